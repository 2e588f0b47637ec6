//! Whether estimates with known variances agree with expected values, pixel by pixel and all together.
//!
//! z = (estimate − expected) / standard error. With thousands of samples for each mean, z is normal: Student's
//! distribution of 1000 degrees of freedom has its 5 σ quantile at 5.05. What skewness is left shifts the mean of z by
//! −γ/(2√n), γ being the skewness of one sample and n their number, so n has to be large enough for that as well.

use sootlight::render::null_collision::Estimate;

/// Probability that a true expectation is called wrong, by either test.
const FALSE_ALARM: f64 = 1e-3;

/// What the comparison shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Comparison {
    /// Largest |z| of any pixel's X, Y or Z, and the most that chance explains (Šidák).
    pub(super) worst: f64,
    pub(super) worst_limit: f64,
    /// Mean of z over the pixels times the root of their number, for each of X, Y, Z: normal if all agree. And the most
    /// that chance explains.
    pub(super) together: [f64; 3],
    pub(super) together_limit: f64,
    /// Pixels compared; the others are exactly black in both.
    pub(super) pixels: usize,
    /// Mean relative standard error of Y.
    pub(super) noise: f64,
}

impl Comparison {
    /// Compares all pixels. One without variance is skipped if both are equal, and counts as infinitely wrong if not.
    pub(super) fn new(estimates: &[Estimate], expected: &[[f64; 3]]) -> Self {
        assert_eq!(estimates.len(), expected.len());
        let mut comparison = Self {
            worst: 0.0,
            worst_limit: 0.0,
            together: [0.0; 3],
            together_limit: two_sided_quantile(sidak(FALSE_ALARM, 3)),
            pixels: 0,
            noise: 0.0,
        };
        for (estimate, expected) in estimates.iter().zip(expected) {
            let known = (0..3).all(|c| {
                estimate.variance_of_mean[c] == 0.0 && estimate.mean[c] == expected[c]
            });
            if known {
                continue;
            }
            comparison.pixels += 1;
            comparison.noise += estimate.variance_of_mean[1].sqrt() / expected[1];
            for c in 0..3 {
                let z = (estimate.mean[c] - expected[c]) / estimate.variance_of_mean[c].sqrt();
                comparison.worst = comparison.worst.max(z.abs());
                comparison.together[c] += z;
            }
        }
        let pixels = comparison.pixels as f64;
        comparison.worst_limit = two_sided_quantile(sidak(FALSE_ALARM, 3 * comparison.pixels));
        comparison.together = comparison.together.map(|sum| sum / pixels.sqrt());
        comparison.noise /= pixels;
        comparison
    }

    /// Whether no pixel stands out.
    pub(super) fn each_agrees(&self) -> bool {
        self.worst <= self.worst_limit
    }

    /// Whether the pixels together show no bias.
    pub(super) fn all_agree(&self) -> bool {
        self.together.iter().all(|z| z.abs() <= self.together_limit)
    }
}

/// Level of each of `count` tests, so that any of them gives a false alarm with probability `level`.
fn sidak(level: f64, count: usize) -> f64 {
    -((-level).ln_1p() / count as f64).exp_m1()
}

/// The z that a normal number exceeds in magnitude with a probability below ½.
fn two_sided_quantile(probability: f64) -> f64 {
    let (mut low, mut high) = (0.6, 40.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if 2.0 * upper_tail(middle) > probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Probability that a normal number exceeds z > 0.5, by Laplace's continued fraction.
fn upper_tail(z: f64) -> f64 {
    let fraction = (1..400).rev().fold(z, |below, k| z + f64::from(k) / below);
    (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
}

#[test]
fn quantiles_are_those_of_the_tables() {
    for (probability, z) in [(0.05, 1.959964), (1e-3, 3.290527), (1e-6, 4.891638)] {
        assert!((two_sided_quantile(probability) - z).abs() < 1e-6, "{probability}");
    }
    assert!((sidak(0.05, 10) - 0.005116197).abs() < 1e-9);
}

#[test]
fn a_known_pixel_is_skipped_and_a_wrong_one_without_variance_is_not() {
    let exact = |value: f64| Estimate {
        mean: [value; 3],
        variance_of_mean: [0.0; 3],
    };
    let noisy = Estimate {
        mean: [1.0; 3],
        variance_of_mean: [0.01; 3],
    };
    let fine = Comparison::new(&[exact(0.0), noisy], &[[0.0; 3], [1.1; 3]]);
    assert_eq!(fine.pixels, 1);
    assert!((fine.worst - 1.0).abs() < 1e-12 && fine.each_agrees() && fine.all_agree());
    let wrong = Comparison::new(&[exact(0.0), noisy], &[[1e-9; 3], [1.1; 3]]);
    assert!(!wrong.each_agrees());
}
