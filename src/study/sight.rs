//! How far parts of pictures are from a reference, in what an eye sees and in plain numbers.
//!
//! ΔE_ITP as [`crate::render::difference`] defines it, of pixels of which each stands for several. A difference is kept as a
//! vector of I, T and P: small ones of several causes add up, pixel by pixel, so that the error of any choice of numbers is
//! known from a few.

use crate::colour::itp;
use crate::render::difference::{LIT, WHITE_CD_M2};

/// ΔE_ITP of a vector of I, T, P that is 1 long.
const FOR_EACH_UNIT: f64 = 720.0;

/// How far a picture is from the reference.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Error {
    /// 95th percentile of ΔE_ITP over lit pixels.
    pub de95: f64,
    /// Its mean.
    pub de_mean: f64,
    /// Root mean square difference of luminance, over the root mean square luminance.
    pub rel_y: f64,
    /// The same of X, Y and Z together.
    pub rel_xyz: f64,
}

impl Error {
    /// The same, and nothing below what the reference itself is off by.
    #[must_use]
    pub fn at_least(self, own: Self) -> Self {
        Self {
            de95: self.de95.max(own.de95),
            de_mean: self.de_mean.max(own.de_mean),
            rel_y: self.rel_y.max(own.rel_y),
            rel_xyz: self.rel_xyz.max(own.rel_xyz),
        }
    }

    /// Of causes that know nothing of one another: root of the sum of squares.
    #[must_use]
    pub fn beside(self, other: Self) -> Self {
        Self {
            de95: self.de95.hypot(other.de95),
            de_mean: self.de_mean.hypot(other.de_mean),
            rel_y: self.rel_y.hypot(other.rel_y),
            rel_xyz: self.rel_xyz.hypot(other.rel_xyz),
        }
    }

    /// A share of it.
    #[must_use]
    pub fn scaled(self, share: f64) -> Self {
        Self {
            de95: share * self.de95,
            de_mean: share * self.de_mean,
            rel_y: share * self.rel_y,
            rel_xyz: share * self.rel_xyz,
        }
    }
}

/// X, Y, Z of each pixel, W m⁻² sr⁻¹.
pub(super) type Picture = Vec<[f64; 3]>;

/// The eye that compares: how it is exposed, what it takes for dark, and how much each pixel counts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sight {
    /// cd m⁻² for a unit of Y.
    exposure: f64,
    /// Y of what is not lit.
    darkest: f64,
    weights: Vec<f64>,
}

impl Sight {
    /// Exposed for a picture; `None` if that is dark.
    pub(super) fn of(picture: &[[f64; 3]], weights: Vec<f64>) -> Option<Self> {
        let peak = picture.iter().map(|xyz| xyz[1]).fold(0.0, f64::max);
        let darkest = LIT * peak;
        let lit = picture.iter().zip(&weights);
        let lit = lit.filter(|(xyz, _)| xyz[1] > darkest);
        let lit: Vec<(f64, f64)> = lit.map(|(xyz, weight)| (xyz[1], *weight)).collect();
        let bright = percentile(lit, 0.99)?;
        (bright > 0.0).then(|| Self {
            exposure: WHITE_CD_M2 / bright,
            darkest,
            weights,
        })
    }

    /// I, T, P of every pixel.
    pub(super) fn seen(&self, picture: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let shown = |xyz: &[f64; 3]| itp::itp(xyz.map(|value| self.exposure * value));
        picture.iter().map(shown).collect()
    }

    /// By which vector each pixel of a picture looks different from another.
    pub(super) fn shift(&self, from: &[[f64; 3]], to: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (from, to) = (self.seen(from), self.seen(to));
        let pixels = from.iter().zip(&to);
        pixels
            .map(|(from, to)| std::array::from_fn(|c| to[c] - from[c]))
            .collect()
    }

    /// How different two colours look, ΔE_ITP.
    pub(super) fn apart(&self, one: [f64; 3], other: [f64; 3]) -> f64 {
        let [one, other] = [one, other].map(|xyz| xyz.map(|value| self.exposure * value));
        itp::delta_e(one, other)
    }

    /// Which pixels are lit in at least one of these pictures.
    pub(super) fn lit(&self, pictures: &[&[[f64; 3]]]) -> Vec<bool> {
        let lit = |i: usize| pictures.iter().any(|picture| picture[i][1] > self.darkest);
        (0..self.weights.len()).map(lit).collect()
    }

    /// For how many pixels those stand that are lit in a picture.
    pub(super) fn lit_weight(&self, picture: &[[f64; 3]]) -> f64 {
        let pixels = picture.iter().zip(&self.weights);
        let lit = pixels.filter(|(xyz, _)| xyz[1] > self.darkest);
        lit.map(|(_, weight)| weight).sum()
    }

