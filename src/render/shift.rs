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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::DVec3;

    use super::*;
    use crate::math::Ray;
    use crate::render::bend::Knot;
    use crate::scene::refractivity::tests::{Gas, ball, clear};
    use crate::scene::{Camera, Stage};

    /// An eye 2 m before the middle that sees 40° in 500 pixels: a pixel in the middle is 2 tan 20°/500 = 1.456e-3.
    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(0.0, -2.0, 0.0),
            target: DVec3::ZERO,
            up: DVec3::Z,
            fov_deg: 40.0,
            roll_deg: 0.0,
        }
    }

    #[test]
    fn a_shift_is_what_the_eye_would_measure() {
        let view = camera().view([500, 500]).unwrap();
        // A path that leaves the fire 3 m before the eye, 2 mm to the right of where it would go straight.
        let exit = Ray {
            origin: DVec3::new(0.002, 1.0, 0.0),
            direction: DVec3::Y,
        };
        let knot = Knot {
            arc_m: 0.0,
            at: exit,
        };
        let way = Way {
            knots: vec![knot],
            exit,
            hit: None,
        };
        let shift = shift_px(&way, &view, [250.0, 250.0], None);
        let expected = 0.002 / 3.0 / (2.0 * 20_f64.to_radians().tan() / 500.0);
        assert!((shift / expected - 1.0).abs() < 1e-5, "{shift}");
        let missing = Way {
            knots: Vec::new(),
            ..way
        };
        assert_eq!(shift_px(&missing, &view, [250.0, 250.0], None), 0.0);
    }

    #[test]
    fn the_largest_shift_of_a_hot_ball_is_a_fraction_of_a_pixel_whatever_the_threads() {
        let scene = Scene {
            flame: Gas::default().flame(ball(DVec3::ZERO), clear),
            camera: camera(),
            stage: Stage::default(),
        };
        let gas = Refractivity::new(&scene.flame, 550.0).unwrap();
        let by_threads = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| largest_shift_px(&scene, &gas, [500, 300]).unwrap())
        });
        assert_eq!(by_threads[0].to_bits(), by_threads[1].to_bits());
        assert_eq!(by_threads[0].to_bits(), by_threads[2].to_bits());
        // 4.4e-4 rad at most, bent about 0.3 m before the exit, which is 2.3 m from the eye.
        let pixel = 2.0 * 20_f64.to_radians().tan() / 300.0;
        let expected = 4.4e-4 * 0.33 / 2.33 / pixel;
        let ratio = by_threads[0] / expected;
        assert!(
            (0.85..1.1).contains(&ratio),
            "{}, about {expected}",
            by_threads[0]
        );
    }
}
