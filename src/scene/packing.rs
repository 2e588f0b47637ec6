//! From named grids and their mappings to a [`Medium`]: the only place that reads a volume's voxels.

use glam::{DAffine3, DVec3, IVec3, UVec3};
use rayon::prelude::*;
use thiserror::Error;

use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES, Sample};
use super::source::Source;
use crate::math::Aabb;
use crate::volume::{Border, FieldMap, FieldMaps, Grid, Limits, Volume};

/// The coldest temperature stored, K: Planck's radiance at 1 K is zero in f32, and 1/T stays finite.
const COLDEST_K: f64 = 1.0;

/// Why fields cannot be packed side by side.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum PackingError {
    /// The box around soot and smoke is too wide for a table of bricks.
    #[error(
        "soot and smoke together span {:.0} × {:.0} × {:.0} voxels, more than a table of {limit} bricks of 8³ holds: \
         switch one of them off (an empty volume.smoke.grid), or crop the volume",
        .voxels[0], .voxels[1], .voxels[2]
    )]
    TooWide {
        /// Voxels of the soot's grid along each axis.
        voxels: [f64; 3],
        /// Most bricks of the table.
        limit: u64,
    },
    /// The bricks that hold soot need too much memory.
    #[error(
        "soot and smoke fill {bricks} bricks, {} MB when packed, more than {} MB: does an offset or a min above zero \
         fill the air with soot?",
        .bytes >> 20, .limit >> 20
    )]
    TooLarge {
        /// Bricks with soot.
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
}

/// Where bricks go, before any is made.
struct Layout<'a> {
    reference: &'a Grid,
    absorbers: Vec<Source<'a>>,
    /// Box of the voxels, min inside, max outside.
    voxels: [IVec3; 2],
    /// First voxel of the lattice, on a brick's border.
    origin: IVec3,
    bricks: UVec3,
    occupied: Vec<UVec3>,
}

impl Fields<'_> {
    /// Whether [`Fields::pack`] keeps to the limits.
    ///
    /// # Errors
    /// The fields lie too far apart, or fill too many bricks.
    pub(super) fn check(&self, limits: &Limits) -> Result<(), PackingError> {
        self.layout(limits).map(|_| ())
    }

    /// `None` if there is nothing to pack.
    fn layout(&self, limits: &Limits) -> Result<Option<Layout<'_>>, PackingError> {
        let Self {
            volume,
            maps,
            amounts,
            ..
        } = *self;
        let grid_of = |map: &Option<FieldMap>| map.as_ref().and_then(|map| volume.grid(&map.grid));
        let Some(reference) = grid_of(&maps.soot).or_else(|| grid_of(&maps.smoke)) else {
            return Ok(None);
        };
        let absorbers: Vec<Source<'_>> = [(&maps.soot, amounts[0]), (&maps.smoke, amounts[1])]
            .into_iter()
            .filter(|&(_, amount)| amount > 0.0)
            .filter_map(|(map, amount)| Source::new(volume, map.as_ref(), reference, amount))
            .filter(Source::has_data)
            .collect();
        if absorbers.is_empty() {
            return Ok(None);
        }
        // In f64, where grids that lie far apart do not overflow.
        let hull = absorbers
            .iter()
            .fold(Aabb::EMPTY, |hull, source| hull.union(&source.bounds()));
        let edge = BRICK as f64;
        let across = hull.size() / edge + 3.0;
        let widest = 2_f64.powi(29);
        let fits = across.element_product() <= limits.max_extent_bricks as f64;
        // A hull that is not a number, of transforms beyond f64, does not fit either.
        if !fits || hull.min.min_element() < -widest || hull.max.max_element() > widest {
            return Err(PackingError::TooWide {
                voxels: hull.size().to_array(),
                limit: limits.max_extent_bricks,
            });
        }

        // One layer around the voxels, from a brick's border on: what trilinear interpolation reaches.
        let (min, max) = (hull.min.as_ivec3(), hull.max.as_ivec3());
        let edge = BRICK as i32;
        let origin = (min - 1).div_euclid(IVec3::splat(edge)) * edge;
        let bricks = ((max + 1 - origin + edge - 1) / edge).as_uvec3();
        let occupied = occupied_bricks(&absorbers, origin, bricks);
        let bytes = (occupied.len() * BRICK_SAMPLES * size_of::<Sample>()) as u64;
        if bytes > limits.max_bytes {
            return Err(PackingError::TooLarge {
                bricks: occupied.len() as u64,
                bytes,
                limit: limits.max_bytes,
            });
        }
        Ok(Some(Layout {
            reference,
            absorbers,
            voxels: [min, max],
            origin,
            bricks,
            occupied,
        }))
    }

    /// Packs soot, smoke and temperature. The lattice is that of the soot's grid (or the smoke's where there is no
    /// soot); other fields are resampled onto it where their transforms differ.
    ///
    /// # Errors
    /// As [`Fields::check`].
    pub(super) fn pack(
        &self,
        world_from_file: &DAffine3,
        limits: &Limits,
    ) -> Result<Medium, PackingError> {
        let Some(layout) = self.layout(limits)? else {
            return Ok(empty());
        };
        let Layout {
            reference,
            absorbers,
            voxels: [min, max],
            origin,
            bricks,
            occupied,
        } = layout;
        let temperature = Source::new(self.volume, self.maps.temperature.as_ref(), reference, 1.0);
        let ambient = [0.0, self.ambient_k.max(COLDEST_K) as f32];
        let mut samples: Vec<Sample> = vec![ambient; occupied.len() * BRICK_SAMPLES];
        samples
            .par_chunks_exact_mut(BRICK_SAMPLES)
            .zip(&occupied)
            .for_each(|(samples, brick)| {
                let first = origin + brick.as_ivec3() * BRICK as i32;
                pack_brick(&absorbers, temperature.as_ref(), first, samples);
            });

        let reach = match reference.border() {
            Border::Clamp => 0.5,
            Border::Background => 1.0,
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
            bricks,
            table: vec![NO_BRICK; bricks.as_u64vec3().element_product() as usize],
            samples,
            voxel_size_m: world_from_lattice.matrix3.determinant().abs().cbrt(),
            peak_volume_fraction: 0.0,
            peak_temperature_k: 0.0,
        };
        medium.keep_sooty(&occupied);
        Ok(medium)
    }
}

