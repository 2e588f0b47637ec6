//! Black body radiation.
//!
//! ```text
//! B(λ, T) = c1 / (λ⁵ (exp(x) − 1)),   x = c2 / (λ T),   c1 = 2 h c₀²,   c2 = h c₀ / k
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | B | spectral radiance, per unit vacuum wavelength | W m⁻² sr⁻¹ nm⁻¹ |
//! | λ | vacuum wavelength | nm |
//! | T | temperature | K |
//! | x | photon energy over thermal energy | 1 |
//! | c1, c2 | radiation constants, scaled to nanometres | W m⁻² sr⁻¹ nm⁴, nm K |
//!
//! **Validity.** Thermal equilibrium at T; every wavelength. In a medium of refractive index n the radiance is n² B, and
//! L/n² is what a ray conserves: a march of L/n² uses B as it stands and n drops out.
//!
//! **Why nanometres.** λ⁵ in metres is 1e-35 at 100 nm and leaves the range of single precision; with c1 scaled once, no
//! intermediate value is out of proportion.
//!
//! **Conditioning.** d ln B / d ln T = x/(1 − e⁻ˣ): one unit in the last place of T is amplified x times, so a relative
//! error of (8 + 2x)·ε is as good as B can be.
//!
//! **Source.** M. Planck, Annalen der Physik 309 (1901) 553; constants of the SI of 2019.

/// First radiation constant for radiance c1 = 2hc₀², scaled to nanometres: W m⁻² sr⁻¹ nm⁴. SI 2019, rounded to f64.
pub const FIRST_RADIATION_CONSTANT: f64 = 1.1910429723971884e20;

/// Second radiation constant c2 = hc₀/k in nm K. SI 2019, rounded to f64.
pub const SECOND_RADIATION_CONSTANT_NM_K: f64 = 1.4387768775039338e7;

/// From here on, exp(x) − 1 is exp(x) to the last bit, and exp(x) soon overflows.
const WIEN_LIMIT: f64 = 700.0;

