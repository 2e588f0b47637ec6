//! Absorption and scattering by one sphere of any size: Mie's series.
//!
//! ```text
//! a_n = [(D_n/m + n/x) ψ_n − ψ_{n−1}] / [(D_n/m + n/x) ξ_n − ξ_{n−1}]
//! b_n = [(m D_n + n/x) ψ_n − ψ_{n−1}] / [(m D_n + n/x) ξ_n − ξ_{n−1}]
//! Q_ext = (2/x²) Σ (2n+1) Re(a_n + b_n),   Q_sca = (2/x²) Σ (2n+1) (|a_n|² + |b_n|²),   Q_abs = Q_ext − Q_sca
//! g Q_sca = (4/x²) Σ [ n(n+2)/(n+1) Re(a_n a*_{n+1} + b_n b*_{n+1}) + (2n+1)/(n(n+1)) Re(a_n b*_n) ]
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x | size parameter 2πR/λ | 1 |
//! | m | index of the sphere against that around it; n + ik here, as in the source | 1 |
//! | ψ_n, ξ_n | Riccati–Bessel functions of x, ξ_n = ψ_n − iχ_n | 1 |
//! | D_n | logarithmic derivative of ψ_n at mx | 1 |
//! | Q | cross section over the sphere's own πR² | 1 |
//! | g | mean cosine of the scattering | 1 |
//!
//! **Validity.** A homogeneous sphere, alone in its light: 1e-4 ≤ x ≤ 20, k > 0. D_n and the ratios of ψ_n are found
//! from high orders downwards and χ_n upwards, the ways in which rounding dies out (appendix A of the source). Q is good
//! to about 1e-13; g to 1e-14 + 1e-15/x² in absolute terms, for it is x² small itself.
//!
//! **Source.** C. F. Bohren and D. R. Huffman, *Absorption and Scattering of Light by Small Particles* (1983), eq. 4.61,
//! 4.62, 4.88, 4.89 and appendix A; g by the formula after eq. 4.62.

use nalgebra::Complex;

use super::soot_index::ComplexIndex;

/// Smallest size parameter for which the series is summed; below it the limit of small spheres holds to 1e-8.
pub const SMALLEST: f64 = 1e-4;

/// What a sphere does to light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Efficiencies {
    /// Absorption cross section over πR², dimensionless.
    pub absorption: f64,
    /// Scattering cross section over πR², dimensionless.
    pub scattering: f64,
    /// Mean cosine of the scattering, −1 to 1.
    pub asymmetry: f64,
}

impl Efficiencies {
    /// Of a sphere of size parameter `x`, from [`SMALLEST`] to about 20, in air or vacuum.
    pub fn of_sphere(index: ComplexIndex, x: f64) -> Self {
        debug_assert!((SMALLEST..=50.0).contains(&x), "x = {x}");
        let [a, b] = coefficients(index, x);
        let (mut extinction, mut scattering, mut forward) = (0.0, 0.0, 0.0);
        for i in 0..a.len() {
            let n = (i + 1) as f64;
            extinction += (2.0 * n + 1.0) * (a[i] + b[i]).re;
            scattering += (2.0 * n + 1.0) * (a[i].norm_sqr() + b[i].norm_sqr());
            forward += (2.0 * n + 1.0) / (n * (n + 1.0)) * (a[i] * b[i].conj()).re;
            if i + 1 < a.len() {
                let next = a[i] * a[i + 1].conj() + b[i] * b[i + 1].conj();
                forward += n * (n + 2.0) / (n + 1.0) * next.re;
            }
        }
        Self {
            absorption: 2.0 / (x * x) * (extinction - scattering),
            scattering: 2.0 / (x * x) * scattering,
            asymmetry: 2.0 * forward / scattering,
        }
    }

    /// The limit of small spheres (eq. 5.8 and 5.9 with 5.4), which scatter evenly forwards and backwards.
    pub fn of_small_sphere(index: ComplexIndex, x: f64) -> Self {
        Self {
            absorption: 4.0 * x * index.absorption_function(),
            scattering: 8.0 / 3.0 * x.powi(4) * index.scattering_function(),
            asymmetry: 0.0,
        }
    }
}

/// The coefficients a_n and b_n from n = 1 on, as many as count.
fn coefficients(index: ComplexIndex, x: f64) -> [Vec<Complex<f64>>; 2] {
    let m = Complex::new(index.n, index.k);
    // Wiscombe's count of terms with three to spare.
    let count = (x + 4.05 * x.cbrt() + 2.0).ceil() as usize + 3;
    let derivatives = logarithmic_derivatives(m * x, count);
    let psi = psi(x, count);

    let mut found = [Vec::with_capacity(count), Vec::with_capacity(count)];
    let (mut chi_before, mut chi) = (x.cos(), x.cos() / x + x.sin());
    for n in 1..=count {
        let order = n as f64;
        let xi_before = Complex::new(psi[n - 1], -chi_before);
        let xi = Complex::new(psi[n], -chi);
        let of = |slope: Complex<f64>| {
            let factor = slope + order / x;
            (factor * psi[n] - psi[n - 1]) / (factor * xi - xi_before)
        };
        found[0].push(of(derivatives[n] / m));
        found[1].push(of(derivatives[n] * m));
        (chi_before, chi) = (chi, (2.0 * order + 1.0) / x * chi - chi_before);
    }
    found
}

