//! Cases 9 to 16: optical depth and the slab, from nothing to the opaque.
//!
//! The march computes these in f32. Where a case states a limit in f64 that f32 does not hold, the f32 one is as many ε.

use sootlight::math::lanes;
use sootlight::physics::soot::{SootLaw, SootModel, absorption_coefficient};
use sootlight::physics::soot_index::SootIndex;
use sootlight::render::null_collision::{Environment, NullCollision, Params, Scattering};
use sootlight::render::{Effects, Prober, Switch};
use sootlight::scene::Scene;

use super::super::common;
use super::{
    EPSILON_32, LENGTH_M, RGB_NM, assert_close, at_once, depth_of, even, even_with,
    fraction_of_depth, march, planck, planck_of_the_march, planck_tolerance, scene_of, three,
};

/// Mean of paths of the unbiased reference through the slab.
fn reference(scene: &Scene, params: &Params, paths: u32) -> [f64; 3] {
    // One wavelength, so that paths of different weights do not make noise.
    let wavelengths = three([550.0; 3]);
    NullCollision::new(scene, &wavelengths, params)
        .estimate([64, 64], [32.0, 32.0], paths, 7)
        .unwrap()
        .mean
}

/// X, Y and Z of the backdrop as the picture's middle shows it.
fn backdrop_through(scene: &Scene, effects: Effects) -> [f64; 3] {
    Prober::new(scene, [64, 64], effects)
        .read([32.0, 32.0])
        .unwrap()
        .xyz
}

#[test]
fn case_09_no_depth_lets_everything_through_and_gives_nothing() {
    assert_eq!((lanes::exp(-0.0), lanes::exp_m1(-0.0)), (1.0, 0.0));
    let seen = at_once(&even(0.0, 1800.0), RGB_NM);
    assert_eq!((seen.radiance, seen.opacity), ([0.0; 3], [0.0; 3]));
    // T = 1: what is behind keeps every bit.
    let clear = even_with(0.0, 1800.0, &["stage.backdrop=gradient"]);
    let through = backdrop_through(&clear, common::scattered_alone(Switch::Off));
    let alone = clear.stage.backdrop.as_ref().unwrap();
    let screen = alone.facing(&clear.camera, [64, 64]).unwrap();
    let ray = clear.camera.view([64, 64]).unwrap().ray(32.0, 32.0);
    assert_eq!(through, screen.xyz(&ray));
    // φ₁ = 1: radicals in gas without soot shine by j s, not by 0/0.
    let lit = ["effects.chemiluminescence=on", "fuel.blue_glow=100"];
    let [clear, thin] = [0.0, 1e-15].map(|soot| {
        let scene = even_with(soot, 2300.0, &lit);
        at_once(&scene, [700.0; 3]).radiance[2]
    });
    assert!(clear > 0.0);
    assert_close(clear, thin, 4.0 * EPSILON_32, "j s φ₁(0)");
}

#[test]
fn case_10_a_depth_of_a_trillionth_keeps_its_digits() {
    let scene = even(fraction_of_depth(1e-12, 550.0), 1500.0);
    let seen = at_once(&scene, [550.0; 3]);
    // 9.999999999995e-13 but for the volume fraction's rounding to f32.
    assert_close(
        seen.opacity[0],
        9.999999999995e-13,
        2.0 * EPSILON_32,
        "emissivity",
    );
    let expected = planck(550.0, 1500.0) * 9.999999999995e-13;
    assert_close(
        seen.radiance[0],
        expected,
        planck_tolerance(550.0, 1500.0, EPSILON_32),
        "radiance",
    );
    // In f32 1 − e^{−τ} is 0 for every τ below 3e-8.
    for tau in [1e-12_f32, 1e-20, 1e-30, 2.9e-8] {
        assert_eq!(1.0 - (-tau).exp(), 0.0);
        let got = -f64::from(lanes::exp_m1(-tau));
        assert_close(got, -(-f64::from(tau)).exp_m1(), 3e-7, "−expm1(−τ)");
    }
}