    /// 95th percentile and mean of ΔE_ITP over lit pixels that look different by the sum of these vectors.
    pub(super) fn delta_e(&self, lit: &[bool], shifts: &[&[[f64; 3]]]) -> [f64; 2] {
        let apart = |i: usize| {
            let sum: [f64; 3] =
                std::array::from_fn(|c| shifts.iter().map(|shift| shift[i][c]).sum());
            FOR_EACH_UNIT * sum.iter().map(|v| v * v).sum::<f64>().sqrt()
        };
        let pixels = (0..lit.len()).filter(|&i| lit[i]);
        let all: Vec<(f64, f64)> = pixels.map(|i| (apart(i), self.weights[i])).collect();
        let weight: f64 = all.iter().map(|(_, weight)| weight).sum();
        let sum: f64 = all.iter().map(|(apart, weight)| apart * weight).sum();
        let mean = if weight > 0.0 { sum / weight } else { 0.0 };
        [percentile(all, 0.95).unwrap_or(0.0), mean]
    }

    /// How far a picture is from a reference.
    pub(super) fn error(&self, reference: &[[f64; 3]], other: &[[f64; 3]]) -> Error {
        let lit = self.lit(&[reference, other]);
        let [de95, de_mean] = self.delta_e(&lit, &[&self.shift(reference, other)]);
        let relative = |channels: std::ops::Range<usize>| {
            let [mut off, mut all] = [0.0; 2];
            for ((one, other), weight) in reference.iter().zip(other).zip(&self.weights) {
                for c in channels.clone() {
                    off += weight * (other[c] - one[c]).powi(2);
                    all += weight * one[c].powi(2);
                }
            }
            (off / all).sqrt()
        };
        Error {
            de95,
            de_mean,
            rel_y: relative(1..2),
            rel_xyz: relative(0..3),
        }
    }
}

/// The value that this share of all weight does not exceed; each value with its weight.
fn percentile(mut values: Vec<(f64, f64)>, share: f64) -> Option<f64> {
    values.sort_by(|one, other| one.0.total_cmp(&other.0));
    let all: f64 = values.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    for (value, weight) in &values {
        below += weight;
        if below >= share * all {
            return Some(*value);
        }
    }
    values.last().map(|(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::difference::difference;

    fn pictures() -> [Picture; 2] {
        let one: Picture = (0..400)
            .map(|i| [0.9, 1.0, 0.5].map(|v| v * (0.05 + f64::from(i) / 300.0)))
            .collect();
        let other = one.iter().enumerate();
        let other = other
            .map(|(i, xyz)| xyz.map(|v| v * (1.0 + 1e-4 * i as f64)))
            .collect();
        [one, other]
    }

    #[test]
    fn pixels_of_one_weight_differ_as_whole_pictures_do() {
        let [one, other] = pictures();
        let sight = Sight::of(&one, vec![3.0; 400]);
        let found = sight
            .map(|sight| sight.error(&one, &other))
            .unwrap_or_default();
        // The two take percentiles of neighbouring pixels, and so expose a 400th differently.
        let expected = difference(&one, &other);
        assert!(
            (found.de_mean / expected.mean - 1.0).abs() < 1e-3,
            "{found:?} {expected:?}"
        );
        assert!(
            (found.de95 / expected.p95 - 1.0).abs() < 0.01,
            "{found:?} {expected:?}"
        );
        // Luminance alone is scaled here: all channels are off alike.
        assert!((found.rel_y / found.rel_xyz - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_pixel_that_stands_for_many_counts_as_many() {
        let values = |heavy: f64| vec![(1.0, heavy), (2.0, 1.0), (3.0, 1.0)];
        assert_eq!(percentile(values(1.0), 0.5), Some(2.0));
        assert_eq!(percentile(values(8.0), 0.5), Some(1.0));
        assert_eq!(percentile(Vec::new(), 0.5), None);

        // One of ten pixels is off and stands for 31 of 40.
        let one: Picture = vec![[95.0, 100.0, 108.0]; 10];
        let mut other = one.clone();
        other[3][1] *= 1.1;
        let off = |heavy: f64| {
            let weights = (0..10).map(|i| if i == 3 { heavy } else { 1.0 });
            let sight = Sight::of(&one, weights.collect());
            sight.map(|sight| sight.error(&one, &other).de_mean)
        };
        let [alike, heavy] = [1.0, 31.0].map(|weight| off(weight).unwrap_or_default());
        assert!((heavy / alike - 7.75).abs() < 1e-9, "{heavy} {alike}");
    }

    #[test]
    fn small_shifts_of_two_causes_add_up() {
        let [one, other] = pictures();
        let third: Picture = one.iter().map(|[x, y, z]| [*x, *y, 1.002 * z]).collect();
        let both: Picture = one
            .iter()
            .zip(&other)
            .zip(&third)
            .map(|((a, b), c)| std::array::from_fn(|i| b[i] + c[i] - a[i]))
            .collect();
        let found = Sight::of(&one, vec![1.0; 400]).map(|sight| {
            let lit = sight.lit(&[&one]);
            let shifts = [&other, &third].map(|to| sight.shift(&one, to));
            let apart = sight.delta_e(&lit, &[&shifts[0], &shifts[1]]);
            (apart, sight.error(&one, &both))
        });
        let ([de95, de_mean], expected) = found.unwrap_or_default();
        // What is neglected is of the second order: a per cent of a change by a per cent or two.
        assert!(expected.de95 > 0.5);
        assert!(
            (de95 / expected.de95 - 1.0).abs() < 0.02,
            "{de95} {expected:?}"
        );
        assert!(
            (de_mean / expected.de_mean - 1.0).abs() < 0.02,
            "{de_mean} {expected:?}"
        );
    }
}
