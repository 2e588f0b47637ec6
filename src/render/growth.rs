//! The curve of growth for the march, in single precision.
//!
//! Between its limits y and √(2y/π) the law is nearly a root: with
//!
//! ```text
//! G(y) = y / √(1 + y q),   q from 1 at y = 0 to π/2 at y = ∞
//! ```
//!
//! q is so smooth in z = (y − 1)/(y + 1) that a polynomial holds it. The polynomial is made from the law itself, by
//! interpolation at Chebyshev's points, once for the program.

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector};

use crate::physics::growth::curve_of_growth;

/// Coefficients of q in powers of z.
pub(super) type GrowthFit = [f32; TERMS];

/// Terms of the polynomial.
const TERMS: usize = 14;

/// The fit.
pub(super) static FIT: LazyLock<GrowthFit> = LazyLock::new(fit);

/// G(y) for y ≥ 0, 1e-6 of itself from the law.
#[inline(always)]
pub(super) fn curve_of_growth_f32(fit: &GrowthFit, y: f32) -> f32 {
    let z = 1.0 - 2.0 / (y + 1.0);
    let mut q = fit[TERMS - 1];
    for &coefficient in fit[..TERMS - 1].iter().rev() {
        q = q * z + coefficient;
    }
    y / (1.0 + y * q).sqrt()
}

fn fit() -> GrowthFit {
    let points = (0..TERMS).map(|i| {
        let angle = std::f64::consts::PI * (i as f64 + 0.5) / TERMS as f64;
        angle.cos()
    });
    let (mut powers, mut values) = (Vec::new(), Vec::new());
    for z in points {
        let y = (1.0 + z) / (1.0 - z);
        let root = y / curve_of_growth(y);
        values.push((root * root - 1.0) / y);
        powers.extend((0..TERMS as i32).map(|power| z.powi(power)));
    }
    let solved = DMatrix::from_row_iterator(TERMS, TERMS, powers)
        .lu()
        .solve(&DVector::from_vec(values));
    // Powers of different points are independent: there is a solution.
    solved.map_or([0.0; TERMS], |q| std::array::from_fn(|i| q[i] as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_follows_the_law_over_eighteen_decades() {
        let mut worst = 0.0_f64;
        for i in 0..=3600 {
            let y = 10.0_f64.powf(-10.0 + f64::from(i) * 0.005);
            let ours = f64::from(curve_of_growth_f32(&FIT, y as f32));
            worst = worst.max((ours / curve_of_growth(f64::from(y as f32)) - 1.0).abs());
        }
        assert!(worst < 2e-6, "off by {worst:e}");
        assert_eq!(curve_of_growth_f32(&FIT, 0.0), 0.0);
    }

    #[test]
    fn more_gas_never_gives_less_light() {
        let mut before = 0.0;
        for i in 0..3600 {
            let y = 10.0_f32.powf(-10.0 + i as f32 * 0.005);
            let growth = curve_of_growth_f32(&FIT, y);
            assert!(growth > before, "{y}");
            before = growth;
        }
    }
}
