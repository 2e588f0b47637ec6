//! Cases 51 to 58: rays that start inside, run along faces, touch edges; grids of one voxel, steps of any length.

use glam::DVec3;
use sootlight::math::{Aabb, Ray};
use sootlight::project::ProjectError;
use sootlight::render::Plan;
use sootlight::render::march::Marcher;
use sootlight::render::{Prober, Switch};
use sootlight::scene::camera::CameraError;
use sootlight::scene::{Camera, Scene};

use super::super::common;
use super::{
    ALONG, EPSILON_32, LENGTH_M, RGB_NM, assert_close, depth_of, even_with, fraction_of_depth,
    march, planck, planck_tolerance, refusal, three,
};

const UNIT: Aabb = Aabb {
    min: DVec3::ZERO,
    max: DVec3::ONE,
};

fn hit(origin: [f64; 3], direction: [f64; 3]) -> Option<(f64, f64)> {
    UNIT.intersect(&Ray {
        origin: origin.into(),
        direction: direction.into(),
    })
}

/// An even slab, a depth of 1 in green, from y = 0 to [`LENGTH_M`] and as wide around the y axis.
fn slab(assignments: &[&str]) -> Scene {
    even_with(fraction_of_depth(1.0, 550.0), 1500.0, assignments)
}

/// The slab seen by another camera, at the middle of the picture.
fn seen_from(eye: DVec3, target: DVec3) -> [f64; 3] {
    let mut scene = slab(&[]);
    scene.camera = Camera {
        eye,
        target,
        ..ALONG
    };
    march(&scene, 0.1, RGB_NM).radiance
}

/// What an even slab gives over a length, at [`RGB_NM`].
fn expected_over(length_m: f64) -> [f64; 3] {
    let scene = slab(&[]);
    RGB_NM.map(|nm| {
        let tau = depth_of(&scene, fraction_of_depth(1.0, 550.0), nm) * length_m / LENGTH_M;
        planck(nm, 1500.0) * -(-tau).exp_m1()
    })
}

#[track_caller]
fn assert_slab(seen: [f64; 3], length_m: f64, what: &str) {
    for ((seen, expected), nm) in seen.into_iter().zip(expected_over(length_m)).zip(RGB_NM) {
        let tolerance = planck_tolerance(nm, 1500.0, EPSILON_32);
        assert_close(seen, expected, tolerance, &format!("{what}, {nm} nm"));
    }
}

#[test]
fn case_51_an_eye_inside_sees_from_where_it_is() {
    assert_eq!(hit([0.25, 0.5, 0.5], [1.0, 0.0, 0.0]), Some((0.0, 0.75)));
    assert_eq!(hit([0.25, 0.5, 0.5], [-1.0, 0.0, 0.0]), Some((0.0, 0.25)));
    for inside in [0.0, 0.125, 0.375] {
        let seen = seen_from(DVec3::Y * inside, DVec3::Y);
        assert_slab(seen, LENGTH_M - inside, &format!("from {inside} m"));
    }
    assert_eq!(
        seen_from(DVec3::Y * LENGTH_M, DVec3::Y),
        [0.0; 3],
        "from the far face on"
    );
}

#[test]
fn case_52_a_face_does_not_constrain_a_ray_that_runs_along_it() {
    for zero in [0.0, -0.0] {
        for on in [0.0, 0.5, 1.0] {
            assert_eq!(
                hit([-1.0, on, 0.5], [1.0, zero, zero]),
                Some((1.0, 2.0)),
                "at {on}"
            );
            assert_eq!(
                hit([-1.0, on, on], [1.0, zero, zero]),
                Some((1.0, 2.0)),
                "at {on}"
            );
        }
        for off in [-f64::from_bits(1), 1.0_f64.next_up(), 7.0, f64::INFINITY] {
            assert_eq!(hit([-1.0, off, 0.5], [1.0, zero, zero]), None, "at {off}");
        }
    }
    // The march, in the very plane of the slab's face, whose numbers are exact.
    let face = DVec3::X * 0.5 * LENGTH_M;
    assert_slab(seen_from(face - DVec3::Y, face), LENGTH_M, "along the face");
    let beside = DVec3::X * (0.5 * LENGTH_M + 1e-9);
    assert_eq!(seen_from(beside - DVec3::Y, beside), [0.0; 3], "beside it");
}

