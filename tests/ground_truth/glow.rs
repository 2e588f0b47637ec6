//! What glows in the gas against closed forms, and against sums over the profile of a line.

use std::sync::Arc;

use glam::DVec3;
use sootlight::colour::cie;
use sootlight::physics::growth::curve_of_growth;
use sootlight::physics::lines::{self, ATMOSPHERE_PA, Line};
use sootlight::physics::{blackbody, soot};
use sootlight::project::{Preset, Project};
use sootlight::render::march::Marcher;
use sootlight::render::{Plan, Probe, Switch};
use sootlight::scene::{Camera, Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;
use sootlight::volume::{FieldKind, Volume};

use super::super::common;

/// Length of the slab, m.
const LENGTH_M: f64 = 0.05;

/// A slab along y with soot and kelvin by depth, in gas as the assignments say, looked through along its axis.
fn scene(
    soot: impl Fn(f64) -> f64 + Sync,
    kelvin: impl Fn(f64) -> f64 + Sync,
    voxels: i32,
    assignments: &[&str],
) -> Scene {
    let volume: Volume = common::slab(voxels, LENGTH_M, soot, kelvin);
    let mut project: Project = common::physical();
    project.soot.radius_nm = soot::REFERENCE_RADIUS_NM;
    project.volume.field_mut(FieldKind::Temperature).grid = Some("temperature".to_owned());
    project.set_all(assignments.iter().copied()).unwrap();
    let mut job = project.job(&Arc::new(volume)).unwrap();
    job.camera = Camera {
        eye: DVec3::new(0.0, -1.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov_deg: 1.0,
        roll_deg: 0.0,
    };
    job.scene(None)
}

/// XYZ along the slab's axis.
fn xyz(scene: &Scene, wavelengths: Wavelengths, step_voxels: f64) -> [f64; 3] {
    let plan = Plan::with_wavelengths(scene, [64, 64], wavelengths);
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    let mut points = [None; 16];
    points[5] = Some([32.0, 32.0]);
    marcher.march(&points).0[5].xyz.map(f64::from)
}

/// No wavelengths for soot: only what the gas adds is left.
fn none() -> Wavelengths {
    Wavelengths {
        nodes_nm: Vec::new(),
        xyz: Vec::new(),
        opacity: Vec::new(),
    }
}

fn near(ours: [f64; 3], expected: [f64; 3], tolerance: f64, what: &str) {
    for c in 0..3 {
        let slack = tolerance * expected[c].abs().max(1e-3 * expected[1].abs());
        assert!(
            (ours[c] - expected[c]).abs() <= slack,
            "{what}: {ours:?}, expected {expected:?}"
        );
    }
}

/// Number density of sodium in gas of 2000 K, as the scene's gas dilutes it: propane's flame is hotter.
fn sodium_per_m3(scene: &Scene, ppm: f64, kelvin: f64) -> f64 {
    scene.flame.glow().vapour_share(kelvin)
        * lines::number_density(1e-6 * ppm, ATMOSPHERE_PA, kelvin)
}

#[test]
fn an_isothermal_vapour_gives_planck_times_its_equivalent_width() {
    // From thin to ten thousand times saturated.
    for ppm in [1e-4, 1e-2, 1.0, 100.0, 1e5] {
        let salt = format!("fuel.salt_ppm={ppm}");
        let scene = scene(|_| 0.0, |_| 2000.0, 5, &["fuel.salt=sodium", &salt]);
        let mut expected = [0.0; 3];
        for line in lines::SODIUM {
            let area = sodium_per_m3(&scene, ppm, 2000.0) * line.area_per_atom(2000.0) * LENGTH_M;
            let width_m = 2.0 * std::f64::consts::PI * line.half_width_m();
            let width_nm = 1e9 * width_m * curve_of_growth(area / width_m);
            let radiance = width_nm * blackbody::spectral_radiance(line.lambda_nm, 2000.0);
            let bar = cie::colour_matching(line.lambda_nm);
            expected = std::array::from_fn(|c| expected[c] + radiance * bar[c]);
        }
        for step in [0.1, 1.0, 7.0] {
            // f32: Planck's exponential at x = 12, and the sums of a hundred steps.
            near(
                xyz(&scene, none(), step),
                expected,
                5e-4,
                &format!("{ppm} ppm"),
            );
        }
    }
}

/// The light that a line adds to a path of soot and gas, by brute force: for each of many detunings the whole path is
/// marched, with the line and without it.
fn by_brute_force(
    line: &Line,
    depth_per_m: impl Fn(f64) -> f64,
    soot_per_m: f64,
    kelvin: impl Fn(f64) -> f64,
) -> f64 {
    const STEPS: u32 = 2000;
    const DETUNINGS: u32 = 4000;
    let step = LENGTH_M / f64::from(STEPS);
    let gamma_nm = 1e9 * line.half_width_m();
    let mut sum = 0.0;
    for i in 0..DETUNINGS {
        // Detuning u γ with u = tan³-like spacing: dense in the core, out to the far wings.
        let p = (f64::from(i) + 0.5) / f64::from(DETUNINGS) * std::f64::consts::FRAC_PI_2;
        let u = p.tan().powi(2);
        let du =
            2.0 * p.tan() / p.cos().powi(2) * std::f64::consts::FRAC_PI_2 / f64::from(DETUNINGS);
        let (mut with, mut t_with, mut without, mut t_without) = (0.0, 1.0_f64, 0.0, 1.0_f64);
        for k in 0..STEPS {
            let depth = (f64::from(k) + 0.5) / f64::from(STEPS);
            let planck = blackbody::spectral_radiance(line.lambda_nm, kelvin(depth));
            let soot = (-soot_per_m * step).exp();
            // y is half of the optical depth in the middle.
            let both = soot * (-2.0 * depth_per_m(depth) * step / (1.0 + u * u)).exp();
            with += planck * t_with * (1.0 - both);
            without += planck * t_without * (1.0 - soot);
            t_with *= both;
            t_without *= soot;
        }
        // Both sides of the line.
        sum += 2.0 * (with - without) * du * gamma_nm;
    }
    sum
}

/// Temperature (K) by depth, 0 to 1.
type Profile = fn(f64) -> f64;

#[test]
fn a_line_in_gas_of_changing_heat_among_soot_agrees_with_its_profile_summed() {
    let profiles: [(&str, Profile); 3] = [
        ("a cool mantle before a hot core", |d| {
            1350.0 + 750.0 * (std::f64::consts::PI * d).sin()
        }),
        ("hot in front", |d| 2100.0 - 700.0 * d),
        ("hot behind", |d| 1400.0 + 700.0 * d),
    ];
    for (name, kelvin) in profiles {
        for (ppm, volume_fraction) in [(0.01, 0.0), (3.0, 1e-6), (300.0, 1e-6)] {
            let salt = format!("fuel.salt_ppm={ppm}");
            let scene = scene(
                |_| volume_fraction,
                kelvin,
                400,
                &["fuel.salt=sodium", &salt],
            );
            let mut expected = [0.0; 3];
            for line in lines::SODIUM {
                let soot_per_m = scene.flame.absorption_per_sample(line.lambda_nm)
                    * f64::from(volume_fraction as f32);
                let width_m = 2.0 * std::f64::consts::PI * line.half_width_m();
                let depth_per_m = |depth: f64| {
                    let kelvin = kelvin(depth);
                    sodium_per_m3(&scene, ppm, kelvin) * line.area_per_atom(kelvin) / width_m
                };
                let light = by_brute_force(line, depth_per_m, soot_per_m, kelvin);
                let bar = cie::colour_matching(line.lambda_nm);
                expected = std::array::from_fn(|c| expected[c] + light * bar[c]);
            }
            // 400 steps along the slab, whose voxels are longer across; where the line is thick its light comes from the
            // first few of them.
            let light = xyz(&scene, none(), 0.02);
            near(light, expected, 1e-3, &format!("{name}, {ppm} ppm"));
        }
    }
}

#[test]
fn radicals_shine_in_proportion_and_are_dimmed_by_soot() {
    let blue = ["effects.chemiluminescence=on", "fuel.blue_glow=100"];
    let light = |soot: f64| {
        let scene = scene(|_| soot, |_| 2100.0, 5, &blue);
        let emitted = scene.flame.glow().coefficients([360.0, 830.0], 2100.0, 1.0);
        (xyz(&scene, none(), 1.0), emitted.emission * 470.0, scene)
    };
    let (clear, emission, _) = light(0.0);
    let sum: f64 = clear.iter().sum();
    assert!(sum > 0.0 && clear[2] > clear[1], "not blue: {clear:?}");
    // By 1 nm through the whole observer.
    let (dimmed, _, scene) = light(3e-6);
    let (mut expected_clear, mut expected_dimmed, mut all) = ([0.0; 3], [0.0; 3], 0.0);
    for nm in 360..830 {
        let nm = f64::from(nm);
        let glow = scene.flame.glow().coefficients([nm, nm + 1.0], 2100.0, 1.0);
        let tau = scene.flame.absorption_per_sample(nm + 0.5) * f64::from(3e-6_f32) * LENGTH_M;
        let bar = cie::colour_matching(nm + 0.5);
        all += glow.emission;
        for c in 0..3 {
            expected_clear[c] += glow.emission * LENGTH_M * bar[c];
            expected_dimmed[c] += glow.emission * LENGTH_M * bar[c] * -(-tau).exp_m1() / tau;
        }
    }
    assert!((all / emission - 1.0).abs() < 1e-9);
    near(clear, expected_clear, 2e-3, "clear");
    // Four wavelengths carry all of the light through soot of a depth of about 1.
    near(dimmed, expected_dimmed, 1e-2, "through soot");
}

#[test]
fn every_set_of_wavelengths_holds_the_same_area_as_bins_of_five_nanometres() {
    // Lines and bands among soot, thin enough for bins: 5 nm bins over the whole observer are the measure.
    for (salt, ppm) in [("sodium", 0.002), ("strontium", 0.05), ("copper", 1.0)] {
        let salt_name = format!("fuel.salt={salt}");
        let amount = format!("fuel.salt_ppm={ppm}");
        let asked = [
            salt_name.as_str(),
            amount.as_str(),
            "effects.chemiluminescence=on",
        ];
        let scene_with = scene(|_| 1e-8, |_| 2100.0, 5, &asked);
        let scene_without = scene(|_| 1e-8, |_| 2100.0, 5, &[]);
        let mut binned = [0.0; 3];
        for bin in 0..94 {
            let from = 360.0 + 5.0 * f64::from(bin);
            let glow = scene_with
                .flame
                .glow()
                .coefficients([from, from + 5.0], 2100.0, 1.0);
            // The mean of the observer over the bin: a line's own place in it is what bins do not know.
            let bars = (0..5).map(|i| cie::colour_matching(from + 0.5 + f64::from(i)));
            let bar = bars.fold([0.0; 3], |sum, bar| {
                std::array::from_fn(|c| sum[c] + bar[c] / 5.0)
            });
            binned = std::array::from_fn(|c| binned[c] + 5.0 * glow.emission * LENGTH_M * bar[c]);
        }
        for set in WavelengthSet::ALL {
            let law = scene_with.flame.soot();
            let with = xyz(&scene_with, set.wavelengths(law), 1.0);
            let without = xyz(&scene_without, set.wavelengths(law), 1.0);
            let added: [f64; 3] = std::array::from_fn(|c| with[c] - without[c]);
            // Within its 5 nm the observer changes by some per cent, and soot takes 0.3 %.
            near(added, binned, 4e-2, &format!("{salt}, {set:?}"));
            let same = xyz(&scene_with, none(), 1.0);
            near(added, same, 2e-3, &format!("{salt}, {set:?} against none"));
        }
    }
}

#[test]
fn no_extreme_of_salt_heat_soot_or_step_gives_what_is_no_light() {
    for kelvin in [1.0, 300.0, 901.0, 1500.0, 2300.0, 6000.0, 1e4] {
        for (ppm, volume_fraction) in [(1e-9, 1e-3), (10.0, 0.0), (1e5, 1e-12), (1e5, 1e-3)] {
            for salt in ["sodium", "copper", "barium-chloride"] {
                let name = format!("fuel.salt={salt}");
                let amount = format!("fuel.salt_ppm={ppm}");
                let asked = [
                    name.as_str(),
                    amount.as_str(),
                    "effects.chemiluminescence=on",
                    "fuel.blue_glow=10000",
                    "volume.temperature.max=10000",
                    "volume.soot.max=0.001",
                ];
                let scene = scene(|_| volume_fraction, |_| kelvin, 40, &asked);
                let set = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
                let what = format!("{salt}, {ppm} ppm, {kelvin} K, soot {volume_fraction}");
                let thin = xyz(&scene, none(), 64.0);
                for step in [0.01, 0.3, 64.0] {
                    let all = xyz(&scene, set.clone(), step);
                    assert!(
                        all.iter().all(|v| v.is_finite()),
                        "{what}, step {step}: {all:?}"
                    );
                    assert!(all[1] >= 0.0, "{what}, step {step}: {all:?}");
                    // Everything is alike along the path, so that steps change nothing; but behind soot that is opaque
                    // lies the noise of what it hides.
                    let gas = xyz(&scene, none(), step);
                    assert!(gas.iter().all(|v| v.is_finite()), "{what}: {gas:?}");
                    if volume_fraction < 1e-6 {
                        near(gas, thin, 1e-3, &format!("{what}, step {step}"));
                    }
                }
            }
        }
    }
}

#[test]
fn the_spectrum_under_the_pointer_and_of_a_place_is_the_films() {
    for preset in ["gas-burner", "copper", "sodium", "strontium", "torch"] {
        let preset = Preset::named(preset).unwrap();
        let mut project = preset.project();
        project.render.size = [24, 32];
        let volume = project.volume.built_in.volume();
        let scene = project.job(&Arc::new(volume)).unwrap().scene(None);
        let mut lit = 0;
        for place in [
            [12.5, 28.5],
            [12.5, 24.5],
            [12.5, 16.5],
            [10.5, 20.5],
            [13.5, 8.5],
        ] {
            let probe = Probe::new(&scene, [24, 32], place).unwrap();
            let settings = project.settings([24, 32]).unwrap();
            let plan = Plan::new(&scene, &settings);
            let marcher = Marcher::new(&scene, &plan, 0.5).unwrap();
            let mut points = [None; 16];
            points[0] = Some(place);
            let film = marcher.march(&points).0[0].xyz.map(f64::from);
            if film[1] <= 0.0 {
                continue;
            }
            lit += 1;
            // What is left out as outshone, and the quality's own wavelengths.
            near(
                probe.xyz,
                film,
                5e-3,
                &format!("{} at {place:?}", preset.name),
            );
            // Its bands hold all the light but what the observer hardly sees.
            let summed = probe.spectrum.iter().fold([0.0; 3], |sum, [nm, radiance]| {
                let bars = (0..25).map(|i| cie::colour_matching(nm - 3.0 + 0.25 * f64::from(i)));
                let bar = bars.fold([0.0; 3], |a: [f64; 3], b| {
                    std::array::from_fn(|c| a[c] + b[c] / 25.0)
                });
                std::array::from_fn(|c| sum[c] + 6.25 * radiance * bar[c])
            });
            near(
                summed,
                probe.xyz,
                4e-2,
                &format!("{} in bands at {place:?}", preset.name),
            );
        }
        assert!(lit >= 2, "{}: {lit}", preset.name);
    }
}

#[test]
fn what_is_not_asked_for_changes_no_bit() {
    let plain = scene(|_| 1e-6, |_| 1900.0, 5, &[]);
    let switched = scene(
        |_| 1e-6,
        |_| 1900.0,
        5,
        &["fuel.salt=sodium", "effects.lines=off"],
    );
    let set = WavelengthSet::Fitted(6).wavelengths(plain.flame.soot());
    assert_eq!(xyz(&plain, set.clone(), 1.0), xyz(&switched, set, 1.0));
    assert!(switched.flame.glow().is_empty());
    assert_eq!(Switch::default(), Switch::Auto);
}

#[test]
fn no_extreme_of_gas_and_soot_spoils_a_pixel() {
    let salts = [
        "none",
        "sodium",
        "potassium",
        "strontium-chloride",
        "copper-chloride",
    ];
    for salt in salts {
        for ppm in [1e-6, 1.0, 1e5] {
            for kelvin in [1.0, 950.0, 2500.0, 6000.0] {
                for soot in [0.0, 1e-9, 1e-3] {
                    let asked = [
                        format!("fuel.salt={salt}"),
                        format!("fuel.salt_ppm={ppm}"),
                        "fuel.blue_glow=10000".to_owned(),
                        "effects.chemiluminescence=on".to_owned(),
                        "air.temperature_k=400".to_owned(),
                    ];
                    let asked = asked.each_ref().map(String::as_str);
                    // Hot on one side only: cold vapour in front of a furnace, and behind it.
                    let scene = scene(
                        |_| soot,
                        |d| if d < 0.5 { kelvin } else { 1500.0 },
                        8,
                        &asked,
                    );
                    for step in [0.01, 1.0, 64.0] {
                        let set = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
                        let light = xyz(&scene, set, step);
                        let case = format!("{salt} {ppm} ppm, {kelvin} K, f_v {soot}, step {step}");
                        assert!(light.iter().all(|v| v.is_finite()), "{case}: {light:?}");
                        assert!(light[1] >= 0.0, "{case}: {light:?}");
                    }
                }
            }
        }
    }
}
