//! How accurate a picture is, and how large, as a scene file has it.

use serde::{Deserialize, Serialize};

use crate::scene::{Interpolation, WavelengthSet};

/// `[render]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// Width and height of a still, pixels.
    pub size: [u32; 2],
    /// A preset of the numbers below; an explicit number overrides it.
    pub quality: Quality,
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
            step_voxels: None,
            wavelengths: None,
            interpolation: Interpolation::default(),
            samples_per_pixel: None,
            scattering_orders: 1,
        }
    }
}

/// Fixed presets of step, wavelengths and rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// For blocking out: steps of two voxels, 4 wavelengths, one ray.
    Draft,
    /// For looking: steps of one voxel, 6 wavelengths, one ray.
    #[default]
    Look,
    /// For keeping: half-voxel steps, 8 wavelengths, 4 rays.
    Final,
    /// For measuring against: quarter-voxel steps, 64 wavelengths, 16 rays.
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

    /// Step in voxels, wavelengths and rays for each pixel.
    pub fn numbers(self) -> (f64, WavelengthSet, u32) {
        match self {
            Self::Draft => (2.0, WavelengthSet::Fitted(4), 1),
            Self::Look => (1.0, WavelengthSet::Fitted(6), 1),
            Self::Final => (0.5, WavelengthSet::Fitted(8), 4),
            Self::Reference => (0.25, WavelengthSet::Plain(64), 16),
        }
    }
}
