//! A torch of soot and kelvin.
//!
//! A diffusion flame burns where fuel and air meet in the right proportion. So the torch is a *mixture
//! fraction* ξ, 1 in the fuel, 0 in the air, and what glows follows from it (the conserved-scalar picture of
//! Burke & Schumann 1928): the gas is hottest on the stoichiometric surface, soot is born just inside of it,
//! where the mixture is rich and already hot, and burns away on reaching it. The result is what fire looks like:
//! thin wrinkled sheets around a darker inside, closing to tips.
//!
//! ξ is a paraboloid of revolution that narrows upwards, warped by gradient noise (Perlin 2002) that grows with
//! height and is drawn out along the flow. Illustrative, not simulated; the optics are as real as for any file.

use glam::{IVec3, Vec3};

use super::noise::{noise, noise_vector, smoothstep};
use super::{AIR_K, Fields, Lattice};

/// Voxels of the grid.
const DIMS: IVec3 = IVec3::new(72, 72, 152);
/// Edge of a voxel, m.
const VOXEL_M: f64 = 0.003;
/// Height at which the last fuel is burnt, m.
const HEIGHT_M: f32 = 0.42;
/// Radius of the fuel's outlet, m.
const OUTLET_M: f32 = 0.030;
/// Mixture fraction of the hottest surface, in units of the outlet's.
pub(super) const STOICHIOMETRIC: f32 = 0.26;
/// Mixture fraction with most soot.
const SOOTIEST: f32 = 0.44;
/// Half width of the soot's layer in mixture fraction.
const SOOT_WIDTH: f32 = 0.12;
/// Amplitudes of the warp where it is fully grown, m: swaying, eddies, curls.
const SWAY_M: f32 = 0.042;
const EDDY_M: f32 = 0.036;
const CURL_M: f32 = 0.010;
/// Most soot, volume fraction: a propane torch.
const PEAK_SOOT: f32 = 3.0e-6;
/// Hottest gas, K.
const FLAME_K: f32 = 1950.0;

/// The lattice on which the torch is made.
pub(super) const LATTICE: Lattice = Lattice {
    dims: DIMS,
    voxel_m: VOXEL_M,
};

/// Soot volume fraction, temperature (K) and flame field at a point, m.
///
/// Its sheets are all that burns and all that soots, so it has no flame field of its own.
pub(super) fn at(point: Vec3) -> Fields {
    mixture_fraction(point).map_or(Fields::AIR, |mixture| Fields {
        soot: soot(point, mixture),
        kelvin: temperature(point, mixture),
        flame: 0.0,
    })
}

/// Soot volume fraction at a point (m) of a mixture.
fn soot(point: Vec3, mixture: f32) -> f32 {
    let layer = (mixture - SOOTIEST) / SOOT_WIDTH;
    // Soot needs time to grow: none at the outlet, all of it a quarter of the way up.
    let grown = smoothstep(0.008, 0.13, point.z);
    let density = PEAK_SOOT * grown * (-layer * layer).exp();
    // The gaussian's feet are cut where they no longer glow, so that air stays empty.
    if density < 2e-3 * PEAK_SOOT {
        0.0
    } else {
        density
    }
}

/// Temperature (K) at a point (m) of a mixture.
fn temperature(point: Vec3, mixture: f32) -> f32 {
    // Linear from air to the flame sheet; richer gas is cooler, and soot's own radiation cools it further.
    let lean = mixture / STOICHIOMETRIC;
    let rich = 1.0 - 0.45 * (mixture - STOICHIOMETRIC) / (1.0 - STOICHIOMETRIC);
    let radiated = 1.0 - 0.30 * smoothstep(0.06, HEIGHT_M, point.z);
    AIR_K + (FLAME_K - AIR_K) * lean.min(rich).clamp(0.0, 1.0) * radiated
}

/// Mixture fraction, 1 in the fuel; `None` where the air is clean.
pub(super) fn mixture_fraction(point: Vec3) -> Option<f32> {
    let height = point.z / HEIGHT_M;
    // The fuel's column is drawn in by the rising gas, swells as it heats, and narrows as it burns.
    let swell =
        0.55 + 0.75 * smoothstep(-0.08, 0.30, height) - 0.95 * smoothstep(0.22, 1.15, height);
    let radius = 2.1 * OUTLET_M * swell;
    let [sway, eddy, curl] = [
        SWAY_M * smoothstep(0.0, 0.8, height),
        EDDY_M * smoothstep(-0.1, 0.5, height),
        CURL_M * smoothstep(0.0, 0.3, height),
    ];
    // Whether the warps still to come can carry a point into the column: noise is dear, and most of the box is air.
    let out_of_reach = |point: Vec3, warps: f32| point.truncate().length() > radius + 1.2 * warps;
    if !(0.0..1.25).contains(&height) || out_of_reach(point, sway + eddy + curl) {
        return None;
    }
    // The warp: slow swaying of the whole, eddies that rise and stretch, fine curls on the sheets.
    let flow = Vec3::new(point.x, point.y, 0.42 * point.z);
    let swayed = flow + noise_vector(flow * 9.0 + Vec3::splat(3.7)) * sway;
    if out_of_reach(swayed, eddy + curl) {
        return None;
    }
    // Tongues: some columns of gas burn out sooner than others.
    let tongue = noise(Vec3::new(
        swayed.x * 34.0,
        swayed.y * 34.0,
        swayed.z * 16.0 + 0.6,
    ));
    let burning = 1.0 - 0.95 * height.powf(1.3) + 2.3 * height * (1.1 - height) * tongue;
    if burning <= 0.0 {
        return None;
    }
    let turned = swayed + noise_vector(swayed * 30.0 + Vec3::splat(1.3)) * eddy;
    if out_of_reach(turned, curl) {
        return None;
    }
    let curled = turned + noise_vector(turned * 74.0) * curl;
    let distance = curled.truncate().length() / radius;
    Some((burning * (1.0 - distance * distance).max(0.0)).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::super::torch;
    use super::*;
    use crate::volume::BrickRef;

    #[test]
    fn the_torch_is_a_physical_volume_that_stands_on_the_ground() {
        let volume = torch();
        let (soot, hot) = (&volume.grids[0], &volume.grids[1]);
        assert!(soot.range().1 <= PEAK_SOOT && soot.range().1 > 0.8 * PEAK_SOOT);
        assert!(hot.range().1 <= FLAME_K && hot.range().1 > 1800.0);
        let dense = soot
            .bricks()
            .filter(|(_, brick)| matches!(brick, BrickRef::Dense(_)))
            .count();
        assert!((100..2000).contains(&dense), "{dense} bricks with soot");
    }

    #[test]
    fn the_flame_does_not_touch_its_box() {
        let volume = torch();
        let soot = &volume.grids[0];
        for z in 0..DIMS.z {
            for y in 0..DIMS.y {
                for x in 0..DIMS.x {
                    let voxel = IVec3::new(x, y, z);
                    let on_a_face = voxel.cmpeq(IVec3::ZERO).any() || voxel.cmpeq(DIMS - 1).any();
                    assert!(!on_a_face || soot.value(voxel) == 0.0, "{voxel} is cut off");
                }
            }
        }
    }
}
