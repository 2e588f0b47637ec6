//! A ray's way through the bricks of a medium.

use glam::IVec3;

use crate::math::Ray;
use crate::scene::medium::{BRICK, Medium, NO_BRICK};

/// Part of a ray inside one stored brick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// Which brick.
    pub(super) slot: u32,
    /// Where it begins and ends, metres along the ray.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Visits the stretches of a ray of the lattice in bricks in which something shows, nearest first, between two parameters
/// that lie in the domain.
#[inline(always)]
pub(super) fn for_each_stretch(
    medium: &Medium,
    ray: &Ray,
    range: [f64; 2],
    visit: impl FnMut(Stretch),
) {
    for_each_below(medium, medium.shown, ray, range, visit);
}

/// The same for all stored bricks, those that only bend light as well.
#[inline(always)]
pub(super) fn for_each_stored(
    medium: &Medium,
    ray: &Ray,
    range: [f64; 2],
    visit: impl FnMut(Stretch),
) {
    for_each_below(medium, NO_BRICK, ray, range, visit);
}

/// The same for bricks whose slot is below a number.
#[inline(always)]
fn for_each_below(
    medium: &Medium,
    below: u32,
    ray: &Ray,
    range: [f64; 2],
    mut visit: impl FnMut(Stretch),
) {
    for_each_brick(medium, ray, range, |stretch| {
        if stretch.slot < below {
            visit(stretch);
        }
    });
}

/// The same for all bricks of the box, those that are not stored as well (J. Amanatides and A. Woo, Eurographics 1987).
///
/// Which border comes next is as good as random, so nothing branches on it: all three axes are updated, two of them by
/// nothing.
#[inline(always)]
#[allow(
    clippy::needless_bitwise_bool,
    reason = "a lazy operator would be a branch on what is as good as random"
)]
pub(super) fn for_each_brick(
    medium: &Medium,
    ray: &Ray,
    [enter, exit]: [f64; 2],
    mut visit: impl FnMut(Stretch),
) {
    let limit = medium.bricks.as_ivec3();
    if limit.min_element() == 0 {
        return;
    }
    let first = (ray.at(enter) * (1.0 / BRICK as f64))
        .as_ivec3()
        .clamp(IVec3::ZERO, limit - 1);
    let row = limit.x as isize;
    let strides = [1, row, row * limit.y as isize];
    let axis = |axis: usize| {
        Axis::new(
            [ray.origin[axis], ray.direction[axis]],
            [first[axis], limit[axis]],
            strides[axis],
        )
    };
    let (mut x, mut y, mut z) = (axis(0), axis(1), axis(2));
    let mut at = medium.brick_index(first.as_uvec3()) as isize;
    let mut from = enter;
    loop {
        let border = lesser(lesser(x.next, y.next), z.next);
        let to = lesser(border, exit);
        let Some(&slot) = medium.table.get(at as usize) else {
            return;
        };
        visit(Stretch { slot, from, to });
        let along_x = x.next == border;
        let along_y = !along_x & (y.next == border);
        at += x.pass(along_x) + y.pass(along_y) + z.pass(!(along_x | along_y));
        if (border >= exit) | ((x.left | y.left | z.left) < 0) {
            return;
        }
        from = if to > from { to } else { from };
    }
}

/// The lesser of two numbers that are no NaN.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// A ray's way across the borders of one axis.
struct Axis {
    /// Where the next border is and how far it is to the one after, as the ray counts.
    next: f64,
    pace: f64,
    /// Borders that are left before the box ends.
    left: i32,
    /// What a brick further is in the table.
    stride: isize,
}

impl Axis {
    #[inline(always)]
    fn new([origin, direction]: [f64; 2], [first, limit]: [i32; 2], stride: isize) -> Self {
        let edge = BRICK as f64;
        if direction == 0.0 {
            // A ray along a border never crosses it: its next border lies infinitely far.
            return Self {
                next: f64::INFINITY,
                pace: 0.0,
                left: 0,
                stride: 0,
            };
        }
        let rises = direction > 0.0;
        let inverse = 1.0 / direction;
        let border = edge * f64::from(first + i32::from(rises));
        Self {
            next: (border - origin) * inverse,
            pace: edge * inverse.abs(),
            left: if rises { limit - 1 - first } else { first },
            stride: if rises { stride } else { -stride },
        }
    }

    /// Passes the next border if it is the one; returns how far the next brick is in the table.
    #[inline(always)]
    fn pass(&mut self, it_is: bool) -> isize {
        self.next += if it_is { self.pace } else { 0.0 };
        self.left -= i32::from(it_is);
        if it_is { self.stride } else { 0 }
    }
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::{DAffine3, IVec3};

    use crate::scene::Interpolation;
    use crate::scene::Medium;
    use crate::volume::{Border, FieldMap, FieldMaps, Grid, Volume};

    /// 24³ voxels of 1 m, a few blocks of which hold soot.
    pub(in crate::render) fn sparse(seed: u32, interpolation: Interpolation) -> Medium {
        let soot = move |voxel: IVec3| {
            let block = voxel / 5;
            let number = (block.x + 5 * block.y + 25 * block.z) as u32;
            let [hash, ..] = crate::math::random::philox([number, 0, 0, 0], [seed, 0]);
            if hash >> 29 == 0 { 1e-6 } else { 0.0 }
        };
        let grid = Grid::from_fn(
            "soot",
            IVec3::splat(24),
            DAffine3::IDENTITY,
            Border::Background,
            0.0,
            soot,
        );
        let maps = FieldMaps {
            soot: Some(FieldMap::new("soot", 1.0, 0.0, 0.0, 1.0)),
            ..FieldMaps::default()
        };
        let volume = Volume::from_grids(vec![grid], "sparse");
        crate::scene::pack_for_tests(&volume, &maps, interpolation).unwrap()
    }
}
