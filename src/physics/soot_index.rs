//! The complex refractive index of soot.
//!
//! ```text
//! m = n − i k
//! E(m) = −Im((m² − 1)/(m² + 2)) = 6 n k / D
//! F(m) = |(m² − 1)/(m² + 2)|²   = ((n² − k² − 1)² + 4 n² k²) / D
//! D    = |m² + 2|²              = (n² − k² + 2)² + 4 n² k²
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | n, k | real and imaginary part of the index | 1 |
//! | E, F | absorption and scattering function of a small sphere | 1 |
//! | λ | vacuum wavelength | nm |
//!
//! Two sources of n and k are offered.
//!
//! * [`chang`]: a polynomial in u = ln(λ/µm), measured on a propane flame. **Valid** 400 nm to 30 µm. Outside, the index
//!   of the nearest end is used: a cubic leaves its data quickly.
//!   Source: H. Chang and T. T. Charalampopoulos, Proc. R. Soc. Lond. A 430 (1990) 577.
//! * [`dalzell_sarofim`]: tables for propane and acetylene soot. **Valid** 435.8 to 650 nm. Between knots n and k are
//!   linear (and E is formed from them); outside, the index of the nearest end is used, for a straight line through the
//!   last two knots could make k negative.
//!   Source: W. H. Dalzell and A. F. Sarofim, J. Heat Transfer 91 (1969) 100. They write m = n(1 − iκ); k here is nκ.

use serde::{Deserialize, Serialize};

/// A complex refractive index m = n − i k. Preconditions: n > 0 and k ≥ 0, both finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexIndex {
    /// Real part n.
    pub n: f64,
    /// Imaginary part k, positive where the material absorbs.
    pub k: f64,
}

impl ComplexIndex {
    /// The absorption function E(m) of a sphere much smaller than the wavelength.
    pub fn absorption_function(self) -> f64 {
        6.0 * self.n * self.k / self.denominator()
    }

    /// The scattering function F(m) of a sphere much smaller than the wavelength.
    pub fn scattering_function(self) -> f64 {
        let real = self.n * self.n - self.k * self.k - 1.0;
        let imaginary = 2.0 * self.n * self.k;
        (real * real + imaginary * imaginary) / self.denominator()
    }

    /// |m² + 2|². Zero only for n = 0, k = √2, which the precondition on n excludes.
    fn denominator(self) -> f64 {
        debug_assert!(self.n > 0.0 && self.k >= 0.0, "{self:?}");
        let real = self.n * self.n - self.k * self.k + 2.0;
        let imaginary = 2.0 * self.n * self.k;
        real * real + imaginary * imaginary
    }
}

/// Whose soot the tables of Dalzell and Sarofim describe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SootIndex {
    /// Soot of a propane flame.
    #[default]
    Propane,
    /// Soot of an acetylene flame.
    Acetylene,
}

/// Wavelengths of the Dalzell and Sarofim tables, nm.
const TABLE_LAMBDA_NM: [f64; 4] = [435.8, 450.0, 550.0, 650.0];

/// n of propane soot at [`TABLE_LAMBDA_NM`].
const PROPANE_N: [f64; 4] = [1.57, 1.56, 1.57, 1.56];
/// k of propane soot at [`TABLE_LAMBDA_NM`].
const PROPANE_K: [f64; 4] = [0.46, 0.50, 0.53, 0.52];
/// n of acetylene soot at [`TABLE_LAMBDA_NM`].
const ACETYLENE_N: [f64; 4] = [1.56, 1.56, 1.56, 1.57];
/// k of acetylene soot at [`TABLE_LAMBDA_NM`].
const ACETYLENE_K: [f64; 4] = [0.46, 0.48, 0.46, 0.44];

/// The range of the Chang and Charalampopoulos polynomial, nm.
const CHANG_RANGE_NM: (f64, f64) = (400.0, 30_000.0);
/// Coefficients of n in powers of u = ln(λ/µm).
const CHANG_N: [f64; 4] = [1.811, 0.1263, 0.0270, 0.0417];
/// Coefficients of k in powers of u = ln(λ/µm).
const CHANG_K: [f64; 4] = [0.5821, 0.1213, 0.2309, -0.0100];

/// The index by Chang and Charalampopoulos (1990), held constant outside 400 nm to 30 µm.
pub fn chang(lambda_nm: f64) -> ComplexIndex {
    let (shortest, longest) = CHANG_RANGE_NM;
    let u = (lambda_nm.clamp(shortest, longest) * 1e-3).ln();
    ComplexIndex {
        n: cubic(CHANG_N, u),
        k: cubic(CHANG_K, u),
    }
}

