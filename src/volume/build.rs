//! How grids come into being from bricks, and from boxes of samples.

use std::sync::OnceLock;

use glam::{DAffine3, IVec3};
use rayon::prelude::*;

use super::grid::{Border, Brick, Grid};
use super::lattice::{BRICK_EDGE, brick_key};
use super::watch::{Counter, Stretch, Watch};

pub(super) use super::new_brick::{NewBrick, Tally, is_usable};

/// What is known about a grid before its values are.
#[derive(Clone, Debug)]
pub(super) struct GridHead {
    pub name: String,
    pub world_from_index: DAffine3,
    pub border: Border,
    pub background: f32,
    pub stored_as: &'static str,
}

/// Bricks that are not all background, in any order, with the counts of them all.
#[derive(Default)]
pub(super) struct Gathered {
    tally: Tally,
    bricks: Vec<(IVec3, Brick)>,
}

impl Gathered {
    /// The counts of all bricks that were gathered.
    pub(super) fn tally(&self) -> &Tally {
        &self.tally
    }

    /// These and one more, of a coordinate that has not come yet.
    pub(super) fn with(mut self, new: NewBrick) -> Self {
        self.tally = self.tally.merge(new.tally);
        let kept = new.brick.map(|brick| (new.coordinate, brick));
        self.bricks.extend(kept);
        self
    }

    /// These and others.
    pub(super) fn and(mut self, mut others: Self) -> Self {
        self.tally = self.tally.merge(others.tally);
        self.bricks.append(&mut others.bricks);
        self
    }
}

impl Grid {
    /// A grid from bricks in any order. Where a coordinate comes twice, the later brick is kept.
    pub(super) fn from_bricks(head: GridHead, mut bricks: Vec<NewBrick>) -> (Self, Tally) {
        let tally = Tally::of(&bricks);
        // A stable sort of the reversed list puts the later of two doubles first, where dedup keeps it.
        bricks.reverse();
        bricks.par_sort_by_key(|brick| brick_key(brick.coordinate));
        bricks.dedup_by_key(|brick| brick.coordinate);
        let gathered = bricks.into_iter().fold(Gathered::default(), Gathered::with);
        // Doubles count twice, as they stand in the file.
        Self::from_gathered(head, Gathered { tally, ..gathered })
    }

    /// A grid from bricks no two of which have the same coordinate.
    pub(super) fn from_gathered(head: GridHead, gathered: Gathered) -> (Self, Tally) {
        let Gathered { tally, mut bricks } = gathered;
        bricks.par_sort_unstable_by_key(|(coordinate, _)| brick_key(*coordinate));
        bricks.shrink_to_fit();
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
        let table = bricks_of(dims);
        let counter = stretch.counter(table.y as usize * table.z as usize);
        let last = dims - IVec3::ONE;
        let background = head.background;
        let gathered = dense_bricks(&head, dims, 0..table.z, &counter, |coordinate| {
            NewBrick::from_samples(coordinate, background, |voxel| {
                voxel.cmple(last).all().then(|| sample(voxel))
            })
        });
        Self::from_gathered(head, gathered)
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
            let (x, y, z) = (voxel.x as usize, voxel.y as usize, voxel.z as usize);
            let sample = values.get(x + dims.x as usize * (y + dims.y as usize * z));
            sample.copied().unwrap_or(background)
        })
    }
}

/// Bricks along each axis of a dense box.
pub(super) fn bricks_of(dims: IVec3) -> IVec3 {
    dims.map(|d| d.div_euclid(BRICK_EDGE) + i32::from(d % BRICK_EDGE != 0))
}

/// The (y, z) of the rows of bricks in some layers of a table.
fn rows_of_bricks(table: IVec3, layers: std::ops::Range<i32>) -> Vec<(i32, i32)> {
    layers
        .flat_map(|z| (0..table.y).map(move |y| (y, z)))
        .collect()
}

/// Some layers of the bricks of a dense box, made in parallel; none of a row that the counter does not let begin.
pub(super) fn dense_bricks(
    head: &GridHead,
    dims: IVec3,
    layers: std::ops::Range<i32>,
    counter: &Counter<'_>,
    make: impl Fn(IVec3) -> NewBrick + Sync,
) -> Gathered {
    let table = bricks_of(dims);
    let last = dims - IVec3::ONE;
    let (border, background) = (head.border, head.background);
    rows_of_bricks(table, layers)
        .into_par_iter()
        .flat_map_iter(|(y, z)| {
            let make = &make;
            let width = if counter.goes_on() { table.x } else { 0 };
            (0..width).map(move |x| {
                let mut new = make(IVec3::new(x, y, z));
                if border == Border::Clamp {
                    new.repeat_edge(last, background);
                }
                new
            })
        })
        .fold(Gathered::default, Gathered::with)
        .reduce(Gathered::default, Gathered::and)
}
