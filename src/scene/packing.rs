//! From named grids and their mappings to a [`Medium`]: the only place that reads a volume's voxels.

use std::sync::OnceLock;

use glam::{DAffine3, DVec3, IVec3, UVec3};
use rayon::prelude::*;
use thiserror::Error;

use super::interpolation::Interpolation;
use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, Peaks, Sample};
use super::source::Source;
use crate::math::Aabb;
use crate::volume::{Border, FieldMaps, Limits, Volume};

mod layout;
mod shown;

use layout::Layout;

/// The coldest temperature stored, K: Planck's radiance at 1 K is zero in f32, and 1/T stays finite.
const COLDEST_K: f64 = 1.0;

/// Least volume fraction that is packed, 1e-31: less is none. A kilometre of it is 3e-21 optical depths, and glows with
/// 2e-12 cd/m² at 5000 K; even with the largest amount, 1e4, that is a fiftieth of the faintest that an eye can see (1e-6
/// cd/m²). Its share in a cell, of which an f32 tells 2⁻²³ at least, is no denormal number: many processors are slow at those.
const LEAST_FRACTION: f32 = f32::MIN_POSITIVE / f32::EPSILON;

/// Temperatures between which gas without a flame field is taken to begin to burn, K: hydrocarbon flames go out when
/// they are colder than about 1600 K (R. F. Simmons and H. G. Wolfhard, Combust. Flame 1 (1957) 155).
pub(super) const BURNING_K: [f64; 2] = [1600.0, 2000.0];

/// Why fields cannot be packed side by side.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum PackingError {
    /// The box around what shows is too wide for a table of bricks.
    #[error(
        "the fields that show together span {:.0} × {:.0} × {:.0} voxels, more than a table of {limit} bricks of 8³ holds: \
         switch one of them off (an empty volume.smoke.grid or volume.flame.grid, effects.lines=off), or crop the volume",
        .voxels[0], .voxels[1], .voxels[2]
    )]
    TooWide {
        /// Voxels of the packed lattice along each axis.
        voxels: [f64; 3],
        /// Most bricks of the table.
        limit: u64,
    },
    /// The bricks in which something shows need too much memory.
    #[error(
        "what shows fills {bricks} bricks, {} MB when packed, more than {} MB: does an offset or a min above zero \
         fill the air with soot, or heat it until its salt glows? If it is as it should be, raise volume.memory_limit_mb \
         to {} and open it again",
        .bytes >> 20, .limit >> 20, .bytes.div_ceil(1_000_000)
    )]
    TooLarge {
        /// Bricks in which something shows.
        bricks: u64,
        /// What they need.
        bytes: u64,
        /// What they may need.
        limit: u64,
    },
}

/// What is packed: fields with their mappings and weights.
pub(super) struct Fields<'a> {
    pub(super) volume: &'a Volume,
    pub(super) maps: &'a FieldMaps,
    /// Weights of soot and smoke.
    pub(super) amounts: [f64; 2],
    /// Temperature where there is no such field, K.
    pub(super) ambient_k: f64,
    /// What of the gas must be there beside soot.
    pub(super) gas: GasFields,
    /// Whether it must be known which part of the soot is smoke.
    pub(super) smoke_apart: bool,
    /// How values between samples will be formed.
    pub(super) interpolation: Interpolation,
}

/// What of the gas is packed beside soot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct GasFields {
    /// Whether burning gas glows, and what says where it burns.
    pub(super) burning: Option<Burning>,
    /// Temperature above which gas glows by its heat, K: bricks without soot are stored where it is hotter.
    pub(super) hot_above_k: Option<f64>,
    /// Temperature above which gas bends light, K: bricks without soot are stored where it is hotter, and where the
    /// gradient reaches that hotter gas has beside it.
    pub(super) bends_above_k: Option<f64>,
}

/// What says where gas burns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Burning {
    /// The flame field.
    Field,
    /// The temperature, for want of a flame field: see [`BURNING_K`].
    Temperature,
}

