//! Light that is scattered more than once, as a picture adds it, against the unbiased reference.
//!
//! Both weigh their paths by the same code, which `furnace.rs` holds to closed forms. What is held here is that a picture's
//! other rates of collisions and other odds of scattering change no mean, and that the picture adds what they bring.

use std::sync::{Arc, Mutex};

use glam::{DAffine3, DVec3, IVec3};
use sootlight::render::null_collision::{Estimate, NullCollision, Params, Scattering};
use sootlight::render::{Audience, Cancel, Film, Pass, Plan, Settings, Switch, render_pass};
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::volume::{Border, Grid, Volume};

use super::super::common;

/// The pictures are compared in blocks of pixels: the rays of ours are spread over their pixels, those of the reference go
/// through the pixels' centres, and a block's mean differs by less than a thousandth between the two.
const SIZE: [u32; 2] = [24, 24];
const BLOCK: usize = 8;
const ORDERS: u32 = 16;
const WAVELENGTHS: WavelengthSet = WavelengthSet::Fitted(6);
/// Rays for each pixel of ours, and the reference's paths.
const SAMPLES: u32 = 8;
const REFERENCE_SAMPLES: u32 = 512;
/// A true mean is told to be wrong once in 16 000 times for each number.
const STANDARD_ERRORS: f64 = 4.0;

/// A ball of white smoke around a hot core of soot.
fn white_cloud() -> Volume {
    const EDGE: i32 = 32;
    let grid = |name: &str, background: f32, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(
            name,
            IVec3::splat(EDGE),
            DAffine3::from_scale(DVec3::splat(0.01)),
            Border::Background,
            background,
            |voxel| {
                let middle = DVec3::splat(0.5 * f64::from(EDGE - 1));
                value((voxel.as_dvec3() - middle).length()) as f32
            },
        )
    };
    let core = |radius: f64| f64::exp(-(radius / 7.0).powi(4));
    let smoke = |radius: f64| f64::exp(-(radius / 12.0).powi(4)) - 0.9 * core(radius);
    Volume::from_grids(
        vec![
            grid("soot", 0.0, &|radius| 1e-6 * core(radius)),
            grid("smoke", 0.0, &|radius| 5e-8 * smoke(radius)),
            grid("temperature", 300.0, &|radius| {
                400.0 + 1400.0 * core(radius)
            }),
        ],
        "white cloud",
    )
}

fn scene(more: &[&str]) -> Scene {
    let mut project = common::physical();
    let keys = ["effects.scattering=on", "smoke.albedo=0.99"];
    project.set_all(keys).unwrap();
    project.set_all(more.iter().copied()).unwrap();
    project.render.size = SIZE;
    let job = project.job(&Arc::new(white_cloud())).unwrap();
    job.scene(None)
}

fn settings(scattering_orders: u32) -> Settings {
    Settings {
        size: SIZE,
        step_voxels: 1.0,
        wavelengths: WAVELENGTHS,
        samples_per_pixel: 1,
        scattering_orders,
        effects: common::scattered_alone(Switch::On),
    }
}

/// XYZ of one ray for each pixel.
fn rays(scene: &Scene, plan: &Plan, sample: u32) -> Vec<[f64; 3]> {
    let pass = Pass {
        stride: 1,
        sample,
        samples: SAMPLES,
        step_voxels: 1.0,
        region: None,
        audience: Audience::Still,
    };
    let film = Mutex::new(Film::new(SIZE));
    // The first ray of a film is shown as it is.
    let finished = render_pass(scene, plan, &pass, &Cancel::never(), &|mut tile| {
        tile.sample = 0;
        film.lock().unwrap().merge(&tile);
    });
    assert!(finished);
    let film = film.into_inner().unwrap();
    let xyz = |pixel: &sootlight::render::Pixel| pixel.xyz.map(f64::from);
    film.pixels().iter().map(xyz).collect()
}

/// What a picture adds beyond the first order, which is the same to the last bit in both pictures, as the mean of
/// independent rays.
fn added(scene: &Scene) -> Vec<Estimate> {
    let plans = [1, ORDERS].map(|orders| Plan::new(scene, &settings(orders)));
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    let mut sums = vec![[[0.0; 2]; 3]; pixels];
    for sample in 0..SAMPLES {
        let [once, all] = [0, 1].map(|n| rays(scene, &plans[n], sample));
        for (sums, (once, all)) in sums.iter_mut().zip(once.iter().zip(&all)) {
            for (c, [sum, squares]) in sums.iter_mut().enumerate() {
                let more = all[c] - once[c];
                *sum += more;
                *squares += more * more;
            }
        }
    }
    let count = f64::from(SAMPLES);
    let estimate = |sums: &[[f64; 2]; 3]| Estimate {
        mean: sums.map(|[sum, _]| sum / count),
        variance_of_mean: sums
            .map(|[sum, squares]| (squares - sum * sum / count) / (count - 1.0) / count),
    };
    sums.iter().map(estimate).collect()
}

/// Sums over blocks of pixels, and that of all, with their variances.
fn in_blocks(estimates: &[Estimate]) -> Vec<Estimate> {
    let side = SIZE[0] as usize / BLOCK;
    let none = Estimate {
        mean: [0.0; 3],
        variance_of_mean: [0.0; 3],
    };
    let mut blocks = vec![none; side * side + 1];
    for (pixel, estimate) in estimates.iter().enumerate() {
        let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize];
        for block in [y / BLOCK * side + x / BLOCK, side * side] {
            for c in 0..3 {
                blocks[block].mean[c] += estimate.mean[c];
                blocks[block].variance_of_mean[c] += estimate.variance_of_mean[c];
            }
        }
    }
    blocks
}

