//! Less colour at the same hue: what a display cannot show is brought nearer to grey, and an eye still calls it by the
//! same name.
//!
//! ```text
//! q = ∛(M rgb),   L = w · q,   d = q − L (1, 1, 1)
//! rgb(k) = M⁻¹ (L + k d)³                  k = 1: the colour, k = 0: grey of the same lightness
//! P(k) = ε + Σ_j c_j (L + k d_j)³ ≥ 0      a bound of the display, a cubic in k
//! kept = r (t + (1 − t) a/(a + (1 − t) r)),   a = 1 − t r,   r = the root of P, at most 1/t
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | rgb | linear Rec. 709 light, of any scale | 1 |
//! | M, q | rgb to the receptors of Oklab, and their compressed responses | 1 |
//! | w, L | Oklab's weights, which sum to 1, and lightness | 1 |
//! | d, k | the colour apart from grey, and how much of it is kept | 1 |
//! | c, ε | a bound: weights of the receptors, and how far outside is let be | 1 |
//! | r, t | how far the bound is reached, and from which share of that on colour gives way | 1 |
//!
//! In Oklab the lines of one hue are straight and go through grey, so the factor k leaves hue and lightness alone. A
//! scale of rgb does too, since the cube root only scales L and d. So a colour is dimmed by a factor and paled by k, and
//! its hue stays exactly. Along k, a bound of the display is a cubic with P(0) > 0; its root is found by halving and a
//! last chord. The kept share has no kink: it is 1 where the colour lies well inside, and approaches the root.
//!
//! **Validity.** Light that an eye can see. The response of a receptor counts for a hundredth of the largest one at
//! least, below which no visible light comes: a negative one is no colour, and has no root.
//!
//! **Source.** B. Ottosson, *A perceptual color space for image processing* (2020), for Oklab; the bound as a cubic and
//! the kept share are our own.

use glam::{DMat3, DVec3};

use super::xyz::{LUMINANCE, matrix_from_rows, xyz_from_rgb};

/// XYZ to the receptors of Oklab.
const RECEPTORS_FROM_XYZ: [[f64; 3]; 3] = [
    [0.8189330101, 0.3618667424, -0.1288597137],
    [0.0329845436, 0.9293118715, 0.0361456387],
    [0.0482003018, 0.2643662691, 0.6338517070],
];
/// Weights of the compressed responses in Oklab's lightness.
const LIGHTNESS: [f64; 3] = [0.2104542553, 0.7936177850, -0.0040720468];
/// No receptor counts for less than this fraction of the largest.
const SMALLEST_RESPONSE: f32 = 0.01;
/// Halvings of the interval of k before the last chord.
const HALVINGS: u32 = 10;

/// Oklab as seen from linear Rec. 709, as numbers for a pixel and for a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct HueSpace {
    /// Rows of the matrix to the receptors' responses.
    pub receptors_from_rgb: [[f32; 3]; 3],
    /// Rows of the matrix back.
    pub rgb_from_receptors: [[f32; 3]; 3],
    /// Weights of the compressed responses in the lightness.
    pub lightness: [f32; 3],
}

/// A colour as lightness and what sets it apart from grey.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    lightness: f32,
    /// The compressed responses less the lightness.
    colour: [f32; 3],
}

impl HueSpace {
    /// Oklab, with grey exactly grey: the published matrices miss that in the fourth digit.
    pub(super) fn new() -> Self {
        let raw = matrix_from_rows(RECEPTORS_FROM_XYZ) * xyz_from_rgb();
        // Receptors that respond to white alike.
        let there = DMat3::from_diagonal(1.0 / (raw * DVec3::ONE)) * raw;
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).as_vec3().to_array());
        Self {
            receptors_from_rgb: rows(there),
            rgb_from_receptors: rows(there.inverse()),
            lightness: LIGHTNESS.map(|weight| weight as f32),
        }
    }

    /// Takes a colour apart, whose largest channel should be near 1. `None` for what no eye can see.
    pub(super) fn apart(&self, rgb: [f32; 3]) -> Option<Apart> {
        let response = self.receptors_from_rgb.map(|row| dot(row, rgb));
        let largest = response[0].max(response[1]).max(response[2]);
        if largest <= 0.0 {
            return None;
        }
        let compressed = response.map(|r| r.max(SMALLEST_RESPONSE * largest).cbrt());
        let lightness = dot(self.lightness, compressed);
        Some(Apart {
            lightness,
            colour: compressed.map(|q| q - lightness),
        })
    }

    /// Bounds that keep every channel at 1 or below when the colour is scaled to a luminance ≤ 1.
    pub(super) fn below_full(&self, luminance: f32) -> [[f32; 3]; 3] {
        let rows = self.rgb_from_receptors;
        let of_luminance = [0, 1, 2].map(|j| dot(LUMINANCE, rows.map(|row| row[j])));
        rows.map(|row| [0, 1, 2].map(|j| of_luminance[j] - luminance * row[j]))
    }

    /// The colour of what was taken apart.
    pub(super) fn rgb(&self, Apart { lightness, colour }: Apart) -> [f32; 3] {
        let response = colour.map(|d| {
            let q = lightness + d;
            q * q * q
        });
        self.rgb_from_receptors.map(|row| dot(row, response))
    }
}

