//! The unbiased reference against closed forms: furnaces, enclosures, slabs, one order of scattering.

use sootlight::math::{Aabb, Ray};
use sootlight::physics::blackbody;
use sootlight::physics::phase::HenyeyGreenstein;
use sootlight::render::null_collision::{Environment, Estimate, NullCollision, Params, Scattering};
use sootlight::scene::Scene;
use sootlight::spectral::Wavelengths;

use super::super::common;
use super::{EDGE_M, RGB_NM, cube, scene_of, three};

const NM: f64 = 550.0;
const ASYMMETRIES: [f64; 7] = [-0.99, -0.7, -0.3, 0.0, 0.3, 0.7, 0.99];
/// Standard errors that are taken for chance: in a hundred comparisons once in 1e5.
const CHANCE: f64 = 5.0;

/// One wavelength, whose radiance lands in X, Y and Z.
fn one() -> Wavelengths {
    Wavelengths {
        nodes_nm: vec![NM],
        xyz: vec![[1.0; 3]],
        opacity: vec![[1.0; 3]],
    }
}

fn hg(asymmetry: f64) -> HenyeyGreenstein {
    HenyeyGreenstein::new(asymmetry).unwrap()
}

/// Volume fraction that makes the cube's edge so many optical depths long at [`NM`], in f32 as the volume stores it.
fn volume_fraction(depth: f64) -> f64 {
    let probe = scene_of(cube(1, |_| 1e-6, |_| 300.0));
    f64::from((depth / EDGE_M / probe.flame.absorption_per_sample(NM)) as f32)
}

/// A cube of even soot and temperature, `depth` optical depths thick at [`NM`].
fn even(depth: f64, kelvin: f64) -> Scene {
    let soot = volume_fraction(depth);
    scene_of(cube(4, |_| soot, |_| kelvin))
}

/// The light along the middle of the cube.
fn middle(scene: &Scene, wavelengths: &Wavelengths, params: &Params, samples: u32) -> Estimate {
    NullCollision::new(scene, wavelengths, params)
        .estimate([64, 64], [32.0, 32.0], samples, 11)
        .unwrap()
}

fn assert_near(estimate: &Estimate, expected: [f64; 3], what: &str) {
    for (c, expected) in expected.into_iter().enumerate() {
        let (mean, error) = (estimate.mean[c], estimate.variance_of_mean[c].sqrt());
        let z = (mean - expected) / error;
        assert!(
            z.abs() < CHANCE,
            "{what}: {mean} ± {error}, expected {expected}: z = {z:.1}"
        );
    }
}

#[test]
fn a_white_furnace_shows_nothing_but_its_walls_whatever_the_asymmetry() {
    // Nothing absorbs: each path ends at the walls with all of its weight, however long it wandered.
    let scene = common::torch_scene(1.0);
    let wavelengths = one();
    for asymmetry in ASYMMETRIES {
        let params = Params {
            scattering: Scattering::Albedo(1.0),
            phase: hg(asymmetry),
            environment: Environment::Uniform(2.5),
            ..Params::default()
        };
        let furnace = NullCollision::new(&scene, &wavelengths, &params);
        for pixel in furnace.render([12, 12], 16, 3).unwrap() {
            for value in pixel.mean {
                assert!((value / 2.5 - 1.0).abs() < 1e-12, "g {asymmetry}: {value}");
            }
        }
    }
}

#[test]
fn wavelengths_that_share_a_path_each_see_the_furnace_and_none_outweighs_their_number() {
    // Red and blue scatter very differently here, so a path that was probable for one is not for the other.
    let scene = even(3.0, 300.0);
    let params = Params {
        scattering: Scattering::Albedo(1.0),
        phase: hg(0.5),
        environment: Environment::Uniform(1.0),
        ..Params::default()
    };
    let wavelengths = three([780.0, 550.0, 380.0]);
    let furnace = middle(&scene, &wavelengths, &params, 40_000);
    assert_near(&furnace, [1.0; 3], "furnace");
    let reference = NullCollision::new(&scene, &wavelengths, &params);
    for seed in 0..2000 {
        let path = reference.estimate([64, 64], [32.0, 32.0], 1, seed).unwrap();
        assert!(
            path.mean.iter().all(|&weight| weight <= 3.0 + 1e-9),
            "{path:?}"
        );
    }
}

