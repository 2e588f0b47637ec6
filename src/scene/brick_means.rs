//! What a medium holds and sends out, by means over eighths of bricks, from which bounds are worked out.
//!
//! A mean is of all samples of a part, so no light of the file is missed however thin a sheet it comes from. What comes to
//! a place from the whole fire is summed over blocks of parts as if nothing stood in the way:
//!
//! ```text
//! G(x) = 1/(4π) Σ_b E_b V_b/|x − x_b|²,   E_b r_b for the block itself, r_b the radius of the ball of its volume
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | E_b | mean of f_v B(λ, T) in a block, or of the flame field | W m⁻² sr⁻¹ nm⁻¹, 1 |
//! | V_b | volume of its parts | m³ |
//! | G | mean over all directions of what arrives, for a unit of absorption for each f_v | the same times m |
//!
//! No law of soot is in it: it is worked out once for each packed medium. For a ball of even light the block's own term is
//! exact in its middle, and what other blocks send is right from afar; beside each other blocks are off by up to a third.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec3, UVec3};
use rayon::prelude::*;

use super::means::{Lamp, MEANS, MEANS_NM, Means, PART_EDGE, PARTS, PartMean};
use super::medium::{BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};
use crate::math::lanes::{self, Arithmetic, Kernel};
use crate::physics::blackbody;

/// Most blocks between which light is summed up.
const MOST_BLOCKS: usize = 1000;

impl Medium {
    /// Means over the parts of each stored brick, worked out when they are asked for first.
    pub(crate) fn means(&self) -> &Means {
        self.means.get_or_init(|| of_medium(self))
    }
}

/// The means of a medium.
fn of_medium(medium: &Medium) -> Means {
    let samples = medium.samples.par_chunks_exact(BRICK_SAMPLES);
    let mut parts: Vec<PartMean> = samples
        .enumerate()
        .flat_map_iter(|(slot, samples)| {
            let own = slot * BRICK_SAMPLES..(slot + 1) * BRICK_SAMPLES;
            let glows = glows(samples);
            let steepest = steepest(samples) / medium.voxel_size_m;
            (0..PARTS).map(move |part| {
                let beside = |field: &[f32]| {
                    let field = field.get(own.clone());
                    field.map_or(0.0, |field| mean_of(field, part))
                };
                PartMean {
                    burning: beside(&medium.flame),
                    smoke: beside(&medium.smoke),
                    steepest,
                    ..of_samples(samples, glows.as_deref(), part)
                }
            })
        })
        .collect();
    let blocks = Blocks::new(medium, parts.len());
    let lamps = blocks.lamps(&parts);
    blocks.light_around(&mut parts);
    Means { parts, lamps }
}

/// The samples of a part of a brick, and how much each counts: those on a face belong to two parts, on an edge to four.
static WEIGHTS: LazyLock<[Vec<(usize, f32)>; PARTS]> = LazyLock::new(|| {
    let of_part = |part: usize| {
        let first = [part & 1, part >> 1 & 1, part >> 2].map(|half| half * PART_EDGE);
        let edge = PART_EDGE + 1;
        let sample = |i: usize| {
            let within = [i % edge, i / edge % edge, i / (edge * edge)];
            let half = |at: usize| if at == 0 || at == PART_EDGE { 0.5 } else { 1.0 };
            let weight: f32 = within.map(half).into_iter().product();
            let [x, y, z] = [0, 1, 2].map(|axis| first[axis] + within[axis]);
            let voxels = (PART_EDGE * PART_EDGE * PART_EDGE) as f32;
            ((z * SAMPLES + y) * SAMPLES + x, weight / voxels)
        };
        (0..edge * edge * edge).map(sample).collect()
    };
    std::array::from_fn(of_part)
});

fn mean_of(field: &[f32], part: usize) -> f64 {
    let shares = WEIGHTS[part].iter().map(|&(i, w)| field[i] * w);
    f64::from(shares.sum::<f32>())
}

/// f_v B over the first radiation constant by λ⁵, of each sample of a brick at each wavelength.
type Glows = [[f32; BRICK_SAMPLES]; MEANS];

/// Of a brick; `None` where it has no soot.
fn glows(samples: &[[f32; 2]]) -> Option<Box<Glows>> {
    if samples.iter().all(|sample| sample[0] <= 0.0) {
        return None;
    }
    let mut glows = Box::new([[0.0; BRICK_SAMPLES]; MEANS]);
    lanes::dispatch(Glowing {
        samples,
        glows: &mut glows,
    });
    Some(glows)
}

struct Glowing<'a> {
    samples: &'a [[f32; 2]],
    glows: &'a mut Glows,
}

impl Kernel for Glowing<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        for (glow, nm) in self.glows.iter_mut().zip(*MEANS_NM) {
            let exponent = (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32;
            for (glow, [fraction, kelvin]) in glow.iter_mut().zip(self.samples) {
                *glow = fraction.max(0.0) * lanes::inverse_exp_m1_by::<A>(exponent / kelvin);
            }
        }
    }
}

