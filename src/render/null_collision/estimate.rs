//! Means of independent samples, with how well they are known.

/// The mean of many paths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// XYZ, W m⁻² sr⁻¹.
    pub mean: [f64; 3],
    /// Variance of each number of the mean, as the samples show it; infinite for fewer than two samples.
    pub variance_of_mean: [f64; 3],
}

/// Collects samples in one pass without losing digits (Welford 1962).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    count: u32,
    mean: [f64; 3],
    /// Sum of squared distances from the mean.
    squares: [f64; 3],
}

impl Tally {
    pub(super) fn add(&mut self, sample: [f64; 3]) {
        self.count += 1;
        for (c, value) in sample.into_iter().enumerate() {
            let before = value - self.mean[c];
            self.mean[c] += before / f64::from(self.count);
            self.squares[c] += before * (value - self.mean[c]);
        }
    }

    pub(super) fn estimate(self) -> Estimate {
        let n = f64::from(self.count);
        let variance = |squares: f64| {
            if self.count < 2 {
                f64::INFINITY
            } else {
                squares / (n - 1.0) / n
            }
        };
        Estimate {
            mean: self.mean,
            variance_of_mean: self.squares.map(variance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_are_those_of_the_samples() {
        let mut tally = Tally::default();
        for value in [1e9 + 1.0, 1e9 + 2.0, 1e9 + 6.0] {
            tally.add([value, -value, 0.0]);
        }
        // Variance of 1, 2, 6 is 7; of the mean of three 7/3.
        let estimate = tally.estimate();
        assert_eq!(estimate.mean, [1e9 + 3.0, -1e9 - 3.0, 0.0]);
        for (got, expected) in estimate.variance_of_mean.into_iter().zip([7.0, 7.0, 0.0]) {
            assert!((got - expected / 3.0).abs() < 1e-6, "{got}");
        }
    }

    #[test]
    fn one_sample_says_nothing_of_its_error() {
        let mut tally = Tally::default();
        tally.add([1.0; 3]);
        assert_eq!(tally.estimate().variance_of_mean, [f64::INFINITY; 3]);
    }
}
