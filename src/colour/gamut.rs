//! Bringing a colour into the triangle of the display.
//!
//! ```text
//! far      paled at its hue until every channel is above −ε', see [`super::hue`]; then its Y again
//! nearby   c⁺ = (c + √(c² + (ε·max(rgb))²))/2 for each channel c;   rgb' = rgb⁺ · Y/Y⁺
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | rgb, c | linear Rec. 709 light | 1 |
//! | Y, Y⁺ | luminance of rgb and of rgb⁺ | 1 |
//! | ε' | how far outside is nearby, in shares of what the largest channel was | 1 |
//! | ε | softness; with 0, c⁺ is max(c, 0) | 1 |
//!
//! Leaving a negative channel out takes a colour to the nearest side of the triangle: good for what is close, as black
//! bodies below 1900 K are, whose hue moves by less than 5°; a deep red stays red, and embers do not turn pink. But the
//! lone lines of metals are far outside: 470 nm would turn by 28°, copper's 510 nm by 21°. Those first give up colour at
//! their hue. Both keep the brightness, and a negative channel never meets a power. Without softness the blue of a flame
//! would set in at a line, which the eye finds; with it, c⁺ > 0 is smooth, keeps the order of the channels, and keeps
//! grey grey.
//!
//! **Validity.** Finite light. A colour without luminance is no light: black.
//!
//! **Source.** Our own: the hyperbola is the smooth maximum of c and 0. The luminance weights are the middle row of the
//! matrix to XYZ, see [`super::xyz`].

use super::hue::{Apart, HueSpace};
use super::xyz::LUMINANCE;

/// The colour without negative channels, of the same luminance (see the page above).
pub(super) fn without_negatives(rgb: [f32; 3], softness: f32) -> [f32; 3] {
    let bend = softness * rgb[0].max(rgb[1]).max(rgb[2]);
    let positive = rgb.map(|channel| smooth_positive(channel, bend));
    let scale = luminance(rgb) / luminance(positive);
    // 0/0 for black, negative where there is no light.
    if scale > 0.0 {
        positive.map(|channel| channel * scale)
    } else {
        [0.0; 3]
    }
}

/// How a colour outside of the triangle is paled at its hue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paling {
    /// How far below 0 a channel may stay, in shares of what the largest was.
    pub outside: f32,
    /// From which share of the way to that bound on colour gives way, 0..1: the rest is a bend instead of a kink.
    pub start: f32,
}

/// The colour paled at its hue until it lies in the triangle or nearby, of the same luminance.
pub(super) fn paled(rgb: [f32; 3], paling: Paling, space: &HueSpace) -> [f32; 3] {
    let Some((apart, kept)) = nearer_grey(rgb, paling, space) else {
        return rgb;
    };
    if kept >= 1.0 {
        return rgb;
    }
    let pale = space.rgb(apart.paled(kept));
    let scale = luminance(rgb) / luminance(pale);
    pale.map(|channel| channel * scale)
}

/// A colour in units of its largest channel, taken apart, and the share of it that stays; `None` without light.
pub(super) fn nearer_grey(rgb: [f32; 3], paling: Paling, space: &HueSpace) -> Option<(Apart, f32)> {
    if luminance(rgb) <= 0.0 {
        return None;
    }
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    let apart = space.apart(rgb.map(|channel| channel / largest))?;
    let kept = apart.kept(space.rgb_from_receptors, paling.outside, paling.start);
    Some((apart, kept))
}

/// max(c, 0), rounded off by a hyperbola where |c| is of the size of `bend`.
fn smooth_positive(channel: f32, bend: f32) -> f32 {
    let root = (channel * channel + bend * bend).sqrt();
    // For a negative channel the sum would cancel: the product of the roots is bend²/4.
    if channel >= 0.0 {
        0.5 * (channel + root)
    } else if bend > 0.0 {
        0.5 * bend * bend / (root - channel)
    } else {
        0.0
    }
}

/// Y of linear Rec. 709 light.
pub(super) fn luminance([r, g, b]: [f32; 3]) -> f32 {
    LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
}

