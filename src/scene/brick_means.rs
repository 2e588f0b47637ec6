//! What a medium holds and sends out brick by brick: means over whole bricks, from which bounds are worked out.
//!
//! A mean is of all samples of a brick, so no light of the file is missed however thin a sheet it comes from. What comes to
//! a place from the whole fire is summed over blocks of bricks as if nothing stood in the way:
//!
//! ```text
//! G(x) = 1/(4π) Σ_b E_b V_b/|x − x_b|²,   E_b r_b for the block itself, r_b the radius of the ball of its volume
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | E_b | mean of f_v B(λ, T) in a block, or of the flame field | W m⁻² sr⁻¹ nm⁻¹, 1 |
//! | V_b | volume of its bricks | m³ |
//! | G | mean over all directions of what arrives, for a unit of absorption for each f_v | the same times m |
//!
//! No law of soot is in it: it is worked out once for each packed medium. For a ball of even light the block's own term is
//! exact in its middle, and what other blocks send is right from afar; beside each other blocks are off by up to a third.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec3, UVec3};
use rayon::prelude::*;

use super::means::{BrickMean, Lamp, MEANS, MEANS_NM, Means};
use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};
use crate::math::lanes;
use crate::physics::blackbody;

/// Most blocks between which light is summed up.
const MOST_BLOCKS: usize = 1000;

impl Medium {
    /// Means over each stored brick, worked out when they are asked for first.
    pub(crate) fn means(&self) -> &Means {
        self.means.get_or_init(|| of_medium(self))
    }
}

/// The means of a medium.
fn of_medium(medium: &Medium) -> Means {
    let samples = medium.samples.par_chunks_exact(BRICK_SAMPLES);
    let mut bricks: Vec<BrickMean> = samples
        .enumerate()
        .map(|(slot, samples)| {
            let own = slot * BRICK_SAMPLES..(slot + 1) * BRICK_SAMPLES;
            let beside = |field: &[f32]| field.get(own.clone()).map(mean_of).unwrap_or_default();
            BrickMean {
                burning: beside(&medium.flame),
                smoke: beside(&medium.smoke),
                steepest: steepest(samples) / medium.voxel_size_m,
                ..of_samples(samples)
            }
        })
        .collect();
    let blocks = Blocks::new(medium, bricks.len());
    let lamps = blocks.lamps(&bricks);
    blocks.light_around(&mut bricks);
    Means { bricks, lamps }
}

/// A share of the samples' weights: those on a face belong to two bricks, on an edge to four.
fn weight(i: usize) -> f32 {
    let place = [i % SAMPLES, i / SAMPLES % SAMPLES, i / (SAMPLES * SAMPLES)];
    let half = |at: usize| if at == 0 || at == BRICK { 0.5 } else { 1.0 };
    place.map(half).into_iter().product()
}

static WEIGHTS: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let voxels = (BRICK * BRICK * BRICK) as f32;
    (0..BRICK_SAMPLES).map(|i| weight(i) / voxels).collect()
});

fn mean_of(field: &[f32]) -> f64 {
    let shares = field.iter().zip(&*WEIGHTS).map(|(value, w)| value * w);
    f64::from(shares.sum::<f32>())
}

