//! Colour differences that can be seen: ΔE_ITP.
//!
//! ```text
//! LMS = M₁ RGB,   RGB linear Rec. 2020 in cd m⁻²
//! v′ = ((c₁ + c₂ u)/(1 + c₃ u))^{m₂},   u = (v/10 000)^{m₁}          for each of L, M, S
//! I = (L′ + M′)/2
//! T = (6610 L′ − 13613 M′ + 7003 S′)/8192
//! P = (17933 L′ − 17390 M′ − 543 S′)/4096
//! ΔE = 720 √(ΔI² + ΔT² + ΔP²)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | L, M, S | what the eye's cones take, mixed as for hue that stays | cd m⁻² |
//! | ′ | perceptual quantiser | 1 |
//! | I, T, P | intensity, and differences blue–yellow and red–green | 1 |
//! | ΔE | 1 is a difference that is just seen by an eye adapted to these very colours | 1 |
//!
//! **Validity.** For 0 to 10 000 cd m⁻²; above, the quantiser is continued by its own formula. Spectral violet lies outside
//! of Rec. 2020 and may make a cone's share negative: that counts as 0. Against the sRGB primaries' matrix, a white of
//! x = 0.3127, y = 0.3290 has T = P = 0.
//!
//! **Source.** ITU-R BT.2124-0 (2019), Annex 1, with ICtCp of ITU-R BT.2100-2 (2018), Tables 4 and 7, and the primaries of
//! ITU-R BT.2020-2 (2015).

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::xyz::{WHITE_XY, matrix_from_rows, xyz_from_primaries};

/// Chromaticities of the primaries of Rec. 2020.
const PRIMARIES_XY: [[f64; 2]; 3] = [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]];

/// LMS of linear Rec. 2020, times 4096.
const LMS_FROM_RGB: [[f64; 3]; 3] = [
    [1688.0, 2146.0, 262.0],
    [683.0, 2951.0, 462.0],
    [99.0, 309.0, 3688.0],
];

/// The perceptual quantiser's constants.
const M1: f64 = 2610.0 / 16384.0;
const M2: f64 = 2523.0 / 4096.0 * 128.0;
const C1: f64 = 3424.0 / 4096.0;
const C2: f64 = 2413.0 / 4096.0 * 32.0;
const C3: f64 = 2392.0 / 4096.0 * 32.0;
const PEAK_CD_M2: f64 = 10_000.0;

/// A just visible difference in units of I, T, P.
const VISIBLE: f64 = 720.0;

static LMS_FROM_XYZ: LazyLock<DMat3> = LazyLock::new(|| {
    let rgb_from_xyz = xyz_from_primaries(PRIMARIES_XY, WHITE_XY).inverse();
    matrix_from_rows(LMS_FROM_RGB) * (1.0 / 4096.0) * rgb_from_xyz
});

/// I, T, P of X, Y, Z in cd m⁻².
pub fn itp([x, y, z]: [f64; 3]) -> [f64; 3] {
    let lms = *LMS_FROM_XYZ * DVec3::new(x, y, z);
    let [l, m, s] = lms.to_array().map(quantised);
    [
        0.5 * (l + m),
        (6610.0 * l - 13613.0 * m + 7003.0 * s) / 8192.0,
        (17933.0 * l - 17390.0 * m - 543.0 * s) / 4096.0,
    ]
}

/// ΔE_ITP of two colours, X, Y, Z in cd m⁻².
pub fn delta_e(one: [f64; 3], other: [f64; 3]) -> f64 {
    let (one, other) = (itp(one), itp(other));
    let squares = (0..3).map(|c| (one[c] - other[c]).powi(2));
    VISIBLE * squares.sum::<f64>().sqrt()
}

/// The perceptual quantiser: 0 to 1 for 0 to 10 000 cd m⁻².
fn quantised(cd_m2: f64) -> f64 {
    let u = (cd_m2.max(0.0) / PEAK_CD_M2).powf(M1);
    ((C1 + C2 * u) / (1.0 + C3 * u)).powf(M2)
}

#[cfg(test)]
mod tests {
    use super::super::xyz::{srgb_decode, xyz_from_rgb};
    use super::*;

    /// White of a diffuse surface, cd m⁻²: ITU-R BT.2408.
    const WHITE_CD_M2: f64 = 203.0;

    fn of_srgb(code: [u32; 3]) -> [f64; 3] {
        let linear = code.map(|code| f64::from(srgb_decode(code as f32 / 255.0)));
        (WHITE_CD_M2 * xyz_from_rgb() * DVec3::from(linear)).to_array()
    }

    #[test]
    fn the_quantiser_has_the_standards_values() {
        // BT.2100: 10 000 cd m⁻² is 1; SMPTE ST 2084 prints 0.508078 for 100 cd m⁻², BT.2408 58 % for 203 and 75 % for 1000.
        for (cd_m2, expected, digits) in [
            (10_000.0, 1.0, 1e-12),
            (100.0, 0.508_078, 1e-6),
            (203.0, 0.58, 1e-3),
            (1000.0, 0.75, 2e-3),
            (0.0, 0.0, 1e-6),
        ] {
            let found = quantised(cd_m2);
            assert!((found - expected).abs() < digits, "{cd_m2}: {found}");
        }
    }

    #[test]
    fn the_difference_is_that_of_a_public_implementation() {
        // coloraide's tests (F. Jaquerod, I. Muse), CSS colours on a white of 203 cd m⁻², to their four digits.
        let [red, white, black, grey, indigo] = [
            [255, 0, 0],
            [255, 255, 255],
            [0, 0, 0],
            [128, 128, 128],
            [75, 0, 130],
        ]
        .map(of_srgb);
        for (colour, expected) in [
            (white, 232.6248),
            (black, 370.0251),
            (grey, 204.962),
            (indigo, 260.892),
        ] {
            let found = delta_e(colour, red);
            assert!((found - expected).abs() < 2e-2, "{found}, not {expected}");
        }
    }

    #[test]
    fn the_formula_gives_the_worked_example() {
        // The pair of ICtCp that colour-science documents for BT.2124: 1.42657228.
        let one = [0.4885468072, 0.5 * -0.04739350675, 0.07475401302];
        let other = [0.4899203231, 0.5 * -0.04567508203, 0.07361341775];
        let squares: f64 = (0..3).map(|c| f64::powi(one[c] - other[c], 2)).sum();
        assert!((VISIBLE * squares.sqrt() - 1.426_572_28).abs() < 1e-7);
    }

    #[test]
    fn greys_have_no_colour_and_a_per_cent_is_three_quarters_of_a_step() {
        let white = of_srgb([255; 3]);
        let [_, t, p] = itp(white);
        assert!(t.abs() < 1e-4 && p.abs() < 1e-4, "{t} {p}");
        let brighter = white.map(|v| 1.01 * v);
        let found = delta_e(white, brighter);
        assert!((found - 0.749).abs() < 0.001, "{found}");
        assert_eq!(delta_e(white, white), 0.0);
    }
}
