//! Into which directions a particle scatters: the phase function of Henyey and Greenstein.
//!
//! ```text
//! Φ(θ) = (1 − g)(1 + g) / (4π D^{3/2}),   D = (1 − g)² + 2g(1 − cos θ)   for g ≥ 0
//!                                         D = (1 + g)² − 2g(1 + cos θ)   for g < 0
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | Φ | probability density over the sphere of directions: its integral is 1, so 1/4π is in it | sr⁻¹ |
//! | θ | angle between the directions of propagation before and after | rad |
//! | g | asymmetry, the mean of cos θ: −1 backwards, 0 evenly, 1 forwards | 1 |
//!
//! **Validity.** g in the open interval (−1, 1); at ±1 the function is a delta, which has no value. It is an empirical
//! shape with the right mean cosine; small soot (Rayleigh) is even in θ, aggregates lean forwards.
//!
//! **Why this form.** 1 + g² − 2g cos θ cancels to 12 digits for g near 1 and light that goes on; D is a sum of terms
//! that are not negative. Nothing is divided by g, so that g = 0 and |g| = 1e-8 need no case of their own.
//!
//! **Sources.** L. G. Henyey and J. L. Greenstein, Astrophys. J. 93 (1941) 70; G. Dorta-Perez, *Realistic fire
//! rendering* (2015), eq. 3.4.

use std::f64::consts::PI;

/// Henyey and Greenstein's phase function of one asymmetry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HenyeyGreenstein {
    asymmetry: f64,
}

impl HenyeyGreenstein {
    /// Light goes into all directions evenly.
    pub const ISOTROPIC: Self = Self { asymmetry: 0.0 };

    /// The function with mean cosine `asymmetry`; `None` unless −1 < `asymmetry` < 1.
    pub fn new(asymmetry: f64) -> Option<Self> {
        (asymmetry.abs() < 1.0).then_some(Self { asymmetry })
    }

    /// g, the mean cosine.
    pub fn asymmetry(self) -> f64 {
        self.asymmetry
    }

    /// Probability density in sr⁻¹ of a turn by θ, given cos θ, both directions being those of propagation. A cosine
    /// that rounding has put beyond ±1 counts as ±1.
    pub fn value(self, cosine: f64) -> f64 {
        let g = self.asymmetry;
        let cosine = cosine.clamp(-1.0, 1.0);
        let d = if g >= 0.0 {
            (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cosine)
        } else {
            (1.0 + g) * (1.0 + g) - 2.0 * g * (1.0 + cosine)
        };
        (1.0 - g) * (1.0 + g) / (4.0 * PI * d * d.sqrt())
    }

    /// The cosine below which a share `xi` of all light is scattered: a uniform number in 0..=1 becomes a cosine with
    /// density 2πΦ. 0 gives exactly −1, 1 gives exactly 1.
    pub fn sample_cosine(self, xi: f64) -> f64 {
        let g = self.asymmetry.abs();
        // The function of −g is the mirror image of that of g.
        if self.asymmetry >= 0.0 {
            forward_cosine(g, xi, 1.0 - xi)
        } else {
            -forward_cosine(g, 1.0 - xi, xi)
        }
    }
}