impl Fields<'_> {
    /// Whether [`Fields::pack`] keeps to the limits.
    ///
    /// # Errors
    /// The fields lie too far apart, or fill too many bricks.
    pub(super) fn check(&self, limits: &Limits) -> Result<(), PackingError> {
        Layout::new(self, limits).map(|_| ())
    }

    /// Packs soot, smoke, temperature and what of the gas glows. The lattice is that of the soot's grid (or the next
    /// one's where there is no soot); other fields are resampled onto it where their transforms differ.
    ///
    /// # Errors
    /// As [`Fields::check`].
    pub(super) fn pack(
        &self,
        world_from_file: &DAffine3,
        limits: &Limits,
    ) -> Result<Medium, PackingError> {
        let Some(layout) = Layout::new(self, limits)? else {
            return Ok(empty());
        };
        let Layout {
            reference,
            ref absorbers,
            voxels: [min, max],
            origin,
            bricks,
            ref occupied,
            ..
        } = layout;
        let temperature = Source::new(self.volume, self.maps.temperature.as_ref(), reference, 1.0);
        let flame = Source::new(self.volume, self.maps.flame.as_ref(), reference, 1.0);
        let ambient = [0.0, self.ambient_k.max(COLDEST_K) as f32];
        let count = occupied.len() * BRICK_SAMPLES;
        let mut samples: Vec<Sample> = vec![ambient; count];
        let first = |brick: &UVec3| origin + brick.as_ivec3() * BRICK as i32;
        samples
            .par_chunks_exact_mut(BRICK_SAMPLES)
            .zip(occupied)
            .for_each(|(samples, brick)| {
                pack_brick(absorbers, temperature.as_ref(), first(brick), samples);
            });
        let mut burning = vec![0.0; if self.gas.burning.is_some() { count } else { 0 }];
        burning
            .par_chunks_exact_mut(BRICK_SAMPLES)
            .zip(samples.par_chunks_exact(BRICK_SAMPLES))
            .zip(occupied)
            .for_each(|((burning, samples), brick)| match self.gas.burning {
                Some(Burning::Temperature) => burn_by_heat(samples, burning),
                _ => read_flame(flame.as_ref(), first(brick), burning),
            });

        let smoke = layout::absorber(self, self.maps.smoke.as_ref(), self.amounts[1], reference)
            .filter(|_| self.smoke_apart);
        let mut of_smoke = vec![0.0; if smoke.is_some() { count } else { 0 }];
        if let Some(smoke) = &smoke {
            of_smoke
                .par_chunks_exact_mut(BRICK_SAMPLES)
                .zip(occupied)
                .for_each(|(of_smoke, brick)| {
                    smoke.for_each_sample(first(brick), |i, value| of_smoke[i] = told(value));
                });
        }

        let reach = match reference.border() {
            Border::Clamp => 0.5,
            Border::Background => f64::from(self.interpolation.reach()),
        };
        let to_lattice = DAffine3::from_translation(-origin.as_dvec3());
        let world_from_lattice =
            *world_from_file * reference.world_from_index() * to_lattice.inverse();
        let mut medium = Medium {
            lattice_from_world: world_from_lattice.inverse(),
            domain: Aabb {
                min: (min - origin).as_dvec3() - reach,
                max: (max - 1 - origin).as_dvec3() + reach,
            },
            data: Aabb {
                min: (min - origin).as_dvec3(),
                max: (max - 1 - origin).as_dvec3(),
            },
            bricks,
            table: vec![NO_BRICK; bricks.as_u64vec3().element_product() as usize],
            samples,
            flame: burning,
            smoke: of_smoke,
            voxel_size_m: world_from_lattice.matrix3.determinant().abs().cbrt(),
            interpolation: self.interpolation,
            ..empty()
        };
        medium.keep_what_shows(occupied, self.gas);
        Ok(medium)
    }
}

/// A volume fraction as it is packed.
fn told(fraction: f64) -> f32 {
    let fraction = fraction as f32;
    if fraction < LEAST_FRACTION {
        0.0
    } else {
        fraction
    }
}

/// Fills a brick's samples, which come as ambient air; the first is voxel `first`.
fn pack_brick(
    absorbers: &[Source<'_>],
    temperature: Option<&Source<'_>>,
    first: IVec3,
    samples: &mut [Sample],
) {
    for source in absorbers {
        source.for_each_sample(first, |i, value| samples[i][0] += told(value));
    }
    if let Some(temperature) = temperature {
        temperature.for_each_sample(first, |i, value| {
            samples[i][1] = value.max(COLDEST_K) as f32;
        });
    }
}

/// Fills a brick's flame field from its grid; 0 without one.
fn read_flame(flame: Option<&Source<'_>>, first: IVec3, burning: &mut [f32]) {
    if let Some(flame) = flame {
        flame.for_each_sample(first, |i, value| burning[i] = value.clamp(0.0, 1.0) as f32);
    }
}

/// Fills a brick's flame field from its temperatures.
fn burn_by_heat(samples: &[Sample], burning: &mut [f32]) {
    let [from, to] = BURNING_K.map(|kelvin| kelvin as f32);
    for (burning, sample) in burning.iter_mut().zip(samples) {
        let t = ((sample[1] - from) / (to - from)).clamp(0.0, 1.0);
        *burning = t * t * (3.0 - 2.0 * t);
    }
}

/// A medium in which nothing shows.
pub(super) fn empty() -> Medium {
    Medium {
        lattice_from_world: DAffine3::IDENTITY,
        domain: Aabb {
            min: DVec3::ZERO,
            max: DVec3::ZERO,
        },
        data: Aabb {
            min: DVec3::ZERO,
            max: DVec3::ZERO,
        },
        bricks: UVec3::ZERO,
        table: Vec::new(),
        samples: Vec::new(),
        flame: Vec::new(),
        smoke: Vec::new(),
        voxel_size_m: 1.0,
        interpolation: Interpolation::default(),
        peaks: Peaks::default(),
        means: OnceLock::new(),
        cuts: OnceLock::new(),
        sooty: 0,
        shown: 0,
    }
}

#[cfg(test)]
mod tests;
