//! Cases 17 to 21: the slab in steps: of any number, of changing temperature, and where a ray ends.
//!
//! The march computes these in f32: where a case states a limit in f64, the f32 one is as many ε.

use sootlight::volume::Volume;

use super::super::common;
use super::{
    EPSILON_32, LENGTH_M, RGB_NM, assert_close, at_once, depth_of, even, even_with, exponent,
    fraction_of_depth, march, planck, planck_tolerance, scene_of,
};

#[test]
fn case_17_an_isothermal_slab_is_the_same_at_any_grid_and_step() {
    for depth in [1e-3, 1.0, 8.0] {
        let fraction = fraction_of_depth(depth, 550.0);
        for voxels in [1, 3, 17] {
            let volume = common::slab(voxels, LENGTH_M, |_| fraction, |_| 1500.0);
            let scene = scene_of(volume, &[]);
            for steps in [1, 2, 3, 7, 64, 1000] {
                let seen = march(&scene, LENGTH_M / f64::from(steps), RGB_NM);
                for (radiance, nm) in seen.radiance.into_iter().zip(RGB_NM) {
                    let tau = depth_of(&scene, fraction, nm);
                    let expected = planck(nm, 1500.0) * -(-tau).exp_m1();
                    let tolerance =
                        planck_tolerance(nm, 1500.0, EPSILON_32) + f64::from(steps) * EPSILON_32;
                    let what = format!("depth {depth}, {voxels} voxels, {steps} steps, {nm} nm");
                    assert_close(radiance, expected, tolerance, &what);
                }
            }
        }
    }
}

#[test]
fn case_18_one_step_is_two_of_half_the_length() {
    // 1e-15 in f64 is 4.5 ε; so much of f32's is 5.4e-7.
    let tolerance = 1e-15 / f64::EPSILON * EPSILON_32;
    for depth in [1e-9, 1e-3, 0.1, 1.0, 3.0, 10.0, 30.0] {
        let scene = even(fraction_of_depth(depth, 550.0), 1500.0);
        let [once, twice] = [1.0, 0.5].map(|share| march(&scene, share * LENGTH_M, RGB_NM));
        for (c, nm) in RGB_NM.into_iter().enumerate() {
            let what = format!("depth {depth}, {nm} nm");
            assert_close(twice.radiance[c], once.radiance[c], tolerance, &what);
            assert_close(twice.opacity[c], once.opacity[c], tolerance, &what);
        }
    }
}

/// Voxels of a slab whose temperature is a ramp from face to face.
const RAMP_VOXELS: i32 = 20_000;

fn ramp([near, far]: [f64; 2], depth: f64) -> Volume {
    let fraction = fraction_of_depth(depth, 650.0);
    common::slab(
        RAMP_VOXELS,
        LENGTH_M,
        |_| fraction,
        |at| near + (far - near) * at,
    )
}

#[test]
fn case_19_temperature_is_interpolated_and_not_its_light() {
    // tests/golden/linear_temperature_slab.csv, 650 nm: depth, radiance (W m⁻³ sr⁻¹), what one cell of the mean
    // temperature gives over that.
    let cold_in_front = [
        (1.0, 1.5771682226862341e8, 2.8769300717828469e-3),
        (10.0, 5.3025223500006762e5, 1.3536462469802305),
        (100.0, 2.3649764047691795e-9, 3.0351530559862228e14),
        (1e4, 9.6367800470330573e-18, 7.4486138806088517e22),
    ];
    let hot_in_front = [
        (1.0, 3.6880039350226945e8, 1.2303139497811873e-3),
        (10.0, 2.2182188035127849e9, 3.2358122053787009e-4),
        (1e4, 4.6805297168111589e9, 1.5336010658128874e-4),
    ];
    let cold = cold_in_front.map(|row| ([300.0, 1800.0], row));
    let hot = hot_in_front.map(|row| ([1800.0, 300.0], row));
    for (faces, (depth, expected, one_step_ratio)) in cold.into_iter().chain(hot) {
        let scene = scene_of(ramp(faces, depth), &[]);
        let step_m = LENGTH_M / f64::from(RAMP_VOXELS);
        let seen = 1e9 * march(&scene, step_m, [650.0; 3]).radiance[0];
        // A voxel of 0.075 K at 300 K is 2 % of the light there, and half of the first one is even.
        let tolerance =
            0.5 * exponent(650.0, faces[0]) * 1500.0 / f64::from(RAMP_VOXELS) / faces[0];
        let what = format!("{faces:?} K, depth {depth}");
        if depth == 100.0 {
            // Most of this light comes from about 20 optical depths behind the face. The march ends a ray 24 deep, so that
            // e^{−24} of the hottest light may be missing.
            let missing = (-24.0_f64).exp() * 4.6853270032398232e9;
            assert!(
                seen > 0.8 * expected && seen < expected + missing,
                "{what}: {seen:e}"
            );
        } else {
            assert_close(seen, expected, tolerance.max(1e-4), &what);
        }
        // The trap that it does not fall into.
        let mean = even(fraction_of_depth(depth, 650.0), 1050.0);
        let one_cell = 1e9 * at_once(&mean, [650.0; 3]).radiance[0];
        assert_close(one_cell / expected, one_step_ratio, 1e-5, &what);
    }
}

#[test]
fn case_20_a_ray_ends_only_where_every_wavelength_is_opaque() {
    // Before the hot half stands cold soot, opaque to violet and clear to far infrared.
    let nodes_nm = [1e4, 650.0, 380.0];
    let asked = [
        "soot.model=hottel-broughton",
        "render.interpolation=nearest",
    ];
    let probe = even_with(1e-6, 300.0, &asked);
    let fraction = f64::from((400.0 / LENGTH_M / probe.flame.absorption_per_sample(380.0)) as f32);
    let kelvin = |depth: f64| if depth < 0.5 { 1.0 } else { 1500.0 };
    let volume = common::slab(64, LENGTH_M, |_| fraction, kelvin);
    let scene = scene_of(volume, &asked);
    let seen = march(&scene, LENGTH_M / 512.0, nodes_nm);
    for (radiance, nm) in seen.radiance.into_iter().zip(nodes_nm) {
        let half = 0.5 * depth_of(&scene, fraction, nm);
        let expected = planck(nm, 1500.0) * (-half).exp() * -(-half).exp_m1();
        if nm < 1e3 {
            // Where even the whole is darker than e^{−24} of the front it may be left out.
            assert!(
                half > 90.0 && radiance <= expected + 1e-38,
                "{nm} nm: {radiance:e}"
            );
        } else {
            assert!((1.0..5.0).contains(&half), "depth {half}");
            let tolerance = planck_tolerance(nm, 1500.0, EPSILON_32) + (half + 16.0) * EPSILON_32;
            assert_close(radiance, expected, tolerance, &format!("{nm} nm"));
        }
    }
}

#[test]
fn case_21_a_deep_metre_is_a_black_body_and_not_infinity_less_infinity() {
    let fraction = 1000.0 / even(1e-6, 300.0).flame.absorption_per_sample(550.0);
    let volume = common::slab(10, 1.0, |_| fraction, |_| 1500.0);
    let scene = scene_of(volume, &[]);
    for step_m in [2.0, 0.1, 0.01] {
        let seen = march(&scene, step_m, [550.0; 3]);
        let tolerance = planck_tolerance(550.0, 1500.0, EPSILON_32);
        assert_close(
            seen.radiance[1],
            planck(550.0, 1500.0),
            tolerance,
            &format!("steps of {step_m} m"),
        );
        assert_eq!(seen.opacity, [1.0; 3]);
    }
}
