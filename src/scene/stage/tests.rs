#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::scene::Camera;

const GREY: [f64; 3] = [0.5; 3];

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray::new(origin.into(), direction.into()).unwrap()
}

fn ground(height_m: f64) -> Stage {
    Stage {
        ground: Some(Ground {
            height_m,
            colour: GREY,
        }),
        ..Stage::default()
    }
}

fn sphere(centre: [f64; 3], radius_m: f64) -> Stage {
    Stage {
        spheres: vec![Sphere {
            centre: centre.into(),
            radius_m,
            colour: GREY,
        }],
        ..Stage::default()
    }
}

fn log(ends: [[f64; 3]; 2], radius_m: f64) -> Stage {
    Stage {
        logs: vec![Log {
            ends: ends.map(DVec3::from),
            radius_m,
            colour: GREY,
        }],
        ..Stage::default()
    }
}

fn assert_hit(stage: &Stage, ray: &Ray, distance_m: f64, normal: [f64; 3]) {
    let hit = stage.hit(ray, f64::INFINITY).unwrap();
    assert!((hit.distance_m - distance_m).abs() < 1e-9, "{hit:?}");
    assert!(hit.normal.abs_diff_eq(normal.into(), 1e-9), "{hit:?}");
    assert!(hit.point.abs_diff_eq(ray.at(distance_m), 1e-7), "{hit:?}");
    assert!(hit.normal.dot(ray.direction) <= 0.0);
}