/// Asserts that what a picture adds is what plain paths bring, which scatter as often as nature has it and end where they
/// weigh nothing.
fn assert_agreement(name: &str, scene: &Scene) {
    let wavelengths = WAVELENGTHS.wavelengths(scene.flame.soot());
    let params = Params {
        scattering: Scattering::Flame,
        min_bounces: 2,
        max_bounces: ORDERS,
        ..Params::default()
    };
    let reference = NullCollision::new(scene, &wavelengths, &params);
    // No picture's ray has so high a seed.
    let reference = reference.render(SIZE, REFERENCE_SAMPLES, 1 << 40).unwrap();
    let (expected, ours) = (in_blocks(&reference), in_blocks(&added(scene)));
    let mut worst = 0.0_f64;
    for (expected, ours) in expected.iter().zip(&ours) {
        for c in 0..3 {
            let variance = expected.variance_of_mean[c] + ours.variance_of_mean[c];
            worst = worst.max((ours.mean[c] - expected.mean[c]).abs() / variance.sqrt());
        }
    }
    let noise = [&expected, &ours].map(|blocks| {
        let all = blocks[blocks.len() - 1];
        all.variance_of_mean[1].sqrt() / all.mean[1]
    });
    let all = [&expected, &ours].map(|blocks| blocks[blocks.len() - 1].mean[1]);
    println!("{name}: worst {worst:.2} standard errors, noise of all {noise:.4?}, {all:.3?}");
    // An error of a fourteenth of all would be found.
    assert!(
        noise.iter().all(|noise| *noise < 0.012),
        "{name}: {noise:?}"
    );
    assert!(worst < STANDARD_ERRORS, "{name}: {worst}");
}

#[test]
fn higher_orders_of_a_thick_white_cloud_agree_with_the_reference() {
    assert_agreement("white cloud", &scene(&[]));
}

#[test]
fn higher_orders_agree_where_light_is_scattered_ahead() {
    assert_agreement("ahead", &scene(&["soot.asymmetry=0.5"]));
}

#[test]
fn noise_of_thick_smoke_is_told_where_higher_orders_are_asked_for() {
    let told = |orders: u32, more: &[&str]| {
        let plan = Plan::new(&scene(more), &settings(orders));
        plan.flaws.iter().any(|flaw| flaw.contains("noisy"))
    };
    let thick = ["smoke.amount=10"];
    assert!(told(2, &thick) && !told(1, &thick));
    let thin = ["smoke.amount=0.1", "soot.amount=0.1"];
    assert!(!told(2, &thin));
}

#[test]
fn a_cancelled_picture_of_higher_orders_gives_no_tile() {
    // Its fields are worked out before and not what is cancelled.
    let scene = scene(&[]);
    let plan = Plan::new(&scene, &settings(ORDERS));
    let _ = rays(&scene, &plan, 0);
    let pass = Pass {
        stride: 1,
        sample: 0,
        samples: 1,
        step_voxels: 1.0,
        region: None,
        audience: Audience::Still,
    };
    let passed = Cancel::when_passed(Arc::new(1.into()), 0);
    let tiles = Mutex::new(0);
    let finished = render_pass(&scene, &plan, &pass, &passed, &|_| {
        *tiles.lock().unwrap() += 1;
    });
    assert!(!finished && tiles.into_inner().unwrap() == 0);
}

/// The luminance that fields of light scattered again add to a picture, over what paths of two and more scatterings bring.
fn fields_over_paths(scene: &Scene, rays: u32) -> f64 {
    let with = |again: Switch| {
        let mut settings = settings(1);
        settings.effects.scattering_orders = again;
        let plan = Plan::new(scene, &settings);
        let light = rays_of(scene, &plan);
        light.iter().map(|xyz| xyz[1]).sum::<f64>()
    };
    let added = with(Switch::On) - with(Switch::Off);
    let wavelengths = WAVELENGTHS.wavelengths(scene.flame.soot());
    let params = Params {
        scattering: Scattering::Flame,
        min_bounces: 2,
        max_bounces: 64,
        ..Params::default()
    };
    let reference = NullCollision::new(scene, &wavelengths, &params);
    let reference = reference.render(SIZE, rays, 1 << 41).unwrap();
    added / reference.iter().map(|pixel| pixel.mean[1]).sum::<f64>()
}

fn rays_of(scene: &Scene, plan: &Plan) -> Vec<[f64; 3]> {
    rays(scene, plan, 0)
}

#[test]
fn light_scattered_again_by_fields_is_that_of_paths() {
    // Soot of 60 nm in a torch, as spheres scatter and evenly.
    for (asymmetry, within) in [(None, 0.12), (Some("soot.asymmetry=0"), 0.06)] {
        let mut project = sootlight::project::Project::default();
        let keys = ["effects.scattering=on", "soot.radius_nm=60"];
        project.set_all(keys.into_iter().chain(asymmetry)).unwrap();
        project.render.size = SIZE;
        let scene = project.job(&common::torch()).unwrap().scene(None);
        let ratio = fields_over_paths(&scene, 512);
        println!("{asymmetry:?}: {ratio:.3}");
        assert!((ratio - 1.0).abs() < within, "{asymmetry:?}: {ratio}");
    }
}