/// Spectral radiance of a black body in W m⁻² sr⁻¹ nm⁻¹, never normalised.
///
/// Preconditions: `lambda_nm` > 0 and finite, `temperature_k` ≥ 0 and finite. At 0 K the radiance is exactly 0. Where
/// the true value is below the smallest f64 the result is 0; it is never NaN inside the domain.
pub fn spectral_radiance(lambda_nm: f64, temperature_k: f64) -> f64 {
    debug_assert!(
        lambda_nm > 0.0 && lambda_nm.is_finite(),
        "wavelength {lambda_nm} nm"
    );
    debug_assert!(
        temperature_k >= 0.0 && temperature_k.is_finite(),
        "temperature {temperature_k} K"
    );

    let lambda_squared = lambda_nm * lambda_nm;
    let scale = FIRST_RADIATION_CONSTANT / (lambda_squared * lambda_squared * lambda_nm);
    let x = SECOND_RADIATION_CONSTANT_NM_K / (lambda_nm * temperature_k);
    if x < WIEN_LIMIT {
        // expm1, because exp(x) − 1 loses half of the digits in the far infrared.
        scale / x.exp_m1()
    } else {
        // In two halves: exp(−x) alone goes denormal before the product with the large scale does.
        let half = (-0.5 * x).exp();
        scale * half * half
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        reason = "a test fails by panicking"
    )]

    use super::super::constants::{BOLTZMANN_J_PER_K, LIGHT_SPEED_M_PER_S, PLANCK_J_S};
    use super::super::golden_csv::Table;
    use super::*;
    use proptest::prelude::*;

    const PLANCK_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/planck.csv"
    ));

    #[test]
    fn radiation_constants_follow_from_the_si() {
        // 2 h c² in W m² sr⁻¹; λ⁵ in nm⁵ brings 1e45, per nm instead of per m 1e-9.
        let first = 2.0 * PLANCK_J_S * LIGHT_SPEED_M_PER_S * LIGHT_SPEED_M_PER_S * 1e36;
        let second = PLANCK_J_S * LIGHT_SPEED_M_PER_S / BOLTZMANN_J_PER_K * 1e9;
        assert!((FIRST_RADIATION_CONSTANT / first - 1.0).abs() < 1e-15);
        assert!((SECOND_RADIATION_CONSTANT_NM_K / second - 1.0).abs() < 1e-15);
    }

    #[test]
    fn radiance_agrees_with_fifty_digit_arithmetic() {
        let mut compared = 0;
        for row in Table::parse(PLANCK_CSV).rows() {
            if row.number("n") != 1.0 {
                continue;
            }
            let (lambda_nm, temperature_k) = (row.number("lambda_nm"), row.number("T_K"));
            let expected = row.number("B_vac_f64_W_m-2_sr-1_nm-1");
            let got = spectral_radiance(lambda_nm, temperature_k);
            let x = row.number("x_hc_over_lambda_k_T");
            let tolerance = (8.0 + 2.0 * x) * f64::EPSILON * expected + f64::from_bits(2);
            assert!(
                (got - expected).abs() <= tolerance,
                "{lambda_nm} nm, {temperature_k} K: {got:e}, expected {expected:e}"
            );
            compared += usize::from(expected > 0.0);
        }
        assert!(compared > 80, "only {compared} rows with light in them");
    }

    #[test]
    fn case_1_past_the_overflow_of_exp_the_radiance_is_small_or_zero() {
        // x = 1868.54: the true value is 3.79e-793.
        assert_eq!(spectral_radiance(100.0, 77.0), 0.0);
        // x = 744: exp(−x) is denormal, the radiance is not.
        let temperature_k = SECOND_RADIATION_CONSTANT_NM_K / (744.0 * 100.0);
        let log_expected = (FIRST_RADIATION_CONSTANT / 1e10).ln() - 744.0;
        let got = spectral_radiance(100.0, temperature_k);
        assert!((got.ln() - log_expected).abs() < 1e-7, "{got:e}");
    }

    #[test]
    fn case_1_both_forms_meet_at_their_seam() {
        let t = SECOND_RADIATION_CONSTANT_NM_K / (WIEN_LIMIT * 500.0);
        let (below, above) = (
            spectral_radiance(500.0, t * (1.0 - 1e-13)),
            spectral_radiance(500.0, t * (1.0 + 1e-13)),
        );
        let ratio = above / below;
        assert!((ratio - 1.0 - 2e-13 * WIEN_LIMIT).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn case_2_the_reference_is_safe_to_round_to_single_precision() {
        // x = 88.8 overflows exp in f32. The f64 law is finite there, and so is its rounding.
        let radiance = spectral_radiance(450.0, 360.0) as f32;
        assert!(radiance.is_finite() && radiance > 0.0);
        assert_eq!(spectral_radiance(450.0, 150.0) as f32, 0.0);
    }

    #[test]
    fn case_3_no_light_at_absolute_zero() {
        for lambda_nm in [100.0, 380.0, 550.0, 1e6] {
            assert_eq!(spectral_radiance(lambda_nm, 0.0), 0.0);
            assert_eq!(spectral_radiance(lambda_nm, 1e-3), 0.0);
            assert_eq!(spectral_radiance(lambda_nm, f64::MIN_POSITIVE), 0.0);
        }
    }

    #[test]
    fn case_4_far_infrared_is_rayleigh_jeans() {
        let (lambda_nm, temperature_k) = (1e6, 1e7);
        let x = SECOND_RADIATION_CONSTANT_NM_K / (lambda_nm * temperature_k);
        let jeans = FIRST_RADIATION_CONSTANT / SECOND_RADIATION_CONSTANT_NM_K * temperature_k
            / lambda_nm.powi(4);
        let expected = jeans * (1.0 - x / 2.0 + x * x / 12.0);
        let got = spectral_radiance(lambda_nm, temperature_k);
        assert!((got / expected - 1.0).abs() < 8.0 * f64::EPSILON);
    }

    #[test]
    fn case_5_sensitivity_to_temperature_is_x() {
        let (lambda_nm, temperature_k) = (450.0, 1500.0);
        let x = SECOND_RADIATION_CONSTANT_NM_K / (lambda_nm * temperature_k);
        let h = 1e-5;
        let slope = (spectral_radiance(lambda_nm, temperature_k * (1.0 + h))
            / spectral_radiance(lambda_nm, temperature_k * (1.0 - h)))
        .ln()
            / (2.0 * h);
        assert!((slope / (x / -(-x).exp_m1()) - 1.0).abs() < 1e-7, "{slope}");
    }

    #[test]
    fn case_6_the_scaled_constants_survive_single_precision() {
        let lambda_nm = 100.0_f32;
        let scale = FIRST_RADIATION_CONSTANT as f32 / lambda_nm.powi(5);
        assert!(scale.is_normal());
        assert!((SECOND_RADIATION_CONSTANT_NM_K as f32).is_normal());
    }

    #[test]
    #[cfg(debug_assertions)]
    fn case_7_what_the_doors_must_refuse_is_caught_in_debug_builds() {
        for (lambda_nm, temperature_k) in [
            (0.0, 1500.0),
            (-1.0, 1500.0),
            (f64::NAN, 1500.0),
            (550.0, -1.0),
            (550.0, f64::NAN),
            (550.0, f64::INFINITY),
        ] {
            let refused =
                std::panic::catch_unwind(|| spectral_radiance(lambda_nm, temperature_k)).is_err();
            assert!(refused, "{lambda_nm} nm, {temperature_k} K");
        }
    }

    proptest! {
        #[test]
        fn hotter_is_never_darker(lambda_nm in 100.0..1e6_f64, t in 0.0..1e4_f64, more in 0.0..1e3_f64) {
            let cool = spectral_radiance(lambda_nm, t);
            let hot = spectral_radiance(lambda_nm, t + more);
            prop_assert!(cool.is_finite() && cool >= 0.0);
            // The two forms may differ by rounding where they meet.
            prop_assert!(hot >= cool * (1.0 - 2e3 * f64::EPSILON));
        }
    }
}
