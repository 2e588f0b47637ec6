//! The march with light scattered once against the unbiased reference, on whole pictures.
//!
//! The march takes its light from all sides from a field of cells, so its own error is not noise alone: these tests
//! show that it is below what two thousand paths a pixel can tell.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use sootlight::project::{Preset, Project};
use sootlight::render::march::Marcher;
use sootlight::render::null_collision::{Estimate, NullCollision, Params, Scattering};
use sootlight::render::{Cancel, Plan, Settings, Switch, render_still};
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::volume::{self, Border, BuiltIn, Grid, Limits, Volume};

use super::super::common;
use super::z_test::Comparison;

const SIZE: [u32; 2] = [24, 24];
/// Edge of a block of pixels that are compared together.
const BLOCK: usize = 3;
/// Paths for each pixel; more where scattered light is much of the picture, so that 1 % can be told.
const SAMPLES: u32 = 2048;
const MORE_SAMPLES: u32 = 8192;
const MOST_SAMPLES: u32 = 16384;
const SEED: u64 = 1;
/// Relative error of the light from all sides at single places: what `scatter`'s own tests find, root mean square.
const FIELD_ERROR: f64 = 0.04;
/// The march's step, at which its own error is far below the noise.
const STEP_VOXELS: f64 = 1.0 / 32.0;

/// Particles that scatter a fifth as much as they absorb.
const LARGE: [&str; 3] = [
    "effects.scattering=on",
    "soot.radius_nm=60",
    "soot.hold=volume",
];

/// A project's scene, with scattering by large particles and what else is set.
fn scattering(mut project: Project, volume: Volume, more: &[&str]) -> Scene {
    project.set_all(LARGE).unwrap();
    project.set_all(more.iter().copied()).unwrap();
    project.render.size = SIZE;
    project.job(&Arc::new(volume)).unwrap().scene(None)
}

