//! How exact a picture is wished, and which of its numbers are left to be chosen for that.

use super::settings::Project;

/// How exact a picture is wished.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// 95th percentile of ΔE_ITP over lit pixels, against the reference of the study.
    pub target_de: f64,
    /// Whether the step is to be chosen, and not set by hand.
    pub step: bool,
    /// Whether the wavelengths are.
    pub wavelengths: bool,
    /// Whether the rays of each pixel are.
    pub rays: bool,
}

impl Accuracy {
    /// Everything is to be chosen; the target is for the caller to say.
    pub const ALL: Self = Self {
        target_de: 1.0,
        step: true,
        wavelengths: true,
        rays: true,
    };

    /// Whether there is anything to choose.
    pub fn is_open(self) -> bool {
        self.step || self.wavelengths || self.rays
    }
}

impl Project {
    /// How exact the render section wishes a picture.
    pub fn accuracy(&self) -> Accuracy {
        let render = &self.render;
        Accuracy {
            target_de: render
                .target_error
                .unwrap_or_else(|| render.quality.target_de()),
            step: render.step_voxels.is_none(),
            wavelengths: render.wavelengths.is_none(),
            rays: render.samples_per_pixel.is_none(),
        }
    }
}
