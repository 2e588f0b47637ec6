//! What a volume may cost, and the checks that stand before every allocation.

use std::path::Path;

use super::VolumeError;
use super::lattice::{BRICK_LEN, IndexBox};

/// What a volume may cost. Nothing is allocated before it was compared with these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Resident bytes of one file's contents and of its grids, each.
    pub max_bytes: u64,
    /// Bricks of 8³ voxels in the bounding box of a grid, stored or not: renderers keep a dense table of them.
    pub max_extent_bricks: u64,
}

impl Default for Limits {
    /// 4 GiB, and 2²⁶ bricks: a box of about 3200³ voxels.
    fn default() -> Self {
        Self {
            max_bytes: 4 << 30,
            max_extent_bricks: 1 << 26,
        }
    }
}

impl Limits {
    /// Refuses what would need more than `max_bytes` resident.
    pub(super) fn check_bytes(
        &self,
        path: &Path,
        what: &str,
        needed: u64,
    ) -> Result<(), VolumeError> {
        if needed <= self.max_bytes {
            return Ok(());
        }
        Err(VolumeError::TooLarge {
            path: path.to_owned(),
            what: what.to_owned(),
            needed,
            limit: self.max_bytes,
            unit: "bytes",
        })
    }

    /// Refuses a box whose dense table of bricks would be too large.
    pub(super) fn check_extent(
        &self,
        path: &Path,
        what: &str,
        bounds: IndexBox,
    ) -> Result<(), VolumeError> {
        let needed = bounds.brick_count();
        if needed <= self.max_extent_bricks {
            return Ok(());
        }
        Err(VolumeError::TooLarge {
            path: path.to_owned(),
            what: what.to_owned(),
            needed,
            limit: self.max_extent_bricks,
            unit: "bricks of 8³ voxels",
        })
    }

    /// How many bricks may be stored.
    pub(super) fn most_bricks(&self) -> u64 {
        self.max_bytes / (BRICK_LEN * 4) as u64
    }

    /// Refuses a number of stored bricks before they are allocated.
    pub(super) fn check_bricks(
        &self,
        path: &Path,
        what: &str,
        bricks: u64,
    ) -> Result<(), VolumeError> {
        self.check_bytes(path, what, bricks.saturating_mul((BRICK_LEN * 4) as u64))
    }
}