impl Apart {
    /// The same with a share of its colour, 0..=1.
    pub(super) fn paled(self, kept: f32) -> Self {
        Self {
            colour: self.colour.map(|d| kept * d),
            ..self
        }
    }

    /// The share of colour that keeps all bounds; each gives the receptors' weights c. Precondition: grey keeps them.
    pub(super) fn kept(&self, bounds: [[f32; 3]; 3], outside: f32, start: f32) -> f32 {
        let furthest = 1.0 / start;
        let reach = bounds
            .map(|bound| self.reach(bound, outside, furthest))
            .into_iter()
            .fold(furthest, f32::min);
        if reach >= furthest {
            return 1.0;
        }
        let left = 1.0 - start * reach;
        reach * (start + (1.0 - start) * left / (left + (1.0 - start) * reach))
    }

    /// The k up to `furthest` at which a bound is met.
    fn reach(&self, bound: [f32; 3], outside: f32, furthest: f32) -> f32 {
        let l = self.lightness;
        let moment = |power: i32| {
            let terms = [0, 1, 2].map(|j| bound[j] * self.colour[j].powi(power));
            terms[0] + terms[1] + terms[2]
        };
        let cubic = [
            outside + l * l * l * moment(0),
            3.0 * l * l * moment(1),
            3.0 * l * moment(2),
            moment(3),
        ];
        let at = |k: f32| ((cubic[3] * k + cubic[2]) * k + cubic[1]) * k + cubic[0];
        let (mut low, mut high) = (0.0, furthest);
        if at(high) >= 0.0 {
            return furthest;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if at(middle) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let (above, below) = (at(low).max(0.0), at(high));
        low + (high - low) * above / (above - below)
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use palette::{IntoColor, LinSrgb, Oklab};
    use proptest::prelude::*;

    const RED: [f32; 3] = [1.0, 0.0, 0.0];

    #[test]
    fn grey_is_exactly_grey() {
        let space = HueSpace::new();
        let apart = space.apart([0.7; 3]).unwrap();
        assert!(apart.colour.iter().all(|d| d.abs() < 2e-7), "{apart:?}");
        assert_eq!(apart.kept(space.rgb_from_receptors, 0.0, 0.9), 1.0);
    }

    #[test]
    fn what_no_eye_sees_is_not_taken_apart() {
        let space = HueSpace::new();
        assert!(space.apart([-1.0, -1.0, 0.5]).is_none());
        assert!(space.apart([0.0; 3]).is_none());
    }

    #[test]
    fn a_bound_is_met_where_it_was_reached() {
        let space = HueSpace::new();
        // Twice as far from grey as red is, half of it may stay.
        let red = space.apart(RED).unwrap();
        let twice = red.paled(2.0);
        let reach = space
            .rgb_from_receptors
            .map(|bound| twice.reach(bound, 0.0, 1.0 / 0.9));
        let nearest = reach.into_iter().fold(2.0, f32::min);
        assert!((nearest - 0.5).abs() < 1e-3, "{reach:?}");
    }

    #[test]
    fn the_kept_share_has_no_kink() {
        let space = HueSpace::new();
        let red = space.apart(RED).unwrap();
        // Colourfulness that is left, against what there was.
        let left = |times: f32| times * red.paled(times).kept(space.rgb_from_receptors, 0.0, 0.9);
        let slope = |times: f32| (left(times + 5e-3) - left(times - 5e-3)) / 1e-2;
        for i in 0..300 {
            let times = 0.7 + 0.005 * i as f32;
            let (here, next) = (slope(times), slope(times + 0.005));
            assert!((here - next).abs() < 0.12, "at {times}: {here}, {next}");
            assert!(here > -1e-3 && left(times) < 1.0, "at {times}");
        }
        assert!(left(0.85) > 0.849 && left(8.0) > 0.98);
    }

    proptest! {
        #[test]
        fn parts_put_together_are_the_colour(r in 0.0..1.0_f32, g in 0.0..1.0_f32, b in 0.01..1.0_f32) {
            let space = HueSpace::new();
            let back = space.rgb(space.apart([r, g, b]).unwrap());
            for (got, channel) in back.into_iter().zip([r, g, b]) {
                prop_assert!((got - channel).abs() < 1e-5, "{} {}", got, channel);
            }
        }

        #[test]
        fn a_paler_colour_has_the_hue_and_the_lightness_that_another_crate_gives_it(
            r in 0.0..1.0_f32, g in 0.0..1.0_f32, b in 0.0..1.0_f32, kept in 0.2..1.0_f32,
        ) {
            let space = HueSpace::new();
            let theirs = |[r, g, b]: [f32; 3]| -> Oklab { LinSrgb::new(r, g, b).into_color() };
            let before = theirs([r, g, b]);
            prop_assume!(before.a.hypot(before.b) > 0.05);
            let after = theirs(space.rgb(space.apart([r, g, b]).unwrap().paled(kept)));
            prop_assert!((before.l - after.l).abs() < 1e-3, "{:?} {:?}", before, after);
            // The parts along and across the old colour.
            let across = before.a * after.b - before.b * after.a;
            let along = before.a * after.a + before.b * after.b;
            prop_assert!(across.atan2(along).to_degrees().abs() < 0.5, "{:?} {:?}", before, after);
        }
    }
}
