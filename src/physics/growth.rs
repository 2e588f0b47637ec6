//! The curve of growth: how much light a spectral line gives as the gas becomes thick.
//!
//! ```text
//! W = ∫ (1 − e^{−τ(λ)}) dλ = 2πγ G(y),   G(y) = y e^{−y} (I₀(y) + I₁(y)),   y = S / (2πγ)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | W | equivalent width: an isothermal gas gives W·B(λ, T) | m |
//! | S | ∫ σ_a dλ along the path, the area of the line times the path | m |
//! | γ | half width at half height of the line's Lorentz profile | m |
//! | y | half of the optical depth in the middle of the line | 1 |
//! | I₀, I₁ | modified Bessel functions | 1 |
//!
//! Thin gas has G = y; once the middle of the line is black, only its wings grow and G → √(2y/π).
//!
//! **Along a path whose temperature changes** the profile keeps its shape if γ does, so that τ(λ) is a fixed shape times
//! the y gathered so far, and the light of each piece is B(T) dW: nothing but W is needed.
//!
//! **Validity.** One Lorentz line, alone, of the same width everywhere. Doppler broadening, which in a flame is about as
//! wide as the collisions make a line, is left out: it adds to W where y is about 1 and nothing in the limits.
//!
//! **Computation.** e^{−y}(I₀ + I₁) = (1/π) ∫₀^π e^{−2y sin²(θ/2)} (1 + cos θ) dθ has a periodic, positive integrand:
//! equal steps converge faster than any power. Beyond y = 50 the asymptotic series has more digits than an f64.
//!
//! **Source.** R. Ladenburg and F. Reiche, Ann. Phys. 347 (1913) 181; M. Abramowitz and I. A. Stegun, *Handbook of
//! Mathematical Functions* (1964), eq. 9.6.19 and 9.7.1.

use std::f64::consts::PI;

/// From here on the asymptotic series is exact to the last bit.
const ASYMPTOTIC: f64 = 50.0;
/// Steps of the integral: enough for I₁₂₈(50) to be lost in rounding.
const STEPS: u32 = 64;

/// G(y), the equivalent width over 2πγ. Precondition: y ≥ 0; infinity gives infinity.
pub fn curve_of_growth(y: f64) -> f64 {
    debug_assert!(y >= 0.0, "{y}");
    if y > ASYMPTOTIC {
        return (y / (2.0 * PI)).sqrt() * (asymptotic(0.0, y) + asymptotic(1.0, y));
    }
    let mean: f64 = (0..=STEPS)
        .map(|i| {
            let theta = PI * f64::from(i) / f64::from(STEPS);
            let end = if i == 0 || i == STEPS { 0.5 } else { 1.0 };
            end * (-2.0 * y * (0.5 * theta).sin().powi(2)).exp() * (1.0 + theta.cos())
        })
        .sum::<f64>()
        / f64::from(STEPS);
    y * mean
}

/// √(2πy) e^{−y} I_ν(y) for large y.
fn asymptotic(order: f64, y: f64) -> f64 {
    let (mut sum, mut term) = (0.0, 1.0);
    for k in 1..20 {
        sum += term;
        let odd = 2.0 * f64::from(k) - 1.0;
        term *= -(4.0 * order * order - odd * odd) / (8.0 * f64::from(k) * y);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::golden_csv::Table;
    use super::*;

    #[test]
    fn it_agrees_with_fifty_digit_arithmetic() {
        let text = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/golden/line_curve_of_growth.csv"
        ));
        let mut compared = 0;
        for row in Table::parse(text).rows() {
            let (y, expected) = (row.number("x"), row.number("W_over_2pi_gamma"));
            let error = (curve_of_growth(y) / expected - 1.0).abs();
            assert!(error < 1e-12, "y = {y}: off by {error:e}");
            // The middle of the line: τ = 2y; and what a thin line would be too bright by.
            assert_eq!(row.number("tau_centre"), 2.0 * y);
            let thin = curve_of_growth(y) / y;
            assert!((thin / row.number("thin_factor") - 1.0).abs() < 1e-12);
            compared += 1;
        }
        assert!(compared >= 14, "only {compared} rows");
    }

    #[test]
    fn it_is_the_integral_over_the_profile() {
        // ∫ (1 − exp(−2y/(1+u²))) du with u = tan φ, in units of γ; W/γ = 2π G.
        for y in [0.01, 0.7, 5.0, 40.0, 300.0] {
            let steps = 2_000_000;
            let sum: f64 = (0..steps)
                .map(|i| {
                    let phi = PI * ((f64::from(i) + 0.5) / f64::from(steps) - 0.5);
                    let cos2 = phi.cos().powi(2);
                    -(-2.0 * y * cos2).exp_m1() / cos2
                })
                .sum();
            let integral = sum * PI / f64::from(steps);
            let error = (curve_of_growth(y) * 2.0 * PI / integral - 1.0).abs();
            assert!(error < 1e-6, "y = {y}: off by {error:e}");
        }
    }

    #[test]
    fn both_forms_meet_and_the_limits_are_right() {
        let (below, above) = (
            curve_of_growth(ASYMPTOTIC),
            curve_of_growth(ASYMPTOTIC.next_up()),
        );
        assert!((above / below - 1.0).abs() < 1e-14);
        assert_eq!(curve_of_growth(0.0), 0.0);
        assert_eq!(curve_of_growth(f64::INFINITY), f64::INFINITY);
    }
}
