//! From a colour to a reflectance spectrum.
//!
//! ```text
//! ρ(λ) = c₁ w_r(λ) + c₂ w_g(λ) + c₃ w_b(λ),   w_r + w_g + w_b = 1
//! w_b = 1 − s(λ; 490, 60),   w_r = s(λ; 590, 60),   s from 0 to 1 over a width around a border
//! c = A⁻¹ rgb, each held to 0 … 1,   A: linear Rec. 709 of the three lobes under D65
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | ρ | diffuse reflectance | 1 |
//! | w | lobes | 1 |
//! | λ | wavelength, borders and widths of the lobes | nm |
//! | rgb | diffuse albedo under D65, linear Rec. 709, each 0 to 1 | 1 |
//!
//! Many spectra have one colour; this is a smooth one, between 0 and 1 everywhere, so no surface gives back more light than
//! falls on it, and flat where the colour is grey. The borders are those with which A is nearest to the unit matrix.
//!
//! **Validity.** 360 to 830 nm. Under D65 and the standard observer the colour comes back within 0.2 % of its largest
//! channel where c needs no holding. Nearly pure colours need it: one whose smallest channel is below 2 % of the largest,
//! or a bright one such as a cyan of 0.02, 1, 0.95. They are off by up to that of the pure primaries, 1 % of white (tests
//! say so).
//!
//! **Source.** Own choice of lobes; the idea of a basis that sums to one is that of B. Smits, J. Graphics Tools 4(4) (1999)
//! 11, and I. Mallett and C. Yuksel, EGSR 2019.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::{cie, xyz};

/// Borders between blue and green and between green and red, nm.
const BORDERS_NM: [f64; 2] = [490.0, 590.0];
/// Width of the change from one lobe to the next, nm.
const CHANGE_NM: f64 = 60.0;

/// A⁻¹: how much of each lobe a colour of linear Rec. 709 has.
static LOBES_FROM_RGB: LazyLock<DMat3> = LazyLock::new(|| lobes_under_d65().inverse());

/// A diffuse reflectance spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflectance {
    /// What is white in the colour, and what of red, green and blue lobes lies over it.
    grey: f64,
    lobes: DVec3,
}

impl Reflectance {
    /// The reflectance of a colour: diffuse albedo in linear Rec. 709, held to 0 … 1.
    pub fn of(colour: [f64; 3]) -> Self {
        let rgb = DVec3::from(colour).clamp(DVec3::ZERO, DVec3::ONE);
        let grey = rgb.min_element();
        let lobes = *LOBES_FROM_RGB * (rgb - grey);
        Self {
            grey,
            lobes: lobes.clamp(DVec3::splat(-grey), DVec3::splat(1.0 - grey)),
        }
    }

    /// Share of light of a wavelength (nm) that is sent back, 0 to 1.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        (self.grey + self.lobes.dot(lobes(lambda_nm))).clamp(0.0, 1.0)
    }
}

/// The red, green and blue lobe at a wavelength; they sum to 1.
fn lobes(lambda_nm: f64) -> DVec3 {
    let [green, red] = BORDERS_NM.map(|border_nm| {
        let t = ((lambda_nm - border_nm) / CHANGE_NM + 0.5).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    });
    DVec3::new(red, green - red, 1.0 - green)
}

/// A: linear Rec. 709 of each lobe under D65; a flat spectrum gives 1, 1, 1.
fn lobes_under_d65() -> DMat3 {
    let mut lit = DMat3::ZERO;
    for nm in cie::OBSERVER_FIRST_NM as i32..=cie::OBSERVER_LAST_NM as i32 {
        let nm = f64::from(nm);
        let light = cie::d65(nm) * DVec3::from(cie::colour_matching(nm));
        let lobes = lobes(nm);
        lit += DMat3::from_cols(light * lobes.x, light * lobes.y, light * lobes.z);
    }
    let rgb = xyz::rgb_from_xyz() * lit;
    // The table's white and the matrix's differ in the fourth digit: white is what all lobes give together.
    let white = rgb * DVec3::ONE;
    DMat3::from_diagonal(white.recip()) * rgb
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Linear Rec. 709 of a reflectance under D65, by sums of its own.
    fn under_d65(reflectance: &Reflectance) -> DVec3 {
        let (mut seen, mut white) = (DVec3::ZERO, DVec3::ZERO);
        for half_nm in 720..=1660 {
            let nm = 0.5 * f64::from(half_nm);
            let light = cie::d65(nm) * DVec3::from(cie::colour_matching(nm));
            seen += reflectance.at(nm) * light;
            white += light;
        }
        let to_rgb = xyz::rgb_from_xyz();
        (to_rgb * seen) / (to_rgb * white)
    }

    #[test]
    fn pure_colours_come_back_within_one_per_cent_of_white() {
        let mut worst = 0.0_f64;
        for corner in 0..8 {
            let colour = [0, 1, 2].map(|c| f64::from(corner >> c & 1));
            let off = under_d65(&Reflectance::of(colour)) - DVec3::from(colour);
            worst = worst.max(off.abs().max_element());
        }
        assert!(worst < 0.0105, "{worst}");
    }

    proptest! {
        #[test]
        fn colours_that_are_not_pure_come_back(
            top in 0.05..1.0_f64,
            shares in prop::array::uniform2(0.02..1.0_f64),
            largest in 0..3_usize,
        ) {
            let mut colour = [top * shares[0], top * shares[1], top];
            colour.rotate_left(largest);
            let reflectance = Reflectance::of(colour);
            let off = under_d65(&reflectance) - DVec3::from(colour);
            let free = *LOBES_FROM_RGB * (DVec3::from(colour) - reflectance.grey);
            // What is held to 0 … 1 is off by no more than the pure colours are.
            let bound = if free == reflectance.lobes { 2e-3 * top } else { 0.0105 };
            prop_assert!(off.abs().max_element() < bound, "{colour:?}: {off}");
        }

        #[test]
        fn it_is_bounded_smooth_and_flat_for_grey(
            colour in prop::array::uniform3(-0.2..1.2_f64),
            nm in 300.0..900.0_f64,
        ) {
            let reflectance = Reflectance::of(colour);
            let here = reflectance.at(nm);
            prop_assert!((0.0..=1.0).contains(&here));
            // The steepest slope of a smooth step is 3/2 over its width.
            prop_assert!((reflectance.at(nm + 0.01) - here).abs() < 0.01 * 1.6 / CHANGE_NM * 2.0);
            let grey = colour[0].clamp(0.0, 1.0);
            prop_assert_eq!(Reflectance::of([colour[0]; 3]).at(nm), grey);
        }
    }
}
