//! The medium at a place, in single precision: what the march reads at each sample.

use crate::math::lanes::{Arithmetic, LANES};
use crate::scene::Interpolation;
use crate::scene::interpolation::spline_fetches_f32;
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES, Sample};

/// Soot volume fraction, temperature in K, the flame field, and which part of the volume fraction is smoke.
pub(super) type Found = [f32; 4];

/// How much later than the lowest corner of a cell its highest one is stored.
const FAR_CORNER: usize = (SAMPLES + 1) * SAMPLES + 1;

/// Adding 1.5 · 2⁵² rounds an f64 below 2³¹ in magnitude to the nearest integer, left in the low mantissa bits: lanes side by
/// side, which a conversion is not. At half a voxel below a whole number it may be either, so that a place on a voxel may
/// belong to the cell before, at its end: it is the same sample, and a brick stores the first layer of its neighbour.
const ROUNDER: f64 = 6755399441055744.0;

/// What is found where no brick is: clear air.
const CLEAR: Found = [0.0, 300.0, 0.0, 0.0];

/// The medium at lattice positions, one in each lane, given by axis; clear air where no sample is left to take. The flame
/// field is read only where `GAS` is, the smoke only where `SCATTER` is.
///
/// The positions come in f64: where the temperature changes by hundreds of kelvin in a voxel, the last bit of an
/// f32 coordinate would show in Planck's exponential.
#[inline(always)]
#[allow(
    clippy::needless_bitwise_bool,
    reason = "lanes side by side: a lazy operator would be a branch in each"
)]
pub(super) fn lookup_lanes<A: Arithmetic, const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    position: &[[f64; LANES]; 3],
    left: &[u32; LANES],
) -> [Found; LANES] {
    let mut found = [CLEAR; LANES];
    // One way for all samples of a picture: the processor foresees it.
    match medium.interpolation {
        Interpolation::Trilinear => {
            let mut fraction = [[0.0_f32; LANES]; 3];
            let mut cell = [[0_u32; LANES]; 3];
            for axis in 0..3 {
                for lane in 0..LANES {
                    let at = position[axis][lane];
                    let shifted = at - 0.5 + ROUNDER;
                    fraction[axis][lane] = (at - (shifted - ROUNDER)) as f32;
                    // Below the lattice the number wraps to a brick that no table has.
                    cell[axis][lane] = shifted.to_bits() as u32;
                }
            }
            let size = medium.bricks.to_array();
            let mut at = [0_u32; LANES];
            let mut local = [0_u32; LANES];
            for lane in 0..LANES {
                let [x, y, z] = [0, 1, 2].map(|axis: usize| cell[axis][lane] / BRICK as u32);
                let inside = (x < size[0]) & (y < size[1]) & (z < size[2]) & (left[lane] > 0);
                let index = z
                    .wrapping_mul(size[1])
                    .wrapping_add(y)
                    .wrapping_mul(size[0])
                    .wrapping_add(x);
                at[lane] = if inside { index } else { u32::MAX };
                let [x, y, z] = [0, 1, 2].map(|axis: usize| cell[axis][lane] % BRICK as u32);
                local[lane] = (z * SAMPLES as u32 + y) * SAMPLES as u32 + x;
            }
            for lane in 0..LANES {
                let slot = medium
                    .table
                    .get(at[lane] as usize)
                    .copied()
                    .unwrap_or(NO_BRICK);
                if slot != NO_BRICK {
                    let first = slot as usize * BRICK_SAMPLES + local[lane] as usize;
                    let fraction = [0, 1, 2].map(|axis: usize| fraction[axis][lane]);
                    found[lane] = between_corners::<A, GAS, SCATTER>(medium, first, fraction);
                }
            }
        }
        Interpolation::Nearest | Interpolation::Tricubic => {
            for lane in 0..LANES {
                if left[lane] > 0 {
                    found[lane] = lookup::<A, GAS, SCATTER>(
                        medium,
                        [0, 1, 2].map(|axis: usize| position[axis][lane]),
                    );
                }
            }
        }
    }
    found
}

/// The medium at one lattice position.
#[inline(always)]
pub(super) fn lookup<A: Arithmetic, const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    position: [f64; 3],
) -> Found {
    match medium.interpolation {
        Interpolation::Trilinear => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let fraction =
                std::array::from_fn(|axis| (position[axis] - f64::from(voxel[axis])) as f32);
            cell::<A, GAS, SCATTER>(medium, voxel, fraction)
        }
        Interpolation::Nearest => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let upper = std::array::from_fn(|axis| position[axis] - f64::from(voxel[axis]) >= 0.5);
            corner::<GAS, SCATTER>(medium, voxel, upper)
        }
        Interpolation::Tricubic => tricubic::<A, GAS, SCATTER>(medium, position),
    }
}

