//! A scalar grid in memory: sorted bricks of 8³ single-precision samples.
//!
//! A brick that holds one value costs a few bytes; a brick that holds only the background is not stored at
//! all. Sample i sits at index position i; [`Grid::world_from_index`] takes index positions to the world of
//! the file. Values outside the stored bricks follow [`Border`].

use std::sync::OnceLock;

use glam::{DAffine3, DVec3, IVec3};

use super::lattice::{
    BRICK_EDGE, BRICK_LEN, IndexBox, MAX_COORDINATE, brick_key, brick_of, offset_in_brick,
};

/// Share of a field's greatest departure from its background that counts as its bulk: a wisp of 2 % is hardly
/// seen beside the body of a fire.
pub(super) const BULK: f32 = 0.02;

/// What lies outside the stored voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// The nearest voxel of the bounds is repeated: dense formats, whose box cuts the field.
    Clamp,
    /// The background value: sparse formats, where an absent voxel is ambient.
    Background,
}

/// The samples of one brick, x fastest, then y, then z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BrickRef<'a> {
    /// All 512 samples have this value.
    Constant(f32),
    /// The samples one by one.
    Dense(&'a [f32; BRICK_LEN]),
}

impl BrickRef<'_> {
    /// The sample of a voxel, which must lie in this brick.
    pub fn value(&self, voxel: IVec3) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Dense(values) => values[offset_in_brick(voxel)],
        }
    }
}

#[derive(Clone, Debug)]
pub(super) enum Brick {
    Constant(f32),
    Dense(Box<[f32; BRICK_LEN]>),
}

/// A named scalar field on a regular lattice, in the units of its file.
///
/// Every stored value is finite. Under [`Border::Clamp`] the samples of an edge brick that lie outside the
/// bounds repeat the edge, so a brick can be packed as it is.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The name in the file, or the one its reader gave it.
    pub name: String,
    pub(super) background: f32,
    pub(super) border: Border,
    pub(super) world_from_index: DAffine3,
    pub(super) bounds: IndexBox,
    pub(super) range: (f32, f32),
    pub(super) active_voxels: u64,
    pub(super) stored_as: &'static str,
    /// Sorted by `brick_key`, without doubles and without background bricks.
    pub(super) bricks: Vec<(IVec3, Brick)>,
    /// See [`Grid::bulk`].
    pub(super) bulk: OnceLock<IndexBox>,
}

impl Grid {
    /// The voxels that hold data. A dense format holds data everywhere in its box; a sparse one in its
    /// active voxels. A grid without data has an empty box.
    pub fn bounds(&self) -> IndexBox {
        self.bounds
    }

    /// The box of the field's bulk: voxels that depart from the background by more than `BULK` of the greatest
    /// departure. Empty for a field that is background everywhere. Found at the first call, then remembered.
    pub fn bulk(&self) -> IndexBox {
        *self.bulk.get_or_init(|| {
            let departure = |value: f32| (value - self.background).abs();
            let least = BULK * departure(self.range.0).max(departure(self.range.1));
            let differs = |value: f32| departure(value) > least;
            self.bricks()
                .fold(IndexBox::EMPTY, |hull, (brick, values)| {
                    let first = brick * BRICK_EDGE;
                    match values {
                        BrickRef::Constant(value) if !differs(value) => hull,
                        BrickRef::Constant(_) => hull.union(
                            IndexBox {
                                min: first,
                                max: first + BRICK_EDGE,
                            }
                            .within(self.bounds),
                        ),
                        BrickRef::Dense(values) => {
                            let lit = values
                                .iter()
                                .enumerate()
                                .filter(|&(_, &value)| differs(value));
                            let voxels = lit.map(|(i, _)| {
                                let i = i as i32;
                                first
                                    + IVec3::new(i, i / BRICK_EDGE, i / (BRICK_EDGE * BRICK_EDGE))
                                        % BRICK_EDGE
                            });
                            let inside = voxels.fold(IndexBox::EMPTY, |hull, voxel| {
                                hull.union(IndexBox {
                                    min: voxel,
                                    max: voxel + 1,
                                })
                            });
                            hull.union(inside.within(self.bounds))
                        }
                    }
                })
        })
    }

    /// Value of absent voxels, in file units.
    pub fn background(&self) -> f32 {
        self.background
    }

    /// What lies outside the stored voxels.
    pub fn border(&self) -> Border {
        self.border
    }

    /// Takes index positions to the world units of the file (not yet metres): the sample of voxel i sits at
    /// `world_from_index * i`. Always invertible.
    pub fn world_from_index(&self) -> DAffine3 {
        self.world_from_index
    }

