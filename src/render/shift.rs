//! By how much bent light moves what is seen through a fire, in pixels: what a person is told.

use rayon::prelude::*;

use super::bend::{Surroundings, Way, follow};
use crate::scene::Scene;
use crate::scene::camera::{CameraError, View};
use crate::scene::refractivity::Refractivity;
use crate::scene::stage::Screen;

/// Rays along the longer side of the picture. A shift changes over the width of a flame's front, about a thirtieth of a
/// picture that frames it.
const RAYS_ALONG: u32 = 48;

/// The largest shift in pixels over a coarse grid of rays of a picture of `size` pixels, in the calling thread's rayon
/// pool; the same whatever the number of threads, for a maximum has no order.
///
/// # Errors
/// The camera cannot see.
pub(super) fn largest_shift_px(
    scene: &Scene,
    gas: &Refractivity,
    size: [u32; 2],
) -> Result<f64, CameraError> {
    let view = scene.camera.view(size)?;
    let backdrop = scene.stage.backdrop.as_ref();
    let screen = backdrop.and_then(|it| it.facing(&scene.camera, size).ok());
    let around = Surroundings {
        medium: scene.flame.medium(),
        gas,
        stage: &scene.stage,
    };
    let longer = size[0].max(size[1]);
    let counts = size.map(|side| (side * RAYS_ALONG).div_ceil(longer).max(1));
    let shift = |i: u32| {
        let cell = [i % counts[0], i / counts[0]];
        let pixel: [f64; 2] = std::array::from_fn(|axis| {
            (f64::from(cell[axis]) + 0.5) * f64::from(size[axis]) / f64::from(counts[axis])
        });
        let way = follow(around, &view.ray(pixel[0], pixel[1]));
        shift_px(&way, &view, pixel, screen.as_ref())
    };
    let shifts = (0..counts[0] * counts[1]).into_par_iter().map(shift);
    Ok(shifts.reduce(|| 0.0, f64::max))
}

/// How far from its pixel a path brings what it meets: the surface, or else the screen where there is one, or else the
/// point where it leaves the fire. In pixels, between where that is seen if light goes straight, and where it is seen.
pub(super) fn shift_px(way: &Way, view: &View, pixel: [f64; 2], screen: Option<&Screen>) -> f64 {
    if way.knots.is_empty() {
        return 0.0;
    }
    if let (None, Some(screen)) = (&way.hit, screen) {
        let seen = screen.pixel(&way.exit);
        return seen.map_or(0.0, |[x, y]| (x - pixel[0]).hypot(y - pixel[1]));
    }
    let straight = view.ray(pixel[0], pixel[1]);
    let met = way.hit.map_or(way.exit.origin, |hit| hit.point);
    let towards = (met - straight.origin).normalize_or(straight.direction);
    // A pixel as wide as it is here: towards the edge of a picture it spans a smaller angle.
    let beside = view.ray(pixel[0] + 1.0, pixel[1]).direction;
    let angle = |a: glam::DVec3, b: glam::DVec3| a.cross(b).length().atan2(a.dot(b));
    angle(straight.direction, towards) / angle(straight.direction, beside)
}
