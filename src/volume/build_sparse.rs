//! Sparse grids from lists of voxels.

use std::path::Path;

use glam::IVec3;
use rayon::prelude::*;

use super::build::{GridHead, NewBrick, Tally};
use super::grid::Grid;
use super::lattice::{BRICK_EDGE, BRICK_LEN, IndexBox, brick_key, offset_in_brick};
use super::watch::Stretch;
use super::{Limits, VolumeError};

/// Share of the time that sorting voxels takes.
const SORTING: f32 = 0.5;

impl Grid {
    /// A sparse grid from voxels in any order, with the number of voxels that came more than once: the last
    /// value of a voxel is kept.
    ///
    /// # Errors
    /// [`VolumeError::TooLarge`], before bricks are allocated; [`VolumeError::Cancelled`]. Coordinates must lie within `MAX_COORDINATE`.
    pub(super) fn from_voxels(
        head: GridHead,
        mut voxels: Vec<(IVec3, f32)>,
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
        let brick_of = |voxel: IVec3| voxel.map(|c| c.div_euclid(BRICK_EDGE));
        let building = stretch.part(SORTING, 1.0);
        // The sort is stable: doubles keep the order of the file.
        voxels.par_sort_by_key(|(voxel, _)| brick_key(brick_of(*voxel)));
        let runs: Vec<&[(IVec3, f32)]> = voxels
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

/// Says how often a voxel came again.
pub(super) fn repeated_note(repeated: u64) -> Option<String> {
    (repeated > 0)
        .then(|| format!("{repeated} voxels came more than once: the last value was kept"))
}