/// The index by Dalzell and Sarofim (1969), linear between the knots, held constant outside 435.8 to 650 nm.
pub fn dalzell_sarofim(soot: SootIndex, lambda_nm: f64) -> ComplexIndex {
    let (n, k) = match soot {
        SootIndex::Propane => (PROPANE_N, PROPANE_K),
        SootIndex::Acetylene => (ACETYLENE_N, ACETYLENE_K),
    };
    let lambda_nm = lambda_nm.clamp(TABLE_LAMBDA_NM[0], TABLE_LAMBDA_NM[3]);
    let left = TABLE_LAMBDA_NM[1..3]
        .iter()
        .filter(|knot| **knot <= lambda_nm)
        .count();
    let width = TABLE_LAMBDA_NM[left + 1] - TABLE_LAMBDA_NM[left];
    let t = (lambda_nm - TABLE_LAMBDA_NM[left]) / width;
    ComplexIndex {
        n: n[left] + (n[left + 1] - n[left]) * t,
        k: k[left] + (k[left + 1] - k[left]) * t,
    }
}

/// a₀ + a₁u + a₂u² + a₃u³ by Horner's rule.
fn cubic(a: [f64; 4], u: f64) -> f64 {
    a[0] + u * (a[1] + u * (a[2] + u * a[3]))
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        reason = "a test fails by panicking"
    )]

    use super::super::golden_csv::{Row, Table};
    use super::*;
    use proptest::prelude::*;

    const INDEX_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/soot_index.csv"
    ));

    fn assert_index(row: &Row<'_>, source: &str, index: ComplexIndex) {
        for (name, got) in [
            ("n", index.n),
            ("k", index.k),
            ("E", index.absorption_function()),
            ("F", index.scattering_function()),
        ] {
            let expected = row.number(&format!("{name}_{source}"));
            assert!(
                (got / expected - 1.0).abs() < 1e-14,
                "{name}_{source} at {} nm: {got}, expected {expected}",
                row.text("lambda_nm")
            );
        }
    }

    #[test]
    fn index_and_functions_agree_with_fifty_digit_arithmetic() {
        let mut compared = 0;
        for row in Table::parse(INDEX_CSV).rows() {
            let lambda_nm = row.number("lambda_nm");
            if lambda_nm >= 400.0 {
                assert_index(&row, "cc", chang(lambda_nm));
                compared += 1;
            }
            // Below their first knot the reference is held constant as we hold it; above 650 nm it runs on to another.
            if lambda_nm <= 650.0 {
                for (soot, name) in [
                    (SootIndex::Propane, "ds_propane"),
                    (SootIndex::Acetylene, "ds_acetylene"),
                ] {
                    assert_index(&row, name, dalzell_sarofim(soot, lambda_nm));
                    compared += 1;
                }
            }
        }
        assert!(compared > 90, "only {compared} comparisons");
    }

    #[test]
    fn knots_are_met() {
        for (i, lambda_nm) in TABLE_LAMBDA_NM.into_iter().enumerate() {
            let propane = dalzell_sarofim(SootIndex::Propane, lambda_nm);
            let acetylene = dalzell_sarofim(SootIndex::Acetylene, lambda_nm);
            assert!((propane.n - PROPANE_N[i]).abs() < 1e-15);
            assert!((propane.k - PROPANE_K[i]).abs() < 1e-15);
            assert!((acetylene.n - ACETYLENE_N[i]).abs() < 1e-15);
            assert!((acetylene.k - ACETYLENE_K[i]).abs() < 1e-15);
        }
    }

    #[test]
    fn case_23_a_transparent_particle_scatters_only() {
        let glass = ComplexIndex { n: 1.5, k: 0.0 };
        assert_eq!(glass.absorption_function(), 0.0);
        assert!(glass.scattering_function() > 0.0);
        let nothing = ComplexIndex { n: 1.0, k: 0.0 };
        assert_eq!(nothing.absorption_function(), 0.0);
        assert_eq!(nothing.scattering_function(), 0.0);
    }

    #[test]
    fn case_26_outside_their_range_the_models_are_held_constant() {
        for soot in [SootIndex::Propane, SootIndex::Acetylene] {
            let (first, last) = (dalzell_sarofim(soot, 435.8), dalzell_sarofim(soot, 650.0));
            assert_eq!(dalzell_sarofim(soot, 200.0), first);
            assert_eq!(dalzell_sarofim(soot, 5000.0), last);
        }
        assert_eq!(chang(300.0), chang(400.0));
        assert_eq!(chang(1e6), chang(30_000.0));
    }

    proptest! {
        #[test]
        fn case_24_every_index_offered_absorbs(lambda_nm in 1.0..1e6_f64) {
            for index in [
                chang(lambda_nm),
                dalzell_sarofim(SootIndex::Propane, lambda_nm),
                dalzell_sarofim(SootIndex::Acetylene, lambda_nm),
            ] {
                prop_assert!(index.n > 1.0 && index.k > 0.0);
                // Far in the infrared a metal-like index brings E down to 0.02; it never comes near the resonance.
                prop_assert!((0.01..0.5).contains(&index.absorption_function()), "{:?}", index);
            }
        }
    }
}
