//! Tone curves: how much light becomes how much display, and what becomes of the colour on the way.
//!
//! ```text
//! photographic  y(v) = v / (1 + v^p)^(1/p)      p = 1.6       mostly channel by channel
//!               w(v) = v² / (v² + v_w²)         v_w = 12
//! filmic        y and w likewise,               v_w = 6        by the brightest channel, at one hue
//! eye           y(Y) = Y / (Y + τ)              w = 0         by luminance, at one hue
//! linear        y(v) = min(v, 1)                w = 0         channel by channel
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | v, Y | linear light of a channel, luminance; 1 = display white if nothing were done | 1 |
//! | y | what of it the display shows, 0..=1 | 1 |
//! | p | sharpness of the shoulder | 1 |
//! | w | share of white in the brightest light | 1 |
//! | v_w | light that is half white | 1 |
//! | τ | half-saturation: the luminance that is shown at half | 1 |
//!
//! **Derivation.** The smallest of v and 1 is v/max(1, v). With the p-norm ‖(1, v)‖ₚ instead of the maximum it becomes
//! smooth everywhere and keeps both limits: y → v for small v, y → 1 as v → ∞. Mid grey, 0.18, is shown as 0.173. The
//! path to white imitates film and sensors, where light so strong leaks into all three layers; its square keeps dark
//! colours pure. The eye's is Naka and Rushton's law, see [`super::adaptation`].
//!
//! **Which one.** A photograph of a fire is yellow where it is bright: each layer of film saturates by itself, so a
//! bright orange turns by up to 43° of hue. The filmic curve takes the same light at its own hue, a paler orange.
//!
//! **Validity.** v ≥ 0; infinity is shown as 1.

use serde::{Deserialize, Serialize};

use super::adaptation::naka_rushton;
use super::gamut::Paling;

/// How light is brought into the range of the display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curve {
    /// A smooth shoulder, and a path to white for the brightest light, as in a photograph: bright orange turns yellow.
    #[default]
    Photographic,
    /// The same shoulder and path to white, with the hue of every light kept.
    Filmic,
    /// The response of the eye to luminance (Naka and Rushton), with the hue of every light kept.
    Eye,
    /// Plain clipping of each channel, for comparison.
    Linear,
}

/// What is done with a colour while its brightness is brought into range. A shader knows them by these numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Road {
    /// The curve on each channel, as far as `Curve::per_channel` says.
    Channels = 0,
    /// The curve on the brightest channel, and only less colour at the same hue.
    HueOfBrightest = 1,
    /// The curve on the luminance, and only less colour at the same hue.
    HueOfLuminance = 2,
    /// No curve: the colour of its stop.
    FalseColour = 3,
}

/// Sharpness p of the shoulder.
const SHOULDER: f64 = 1.6;
/// Light v_w that the photographic curve mixes half with white.
const HALF_WHITE: f64 = 12.0;
/// Light v_w that the filmic curve pales by half: earlier, because nothing else tells its bright parts apart.
const HALF_WHITE_AT_ONE_HUE: f64 = 6.0;
/// Share of the channel-by-channel curve in the photographic one; the rest keeps the ratio of the channels.
const PHOTOGRAPHIC_PER_CHANNEL: f64 = 0.85;
/// Softness with which the photographic curve brings colours into the triangle of the display: the blue of black bodies
/// from 1500 to 2000 K lies within so much of their red.
const PHOTOGRAPHIC_SOFTNESS: f64 = 0.02;
/// What is nearby for the photographic curve: black bodies from 1000 K on are.
const PHOTOGRAPHIC_PALING: Paling = Paling {
    outside: 0.04,
    start: 0.95,
};
/// The curves that keep hues leave nothing outside; the last tenth of the way to the sides bends.
const KEEPING_PALING: Paling = Paling {
    outside: 0.0,
    start: 0.9,
};

impl Curve {
    /// Every curve, in the order in which it is offered.
    pub const ALL: [Self; 4] = [Self::Photographic, Self::Filmic, Self::Eye, Self::Linear];

    /// What the display shows of a light v ≥ 0. Only the eye looks at the half-saturation.
    pub(super) fn shown(self, light: f64, half_saturation: f64) -> f64 {
        match self {
            // Written in 1/v where v is large, so that infinity has a value.
            Self::Photographic | Self::Filmic if light > 1.0 => {
                (1.0 + light.powf(-SHOULDER)).powf(-1.0 / SHOULDER)
            }
            Self::Photographic | Self::Filmic => {
                light / (1.0 + light.powf(SHOULDER)).powf(1.0 / SHOULDER)
            }
            Self::Eye => naka_rushton(light, half_saturation),
            Self::Linear => light.min(1.0),
        }
    }

