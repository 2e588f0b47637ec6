//! The march against the unbiased reference, on whole pictures.
//!
//! The long version compares two real fires as well, with an eighth of the variance:
//! `cargo test --release --test main -- --ignored at_length`.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use sootlight::physics::blackbody;
use sootlight::project::{Preset, Project};
use sootlight::render::march::Marcher;
use sootlight::render::null_collision::{Estimate, NullCollision, Params, Scattering};
use sootlight::render::{Plan, Switch};
use sootlight::scene::{Camera, Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;
use sootlight::volume::{self, Border, BuiltIn, Grid, Limits, Volume};

use super::super::common;
use super::z_test::Comparison;

/// Width and height of the pictures.
const SIZE: [u32; 2] = [24, 24];
/// Paths for each pixel.
const SAMPLES: u32 = 2048;
const MANY_SAMPLES: u32 = 16384;

/// The march's step, at which its own error is far below the noise, and half of it, which shows that error: it falls to
/// a quarter, so their difference is three quarters of it.
const STEP_VOXELS: f64 = 1.0 / 32.0;
/// The most by which the step's error may shift any pixel's z and the mean z: a quarter and a tenth of their limits.
const WORST_SHIFT: f64 = 1.2;
const MEAN_SHIFT: f64 = 0.35;

/// XYZ of the march through all pixel centres.
fn marched(scene: &Scene, wavelengths: &Wavelengths, step_voxels: f64) -> Vec<[f64; 3]> {
    let plan = Plan::with_wavelengths(scene, SIZE, wavelengths.clone());
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    let pixels: Vec<[u32; 2]> = (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
        .collect();
    let packets = pixels.chunks(16).flat_map(|packet| {
        let point = |lane: usize| {
            packet
                .get(lane)
                .map(|pixel| pixel.map(|side| f64::from(side) + 0.5))
        };
        let (light, _) = marcher.march(&std::array::from_fn(point));
        light.into_iter().take(packet.len()).collect::<Vec<_>>()
    });
    packets.map(|pixel| pixel.xyz.map(f64::from)).collect()
}

/// Asserts that the march is right on every pixel and on all together, and that one that is 1 % off would be found out.
fn assert_agreement(name: &str, scene: &Scene, samples: u32) {
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let reference = NullCollision::new(scene, &wavelengths, &Params::default());
    let estimates = reference.render(SIZE, samples, 1).unwrap();
    let [ours, finer] = [STEP_VOXELS, 0.5 * STEP_VOXELS]
        .map(|step_voxels| marched(scene, &wavelengths, step_voxels));

    let agreement = Comparison::new(&estimates, &ours);
    println!("{name}: {agreement:.3?}");
    assert!(
        agreement.pixels > 40 && agreement.noise < 0.05,
        "{name}: {agreement:?}"
    );
    assert!(agreement.each_agrees(), "{name}: {agreement:?}");
    assert!(agreement.all_agree(), "{name}: {agreement:?}");

    // The same comparison with the finer march in the estimate's place shows the step's error in units of the noise.
    let step_error: Vec<Estimate> = estimates
        .iter()
        .zip(&finer)
        .map(|(estimate, &mean)| Estimate { mean, ..*estimate })
        .collect();
    let shift = Comparison::new(&step_error, &ours);
    println!(
        "{name}: half a step shifts z by {:.3}, all together by {:.3?}",
        shift.worst, shift.together
    );
    assert!(shift.worst < WORST_SHIFT, "{name}: {shift:?}");
    assert!(
        shift.together.iter().all(|z| z.abs() < MEAN_SHIFT),
        "{name}: {shift:?}"
    );

    for planted in [0.99, 1.01] {
        let biased: Vec<[f64; 3]> = ours.iter().map(|xyz| xyz.map(|v| planted * v)).collect();
        let found = Comparison::new(&estimates, &biased);
        println!("{name}: {planted} gives {:.1?}", found.together);
        assert!(
            !found.all_agree(),
            "{name}: {planted} goes unseen: {found:?}"
        );
    }
}

/// A brick of voxels of 10 km with soot in one corner, as dense as an artist can make it: its empty part is crossed by paths
/// whose collisions are all with nothing, a hundred million times in a voxel if nobody stops them.
#[test]
fn the_clear_part_of_a_brick_with_soot_beyond_measure_is_crossed_in_a_moment() {
    let grid = |name: &str, soot: f32, clear: f32| {
        let scale = DAffine3::from_scale(DVec3::splat(1e4));
        Grid::from_fn(name, IVec3::splat(8), scale, Border::Clamp, 0.0, |at| {
            if at == IVec3::ZERO { soot } else { clear }
        })
    };
    let grids = vec![grid("soot", 1e-4, 0.0), grid("temperature", 1800.0, 1800.0)];
    // Past the corner, through what is clear.
    let camera = Camera {
        eye: DVec3::new(5e4, -1e5, 5e4),
        target: DVec3::splat(5e4),
        up: DVec3::Z,
        fov_deg: 1.0,
        roll_deg: 0.0,
    };
    let scene = common::scene(Volume::from_grids(grids, "corner"), camera);
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let params = Params {
        scattering: Scattering::Albedo(0.5),
        ..Params::default()
    };
    let paths = NullCollision::new(&scene, &wavelengths, &params);
    let clear = paths.render([4, 4], 64, 1).unwrap();
    assert!(clear.iter().all(|pixel| pixel.mean == [0.0; 3]));
    // The corner itself is as bright as a black body, where nothing scatters.
    let mut scene = scene;
    scene.camera.target = DVec3::ZERO;
    let paths = NullCollision::new(&scene, &wavelengths, &Params::default());
    let dense = paths.render([4, 4], 64, 1).unwrap();
    let planck = |&nm: &f64| blackbody::spectral_radiance(nm, 1800.0);
    let expected = wavelengths.xyz_of(wavelengths.nodes_nm.iter().map(planck));
    for pixel in dense {
        for (found, expected) in pixel.mean.iter().zip(expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-3,
                "{pixel:?} {expected:?}"
            );
        }
    }
}

#[test]
fn the_march_agrees_with_the_reference_on_the_torch() {
    assert_agreement("torch", &common::torch_scene(1.0), SAMPLES);
}

#[test]
fn the_march_agrees_with_the_reference_where_radicals_glow_among_smooth_soot() {
    // Enough of it to shine beside the sooty tip.
    let mut project = Preset::named("gas-burner").unwrap().project();
    project
        .set_all(["fuel.blue_glow=10000", "render.interpolation=tricubic"])
        .unwrap();
    project.render.size = SIZE;
    let job = project.job(&Arc::new(BuiltIn::Burner.volume())).unwrap();
    assert_agreement("burner", &job.scene(None), SAMPLES);
}

#[test]
fn the_march_agrees_with_the_reference_on_the_standard_plume() {
    let Some(shared) = common::shared() else {
        return;
    };
    assert_agreement("plume", &plume(&shared), SAMPLES);
}

#[test]
fn the_march_agrees_with_the_reference_on_a_real_fire() {
    let Some(shared) = common::shared() else {
        return;
    };
    let scene = real(&shared.join("data/campfire/campfire_0022_zip_half.vdb"));
    assert_agreement("campfire", &scene, SAMPLES);
}

#[test]
#[ignore = "a minute on two cores"]
fn the_march_agrees_with_the_reference_at_length() {
    assert_agreement("torch", &common::torch_scene(1.0), MANY_SAMPLES);
    let Some(shared) = common::shared() else {
        return;
    };
    assert_agreement("plume", &plume(&shared), MANY_SAMPLES);
    for file in [
        "campfire/campfire_0022_zip_half.vdb",
        "pool/pool_0022_zip_half.vdb",
    ] {
        assert_agreement(file, &real(&shared.join("data").join(file)), MANY_SAMPLES);
    }
}

fn plume(shared: &Path) -> Scene {
    common::scene_file("plume.toml", &shared.join("data/plume/plume.vdb"), SIZE).0
}

/// A file as it opens without a word from anybody.
fn real(file: &Path) -> Scene {
    let volume = volume::open(&[file.to_path_buf()], &Limits::default()).unwrap();
    let mut project = Project::default();
    project.render.size = SIZE;
    // Emission and absorption alone; what scatters is held to the reference in `scattering`.
    project.effects.scattering = Switch::Off;
    project.job(&Arc::new(volume)).unwrap().scene(None)
}
