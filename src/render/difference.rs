//! How different two pictures of one scene look.
//!
//! In ΔE_ITP ([`crate::colour::itp`]) of X, Y, Z at the exposure that brings the reference's 99th percentile of lit pixels to
//! 203 cd m⁻², diffuse white of ITU-R BT.2408; without curve or adaptation, so that it does not depend on the view. Lit is
//! what is brighter than a ten-thousandth of the reference's peak, in one of the two.

use crate::colour::itp;

/// Luminance that the 99th percentile of lit pixels is shown with, cd m⁻².
pub const WHITE_CD_M2: f64 = 203.0;
/// Share of the peak from which on a pixel is lit.
pub const LIT: f64 = 1e-4;

/// How different two pictures look, over their lit pixels, ΔE_ITP.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Difference {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Largest.
    pub largest: f64,
    /// Lit pixels.
    pub lit: usize,
}

/// Exposure at which pictures of a scene are compared, by the X, Y, Z of one of them: cd m⁻² for a unit of Y. `None` where
/// nothing is lit.
pub fn exposure(pixels: &[[f64; 3]]) -> Option<f64> {
    let peak = peak(pixels);
    let mut lit: Vec<f64> = pixels
        .iter()
        .map(|xyz| xyz[1])
        .filter(|&y| y > LIT * peak)
        .collect();
    let bright = percentile(&mut lit, 0.99)?;
    Some(WHITE_CD_M2 / bright)
}

/// The difference of a picture from a reference of the same scene and size, in X, Y, Z.
pub fn difference(reference: &[[f64; 3]], other: &[[f64; 3]]) -> Difference {
    difference_seen(reference, reference, other)
}

/// The same between two pictures at the exposure of a third.
pub fn difference_seen(
    exposed: &[[f64; 3]],
    reference: &[[f64; 3]],
    other: &[[f64; 3]],
) -> Difference {
    let Some(exposure) = exposure(exposed) else {
        return Difference::default();
    };
    let darkest = LIT * peak(exposed);
    let mut apart: Vec<f64> = reference
        .iter()
        .zip(other)
        .filter(|(one, other)| one[1].max(other[1]) > darkest)
        .map(|(one, other)| {
            itp::delta_e(
                one.map(|value| exposure * value),
                other.map(|value| exposure * value),
            )
        })
        .collect();
    let mean = apart.iter().sum::<f64>() / apart.len().max(1) as f64;
    let [p95, p99, largest] =
        [0.95, 0.99, 1.0].map(|share| percentile(&mut apart, share).unwrap_or(0.0));
    Difference {
        mean,
        p95,
        p99,
        largest,
        lit: apart.len(),
    }
}

fn peak(pixels: &[[f64; 3]]) -> f64 {
    pixels.iter().map(|xyz| xyz[1]).fold(0.0, f64::max)
}

/// The value that this share of all values do not exceed.
fn percentile(values: &mut [f64], share: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let index = (share * last as f64).ceil() as usize;
    let (_, value, _) = values.select_nth_unstable_by(index, f64::total_cmp);
    Some(*value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brighter_picture_differs_by_its_brightness_and_the_dark_does_not_count() {
        let mut reference = vec![[0.95, 1.0, 1.09]; 99];
        // Far below the peak: not lit in either.
        reference.push([0.0, 5e-5, 0.0]);
        let mut other: Vec<[f64; 3]> = reference.iter().map(|xyz| xyz.map(|v| 1.01 * v)).collect();
        other[99] = [0.0; 3];
        let found = difference(&reference, &other);
        assert_eq!(found.lit, 99);
        assert!((found.mean - 0.749).abs() < 0.001, "{found:?}");
        assert!((found.p99 - found.largest).abs() < 1e-9);
        // Whatever the units of light.
        let scaled = |pixels: &[[f64; 3]]| -> Vec<[f64; 3]> {
            pixels.iter().map(|xyz| xyz.map(|v| 1e-7 * v)).collect()
        };
        let again = difference(&scaled(&reference), &scaled(&other));
        assert!((again.mean - found.mean).abs() < 1e-9);
    }

    #[test]
    fn percentiles_are_of_the_pixels_that_differ_most() {
        let reference = vec![[0.95, 1.0, 1.09]; 1000];
        let mut other = reference.clone();
        for xyz in &mut other[..30] {
            *xyz = xyz.map(|v| 1.1 * v);
        }
        let found = difference(&reference, &other);
        assert_eq!(found.p95, 0.0);
        assert!(found.p99 > 5.0 && found.p99 == found.largest, "{found:?}");
    }

    #[test]
    fn what_is_dark_is_not_compared() {
        let dark = vec![[0.0; 3]; 4];
        assert_eq!(difference(&dark, &dark), Difference::default());
        assert_eq!(exposure(&dark), None);
        assert_eq!(difference(&[], &[]), Difference::default());
    }
}
