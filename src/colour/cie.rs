//! The CIE 1931 standard colorimetric observer (2°) and the standard illuminant D65.
//!
//! ```text
//! X = Σ L(λ) x̄(λ) Δλ,   Y and Z likewise;   luminance = K_m Y
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | L | spectral radiance | W m⁻² sr⁻¹ nm⁻¹ |
//! | x̄, ȳ, z̄ | colour matching functions | 1 |
//! | X, Y, Z | tristimulus values, not normalised | W m⁻² sr⁻¹ |
//! | K_m | maximum luminous efficacy | lm W⁻¹ |
//!
//! **Validity.** The observer is tabulated from 360 to 830 nm at 1 nm, D65 from 300 to 780 nm at 5 nm. Between knots both
//! are linear; outside they are 0, which for the observer is what the eye does.
//!
//! **Source.** ISO/CIE 11664-1:2019, table 1; ISO/CIE 11664-2:2022, table 1. The data files say how they came here.

use std::sync::LazyLock;

/// Maximum luminous efficacy of radiation K_m in lm W⁻¹: luminance in cd m⁻² is this times Y in W m⁻² sr⁻¹. The SI
/// defines 683 lm W⁻¹ at 540 THz; the peak of ȳ lies so close that the difference is ignored, as is usual.
pub const MAX_LUMINOUS_EFFICACY: f64 = 683.0;

/// First wavelength of the observer's table, nm.
pub const OBSERVER_FIRST_NM: f64 = 360.0;
/// Last wavelength of the observer's table, nm.
pub const OBSERVER_LAST_NM: f64 = 830.0;

const OBSERVER_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/assets/colour/cie_1931_2deg_1nm.csv"
));
const D65_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/assets/colour/d65_5nm.csv"
));

/// Lines of λ, x̄, ȳ, z̄.
static OBSERVER: LazyLock<Vec<[f64; 4]>> = LazyLock::new(|| numbers(OBSERVER_CSV));
/// Lines of λ, S.
static D65: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| numbers(D65_CSV));

/// The colour matching functions x̄, ȳ, z̄ at a wavelength; 0 outside 360 to 830 nm.
pub fn colour_matching(lambda_nm: f64) -> [f64; 3] {
    let [_, x, y, z] = interpolated(&OBSERVER, lambda_nm);
    [x, y, z]
}

/// The relative spectral power of D65 at a wavelength, 100 at 560 nm; 0 outside 300 to 780 nm.
pub fn d65(lambda_nm: f64) -> f64 {
    let [_, power] = interpolated(&D65, lambda_nm);
    power
}

/// The line of an evenly spaced table at a wavelength (its first number), linear between lines, 0 outside.
fn interpolated<const N: usize>(table: &[[f64; N]], lambda_nm: f64) -> [f64; N] {
    let (Some(first), Some(last)) = (table.first(), table.last()) else {
        return [0.0; N];
    };
    if !(first[0]..=last[0]).contains(&lambda_nm) {
        return [0.0; N];
    }
    let step = (last[0] - first[0]) / (table.len() - 1) as f64;
    let position = (lambda_nm - first[0]) / step;
    let left = (position as usize).min(table.len() - 2);
    let t = position - left as f64;
    std::array::from_fn(|i| table[left][i] * (1.0 - t) + table[left + 1][i] * t)
}