#[test]
fn case_53_a_touched_edge_or_corner_changes_nothing_behind() {
    assert_eq!(hit([-1.0, 1.0, 0.5], [1.0, -1.0, 0.0]), Some((1.0, 1.0)));
    assert_eq!(hit([-1.0, 1.0, -1.0], [1.0, -1.0, 1.0]), Some((1.0, 1.0)));
    let mut scene = slab(&["stage.backdrop=gradient"]);
    let edge = DVec3::new(-0.5 * LENGTH_M, 0.0, 0.0);
    let ray = Ray {
        origin: edge + DVec3::new(-1.0, 1.0, 0.0),
        direction: DVec3::new(1.0, -1.0, 0.0),
    };
    assert!(
        scene.flame.medium().enter(&ray).is_none(),
        "no length, no march"
    );
    scene.camera = Camera {
        eye: ray.origin,
        target: edge,
        ..ALONG
    };
    let point = [32.0, 32.0];
    let probe = Prober::new(&scene, [64, 64], common::scattered_alone(Switch::Off));
    let backdrop = scene.stage.backdrop.as_ref().unwrap();
    let screen = backdrop.facing(&scene.camera, [64, 64]).unwrap();
    let expected = screen.xyz(&scene.camera.view([64, 64]).unwrap().ray(point[0], point[1]));
    assert!(expected[1] > 0.0);
    let seen = probe.read(point).unwrap().xyz;
    for c in 0..3 {
        assert_close(seen[c], expected[c], 4.0 * f64::EPSILON, "the backdrop");
    }
}

#[test]
fn case_54_a_grid_of_one_voxel_is_an_even_slab() {
    for interpolation in ["nearest", "trilinear"] {
        let scene = slab(&[&format!("render.interpolation={interpolation}")]);
        assert_slab(
            march(&scene, 0.03, RGB_NM).radiance,
            LENGTH_M,
            interpolation,
        );
    }
    // Beside its middle, where a cell reaches past the voxel.
    for aside in [DVec3::new(0.2, 0.0, 0.1), DVec3::new(-0.24, 0.0, -0.24)] {
        assert_slab(
            seen_from(aside - DVec3::Y, aside),
            LENGTH_M,
            &format!("at {aside}"),
        );
    }
    let tricubic = slab(&["render.interpolation=tricubic"]);
    assert_slab(
        march(&tricubic, 0.03, RGB_NM).radiance,
        LENGTH_M,
        "tricubic",
    );
}

#[test]
fn case_55_a_step_beyond_the_box_is_one_step_of_its_chord() {
    let scene = slab(&[]);
    let small = march(&scene, LENGTH_M / 64.0, RGB_NM).radiance;
    for step_m in [1.0001 * LENGTH_M, 2.0, 1e6] {
        let seen = march(&scene, step_m, RGB_NM).radiance;
        assert_slab(seen, LENGTH_M, &format!("a step of {step_m} m"));
        for c in 0..3 {
            assert_close(seen[c], small[c], 64.0 * EPSILON_32, "against small steps");
        }
        let parts = parts(&scene, step_m);
        assert_eq!(parts.len(), 1);
        assert_close(parts[0][1] - parts[0][0], LENGTH_M, EPSILON_32, "the chord");
    }
}

/// The parts into which a march of such steps cuts the middle ray, m from where it enters.
fn parts(scene: &Scene, step_m: f64) -> Vec<[f64; 2]> {
    let plan = Plan::with_wavelengths(scene, [64, 64], three(RGB_NM));
    let step_voxels = step_m / scene.flame.medium().voxel_size_m();
    Marcher::new(scene, &plan, step_voxels)
        .unwrap()
        .samples_of([32.0, 32.0])
}

