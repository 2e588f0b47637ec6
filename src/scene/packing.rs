//! From named grids and their mappings to a [`Medium`]: the only place that reads a volume's voxels.

use glam::{DAffine3, DVec3, IVec3, UVec3};
use rayon::prelude::*;

use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES, Sample};
use crate::math::Aabb;
use crate::volume::{Border, BrickRef, FieldMap, FieldMaps, Grid, Volume, brick_of};

/// A field as the packing reads it: a grid, its mapping, and how its lattice lies to the packed one.
struct Source<'a> {
    grid: &'a Grid,
    map: &'a FieldMap,
    /// `None` where the grid's own indices are the lattice's (up to an offset): values are copied, not resampled.
    index_from_reference: Option<DAffine3>,
    /// Multiplies the mapped value.
    amount: f64,
}

impl<'a> Source<'a> {
    fn new(
        volume: &'a Volume,
        map: Option<&'a FieldMap>,
        reference: &Grid,
        amount: f64,
    ) -> Option<Self> {
        let map = map?;
        let grid = volume.grid(&map.grid)?;
        let index_from_reference = grid.world_from_index().inverse() * reference.world_from_index();
        let aligned = index_from_reference.abs_diff_eq(DAffine3::IDENTITY, 1e-6);
        Some(Self {
            grid,
            map,
            index_from_reference: (!aligned).then_some(index_from_reference),
            amount,
        })
    }

    /// The physical values of a brick's samples, the first at voxel `first` of the reference lattice.
    fn read(&self, first: IVec3) -> impl Fn(IVec3) -> f64 {
        // The brick and its upper neighbours, found once for all of their samples.
        let corner = brick_of(first);
        let near: [BrickRef<'_>; 8] = std::array::from_fn(|i| {
            let i = i as i32;
            self.grid
                .brick(corner + IVec3::new(i & 1, i >> 1 & 1, i >> 2))
        });
        move |voxel| {
            let raw = if let Some(index) = &self.index_from_reference {
                self.grid
                    .sample_trilinear(index.transform_point3(voxel.as_dvec3()))
            } else {
                let voxel = self.grid.bordered(voxel);
                let offset = brick_of(voxel) - corner;
                if offset.cmpge(IVec3::ZERO).all() && offset.cmple(IVec3::ONE).all() {
                    f64::from(near[(offset.x + 2 * offset.y + 4 * offset.z) as usize].value(voxel))
                } else {
                    f64::from(self.grid.value(voxel))
                }
            };
            self.amount * self.map.apply(raw)
        }
    }

    /// What the field is where the grid says nothing.
    fn ambient(&self) -> f64 {
        self.amount * self.map.apply(f64::from(self.grid.background()))
    }

    /// This grid's box in reference voxels.
    fn bounds(&self) -> (IVec3, IVec3) {
        let bounds = self.grid.bounds();
        match &self.index_from_reference {
            None => (bounds.min, bounds.max),
            Some(index) => {
                let cells = Aabb {
                    min: bounds.min.as_dvec3(),
                    max: bounds.max.as_dvec3(),
                };
                let hull = cells.transformed(&index.inverse());
                (
                    hull.min.floor().as_ivec3() - 1,
                    hull.max.ceil().as_ivec3() + 1,
                )
            }
        }
    }

    /// Visits the reference-voxel boxes in which this field may be above zero.
    fn for_each_occupied(&self, mut visit: impl FnMut(IVec3, IVec3)) {
        if self.index_from_reference.is_some() || self.ambient() > 0.0 {
            let (min, max) = self.bounds();
            visit(min, max);
            return;
        }
        let edge = BRICK as i32;
        for (brick, values) in self.grid.bricks() {
            let occupied = match values {
                BrickRef::Constant(value) => self.map.apply(f64::from(value)) > 0.0,
                BrickRef::Dense(values) => values
                    .iter()
                    .any(|&value| self.map.apply(f64::from(value)) > 0.0),
            };
            if occupied {
                visit(brick * edge, (brick + 1) * edge);
            }
        }
    }
}

/// The coldest temperature stored, K: Planck's radiance at 1 K is zero in f32, and 1/T stays finite.
const COLDEST_K: f64 = 1.0;

