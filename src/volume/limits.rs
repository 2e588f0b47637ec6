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

/// Least and most megabytes (10⁶ bytes) that a person can allow.
pub const MEMORY_LIMIT_MB: [f64; 2] = [16.0, 1e6];

/// Share of the memory that pays for a brick of the box, stored or not: a table has 4 bytes for each, and what is
/// computed brick by brick some more.
const BYTES_PER_EXTENT_BRICK: u64 = 64;
/// Most bricks of a box: tables are looked up with 32 bits.
const MOST_EXTENT_BRICKS: u64 = 1 << 30;
const MB: f64 = 1e6;

impl Default for Limits {
    /// 4 GiB, and 2²⁶ bricks: a box of about 3200³ voxels.
    fn default() -> Self {
        Self::of_bytes(4 << 30)
    }
}

impl Limits {
    /// What a person allows, in megabytes of 10⁶ bytes, within [`MEMORY_LIMIT_MB`].
    pub fn of_memory_mb(megabytes: f64) -> Self {
        let [least, most] = MEMORY_LIMIT_MB;
        Self::of_bytes((megabytes.clamp(least, most) * MB) as u64)
    }

    fn of_bytes(max_bytes: u64) -> Self {
        Self {
            max_bytes,
            max_extent_bricks: (max_bytes / BYTES_PER_EXTENT_BRICK).min(MOST_EXTENT_BRICKS),
        }
    }

    /// How `max_bytes` can be set, in megabytes of 10⁶ bytes.
    pub fn memory_mb(&self) -> f64 {
        self.max_bytes as f64 / MB
    }

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
            raise_to_mb: raise_to_mb(needed, 1, u64::MAX),
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
            raise_to_mb: raise_to_mb(needed, BYTES_PER_EXTENT_BRICK, MOST_EXTENT_BRICKS),
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

impl VolumeError {
    /// The same refusal of something for which there is less room, because of what was read before it.
    pub(super) fn beside(self, bytes: u64) -> Self {
        match self {
            Self::TooLarge {
                path,
                what,
                needed,
                limit,
                unit,
                raise_to_mb: Some(alone),
            } => Self::TooLarge {
                path,
                what,
                needed,
                limit,
                unit,
                raise_to_mb: Some(alone + (bytes as f64 / MB).ceil() as u64),
            },
            other => other,
        }
    }
}

/// The limit, in megabytes, under which so many pieces of this many bytes fit; `None` where none is high enough.
fn raise_to_mb(pieces: u64, bytes: u64, most: u64) -> Option<u64> {
    let needed = (pieces.saturating_mul(bytes) as f64 / MB).ceil();
    (pieces <= most && needed <= MEMORY_LIMIT_MB[1]).then_some(needed as u64)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::IVec3;

    use super::*;

    #[test]
    fn a_refusal_says_which_limit_would_do_and_that_one_does() {
        let path = Path::new("a.vdb");
        let limits = Limits::of_memory_mb(100.0);
        let said = |refused: Result<(), VolumeError>| refused.unwrap_err().to_string();
        let words = said(limits.check_bytes(path, "the grid", 1_234_567_890));
        assert!(
            words.contains("raise volume.memory_limit_mb to 1235"),
            "{words}"
        );
        let raised = Limits::of_memory_mb(1235.0);
        raised.check_bytes(path, "the grid", 1_234_567_890).unwrap();

        let bounds = IndexBox {
            min: IVec3::ZERO,
            max: IVec3::splat(8 * 200),
        };
        let words = said(limits.check_extent(path, "the box", bounds));
        assert!(
            words.contains("raise volume.memory_limit_mb to 512"),
            "{words}"
        );
        let raised = Limits::of_memory_mb(512.0);
        raised.check_extent(path, "the box", bounds).unwrap();

        // What no machine holds is not recommended.
        for refused in [
            limits.check_bytes(path, "the grid", u64::MAX),
            limits.check_extent(
                path,
                "the box",
                IndexBox {
                    min: IVec3::MIN,
                    max: IVec3::MAX,
                },
            ),
        ] {
            let words = said(refused);
            assert!(
                words.contains("crop") && !words.contains("raise"),
                "{words}"
            );
        }
    }

    #[test]
    fn the_default_is_what_it_says() {
        let limits = Limits::default();
        assert_eq!(
            (limits.max_bytes, limits.max_extent_bricks),
            (1 << 32, 1 << 26)
        );
        assert_eq!(
            Limits::of_memory_mb(f64::INFINITY).max_extent_bricks,
            1 << 30
        );
    }
}