#[test]
fn the_ground_is_met_from_above_only() {
    let stage = ground(-1.0);
    assert_hit(
        &stage,
        &ray([5.0, 3.0, 1.0], [0.0, 0.0, -1.0]),
        2.0,
        [0.0, 0.0, 1.0],
    );
    for blind in [
        ray([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ray([0.0, 0.0, 1.0], [0.0, 0.3, 1.0]),
        ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]),
        ray([0.0, 0.0, -2.0], [0.0, 0.0, -1.0]),
        ray([0.0, 0.0, -1.0], [0.0, 1.0, -1.0]),
    ] {
        assert_eq!(stage.hit(&blind, f64::INFINITY), None, "{blind:?}");
    }
    let down = ray([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    assert_eq!(stage.hit(&down, 2.0), None);
    assert!(stage.hit(&down, 2.1).is_some());
}

#[test]
fn spheres_and_logs_are_met_outside_and_inside() {
    let stage = sphere([1.0, 0.0, 0.0], 0.5);
    assert_hit(
        &stage,
        &ray([-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        2.5,
        [-1.0, 0.0, 0.0],
    );
    assert_hit(
        &stage,
        &ray([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        0.5,
        [0.0, -1.0, 0.0],
    );
    assert_eq!(
        stage.hit(&ray([-2.0, 0.6, 0.0], [1.0, 0.0, 0.0]), 9.0),
        None
    );
    assert_eq!(stage.hit(&ray([3.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 9.0), None);

    let stage = log([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]], 0.25);
    assert_hit(
        &stage,
        &ray([0.0, 0.3, 4.0], [0.0, 0.0, -1.0]),
        3.75,
        [0.0, 0.0, 1.0],
    );
    // The round end, head on, and along the log from the side.
    assert_hit(
        &stage,
        &ray([0.0, 4.0, 0.0], [0.0, -1.0, 0.0]),
        2.75,
        [0.0, 1.0, 0.0],
    );
    let end = (0.25_f64 * 0.25 - 0.15 * 0.15).sqrt();
    assert_hit(
        &stage,
        &ray([0.15, 4.0, 0.0], [0.0, -1.0, 0.0]),
        3.0 - end,
        [0.6, end / 0.25, 0.0],
    );
    assert_hit(
        &stage,
        &ray([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        0.25,
        [-1.0, 0.0, 0.0],
    );
    assert_eq!(
        stage.hit(&ray([0.0, 1.2, 4.0], [0.26, 0.0, -4.0]), 9.0),
        None
    );

    // A log without length is a ball.
    let [ball, point] = [sphere([1.0, 2.0, 3.0], 0.5), log([[1.0, 2.0, 3.0]; 2], 0.5)];
    for direction in [[1.0, 2.0, 3.1], [1.2, 1.9, 2.7], [0.0, 0.0, 1.0]] {
        let ray = ray([0.0; 3], direction);
        assert_eq!(
            ball.hit(&ray, 9.0).map(|hit| hit.distance_m),
            point.hit(&ray, 9.0).map(|hit| hit.distance_m)
        );
    }
}

#[test]
fn the_nearest_is_met() {
    let stage = Stage {
        spheres: sphere([0.0, 0.0, 1.0], 0.5).spheres,
        logs: log([[-3.0, 0.0, 2.0], [3.0, 0.0, 2.0]], 0.1).logs,
        ..ground(0.0)
    };
    let down = |x: f64, y: f64| ray([x, y, 5.0], [0.0, 0.0, -1.0]);
    assert_hit(&stage, &down(0.0, 0.0), 2.9, [0.0, 0.0, 1.0]);
    assert_hit(&stage, &down(0.0, 0.3), 3.6, [0.0, 0.6, 0.8]);
    assert_hit(&stage, &down(0.0, 0.7), 5.0, [0.0, 0.0, 1.0]);
}

proptest! {
    /// A ray that goes on from a hit into the half space of the normal does not meet the same convex thing again, near or
    /// far from the origin, grazing or not.
    #[test]
    fn what_has_been_met_is_not_met_again(
        shift in prop::sample::select(vec![0.0, 10.0, 1e4]),
        origin in prop::array::uniform3(-3.0..3.0_f64),
        aim in prop::array::uniform3(-1.0..1.0_f64),
        onward in prop::array::uniform3(-1.0..1.0_f64),
        which in 0..3,
    ) {
        let stage = match which {
            0 => sphere([shift, 0.2, 0.0], 0.7),
            1 => log([[shift - 0.5, 0.0, 0.1], [shift + 0.4, 0.5, 0.3]], 0.3),
            _ => ground(-0.4),
        };
        let from = DVec3::from(origin) + DVec3::X * shift;
        let toward = DVec3::from(aim) * 0.7 + DVec3::X * shift - from;
        let Some(ray) = Ray::new(from, toward) else { return Ok(()) };
        let Some(hit) = stage.hit(&ray, f64::INFINITY) else { return Ok(()) };
        prop_assert!((hit.normal.length() - 1.0).abs() < 1e-12);
        let inside = which < 2 && stage.visibility(from, DVec3::ZERO, from + 1e-9, 1e-12) == 0.0;
        let Some(next) = Ray::new(hit.point, onward.into()) else { return Ok(()) };
        if !inside && next.direction.dot(hit.normal) > 1e-6 {
            prop_assert_eq!(stage.hit(&next, f64::INFINITY), None);
            let there = next.at(5.0);
            prop_assert_eq!(stage.visibility(hit.point, hit.normal, there, 1e-3), 1.0);
        }
    }

    /// For a tiny ball all is seen or nothing, as a ray says.
    #[test]
    fn a_tiny_ball_is_seen_where_a_ray_is_free(
        from in prop::array::uniform3(-3.0..3.0_f64),
        to in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let stage = Stage {
            spheres: sphere([0.5, 0.5, 1.0], 0.8).spheres,
            logs: log([[-2.0, -0.5, 0.0], [1.0, 0.3, 0.5]], 0.4).logs,
            ..ground(-1.0)
        };
        let (from, to) = (DVec3::from(from), DVec3::from(to));
        let Some(ray) = Ray::new(from, to - from) else { return Ok(()) };
        let seen = stage.visibility(from, DVec3::ZERO, to, 1e-9);
        let free = stage.hit(&ray, (to - from).length()).is_none();
        let solid = |at: DVec3| {
            let end = at - DVec3::new(-2.0, -0.5, 0.0);
            let along = DVec3::new(3.0, 0.8, 0.5);
            let nearest = (end.dot(along) / along.length_squared()).clamp(0.0, 1.0) * along;
            at.distance(DVec3::new(0.5, 0.5, 1.0)) < 0.8 || end.distance(nearest) < 0.4
        };
        if solid(from) || solid(to) || to.z < -1.0 && from.z > -1.0 {
            prop_assert_eq!(seen, 0.0);
        } else {
            prop_assert_eq!(seen, f64::from(u8::from(free)), "{} {}", from, to);
        }
    }

    /// A step of a hair never makes a step in the light.
    #[test]
    fn shadows_have_no_steps(
        from in prop::array::uniform3(-3.0..3.0_f64),
        to in prop::array::uniform3(-3.0..3.0_f64),
        radius_m in 0.05..0.5_f64,
    ) {
        let stage = Stage {
            spheres: sphere([0.5, 0.5, 1.0], 0.2).spheres,
            logs: log([[-2.0, -0.5, 0.0], [1.0, 0.3, 0.5]], 0.1).logs,
            ..Stage::default()
        };
        let seen = |to: DVec3| stage.visibility(from.into(), DVec3::ZERO, to, radius_m);
        let to = DVec3::from(to);
        let step = 1e-6 * DVec3::new(0.5, -0.6, 0.6);
        prop_assert!((seen(to + step) - seen(to)).abs() < 1e-3);
    }
}

#[test]
fn half_of_a_ball_is_seen_over_a_wide_edge_and_most_of_it_past_a_small_ball() {
    // The horizon of the ground through the middle of the ball.
    let seen = ground(0.0).visibility(DVec3::new(0.0, 0.0, 0.2), DVec3::ZERO, DVec3::X, 0.1);
    assert!((seen - 0.5).abs() < 1e-12, "{seen}");
    // A ball of a tenth, in the middle of the light: about its disc.
    let seen = sphere([0.5, 0.0, 0.0], 0.005).visibility(DVec3::ZERO, DVec3::ZERO, DVec3::X, 0.1);
    assert!(seen > 0.95 && seen < 0.99, "{seen}");
}

fn looking_along_y() -> Camera {
    Camera {
        eye: DVec3::new(0.0, -2.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov_deg: 60.0,
        roll_deg: 0.0,
    }
}

#[test]
fn a_backdrop_fills_the_frame_and_knows_its_pixels() {
    let camera = looking_along_y();
    let (view, size) = (camera.view([40, 20]).unwrap(), [40, 20]);
    let backdrop = Backdrop {
        pattern: Pattern::Gradient,
        distance_m: 3.0,
        luminance_cd_m2: 683.0,
    };
    let screen = backdrop.facing(&camera, size).unwrap();
    for [x, y] in [[0.5, 0.5], [20.0, 10.0], [33.0, 19.5]] {
        let [px, py] = screen.pixel(&view.ray(x, y)).unwrap();
        assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9);
        // D65 white times the height in the picture.
        let [cx, cy, cz] = screen.xyz(&view.ray(x, y));
        let bright = 1.0 - y / 20.0;
        assert!((cy - bright).abs() < 1e-9, "{cy}");
        assert!((cx / cy - 0.3127 / 0.3290).abs() < 1e-9);
        assert!((cz / cy - 0.3583 / 0.3290).abs() < 1e-9);
    }
    // From another place, a point of the screen is known by where the camera sees it.
    let beside = ray([1.0, 0.0, 0.0], [-1.0, 3.0, 0.0]);
    let middle = screen.pixel(&beside).unwrap();
    assert!((middle[0] - 20.0).abs() < 1e-9 && (middle[1] - 10.0).abs() < 1e-9);
    assert_eq!(screen.pixel(&ray([0.0; 3], [0.0, -1.0, 0.0])), None);
    assert_eq!(screen.xyz(&ray([0.0; 3], [1.0, 0.0, 0.0])), [0.0; 3]);
}

#[test]
fn squares_meet_in_the_middle_and_are_smooth_over_a_pixel() {
    let camera = looking_along_y();
    let view = camera.view([100, 100]).unwrap();
    let half = 5.0 * 30.0_f64.to_radians().tan();
    let backdrop = Backdrop {
        // Ten squares fill the height.
        pattern: Pattern::Checker {
            square_m: 0.2 * half,
        },
        distance_m: 3.0,
        luminance_cd_m2: 683.0,
    };
    let screen = backdrop.facing(&camera, [100, 100]).unwrap();
    let y = |x: f64, y: f64| screen.xyz(&view.ray(x, y))[1];
    assert!((y(55.0, 45.0) - 1.0).abs() < 1e-9 && (y(45.0, 45.0) - 0.1).abs() < 1e-9);
    assert!((y(50.0, 45.0) - 0.55).abs() < 1e-9);
    assert!((y(50.25, 45.0) - 0.775).abs() < 1e-9 && (y(50.5, 45.0) - 1.0).abs() < 1e-9);
    // The mean of all pixels is that of black and white.
    let all: f64 = (0..100)
        .flat_map(|row| (0..100).map(move |column| (column, row)))
        .map(|(column, row)| y(f64::from(column) + 0.3, f64::from(row) + 0.7))
        .sum();
    assert!((all / 1e4 - 0.55).abs() < 1e-3, "{all}");
}

#[test]
fn a_pixel_that_is_next_to_nothing_beside_a_square_has_the_squares_own_light() {
    let camera = Camera {
        fov_deg: 0.01,
        ..looking_along_y()
    };
    let view = camera.view([16, 16]).unwrap();
    for square_m in [1e3, 1e6, 1e12] {
        let backdrop = Backdrop {
            pattern: Pattern::Checker { square_m },
            distance_m: 1e-6,
            luminance_cd_m2: 683.0,
        };
        let screen = backdrop.facing(&camera, [16, 16]).unwrap();
        for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
            let found = screen.xyz(&view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5))[1];
            // The middle of the frame is a corner of four squares, of which that at the upper right is white.
            let white = (x < 8) == (y >= 8);
            let expected = if white { 1.0 } else { 0.1 };
            assert!(
                (found - expected).abs() < 1e-9,
                "{square_m}: {x}, {y}: {found}"
            );
        }
    }
}

#[test]
fn a_picture_is_fitted_to_the_height_and_black_around() {
    let camera = looking_along_y();
    let view = camera.view([40, 20]).unwrap();
    let picture = BackdropPicture {
        size: [2, 2],
        pixels: vec![[1.0, 1.0, 1.0], [0.0; 3], [0.0; 3], [0.5, 0.5, 0.5]],
    };
    let backdrop = Backdrop {
        pattern: Pattern::Picture(Arc::new(picture)),
        distance_m: 3.0,
        luminance_cd_m2: 683.0,
    };
    let screen = backdrop.facing(&camera, [40, 20]).unwrap();
    let y = |x: f64, y: f64| screen.xyz(&view.ray(x, y))[1];
    assert!((y(15.0, 5.0) - 1.0).abs() < 1e-9, "upper left");
    assert!((y(25.0, 15.0) - 0.5).abs() < 1e-9, "lower right");
    assert!(
        (y(20.0, 10.0) - 0.375).abs() < 1e-9,
        "the mean in the middle"
    );
    assert_eq!((y(9.9, 5.0), y(30.1, 5.0)), (0.0, 0.0));
}

#[test]
fn the_end_of_a_log_casts_no_edge_of_its_own() {
    let stage = Stage {
        logs: vec![Log {
            ends: [DVec3::new(0.0, 0.0, 0.4), DVec3::new(0.1, 0.0, 0.4)],
            radius_m: 0.02,
            colour: [0.5; 3],
        }],
        ..Stage::default()
    };
    // A light whose beam is four times as wide as the log: the penumbra is decimetres long.
    for direction in [DVec3::X, DVec3::new(0.8, -0.6, 0.0)] {
        let seen: Vec<f64> = (-800..800)
            .map(|i| 0.002 * f64::from(i) * direction + 0.01 * DVec3::Y)
            .map(|from| stage.visibility(from, DVec3::Z, DVec3::new(0.05, 0.0, 0.5), 0.1))
            .collect();
        let most = seen.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let most = most.fold(0.0, f64::max);
        assert!(most < 0.02, "{direction}: a step of {most}");
        assert!(
            seen.iter().any(|&seen| seen < 0.95),
            "{direction}: no shadow"
        );
    }
}