/// XYZ of the march through all pixel centres, with or without scattered light.
fn marched(scene: &Scene, scattering: Switch) -> Vec<[f64; 3]> {
    let settings = Settings {
        size: SIZE,
        step_voxels: STEP_VOXELS,
        wavelengths: WavelengthSet::Fitted(6),
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: common::scattered_alone(scattering),
    };
    let plan = Plan::new(scene, &settings);
    let marcher = Marcher::new(scene, &plan, settings.step_voxels).unwrap();
    let pixels: Vec<[u32; 2]> = (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
        .collect();
    let packets = pixels.chunks(16).flat_map(|packet| {
        let point = |lane: usize| {
            let pixel = packet.get(lane)?;
            Some(pixel.map(|side| f64::from(side) + 0.5))
        };
        let (light, _) = marcher.march(&std::array::from_fn(point));
        light.into_iter().take(packet.len()).collect::<Vec<_>>()
    });
    packets.map(|pixel| pixel.xyz.map(f64::from)).collect()
}

/// Sums over blocks of pixels. A dim pixel beside the fire sees it by few paths, and a mean of few is skew: it is mostly too
/// low, and then its variance as well. Blocks are brighter, and know nine times as many paths.
fn in_blocks(estimates: &[Estimate]) -> Vec<Estimate> {
    let corners = (0..SIZE[1]).step_by(BLOCK).flat_map(|y| {
        let row = (0..SIZE[0]).step_by(BLOCK);
        row.map(move |x| (y * SIZE[0] + x) as usize)
    });
    let rows = (0..BLOCK).flat_map(|y| (0..BLOCK).map(move |x| y * SIZE[0] as usize + x));
    let sum = |corner: usize| {
        let mut sum = known([0.0; 3]);
        for estimate in rows.clone().map(|step| &estimates[corner + step]) {
            for c in 0..3 {
                sum.mean[c] += estimate.mean[c];
                sum.variance_of_mean[c] += estimate.variance_of_mean[c];
            }
        }
        sum
    };
    corners.map(sum).collect()
}

/// A number without noise.
fn known(mean: [f64; 3]) -> Estimate {
    Estimate {
        mean,
        variance_of_mean: [0.0; 3],
    }
}

/// Asserts that the march is right on every block and on all together, and that one that is 1 % off would be found out.
fn assert_agreement(name: &str, scene: &Scene, samples: u32) {
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let params = Params {
        scattering: Scattering::Flame,
        max_bounces: 1,
        scattering_points: 8.0,
        ..Params::default()
    };
    let pictures = |params: &Params, samples: u32| {
        let reference = NullCollision::new(scene, &wavelengths, params);
        in_blocks(&reference.render(SIZE, samples, SEED).unwrap())
    };
    let mut estimates = pictures(&params, samples);
    let scattered = Params {
        min_bounces: 1,
        ..params
    };
    // The march's own error is as uncertain as the reference's noise.
    for (estimate, scattered) in estimates.iter_mut().zip(pictures(&scattered, samples / 8)) {
        for c in 0..3 {
            estimate.variance_of_mean[c] += (FIELD_ERROR * scattered.mean[c]).powi(2);
        }
    }
    let ours: Vec<Estimate> = marched(scene, Switch::On).into_iter().map(known).collect();
    let ours: Vec<[f64; 3]> = in_blocks(&ours).iter().map(|block| block.mean).collect();

    let agreement = Comparison::new(&estimates, &ours);
    println!("{name}: {agreement:.3?}");
    for planted in [0.99, 1.01] {
        let biased: Vec<[f64; 3]> = ours.iter().map(|xyz| xyz.map(|v| planted * v)).collect();
        let found = Comparison::new(&estimates, &biased);
        println!("{name}: {planted} gives {:.1?}", found.together);
        assert!(
            !found.all_agree(),
            "{name}: {planted} goes unseen: {found:?}"
        );
    }
    assert!(
        agreement.pixels > 12 && agreement.noise < 0.1,
        "{name}: {agreement:?}"
    );
    assert!(agreement.each_agrees(), "{name}: {agreement:?}");
    assert!(agreement.all_agree(), "{name}: {agreement:?}");
}

#[test]
fn light_scattered_once_agrees_with_the_reference_on_the_torch() {
    let torch = volume::procedural::torch();
    assert_agreement(
        "torch",
        &scattering(Project::default(), torch, &[]),
        SAMPLES,
    );
}

#[test]
fn light_scattered_ahead_and_back_agrees_with_the_reference() {
    for asymmetry in ["soot.asymmetry=0.6", "soot.asymmetry=-0.5"] {
        let torch = volume::procedural::torch();
        let scene = scattering(Project::default(), torch, &[asymmetry]);
        assert_agreement(asymmetry, &scene, SAMPLES);
    }
}

#[test]
fn the_light_of_radicals_is_scattered_as_the_reference_says() {
    // Enough of it to shine beside the sooty tip, and enough soot to scatter it.
    let scene = scattering(
        Preset::named("gas-burner").unwrap().project(),
        BuiltIn::Burner.volume(),
        &[
            "fuel.blue_glow=10000",
            "soot.amount=4",
            "render.interpolation=tricubic",
        ],
    );
    assert_agreement("burner", &scene, SAMPLES);
}

/// A hot column of soot with a cold bank of smoke beside it, 20 cm high.
fn smoke_beside_soot() -> Volume {
    let size = IVec3::new(40, 24, 32);
    let voxel_m = 0.2 / 32.0;
    let grid = |name: &str, background: f32, value: &(dyn Fn(DVec3) -> f64 + Sync)| {
        Grid::from_fn(
            name,
            size,
            DAffine3::from_scale(DVec3::splat(voxel_m)),
            Border::Background,
            background,
            |voxel| value(voxel.as_dvec3()) as f32,
        )
    };
    // Smooth bumps around places in voxels, 1 in the middle.
    let soot = |at: DVec3| {
        let off = (at - DVec3::new(10.0, 12.0, at.z)).length();
        f64::exp(-(off / 4.0).powi(2))
    };
    let smoke = |at: DVec3| {
        let off = at - DVec3::new(28.0, 12.0, 16.0);
        f64::exp(-(off / DVec3::new(5.0, 6.0, 9.0)).length_squared())
    };
    Volume::from_grids(
        vec![
            grid("soot", 0.0, &|at| 1e-6 * soot(at)),
            grid("smoke", 0.0, &|at| 3e-6 * smoke(at)),
            grid("temperature", 300.0, &|at| 400.0 + 1400.0 * soot(at)),
        ],
        "smoke beside soot",
    )
}

#[test]
fn smoke_in_the_light_of_a_fire_agrees_with_the_reference() {
    let scene = scattering(
        common::physical(),
        smoke_beside_soot(),
        &["smoke.albedo=0.5", "soot.asymmetry=0.4"],
    );
    assert_agreement("smoke", &scene, MOST_SAMPLES);

    // Smoke is black but for the light that it scatters.
    let [with, without] = [Switch::On, Switch::Off].map(|scattering| {
        let right = marched(&scene, scattering)
            .into_iter()
            .enumerate()
            .filter(|(pixel, _)| pixel % SIZE[0] as usize > SIZE[0] as usize * 5 / 8);
        right.map(|(_, xyz)| xyz[1]).sum::<f64>()
    });
    println!("smoke: {with:e} against {without:e}");
    assert!(with > 10.0 * without, "{with:e} {without:e}");
}

fn shared_volume(shared: &Path, file: &str) -> Volume {
    let path = shared.join("data").join(file);
    volume::open(&[path], &Limits::default()).unwrap()
}

#[test]
fn light_scattered_once_agrees_with_the_reference_on_the_standard_plume() {
    let Some(shared) = common::shared() else {
        return;
    };
    let scene_file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/plume.toml");
    let plume = Project::read(&scene_file).unwrap();
    let volume = shared_volume(&shared, "plume/plume.vdb");
    assert_agreement("plume", &scattering(plume, volume, &[]), SAMPLES);
}

#[test]
fn light_scattered_once_agrees_with_the_reference_on_a_real_fire() {
    let Some(shared) = common::shared() else {
        return;
    };
    let volume = shared_volume(&shared, "campfire/campfire_0022_zip_half.vdb");
    let scene = scattering(Project::default(), volume, &[]);
    assert_agreement("campfire", &scene, MORE_SAMPLES);
}

/// Mean X, Y, Z of the light of all pixels of a still.
fn mean_of_still(scene: &Scene, scattering_orders: u32, threads: usize) -> ([f64; 3], Vec<u32>) {
    let settings = Settings {
        size: SIZE,
        step_voxels: 0.25,
        wavelengths: WavelengthSet::Fitted(6),
        samples_per_pixel: 4,
        scattering_orders,
        effects: common::scattered_alone(Switch::On),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let frame = pool.build().unwrap().install(|| {
        render_still(scene, &settings, &Cancel::never(), &|_| {}).expect("nobody cancels")
    });
    let pixels = frame.film.pixels();
    let bits = pixels.iter().flat_map(|pixel| pixel.xyz.map(f32::to_bits));
    let mean = |c: usize| {
        let sum: f64 = pixels.iter().map(|pixel| f64::from(pixel.xyz[c])).sum();
        sum / pixels.len() as f64
    };
    ([0, 1, 2].map(mean), bits.collect())
}

#[test]
fn orders_beyond_the_first_are_added_on_request() {
    let scene = scattering(
        Project::default(),
        BuiltIn::Torch.volume(),
        &["soot.radius_nm=80", "soot.amount=2"],
    );
    let (once, _) = mean_of_still(&scene, 1, 2);
    let (all, bits) = mean_of_still(&scene, 64, 2);
    assert_eq!(
        bits,
        mean_of_still(&scene, 64, 1).1,
        "threads make a difference"
    );
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let added_by_paths = |samples: u32| {
        let params = Params {
            scattering: Scattering::Flame,
            min_bounces: 2,
            scattering_points: 8.0,
            ..Params::default()
        };
        let reference = NullCollision::new(&scene, &wavelengths, &params);
        let estimates = reference.render(SIZE, samples, 5).unwrap();
        let count = estimates.len() as f64;
        let [mut sum, mut variance] = [0.0; 2];
        for estimate in estimates {
            sum += estimate.mean[1] / count;
            variance += estimate.variance_of_mean[1] / (count * count);
        }
        (sum, variance.sqrt())
    };
    let (expected, error) = added_by_paths(1024);
    let added = all[1] - once[1];
    // Our 256 paths a pixel are as independent as the reference's 1024; pixels' centres and their areas differ by far less.
    assert!(
        (added - expected).abs() < 5.0 * 2.3 * error,
        "{added:e} was added, not {expected:e} ± {error:e}"
    );
    assert!(
        added > 20.0 * error && added > 2e-3 * once[1],
        "{added:e} of {:e}",
        once[1]
    );
}
