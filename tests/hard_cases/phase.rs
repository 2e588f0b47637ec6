//! Cases 36 to 40: the phase function of Henyey and Greenstein, even, nearly even, and nearly a delta.
//!
//! The march's fields weigh their directions in f32; they are tried through pictures of even light.

use sootlight::physics::phase::HenyeyGreenstein;
use sootlight::project::ProjectError;
use sootlight::render::{Prober, Switch};

use super::super::common;
use super::{assert_close, even_with, fraction_of_depth, refusal};

const XIS: [f64; 9] = [0.0, 1e-12, 0.1, 0.25, 0.5, 0.6, 0.9, 1.0 - 1e-12, 1.0];

fn hg(asymmetry: f64) -> HenyeyGreenstein {
    HenyeyGreenstein::new(asymmetry).unwrap()
}

/// Luminance of a thick slab of scattering soot with this asymmetry, by the march.
fn luminance(asymmetry: &str) -> f64 {
    let scene = even_with(
        fraction_of_depth(1.0, 550.0),
        1500.0,
        &[
            "soot.radius_nm=80",
            "soot.hold=volume",
            &format!("soot.asymmetry={asymmetry}"),
        ],
    );
    let probe = Prober::new(&scene, [64, 64], common::scattered_alone(Switch::On));
    probe.read([32.0, 32.0]).unwrap().luminance()
}

#[test]
fn case_36_even_scattering_is_one_over_four_pi() {
    for cosine in [-1.0, -0.3, 0.0, 0.9, 1.0] {
        assert_eq!(hg(0.0).value(cosine), 0.079577471545947668);
    }
    for xi in XIS {
        let cosine = hg(0.0).sample_cosine(xi);
        assert!(
            (cosine - (2.0 * xi - 1.0)).abs() <= f64::EPSILON,
            "{xi}: {cosine}"
        );
    }
    assert_eq!(hg(-0.0).value(1.0), 0.079577471545947668);
    assert_eq!(luminance("0"), luminance("-0.0"));
}

#[test]
fn case_37_a_hundred_millionth_of_asymmetry_keeps_its_digits() {
    for g in [1e-8, -1e-8] {
        for xi in XIS {
            // The inverse to first order in g; the second is 1e-16.
            let expected = 2.0 * xi - 1.0 + 6.0 * g * xi * (1.0 - xi);
            let got = hg(g).sample_cosine(xi);
            assert!((got - expected).abs() < 1e-15, "g = {g}, ξ = {xi}: {got}");
        }
        for cosine in [-1.0, -0.3, 0.5, 1.0] {
            let expected = (1.0 + 3.0 * g * cosine) * 0.079577471545947668;
            assert_close(hg(g).value(cosine), expected, 4.0 * f64::EPSILON, "Φ");
        }
    }
    // Even scattering takes fewer directions: so nearly even is held to nearly even, turned round.
    assert_close(luminance("1e-8"), luminance("-1e-8"), 1e-6, "the march");
}

#[test]
fn case_38_the_peak_has_its_value_and_a_delta_is_refused() {
    // (1 + g)/(4π(1 − g)²) of the nearest f64 to 0.999999, by fifty-digit arithmetic (tests/golden/hg_phase.csv).
    for (g, cosine) in [(0.999999, 1.0), (-0.999999, -1.0)] {
        let peak = hg(g).value(cosine);
        assert_close(peak, 1.5915486350527058e11, 4.0 * f64::EPSILON, "peak");
        assert_close(peak, 1.5915e11, 1e-4, "as stated");
        // Away from the peak, where nothing cancels: (1 − g²)/(4π(1 + g²)^{3/2}).
        assert_close(
            hg(g).value(0.0),
            5.6269826031228068e-8,
            4.0 * f64::EPSILON,
            "at a right angle",
        );
    }
    for g in [1.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
        assert_eq!(HenyeyGreenstein::new(g), None, "{g}");
    }
    for g in ["1", "-1", "nan"] {
        let error = refusal(&[&format!("soot.asymmetry={g}")]);
        assert!(
            matches!(
                error,
                ProjectError::Range {
                    key: "soot.asymmetry",
                    ..
                }
            ),
            "{error:?}"
        );
        assert!(
            error
                .to_string()
                .ends_with("it must lie between -0.99 and 0.99"),
            "{error}"
        );
    }
    // What the scene file lets through, in the march.
    for g in ["-0.99", "0.99"] {
        let light = luminance(g);
        assert!(light.is_finite() && light > 0.0, "{g}: {light}");
    }
}

#[test]
fn case_39_a_cosine_beyond_one_is_one() {
    for g in [
        0.999999,
        1.0 - f64::EPSILON,
        -0.999999,
        f64::EPSILON - 1.0,
        0.3,
        0.0,
    ] {
        for (beyond, end) in [
            (1.0 + f64::EPSILON, 1.0),
            (1.0 + 1e-9, 1.0),
            (-1.0 - f64::EPSILON, -1.0),
            (-1.0 - 1e-9, -1.0),
        ] {
            assert_eq!(hg(g).value(beyond), hg(g).value(end), "g = {g}");
            assert!(hg(g).value(beyond).is_finite() && hg(g).value(beyond) > 0.0);
        }
    }
}

#[test]
fn case_40_the_ends_are_exact_and_all_between_are_cosines() {
    for g in [
        f64::EPSILON - 1.0,
        -0.999999,
        -0.7,
        -1e-8,
        0.0,
        1e-8,
        0.3,
        0.77,
        0.999999,
        1.0 - f64::EPSILON,
    ] {
        assert_eq!(hg(g).sample_cosine(0.0), -1.0, "g = {g}");
        assert_eq!(hg(g).sample_cosine(1.0), 1.0, "g = {g}");
        let mut before = -1.0;
        for step in 0..=10_000 {
            let cosine = hg(g).sample_cosine(f64::from(step) / 1e4);
            assert!(
                (-1.0..=1.0).contains(&cosine),
                "g = {g}, step {step}: {cosine}"
            );
            assert!(
                cosine >= before - 4.0 * f64::EPSILON,
                "g = {g}, step {step}: falls"
            );
            before = cosine;
        }
    }
}