/// The cosine for 0 ≤ g < 1, measured from the nearer end so that both ends are exact. `rest` is 1 − `xi`.
fn forward_cosine(g: f64, xi: f64, rest: f64) -> f64 {
    let d = 1.0 - g + 2.0 * g * xi;
    let cosine = if xi < 0.5 {
        2.0 * xi * (1.0 + g) * (1.0 + g) * (1.0 - g + g * xi) / (d * d) - 1.0
    } else {
        1.0 - 2.0 * rest * (1.0 - g) * (1.0 - g) * (1.0 + g * xi) / (d * d)
    };
    cosine.clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::super::golden_csv::Table;
    use super::*;

    const HG_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/hg_phase.csv"
    ));

    #[test]
    fn values_and_sampled_cosines_agree_with_fifty_digit_arithmetic() {
        let (mut values, mut samples) = (0, 0);
        for row in Table::parse(HG_CSV).rows() {
            let g = row.number("g");
            let phase = HenyeyGreenstein::new(g).unwrap();
            if row.text("xi").is_empty() {
                let cosine = row.number("cos_theta");
                let expected = row.number("p_sr-1");
                let error = (phase.value(cosine) / expected - 1.0).abs();
                assert!(
                    error <= 4.0 * f64::EPSILON,
                    "g {g}, cos {cosine}: {error:e}"
                );
                values += 1;
            } else {
                let xi = row.number("xi");
                let error = (phase.sample_cosine(xi) - row.number("cos_theta_sample")).abs();
                assert!(error <= 8.0 * f64::EPSILON, "g {g}, xi {xi}: {error:e}");
                samples += 1;
            }
        }
        assert!(values > 150 && samples > 100, "{values} and {samples} rows");
    }

    #[test]
    fn hard_case_36_no_asymmetry_is_exactly_even() {
        let phase = HenyeyGreenstein::new(0.0).unwrap();
        for cosine in [-1.0, -0.3, 0.0, 0.9, 1.0] {
            assert_eq!(phase.value(cosine), 0.079577471545947668);
        }
        for xi in [0.0, 0.125, 0.25, 0.5, 0.75, 0.875, 1.0] {
            assert_eq!(phase.sample_cosine(xi), 2.0 * xi - 1.0);
        }
    }

    #[test]
    fn hard_case_37_a_tiny_asymmetry_keeps_its_digits() {
        // The inverse to first order in g, from Φ = (1 + 3g cos θ)/4π.
        for g in [1e-8, -1e-8] {
            let phase = HenyeyGreenstein::new(g).unwrap();
            for xi in [0.1, 0.25, 0.5, 0.6, 0.9] {
                let first_order = 2.0 * xi - 1.0 + 6.0 * g * xi * (1.0 - xi);
                assert!((phase.sample_cosine(xi) - first_order).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn hard_case_38_the_forward_peak_has_its_value_and_a_delta_is_refused() {
        for (g, cosine) in [(0.999999, 1.0), (-0.999999, -1.0)] {
            let peak = HenyeyGreenstein::new(g).unwrap().value(cosine);
            assert!((peak / 1.5915486350527058e11 - 1.0).abs() < 1e-15);
        }
        for g in [1.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
            assert_eq!(HenyeyGreenstein::new(g), None, "{g}");
        }
    }

    #[test]
    fn hard_case_39_a_cosine_beyond_one_is_one() {
        for g in [0.999999, 1.0 - f64::EPSILON, -0.999999, 0.0] {
            let phase = HenyeyGreenstein::new(g).unwrap();
            for (beyond, end) in [(1.0 + 1e-12, 1.0), (-1.0 - 1e-12, -1.0)] {
                assert_eq!(phase.value(beyond), phase.value(end));
                assert!(phase.value(end) > 0.0);
            }
        }
    }

    #[test]
    fn hard_case_40_the_ends_are_exact_and_all_between_are_cosines() {
        for g in [
            -1.0 + 1e-16,
            -0.999999,
            -0.7,
            -1e-8,
            0.0,
            1e-8,
            0.3,
            0.77,
            0.999999,
        ] {
            let phase = HenyeyGreenstein::new(g).unwrap();
            assert_eq!(phase.sample_cosine(0.0), -1.0, "{g}");
            assert_eq!(phase.sample_cosine(1.0), 1.0, "{g}");
            for step in 0..=1000 {
                let cosine = phase.sample_cosine(f64::from(step) / 1000.0);
                assert!((-1.0..=1.0).contains(&cosine), "{g} {step}: {cosine}");
            }
        }
    }

    #[test]
    fn samples_have_the_density_of_the_value() {
        // d cos/d ξ = 1/(2πΦ), by differences.
        for g in [-0.9, -0.4, 0.0, 0.2, 0.8] {
            let phase = HenyeyGreenstein::new(g).unwrap();
            for xi in [0.03, 0.3, 0.5, 0.7, 0.97] {
                let h = 1e-5;
                let slope = (phase.sample_cosine(xi + h) - phase.sample_cosine(xi - h)) / (2.0 * h);
                let density = 2.0 * PI * phase.value(phase.sample_cosine(xi));
                assert!((slope * density - 1.0).abs() < 1e-6, "{g} {xi}");
            }
        }
    }
}
