//! Voxels and bricks by index: where a voxel lies in its brick, and boxes of voxels.

use glam::IVec3;

/// Edge of a brick in voxels.
pub const BRICK_EDGE: i32 = 8;
/// Samples in a brick.
pub const BRICK_LEN: usize = 512;
/// Index coordinates beyond ±this are refused by every reader, so sums of two of them fit an `i32`.
pub(super) const MAX_COORDINATE: i64 = 1 << 29;

/// A box of voxels: `min` inside, `max` outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndexBox {
    /// Lowest voxel.
    pub min: IVec3,
    /// One past the highest voxel.
    pub max: IVec3,
}

impl IndexBox {
    /// The box without any voxel; the union with it changes nothing.
    pub const EMPTY: Self = Self {
        min: IVec3::MAX,
        max: IVec3::MIN,
    };

    /// True when the box holds no voxel.
    pub fn is_empty(&self) -> bool {
        self.min.cmpge(self.max).any()
    }

    /// Voxels along each axis; zero when empty.
    pub fn dims(&self) -> IVec3 {
        if self.is_empty() {
            IVec3::ZERO
        } else {
            self.max - self.min
        }
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// What is in both.
    #[must_use]
    pub fn within(self, other: Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// Bricks in the box of bricks around it: what a dense table of bricks would need.
    pub fn brick_count(&self) -> u64 {
        if self.is_empty() {
            return 0;
        }
        let low = self.min.map(|c| c.div_euclid(BRICK_EDGE));
        let high = self.max.map(|c| (c - 1).div_euclid(BRICK_EDGE));
        (high - low + IVec3::ONE)
            .to_array()
            .into_iter()
            .fold(1u64, |n, d| n.saturating_mul(d.unsigned_abs().into()))
    }
}

/// Bricks are sorted by z, then y, then x: the order of a dense table with x fastest.
pub(super) fn brick_key(brick: IVec3) -> (i32, i32, i32) {
    (brick.z, brick.y, brick.x)
}

/// Position of a voxel in its brick: x fastest, then y, then z.
pub(super) fn offset_in_brick(voxel: IVec3) -> usize {
    let local = voxel & IVec3::splat(BRICK_EDGE - 1);
    (local.x + BRICK_EDGE * (local.y + BRICK_EDGE * local.z)) as usize
}

/// The coordinate of the brick that a voxel lies in.
pub fn brick_of(voxel: IVec3) -> IVec3 {
    voxel.map(|c| c.div_euclid(BRICK_EDGE))
}