#[cfg(test)]
mod tests {
    use super::super::cie::colour_matching;
    use super::super::xyz::{rgb_from_xyz, xyz_from_rgb};
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    #[test]
    fn weights_are_those_of_the_matrix() {
        for (i, weight) in LUMINANCE.into_iter().enumerate() {
            assert_eq!(weight, xyz_from_rgb().row(1)[i] as f32);
        }
    }

    #[test]
    fn without_softness_what_the_display_can_show_is_left_alone() {
        assert_eq!(without_negatives([4.0, 0.5, 0.0], 0.0), [4.0, 0.5, 0.0]);
        assert_eq!(without_negatives([0.0; 3], 0.0), [0.0; 3]);
    }

    #[test]
    fn a_colour_without_luminance_is_black() {
        for softness in [0.0, 0.02] {
            assert_eq!(without_negatives([0.0; 3], softness), [0.0; 3]);
            assert_eq!(without_negatives([1.0, -1.0, 0.0], softness), [0.0; 3]);
            assert_eq!(without_negatives([-1.0; 3], softness), [0.0; 3]);
        }
    }

    #[test]
    fn softness_lets_a_channel_set_in_without_a_kink() {
        let blue = |b| without_negatives([1.0, 0.2, b], 0.02)[2];
        let slope = |b: f32| (blue(b + 1e-3) - blue(b - 1e-3)) / 2e-3;
        for i in -40..40 {
            let b = i as f32 * 1e-3;
            assert!((slope(b + 1e-3) - slope(b)).abs() < 0.05, "at {b}");
        }
    }

    const PALING: Paling = Paling {
        outside: 0.04,
        start: 0.95,
    };

    #[test]
    fn what_is_nearby_is_not_paled_at_all() {
        let space = HueSpace::new();
        // Black bodies at 1000, 1500 and 2500 K.
        for rgb in [
            [1.0, 0.009, -0.020],
            [1.0, 0.133, -0.020],
            [1.0, 0.372, 0.067],
        ] {
            assert_eq!(paled(rgb, PALING, &space), rgb);
        }
        assert_eq!(paled([0.0; 3], PALING, &space), [0.0; 3]);
        assert_eq!(paled([1.0, -1.0, 0.0], PALING, &space), [1.0, -1.0, 0.0]);
    }

    proptest! {
        #[test]
        fn luminance_stays_and_no_channel_is_negative(
            r in -1.0..4.0_f32, g in -1.0..4.0_f32, b in -1.0..4.0_f32, softness in 0.0..0.1_f32,
        ) {
            let before = luminance([r, g, b]);
            let mapped = without_negatives([r, g, b], softness);
            prop_assert!(mapped.iter().all(|channel| *channel >= 0.0));
            prop_assert!((luminance(mapped) - before.max(0.0)).abs() < 1e-5);
        }

        #[test]
        fn what_is_far_comes_nearby_with_its_luminance(
            nm in 400.0..700.0_f64, other in 400.0..700.0_f64, share in 0.0..1.0_f64, stop in -20.0..20.0_f64,
        ) {
            let [one, other] = [nm, other].map(|nm| DVec3::from_array(colour_matching(nm)));
            let light = rgb_from_xyz() * (one * share + other * (1.0 - share)) * stop.exp2();
            let rgb = light.as_vec3().to_array();
            let near = paled(rgb, PALING, &HueSpace::new());
            let [before, after] = [rgb, near].map(luminance);
            prop_assert!((after / before - 1.0).abs() < 1e-4, "{:?} {:?}", rgb, near);
            let largest = near[0].max(near[1]).max(near[2]);
            let lowest = near[0].min(near[1]).min(near[2]);
            prop_assert!(lowest > -0.2 * largest, "{:?} {:?}", rgb, near);
        }

        #[test]
        fn the_order_of_the_channels_stays(
            r in 1.0..4.0_f32, g in 0.0..1.0_f32, b in -0.5..0.0_f32, softness in 0.0..0.1_f32,
        ) {
            let [red, green, blue] = without_negatives([r, g, b], softness);
            prop_assert!(red >= green && green >= blue);
        }

        #[test]
        fn grey_stays_grey(grey in 0.0..1e6_f32, softness in 0.0..0.1_f32) {
            let [r, g, b] = without_negatives([grey; 3], softness);
            prop_assert!(r == g && g == b && (r - grey).abs() <= 1e-6 * grey);
        }
    }
}
