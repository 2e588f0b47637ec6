#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use glam::{DAffine3, DVec3, IVec3};
use proptest::prelude::*;

use super::*;
use crate::math::lanes::Rounded;
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
            let lanes = position.to_array().map(|at| [at; LANES]);
            let mut left = [1; LANES];
            left[1] = 0;
            let [single, none, ..] = lookup_lanes::<Rounded, true, true>(&medium, &lanes, &left);
            prop_assert_eq!(none, CLEAR);
            prop_assert_eq!(single, lookup::<Rounded, true, true>(&medium, position.to_array()));
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
