//! How the eye adapts to the fire: von Kries for its colour, Naka–Rushton for its brightness.
//!
//! ```text
//! (l, m, s) = M XYZ
//! adapted   = M⁻¹ (l/g_l, m/g_m, s/g_s),   g = white^D · display white^(1−D)
//! R(L)      = L/(L + τ) = 1/(1 + τ/L)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | M | Hunt–Pointer–Estévez matrix normalised to D65, four decimals | 1 |
//! | l, m, s | responses of the three cones | that of XYZ |
//! | white | colour that the eye takes for white: the hottest part in view | that of XYZ |
//! | D | degree of adaptation, 0 none, 1 complete | 1 |
//! | L, τ, R | luminance, semi-saturation, response 0..=1 | cd m⁻², cd m⁻², 1 |
//!
//! The display white is M⁻¹(1, 1, 1), so that its l, m, s are 1: with D = 0 the gains are 1 and a colour is left alone,
//! with D = 1 the white lands on the display white. That has Y = 1.00002, because M has four decimals.
//!
//! **Validity.** Any scale of XYZ. A weak blue response of the white is raised to a hundredth of its strongest one:
//! without that, white from a body cooler than about 1150 K would amplify noise in the blue a thousandfold.
//!
//! **Source.** J. von Kries (1905); R. W. G. Hunt and M. R. Pointer, Color Res. Appl. 10 (1985) 165, for the matrix;
//! G. Dorta-Perez, *Realistic fire rendering* (2015), eq. 3.26 and 4.6; K. I. Naka and W. A. H. Rushton, J. Physiol. 185
//! (1966) 536.

use glam::{DMat3, DVec3};

use super::xyz::matrix_from_rows;

/// XYZ to cone responses, rows l, m, s; Hunt–Pointer–Estévez normalised to D65.
const LMS_FROM_XYZ: [[f64; 3]; 3] = [
    [0.4002, 0.7076, -0.0808],
    [-0.2263, 1.1653, 0.0457],
    [0.0, 0.0, 0.9182],
];

/// No cone response of a white counts for less than this fraction of its largest.
const SMALLEST_RESPONSE: f64 = 0.01;

/// Maps an XYZ colour to how it looks to an eye adapted to `white_xyz` in the degree D, 0..=1 (see the page above).
///
/// At D = 0 this is the identity. At D > 0 a white that is black, negative or not finite gives black: there is nothing
/// to compare with. It divides and never forms a reciprocal, so XYZ of any scale do, denormal ones too.
pub fn adapted(xyz: [f64; 3], white_xyz: [f64; 3], degree: f64) -> DVec3 {
    let Some(gain) = gains(white_xyz, degree) else {
        return DVec3::ZERO;
    };
    let matrix = matrix_from_rows(LMS_FROM_XYZ);
    matrix.inverse() * (matrix * DVec3::from_array(xyz) / gain)
}

/// [`adapted`] as a matrix. Its entries are of the size of 1/white, so `white_xyz` should be scaled to Y near 1.
pub fn von_kries(white_xyz: [f64; 3], degree: f64) -> DMat3 {
    let Some(gain) = gains(white_xyz, degree) else {
        return DMat3::ZERO;
    };
    let matrix = matrix_from_rows(LMS_FROM_XYZ);
    matrix.inverse() * DMat3::from_diagonal(1.0 / gain) * matrix
}

/// What the cone responses are divided by; `None` where the white is no light.
fn gains(white_xyz: [f64; 3], degree: f64) -> Option<DVec3> {
    debug_assert!((0.0..=1.0).contains(&degree), "degree {degree}");
    // The display white has the responses (1, 1, 1), so its power of 1 − D is 1.
    if degree == 0.0 {
        return Some(DVec3::ONE);
    }
    let white = matrix_from_rows(LMS_FROM_XYZ) * DVec3::from_array(white_xyz);
    let largest = white.max_element();
    if !(white.is_finite() && largest > 0.0) {
        return None;
    }
    let white = white.max(DVec3::splat(SMALLEST_RESPONSE * largest));
    Some(if degree == 1.0 {
        white
    } else {
        white.powf(degree)
    })
}

