//! Where on a picture anything can be, and how far away: what spares most rays the way through the bricks.
//!
//! Every brick in which something shows is projected onto a raster of cells of [`CELL_PX`] pixels. A cell knows the nearest
//! and the farthest distance from the eye of all bricks that its rays may meet. Both are bounds: the projection of a box lies
//! in the box around its projected corners, and a brick in the ball around its middle. A ray that meets nothing is known
//! before it is made; one that does begins at its first brick.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DVec3, UVec3};
use rayon::prelude::*;

use super::chord::Bricks;
use crate::scene::camera::View;
use crate::scene::medium::BRICK;

/// Edge of a cell, pixels: that of a packet of rays.
const CELL_PX: f64 = 4.0;
/// By how much a projection is widened, pixels: far more than f64 rounds off.
const MARGIN_PX: f64 = 1e-3;
/// By how much distances are widened, as a share: far more than f32 rounds off.
const MARGIN: f64 = 1e-5;

/// A raster of distances.
pub(super) struct Cover {
    cells: [usize; 2],
    /// Bits of the nearest and the farthest distance, m; of f32 at least 0 bits are in the order of the numbers.
    ranges: Vec<[AtomicU32; 2]>,
}

impl Cover {
    /// Projects a medium, in the calling thread's rayon pool.
    pub(super) fn new(bricks: Bricks<'_>, view: &View, size: [u32; 2]) -> Self {
        let medium = bricks.medium;
        let cells = size.map(|side| (f64::from(side) / CELL_PX).ceil() as usize);
        let nothing = || [f32::INFINITY, 0.0].map(|distance| AtomicU32::new(distance.to_bits()));
        let cover = Self {
            cells,
            ranges: (0..cells[0] * cells[1]).map(|_| nothing()).collect(),
        };
        // From the lattice, in bricks, to vectors from the eye.
        let world_from_lattice = medium.lattice_from_world.inverse();
        let edges = [DVec3::X, DVec3::Y, DVec3::Z]
            .map(|axis| world_from_lattice.transform_vector3(BRICK as f64 * axis));
        let origin = world_from_lattice.translation - view.eye();
        let diagonal = |signs: [f64; 2]| edges[0] + signs[0] * edges[1] + signs[1] * edges[2];
        let radius = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
            .map(|signs| 0.5 * diagonal(signs).length())
            .into_iter()
            .fold(0.0, f64::max);
        let seen = edges.map(|edge| view.seen(edge));
        let [width, height, _] = medium.bricks.to_array().map(|count| count as usize);
        let layers = medium.table.par_chunks((width * height).max(1));
        layers.enumerate().for_each(|(z, layer)| {
            for (i, &slot) in layer.iter().enumerate() {
                if !bricks.has(slot) {
                    continue;
                }
                let brick = UVec3::new((i % width) as u32, (i / width) as u32, z as u32).as_dvec3();
                let corner = origin + brick.x * edges[0] + brick.y * edges[1] + brick.z * edges[2];
                let middle = (corner + 0.5 * (edges[0] + edges[1] + edges[2])).length();
                let near = ((middle - radius) * (1.0 - MARGIN)).max(0.0);
                let far = (middle + radius) * (1.0 + MARGIN);
                if let Some(around) = box_around(view.seen(corner), seen) {
                    cover.add(around, [near as f32, far as f32]);
                }
            }
        });
        cover
    }

    /// Notes that rays through a box of the picture (lower and upper corner, pixels) may meet something at these distances.
    fn add(&self, [low, high]: [[f64; 2]; 2], range: [f32; 2]) {
        let cell =
            |at: f64, axis: usize| (at / CELL_PX).clamp(0.0, self.cells[axis] as f64) as usize;
        let [first, end] = [
            [0, 1].map(|axis| cell(low[axis] - MARGIN_PX, axis)),
            [0, 1].map(|axis| cell(high[axis] + MARGIN_PX + CELL_PX, axis)),
        ];
        let [near, far] = range.map(f32::to_bits);
        for y in first[1]..end[1] {
            for [nearest, farthest] in
                &self.ranges[y * self.cells[0]..][first[0]..end[0].max(first[0])]
            {
                // Whoever comes first, the least and the greatest are the same.
                if near < nearest.load(Ordering::Relaxed) {
                    nearest.fetch_min(near, Ordering::Relaxed);
                }
                if far > farthest.load(Ordering::Relaxed) {
                    farthest.fetch_max(far, Ordering::Relaxed);
                }
            }
        }
    }

