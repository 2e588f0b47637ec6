//! How grids come into being: one brick at a time, with the statistics taken on the way.

use std::sync::OnceLock;

use glam::{DAffine3, IVec3};
use rayon::prelude::*;

use super::grid::{Border, Brick, Grid};
use super::lattice::{BRICK_EDGE, BRICK_LEN, IndexBox, brick_key, offset_in_brick};
use super::watch::{Stretch, Watch};

/// What is known about a grid before its values are.
#[derive(Clone, Debug)]
pub(super) struct GridHead {
    pub name: String,
    pub world_from_index: DAffine3,
    pub border: Border,
    pub background: f32,
    pub stored_as: &'static str,
}

/// Beyond this a value has no meaning in any unit, and one such voxel would spoil the range of its field.
const LARGEST: f32 = 1e20;

/// False for NaN, infinities and absurdly large values.
pub(super) fn is_usable(raw: f32) -> bool {
    raw.abs() <= LARGEST
}

/// Counts of what is worth telling about the values, taken over active voxels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tally {
    bounds: IndexBox,
    range: (f32, f32),
    active: u64,
    /// NaN, infinities and absurdly large values, read as the background.
    unusable: u64,
    negative: u64,
}

impl Tally {
    const EMPTY: Self = Self {
        bounds: IndexBox::EMPTY,
        range: (f32::INFINITY, f32::NEG_INFINITY),
        active: 0,
        unusable: 0,
        negative: 0,
    };

    fn merge(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            range: (
                self.range.0.min(other.range.0),
                self.range.1.max(other.range.1),
            ),
            active: self.active + other.active,
            unusable: self.unusable + other.unusable,
            negative: self.negative + other.negative,
        }
    }

    /// Records one active sample and returns the value to store.
    fn take(&mut self, voxel: IVec3, raw: f32, background: f32) -> f32 {
        self.active += 1;
        self.bounds = self.bounds.union(IndexBox {
            min: voxel,
            max: voxel + IVec3::ONE,
        });
        if !is_usable(raw) {
            self.unusable += 1;
            return background;
        }
        self.negative += u64::from(raw < 0.0);
        self.range = (self.range.0.min(raw), self.range.1.max(raw));
        raw
    }

    /// The flaws of a grid's values, in words.
    pub(super) fn notes(&self, grid: &str, background: f32) -> Vec<String> {
        let mut notes = Vec::new();
        if self.unusable > 0 {
            notes.push(format!(
                "{grid}: NaN, infinity or values beyond 1e20 in {} voxels read as {background}",
                self.unusable
            ));
        }
        if self.negative > 0 {
            notes.push(format!(
                "{grid}: negative values in {} voxels",
                self.negative
            ));
        }
        notes
    }
}

/// A brick on its way into a grid.
pub(super) struct NewBrick {
    coordinate: IVec3,
    /// None where every sample is the background.
    brick: Option<Brick>,
    tally: Tally,
}

impl NewBrick {
    /// A brick from its samples (x fastest); `None` is a voxel without data, read as the background.
    pub(super) fn from_samples(
        coordinate: IVec3,
        background: f32,
        sample: impl Fn(IVec3) -> Option<f32>,
    ) -> Self {
        let mut tally = Tally::EMPTY;
        let mut values = Box::new([background; BRICK_LEN]);
        let origin = coordinate * BRICK_EDGE;
        for (offset, value) in values.iter_mut().enumerate() {
            let local = IVec3::new(
                (offset & 7) as i32,
                (offset >> 3 & 7) as i32,
                (offset >> 6) as i32,
            );
            let voxel = origin + local;
            if let Some(raw) = sample(voxel) {
                *value = tally.take(voxel, raw, background);
            }
        }
        Self {
            coordinate,
            brick: compact(values, background),
            tally,
        }
    }

    /// A brick whose 512 voxels all hold data of one value.
    pub(super) fn constant(coordinate: IVec3, raw: f32, background: f32) -> Self {
        let origin = coordinate * BRICK_EDGE;
        let mut tally = Tally::EMPTY;
        let value = tally.take(origin, raw, background);
        let count = BRICK_LEN as u64;
        tally = Tally {
            bounds: IndexBox {
                min: origin,
                max: origin + IVec3::splat(BRICK_EDGE),
            },
            active: count,
            unusable: tally.unusable * count,
            negative: tally.negative * count,
            ..tally
        };
        Self {
            coordinate,
            brick: (value != background).then_some(Brick::Constant(value)),
            tally,
        }
    }
}

/// The cheapest form of a brick.
fn compact(values: Box<[f32; BRICK_LEN]>, background: f32) -> Option<Brick> {
    let first = values[0];
    if values.iter().any(|value| *value != first) {
        Some(Brick::Dense(values))
    } else {
        (first != background).then_some(Brick::Constant(first))
    }
}

