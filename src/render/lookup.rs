//! The medium at a place, in single precision: what the march reads at each sample.

use crate::scene::Interpolation;
use crate::scene::interpolation::spline_fetches_f32;
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};

/// Soot volume fraction, temperature in K, the flame field, and which part of the volume fraction is smoke.
pub(super) type Found = [f32; 4];

/// What is found where no brick is: clear air.
const CLEAR: Found = [0.0, 300.0, 0.0, 0.0];

/// The medium at a lattice position. The flame field is read only where `GAS` is, the smoke only where `SCATTER` is.
///
/// The position comes in f64: where the temperature changes by hundreds of kelvin in a voxel, the last bit of an
/// f32 coordinate would show in Planck's exponential.
#[inline(always)]
pub(super) fn lookup<const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    position: [f64; 3],
) -> Found {
    // One way for all samples of a picture: the processor foresees it.
    match medium.interpolation {
        Interpolation::Trilinear => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let fraction =
                std::array::from_fn(|axis| (position[axis] - f64::from(voxel[axis])) as f32);
            cell::<GAS, SCATTER>(medium, voxel, fraction)
        }
        Interpolation::Nearest => {
            let voxel: [i32; 3] = position.map(|p| p as i32);
            let upper = std::array::from_fn(|axis| position[axis] - f64::from(voxel[axis]) >= 0.5);
            corner::<GAS, SCATTER>(medium, voxel, upper)
        }
        Interpolation::Tricubic => tricubic::<GAS, SCATTER>(medium, position),
    }
}

/// The B-spline by eight linear fetches.
#[inline(never)]
fn tricubic<const GAS: bool, const SCATTER: bool>(medium: &Medium, position: [f64; 3]) -> Found {
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
                let found = cell::<GAS, SCATTER>(medium, [x, y, z], [fx, fy, fz]);
                let weight = wx * wy * wz;
                sum = std::array::from_fn(|c| sum[c] + weight * found[c]);
            }
        }
    }
    sum
}