#[test]
fn an_isothermal_enclosure_is_a_black_body() {
    // Soot from nothing to two optical depths a voxel, walls as hot as the soot. Roulette, at a thousandth, is the only
    // noise at one wavelength.
    let kelvin = 1600.0;
    let peak = volume_fraction(8.0);
    let scene = scene_of(cube(8, |depth| peak * depth, |_| kelvin));
    let planck = |nm| blackbody::spectral_radiance(nm, kelvin);
    let mut worst = 0.0_f64;
    for asymmetry in ASYMMETRIES {
        for albedo in [0.0, 0.3, 0.95] {
            let params = Params {
                scattering: Scattering::Albedo(albedo),
                phase: hg(asymmetry),
                environment: Environment::BlackBody(kelvin),
                ..Params::default()
            };
            let enclosure = middle(&scene, &one(), &params, 400);
            worst = worst.max((enclosure.mean[1] / planck(NM) - 1.0).abs());
        }
    }
    println!("isothermal enclosure: off by {worst:.1e}");
    assert!(worst < 1e-4, "{worst:e}");

    // Where roulette is not reached the path telescopes to Planck's radiance.
    let thin = even(1.0, kelvin);
    let params = Params {
        environment: Environment::BlackBody(kelvin),
        ..Params::default()
    };
    let enclosure = middle(&thin, &three(RGB_NM), &params, 100);
    for (value, nm) in enclosure.mean.into_iter().zip(RGB_NM) {
        assert!((value / planck(nm) - 1.0).abs() < 1e-12, "{nm} nm: {value}");
    }

    // Large particles at several wavelengths: true on average.
    let params = Params {
        scattering: Scattering::Soot { radius_nm: 60.0 },
        phase: hg(0.6),
        ..params
    };
    let enclosure = middle(&scene, &three(RGB_NM), &params, 20_000);
    assert_near(&enclosure, RGB_NM.map(planck), "several wavelengths");
}

#[test]
fn a_slab_has_its_closed_form() {
    let (kelvin, walls) = (1700.0, 1500.0);
    for depth in [1e-9, 1e-3, 0.1, 1.0, 5.0, 30.0] {
        let scene = even(depth, kelvin);
        let params = Params {
            environment: Environment::BlackBody(walls),
            ..Params::default()
        };
        for params in [Params::default(), params] {
            let expected = RGB_NM.map(|nm| {
                let tau = EDGE_M * volume_fraction(depth) * scene.flame.absorption_per_sample(nm);
                let behind = params.environment.radiance(nm) * (-tau).exp();
                behind - blackbody::spectral_radiance(nm, kelvin) * (-tau).exp_m1()
            });
            let slab = middle(&scene, &three(RGB_NM), &params, 20_000);
            assert_near(&slab, expected, &format!("depth {depth}"));
            let relative = slab.variance_of_mean[1].sqrt() / expected[1];
            assert!(relative < 0.01, "depth {depth}: noise {relative}");
        }
    }
}

#[test]
fn light_that_is_never_scattered_fades_by_all_of_extinction() {
    let depth = 2.0;
    let scene = even(depth, 300.0);
    let radius_nm = 80.0;
    let params = Params {
        scattering: Scattering::Soot { radius_nm },
        max_bounces: 0,
        environment: Environment::Uniform(1.0),
        emission_points: 100.0,
        ..Params::default()
    };
    let faded = middle(&scene, &three(RGB_NM), &params, 10_000);
    let [with, without] = [1.0, 0.0].map(|scattering| {
        RGB_NM.map(|nm| {
            let tau = EDGE_M * volume_fraction(depth) * scene.flame.absorption_per_sample(nm);
            let ratio = scene.flame.soot().scattering_ratio(nm, radius_nm * 1e-9);
            (-tau * (1.0 + scattering * ratio)).exp()
        })
    });
    assert_near(&faded, with, "transmittance");
    let error = faded.variance_of_mean[1].sqrt();
    assert!(
        without[1] - with[1] > 20.0 * error,
        "{with:?} {without:?} ± {error}"
    );
}