impl Medium {
    /// Enters the packed bricks into the table, closing the gaps of those that turned out clear (a brick beside one
    /// with soot only in its far corner), and notes the peaks.
    fn keep_sooty(&mut self, packed: &[UVec3]) {
        let mut kept = 0;
        for (i, &brick) in packed.iter().enumerate() {
            let own = i * BRICK_SAMPLES..(i + 1) * BRICK_SAMPLES;
            let sooty = self.samples[own.clone()]
                .iter()
                .filter(|sample| sample[0] > 0.0);
            let peaks = sooty.fold([0.0_f32; 2], |peak, s| {
                [peak[0].max(s[0]), peak[1].max(s[1])]
            });
            if peaks[0] == 0.0 {
                continue;
            }
            self.peak_volume_fraction = self.peak_volume_fraction.max(peaks[0]);
            self.peak_temperature_k = self.peak_temperature_k.max(peaks[1]);
            self.samples.copy_within(own, kept * BRICK_SAMPLES);
            let index = self.brick_index(brick);
            self.table[index] = kept as u32;
            kept += 1;
        }
        self.samples.truncate(kept * BRICK_SAMPLES);
        self.samples.shrink_to_fit();
    }
}

/// Bricks that any absorber may reach with a sample, in the order of the table.
fn occupied_bricks(absorbers: &[Source<'_>], origin: IVec3, bricks: UVec3) -> Vec<UVec3> {
    let count = bricks.as_u64vec3().element_product() as usize;
    let mut marks = vec![false; count];
    let edge = IVec3::splat(BRICK as i32);
    for source in absorbers {
        source.for_each_occupied(|voxels| {
            // A brick at 8b holds samples 8b to 8b + 8, so a voxel on a border is in two of them.
            let (min, max) = (voxels.min.as_ivec3(), voxels.max.as_ivec3());
            let first = (min - 1 - origin).div_euclid(edge).max(IVec3::ZERO);
            let last = (max - origin).div_euclid(edge).min(bricks.as_ivec3() - 1);
            for z in first.z..=last.z {
                for y in first.y..=last.y {
                    for x in first.x..=last.x {
                        let row = z as usize * bricks.y as usize + y as usize;
                        marks[row * bricks.x as usize + x as usize] = true;
                    }
                }
            }
        });
    }
    let (width, height) = (bricks.x as usize, bricks.y as usize);
    let position = |i: usize| {
        UVec3::new(
            (i % width) as u32,
            (i / width % height) as u32,
            (i / width / height) as u32,
        )
    };
    (0..count).filter(|&i| marks[i]).map(position).collect()
}

/// Fills a brick's samples, which come as ambient air; the first is voxel `first`.
fn pack_brick(
    absorbers: &[Source<'_>],
    temperature: Option<&Source<'_>>,
    first: IVec3,
    samples: &mut [Sample],
) {
    let edge = SAMPLES as i32;
    let mut fill = |field: &dyn Fn(IVec3, &mut Sample)| {
        for (i, sample) in samples.iter_mut().enumerate() {
            let i = i as i32;
            field(
                first + IVec3::new(i % edge, i / edge % edge, i / (edge * edge)),
                sample,
            );
        }
    };
    for source in absorbers {
        let value = source.read(first);
        fill(&|voxel, sample| sample[0] += value(voxel) as f32);
    }
    if let Some(temperature) = temperature {
        let value = temperature.read(first);
        fill(&|voxel, sample| sample[1] = value(voxel).max(COLDEST_K) as f32);
    }
}

/// A medium without any soot.
pub(super) fn empty() -> Medium {
    Medium {
        lattice_from_world: DAffine3::IDENTITY,
        domain: Aabb {
            min: DVec3::ZERO,
            max: DVec3::ZERO,
        },
        bricks: UVec3::ZERO,
        table: Vec::new(),
        samples: Vec::new(),
        voxel_size_m: 1.0,
        peak_volume_fraction: 0.0,
        peak_temperature_k: 0.0,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// Two single voxels, `apart` voxels apart, in a grid each with its own voxel size.
    fn far(apart: f64, second_scale: f64) -> Volume {
        let grid = |name: &str, shift: f64, scale: f64| {
            let world = DAffine3::from_translation(DVec3::splat(shift))
                * DAffine3::from_scale(DVec3::splat(scale));
            Grid::from_fn(name, IVec3::ONE, world, Border::Background, 0.0, |_| 1e-6)
        };
        Volume::from_grids(
            vec![grid("soot", 0.0, 1.0), grid("smoke", apart, second_scale)],
            "far",
        )
    }

    fn maps(offset: f64) -> FieldMaps {
        let map = |grid: &str| Some(FieldMap::new(grid, 1.0, offset, 0.0, 1.0));
        FieldMaps {
            soot: map("soot"),
            smoke: map("smoke"),
            ..FieldMaps::default()
        }
    }

    fn packed(volume: &Volume, maps: &FieldMaps, limits: &Limits) -> Result<Medium, PackingError> {
        let fields = Fields {
            volume,
            maps,
            amounts: [1.0, 1.0],
            ambient_k: 300.0,
        };
        assert_eq!(
            fields.check(limits).err(),
            fields.pack(&DAffine3::IDENTITY, limits).err()
        );
        fields.pack(&DAffine3::IDENTITY, limits)
    }

    #[test]
    fn fields_far_apart_are_packed_sparsely_or_refused() {
        let limits = Limits::default();
        let medium = packed(&far(1600.0, 1.0), &maps(0.0), &limits).unwrap();
        assert!(medium.occupancy().0 <= 16);
        for (apart, scale) in [(1e5, 1.0), (1e12, 1.0), (0.0, 1e12), (1e15, 1e-3)] {
            let refused = packed(&far(apart, scale), &maps(0.0), &limits)
                .err()
                .unwrap();
            assert!(
                matches!(refused, PackingError::TooWide { .. }),
                "{apart} {scale}: {refused}"
            );
        }
    }

    #[test]
    fn soot_in_all_of_the_air_is_refused_before_it_is_allocated() {
        let dot = |voxel: IVec3| if voxel == IVec3::splat(30) { 1e-6 } else { 0.0 };
        let dims = IVec3::splat(64);
        let grid = Grid::from_fn(
            "soot",
            dims,
            DAffine3::IDENTITY,
            Border::Background,
            0.0,
            dot,
        );
        let volume = Volume::from_grids(vec![grid], "dot");
        let limits = Limits {
            max_bytes: 1 << 20,
            ..Limits::default()
        };
        assert!(packed(&volume, &maps(0.0), &limits).is_ok());
        let refused = packed(&volume, &maps(1e-9), &limits).err().unwrap();
        assert!(
            matches!(refused, PackingError::TooLarge { bricks: 1000, .. }),
            "{refused}"
        );
        assert!(refused.to_string().contains("offset"), "{refused}");
    }

    #[test]
    fn a_resampled_field_lies_where_the_file_puts_it() {
        // The same ball of smoke on the soot's own lattice and on one of half the voxel size, shifted.
        let ball = |world: DAffine3| {
            move |voxel: IVec3| {
                let point = world.transform_point3(voxel.as_dvec3());
                (1e-6 * (1.0 - (point - 10.0).length() / 6.0)).max(0.0) as f32
            }
        };
        let coarse = DAffine3::IDENTITY;
        let fine = DAffine3::from_scale(DVec3::splat(0.5))
            * DAffine3::from_translation(DVec3::splat(0.37));
        let grid = |name: &str, dims: i32, world: DAffine3| {
            Grid::from_fn(
                name,
                IVec3::splat(dims),
                world,
                Border::Background,
                0.0,
                ball(world),
            )
        };
        let nothing = Grid::from_fn(
            "soot",
            IVec3::splat(20),
            coarse,
            Border::Background,
            0.0,
            |_| 0.0,
        );
        let smoke = |world, dims| {
            let nothing = nothing.clone();
            let volume = Volume::from_grids(vec![nothing, grid("smoke", dims, world)], "ball");
            packed(&volume, &maps(0.0), &Limits::default()).unwrap()
        };
        let (own, resampled) = (smoke(coarse, 20), smoke(fine, 40));
        for point in [
            DVec3::splat(10.0),
            DVec3::new(7.3, 11.2, 9.9),
            DVec3::new(12.5, 12.5, 8.0),
        ] {
            let at = |medium: &Medium| {
                medium.sample(medium.lattice_from_world.transform_point3(point))[0]
            };
            // Both are the cone's trilinear interpolant; half a voxel of its slope is the most they differ.
            assert!((at(&own) - at(&resampled)).abs() < 0.5e-6 / 6.0, "{point}");
            assert!(at(&own) > 1e-8);
        }
    }
}