#[test]
fn case_11_a_million_thin_steps_add_up() {
    let scene = even(fraction_of_depth(1e-6, 550.0), 1500.0);
    let steps = march(&scene, 1e-6 * LENGTH_M, [550.0; 3]);
    let expected = -(-depth_of(&scene, fraction_of_depth(1e-6, 550.0), 550.0)).exp_m1();
    assert_close(
        expected,
        1.0 - (-1e-6_f64).exp(),
        1e-6,
        "the case's own number",
    );
    assert_close(steps.opacity[0], expected, 1e-6, "emissivity");
    let once = at_once(&scene, [550.0; 3]).radiance[0];
    assert_close(steps.radiance[0], once, 1e-6, "radiance");
    // And where there are as many as a long fire has at the finest step, whatever their number rounds to.
    for steps in [99_999.0, 333_333.0, 777_777.0] {
        let seen = march(&scene, LENGTH_M / steps, [550.0; 3]);
        assert_close(seen.opacity[0], expected, 1e-6, &format!("{steps} steps"));
        assert_close(seen.radiance[0], once, 1e-6, &format!("{steps} steps"));
    }
}

#[test]
fn case_12_an_opaque_slab_is_a_black_body_to_the_last_bit() {
    let law = SootLaw::new(SootModel::Grey, SootIndex::Propane);
    let depths = [18.0, 20.0, 38.0, 1e3, 1e6].map(|depth| {
        let fraction = depth / LENGTH_M / law.absorption_per_volume_fraction(550.0);
        at_once(&even_with(fraction, 1500.0, &["soot.model=grey"]), RGB_NM)
    });
    for seen in depths {
        // 17.33 in f32, 37.43 in f64: here the radiance is f32.
        assert_eq!(seen.radiance, planck_of_the_march(1500.0, RGB_NM));
        assert_close(
            seen.radiance[1],
            planck(550.0, 1500.0),
            planck_tolerance(550.0, 1500.0, EPSILON_32),
            "B",
        );
        assert_eq!(seen.opacity, [1.0; 3]);
    }
    let walls = Params {
        environment: Environment::Uniform(1e3),
        ..Params::default()
    };
    let opaque = reference(&even(fraction_of_depth(60.0, 650.0), 1500.0), &walls, 200);
    assert_close(
        opaque[1],
        planck(550.0, 1500.0),
        1e-2,
        "before walls, by the reference",
    );
    // σ beyond all numbers.
    assert_eq!(lanes::exp_m1(f32::NEG_INFINITY), -1.0);
    assert_eq!(lanes::exp(f32::NEG_INFINITY), 0.0);
    let most = [
        "soot.amount=10000",
        "soot.radius_nm=100",
        "volume.voxel_size_m=10000",
    ];
    let wall = even_with(1.0, 1500.0, &most);
    assert!(wall.flame.absorption_per_sample(550.0) * wall.flame.medium().voxel_size_m() > 1e15);
    for step_m in [1.0, 1e9] {
        let seen = march(&wall, step_m, RGB_NM);
        assert_eq!(seen.radiance, planck_of_the_march(1500.0, RGB_NM));
        assert_eq!(seen.opacity, [1.0; 3]);
    }
    // Of no length it has no depth: beside it nothing is seen.
    let beside = Prober::new(&even_with(1.0, 1500.0, &most[..2]), [64, 4], Effects::AUTO);
    assert_eq!(beside.read([1e9, 2.0]).unwrap().xyz, [0.0; 3]);
}

#[test]
fn case_13_a_transmittance_that_is_denormal_or_gone_is_zero() {
    for x in [87.01_f32, 87.34, 95.0, 103.97, 104.0, 708.0, 745.2, 1e30] {
        assert_eq!(lanes::exp(-x), 0.0, "e^-{x}: documented as 0 below −87");
        assert_eq!(lanes::exp_m1(-x), -1.0);
    }
    for depth in [87.3, 88.0, 103.9, 104.0, 708.0, 740.0, 745.2, 2e4] {
        let scene = even_with(
            fraction_of_depth(depth, 550.0),
            1500.0,
            &["stage.backdrop=gradient"],
        );
        for step_m in [1.0, 0.01] {
            let seen = march(&scene, step_m, [550.0; 3]);
            assert_eq!(seen.opacity, [1.0; 3], "depth {depth}");
            let tolerance = planck_tolerance(550.0, 1500.0, EPSILON_32);
            assert_close(
                seen.radiance[1],
                planck(550.0, 1500.0),
                tolerance,
                "B, and nothing from behind",
            );
        }
    }
}