/// Light that is scattered at most once along the middle of an even cube, by quadrature: the flame seen directly, and
/// of each point on the way what its surroundings send there and it turns towards the eye.
fn once_scattered(sigma: f64, albedo: f64, phase: HenyeyGreenstein, planck: f64) -> f64 {
    let cube = Aabb {
        min: glam::DVec3::ZERO,
        max: glam::DVec3::splat(EDGE_M),
    };
    let direct = |length: f64| -(1.0 - albedo) * planck * (-sigma * length).exp_m1();
    let (points, cosines, turns) = (64, 256, 32);
    let mut scattered = 0.0;
    for point in 0..points {
        let depth = EDGE_M * (f64::from(point) + 0.5) / f64::from(points);
        let origin = glam::DVec3::new(0.25, depth, 0.25);
        let mut arriving = 0.0;
        for i in 0..cosines {
            let cosine = 2.0 * (f64::from(i) + 0.5) / f64::from(cosines) - 1.0;
            let sine = (1.0 - cosine * cosine).sqrt();
            // The cube looks the same after an eighth of a turn and its mirror image.
            for j in 0..turns {
                let (up, across) = (std::f64::consts::FRAC_PI_4 * (f64::from(j) + 0.5)
                    / f64::from(turns))
                .sin_cos();
                let direction = glam::DVec3::new(sine * across, cosine, sine * up);
                let (_, length) = cube.intersect(&Ray { origin, direction }).unwrap();
                arriving += phase.value(cosine) * direct(length);
            }
        }
        arriving *= 4.0 * std::f64::consts::PI / f64::from(cosines * turns);
        scattered += (-sigma * depth).exp() * arriving;
    }
    direct(EDGE_M) + albedo * sigma * scattered * EDGE_M / f64::from(points)
}

#[test]
fn light_scattered_once_is_what_quadrature_finds() {
    let (depth, kelvin, albedo) = (2.0, 1700.0, 0.6);
    let scene = even(depth, kelvin);
    let planck = blackbody::spectral_radiance(NM, kelvin);
    let mut results = Vec::new();
    for asymmetry in [-0.7, 0.0, 0.7] {
        let params = Params {
            scattering: Scattering::Albedo(albedo),
            phase: hg(asymmetry),
            max_bounces: 1,
            emission_points: 4.0,
            ..Params::default()
        };
        let expected = once_scattered(depth / EDGE_M, albedo, hg(asymmetry), planck);
        let estimate = middle(&scene, &one(), &params, 100_000);
        assert_near(&estimate, [expected; 3], &format!("g {asymmetry}"));
        // Paths that are made to scatter more often, in soot as well through which most would go straight.
        let often = Params {
            scattering_points: 8.0,
            ..params
        };
        let estimate_often = middle(&scene, &one(), &often, 100_000);
        assert_near(
            &estimate_often,
            [expected; 3],
            &format!("g {asymmetry}, often"),
        );
        results.push((expected, estimate.variance_of_mean[1].sqrt()));
    }
    // Seen from outside, there is more fire ahead than behind: the comparison tells forwards from backwards.
    let (backwards, forwards) = (results[0], results[2]);
    assert!(forwards.0 - backwards.0 > 20.0 * forwards.1, "{results:?}");
}

#[test]
fn thin_soot_is_known_as_well_when_paths_are_made_to_scatter() {
    let (depth, kelvin, albedo) = (1e-4, 1700.0, 0.6);
    let scene = even(depth, kelvin);
    let planck = blackbody::spectral_radiance(NM, kelvin);
    let params = Params {
        scattering: Scattering::Albedo(albedo),
        min_bounces: 1,
        max_bounces: 1,
        scattering_points: 8.0,
        ..Params::default()
    };
    // Of the light that is scattered once, by quadrature; directly seen is the same with and without scattering.
    let isotropic = hg(0.0);
    let direct = -(1.0 - albedo) * planck * (-depth).exp_m1();
    let expected = once_scattered(depth / EDGE_M, albedo, isotropic, planck) - direct;
    let estimate = middle(&scene, &one(), &params, 20_000);
    assert_near(&estimate, [expected; 3], "thin");
    let noise = estimate.variance_of_mean[1].sqrt() / expected;
    assert!(noise < 0.05, "{noise}");
}

#[test]
fn each_order_of_scattering_adds_light() {
    let scene = even(2.0, 1700.0);
    let orders = [0, 1, 2, u32::MAX].map(|max_bounces| {
        let params = Params {
            scattering: Scattering::Albedo(0.8),
            phase: hg(0.3),
            max_bounces,
            emission_points: 4.0,
            ..Params::default()
        };
        middle(&scene, &one(), &params, 20_000)
    });
    for pair in orders.windows(2) {
        let error = (pair[0].variance_of_mean[1] + pair[1].variance_of_mean[1]).sqrt();
        let gain = pair[1].mean[1] - pair[0].mean[1];
        assert!(gain > CHANCE * error, "{gain} ± {error}: {orders:?}");
    }
}