/// D_0 to D_count at z, by the recurrence downwards from an order at which any start will do.
fn logarithmic_derivatives(z: Complex<f64>, count: usize) -> Vec<Complex<f64>> {
    let start = count.max(z.norm().ceil() as usize) + 16;
    let mut found = vec![Complex::new(0.0, 0.0); start + 1];
    for n in (1..=start).rev() {
        let slope = z.inv() * n as f64;
        found[n - 1] = slope - (found[n] + slope).inv();
    }
    found.truncate(count + 1);
    found
}

/// ψ_0 to ψ_count at x, from their ratios, which are found downwards.
fn psi(x: f64, count: usize) -> Vec<f64> {
    let start = count.max(x.ceil() as usize) + 16;
    // ψ_{n−1}/ψ_n, high orders first known.
    let mut ratios = vec![0.0; start + 1];
    ratios[start] = (2.0 * start as f64 + 1.0) / x;
    for n in (1..start).rev() {
        ratios[n] = (2.0 * n as f64 + 1.0) / x - 1.0 / ratios[n + 1];
    }
    let mut found = vec![x.sin(); count + 1];
    // Beside a zero of ψ_0 the ratios are tied to ψ_1, which then is none.
    let first = x.sin() / x - x.cos();
    found[1] = if x > 1.0 && first.abs() > x.sin().abs() {
        first
    } else {
        x.sin() / ratios[1]
    };
    for n in 2..=count {
        found[n] = found[n - 1] / ratios[n];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::golden_csv::Table;
    use super::*;

    const MIE_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/soot_mie.csv"
    ));

    #[test]
    fn efficiencies_agree_with_thirty_digit_arithmetic() {
        let mut rows = 0;
        for row in Table::parse(MIE_CSV).rows() {
            let index = ComplexIndex {
                n: row.number("n"),
                k: row.number("k"),
            };
            let got = Efficiencies::of_sphere(index, row.number("x"));
            for (got, name) in [
                (got.absorption, "Q_abs_mie"),
                (got.scattering, "Q_sca_mie"),
                (got.asymmetry, "g_mie"),
            ] {
                let error = (got / row.number(name) - 1.0).abs();
                assert!(
                    error < 1e-12,
                    "{name} at x = {}: {error:e}",
                    row.number("x")
                );
            }
            rows += 1;
        }
        assert!(rows > 20);
    }

    #[test]
    fn a_glass_sphere_has_the_extinction_of_the_book() {
        // Bohren and Huffman, appendix A: m = 1.55, radius 0.525 µm at 0.6328 µm gives Q_ext = 3.10543; nothing is
        // absorbed.
        let glass = ComplexIndex { n: 1.55, k: 0.0 };
        let got = Efficiencies::of_sphere(glass, 2.0 * std::f64::consts::PI * 0.525 / 0.6328);
        assert!((got.scattering - 3.10543).abs() < 6e-6, "{got:?}");
        assert!(got.absorption.abs() < 1e-13, "{got:?}");
    }

    #[test]
    fn small_spheres_come_to_rayleighs_limit_as_x_squared() {
        let soot = ComplexIndex { n: 1.7, k: 0.6 };
        for x in [SMALLEST, 1e-3, 1e-2, 1e-1] {
            let (mie, small) = (
                Efficiencies::of_sphere(soot, x),
                Efficiencies::of_small_sphere(soot, x),
            );
            assert!((mie.absorption / small.absorption - 1.0).abs() < 2.0 * x * x);
            assert!((mie.scattering / small.scattering - 1.0).abs() < 2.0 * x * x + 1e-12);
            assert!(mie.asymmetry.abs() < x * x);
        }
    }

    #[test]
    fn zeros_of_the_sine_do_not_show() {
        let soot = ComplexIndex { n: 1.6, k: 0.5 };
        for x in [1.0, 2.0, 3.0, 6.0].map(|n| n * std::f64::consts::PI) {
            let at = |x: f64| Efficiencies::of_sphere(soot, x);
            let mean = 0.5 * (at(x - 1e-4).scattering + at(x + 1e-4).scattering);
            assert!((at(x).scattering / mean - 1.0).abs() < 1e-7, "x = {x}");
        }
    }
}
