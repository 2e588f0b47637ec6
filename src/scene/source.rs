//! A field as the packing reads it: a grid, its mapping, and how its lattice lies to the packed one.

use glam::{DAffine3, IVec3};

use super::medium::{BRICK, BRICK_SAMPLES, SAMPLES};
use crate::math::Aabb;
use crate::volume::{BrickRef, FieldMap, Grid, Volume, brick_of};

/// A grid with its mapping, seen from the lattice of a reference grid.
pub(super) struct Source<'a> {
    grid: &'a Grid,
    map: &'a FieldMap,
    /// `None` where the grid's indices are the reference's own: values are copied, not resampled.
    index_from_reference: Option<DAffine3>,
    /// Multiplies the mapped value.
    amount: f64,
}

impl<'a> Source<'a> {
    /// `None` if the field has no mapping or no such grid.
    pub(super) fn new(
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

    /// Whether the grid holds any data.
    pub(super) fn has_data(&self) -> bool {
        !self.grid.bounds().is_empty()
    }

    /// Visits the physical values of a brick's samples, x fastest; the first is voxel `first` of the reference lattice, which
    /// lies on a brick's border.
    pub(super) fn for_each_sample(&self, first: IVec3, mut visit: impl FnMut(usize, f64)) {
        let edge = SAMPLES as i32;
        let physical = |raw: f64| self.amount * self.map.apply(raw);
        let mut one_by_one = |raw: &dyn Fn(IVec3) -> f64| {
            for i in 0..BRICK_SAMPLES {
                let at = i as i32;
                let step = IVec3::new(at % edge, at / edge % edge, at / (edge * edge));
                visit(i, physical(raw(first + step)));
            }
        };
        if let Some(index) = &self.index_from_reference {
            let at = |voxel: IVec3| index.transform_point3(voxel.as_dvec3());
            return one_by_one(&|voxel| self.grid.sample_trilinear(at(voxel)));
        }
        let last = first + IVec3::splat(edge - 1);
        if self.grid.bordered(first) != first || self.grid.bordered(last) != last {
            return one_by_one(&|voxel| f64::from(self.grid.value(voxel)));
        }
        // The brick and its upper neighbours, found once for all of their samples; rows of them are copied.
        let corner = brick_of(first);
        let near: [BrickRef<'_>; 8] = std::array::from_fn(|i| {
            let i = i as i32;
            self.grid
                .brick(corner + IVec3::new(i & 1, (i >> 1) & 1, i >> 2))
        });
        let mut row = [0.0; SAMPLES];
        for number in 0..SAMPLES * SAMPLES {
            let [y, z] = [number % SAMPLES, number / SAMPLES];
            let brick = 2 * (y / BRICK) + 4 * (z / BRICK);
            let begin = BRICK * (y % BRICK + BRICK * (z % BRICK));
            match near[brick] {
                BrickRef::Constant(value) => row[..BRICK].fill(f64::from(value)),
                BrickRef::Dense(values) => {
                    let values = &values[begin..begin + BRICK];
                    for (raw, value) in row.iter_mut().zip(values) {
                        *raw = f64::from(*value);
                    }
                }
            }
            row[BRICK] = f64::from(match near[brick + 1] {
                BrickRef::Constant(value) => value,
                BrickRef::Dense(values) => values[begin],
            });
            for (x, raw) in row.into_iter().enumerate() {
                visit(number * SAMPLES + x, physical(raw));
            }
        }
    }

    /// What the field is where the grid says nothing.
    fn ambient(&self) -> f64 {
        self.amount * self.map.apply(f64::from(self.grid.background()))
    }

    /// This grid's box in reference voxels, min inside, max outside.
    pub(super) fn bounds(&self) -> Aabb {
        let bounds = self.grid.bounds();
        self.in_reference(bounds.min, bounds.max)
    }

    fn in_reference(&self, min: IVec3, max: IVec3) -> Aabb {
        let own = Aabb {
            min: min.as_dvec3(),
            max: max.as_dvec3(),
        };
        match &self.index_from_reference {
            None => own,
            Some(index) => {
                // A resampled voxel reaches one voxel of its own grid further.
                let reach = Aabb {
                    min: own.min - 1.0,
                    max: own.max + 1.0,
                };
                let hull = reach.transformed(&index.inverse());
                Aabb {
                    min: hull.min.floor(),
                    max: hull.max.ceil(),
                }
            }
        }
    }

    /// Visits the boxes of reference voxels (min inside, max outside) in which this field may be above a threshold.
    pub(super) fn for_each_above(&self, threshold: f64, mut visit: impl FnMut(Aabb)) {
        if self.ambient() > threshold {
            visit(self.bounds());
            return;
        }
        let edge = BRICK as i32;
        for (brick, values) in self.grid.bricks() {
            let above = |value: f32| self.amount * self.map.apply(f64::from(value)) > threshold;
            let occupied = match values {
                BrickRef::Constant(value) => above(value),
                BrickRef::Dense(values) => values.iter().copied().any(above),
            };
            if occupied {
                visit(self.in_reference(brick * edge, (brick + 1) * edge));
            }
        }
    }
}
