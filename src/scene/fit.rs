//! Nodes and weights by numbers alone: Gauss–Legendre roots, and weights by least squares.

use nalgebra::{DMatrix, DVector};

/// Rows `Σ_i value_i · weight_i = XYZ`, each scaled to Y = 1 so that dark spectra count as much as bright ones.
pub(super) struct LeastSquares {
    unknowns: usize,
    rows: Vec<f64>,
    targets: [Vec<f64>; 3],
}

impl LeastSquares {
    pub(super) fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            rows: Vec::new(),
            targets: Default::default(),
        }
    }

    /// Adds a spectrum. One without light, or with so little that its sums are denormal, has no colour to be fitted, and is
    /// passed over: of a row that is no numbers no singular values are ever found.
    pub(super) fn add(
        &mut self,
        at_nodes: impl Iterator<Item = f64>,
        at_targets: impl Iterator<Item = f64>,
        weights: &[[f64; 3]],
    ) {
        let mut xyz = [0.0; 3];
        for (value, weight) in at_targets.zip(weights) {
            for (sum, weight) in xyz.iter_mut().zip(weight) {
                *sum += value * weight;
            }
        }
        if !xyz[1].is_normal() {
            return;
        }
        let row: Vec<f64> = at_nodes.map(|value| value / xyz[1]).collect();
        let colour = xyz.map(|value| value / xyz[1]);
        if !row.iter().chain(&colour).all(|value| value.is_finite()) {
            return;
        }
        self.rows.extend(row);
        for (target, value) in self.targets.iter_mut().zip(colour) {
            target.push(value);
        }
    }

    /// Weights by singular values, those below 1e-12 of the largest left out: the fit's directions that the
    /// family does not determine get no weight.
    pub(super) fn solve(self) -> Vec<[f64; 3]> {
        let count = self.targets[0].len();
        let svd = DMatrix::from_row_iterator(count, self.unknowns, self.rows).svd(true, true);
        let cutoff = 1e-12 * svd.singular_values.max();
        let columns = self.targets.map(|target| {
            svd.solve(&DVector::from_vec(target), cutoff)
                .unwrap_or_else(|_| DVector::zeros(self.unknowns))
        });
        (0..self.unknowns)
            .map(|i| std::array::from_fn(|c| columns[c][i]))
            .collect()
    }
}

/// Nodes of the Gauss–Legendre rule, rising: roots of the Legendre polynomial P_n by Newton's method from the
/// Chebyshev guess (Abramowitz & Stegun 1964, 22.16.6 and 25.4.29).
pub(super) fn gauss_legendre(count: usize, [low, high]: [f64; 2]) -> Vec<f64> {
    let n = count as f64;
    (0..count)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            for _ in 0..8 {
                let (mut before, mut p) = (1.0, x);
                for k in 2..=count {
                    let k = k as f64;
                    (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
                }
                x -= p * (x * x - 1.0) / (n * (x * p - before));
            }
            0.5 * (low + high) + 0.5 * (high - low) * x
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_those_of_the_tables() {
        // Abramowitz & Stegun (1964), table 25.4, n = 4.
        let expected = [
            -0.861136311594053,
            -0.339981043584856,
            0.339981043584856,
            0.861136311594053,
        ];
        for (node, expected) in gauss_legendre(4, [-1.0, 1.0]).into_iter().zip(expected) {
            assert!((node - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn weights_that_can_be_exact_are_exact() {
        let mut fit = LeastSquares::new(2);
        for x in [0.0, 1.0, 2.0, 5.0] {
            // Three sums of two values each, with known weights, of rows that differ.
            let values = [1.0 + x, 1.0 + x * x];
            fit.add(
                values.into_iter(),
                values.into_iter(),
                &[[0.5, 1.0, 2.0], [-0.25, 1.0, 4.0]],
            );
        }
        let expected = [[0.5, 1.0, 2.0], [-0.25, 1.0, 4.0]];
        for (weight, expected) in fit
            .solve()
            .into_iter()
            .flatten()
            .zip(expected.into_iter().flatten())
        {
            assert!((weight - expected).abs() < 1e-12);
        }
    }
}
