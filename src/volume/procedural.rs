//! The built-in flame: a torch of soot and kelvin, made by the same grid path as a file.
//!
//! A diffusion flame burns where fuel and air meet in the right proportion. So the torch is a *mixture
//! fraction* ξ, 1 in the fuel, 0 in the air, and what glows follows from it (the conserved-scalar picture of
//! Burke & Schumann 1928): the gas is hottest on the stoichiometric surface, soot is born just inside of it,
//! where the mixture is rich and already hot, and burns away on reaching it. The result is what fire looks like:
//! thin wrinkled sheets around a darker inside, closing to tips.
//!
//! ξ is a paraboloid of revolution that narrows upwards, warped by gradient noise (Perlin 2002) that grows with
//! height and is drawn out along the flow. Illustrative, not simulated; the optics are as real as for any file.

use glam::{DAffine3, DVec3, IVec3, Vec3};
use rayon::prelude::*;

use super::watch::{Stretch, Watch};
use super::{Border, Grid, Volume, VolumeError};

/// Voxels of the grid.
const DIMS: IVec3 = IVec3::new(72, 72, 152);
/// Edge of a voxel, m.
const VOXEL_M: f64 = 0.003;
/// Height at which the last fuel is burnt, m.
const HEIGHT_M: f32 = 0.42;
/// Radius of the fuel's outlet, m.
const OUTLET_M: f32 = 0.030;
/// Mixture fraction of the hottest surface, in units of the outlet's.
const STOICHIOMETRIC: f32 = 0.26;
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
/// Share of the time that the mixture takes; the rest is building bricks, which is too quick to watch.
const MIXING: f32 = 0.95;
/// Air and flame, K.
const AIR_K: f32 = 300.0;
const FLAME_K: f32 = 1950.0;

/// The built-in flame: soot volume fraction and kelvin, z up, metres, standing on the origin.
pub fn torch() -> Volume {
    make(Watch::default().whole())
}

/// [`torch`] under the eyes of a watch.
///
/// # Errors
/// [`VolumeError::Cancelled`].
pub fn torch_watched(watch: &Watch) -> Result<Volume, VolumeError> {
    let volume = make(watch.whole());
    watch.whole().reach(1, 1)?;
    Ok(volume)
}

/// The torch; once the watch is cancelled parts of it are left out.
fn make(stretch: Stretch) -> Volume {
    let corner = DVec3::new(-0.5 * f64::from(DIMS.x), -0.5 * f64::from(DIMS.y), 0.0) + 0.5;
    let world_from_index =
        DAffine3::from_scale(DVec3::splat(VOXEL_M)) * DAffine3::from_translation(corner);
    // Both fields follow from the mixture, which is by far the dearest to compute: once for each voxel.
    let rows: Vec<(i32, i32)> = (0..DIMS.z)
        .flat_map(|z| (0..DIMS.y).map(move |y| (y, z)))
        .collect();
    let counter = stretch.part(0.0, MIXING).counter(rows.len());
    let (soot, kelvin): (Vec<f32>, Vec<f32>) = rows
        .par_iter()
        .flat_map_iter(|&(y, z)| {
            let width = if counter.goes_on() { DIMS.x } else { 0 };
            (0..width).map(move |x| {
                let point = world_from_index
                    .transform_point3(IVec3::new(x, y, z).as_dvec3())
                    .as_vec3();
                mixture_fraction(point).map_or((0.0, AIR_K), |mixture| {
                    (soot(point, mixture), temperature(point, mixture))
                })
            })
        })
        .unzip();
    let grid = |name: &str, values: &[f32], air: f32| {
        Grid::from_dense(
            name,
            DIMS,
            values,
            world_from_index,
            Border::Background,
            air,
        )
    };
    let grids = vec![
        grid("soot", &soot, 0.0),
        grid("temperature", &kelvin, AIR_K),
    ];
    Volume {
        notes: Vec::new(),
        ..Volume::from_grids(grids, "")
    }
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
fn mixture_fraction(point: Vec3) -> Option<f32> {
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

/// 0 below `low`, 1 above `high`, smooth between.
fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn noise_vector(point: Vec3) -> Vec3 {
    Vec3::new(
        noise(point),
        noise(point + Vec3::new(31.4, 17.2, 5.9)),
        noise(point - Vec3::new(11.8, 47.3, 23.1)),
    )
}

/// Gradient noise, about −1 to 1, features of size 1 (Perlin 2002: quintic fade, twelve edge gradients).
fn noise(point: Vec3) -> f32 {
    // Rounded down without a call: the coordinates are far below 2³¹.
    let toward_zero = point.as_ivec3();
    let above = toward_zero.as_vec3().cmpgt(point);
    let cell = toward_zero - IVec3::new(i32::from(above.x), i32::from(above.y), i32::from(above.z));
    let f = point - cell.as_vec3();
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let corner = |x: i32, y: i32, z: i32| {
        let offset = IVec3::new(x, y, z);
        gradient(cell + offset).dot(f - offset.as_vec3())
    };
    let mix = |a: f32, b: f32, t: f32| a + t * (b - a);
    let along_x = |y, z| mix(corner(0, y, z), corner(1, y, z), fade.x);
    let along_y = |z| mix(along_x(0, z), along_x(1, z), fade.y);
    mix(along_y(0), along_y(1), fade.z)
}

/// The directions from a cube's centre to the middles of its edges.
const GRADIENTS: [Vec3; 12] = {
    const fn edges(x: Vec3, y: Vec3) -> [Vec3; 4] {
        [
            sum(x, y, 1.0, 1.0),
            sum(x, y, -1.0, 1.0),
            sum(x, y, 1.0, -1.0),
            sum(x, y, -1.0, -1.0),
        ]
    }
    const fn sum(x: Vec3, y: Vec3, a: f32, b: f32) -> Vec3 {
        Vec3::new(a * x.x + b * y.x, a * x.y + b * y.y, a * x.z + b * y.z)
    }
    let [p, q, r] = [
        edges(Vec3::X, Vec3::Y),
        edges(Vec3::X, Vec3::Z),
        edges(Vec3::Y, Vec3::Z),
    ];
    [
        p[0], p[1], p[2], p[3], q[0], q[1], q[2], q[3], r[0], r[1], r[2], r[3],
    ]
};

/// One of [`GRADIENTS`], by a hash of the lattice point (mixing as in MurmurHash3,
/// Appleby 2011).
fn gradient(point: IVec3) -> Vec3 {
    let mut hash = (point.x as u32).wrapping_mul(0x9e37_79b1)
        ^ (point.y as u32).wrapping_mul(0x85eb_ca77)
        ^ (point.z as u32).wrapping_mul(0xc2b2_ae3d);
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^= hash >> 16;
    GRADIENTS[(hash % 3 * 4 + (hash >> 8 & 3)) as usize]
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn noise_is_continuous_and_bounded() {
        let mut before = noise(Vec3::new(0.0, 0.0, 0.3));
        for i in 1..20_000 {
            let value = noise(Vec3::new(i as f32 * 1e-3, i as f32 * 7e-4, 0.3));
            // A step of 1.2e-3 at a slope that the quintic fade keeps below 6.
            assert!(
                (value - before).abs() < 7.5e-3 && value.abs() <= 1.1,
                "{before} {value}"
            );
            before = value;
        }
    }
}