fn of_samples(samples: &[[f32; 2]], glows: Option<&Glows>, part: usize) -> PartMean {
    let hottest = |hottest: f32, &(i, _): &(usize, f32)| hottest.max(samples[i][1]);
    let mut mean = PartMean {
        hottest_k: f64::from(WEIGHTS[part].iter().fold(0.0, hottest)),
        ..PartMean::default()
    };
    let Some(glows) = glows else {
        return mean;
    };
    let mut soot = 0.0_f32;
    let [mut heat, mut squares] = [0.0_f64; 2];
    for &(i, w) in &WEIGHTS[part] {
        let [fraction, kelvin] = samples[i];
        let share = w * fraction.max(0.0);
        soot += share;
        let (share, kelvin) = (f64::from(share), f64::from(kelvin));
        heat += share * kelvin;
        squares += share * kelvin * kelvin;
    }
    if soot <= 0.0 {
        return mean;
    }
    let soot = f64::from(soot);
    let even = heat / soot;
    let cool = even - (squares / soot - even * even).max(0.0).sqrt();
    mean.soot = soot;
    mean.glow = std::array::from_fn(|i| {
        let scale = blackbody::FIRST_RADIATION_CONSTANT / MEANS_NM[i].powi(5);
        scale * mean_of(&glows[i], part)
    });
    if cool > 1.0 {
        mean.dim = MEANS_NM.map(|nm| soot * blackbody::spectral_radiance(nm, cool));
    }
    mean
}

/// Largest difference of 1/T between samples that follow each other, 1/K.
fn steepest(samples: &[[f32; 2]]) -> f64 {
    let inverse: Vec<f32> = samples.iter().map(|sample| 1.0 / sample[1]).collect();
    let mut most = 0.0_f32;
    for stride in [1, SAMPLES, SAMPLES * SAMPLES] {
        // Rows of so many samples have a next one each, along this axis.
        for slab in inverse.chunks_exact(stride * SAMPLES) {
            for (one, next) in slab.iter().zip(&slab[stride..]) {
                most = most.max((one - next).abs());
            }
        }
    }
    // Along three axes at once.
    3.0_f64.sqrt() * f64::from(most)
}

/// Parts of bricks taken together.
struct Blocks {
    /// Block of each part.
    of_part: Vec<usize>,
    /// Middle of the parts of each, m, and their volume, m³.
    middles: Vec<DVec3>,
    volumes_m3: Vec<f64>,
}

impl Blocks {
    fn new(medium: &Medium, parts: usize) -> Self {
        let world_from_lattice = medium.lattice_from_world.inverse();
        let part_m3 = (PART_EDGE as f64 * medium.voxel_size_m).powi(3);
        let [width, height, _] = medium.bricks.to_array().map(|side| side as usize);
        let brick = |i: usize| {
            UVec3::from([i % width, i / width % height, i / (width * height)].map(|at| at as u32))
        };
        let mut edge = 1;
        loop {
            let counts = (2 * medium.bricks)
                .map(|side| side.div_ceil(edge))
                .as_usizevec3();
            let mut number = vec![usize::MAX; counts.x * counts.y * counts.z];
            let mut blocks = Self {
                of_part: vec![0; parts],
                middles: Vec::new(),
                volumes_m3: Vec::new(),
            };
            let stored = medium
                .table
                .iter()
                .enumerate()
                .filter(|(_, slot)| **slot != NO_BRICK);
            for ((i, &slot), part) in
                stored.flat_map(|brick| (0..PARTS).map(move |part| (brick, part)))
            {
                let half = UVec3::from([part & 1, part >> 1 & 1, part >> 2].map(|at| at as u32));
                let place = 2 * brick(i) + half;
                let at = (place / edge).as_usizevec3();
                let number = &mut number[(at.z * counts.y + at.y) * counts.x + at.x];
                if *number == usize::MAX {
                    *number = blocks.middles.len();
                    blocks.middles.push(DVec3::ZERO);
                    blocks.volumes_m3.push(0.0);
                }
                blocks.of_part[slot as usize * PARTS + part] = *number;
                let middle = (place.as_dvec3() + 0.5) * PART_EDGE as f64;
                blocks.middles[*number] += world_from_lattice.transform_point3(middle) * part_m3;
                blocks.volumes_m3[*number] += part_m3;
            }
            if blocks.middles.len() <= MOST_BLOCKS {
                let volumes = blocks.middles.iter_mut().zip(&blocks.volumes_m3);
                volumes.for_each(|(middle, volume)| *middle /= *volume);
                return blocks;
            }
            edge *= 2;
        }
    }

    /// Sums of N numbers of each part over each block, times the volume.
    fn summed<const N: usize>(
        &self,
        means: &[PartMean],
        of: impl Fn(&PartMean) -> [f64; N],
    ) -> Vec<[f64; N]> {
        let mut sums = vec![[0.0; N]; self.middles.len()];
        let part_m3 = self.volumes_m3.iter().sum::<f64>() / means.len().max(1) as f64;
        for (mean, &block) in means.iter().zip(&self.of_part) {
            for (sum, value) in sums[block].iter_mut().zip(of(mean)) {
                *sum += part_m3 * value;
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
    fn lamps(&self, means: &[PartMean]) -> Vec<Lamp> {
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
    fn light_around(&self, means: &mut [PartMean]) {
        let fresh = self.around(&self.summed(means, |mean| {
            let [a, b, c, d] = mean.glow;
            [a, b, c, d, mean.burning]
        }));
        for (mean, &block) in means.iter_mut().zip(&self.of_part) {
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
        for (mean, &block) in means.iter_mut().zip(&self.of_part) {
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
        let means = of_medium(&medium).parts;
        let voxels = means.iter().map(|mean| mean.soot).sum::<f64>() / FRACTION
            * (PART_EDGE * PART_EDGE * PART_EDGE) as f64;
        let ball = 4.0 / 3.0 * PI * f64::powi(30.0, 3);
        assert!((voxels / ball - 1.0).abs() < 0.01, "{voxels}, {ball}");
        for (i, &nm) in MEANS_NM.iter().enumerate() {
            let planck = blackbody::spectral_radiance(nm, KELVIN);
            for mean in means.iter().filter(|mean| mean.soot > 0.0) {
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
        let means = of_medium(&medium).parts;
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
        assert!(of_medium(&crate::scene::packing::empty()).parts.is_empty());
    }
}
