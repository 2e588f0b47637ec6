//! How accurate a picture is, and how large, as a scene file has it.

use serde::{Deserialize, Serialize};

use crate::scene::{Interpolation, WavelengthSet};

/// `[render]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// Width and height of a still, pixels.
    pub size: [u32; 2],
    /// How exact; the numbers below are chosen for it, and an explicit one overrides it.
    pub quality: Quality,
    /// The same as a number: 95th percentile of ΔE_ITP over lit pixels; overrides quality.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_error: Option<f64>,
    /// Length of a step, voxels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_voxels: Option<f64>,
    /// How many wavelengths: 4, 6, 8 (fitted to the soot), 16, 32, 64 (plain).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wavelengths: Option<WavelengthSet>,
    /// How values between the samples of a field are formed.
    pub interpolation: Interpolation,
    /// Rays for each pixel; 1 is the pixel's centre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples_per_pixel: Option<u32>,
    /// How often light may be scattered, 1 to 64: once without noise, more often by path tracing.
    pub scattering_orders: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            quality: Quality::default(),
            target_error: None,
            step_voxels: None,
            wavelengths: None,
            interpolation: Interpolation::default(),
            samples_per_pixel: None,
            scattering_orders: 1,
        }
    }
}

/// How exact a picture is to be. Step, wavelengths and rays are chosen for each scene so that its error, the 95th percentile of
/// ΔE_ITP over lit pixels, is what a quality aims at: 1 is a difference that is just seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// For blocking out: 5 ΔE.
    Draft,
    /// For looking: 1 ΔE.
    #[default]
    Look,
    /// For keeping: 0.3 ΔE.
    Final,
    /// For measuring against: 0.05 ΔE.
    Reference,
}

impl Quality {
    /// Every preset, cheapest first.
    pub const ALL: [Self; 4] = [Self::Draft, Self::Look, Self::Final, Self::Reference];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Look => "look",
            Self::Final => "final",
            Self::Reference => "reference",
        }
    }

    /// The error that it aims at, ΔE_ITP.
    pub fn target_de(self) -> f64 {
        match self {
            Self::Draft => 5.0,
            Self::Look => 1.0,
            Self::Final => 0.3,
            Self::Reference => 0.05,
        }
    }

    /// Step in voxels, wavelengths and rays for each pixel of scenes that nobody has looked at yet.
    pub fn numbers(self) -> (f64, WavelengthSet, u32) {
        match self {
            Self::Draft => (2.0, WavelengthSet::Fitted(4), 1),
            Self::Look => (1.0, WavelengthSet::Fitted(6), 1),
            Self::Final => (0.5, WavelengthSet::Fitted(8), 4),
            Self::Reference => (0.25, WavelengthSet::Plain(64), 16),
        }
    }
}
