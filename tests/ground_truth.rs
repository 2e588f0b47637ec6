//! Closed forms, golden values and another method against the march.

use glam::{DAffine3, DVec3, IVec3};
use sootlight::math::Ray;
use sootlight::physics::blackbody;
use sootlight::render::along::{Along, DEPTH_NM};
use sootlight::render::march::Marcher;
use sootlight::render::{Cancel, Plan, Settings, Switch, render_still};
use sootlight::scene::{Camera, Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;
use sootlight::volume::{Border, Grid, Volume};

use super::common::{self, three};

mod cell_walk;
mod fire_light;
mod furnace;
mod glow;
mod null_collision;
mod orders;
mod plain;
mod precision;
mod scattering;
mod z_test;

/// Edge of the test cubes, m.
const EDGE_M: f64 = 0.5;

/// A cube of n³ voxels standing on the origin with soot and temperature by functions of depth y, 0 to 1.
fn cube(n: i32, soot: impl Fn(f64) -> f64 + Sync, kelvin: impl Fn(f64) -> f64 + Sync) -> Volume {
    let voxel = EDGE_M / f64::from(n);
    let world =
        DAffine3::from_scale(DVec3::splat(voxel)) * DAffine3::from_translation(DVec3::splat(0.5));
    let grid = |name: &str, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(name, IVec3::splat(n), world, Border::Clamp, 0.0, |voxel| {
            value((f64::from(voxel.y) + 0.5) / f64::from(n)) as f32
        })
    };
    Volume::from_grids(
        vec![grid("soot", &soot), grid("temperature", &kelvin)],
        "cube",
    )
}

/// Looks along +y at the middle of the cube.
fn scene_of(volume: Volume) -> Scene {
    let camera = Camera {
        eye: DVec3::new(0.25, -1.0, 0.25),
        target: DVec3::new(0.25, 0.0, 0.25),
        up: DVec3::Z,
        fov_deg: 30.0,
        roll_deg: 0.0,
    };
    common::scene(volume, camera)
}