impl Grid {
    /// A grid from bricks in any order. Where a coordinate comes twice, the later brick is kept.
    pub(super) fn from_bricks(head: GridHead, mut bricks: Vec<NewBrick>) -> (Self, Tally) {
        let tally = bricks
            .iter()
            .fold(Tally::EMPTY, |sum, brick| sum.merge(brick.tally));
        // A stable sort of the reversed list puts the later of two doubles first, where dedup keeps it.
        bricks.reverse();
        bricks.sort_by_key(|brick| brick_key(brick.coordinate));
        bricks.dedup_by_key(|brick| brick.coordinate);
        let bricks = bricks
            .into_iter()
            .filter_map(|new| new.brick.map(|brick| (new.coordinate, brick)))
            .collect();
        let range = if tally.range.0 <= tally.range.1 {
            tally.range
        } else {
            (head.background, head.background)
        };
        let grid = Self {
            name: head.name,
            background: head.background,
            border: head.border,
            world_from_index: head.world_from_index,
            bounds: tally.bounds,
            range,
            active_voxels: tally.active,
            stored_as: head.stored_as,
            bulk: OnceLock::new(),
            bricks,
        };
        (grid, tally)
    }

    /// A dense box of samples, `sample(voxel)` for 0 ≤ voxel < dims; the calls run in parallel.
    ///
    /// Once the watch is cancelled bricks are left out: whoever can cancel must check before using the grid.
    pub(super) fn from_box(
        head: GridHead,
        dims: IVec3,
        stretch: Stretch,
        sample: impl Fn(IVec3) -> f32 + Sync,
    ) -> (Self, Tally) {
        let dims = dims.max(IVec3::ZERO);
        let table = dims.map(|d| d.div_euclid(BRICK_EDGE) + i32::from(d % BRICK_EDGE != 0));
        let rows: Vec<(i32, i32)> = (0..table.z)
            .flat_map(|z| (0..table.y).map(move |y| (y, z)))
            .collect();
        let last = dims - IVec3::ONE;
        let (border, background) = (head.border, head.background);
        let counter = stretch.counter(rows.len());
        let bricks = rows
            .into_par_iter()
            .flat_map_iter(|(y, z)| {
                let sample = &sample;
                let width = if counter.goes_on() { table.x } else { 0 };
                (0..width).map(move |x| {
                    let coordinate = IVec3::new(x, y, z);
                    let mut new = NewBrick::from_samples(coordinate, background, |voxel| {
                        voxel.cmple(last).all().then(|| sample(voxel))
                    });
                    if border == Border::Clamp {
                        repeat_edge(&mut new, last, background);
                    }
                    new
                })
            })
            .collect();
        Self::from_bricks(head, bricks)
    }

    /// A dense grid computed voxel by voxel.
    ///
    /// `sample` is called once for every voxel 0 ≤ (x, y, z) < `dims`, from many threads; what is not finite
    /// is stored as `background`. `world_from_index` must be invertible. A `dims` below 1 gives an empty grid.
    pub fn from_fn(
        name: &str,
        dims: IVec3,
        world_from_index: DAffine3,
        border: Border,
        background: f32,
        sample: impl Fn(IVec3) -> f32 + Sync,
    ) -> Self {
        let head = GridHead {
            name: name.to_owned(),
            world_from_index,
            border,
            background,
            stored_as: "computed",
        };
        Self::from_box(head, dims, Watch::default().whole(), sample).0
    }

    /// A dense grid from its samples, x fastest, then y, then z. Samples that are missing at the end of
    /// `values` read as `background`.
    pub fn from_dense(
        name: &str,
        dims: IVec3,
        values: &[f32],
        world_from_index: DAffine3,
        border: Border,
        background: f32,
    ) -> Self {
        Self::from_fn(name, dims, world_from_index, border, background, |voxel| {
            dense_sample(values, dims, voxel).unwrap_or(background)
        })
    }
}

/// The sample of a voxel in a dense array, x fastest; the voxel must lie in 0..dims.
pub(super) fn dense_sample(values: &[f32], dims: IVec3, voxel: IVec3) -> Option<f32> {
    let (x, y, z) = (voxel.x as usize, voxel.y as usize, voxel.z as usize);
    values
        .get(x + dims.x as usize * (y + dims.y as usize * z))
        .copied()
}

/// Fills the samples of an edge brick that lie beyond `last` with the nearest sample inside.
fn repeat_edge(new: &mut NewBrick, last: IVec3, background: f32) {
    let origin = new.coordinate * BRICK_EDGE;
    if (origin + IVec3::splat(BRICK_EDGE - 1)).cmple(last).all() {
        return;
    }
    let Some(Brick::Dense(values)) = &mut new.brick else {
        // A constant brick stays constant, and a background brick is background to its edge.
        return;
    };
    for offset in 0..BRICK_LEN {
        let local = IVec3::new(
            (offset & 7) as i32,
            (offset >> 3 & 7) as i32,
            (offset >> 6) as i32,
        );
        let inside = (origin + local).min(last);
        values[offset] = values[offset_in_brick(inside)];
    }
    let values = std::mem::replace(values, Box::new([0.0; BRICK_LEN]));
    new.brick = compact(values, background);
}
