//! Between nothing and the hottest black body; what even heat and even soot come to.

use proptest::prelude::*;
use sootlight::physics::blackbody::spectral_radiance;

use super::{NODES_NM, Voxels, look, side, voxels};
use crate::common;

/// What f32 may lose: c₂/λT of up to 80 in Planck's exponential carries some roundings of 6e-8 each, and so do sums.
const ROUNDING: f64 = 3e-5;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn light_is_finite_not_negative_and_below_the_hottest_black_body(
        voxels in voxels(),
        side in side(),
        step in 0.05..8.0_f64,
        way in prop::sample::select(&["nearest", "trilinear", "tricubic"][..]),
        nodes_nm in [380.0..780.0_f64, 380.0..780.0, 380.0..780.0],
    ) {
        let way = format!("render.interpolation={way}");
        let scene = voxels.scene(side, &[&way]);
        for pixel in look(&scene, step, nodes_nm) {
            for (c, nm) in nodes_nm.into_iter().enumerate() {
                let most = spectral_radiance(nm, voxels.hottest_k()) * (1.0 + ROUNDING);
                let light = f64::from(pixel.xyz[c]);
                prop_assert!((0.0..=most).contains(&light), "{light:e} of {most:e} at {nm} nm");
                prop_assert!((0.0..=1.0).contains(&pixel.opacity[c]), "{pixel:?}");
            }
        }
    }

    #[test]
    fn an_isothermal_volume_of_any_shape_glows_by_its_opacity(
        voxels in voxels(),
        side in side(),
        step in 0.05..8.0_f64,
        kelvin in 800.0_f32..2400.0,
    ) {
        let scene = voxels.isothermal(kelvin).scene(side, &[]);
        for pixel in look(&scene, step, NODES_NM) {
            for (c, nm) in NODES_NM.into_iter().enumerate() {
                // B (1 − e^{−τ}), whose bracket is the opacity.
                let expected = spectral_radiance(nm, f64::from(kelvin)) * f64::from(pixel.opacity[c]);
                let off = (f64::from(pixel.xyz[c]) - expected).abs();
                prop_assert!(off <= ROUNDING * expected, "{pixel:?}: {expected:e} at {nm} nm");
            }
        }
    }

    #[test]
    fn splitting_a_step_changes_nothing_in_a_constant_cell(
        exponent in -10.0_f64..-4.0,
        kelvin in 800.0_f64..2400.0,
        step in 0.02..1.0_f64,
        parts in 2..40_u32,
    ) {
        let volume = common::slab(1, 0.5, |_| 10.0_f64.powf(exponent), |_| kelvin);
        let mut job = common::physical().job(&std::sync::Arc::new(volume)).unwrap();
        job.camera = sootlight::scene::Camera {
            eye: glam::DVec3::NEG_Y,
            target: glam::DVec3::ZERO,
            up: glam::DVec3::Z,
            fov_deg: 10.0,
            roll_deg: 0.0,
        };
        let scene = job.scene(None);
        let whole = look(&scene, step, NODES_NM);
        let split = look(&scene, step / f64::from(parts), NODES_NM);
        // A rounding of each of the steps, which are as likely up as down.
        let steps = f64::from(parts) / step;
        let most = f64::from(f32::EPSILON) * (8.0 + 4.0 * steps.sqrt());
        for (whole, split) in whole.iter().zip(&split) {
            let pairs = whole.xyz.iter().chain(&whole.opacity).zip(split.xyz.iter().chain(&split.opacity));
            for (whole, split) in pairs {
                let off = f64::from((whole - split).abs());
                prop_assert!(off <= most * f64::from(*whole), "{whole:e}, {split:e}: {most:e}");
            }
        }
    }

    #[test]
    fn more_soot_of_one_heat_is_never_darker_nor_clearer(
        voxels in voxels(),
        side in side(),
        kelvin in 800.0_f32..2400.0,
        times in 1.0..50.0_f64,
    ) {
        let voxels = voxels.isothermal(kelvin);
        let with = |amount: f64| {
            let amount = format!("soot.amount={amount}");
            look(&voxels.scene(side, &[&amount]), 0.5, NODES_NM)
        };
        for (less, more) in with(1.0).iter().zip(&with(times)) {
            for c in 0..3 {
                let slack = 1.0 + 4.0 * f32::EPSILON;
                prop_assert!(more.xyz[c] * slack >= less.xyz[c], "{less:?}, {more:?}");
                prop_assert!(more.opacity[c] * slack >= less.opacity[c], "{less:?}, {more:?}");
            }
        }
    }
}

/// What the properties above rest on: boxes that the rays do meet.
#[test]
fn rays_meet_the_boxes() {
    let voxels = Voxels {
        dims: glam::IVec3::new(2, 3, 4),
        voxel_m: 0.1,
        soot: vec![1e-6; 24],
        kelvin: vec![1500.0; 24],
    };
    let seen = look(&voxels.scene([0.1, 0.05], &[]), 0.5, NODES_NM);
    let lit = seen.iter().filter(|pixel| pixel.xyz[0] > 0.0).count();
    assert!(lit >= 6, "{lit} rays meet the box");
}