/// Looks along the axis of `common::slab`.
fn along_the_slab() -> Camera {
    Camera {
        eye: DVec3::new(0.0, -1.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov_deg: 1.0,
        roll_deg: 0.0,
    }
}

fn settings(size: u32, step_voxels: f64, set: WavelengthSet) -> Settings {
    Settings {
        size: [size, size],
        step_voxels,
        wavelengths: set,
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: common::scattered_alone(Switch::Off),
    }
}

/// Radiance at three wavelengths and opacity along the camera's middle ray.
fn middle_ray(scene: &Scene, step_voxels: f64, nodes_nm: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let plan = Plan::with_wavelengths(scene, [64, 64], three(nodes_nm));
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    let mut points = [None; 16];
    points[5] = Some([32.0, 32.0]);
    let (pixels, _) = marcher.march(&points);
    (
        pixels[5].xyz.map(f64::from),
        pixels[5].opacity.map(f64::from),
    )
}

const RGB_NM: [f64; 3] = [630.0, 540.0, 450.0];

#[test]
fn an_isothermal_slab_has_its_closed_form_at_any_depth_and_step() {
    for volume_fraction in [1e-18, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3] {
        let scene = scene_of(cube(5, |_| volume_fraction, |_| 1700.0));
        for step in [0.07, 0.3, 1.0, 4.9, 5.0, 40.0] {
            let (radiance, opacity) = middle_ray(&scene, step, RGB_NM);
            for c in 0..3 {
                let sigma = scene.flame.absorption_per_sample(RGB_NM[c])
                    * f64::from(volume_fraction as f32);
                let expected_opacity = -(-sigma * EDGE_M).exp_m1();
                let expected = blackbody::spectral_radiance(RGB_NM[c], 1700.0) * expected_opacity;
                // f32: e^{−c₂/λT} loses x·6e-8 with x = 19 at 450 nm, the sums a few last bits.
                let error = (radiance[c] / expected - 1.0).abs();
                assert!(
                    error < 5e-6,
                    "f_v {volume_fraction:e}, step {step}: off by {error:e}"
                );
                let error = (opacity[c] / expected_opacity - 1.0).abs();
                assert!(
                    error < 1e-6,
                    "f_v {volume_fraction:e}, step {step}: opacity off by {error:e}"
                );
            }
        }
    }
}

#[test]
fn a_linear_temperature_slab_comes_to_its_golden_values() {
    // Depth 0 is the near face. The grid's half voxel of constant temperature at each end is 1/1024 of the ramp.
    let n = 512;
    let mut compared = 0;
    for row in common::golden("linear_temperature_slab.csv") {
        let [near, far, nm, tau, expected] = [row[0], row[1], row[2], row[3], row[4]];
        let dimmest = 1e-6 * blackbody::spectral_radiance(nm, near.max(far)) * 1e9;
        if !(400.0..=700.0).contains(&nm) || tau > 50.0 || expected < dimmest {
            continue;
        }
        let probe = scene_of(cube(1, |_| 1e-6, |_| 300.0));
        let volume_fraction = tau / EDGE_M / probe.flame.absorption_per_sample(nm);
        let slab = common::slab(
            n,
            EDGE_M,
            |_| volume_fraction,
            |depth| near + (far - near) * depth,
        );
        let scene = common::scene(slab, along_the_slab());
        let (radiance, _) = middle_ray(&scene, 1.0 / 128.0, [nm; 3]);
        // The golden file is per metre of wavelength.
        let error = (radiance[0] * 1e9 / expected - 1.0).abs();
        assert!(
            error < 4e-3,
            "{near} K → {far} K, {nm} nm, τ {tau}: off by {error:e}"
        );
        compared += 1;
    }
    assert!(compared >= 10, "only {compared} rows compared");
}

#[test]
fn what_lies_along_a_ray_is_what_the_slab_was_made_of() {
    let (near, far, soot) = (900.0, 1800.0, 3e-6);
    let slab = common::slab(64, EDGE_M, |_| soot, |depth| near + (far - near) * depth);
    let scene = common::scene(slab, along_the_slab());
    let along = Along::new(&scene, [1, 1], [0.5, 0.5]).unwrap();
    let [scattered, _] = scene.flame.scattering_per_sample(DEPTH_NM);
    let extinction = scene.flame.absorption_per_sample(DEPTH_NM) + scattered;
    let expected = soot * EDGE_M * extinction;
    assert!(
        (along.depth() / expected - 1.0).abs() < 1e-6,
        "{} instead of {expected}",
        along.depth()
    );
    let eye_m = -along_the_slab().eye.y;
    for place in &along.places {
        let depth = (place.distance_m - eye_m) / EDGE_M;
        let kelvin = near + (far - near) * depth.clamp(0.5 / 64.0, 1.0 - 0.5 / 64.0);
        assert!(
            (place.temperature_k / kelvin - 1.0).abs() < 1e-5,
            "{place:?} {kelvin}"
        );
        assert!((place.soot / soot - 1.0).abs() < 1e-6);
    }
    let hottest = along.hottest().unwrap();
    assert!(hottest.distance_m > eye_m + 0.9 * EDGE_M);
    // Past the fire there is nothing.
    let mut scene = scene;
    scene.camera.target = DVec3::new(5.0, 0.0, 0.0);
    let aside = Along::new(&scene, [1, 1], [0.5, 0.5]).unwrap();
    assert_eq!((aside.depth(), aside.hottest()), (0.0, None));
}

#[test]
fn halving_the_step_quarters_the_error() {
    // The slab's voxels are L × L/512 × L, so a step of one voxel's cube root is L/8: here 32 and 64 steps.
    // Smooth fields, resolved by the grid, so that the quadrature's order shows and not the interpolation's.
    let bump = |depth: f64| (std::f64::consts::PI * depth).sin().powi(2);
    let slab = common::slab(512, EDGE_M, |d| 2e-6 * bump(d), |d| 900.0 + 900.0 * bump(d));
    let scene = common::scene(slab, along_the_slab());
    let [reference, coarse, fine] =
        [1.0 / 128.0, 0.25, 0.125].map(|step| middle_ray(&scene, step, RGB_NM).0);
    for c in 0..3 {
        let ratio = (coarse[c] - reference[c]) / (fine[c] - reference[c]);
        assert!(
            (3.4..4.8).contains(&ratio),
            "channel {c}: error fell by {ratio}"
        );
    }
}

/// The same quadrature in f64, without packets or tables: another road to the same numbers. What the march skips is not
/// skipped, but taken in steps of the nominal length.
fn march_f64(
    scene: &Scene,
    ray: &Ray,
    samples: &[[f64; 2]],
    step_voxels: f64,
    wavelengths: &Wavelengths,
) -> [f64; 3] {
    let medium = scene.flame.medium();
    let Some((local, [enter, exit])) = medium.enter(ray) else {
        return [0.0; 3];
    };
    let step = step_voxels * medium.voxel_size_m();
    let mut parts = Vec::new();
    let mut at = 0.0;
    for &[begin, end] in samples.iter().chain([&[exit - enter; 2]]) {
        let steps = ((begin - at) / step - 1e-9).ceil().max(0.0) as u64;
        for k in 0..steps {
            let begin_of = |k: u64| at + (begin - at) * k as f64 / steps as f64;
            parts.push([begin_of(k), begin_of(k + 1)]);
        }
        parts.push([begin, end]);
        at = end;
    }
    let sigma: Vec<f64> = wavelengths
        .nodes_nm
        .iter()
        .map(|&nm| scene.flame.absorption_per_sample(nm))
        .collect();
    let mut radiance = vec![0.0; sigma.len()];
    let mut column = 0.0;
    for [begin, end] in parts {
        let [soot, kelvin] = medium.sample(local.at(enter + 0.5 * (begin + end)));
        let thickness = soot * (end - begin);
        for ((radiance, sigma), &nm) in radiance.iter_mut().zip(&sigma).zip(&wavelengths.nodes_nm) {
            let planck = if soot > 0.0 {
                blackbody::spectral_radiance(nm, kelvin)
            } else {
                0.0
            };
            *radiance += planck * (-sigma * column).exp() * -(-sigma * thickness).exp_m1();
        }
        column += thickness;
    }
    wavelengths.xyz_of(radiance)
}

#[test]
fn the_f32_march_follows_its_f64_twin() {
    // The bound: c₂/λT, up to 38 where rims of 1000 K are seen at 380 nm, carries three roundings of 6e-8 into the
    // exponential. At 32 wavelengths, steps from two voxels to a hundredth: some ten thousand steps through the torch.
    let scene = common::torch_scene(1.0);
    for (step, size, bound) in [(2.0, 24, 6e-6), (0.25, 12, 6e-6), (0.01, 3, 6e-6)] {
        let settings = settings(size, step, WavelengthSet::Plain(32));
        let plan = Plan::new(&scene, &settings);
        let frame = render_still(&scene, &settings, &Cancel::never(), &|_| {}).unwrap();
        let view = scene.camera.view(settings.size).unwrap();
        let marcher = Marcher::new(&scene, &plan, step).unwrap();
        let peak = frame
            .film
            .pixels()
            .iter()
            .map(|pixel| pixel.xyz[1])
            .fold(0.0, f32::max);
        assert!(peak > 0.0);
        let mut worst = 0.0_f64;
        for y in 0..size {
            for x in 0..size {
                let point = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                let ray = view.ray(point[0], point[1]);
                let samples = marcher.samples_of(point);
                let exact = march_f64(&scene, &ray, &samples, step, &plan.tables.wavelengths);
                let ours = frame.film.pixel(x, y).unwrap().xyz;
                for c in 0..3 {
                    // Relative to the pixel's own brightness, with a floor where there is nothing to see.
                    let scale = exact[1].max(1e-6 * f64::from(peak));
                    worst = worst.max((f64::from(ours[c]) - exact[c]).abs() / scale);
                }
            }
        }
        println!("f32 against f64 at a step of {step} voxels: {worst:.1e}");
        assert!(worst < bound, "step {step}: {worst:e}");
    }
}

#[test]
fn an_eye_inside_the_fire_sees_what_is_before_it() {
    let volume = cube(4, |_| 1e-6, |_| 1600.0);
    let inside = Camera {
        eye: DVec3::new(0.25, 0.2, 0.25),
        target: DVec3::new(0.25, 1.0, 0.25),
        up: DVec3::Z,
        fov_deg: 20.0,
        roll_deg: 0.0,
    };
    let scene = common::scene(volume, inside);
    let (radiance, _) = middle_ray(&scene, 0.5, RGB_NM);
    let depth = scene.flame.absorption_per_sample(RGB_NM[1]) * 1e-6 * (EDGE_M - 0.2);
    let expected = -blackbody::spectral_radiance(RGB_NM[1], 1600.0) * (-depth).exp_m1();
    assert!((radiance[1] / expected - 1.0).abs() < 5e-6);
}

#[test]
fn cold_or_absent_soot_gives_black_and_never_nan() {
    for (soot, kelvin) in [(0.0, 1800.0), (1e-6, 0.0), (1e-6, 3.0)] {
        let scene = scene_of(cube(3, |_| soot, |_| kelvin));
        let (radiance, opacity) = middle_ray(&scene, 0.5, RGB_NM);
        assert_eq!(radiance, [0.0; 3]);
        assert_eq!(opacity.map(|o| o > 0.0), [soot > 0.0; 3]);
    }
}

#[test]
fn the_hotter_side_is_seen_through_the_colder() {
    // Order matters: soot in front of the fire hides it.
    let cold_in_front = scene_of(cube(
        32,
        |_| 4e-6,
        |depth| if depth < 0.5 { 400.0 } else { 1800.0 },
    ));
    let hot_in_front = scene_of(cube(
        32,
        |_| 4e-6,
        |depth| if depth < 0.5 { 1800.0 } else { 400.0 },
    ));
    let [cold, hot] = [cold_in_front, hot_in_front].map(|scene| middle_ray(&scene, 0.5, RGB_NM).0);
    assert!(hot[1] > 10.0 * cold[1], "{hot:?} {cold:?}");
}

#[test]
fn the_standard_plume_agrees_with_its_reference() {
    let Some(shared) = common::shared() else {
        return;
    };
    let folder = shared.join("data/plume");
    let (scene, quality) = common::scene_file("plume.toml", &folder.join("plume.vdb"), [128, 128]);
    let bytes = std::fs::read(folder.join("reference_128_xyz.f32")).unwrap();
    let reference: Vec<f64> = bytes
        .chunks_exact(4)
        .map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap())))
        .collect();
    let error = |settings: &Settings| {
        let frame = render_still(&scene, settings, &Cancel::never(), &|_| {}).unwrap();
        let ours = frame.film.pixels().iter().flat_map(|pixel| pixel.xyz);
        let difference: f64 = ours
            .zip(&reference)
            .map(|(a, b)| (f64::from(a) - b).powi(2))
            .sum();
        (difference / reference.iter().map(|b| b * b).sum::<f64>()).sqrt()
    };
    // The reference knows emission and absorption along lines.
    let quality = Settings {
        effects: settings(1, 1.0, quality.wavelengths).effects,
        ..quality
    };
    let at_default = error(&quality);
    let fine = error(&Settings {
        step_voxels: 0.25,
        wavelengths: WavelengthSet::Fitted(8),
        ..quality
    });
    let fewest = error(&Settings {
        step_voxels: 0.25,
        wavelengths: WavelengthSet::Fitted(4),
        ..quality
    });
    let plain = error(&Settings {
        step_voxels: 0.25,
        wavelengths: WavelengthSet::Plain(64),
        ..quality
    });
    println!(
        "plume: default {at_default:.2e}, quarter voxel {fine:.2e}, 4 nodes {fewest:.2e}, 64 plain {plain:.2e}"
    );
    assert!(fine < 1e-4 && at_default < 6e-4 && fewest < 2.5e-3 && plain < 3e-4);
}
