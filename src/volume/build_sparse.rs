//! Sparse grids from lists of voxels.

use std::path::Path;

use glam::IVec3;
use rayon::prelude::*;

use super::build::{GridHead, NewBrick, Tally};
use super::grid::Grid;
use super::lattice::{BRICK_LEN, IndexBox, brick_key, brick_of, offset_in_brick};
use super::watch::Stretch;
use super::{Limits, VolumeError};

/// A voxel and its value.
type Voxel = (IVec3, f32);

/// Share of the time that sorting voxels takes.
const SORTING: f32 = 0.7;
/// Share of the sorting after which the voxels lie in their heaps.
const HEAPED: f32 = 0.5;
/// Most heaps, as a power of two: a heap is sorted without a look at the watch.
const HEAP_BITS: u32 = 12;
/// Voxels that are moved between two looks at the watch.
const VOXELS_PER_LOOK: usize = 1 << 14;

impl Grid {
    /// A sparse grid from voxels in any order, with the number of voxels that came more than once: the last
    /// value of a voxel is kept.
    ///
    /// # Errors
    /// [`VolumeError::TooLarge`], before bricks are allocated; [`VolumeError::Cancelled`]. Coordinates must lie
    /// within `MAX_COORDINATE`.
    pub(super) fn from_voxels(
        head: GridHead,
        voxels: Vec<Voxel>,
        path: &Path,
        limits: &Limits,
        stretch: Stretch,
    ) -> Result<(Self, Tally, u64), VolumeError> {
        let bounds = voxels.iter().fold(IndexBox::EMPTY, |bounds, (voxel, _)| {
            bounds.union(IndexBox {
                min: *voxel,
                max: *voxel + IVec3::ONE,
            })
        });
        limits.check_extent(path, "the box of its voxels", bounds)?;
        let voxels = sorted_by_brick(voxels, bounds, stretch.part(0.0, SORTING))?;
        let building = stretch.part(SORTING, 1.0);
        let runs: Vec<&[Voxel]> = voxels
            .chunk_by(|a, b| brick_of(a.0) == brick_of(b.0))
            .collect();
        building.reach(0, 1)?;
        limits.check_bricks(path, "the grid", runs.len() as u64)?;
        let background = head.background;
        let counter = building.counter(runs.len());
        let bricks: Vec<(NewBrick, u64)> = runs
            .into_par_iter()
            .map(|run| {
                if !counter.goes_on() {
                    return Err(VolumeError::Cancelled);
                }
                let mut values = [None; BRICK_LEN];
                let mut repeated = 0u64;
                for (voxel, value) in run {
                    let slot = &mut values[offset_in_brick(*voxel)];
                    repeated += u64::from(slot.is_some());
                    *slot = Some(*value);
                }
                let coordinate = brick_of(run[0].0);
                let brick = NewBrick::from_samples(coordinate, background, |voxel| {
                    values[offset_in_brick(voxel)]
                });
                Ok((brick, repeated))
            })
            .collect::<Result<_, _>>()?;
        let repeated = bricks.iter().map(|(_, repeated)| repeated).sum();
        let bricks = bricks.into_iter().map(|(brick, _)| brick).collect();
        let (grid, tally) = Self::from_bricks(head, bricks);
        Ok((grid, tally, repeated))
    }
}

/// Voxels in the order of their bricks; those of one brick, and so doubles, keep the order of the file.
///
/// One sort of them all could not be cancelled for seconds. So the box is cut, in the order of its bricks, into heaps
/// that are sorted one by one.
fn sorted_by_brick(
    voxels: Vec<Voxel>,
    bounds: IndexBox,
    stretch: Stretch,
) -> Result<Vec<Voxel>, VolumeError> {
    if bounds.is_empty() {
        return Ok(voxels);
    }
    let heaping = stretch.part(0.0, HEAPED);
    let corner = brick_of(bounds.min);
    let table = brick_of(bounds.max - IVec3::ONE) - corner + IVec3::ONE;
    let shift = (u64::BITS - bounds.brick_count().leading_zeros()).saturating_sub(HEAP_BITS);
    let heap_of = |voxel: IVec3| {
        let [x, y, z] = (brick_of(voxel) - corner).to_array().map(|c| c as u64);
        let [width, height] = [table.x as u64, table.y as u64];
        // Where the table has more bricks than can be counted, the last heap takes the rest.
        let place = (z.saturating_mul(height).saturating_add(y))
            .saturating_mul(width)
            .saturating_add(x);
        (place >> shift) as usize
    };

    let all = voxels.len() as u64;
    let mut sizes = vec![0usize; 1 << HEAP_BITS];
    for some in voxels.chunks(VOXELS_PER_LOOK) {
        heaping.check()?;
        for (voxel, _) in some {
            sizes[heap_of(*voxel)] += 1;
        }
    }
    let mut begin = 0;
    let mut next: Vec<usize> = sizes
        .iter()
        .map(|size| {
            begin += size;
            begin - size
        })
        .collect();
    let mut heaped = vec![(IVec3::ZERO, 0.0); voxels.len()];
    for (look, some) in voxels.chunks(VOXELS_PER_LOOK).enumerate() {
        heaping.reach((look * VOXELS_PER_LOOK) as u64, all)?;
        for voxel in some {
            let place = &mut next[heap_of(voxel.0)];
            heaped[*place] = *voxel;
            *place += 1;
        }
    }
    drop(voxels);

    let mut rest = heaped.as_mut_slice();
    let heaps: Vec<&mut [Voxel]> = sizes
        .into_iter()
        .map(|size| rest.split_off_mut(..size).unwrap_or_default())
        .collect();
    let counter = stretch.part(HEAPED, 1.0).counter(heaps.len());
    heaps.into_par_iter().for_each(|heap| {
        if counter.goes_on() {
            // The sort is stable.
            heap.sort_by_key(|(voxel, _)| brick_key(brick_of(*voxel)));
        }
    });
    stretch.check()?;
    Ok(heaped)
}

/// Says how often a voxel came again.
pub(super) fn repeated_note(repeated: u64) -> Option<String> {
    (repeated > 0)
        .then(|| format!("{repeated} voxels came more than once: the last value was kept"))
}
