//! Burning spirit: the torch's wrinkled sheet without soot, rising from a pool.
//!
//! Alcohol burns blue and makes no soot, so that what a salt adds is all that shines. The fuel evaporates from a pool, so
//! the sheet closes at its foot. Illustrative, not simulated.

use glam::Vec3;

use super::noise::smoothstep;
use super::torch::{self, STOICHIOMETRIC, mixture_fraction};
use super::{AIR_K, Fields, Lattice};

/// The lattice on which it is made.
pub(super) const LATTICE: Lattice = torch::LATTICE;

/// Hottest gas, K: methanol's flame, less what it loses.
const FLAME_K: f32 = 2050.0;
/// Share of the heat that the richest gas lacks.
const RICH_LOSS: f32 = 0.6;
/// Share of the heat that the gas has lost where the flame ends.
const LOST: f32 = 0.22;
/// Height of the flame, m.
const HEIGHT_M: f32 = 0.42;
/// Height over which the sheet closes at its foot, m.
const FOOT_M: f32 = 0.045;
/// Half width of the burning layer in mixture fraction.
const LAYER: f32 = 0.06;
/// Flame field of the burning layer.
const BURNING: f32 = 0.5;

/// Soot volume fraction, temperature (K) and flame field at a point, m.
pub(super) fn at(point: Vec3) -> Fields {
    let Some(mixture) = mixture_fraction(point) else {
        return Fields::AIR;
    };
    let rise = (point.z / FOOT_M).clamp(0.0, 1.0);
    let mixture = mixture * (1.0 - (1.0 - rise).powi(2)).sqrt();
    let lean = mixture / STOICHIOMETRIC;
    let rich = 1.0 - RICH_LOSS * (mixture - STOICHIOMETRIC) / (1.0 - STOICHIOMETRIC);
    let kept = 1.0 - LOST * smoothstep(0.06, HEIGHT_M, point.z);
    let layer = (mixture - STOICHIOMETRIC) / LAYER;
    let flame = BURNING * (-layer * layer).exp();
    Fields {
        soot: 0.0,
        kelvin: AIR_K + (FLAME_K - AIR_K) * lean.min(rich).clamp(0.0, 1.0) * kept,
        flame: if flame < 1e-3 { 0.0 } else { flame },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_no_soot_and_burns_in_a_sheet_that_closes_at_its_foot() {
        let mut burning = 0;
        for i in 0..400 {
            let fields = at(Vec3::new(0.0, 0.0, 0.001 * i as f32));
            assert_eq!(fields.soot, 0.0);
            burning += i32::from(fields.flame > 0.3);
        }
        assert!(burning > 0);
        assert!(at(Vec3::new(0.02, 0.0, 0.0)).kelvin < 400.0);
    }
}