    /// Between which distances from the eye (m) the ray through a point of the picture (pixels from the upper left corner)
    /// may meet something; `None` if it meets nothing.
    #[inline]
    pub(super) fn range(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let cell = [0, 1].map(|axis| (point[axis] / CELL_PX).floor());
        let inside = |axis: usize| cell[axis] >= 0.0 && cell[axis] < self.cells[axis] as f64;
        if !(inside(0) && inside(1)) {
            // Nothing is known of what lies beside the picture.
            return Some([0.0, f64::INFINITY]);
        }
        let at = cell[1] as usize * self.cells[0] + cell[0] as usize;
        let range = self.ranges[at]
            .each_ref()
            .map(|bits| f32::from_bits(bits.load(Ordering::Relaxed)));
        (range[0] <= range[1]).then(|| range.map(f64::from))
    }
}

/// The box of the picture (pixels) around a box of space, given by [`View::seen`] of its corner and its edges; `None` if all
/// of it is behind the eye.
fn box_around(corner: DVec3, edges: [DVec3; 3]) -> Option<[[f64; 2]; 2]> {
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|which: usize| {
        let share = |axis: usize| f64::from((which >> axis & 1) as u32);
        corner + share(0) * edges[0] + share(1) * edges[1] + share(2) * edges[2]
    });
    if corners.iter().all(|seen| seen.z < 0.0) {
        return None;
    }
    // Beside the eye: it may be anywhere.
    if corners.iter().any(|seen| seen.z <= 0.0) {
        return Some([[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]]);
    }
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for seen in corners {
        let at = seen / seen.z;
        low = low.min(at);
        high = high.max(at);
    }
    Some([[low.x, low.y], [high.x, high.y]])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use proptest::prelude::*;

    use super::super::walk::for_each_stretch;
    use super::super::walk::tests::sparse;
    use super::*;
    use crate::scene::{Camera, Interpolation};

    proptest! {
        /// From anywhere, inside or outside: what a ray meets lies between the distances of its cell.
        #[test]
        fn nothing_lies_outside_of_the_cover(
            seed in 0_u32..500,
            eye in prop::array::uniform3(-40.0..60.0_f64),
            target in prop::array::uniform3(0.0..24.0_f64),
            fov_deg in 1.0..120.0_f64,
            points in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 64),
        ) {
            let medium = sparse(seed, Interpolation::Trilinear);
            let camera = Camera { eye: eye.into(), target: target.into(), up: DVec3::Z, fov_deg, roll_deg: 0.0 };
            let size = [77, 50];
            let Ok(view) = camera.view(size) else { return Ok(()) };
            let cover = Cover::new(Bricks::new(&medium, true), &view, size);
            for point in points {
                let point = [point[0] * 77.0, point[1] * 50.0];
                let ray = view.ray(point[0], point[1]);
                let Some((local, range)) = medium.enter(&ray) else { continue };
                let known = cover.range(point);
                let mut met = Vec::new();
                for_each_stretch(&medium, &local, range, |stretch| met.push([stretch.from, stretch.to]));
                for [from, to] in met {
                    let Some([near, far]) = known else { prop_assert!(false, "{from} to {to} is not known"); return Ok(()) };
                    prop_assert!(near <= from && to <= far, "{from} to {to} beside {near} to {far}");
                }
            }
        }
    }

    #[test]
    fn a_ray_beside_all_bricks_is_known_to_meet_nothing() {
        let medium = sparse(1, Interpolation::Trilinear);
        let camera = Camera {
            eye: DVec3::new(12.0, -60.0, 12.0),
            target: DVec3::splat(12.0),
            up: DVec3::Z,
            fov_deg: 60.0,
            roll_deg: 0.0,
        };
        let view = camera.view([64, 64]).unwrap();
        let cover = Cover::new(Bricks::new(&medium, true), &view, [64, 64]);
        assert_eq!(cover.range([1.0, 1.0]), None);
        assert_eq!(cover.range([-1.0, 1.0]), Some([0.0, f64::INFINITY]));
        let [near, far] = cover.range([32.0, 32.0]).unwrap();
        assert!(near > 40.0 && far < 100.0, "{near} {far}");
    }
}
