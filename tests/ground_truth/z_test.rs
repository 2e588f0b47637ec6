//! Whether estimates with known variances agree with expected values, pixel by pixel and all together.
//!
//! z = (estimate − expected) / standard error. With thousands of paths for each mean z is normal: Student's
//! distribution of 1000 degrees of freedom has its quantile of the normal's 5 σ at 5.05. The skewness γ of a path shifts
//! the mean of z by −γ/(2√n), because a mean that came out low comes with a low error, and skews its tails as much: n
//! has to be large enough for that as well, which the long runs of `null_collision.rs` show.

use sootlight::render::null_collision::Estimate;

/// Probability that a true expectation is called wrong, by either test.
const FALSE_ALARM: f64 = 1e-3;

/// A pixel whose luminance is below this share of the brightest is black: the same limit as for colour differences.
/// What is left there is the light of the hottest corner of a cold voxel, 1e-20 of a flame's, on which a mean of any
/// number of random points says nothing.
const BLACK: f64 = 1e-4;

/// What the comparison shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Comparison {
    /// Largest |z| of any pixel's X, Y or Z.
    pub(super) worst: f64,
    /// The most that chance explains of it (Šidák).
    pub(super) worst_limit: f64,
    /// Mean of z over the pixels times the root of their number, for each of X, Y, Z: normal if all agree.
    pub(super) together: [f64; 3],
    /// The most that chance explains of it.
    pub(super) together_limit: f64,
    /// Pixels compared; the others are black in both.
    pub(super) pixels: usize,
    /// Mean relative standard error of Y.
    pub(super) noise: f64,
}

impl Comparison {
    /// Compares all pixels that are not black in both. One without variance is known: it is passed over if it is equal,
    /// and counts as infinitely wrong if not.
    pub(super) fn new(estimates: &[Estimate], expected: &[[f64; 3]]) -> Self {
        assert_eq!(estimates.len(), expected.len());
        let peak = expected.iter().map(|xyz| xyz[1]).fold(0.0, f64::max);
        let (mut worst, mut sum, mut noise, mut pixels) = (0.0_f64, [0.0; 3], 0.0, 0);
        for (estimate, expected) in estimates.iter().zip(expected) {
            let known = estimate.variance_of_mean == [0.0; 3] && estimate.mean == *expected;
            if known || estimate.mean[1].max(expected[1]) < BLACK * peak {
                continue;
            }
            pixels += 1;
            noise += estimate.variance_of_mean[1].sqrt() / expected[1];
            for (c, sum) in sum.iter_mut().enumerate() {
                let z = (estimate.mean[c] - expected[c]) / estimate.variance_of_mean[c].sqrt();
                worst = worst.max(z.abs());
                *sum += z;
            }
        }
        let count = f64::from(pixels);
        Self {
            worst,
            worst_limit: two_sided_quantile(sidak(FALSE_ALARM, 3 * pixels)),
            together: sum.map(|sum| sum / count.sqrt()),
            together_limit: two_sided_quantile(sidak(FALSE_ALARM, 3)),
            pixels: pixels as usize,
            noise: noise / count,
        }
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
fn sidak(level: f64, count: u32) -> f64 {
    -((-level).ln_1p() / f64::from(count)).exp_m1()
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
        let ours = two_sided_quantile(probability);
        assert!((ours - z).abs() < 1e-6, "{probability}: {ours}");
    }
    // 1 − 0.95^{1/10}.
    assert!((sidak(0.05, 10) - 0.0051162).abs() < 1e-7);
}

#[test]
fn a_known_pixel_is_passed_over_and_a_wrong_one_without_variance_is_not() {
    let exact = |value: f64| Estimate {
        mean: [value; 3],
        variance_of_mean: [0.0; 3],
    };
    let noisy = Estimate {
        mean: [1.0; 3],
        variance_of_mean: [0.01; 3],
    };
    let fine = Comparison::new(
        &[exact(0.0), exact(2.0), noisy],
        &[[0.0; 3], [2.0; 3], [1.1; 3]],
    );
    assert_eq!(fine.pixels, 1);
    assert!((fine.worst - 1.0).abs() < 1e-12 && fine.each_agrees() && fine.all_agree());
    for (pixel, expected) in [(0.0, 1e-3), (1e-3, 0.0)] {
        let wrong = Comparison::new(&[exact(pixel), noisy], &[[expected; 3], [1.1; 3]]);
        assert!(!wrong.each_agrees(), "{pixel} {expected}");
    }
}
