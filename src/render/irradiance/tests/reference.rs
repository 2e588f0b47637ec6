//! Against the unbiased reference, on a picture of lit ground and a sphere.

use super::*;
use crate::colour::reflectance::Reflectance;
use crate::render::null_collision::{NullCollision, Params};
use crate::scene::stage::{Ground, Sphere};

/// Width and height of the picture.
const SIZE: [u32; 2] = [24, 24];
/// Paths for each pixel.
const SAMPLES: u32 = 1024;

#[test]
fn lit_surfaces_agree_with_the_reference() {
    let stage = Stage {
        ground: Some(Ground {
            height_m: 0.0,
            colour: [0.6, 0.45, 0.3],
        }),
        spheres: vec![Sphere {
            centre: DVec3::new(0.03, -0.26, 0.03),
            radius_m: 0.03,
            colour: [0.2, 0.5, 0.7],
        }],
        ..Stage::default()
    };
    // The rays to the ground pass before the fire: they see nothing but surfaces.
    let scene = Scene {
        camera: Camera {
            eye: DVec3::new(0.0, -0.9, 0.5),
            target: DVec3::new(0.0, -0.26, 0.0),
            up: DVec3::Z,
            fov_deg: 12.0,
        },
        ..scene(flame(procedural::torch()), stage)
    };
    let plan = plan(&scene);
    let light = light(&scene, &plan, Level::Fine);
    let view = scene.camera.view(SIZE).unwrap();
    let expected = |x: u32, y: u32| {
        let ray = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let hit = scene.stage.hit(&ray, f64::INFINITY).unwrap();
        let place = [hit.point, hit.normal];
        let falls = irradiance(&light, &plan, &scene.stage, place);
        let reflectance = Reflectance::of(hit.colour);
        let nodes = falls.iter().zip(&plan.tables.wavelengths.nodes_nm);
        let sent = nodes.map(|(falls, &nm)| falls * reflectance.at(nm) / std::f64::consts::PI);
        plan.tables.wavelengths.xyz_of(sent)
    };
    let reference = NullCollision::new(&scene, &plan.tables.wavelengths, &Params::default());
    let estimates = reference.render(SIZE, SAMPLES, 1).unwrap();
    let (mut worst, mut compared, mut sums) = (0.0_f64, 0, [0.0; 3]);
    for (i, estimate) in (0..).zip(&estimates) {
        let ours = expected(i % SIZE[0], i / SIZE[0]);
        // Where few paths find light, the noise of a single pixel is not known.
        let found = estimate.mean[1].powi(2) > 36.0 * estimate.variance_of_mean[1];
        if found {
            let z = (estimate.mean[1] - ours[1]).abs() / estimate.variance_of_mean[1].sqrt();
            worst = worst.max(z);
            compared += 1;
        }
        sums[0] += estimate.mean[1];
        sums[1] += ours[1];
        sums[2] += estimate.variance_of_mean[1];
    }
    let [mean, ours, variance] = sums;
    let together = (mean - ours) / variance.sqrt();
    println!(
        "worst z of {compared} {worst:.2}, together z {together:.2}: {:.2} % off, noise {:.2} %",
        100.0 * (ours / mean - 1.0),
        100.0 * variance.sqrt() / mean
    );
    // Of 576 normal numbers the largest is below 4.9 with a probability of 0.999; single paths are skew.
    assert!(compared > 150 && worst < 5.5, "{compared} {worst}");
    assert!(together.abs() < 3.3, "{together}");

    // With no reflection surfaces are black.
    let black = Params {
        max_reflections: 0,
        ..Params::default()
    };
    let reference = NullCollision::new(&scene, &plan.tables.wavelengths, &black);
    for pixel in reference.render([4, 4], 64, 1).unwrap() {
        assert_eq!(pixel.mean, [0.0; 3]);
    }
}
