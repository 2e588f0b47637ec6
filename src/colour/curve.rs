//! Tone curves: how much light becomes how much display.
//!
//! ```text
//! filmic  y(v) = v / (1 + v^p)^(1/p)      p = 1.6
//!         w(v) = v² / (v² + v_w²)         v_w = 12
//! linear  y(v) = min(v, 1)                w = 0
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | v | linear light, 1 = display white if nothing were done | 1 |
//! | y | what of it the display shows, 0..=1 | 1 |
//! | p | sharpness of the shoulder | 1 |
//! | w | share of white that the brightest light is mixed with | 1 |
//! | v_w | light that is half white | 1 |
//!
//! **Derivation.** The smallest of v and 1 is v/max(1, v). With the p-norm ‖(1, v)‖ₚ instead of the maximum it becomes
//! smooth everywhere and keeps both limits: y → v for small v, y → 1 as v → ∞. Mid grey, 0.18, is shown as 0.173. The
//! path to white imitates film and sensors, where light so strong leaks into all three layers; its square keeps dark
//! colours pure.
//!
//! **Validity.** v ≥ 0; infinity is shown as 1.

use serde::{Deserialize, Serialize};

/// How light is brought into the range of the display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curve {
    /// A smooth shoulder, and a path to white for the brightest light: what a photograph does.
    #[default]
    Filmic,
    /// Plain clipping of each channel, for comparison.
    Linear,
}

/// Sharpness p of the filmic shoulder.
const SHOULDER: f64 = 1.6;
/// Light v_w that the filmic curve mixes half with white.
const HALF_WHITE: f64 = 12.0;
/// Share of the channel-by-channel curve in the filmic one; the rest keeps the ratio of the channels.
const FILMIC_PER_CHANNEL: f64 = 0.85;
/// Softness with which the filmic curve brings colours into the triangle of the display: the blue of black bodies from
/// 1500 to 2000 K lies within so much of their red.
const FILMIC_SOFTNESS: f64 = 0.02;

impl Curve {
    /// What the display shows of a light v ≥ 0.
    pub(super) fn shown(self, light: f64) -> f64 {
        match self {
            // Written in 1/v where v is large, so that infinity has a value.
            Self::Filmic if light > 1.0 => (1.0 + light.powf(-SHOULDER)).powf(-1.0 / SHOULDER),
            Self::Filmic => light / (1.0 + light.powf(SHOULDER)).powf(1.0 / SHOULDER),
            Self::Linear => light.min(1.0),
        }
    }

    /// The share of white in a colour whose brightest channel is v ≥ 0.
    pub(super) fn whiteness(self, light: f64) -> f64 {
        match self {
            Self::Filmic => 1.0 / (1.0 + (HALF_WHITE / light).powi(2)),
            Self::Linear => 0.0,
        }
    }

    /// Share of the curve applied channel by channel, which turns bright orange to yellow; the rest keeps hues.
    pub(super) fn per_channel(self) -> f64 {
        match self {
            Self::Filmic => FILMIC_PER_CHANNEL,
            Self::Linear => 1.0,
        }
    }

    /// Softness of the way into the triangle of the display, relative to the brightest channel.
    pub(super) fn softness(self) -> f64 {
        match self {
            Self::Filmic => FILMIC_SOFTNESS,
            Self::Linear => 0.0,
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
    fn both_curves_run_from_black_to_full() {
        for curve in [Curve::Filmic, Curve::Linear] {
            assert_eq!(curve.shown(0.0), 0.0);
            assert_eq!(curve.shown(f64::INFINITY), 1.0);
            assert_eq!(curve.whiteness(0.0), 0.0);
        }
        assert_eq!(Curve::Filmic.whiteness(f64::INFINITY), 1.0);
    }

    #[test]
    fn dark_light_is_shown_as_it_is() {
        assert!((Curve::Filmic.shown(0.18) - 0.173).abs() < 1e-3);
        assert!((Curve::Filmic.shown(1e-4) / 1e-4 - 1.0).abs() < 1e-6);
        assert!(Curve::Filmic.whiteness(0.18) < 2e-3);
    }

    #[test]
    fn both_forms_of_the_shoulder_meet() {
        let (below, above) = (
            Curve::Filmic.shown(1.0),
            Curve::Filmic.shown(1.0_f64.next_up()),
        );
        assert!((above - below).abs() < 1e-15);
    }

    #[test]
    fn names_are_those_of_the_scene_file() {
        let names = serde_json::to_string(&[Curve::Filmic, Curve::Linear]).unwrap();
        assert_eq!(names, r#"["filmic","linear"]"#);
    }

    proptest! {
        #[test]
        fn more_light_is_never_shown_darker(stop in -20.0..20.0_f64, more in 0.0..1.0_f64) {
            let (less, light) = (stop.exp2(), (stop + more).exp2());
            for curve in [Curve::Filmic, Curve::Linear] {
                prop_assert!(curve.shown(light) >= curve.shown(less) * (1.0 - 1e-15));
                prop_assert!(curve.whiteness(light) >= curve.whiteness(less));
                prop_assert!(curve.shown(light) <= light * (1.0 + 1e-15));
            }
        }
    }
}