#[test]
fn case_14_clear_gas_leaves_light_as_it_is() {
    // Scattering on, and nothing there that scatters: 0/0 if the source function were formed.
    let clear = even_with(0.0, 1800.0, &["stage.backdrop=gradient"]);
    let with = backdrop_through(&clear, common::scattered_alone(Switch::On));
    let without = backdrop_through(&clear, common::scattered_alone(Switch::Off));
    assert!(with[1] > 0.0);
    assert_eq!(with, without);
    // Clear gas in a brick with soot, in the march's loop with scattering: the clear half adds and takes nothing.
    let half = |clear_kelvin: f64| {
        let soot = |depth: f64| if depth < 0.5 { 0.0 } else { 1e-6 };
        let kelvin = move |depth: f64| if depth < 0.5 { clear_kelvin } else { 1500.0 };
        let volume = common::slab(64, LENGTH_M, soot, kelvin);
        let scene = scene_of(volume, &["render.interpolation=nearest"]);
        backdrop_through(&scene, common::scattered_alone(Switch::On))
    };
    let seen = half(300.0);
    assert!(seen.iter().all(|v| v.is_finite() && *v > 0.0));
    assert_eq!(seen, half(1800.0));
    let walls = Params {
        scattering: Scattering::Albedo(0.5),
        environment: Environment::Uniform(0.125),
        ..Params::default()
    };
    assert_eq!(reference(&clear, &walls, 10), [0.125; 3]);
}

/// Nothing that the march knows scatters without absorbing: soot always absorbs, and the albedo of smoke ends at 0.99.
/// The reference knows such a medium.
#[test]
fn case_15_what_only_scatters_glows_by_others_light_alone() {
    let hot = even(fraction_of_depth(2.0, 550.0), 1e5);
    let dark = Params {
        scattering: Scattering::Albedo(1.0),
        ..Params::default()
    };
    assert_eq!(reference(&hot, &dark, 200), [0.0; 3]);
    let lit = Params {
        environment: Environment::Uniform(2.5),
        ..dark
    };
    for value in reference(&hot, &lit, 200) {
        assert_close(value, 2.5, 1e-12, "Li");
    }
    let error = super::refusal(&["smoke.albedo=1"]);
    assert_eq!(
        error.to_string(),
        "smoke.albedo is 1: it must lie between 0 and 0.99"
    );
}

#[test]
fn case_16_a_denormal_of_soot_is_no_nan() {
    let index = SootLaw::default().complex_index(100.0);
    // 100 nm and 1e5 K: more light than any fire gives, 4e9 W m⁻² sr⁻¹ nm⁻¹.
    let product = absorption_coefficient(5e-324, 100.0, index) * planck(100.0, 1e5);
    assert!((0.0..1e-290).contains(&product), "{product:e}");
    for volume_fraction in [f64::from(f32::from_bits(1)), 1e-40, 1e-38] {
        let scene = even(volume_fraction, 1e5);
        for step_m in [1.0, 0.01] {
            let seen = march(&scene, step_m, [100.0, 550.0, 700.0]);
            for (radiance, nm) in seen.radiance.into_iter().zip([100.0, 550.0, 700.0]) {
                let exact = planck(nm, 1e5) * depth_of(&scene, volume_fraction, nm);
                assert!(
                    radiance >= 0.0 && radiance <= 2.0 * exact,
                    "{nm} nm: {radiance:e}, {exact:e}"
                );
            }
            assert!(seen.opacity.iter().all(|o| *o >= 0.0 && *o < 1e-30));
        }
        let scattered = backdrop_through(&scene, common::scattered_alone(Switch::On));
        assert!(scattered.iter().all(|v| v.is_finite() && *v >= 0.0));
    }
}