/// Between the eight corners of a voxel's cell, trilinear; clear air where no brick is.
#[inline(always)]
fn cell<const GAS: bool, const SCATTER: bool>(
    medium: &Medium,
    voxel: [i32; 3],
    fraction: [f32; 3],
) -> Found {
    let Some(first) = first_corner(medium, voxel) else {
        return CLEAR;
    };
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
    // A field of its own: two neighbours in x at a time.
    let beside = |field: &[f32]| -> f32 {
        let pair = |dy: usize, dz: usize| -> [f32; 2] {
            let at = row(dy, dz);
            [field[at], field[at + 1]]
        };
        let near = between(pair(0, 0), pair(1, 0), fraction[1]);
        let far = between(pair(0, 1), pair(1, 1), fraction[1]);
        let [low, high] = between(near, far, fraction[2]);
        low + fraction[0] * (high - low)
    };
    let has = [
        GAS && !medium.flame.is_empty(),
        SCATTER && !medium.smoke.is_empty(),
    ];
    [
        soot_low + fraction[0] * (soot_high - soot_low),
        hot_low + fraction[0] * (hot_high - hot_low),
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
fn between<const N: usize>(a: [f32; N], b: [f32; N], f: f32) -> [f32; N] {
    std::array::from_fn(|i| a[i] + f * (b[i] - a[i]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::{DAffine3, DVec3, IVec3};
    use proptest::prelude::*;

    use super::*;
    use crate::volume::{Border, FieldMap, FieldMaps, Grid, Volume};

    /// Voxels along an edge: no multiple of a brick's.
    const EDGE: i32 = 21;
    /// Temperature where the file says nothing, K.
    const AROUND_K: f32 = 320.0;

    /// 0 to 1 for a voxel: in one block of 5³ voxels out of eight, else 0.
    fn speckles(voxel: IVec3, seed: u32) -> f32 {
        let block = voxel / 5;
        let number = |v: IVec3| (v.x + 32 * v.y + 1024 * v.z) as u32;
        let [hash, ..] = crate::math::random::philox([number(block), 0, 0, 0], [seed, 0]);
        let [noise, ..] = crate::math::random::philox([number(voxel), 1, 0, 0], [seed, 0]);
        if hash >> 29 == 0 {
            noise as f32 / u32::MAX as f32
        } else {
            0.0
        }
    }

    /// Soot with smoke, kelvin, flame and smoke of a voxel of the file.
    fn of_file(voxel: IVec3, seed: u32) -> [f32; 4] {
        let hot = speckles(voxel, seed + 1);
        let smoke = 1e-5 * speckles(voxel, seed + 3);
        [
            1e-5 * speckles(voxel, seed) + smoke,
            if hot > 0.0 {
                400.0 + 2000.0 * hot
            } else {
                AROUND_K
            },
            speckles(voxel, seed + 2),
            smoke,
        ]
    }

    /// The same of any voxel, with the file's border.
    fn of_voxel(voxel: IVec3, seed: u32, border: Border) -> [f32; 4] {
        let clamped = voxel.clamp(IVec3::ZERO, IVec3::splat(EDGE - 1));
        if border == Border::Clamp || clamped == voxel {
            of_file(clamped, seed)
        } else {
            [0.0, AROUND_K, 0.0, 0.0]
        }
    }

    fn medium(seed: u32, border: Border, interpolation: Interpolation) -> Medium {
        let grid = |name: &str, c: usize, around: f32| {
            let (dims, value) = (IVec3::splat(EDGE), |voxel| of_file(voxel, seed)[c]);
            Grid::from_fn(name, dims, DAffine3::IDENTITY, border, around, value)
        };
        // The file's own soot is what is not smoke.
        let own = |voxel| {
            let [all, .., smoke] = of_file(voxel, seed);
            all - smoke
        };
        let grids = vec![
            Grid::from_fn(
                "soot",
                IVec3::splat(EDGE),
                DAffine3::IDENTITY,
                border,
                0.0,
                own,
            ),
            grid("smoke", 3, 0.0),
            grid("temperature", 1, AROUND_K),
            grid("flame", 2, 0.0),
        ];
        let map = |name: &str, max: f64| Some(FieldMap::new(name, 1.0, 0.0, 0.0, max));
        let maps = FieldMaps {
            soot: map("soot", 1.0),
            smoke: map("smoke", 1.0),
            temperature: map("temperature", 1e4),
            flame: map("flame", 1.0),
        };
        let volume = Volume::from_grids(grids, "speckles");
        crate::scene::pack_for_tests(&volume, &maps, interpolation).unwrap()
    }

    /// Weights of the four samples around a fraction, by the formulae.
    fn weights(interpolation: Interpolation, f: f64) -> [f64; 4] {
        let g = 1.0 - f;
        match interpolation {
            Interpolation::Nearest if f < 0.5 => [0.0, 1.0, 0.0, 0.0],
            Interpolation::Nearest => [0.0, 0.0, 1.0, 0.0],
            Interpolation::Trilinear => [0.0, g, f, 0.0],
            Interpolation::Tricubic => [
                g.powi(3) / 6.0,
                (4.0 - 6.0 * f * f + 3.0 * f.powi(3)) / 6.0,
                (1.0 + 3.0 * f + 3.0 * f * f - 3.0 * f.powi(3)) / 6.0,
                f.powi(3) / 6.0,
            ],
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

        /// Both lookups, single and double, are the interpolant of the whole file, wherever anything shows: however
        /// sparse the bricks, at their borders and at the file's.
        #[test]
        fn sparse_bricks_are_the_whole_file(
            seed in 0_u32..1000,
            interpolation in prop::sample::select(Interpolation::ALL.to_vec()),
            border in prop::sample::select(vec![Border::Background, Border::Clamp]),
        ) {
            let medium = medium(seed, border, interpolation);
            let domain = medium.domain;
            let origin = medium.lattice_from_world.translation;
            // The sum of soot and smoke is rounded twice.
            let exact = [2e-7, 1e-12, 1e-12, 1e-12];
            let mut seen = 0;
            for i in 0..400_u32 {
                let place = crate::math::random::philox([i, 0, 0, 0], [seed, 7]);
                let place = [0, 1, 2].map(|axis: usize| f64::from(place[axis]) / f64::from(u32::MAX));
                let anywhere = domain.min + DVec3::from(place) * domain.size();
                // A third beside the borders of bricks, a third at the domain's own.
                let position = match i % 3 {
                    0 => anywhere,
                    1 => {
                        let border = (anywhere / BRICK as f64).round() * BRICK as f64;
                        border + 0.02 * (DVec3::from(place) - 0.5)
                    }
                    _ => anywhere.round() + 1e-9 * (DVec3::from(place) - 0.5).signum(),
                };
                let position = position.clamp(domain.min, domain.max);
                let voxel = position - origin;
                let (base, mut whole) = (voxel.floor(), [0.0; 4]);
                let along = (voxel - base).to_array().map(|f| weights(interpolation, f));
                let (mut low, mut high) = ([f64::INFINITY; 4], [0.0_f64; 4]);
                for at in 0..64 {
                    let [x, y, z] = [at & 3, at >> 2 & 3, at >> 4];
                    let weight = along[0][x] * along[1][y] * along[2][z];
                    let step = IVec3::new(x as i32, y as i32, z as i32) - 1;
                    let values = of_voxel(base.as_ivec3() + step, seed, border).map(f64::from);
                    for c in 0..4 {
                        whole[c] += weight * values[c];
                        if weight > 0.0 {
                            (low[c], high[c]) = (low[c].min(values[c]), high[c].max(values[c]));
                        }
                    }
                }
                let hot = high[1] > 900.0;
                if whole[0] <= 1e-12 && whole[2] <= 1e-6 && !hot {
                    continue;
                }
                seen += 1;
                // At half a voxel and at a whole one single and double may fall to different sides.
                let near_step = interpolation == Interpolation::Nearest
                    && (voxel - base - 0.5).abs().min_element() < 1e-6;
                if near_step {
                    continue;
                }
                let [soot, kelvin] = medium.sample(position);
                let double = [soot, kelvin, medium.flame(position), medium.smoke(position)];
                let single = lookup::<true, true>(&medium, position.to_array());
                for c in 0..4 {
                    let scale = high[c].max(1e-12);
                    let found = f64::from(single[c]);
                    prop_assert!((double[c] - whole[c]).abs() <= exact[c] * scale, "{c} at {voxel}: {double:?} {whole:?}");
                    prop_assert!((found - whole[c]).abs() <= 2e-6 * scale, "{c} at {voxel}: {single:?} {whole:?}");
                    prop_assert!(found >= 0.0 && found <= high[c] * (1.0 + 1e-6), "{c}: {found} above {}", high[c]);
                    prop_assert!(found >= low[c] - 1e-6 * high[c], "{c}: {found} below {}", low[c]);
                }
            }
            prop_assert!(seen > 0 || medium.samples.is_empty());
        }
    }
}
