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

/// The same for bricks whose slot is below a number (J. Amanatides and A. Woo, Eurographics 1987).
#[inline(always)]
fn for_each_below(
    medium: &Medium,
    below: u32,
    ray: &Ray,
    [enter, exit]: [f64; 2],
    mut visit: impl FnMut(Stretch),
) {
    let limit = medium.bricks.as_ivec3();
    if limit.min_element() == 0 {
        return;
    }
    let edge = BRICK as f64;
    let mut brick = (ray.at(enter) / edge)
        .floor()
        .as_ivec3()
        .clamp(IVec3::ZERO, limit - 1);
    let direction = ray.direction.to_array();
    // A ray along a border never crosses it: its next border lies infinitely far.
    let inverse = direction.map(|d| if d == 0.0 { f64::INFINITY } else { edge / d });
    let step = direction.map(|d| if d < 0.0 { -1 } else { 1 });
    let origin = (ray.origin / edge).to_array();
    let border = |axis: usize, brick: i32| {
        if inverse[axis].is_infinite() {
            return f64::INFINITY;
        }
        (f64::from(brick + i32::from(step[axis] > 0)) - origin[axis]) * inverse[axis]
    };
    let mut next: [f64; 3] = std::array::from_fn(|axis| border(axis, brick[axis]));
    let mut from = enter;
    loop {
        let axis = (1..3).fold(
            0,
            |best, axis| if next[axis] < next[best] { axis } else { best },
        );
        let to = next[axis].min(exit);
        let slot = medium.table[medium.brick_index(brick.as_uvec3())];
        if slot < below {
            visit(Stretch { slot, from, to });
        }
        brick[axis] += step[axis];
        if next[axis] >= exit || brick[axis] < 0 || brick[axis] >= limit[axis] {
            return;
        }
        from = from.max(to);
        next[axis] = border(axis, brick[axis]);
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