/// Packs a volume's soot, smoke and temperature. `smoke_amount` weighs the smoke against the soot;
/// `ambient_k` stands in where there is no temperature field.
///
/// The lattice is that of the soot's grid (or the smoke's where there is no soot); other fields are resampled
/// onto it where their transforms differ.
pub(super) fn pack(
    volume: &Volume,
    maps: &FieldMaps,
    soot_amount: f64,
    smoke_amount: f64,
    ambient_k: f64,
    world_from_file: &DAffine3,
) -> Medium {
    let grid_of = |map: &Option<FieldMap>| map.as_ref().and_then(|map| volume.grid(&map.grid));
    let Some(reference) = grid_of(&maps.soot).or_else(|| grid_of(&maps.smoke)) else {
        return empty();
    };
    let absorbers: Vec<Source<'_>> = [(&maps.soot, soot_amount), (&maps.smoke, smoke_amount)]
        .into_iter()
        .filter(|&(_, amount)| amount > 0.0)
        .filter_map(|(map, amount)| Source::new(volume, map.as_ref(), reference, amount))
        .filter(|source| !source.grid.bounds().is_empty())
        .collect();
    let temperature = Source::new(volume, maps.temperature.as_ref(), reference, 1.0);
    if absorbers.is_empty() {
        return empty();
    }

    // One layer around the voxels, from a brick's border on: what trilinear interpolation reaches.
    let (min, max) = absorbers
        .iter()
        .map(Source::bounds)
        .fold((IVec3::MAX, IVec3::MIN), |hull, (min, max)| {
            (hull.0.min(min), hull.1.max(max))
        });
    let edge = BRICK as i32;
    let origin = (min - 1).div_euclid(IVec3::splat(edge)) * edge;
    let bricks = ((max + 1 - origin + edge - 1) / edge).as_uvec3();

    let occupied = occupied_bricks(&absorbers, origin, bricks);
    let packed: Vec<[Sample; BRICK_SAMPLES]> = occupied
        .par_iter()
        .map(|&brick| {
            pack_brick(
                &absorbers,
                temperature.as_ref(),
                ambient_k,
                origin + brick.as_ivec3() * edge,
            )
        })
        .collect();

    let reach = match reference.border() {
        Border::Clamp => 0.5,
        Border::Background => 1.0,
    };
    let to_lattice = DAffine3::from_translation(-origin.as_dvec3());
    let world_from_lattice = *world_from_file * reference.world_from_index() * to_lattice.inverse();
    let mut medium = Medium {
        lattice_from_world: world_from_lattice.inverse(),
        domain: Aabb {
            min: (min - origin).as_dvec3() - reach,
            max: (max - 1 - origin).as_dvec3() + reach,
        },
        bricks,
        table: vec![NO_BRICK; bricks.as_u64vec3().element_product() as usize],
        samples: Vec::with_capacity(packed.len() * BRICK_SAMPLES),
        voxel_size_m: world_from_lattice.matrix3.determinant().abs().cbrt(),
        peak_volume_fraction: 0.0,
        peak_temperature_k: 0.0,
    };
    for (&brick, samples) in occupied.iter().zip(&packed) {
        let sooty = samples.iter().filter(|sample| sample[0] > 0.0);
        let peaks = sooty.fold([0.0_f32; 2], |peak, s| {
            [peak[0].max(s[0]), peak[1].max(s[1])]
        });
        // A candidate that turned out clear (a brick beside one with soot only in its far corner) is left out.
        if peaks[0] == 0.0 {
            continue;
        }
        medium.peak_volume_fraction = medium.peak_volume_fraction.max(peaks[0]);
        medium.peak_temperature_k = medium.peak_temperature_k.max(peaks[1]);
        let index = medium.brick_index(brick);
        medium.table[index] = (medium.samples.len() / BRICK_SAMPLES) as u32;
        medium.samples.extend_from_slice(samples);
    }
    medium
}

/// Bricks that any absorber may reach with a sample, in the order of the table.
fn occupied_bricks(absorbers: &[Source<'_>], origin: IVec3, bricks: UVec3) -> Vec<UVec3> {
    let count = bricks.as_u64vec3().element_product() as usize;
    let mut marks = vec![false; count];
    let edge = IVec3::splat(BRICK as i32);
    for source in absorbers {
        source.for_each_occupied(|min, max| {
            // A brick at 8b holds samples 8b to 8b + 8, so a voxel on a border is in two of them.
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

fn pack_brick(
    absorbers: &[Source<'_>],
    temperature: Option<&Source<'_>>,
    ambient_k: f64,
    first: IVec3,
) -> [Sample; BRICK_SAMPLES] {
    let mut samples = [[0.0, ambient_k.max(COLDEST_K) as f32]; BRICK_SAMPLES];
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
    samples
}

/// A medium without any soot.
fn empty() -> Medium {
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