    /// The share of white in a colour whose brightest channel is v ≥ 0.
    pub(super) fn whiteness(self, light: f64) -> f64 {
        match self {
            Self::Photographic => 1.0 / (1.0 + (HALF_WHITE / light).powi(2)),
            Self::Filmic => 1.0 / (1.0 + (HALF_WHITE_AT_ONE_HUE / light).powi(2)),
            Self::Eye | Self::Linear => 0.0,
        }
    }

    /// What becomes of the colour.
    pub(super) fn road(self) -> Road {
        match self {
            Self::Photographic | Self::Linear => Road::Channels,
            Self::Filmic => Road::HueOfBrightest,
            Self::Eye => Road::HueOfLuminance,
        }
    }

    /// Share of the curve applied channel by channel, which turns bright orange to yellow; the rest keeps the ratio of
    /// the channels.
    pub(super) fn per_channel(self) -> f64 {
        match self {
            Self::Photographic => PHOTOGRAPHIC_PER_CHANNEL,
            _ => 1.0,
        }
    }

    /// Softness of the way into the triangle of the display, relative to the brightest channel.
    pub(super) fn softness(self) -> f64 {
        match self {
            Self::Photographic => PHOTOGRAPHIC_SOFTNESS,
            _ => 0.0,
        }
    }

    /// How a colour outside of the display's triangle is paled at its hue; `None`: not at all.
    pub(super) fn paling(self) -> Option<Paling> {
        match self {
            Self::Photographic => Some(PHOTOGRAPHIC_PALING),
            Self::Filmic | Self::Eye => Some(KEEPING_PALING),
            Self::Linear => None,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        reason = "a test fails by panicking"
    )]

    use super::*;
    use proptest::prelude::*;

    #[test]
    fn every_curve_runs_from_black_to_full() {
        for curve in Curve::ALL {
            assert_eq!(curve.shown(0.0, 1.0), 0.0);
            assert_eq!(curve.shown(f64::INFINITY, 1.0), 1.0);
            assert_eq!(curve.whiteness(0.0), 0.0);
        }
        assert_eq!(Curve::Photographic.whiteness(f64::INFINITY), 1.0);
    }

    #[test]
    fn dark_light_is_shown_as_it_is() {
        for curve in [Curve::Photographic, Curve::Filmic] {
            assert!((curve.shown(0.18, 1.0) - 0.173).abs() < 1e-3);
            assert!((curve.shown(1e-4, 1.0) / 1e-4 - 1.0).abs() < 1e-6);
            assert!(curve.whiteness(0.18) < 2e-3);
        }
        assert!((Curve::Eye.shown(1e-4, 1.0) / 1e-4 - 1.0).abs() < 2e-4);
    }

    #[test]
    fn the_eye_shows_its_half_saturation_at_half() {
        for half in [1e-6, 0.25, 3.0, 1e6] {
            assert_eq!(Curve::Eye.shown(half, half), 0.5);
        }
    }

    #[test]
    fn both_forms_of_the_shoulder_meet() {
        let (below, above) = (
            Curve::Photographic.shown(1.0, 1.0),
            Curve::Photographic.shown(1.0_f64.next_up(), 1.0),
        );
        assert!((above - below).abs() < 1e-15);
    }

    #[test]
    fn names_are_those_of_the_scene_file() {
        let names = serde_json::to_string(&Curve::ALL).unwrap();
        assert_eq!(names, r#"["photographic","filmic","eye","linear"]"#);
    }

    proptest! {
        #[test]
        fn more_light_is_never_shown_darker(stop in -20.0..20.0_f64, more in 0.0..1.0_f64) {
            let (less, light) = (stop.exp2(), (stop + more).exp2());
            for curve in Curve::ALL {
                prop_assert!(curve.shown(light, 1.0) >= curve.shown(less, 1.0) * (1.0 - 1e-15));
                prop_assert!(curve.whiteness(light) >= curve.whiteness(less));
                prop_assert!(curve.shown(light, 1.0) <= light * (1.0 + 1e-15));
            }
        }
    }
}