#[test]
fn case_56_the_steps_add_up_to_the_chord() {
    let scene = slab(&[]);
    for steps in [1.0, 1.5, 2.0, 2.000001, 2.999999, 7.3, 10.0, 999.5] {
        let parts = parts(&scene, LENGTH_M / steps);
        assert_eq!(parts[0][0], 0.0);
        for pair in parts.windows(2) {
            let gap = (pair[1][0] - pair[0][1]).abs();
            assert!(
                gap <= 2.0 * f64::EPSILON * LENGTH_M,
                "{steps} steps: a gap of {gap:e}"
            );
        }
        // One ulp of the march, which is f32: the share of the last step is kept in it.
        let sum: f64 = parts.iter().map(|[begin, end]| end - begin).sum();
        assert_close(sum, LENGTH_M, EPSILON_32, &format!("{steps} steps"));
        let seen = march(&scene, LENGTH_M / steps, RGB_NM).radiance;
        for (seen, expected) in seen.into_iter().zip(expected_over(LENGTH_M)) {
            let tolerance = planck_tolerance(450.0, 1500.0, EPSILON_32) + steps * EPSILON_32;
            assert_close(seen, expected, tolerance, &format!("{steps} steps"));
        }
    }
}

#[test]
fn case_57_a_direction_without_length_is_refused_and_others_are_normalised_once() {
    for bad in [
        DVec3::ZERO,
        DVec3::new(-0.0, 0.0, -0.0),
        DVec3::NAN,
        DVec3::INFINITY,
    ] {
        assert!(Ray::new(DVec3::ZERO, bad).is_none(), "{bad}");
    }
    let along = DVec3::new(1.0, -2.0, 0.5);
    for length in [1e-100, 1e-3, 5.0, 1e100] {
        let ray = Ray::new(DVec3::ONE, length * along).unwrap();
        assert!((ray.direction - along.normalize()).length() < 4.0 * f64::EPSILON);
        assert!((ray.direction.length() - 1.0).abs() < 4.0 * f64::EPSILON);
    }
    let error = refusal(&["camera.eye=[1,2,3]", "camera.target=[1,2,3]"]);
    assert!(
        matches!(error, ProjectError::Camera(CameraError::NoDirection)),
        "{error:?}"
    );
    assert!(
        error
            .to_string()
            .contains("are the same point: move one of them"),
        "{error}"
    );
    // A target a thousand times as far and a longer up are the same directions: τ does not scale.
    let near = seen_from(DVec3::NEG_Y, DVec3::ZERO);
    assert_eq!(near, seen_from(DVec3::NEG_Y, 1e3 * DVec3::Y));
    assert_slab(near, LENGTH_M, "normalised");
}

#[test]
fn case_58_a_negative_zero_is_a_zero() {
    for origin in [
        [-1.0, 0.5, 0.5],
        [-1.0, 0.0, 1.0],
        [-1.0, 1.5, 0.5],
        [0.5, 0.5, 0.5],
    ] {
        for forward in [1.0, -1.0] {
            let expected = hit(origin, [forward, 0.0, 0.0]);
            for (y, z) in [(-0.0, 0.0), (0.0, -0.0), (-0.0, -0.0)] {
                assert_eq!(hit(origin, [forward, y, z]), expected, "{origin:?}");
            }
        }
    }
    let zero = seen_from(DVec3::new(0.0, -1.0, 0.0), DVec3::ZERO);
    for eye in [DVec3::new(-0.0, -1.0, 0.0), DVec3::new(-0.0, -1.0, -0.0)] {
        assert_eq!(seen_from(eye, DVec3::new(0.0, 0.0, -0.0)), zero);
        assert_eq!(seen_from(eye, DVec3::new(-0.0, 0.0, 0.0)), zero);
    }
    // From the other side, with the order of the planes turned round.
    assert_slab(seen_from(DVec3::Y, DVec3::ZERO), LENGTH_M, "from behind");
}
