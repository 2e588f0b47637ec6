//! The numbers that accuracy is made of, and which of them are tried.

use crate::project::{Accuracy, RenderSettings};
use crate::render::Settings;
use crate::scene::WavelengthSet;

/// Steps that are tried, voxels, longest first.
pub const STEPS: [f64; 7] = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// Rays for each pixel that are tried. From four on, their lattices hold all that bends across a pixel to the second order, which
/// those of most counts do not: nine are nearly as good as sixteen, and twelve are better.
pub const RAYS: [u32; 6] = [1, 2, 4, 9, 12, 28];

/// What the pictures of a report are compared with. The march by an eighth of a voxel is what a walk from cell to cell sees, to
/// less than 0.25 ΔE (`ground_truth::cell_walk` among the tests).
pub const REFERENCE: Numbers = Numbers {
    step_voxels: 0.125,
    wavelengths: WavelengthSet::Plain(64),
    samples_per_pixel: 28,
};

/// How exactly a picture is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers {
    /// Length of a step, voxels.
    pub step_voxels: f64,
    /// At which wavelengths light is carried.
    pub wavelengths: WavelengthSet,
    /// Rays for each pixel.
    pub samples_per_pixel: u32,
}

impl Numbers {
    /// Those of settings.
    pub fn of(settings: &Settings) -> Self {
        Self {
            step_voxels: settings.step_voxels,
            wavelengths: settings.wavelengths,
            samples_per_pixel: settings.samples_per_pixel,
        }
    }

    /// The same settings with these numbers.
    #[must_use]
    pub fn within(self, settings: &Settings) -> Settings {
        Settings {
            step_voxels: self.step_voxels,
            wavelengths: self.wavelengths,
            samples_per_pixel: self.samples_per_pixel,
            ..*settings
        }
    }

    /// The same with as many wavelengths as a plan carries: where what falls on a stage or is scattered calls for it, that is
    /// more than settings say.
    #[must_use]
    pub fn carrying(self, count: u32) -> Self {
        let carried = WavelengthSet::ALL
            .into_iter()
            .find(|set| set.count() == count);
        Self {
            wavelengths: carried.unwrap_or(self.wavelengths),
            ..self
        }
    }

    /// Those of them that were to be chosen, the others as given.
    #[must_use]
    pub fn where_free(self, wished: Accuracy, given: Self) -> Self {
        Self {
            step_voxels: if wished.step {
                self.step_voxels
            } else {
                given.step_voxels
            },
            wavelengths: if wished.wavelengths {
                self.wavelengths
            } else {
                given.wavelengths
            },
            samples_per_pixel: if wished.rays {
                self.samples_per_pixel
            } else {
                given.samples_per_pixel
            },
        }
    }

    /// Sets all three by hand.
    pub fn by_hand(self, render: &mut RenderSettings) {
        render.step_voxels = Some(self.step_voxels);
        render.wavelengths = Some(self.wavelengths);
        render.samples_per_pixel = Some(self.samples_per_pixel);
    }

    /// In words: "step 2, 6 wavelengths, 1 ray".
    pub fn in_words(self) -> String {
        let rays = self.samples_per_pixel;
        format!(
            "step {}, {} wavelengths, {rays} {}",
            self.step_voxels,
            self.wavelengths.count(),
            if rays == 1 { "ray" } else { "rays" }
        )
    }
}