/// The response 0..=1 of a cone to a luminance (Naka and Rushton): 1/(1 + τ/L), which cannot overflow as L + τ can.
///
/// A luminance of 0, negative or NaN gives 0, even with τ = 0; an infinite luminance gives 1. Precondition:
/// `semi_saturation` ≥ 0 and finite.
pub fn naka_rushton(luminance: f64, semi_saturation: f64) -> f64 {
    if luminance > 0.0 {
        1.0 / (1.0 + semi_saturation / luminance)
    } else {
        0.0
    }
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

    const ADAPTATION_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/adaptation.csv"
    ));
    /// XYZ of a black body at 1900 K, of the scale of the reference file.
    const WHITE: [f64; 3] = [
        4.3314803999933997,
        3.3119925823398789,
        4.1094020467204158e-01,
    ];

    fn triple(row: &Row<'_>, columns: [&str; 3]) -> [f64; 3] {
        columns.map(|column| row.number(column))
    }

    fn assert_near(got: DVec3, expected: [f64; 3], tolerance: f64, what: &str) {
        let expected = DVec3::from_array(expected);
        let error = ((got - expected) / expected.max(DVec3::splat(f64::MIN_POSITIVE))).abs();
        assert!(
            error.max_element() <= tolerance,
            "{what}: {got}, expected {expected}"
        );
    }

    #[test]
    fn complete_adaptation_agrees_with_fifty_digit_arithmetic() {
        let mut compared = 0;
        for row in Table::parse(ADAPTATION_CSV).rows() {
            let case = row.text("case");
            if !case.starts_with("von_kries") {
                continue;
            }
            let xyz = triple(&row, ["Xi", "Yi", "Zi"]);
            let white = triple(&row, ["Xmax", "Ymax", "Zmax"]);
            let expected = triple(&row, ["out1", "out2", "out3"]);
            let denormal = white[1] < f64::MIN_POSITIVE;
            let tolerance = if denormal { 1e-11 } else { 1e-12 };
            assert_near(adapted(xyz, white, 1.0), expected, tolerance, case);
            if !denormal {
                let matrix = von_kries(white, 1.0);
                assert_near(matrix * DVec3::from_array(xyz), expected, tolerance, case);
            }
            compared += 1;
        }
        assert_eq!(compared, 20);
    }

    #[test]
    fn the_inverse_matrix_agrees_with_fifty_digit_arithmetic() {
        let inverse = matrix_from_rows(LMS_FROM_XYZ).inverse();
        let mut compared = 0;
        for row in Table::parse(ADAPTATION_CSV).rows() {
            let Some(index) = row.text("case").strip_prefix("matrix_inverse_row") else {
                continue;
            };
            let expected = DVec3::from_array(triple(&row, ["out1", "out2", "out3"]));
            let error = (inverse.row(index.parse().unwrap()) - expected).abs();
            assert!(error.max_element() < 1e-15);
            compared += 1;
        }
        assert_eq!(compared, 3);
    }

    #[test]
    fn naka_rushton_agrees_with_fifty_digit_arithmetic() {
        let mut compared = 0;
        for row in Table::parse(ADAPTATION_CSV).rows() {
            let Some(case) = row.text("case").strip_prefix("naka_rushton L=") else {
                continue;
            };
            let (luminance, tau) = case.split_once(" tau=").unwrap();
            let got = naka_rushton(luminance.parse().unwrap(), tau.parse().unwrap());
            let expected = row.number("out1");
            let floor = f64::MIN_POSITIVE;
            assert!((got - expected).abs() <= 1e-15 * expected + floor, "{case}");
            compared += 1;
        }
        assert_eq!(compared, 66, "with the others, every row of the file");
    }

    #[test]
    fn case_61_an_all_black_picture_stays_black() {
        for degree in [0.5, 1.0] {
            assert_eq!(adapted([0.0; 3], [0.0; 3], degree), DVec3::ZERO);
            assert_eq!(von_kries([0.0; 3], degree), DMat3::ZERO);
            assert_eq!(adapted(WHITE, [f64::NAN; 3], degree), DVec3::ZERO);
        }
    }

    #[test]
    fn case_62_a_white_without_blue_amplifies_blue_a_hundredfold_at_most() {
        // 800 K: the response of the blue cone is 1.4e-3 of that of the red one.
        let white = [
            2.3753457484668861e-07,
            1.1084089268425428e-07,
            2.5601004278268411e-10,
        ];
        let noise = [0.0, 0.0, 1e-12];
        let lms = matrix_from_rows(LMS_FROM_XYZ) * DVec3::from_array(white);
        let seen = matrix_from_rows(LMS_FROM_XYZ) * adapted(noise, white, 1.0);
        let limit = 0.9182e-12 / (SMALLEST_RESPONSE * lms.x);
        assert!((seen.z / limit - 1.0).abs() < 1e-12, "{seen}");
    }

    #[test]
    fn case_63_the_white_lands_on_the_display_white() {
        let display_white = [0.9504848375, 1.000020104, 1.089087345];
        assert_near(adapted(WHITE, WHITE, 1.0), display_white, 1e-9, "white");
        assert_near(
            von_kries(WHITE, 1.0) * DVec3::from_array(WHITE),
            display_white,
            1e-9,
            "white",
        );
    }

    #[test]
    fn case_64_negative_responses_pass_through_to_be_clamped_after() {
        let out = adapted([1.0, 0.0, 0.0], WHITE, 1.0);
        let lms = matrix_from_rows(LMS_FROM_XYZ) * out;
        assert!(lms.y < 0.0 && out.is_finite());
    }

    #[test]
    fn case_65_naka_rushton_has_its_limits() {
        assert_eq!(naka_rushton(0.0, 0.0), 0.0);
        assert_eq!(naka_rushton(1.0, 0.0), 1.0);
        assert_eq!(naka_rushton(f64::INFINITY, 1.0), 1.0);
        assert_eq!(naka_rushton(1e308, 1e308), 0.5);
        assert_eq!(naka_rushton(f64::NAN, 1.0), 0.0);
        assert_eq!(naka_rushton(-1.0, 0.5), 0.0);
    }

    #[test]
    fn no_adaptation_is_the_identity() {
        assert!(von_kries(WHITE, 0.0).abs_diff_eq(DMat3::IDENTITY, 1e-15));
        assert!(von_kries([0.0; 3], 0.0).abs_diff_eq(DMat3::IDENTITY, 1e-15));
    }

    proptest! {
        #[test]
        fn case_69_adaptation_does_not_know_the_scale(
            exponent in -300.0..290.0_f64, x in 0.1..1.0_f64, y in 0.1..1.0_f64, z in 0.1..1.0_f64,
        ) {
            let scale = 10.0_f64.powf(exponent);
            let plain = adapted([x, y, z], WHITE, 1.0);
            let scaled = adapted([x, y, z].map(|v| v * scale), WHITE.map(|v| v * scale), 1.0);
            prop_assert!((scaled - plain).abs().max_element() < 1e-12 * plain.abs().max_element());
        }

        #[test]
        fn the_degree_leads_steadily_from_none_to_all(degree in 0.0..0.99_f64) {
            let seen = |d| adapted(WHITE, WHITE, d).z / adapted(WHITE, WHITE, d).y;
            prop_assert!(seen(degree + 0.01) > seen(degree));
        }
    }
}
