//! A gas burner with too little air: a blue cone, hot gas around it, a sooty tip.
//!
//! Gas that brings some of its air along burns twice. On the surface of a cone above the port it meets its own flame
//! (the thin sheet where CH and C₂ glow blue); what is left of the fuel burns where air comes in from the side. Where
//! the mixture is rich, soot forms in the hot gas inside, rises to the tip and burns away there. Illustrative, not
//! simulated; temperatures and amounts are those of such flames (A. G. Gaydon and H. G. Wolfhard, *Flames* (1979)).

use glam::{IVec3, Vec2, Vec3};

use super::noise::{noise, smoothstep};
use super::{AIR_K, Fields, Lattice};

/// The lattice on which the burner is made.
pub(super) const LATTICE: Lattice = Lattice {
    dims: IVec3::new(48, 48, 184),
    voxel_m: 0.001,
};

/// Radius of the port, m.
const PORT_M: f32 = 0.0085;
/// Height of the blue cone, m.
const CONE_M: f32 = 0.042;
/// Half width of the cone's sheet, m: that of a flame, widened to what the lattice can hold.
const SHEET_M: f32 = 0.0009;
/// Height of the whole flame, m.
const HEIGHT_M: f32 = 0.165;
/// Greatest radius of the whole flame, m.
const BODY_M: f32 = 0.0145;
/// Width over which the hot gas ends in air, m.
const EDGE_M: f32 = 0.0045;
/// Hottest gas, just above the cone, K.
const FLAME_K: f32 = 2120.0;
/// Share of the heat that the gas has lost at the tip.
const LOST: f32 = 0.2;
/// Flame field where the rest of the fuel burns, for that of the cone: the same heat from a much thicker layer.
const MANTLE: f32 = 0.02;
/// Most soot, volume fraction.
const PEAK_SOOT: f32 = 1.2e-6;

/// Soot volume fraction, temperature (K) and flame field at a point, m.
pub(super) fn at(point: Vec3) -> Fields {
    let height = point.z / HEIGHT_M;
    if height >= 1.08 {
        return Fields::AIR;
    }
    // The higher, the more the flame sways.
    let sway = 0.006 * smoothstep(0.15, 1.2, height);
    let drift = Vec2::new(
        noise(Vec3::new(3.3, 7.7, 14.0 * point.z)),
        noise(Vec3::new(8.1, 1.9, 14.0 * point.z)),
    );
    let radius = (point.truncate() + sway * drift).length();

    // How far outside of the cone, and how far inside of the body.
    let outside_cone = outside_cone(radius, point.z);
    let inside_body = body_radius(height) - radius;
    let hot = smoothstep(-0.4 * EDGE_M, 0.6 * EDGE_M, inside_body);
    let burnt = smoothstep(-1.5 * SHEET_M, 1.5 * SHEET_M, outside_cone);
    let kept = 1.0 - LOST * smoothstep(0.3, 1.0, height);
    let kelvin = AIR_K + (FLAME_K - AIR_K) * hot * burnt * kept;

    let sheet = (-(outside_cone / SHEET_M).powi(2)).exp() * smoothstep(-0.002, 0.002, point.z);
    let mantle = (-((inside_body - 0.3 * EDGE_M) / (0.5 * EDGE_M)).powi(2)).exp();
    let flame = (sheet + MANTLE * mantle * smoothstep(0.0, 0.1, height)).min(1.0);
    Fields {
        soot: soot(height, inside_body),
        kelvin,
        flame: if flame < 1e-3 { 0.0 } else { flame },
    }
}

/// Signed distance from the cone's surface, m; negative in the unburnt gas.
fn outside_cone(radius: f32, z: f32) -> f32 {
    // A straight cone with a round tip: the norm of how far in and how far up.
    let slant = PORT_M.hypot(CONE_M);
    let across = radius * CONE_M / slant;
    let along = (z - CONE_M) * PORT_M / slant;
    let tip = 0.0012;
    along + across.hypot(tip)
}

/// Radius of the whole flame at a height, as a share of the flame's; 0 above it.
fn body_radius(height: f32) -> f32 {
    let foot = PORT_M + (BODY_M - PORT_M) * smoothstep(-0.05, 0.3, height);
    let closing = (1.0 - ((height - 0.18) / 0.82).max(0.0).powf(1.7)).max(0.0);
    foot * closing
}

/// Soot: inside the hot gas, from above the cone to the tip, where it burns away from the outside.
fn soot(height: f32, inside_body: f32) -> f32 {
    // It begins at the sides, where the gas has been hot for longest, and rises towards the axis.
    let late = 0.2 * smoothstep(0.0, 0.7 * BODY_M, inside_body);
    let grown = smoothstep(0.14 + late, 0.8 + late, height).powi(3);
    let burnt_up = 1.0 - smoothstep(0.88, 1.0, height);
    let inside = smoothstep(0.1 * EDGE_M, 1.1 * EDGE_M, inside_body);
    let density = PEAK_SOOT * grown * burnt_up * inside;
    // So little does not show even beside the blue glow; below it, air stays empty.
    if density < 1e-5 * PEAK_SOOT {
        0.0
    } else {
        density
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cone_burns_the_gas_within_is_cold_and_the_tip_soots() {
        let cone = at(Vec3::new(0.5 * PORT_M, 0.0, 0.5 * CONE_M));
        assert!(cone.flame > 0.3 && cone.soot == 0.0, "{cone:?}");
        let within = at(Vec3::new(0.0, 0.0, 0.3 * CONE_M));
        assert!(within.kelvin < 600.0 && within.flame < 0.1, "{within:?}");
        let above = at(Vec3::new(0.0, 0.0, 1.3 * CONE_M));
        assert!(above.kelvin > 1900.0 && above.soot == 0.0, "{above:?}");
        let tip = at(Vec3::new(0.0, 0.0, 0.78 * HEIGHT_M));
        assert!(tip.soot > 0.3 * PEAK_SOOT && tip.kelvin > 1600.0, "{tip:?}");
    }

    #[test]
    fn the_flame_does_not_touch_its_box() {
        let Lattice { dims, voxel_m } = LATTICE;
        let half = 0.5 * f64::from(dims.x) * voxel_m;
        for i in 0..=200 {
            let along = f64::from(i) / 200.0;
            let top = f64::from(dims.z) * voxel_m;
            let side = at(Vec3::new(half as f32, 0.0, (along * top) as f32));
            assert!(
                side.soot == 0.0 && side.flame == 0.0 && side.kelvin < 900.0,
                "{side:?}"
            );
            let lid = at(Vec3::new((along * half) as f32, 0.0, top as f32));
            assert!(
                lid.soot == 0.0 && lid.flame == 0.0 && lid.kelvin < 900.0,
                "{lid:?}"
            );
        }
    }
}
