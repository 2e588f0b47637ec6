//! Between CIE XYZ and what a display is sent.
//!
//! ```text
//! XYZ = P diag(s) rgb,   P = columns (x, y, 1 − x − y)/y of the primaries,   P s = white
//! encoded = 12.92 v                     for v ≤ 0.0031308
//!           1.055 v^(1/2.4) − 0.055     above
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | rgb, v | linear light of the display, 1 = full | 1 |
//! | x, y | chromaticity | 1 |
//!
//! **Validity.** The matrices are exact for the primaries and for the white point 0.3127, 0.3290; the printed
//! four-decimal matrices differ in the fifth digit. The transfer function is for 0..=1, and both directions clamp to it:
//! the display has nothing else to show.
//!
//! **Source.** ITU-R BT.709-6 (2015), 1.3 and 1.4; IEC 61966-2-1:1999, eq. 7 to 10.

use glam::{DMat3, DVec3};

/// Chromaticities x, y of the primaries red, green and blue of Rec. 709 and sRGB.
pub const PRIMARIES_XY: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

/// Chromaticity x, y of their white, which stands for D65.
pub const WHITE_XY: [f64; 2] = [0.3127, 0.3290];

/// Y of linear Rec. 709 light: the middle row of [`xyz_from_rgb`], rounded to f32.
pub(super) const LUMINANCE: [f32; 3] = [0.212_639_01, 0.715_168_65, 0.072_192_32];

/// Linear value at which the sRGB transfer function turns from a line into a power.
const ENCODE_SEAM: f64 = 0.0031308;

/// XYZ with Y = 1 of a chromaticity. Precondition: y ≠ 0.
pub fn xyz_from_xy([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The matrix from linear Rec. 709 to XYZ; white (1, 1, 1) has Y = 1.
pub fn xyz_from_rgb() -> DMat3 {
    xyz_from_primaries(PRIMARIES_XY, WHITE_XY)
}

/// The matrix to XYZ from linear light of primaries with these chromaticities x, y; (1, 1, 1) is this white with Y = 1.
pub(super) fn xyz_from_primaries(primaries_xy: [[f64; 2]; 3], white_xy: [f64; 2]) -> DMat3 {
    let [red, green, blue] = primaries_xy.map(xyz_from_xy);
    let primaries = DMat3::from_cols(red, green, blue);
    let scale = primaries.inverse() * xyz_from_xy(white_xy);
    primaries * DMat3::from_diagonal(scale)
}

/// The matrix from XYZ to linear Rec. 709.
pub fn rgb_from_xyz() -> DMat3 {
    xyz_from_rgb().inverse()
}

/// A matrix from its rows, as they are printed in books.
pub(super) fn matrix_from_rows(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// The sRGB encoding of a linear value, both 0..=1. Values outside are clamped; NaN becomes 0.
pub fn srgb_encode(linear: f32) -> f32 {
    if linear.is_nan() {
        return 0.0;
    }
    let linear = linear.clamp(0.0, 1.0);
    if linear <= ENCODE_SEAM as f32 {
        12.92 * linear
    } else {
        // The same as 1.055 v^(1/2.4) − 0.055, arranged so that 1 becomes 1 to the last bit.
        1.0 - 1.055 * (1.0 - linear.powf(1.0 / 2.4))
    }
}

/// The linear value of an sRGB encoding, both 0..=1. Values outside are clamped; NaN becomes 0.
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded.is_nan() {
        return 0.0;
    }
    let encoded = encoded.clamp(0.0, 1.0);
    if encoded <= (12.92 * ENCODE_SEAM) as f32 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
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
    use palette::Srgb;
    use proptest::prelude::*;

    const MATRIX_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/srgb_matrix.csv"
    ));
    const INTEGRALS_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/cie_integrals.csv"
    ));

    #[test]
    fn matrices_are_those_of_the_primaries() {
        let table = Table::parse(MATRIX_CSV);
        assert_eq!(table.rows().count(), 9);
        for row in table.rows() {
            let (i, j) = (row.number("row") as usize, row.number("col") as usize);
            let there = xyz_from_rgb().row(i)[j] - row.number("rgb_to_xyz_exact");
            let back = rgb_from_xyz().row(i)[j] - row.number("xyz_to_rgb_exact");
            assert!(there.abs() < 1e-14, "row {i} column {j}: {there:e}");
            assert!(back.abs() < 1e-14, "row {i} column {j}: {back:e}");
            // What is printed is the same matrix, to fewer digits.
            for printed in ["xyz_to_rgb_iec61966", "xyz_to_rgb_pbrt"] {
                let off = rgb_from_xyz().row(i)[j] - row.number(printed);
                assert!(off.abs() < 5e-4, "{printed}, row {i} column {j}: {off:e}");
            }
        }
    }

    #[test]
    fn black_bodies_have_the_reference_rgb() {
        for row in Table::parse(INTEGRALS_CSV).rows() {
            let xyz = DVec3::new(row.number("X"), row.number("Y"), row.number("Z"));
            let expected = DVec3::new(
                row.number("r_lin"),
                row.number("g_lin"),
                row.number("b_lin"),
            );
            let error = (rgb_from_xyz() * xyz - expected).abs().max_element();
            assert!(error < 1e-13 * xyz.max_element(), "{}", row.text("T_K"));
        }
    }

    #[test]
    fn case_66_black_bodies_below_1900_kelvin_are_outside_the_triangle() {
        for row in Table::parse(INTEGRALS_CSV).rows() {
            let xyz = DVec3::new(row.number("X"), row.number("Y"), row.number("Z"));
            let outside = (rgb_from_xyz() * xyz).min_element() < 0.0;
            assert_eq!(outside, row.number("T_K") <= 1900.0, "{}", row.text("T_K"));
        }
    }

    #[test]
    fn case_67_the_transfer_function_has_no_gap_and_no_nan() {
        let seam = ENCODE_SEAM as f32;
        assert!((srgb_encode(seam) - srgb_encode(seam.next_up())).abs() < 1e-7);
        assert_eq!(srgb_encode(f32::NAN), 0.0);
        assert_eq!(srgb_decode(f32::NAN), 0.0);
        assert_eq!(srgb_encode(-1.0), 0.0);
        assert_eq!(srgb_encode(f32::NEG_INFINITY), 0.0);
        assert_eq!(srgb_encode(f32::INFINITY), 1.0);
        assert_eq!((srgb_encode(0.0), srgb_encode(1.0)), (0.0, 1.0));
        assert_eq!((srgb_decode(0.0), srgb_decode(1.0)), (0.0, 1.0));
    }

    proptest! {
        #[test]
        fn encoding_agrees_with_an_independent_crate(linear in 0.0..1.0_f32) {
            let theirs = Srgb::<f32>::from_linear(palette::LinSrgb::new(linear, linear, linear)).red;
            prop_assert!((srgb_encode(linear) - theirs).abs() < 2e-6);
        }

        #[test]
        fn encoding_is_monotone_and_undone_by_decoding(a in 0.0..1.0_f32, b in 0.0..1.0_f32) {
            prop_assert!((a <= b) == (srgb_encode(a) <= srgb_encode(b)) || (a - b).abs() < 1e-6);
            prop_assert!((srgb_decode(srgb_encode(a)) - a).abs() < 1e-6);
        }
    }
}
