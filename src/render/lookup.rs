//! The medium at a place, in single precision: what the march reads at each sample.

use crate::scene::Interpolation;
use crate::scene::interpolation::spline_fetches_f32;
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};

/// Soot volume fraction, temperature in K, and the flame field.
pub(super) type Found = [f32; 3];

/// What is found where no brick is: clear air.
const CLEAR: Found = [0.0, 300.0, 0.0];

/// The medium at a lattice position. The flame field is read only where `GAS` is.
///
/// The position comes in f64: where the temperature changes by hundreds of kelvin in a voxel, the last bit of an
/// f32 coordinate would show in Planck's exponential.
#[inline(always)]
pub(super) fn lookup<const GAS: bool>(medium: &Medium, position: [f64; 3]) -> Found {
    // One way for all samples of a picture: the processor foresees it.
    match medium.interpolation {
        Interpolation::Trilinear => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let fraction =
                std::array::from_fn(|axis| (position[axis] - f64::from(voxel[axis])) as f32);
            cell::<GAS>(medium, voxel, fraction)
        }
        Interpolation::Nearest => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let fraction = std::array::from_fn(|axis| {
                let fraction = (position[axis] - f64::from(voxel[axis])) as f32;
                if fraction < 0.5 { 0.0 } else { 1.0 }
            });
            cell::<GAS>(medium, voxel, fraction)
        }
        Interpolation::Tricubic => tricubic::<GAS>(medium, position),
    }
}

/// The B-spline by eight linear fetches.
#[inline(never)]
fn tricubic<const GAS: bool>(medium: &Medium, position: [f64; 3]) -> Found {
    let base: [i32; 3] = position.map(|p| p.floor() as i32);
    let fetches: [[(f32, f32); 2]; 3] = std::array::from_fn(|axis| {
        spline_fetches_f32((position[axis] - f64::from(base[axis])) as f32)
    });
    // A fetch lies in the cell before or after the position's own, up to its end.
    let cells: [[(i32, f32, f32); 2]; 3] = std::array::from_fn(|axis| {
        let [(low, low_weight), (high, high_weight)] = fetches[axis];
        [
            (base[axis] - 1, low + 1.0, low_weight),
            (base[axis] + 1, high - 1.0, high_weight),
        ]
    });
    let mut sum = [0.0; 3];
    for (z, fz, wz) in cells[2] {
        for (y, fy, wy) in cells[1] {
            for (x, fx, wx) in cells[0] {
                let found = cell::<GAS>(medium, [x, y, z], [fx, fy, fz]);
                let weight = wx * wy * wz;
                sum = std::array::from_fn(|c| sum[c] + weight * found[c]);
            }
        }
    }
    sum
}

/// Between the eight corners of a voxel's cell, trilinear; clear air where no brick is.
#[inline(always)]
fn cell<const GAS: bool>(medium: &Medium, voxel: [i32; 3], fraction: [f32; 3]) -> Found {
    // Below the lattice the index wraps to a brick that no table has.
    let brick: [u32; 3] = voxel.map(|v| (v as u32) / BRICK as u32);
    if brick[0] >= medium.bricks.x || brick[1] >= medium.bricks.y || brick[2] >= medium.bricks.z {
        return CLEAR;
    }
    let slot = medium.table[medium.brick_index(brick.into())];
    if slot == NO_BRICK {
        return CLEAR;
    }
    let local: [usize; 3] = voxel.map(|v| v as usize % BRICK);
    let first =
        slot as usize * BRICK_SAMPLES + (local[2] * SAMPLES + local[1]) * SAMPLES + local[0];
    let row = |dy: usize, dz: usize| first + (dz * SAMPLES + dy) * SAMPLES;
    // Two neighbours in x, both fields: four floats that lie together.
    let pair = |dy: usize, dz: usize| -> [f32; 4] {
        let at = row(dy, dz);
        let [a, b] = [medium.samples[at], medium.samples[at + 1]];
        [a[0], a[1], b[0], b[1]]
    };
    let near = between(pair(0, 0), pair(1, 0), fraction[1]);
    let far = between(pair(0, 1), pair(1, 1), fraction[1]);
    let [soot_low, hot_low, soot_high, hot_high] = between(near, far, fraction[2]);
    let flame = if GAS && !medium.flame.is_empty() {
        let pair = |dy: usize, dz: usize| -> [f32; 2] {
            let at = row(dy, dz);
            [medium.flame[at], medium.flame[at + 1]]
        };
        let near = between(pair(0, 0), pair(1, 0), fraction[1]);
        let far = between(pair(0, 1), pair(1, 1), fraction[1]);
        let [low, high] = between(near, far, fraction[2]);
        low + fraction[0] * (high - low)
    } else {
        0.0
    };
    [
        soot_low + fraction[0] * (soot_high - soot_low),
        hot_low + fraction[0] * (hot_high - hot_low),
        flame,
    ]
}

#[inline(always)]
fn between<const N: usize>(a: [f32; N], b: [f32; N], f: f32) -> [f32; N] {
    std::array::from_fn(|i| a[i] + f * (b[i] - a[i]))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::super::walk::tests::sparse;
    use super::*;

    proptest! {
        /// In single precision every interpolation is its f64 twin, on borders of bricks and beyond the lattice, too; and
        /// none leaves the range of the samples.
        #[test]
        fn a_lookup_is_its_twin_in_double_precision(
            seed in 0_u32..500,
            position in prop::array::uniform3(-4.0..44.0_f64),
            whole in any::<bool>(),
            interpolation in prop::sample::select(Interpolation::ALL.to_vec()),
        ) {
            let medium = sparse(seed, interpolation);
            let position = if whole { position.map(f64::round) } else { position };
            let [soot, kelvin, flame] = lookup::<true>(&medium, position);
            let [expected, expected_k] = medium.sample(DVec3::from(position));
            let peak = f64::from(medium.peak_volume_fraction());
            prop_assert!((f64::from(soot) - expected).abs() <= 1e-6 * peak, "{soot} {expected}");
            prop_assert!(soot >= 0.0 && f64::from(soot) <= peak * (1.0 + 1e-6) && flame == 0.0);
            // Where no brick is, clear air of any temperature will do.
            if expected > 1e-3 * peak {
                prop_assert!((f64::from(kelvin) / expected_k - 1.0).abs() < 1e-5, "{kelvin} {expected_k}");
            }
        }
    }
}