fn of_samples(samples: &[[f32; 2]]) -> BrickMean {
    let exponents = MEANS_NM.map(|nm| (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32);
    let (mut soot, mut hottest, mut glow) = (0.0_f32, 0.0_f32, [0.0_f32; MEANS]);
    for (&[fraction, kelvin], w) in samples.iter().zip(&*WEIGHTS) {
        hottest = hottest.max(kelvin);
        if fraction <= 0.0 {
            continue;
        }
        soot += w * fraction;
        let inverse = 1.0 / kelvin;
        for (glow, exponent) in glow.iter_mut().zip(&exponents) {
            let wien = lanes::exp(-exponent * inverse);
            *glow += w * fraction * wien / (1.0 - wien);
        }
    }
    let scale = |i: usize| blackbody::FIRST_RADIATION_CONSTANT / MEANS_NM[i].powi(5);
    BrickMean {
        soot: f64::from(soot),
        glow: std::array::from_fn(|i| scale(i) * f64::from(glow[i])),
        hottest_k: f64::from(hottest),
        ..BrickMean::default()
    }
}

/// Largest difference of 1/T between samples that follow each other, 1/K.
fn steepest(samples: &[[f32; 2]]) -> f64 {
    let mut most = 0.0_f32;
    for stride in [1, SAMPLES, SAMPLES * SAMPLES] {
        for (i, pair) in samples.iter().zip(&samples[stride..]).enumerate() {
            // The last sample of a row has no next one.
            if i / stride % SAMPLES < BRICK {
                most = most.max((1.0 / pair.0[1] - 1.0 / pair.1[1]).abs());
            }
        }
    }
    // Along three axes at once.
    3.0_f64.sqrt() * f64::from(most)
}

/// Bricks taken together.
struct Blocks {
    /// Block of each slot.
    of_slot: Vec<usize>,
    /// Middle of the bricks of each, m, and their volume, m³.
    middles: Vec<DVec3>,
    volumes_m3: Vec<f64>,
}

impl Blocks {
    fn new(medium: &Medium, bricks: usize) -> Self {
        let world_from_lattice = medium.lattice_from_world.inverse();
        let brick_m3 = (BRICK as f64 * medium.voxel_size_m).powi(3);
        let [width, height, _] = medium.bricks.to_array().map(|side| side as usize);
        let place = |i: usize| {
            let place = [i % width, i / width % height, i / (width * height)];
            UVec3::from(place.map(|at| at as u32))
        };
        let mut edge = 1;
        loop {
            let counts = (medium.bricks + (edge - 1)) / edge;
            let mut number =
                vec![usize::MAX; counts.as_usizevec3().to_array().iter().product::<usize>()];
            let mut blocks = Self {
                of_slot: vec![0; bricks],
                middles: Vec::new(),
                volumes_m3: Vec::new(),
            };
            for (i, &slot) in medium.table.iter().enumerate() {
                if slot == NO_BRICK {
                    continue;
                }
                let at = (place(i) / edge).as_usizevec3();
                let counts = counts.as_usizevec3();
                let number = &mut number[(at.z * counts.y + at.y) * counts.x + at.x];
                if *number == usize::MAX {
                    *number = blocks.middles.len();
                    blocks.middles.push(DVec3::ZERO);
                    blocks.volumes_m3.push(0.0);
                }
                blocks.of_slot[slot as usize] = *number;
                let middle = (place(i).as_dvec3() + 0.5) * BRICK as f64;
                blocks.middles[*number] += world_from_lattice.transform_point3(middle) * brick_m3;
                blocks.volumes_m3[*number] += brick_m3;
            }
            if blocks.middles.len() <= MOST_BLOCKS {
                let volumes = blocks.middles.iter_mut().zip(&blocks.volumes_m3);
                volumes.for_each(|(middle, volume)| *middle /= *volume);
                return blocks;
            }
            edge *= 2;
        }
    }

    /// Sums of N numbers of each brick over each block, times the volume.
    fn summed<const N: usize>(
        &self,
        means: &[BrickMean],
        of: impl Fn(&BrickMean) -> [f64; N],
    ) -> Vec<[f64; N]> {
        let mut sums = vec![[0.0; N]; self.middles.len()];
        let brick_m3 = self.volumes_m3.iter().sum::<f64>() / means.len().max(1) as f64;
        for (mean, &block) in means.iter().zip(&self.of_slot) {
            for (sum, value) in sums[block].iter_mut().zip(of(mean)) {
                *sum += brick_m3 * value;
            }
        }
        sums
    }

    /// G of the module's page, for each block, of sums over blocks.
    fn around<const N: usize>(&self, sums: &[[f64; N]]) -> Vec<[f64; N]> {
        (0..self.middles.len())
            .into_par_iter()
            .map(|here| {
                let mut light = [0.0; N];
                for (there, sum) in sums.iter().enumerate() {
                    let geometry = if there == here {
                        let volume = self.volumes_m3[here];
                        (3.0 * volume / (4.0 * PI)).cbrt() / volume
                    } else {
                        let apart = self.middles[here].distance_squared(self.middles[there]);
                        1.0 / (4.0 * PI * apart)
                    };
                    for (light, sum) in light.iter_mut().zip(sum) {
                        *light += geometry * sum;
                    }
                }
                light
            })
            .collect()
    }

    /// Each as one light.
    fn lamps(&self, means: &[BrickMean]) -> Vec<Lamp> {
        let sums = self.summed(means, |mean| {
            let [a, b, c, d] = mean.glow;
            [a, b, c, d, mean.burning]
        });
        let places = self.middles.iter().zip(&self.volumes_m3);
        places
            .zip(sums)
            .map(|((&middle, volume), [glow @ .., burning])| Lamp {
                middle,
                radius_m: (3.0 * volume / (4.0 * PI)).cbrt(),
                glow,
                burning,
            })
            .collect()
    }

    /// Fills in what arrives from all sides.
    fn light_around(&self, means: &mut [BrickMean]) {
        let fresh = self.around(&self.summed(means, |mean| {
            let [a, b, c, d] = mean.glow;
            [a, b, c, d, mean.burning]
        }));
        for (mean, &block) in means.iter_mut().zip(&self.of_slot) {
            let [glow @ .., burning] = fresh[block];
            (mean.glow_around, mean.burning_around) = (glow, burning);
        }
        let scattered = self.around(&self.summed(means, |mean| {
            let soot = (mean.soot - mean.smoke).max(0.0);
            let [a, b, c, d] = mean.glow_around;
            let of = |share: f64| [a, b, c, d].map(|light| light * share);
            let ([a, b, c, d], [e, f, g, h]) = (of(soot), of(mean.smoke));
            [a, b, c, d, e, f, g, h]
        }));
        for (mean, &block) in means.iter_mut().zip(&self.of_slot) {
            let [a, b, c, d, e, f, g, h] = scattered[block];
            mean.scattered_around = [[a, b, c, d], [e, f, g, h]];
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::{DAffine3, IVec3};

    use super::*;
    use crate::scene::{Interpolation, pack_for_tests};
    use crate::volume::{Border, FieldMap, FieldMaps, Grid, Volume};

    const VOXEL_M: f64 = 0.01;
    const FRACTION: f64 = 2e-7;
    const KELVIN: f64 = 1700.0;

    /// An even ball of a radius in voxels.
    fn ball(radius: f64) -> Medium {
        let edge = 2 * radius as i32 + 8;
        let middle = DVec3::splat(0.5 * f64::from(edge - 1));
        let grid = |name: &str, inside: f64, outside: f64| {
            Grid::from_fn(
                name,
                IVec3::splat(edge),
                DAffine3::from_scale(DVec3::splat(VOXEL_M)),
                Border::Background,
                outside as f32,
                |voxel| {
                    let within = voxel.as_dvec3().distance(middle) < radius;
                    if within {
                        inside as f32
                    } else {
                        outside as f32
                    }
                },
            )
        };
        let grids = vec![
            grid("soot", FRACTION, 0.0),
            grid("temperature", KELVIN, KELVIN),
        ];
        let maps = FieldMaps {
            soot: Some(FieldMap::new("soot", 1.0, 0.0, 0.0, 1.0)),
            temperature: Some(FieldMap::new("temperature", 1.0, 0.0, 0.0, 1e4)),
            ..FieldMaps::default()
        };
        let volume = Volume::from_grids(grids, "ball");
        pack_for_tests(&volume, &maps, Interpolation::Trilinear).unwrap()
    }

    #[test]
    fn means_hold_all_soot_and_all_light() {
        let medium = ball(30.0);
        let means = of_medium(&medium).bricks;
        let voxels = means.iter().map(|mean| mean.soot).sum::<f64>() / FRACTION
            * (BRICK * BRICK * BRICK) as f64;
        let ball = 4.0 / 3.0 * PI * f64::powi(30.0, 3);
        assert!((voxels / ball - 1.0).abs() < 0.01, "{voxels}, {ball}");
        for (i, &nm) in MEANS_NM.iter().enumerate() {
            let planck = blackbody::spectral_radiance(nm, KELVIN);
            for mean in &means {
                let ratio = mean.glow[i] / (mean.soot * planck);
                assert!((ratio - 1.0).abs() < 1e-5, "{nm} nm: {ratio}");
            }
        }
    }

    #[test]
    fn light_from_all_sides_is_that_of_a_clear_ball() {
        // In the middle of an even clear ball of radius R the mean over all directions is j R, on its rim half of it; the
        // middles of the outermost bricks lie outside.
        let radius = 40.0;
        let medium = ball(radius);
        let means = of_medium(&medium).bricks;
        let planck = blackbody::spectral_radiance(MEANS_NM[1], KELVIN);
        let middle_most = means.iter().map(|mean| mean.glow_around[1]);
        let found = middle_most.fold(0.0, f64::max) / (FRACTION * planck * radius * VOXEL_M);
        assert!((0.9..1.35).contains(&found), "{found}");
        let rim = means.iter().map(|mean| mean.glow_around[1]);
        let rim = rim.fold(f64::INFINITY, f64::min) / (FRACTION * planck * radius * VOXEL_M);
        assert!((0.25..0.7).contains(&rim), "{rim}");
    }

    #[test]
    fn nothing_has_no_means() {
        assert!(of_medium(&crate::scene::packing::empty()).bricks.is_empty());
    }
}