    /// Edge lengths of a voxel in file units.
    pub fn voxel_size(&self) -> DVec3 {
        let m = self.world_from_index.matrix3;
        DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length())
    }

    /// Lowest and highest value of the voxels that hold data. The background twice when there is none.
    pub fn range(&self) -> (f32, f32) {
        self.range
    }

    /// Number of voxels that hold data.
    pub fn active_voxels(&self) -> u64 {
        self.active_voxels
    }

    /// Resident size in bytes.
    pub fn bytes(&self) -> u64 {
        let dense = self
            .bricks
            .iter()
            .filter(|(_, brick)| matches!(brick, Brick::Dense(_)))
            .count();
        (self.bricks.len() * size_of::<(IVec3, Brick)>() + dense * BRICK_LEN * size_of::<f32>())
            as u64
    }

    /// How the values were stored: "half", "float", "double", "ascii" or "computed".
    pub fn stored_as(&self) -> &str {
        self.stored_as
    }

    /// The stored bricks by z, then y, then x, each with its brick coordinate (voxel coordinate / 8, rounded
    /// down). What is not listed is background.
    pub fn bricks(&self) -> impl ExactSizeIterator<Item = (IVec3, BrickRef<'_>)> {
        self.bricks.iter().map(|(coordinate, brick)| {
            let samples = match brick {
                Brick::Constant(value) => BrickRef::Constant(*value),
                Brick::Dense(values) => BrickRef::Dense(values),
            };
            (*coordinate, samples)
        })
    }

    /// The brick at a brick coordinate (voxel coordinate / 8, rounded down); background where none is stored.
    /// The border is not honoured.
    pub fn brick(&self, coordinate: IVec3) -> BrickRef<'_> {
        let key = brick_key(coordinate);
        match self
            .bricks
            .binary_search_by_key(&key, |(c, _)| brick_key(*c))
        {
            Err(_) => BrickRef::Constant(self.background),
            Ok(found) => match &self.bricks[found].1 {
                Brick::Constant(value) => BrickRef::Constant(*value),
                Brick::Dense(values) => BrickRef::Dense(values),
            },
        }
    }

    /// The voxel whose sample stands for this one: the nearest in the box where the border clamps, itself
    /// elsewhere.
    pub fn bordered(&self, voxel: IVec3) -> IVec3 {
        match self.border {
            Border::Clamp if !self.bounds.is_empty() => {
                voxel.clamp(self.bounds.min, self.bounds.max - IVec3::ONE)
            }
            _ => voxel,
        }
    }

    /// The sample of one voxel, honouring the border.
    pub fn value(&self, voxel: IVec3) -> f32 {
        let voxel = self.bordered(voxel);
        self.brick(brick_of(voxel)).value(voxel)
    }

    /// The trilinear value at an index position, where sample i sits at index position i. For tests and
    /// probes; the march packs bricks instead.
    pub fn sample_trilinear(&self, index_position: DVec3) -> f64 {
        let limit = MAX_COORDINATE as f64;
        let position = index_position.clamp(DVec3::splat(-limit), DVec3::splat(limit));
        let floor = position.floor();
        let fraction = position - floor;
        let base = floor.as_ivec3();
        let mut sum = 0.0;
        for corner in 0..8 {
            let step = IVec3::new(corner & 1, (corner >> 1) & 1, corner >> 2);
            let upper = step.as_dvec3();
            let weight = upper * fraction + (DVec3::ONE - upper) * (DVec3::ONE - fraction);
            sum += weight.element_product() * f64::from(self.value(base + step));
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(border: Border) -> Grid {
        let dims = IVec3::new(11, 3, 9);
        Grid::from_fn("ramp", dims, DAffine3::IDENTITY, border, 0.0, |v| {
            (1 + v.x + 20 * v.y + 100 * v.z) as f32
        })
    }

    #[test]
    fn trilinear_sampling_reproduces_a_linear_field() {
        let grid = ramp(Border::Background);
        let position = DVec3::new(7.25, 1.5, 6.75);
        let expected = 1.0 + position.dot(DVec3::new(1.0, 20.0, 100.0));
        assert!((grid.sample_trilinear(position) - expected).abs() < 1e-9);
    }

    #[test]
    fn outside_is_the_edge_or_the_background() {
        assert_eq!(ramp(Border::Background).value(IVec3::new(-1, 0, 0)), 0.0);
        let clamped = ramp(Border::Clamp);
        assert_eq!(clamped.value(IVec3::new(-5, 9, 0)), 41.0);
        assert_eq!(
            clamped.sample_trilinear(DVec3::new(1e300, f64::MIN, 0.0)),
            11.0
        );
    }

    #[test]
    fn edge_bricks_of_a_clamped_grid_repeat_the_edge() {
        let grid = ramp(Border::Clamp);
        for (coordinate, samples) in grid.bricks() {
            let BrickRef::Dense(values) = samples else {
                panic!("a ramp has no constant brick");
            };
            let voxel = coordinate * BRICK_EDGE + IVec3::splat(7);
            assert_eq!(values[BRICK_LEN - 1], grid.value(voxel), "{coordinate}");
        }
    }

    #[test]
    fn constant_and_background_bricks_are_cheap() {
        let dims = IVec3::splat(64);
        let grid = |value: f32| {
            Grid::from_fn("c", dims, DAffine3::IDENTITY, Border::Clamp, 0.0, |_| value)
        };
        assert_eq!(grid(0.0).bytes(), 0);
        assert!(grid(5.0).bytes() < 512 * 64);
        assert_eq!(grid(0.0).bounds().dims(), dims);
        assert_eq!(grid(5.0).active_voxels(), 64 * 64 * 64);
    }

    #[test]
    fn bricks_come_in_the_order_of_a_dense_table() {
        let grid = ramp(Border::Background);
        let order: Vec<[i32; 3]> = grid.bricks().map(|(c, _)| c.to_array()).collect();
        assert_eq!(order, [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]);
    }

    #[test]
    fn what_is_not_finite_is_stored_as_background() {
        let values = [1.0, f32::NAN, f32::INFINITY, 3.0];
        let dims = IVec3::new(4, 1, 1);
        let grid = Grid::from_dense("n", dims, &values, DAffine3::IDENTITY, Border::Clamp, 2.0);
        assert_eq!(grid.value(IVec3::X), 2.0);
        assert_eq!(grid.range(), (1.0, 3.0));
    }

    #[test]
    fn a_box_counts_the_bricks_it_touches() {
        let bounds = |min, max| IndexBox {
            min: IVec3::splat(min),
            max: IVec3::splat(max),
        };
        assert_eq!(bounds(0, 8).brick_count(), 1);
        assert_eq!(bounds(-1, 9).brick_count(), 27);
        assert_eq!(IndexBox::EMPTY.brick_count(), 0);
    }
}