/// The B-spline by eight linear fetches.
#[inline(never)]
fn tricubic<A: Arithmetic, const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    position: [f64; 3],
) -> Found {
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
    let mut sum = [0.0; 4];
    for (z, fz, wz) in cells[2] {
        for (y, fy, wy) in cells[1] {
            for (x, fx, wx) in cells[0] {
                let found = cell::<A, GAS, SCATTER>(medium, [x, y, z], [fx, fy, fz]);
                let weight = wx * wy * wz;
                sum = std::array::from_fn(|c| A::madd(weight, found[c], sum[c]));
            }
        }
    }
    sum
}

/// Between the eight corners of a voxel's cell, trilinear; clear air where no brick is.
#[inline(always)]
fn cell<A: Arithmetic, const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    voxel: [i32; 3],
    fraction: [f32; 3],
) -> Found {
    first_corner(medium, voxel).map_or(CLEAR, |first| {
        between_corners::<A, GAS, SCATTER>(medium, first, fraction)
    })
}

/// Between the eight corners of a cell whose lowest is stored at `first`.
#[inline(always)]
fn between_corners<A: Arithmetic, const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    first: usize,
    fraction: [f32; 3],
) -> Found {
    let row = |dy: usize, dz: usize| first + (dz * SAMPLES + dy) * SAMPLES;
    // One check for all eight.
    let corners: &[Sample] = &medium.samples[first..=first + FAR_CORNER];
    // Two neighbours in x, both fields: four floats that lie together.
    let pair = |dy: usize, dz: usize| -> [f32; 4] {
        let at = (dz * SAMPLES + dy) * SAMPLES;
        let [a, b] = [corners[at], corners[at + 1]];
        [a[0], a[1], b[0], b[1]]
    };
    let near = between::<A, _>(pair(0, 0), pair(1, 0), fraction[1]);
    let far = between::<A, _>(pair(0, 1), pair(1, 1), fraction[1]);
    let [soot_low, hot_low, soot_high, hot_high] = between::<A, _>(near, far, fraction[2]);
    // A field of its own: two neighbours in x at a time.
    let beside = |field: &[f32]| -> f32 {
        let pair = |dy: usize, dz: usize| -> [f32; 2] {
            let at = row(dy, dz);
            [field[at], field[at + 1]]
        };
        let near = between::<A, _>(pair(0, 0), pair(1, 0), fraction[1]);
        let far = between::<A, _>(pair(0, 1), pair(1, 1), fraction[1]);
        let [low, high] = between::<A, _>(near, far, fraction[2]);
        A::madd(fraction[0], high - low, low)
    };
    let has = [
        GAS && !medium.flame.is_empty(),
        SCATTER && !medium.smoke.is_empty(),
    ];
    [
        A::madd(fraction[0], soot_high - soot_low, soot_low),
        A::madd(fraction[0], hot_high - hot_low, hot_low),
        if has[0] { beside(&medium.flame) } else { 0.0 },
        if has[1] { beside(&medium.smoke) } else { 0.0 },
    ]
}

/// One of the eight corners, bit for bit; clear air where no brick is.
#[inline(always)]
fn corner<const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    voxel: [i32; 3],
    upper: [bool; 3],
) -> Found {
    let Some(first) = first_corner(medium, voxel) else {
        return CLEAR;
    };
    let [dx, dy, dz] = upper.map(usize::from);
    let at = first + (dz * SAMPLES + dy) * SAMPLES + dx;
    let has = [
        GAS && !medium.flame.is_empty(),
        SCATTER && !medium.smoke.is_empty(),
    ];
    let [soot, kelvin] = medium.samples[at];
    [
        soot,
        kelvin,
        if has[0] { medium.flame[at] } else { 0.0 },
        if has[1] { medium.smoke[at] } else { 0.0 },
    ]
}

/// Where the lowest corner of a voxel's cell is stored, if it is.
#[inline(always)]
fn first_corner(medium: &Medium, voxel: [i32; 3]) -> Option<usize> {
    // Below the lattice the index wraps to a brick that no table has.
    let brick: [u32; 3] = voxel.map(|v| (v as u32) / BRICK as u32);
    if brick[0] >= medium.bricks.x || brick[1] >= medium.bricks.y || brick[2] >= medium.bricks.z {
        return None;
    }
    let slot = medium.table[medium.brick_index(brick.into())];
    let local: [usize; 3] = voxel.map(|v| v as usize % BRICK);
    (slot != NO_BRICK).then(|| {
        slot as usize * BRICK_SAMPLES + (local[2] * SAMPLES + local[1]) * SAMPLES + local[0]
    })
}

#[inline(always)]
fn between<A: Arithmetic, const N: usize>(a: [f32; N], b: [f32; N], f: f32) -> [f32; N] {
    std::array::from_fn(|i| A::madd(f, b[i] - a[i], a[i]))
}

#[cfg(test)]
mod tests;