/// The lines of a CSV text that hold N numbers; comments and the header do not. The texts are compiled in, and a test
/// counts their lines.
fn numbers<const N: usize>(csv: &str) -> Vec<[f64; N]> {
    csv.lines()
        .filter_map(|line| {
            let fields: Vec<f64> = line.split(',').filter_map(|f| f.parse().ok()).collect();
            fields.try_into().ok()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        reason = "a test fails by panicking"
    )]

    use super::super::golden_csv::Table;
    use super::*;
    use proptest::prelude::*;

    const OBSERVER_REFERENCE: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/cie_1931_2deg_1nm.csv"
    ));
    const D65_REFERENCE: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/d65_5nm.csv"
    ));
    const INTEGRALS_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/cie_integrals.csv"
    ));

    /// Sum over the 1 nm table of a spectrum times the observer.
    fn rectangle_sum(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
        (360..=830).fold([0.0; 3], |sum, nm| {
            let lambda_nm = f64::from(nm);
            let matching = colour_matching(lambda_nm);
            std::array::from_fn(|i| sum[i] + spectrum(lambda_nm) * matching[i])
        })
    }

    /// Planck's law in W m⁻² sr⁻¹ nm⁻¹, written again so that this room stays a stranger to physics.
    fn planck(lambda_nm: f64, temperature_k: f64) -> f64 {
        1.1910429723971884e20
            / lambda_nm.powi(5)
            / (1.4387768775039338e7 / (lambda_nm * temperature_k)).exp_m1()
    }

    #[test]
    fn tables_are_complete_and_met_at_every_knot() {
        assert_eq!(OBSERVER.len(), 471);
        assert_eq!(D65.len(), 97);
        for row in Table::parse(OBSERVER_REFERENCE).rows() {
            let expected = [row.number("xbar"), row.number("ybar"), row.number("zbar")];
            assert_eq!(colour_matching(row.number("lambda_nm")), expected);
        }
        for row in Table::parse(D65_REFERENCE).rows() {
            assert_eq!(d65(row.number("lambda_nm")), row.number("S_D65"));
        }
        assert_eq!(OBSERVER[0][0], OBSERVER_FIRST_NM);
        assert_eq!(OBSERVER[470][0], OBSERVER_LAST_NM);
    }

    #[test]
    fn between_knots_the_tables_are_linear() {
        let (left, right) = (colour_matching(555.0), colour_matching(556.0));
        let between = colour_matching(555.25);
        for i in 0..3 {
            assert!((between[i] - (0.75 * left[i] + 0.25 * right[i])).abs() < 1e-15);
        }
        assert!((d65(562.0) - (0.6 * d65(560.0) + 0.4 * d65(565.0))).abs() < 1e-12);
    }

    #[test]
    fn outside_the_tables_there_is_nothing() {
        for lambda_nm in [
            f64::NEG_INFINITY,
            0.0,
            359.999,
            830.001,
            f64::INFINITY,
            f64::NAN,
        ] {
            assert_eq!(colour_matching(lambda_nm), [0.0; 3]);
        }
        assert_eq!(d65(299.9), 0.0);
        assert_eq!(d65(780.1), 0.0);
    }

    #[test]
    fn black_bodies_have_the_reference_tristimulus_values() {
        let norm = rectangle_sum(|_| 1.0)[1];
        let table = Table::parse(INTEGRALS_CSV);
        assert_eq!(table.rows().count(), 17);
        for row in table.rows() {
            let temperature_k = row.number("T_K");
            let xyz = rectangle_sum(|lambda_nm| planck(lambda_nm, temperature_k));
            for (got, column) in chromaticity(xyz).into_iter().zip(["x", "y"]) {
                assert!((got / row.number(column) - 1.0).abs() < 1e-13);
            }
            for (got, column) in xyz.into_iter().zip(["X", "Y", "Z"]) {
                let expected = row.number(column) * norm;
                assert!(
                    (got / expected - 1.0).abs() < 1e-13,
                    "{column} at {temperature_k} K: {got:e}, expected {expected:e}"
                );
            }
            let luminance = MAX_LUMINOUS_EFFICACY * xyz[1];
            assert!((luminance / row.number("Lv_cd_m-2") - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn coarser_and_shorter_tables_err_as_the_reference_says() {
        for row in Table::parse(INTEGRALS_CSV).rows() {
            let temperature_k = row.number("T_K");
            let sum = |nm: &mut dyn Iterator<Item = i32>| {
                nm.fold([0.0; 3], |sum: [f64; 3], nm| {
                    let lambda_nm = f64::from(nm);
                    let matching = colour_matching(lambda_nm);
                    let radiance = planck(lambda_nm, temperature_k);
                    [0, 1, 2].map(|i| sum[i] + radiance * matching[i])
                })
            };
            let all = sum(&mut (360..=830));
            let coarse = sum(&mut (380..=780).step_by(5)).map(|v| 5.0 * v);
            let short = sum(&mut (400..=700));
            let [[x, y], [x5, y5], [x4, y4]] = [all, coarse, short].map(chromaticity);
            for (got, column) in [
                (x5, "x_5nm"),
                (y5, "y_5nm"),
                (coarse[1] / all[1] - 1.0, "Y_5nm_rel_err"),
                (x4 - x, "dx_400_700"),
                (y4 - y, "dy_400_700"),
                (short[1] / all[1] - 1.0, "Y_400_700_rel_err"),
            ] {
                let expected = row.number(column);
                assert!(
                    (got - expected).abs() < 1e-13,
                    "{column} at {temperature_k} K: {got:e}, expected {expected:e}"
                );
            }
        }
    }

    /// The Planckian locus by B. Kang et al., J. Korean Phys. Soc. 41 (2002) 865, from 1667 to 25000 K.
    #[test]
    fn black_bodies_lie_on_the_planckian_locus() {
        let mut compared = 0;
        for row in Table::parse(INTEGRALS_CSV).rows() {
            let t = row.number("T_K");
            if !(1667.0..=25_000.0).contains(&t) {
                continue;
            }
            let coefficients = if t <= 4000.0 {
                [0.179910, 0.8776956, -0.2343589, -0.2661239]
            } else {
                [0.240390, 0.2226347, 2.1070379, -3.0258469]
            };
            let u = 1e3 / t;
            let locus = coefficients.iter().rev().fold(0.0, |sum, c| sum * u + c);
            let [x, _] = chromaticity(rectangle_sum(|nm| planck(nm, t)));
            assert!((x - locus).abs() < 6e-4, "{t} K: {x}, locus {locus}");
            compared += 1;
        }
        assert!(compared > 8, "only {compared}");
    }

    fn chromaticity([x, y, z]: [f64; 3]) -> [f64; 2] {
        [x / (x + y + z), y / (x + y + z)]
    }

    #[test]
    fn case_68_a_flat_spectrum_is_nearly_equal_energy_white() {
        let sums = rectangle_sum(|_| 1.0);
        for (sum, expected) in sums.into_iter().zip([106.86547, 106.85692, 106.89225]) {
            assert!((sum - expected).abs() < 1e-5, "{sum}");
        }
        assert!((sums[0] / sums[1] - 1.000080).abs() < 4e-4);
        assert!((sums[2] / sums[1] - 1.000331).abs() < 4e-4);
    }

    proptest! {
        #[test]
        fn the_observer_is_continuous_and_never_negative(lambda_nm in 300.0..900.0_f64) {
            let here = colour_matching(lambda_nm);
            let near = colour_matching(lambda_nm + 1e-6);
            for i in 0..3 {
                prop_assert!(here[i] >= 0.0);
                // The steepest slope is 0.08 per nm; at the ends the table steps by 6e-4.
                prop_assert!((here[i] - near[i]).abs() < 7e-4);
            }
        }
    }
}