#[test]
fn light_that_must_have_been_scattered_is_what_a_white_furnace_does_not_let_through() {
    // Scattered or not, all light of a white furnace arrives; what is never scattered is e^{−τ} of it.
    let depth = 1.5;
    let scene = even(depth, 300.0);
    for asymmetry in [-0.5, 0.0, 0.8] {
        let params = Params {
            scattering: Scattering::Albedo(1.0),
            phase: hg(asymmetry),
            min_bounces: 1,
            environment: Environment::Uniform(1.0),
            ..Params::default()
        };
        let scattered = middle(&scene, &one(), &params, 20_000);
        let expected = -f64::exp_m1(-depth);
        assert_near(&scattered, [expected; 3], &format!("g {asymmetry}"));
        let error = scattered.variance_of_mean[1].sqrt();
        assert!(error < 0.005, "noise {error}");

        let never = Params {
            max_bounces: 0,
            ..params
        };
        assert_eq!(middle(&scene, &one(), &never, 100).mean, [0.0; 3]);
    }
}

#[test]
fn the_first_orders_of_scattering_and_all_others_are_all_of_it() {
    let scene = even(2.0, 1700.0);
    let orders = |min_bounces, max_bounces| {
        let params = Params {
            scattering: Scattering::Albedo(0.8),
            phase: hg(0.3),
            min_bounces,
            max_bounces,
            emission_points: 4.0,
            ..Params::default()
        };
        middle(&scene, &one(), &params, 100_000)
    };
    let all = orders(0, u32::MAX);
    for first in [0, 1, 2] {
        let [few, many] = [orders(0, first), orders(first + 1, u32::MAX)];
        let variance = [all, few, many].map(|it| it.variance_of_mean[1]);
        let z = (few.mean[1] + many.mean[1] - all.mean[1]) / variance.iter().sum::<f64>().sqrt();
        assert!(z.abs() < CHANCE, "up to {first}: z = {z:.1}");
        // Each part is seen well above the noise, so that a lost order would show.
        let lost = many.mean[1] / variance[2].sqrt();
        assert!(lost > 10.0 * CHANCE, "up to {first}: {lost}");
    }
}

#[test]
fn soot_without_size_scatters_nothing() {
    let scene = common::torch_scene(1.0);
    let wavelengths = three(RGB_NM);
    let picture = |scattering| {
        let params = Params {
            scattering,
            ..Params::default()
        };
        NullCollision::new(&scene, &wavelengths, &params)
            .render([8, 8], 4, 1)
            .unwrap()
    };
    let clear = picture(Scattering::Off);
    assert_eq!(clear, picture(Scattering::Soot { radius_nm: 0.0 }));
    assert_eq!(clear, picture(Scattering::Albedo(0.0)));
    assert!(clear.iter().any(|pixel| pixel.mean[1] > 0.0));
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
    let scene = common::torch_scene(1.0);
    let wavelengths = three(RGB_NM);
    let params = Params {
        scattering: Scattering::Soot { radius_nm: 40.0 },
        ..Params::default()
    };
    let reference = NullCollision::new(&scene, &wavelengths, &params);
    let on = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| reference.render([8, 8], 8, seed).unwrap())
    };
    let alone = on(1, 5);
    assert_eq!(alone, on(3, 5));
    assert_ne!(alone, on(1, 6));
    let pixel = reference.estimate([8, 8], [4.5, 5.5], 8, 5).unwrap();
    assert_eq!(pixel, alone[5 * 8 + 4]);
}

#[test]
fn where_there_is_no_soot_the_surroundings_are_seen() {
    let scene = scene_of(cube(2, |_| 0.0, |_| 2000.0));
    let params = Params {
        scattering: Scattering::Albedo(0.5),
        environment: Environment::Uniform(0.125),
        ..Params::default()
    };
    let estimate = middle(&scene, &three(RGB_NM), &params, 10);
    assert_eq!(estimate.mean, [0.125; 3]);
    assert_eq!(estimate.variance_of_mean, [0.0; 3]);
}
