//! Surfaces in the fire's light against the unbiased reference: ground and a sphere beside the torch.

use glam::DVec3;
use sootlight::render::Plan;
use sootlight::render::march::Marcher;
use sootlight::render::null_collision::{Estimate, NullCollision, Params};
use sootlight::scene::stage::{Ground, Sphere};
use sootlight::scene::{Camera, Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;
use sootlight::volume::procedural;

use super::super::common;
use super::z_test::Comparison;

/// Width and height of the picture.
const SIZE: u32 = 24;
/// Paths for each pixel.
const SAMPLES: u32 = 16384;
/// Edge of the blocks that are compared, pixels. Of all paths from a surface few meet the fire, so that a single pixel's
/// mean is too skew for a z test.
const BLOCK: u32 = 6;
/// How far the fire's light itself may be off: it is worked out without noise, but from cells and in a set of directions.
const OWN_ERROR: f64 = 0.01;
/// Standard errors that chance exceeds with a probability of 0.0003 at most.
const CHANCE: f64 = 3.6;
/// The march's step in voxels: before most surfaces there is nothing to march through.
const STEP_VOXELS: f64 = 0.25;

/// Ground and a sphere beside the torch; rays to them pass before the fire.
fn scene() -> Scene {
    let camera = Camera {
        eye: DVec3::new(0.0, -0.9, 0.5),
        target: DVec3::new(0.0, -0.26, 0.0),
        up: DVec3::Z,
        fov_deg: 12.0,
        roll_deg: 0.0,
    };
    let mut scene = common::scene(procedural::torch(), camera);
    scene.stage.ground = Some(Ground {
        height_m: 0.0,
        colour: [0.6, 0.45, 0.3],
    });
    scene.stage.spheres = vec![Sphere {
        centre: DVec3::new(0.03, -0.26, 0.03),
        radius_m: 0.03,
        colour: [0.2, 0.5, 0.7],
    }];
    scene
}

/// XYZ of the march through all pixels' middles, row by row.
fn marched(scene: &Scene, wavelengths: &Wavelengths) -> Vec<[f64; 3]> {
    let plan = Plan::with_wavelengths(scene, [SIZE; 2], wavelengths.clone());
    let marcher = Marcher::new(scene, &plan, STEP_VOXELS).unwrap();
    (0..SIZE * SIZE)
        .map(|i| {
            let [x, y] = [i % SIZE, i / SIZE].map(|side| f64::from(side) + 0.5);
            let mut points = [None; 16];
            points[0] = Some([x, y]);
            let (pixels, _) = marcher.march(&points);
            pixels[0].xyz.map(f64::from)
        })
        .collect()
}

/// Sums over blocks of pixels.
fn in_blocks<const N: usize>(pixels: impl Iterator<Item = [f64; N]>) -> Vec<[f64; N]> {
    let across = SIZE / BLOCK;
    let mut sums = vec![[0.0; N]; (across * across) as usize];
    for (i, pixel) in (0..).zip(pixels) {
        let sum = &mut sums[(i / SIZE / BLOCK * across + i % SIZE / BLOCK) as usize];
        for (sum, value) in sum.iter_mut().zip(pixel) {
            *sum += value;
        }
    }
    sums
}

#[test]
fn lit_surfaces_agree_with_the_reference() {
    let scene = scene();
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let reference = NullCollision::new(&scene, &wavelengths, &Params::default());
    let estimates = reference.render([SIZE; 2], SAMPLES, 1).unwrap();
    let means = in_blocks(estimates.iter().map(|it| it.mean));
    let variances = in_blocks(estimates.iter().map(|it| it.variance_of_mean));
    let ours = in_blocks(marched(&scene, &wavelengths).into_iter());
    let blocks: Vec<Estimate> = means
        .iter()
        .zip(&variances)
        .zip(&ours)
        .map(|((&mean, variance), ours)| Estimate {
            mean,
            variance_of_mean: std::array::from_fn(|c| variance[c] + (OWN_ERROR * ours[c]).powi(2)),
        })
        .collect();
    let agreement = Comparison::new(&blocks, &ours);
    println!("{agreement:.3?}");
    assert_eq!(agreement.pixels, blocks.len());
    assert!(agreement.each_agrees(), "{agreement:?}");

    // All blocks together; a light that is too bright or too dark by 3 % would be found out.
    for c in 0..3 {
        let sum = |blocks: &[[f64; 3]]| blocks.iter().map(|xyz| xyz[c]).sum::<f64>();
        let (reference, ours) = (sum(&means), sum(&ours));
        let most = OWN_ERROR + CHANCE * sum(&variances).sqrt() / reference;
        let is_off = |planted: f64| (planted * ours / reference - 1.0).abs() > most;
        println!(
            "{c}: {:+.2} %, most {:.2} %",
            100.0 * (ours / reference - 1.0),
            100.0 * most
        );
        assert!(!is_off(1.0), "{c}: {ours} {reference}");
        assert!(is_off(0.97) && is_off(1.03), "{c}: {most}");
    }
}

#[test]
fn surfaces_are_black_where_nothing_is_reflected() {
    let scene = scene();
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let black = Params {
        max_reflections: 0,
        ..Params::default()
    };
    let reference = NullCollision::new(&scene, &wavelengths, &black);
    for pixel in reference.render([4, 4], 64, 1).unwrap() {
        assert_eq!(pixel.mean, [0.0; 3]);
    }
}
