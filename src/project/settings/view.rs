//! How light becomes a picture, as a scene file has it.

use serde::{Deserialize, Serialize};

use crate::colour::display::Curve;
use crate::project::ranges::{DISPLAY_WHITE_CD_M2, WHITE_XY};
use crate::render::develop::{Metering, ViewParams};

/// `[view]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ViewSettings {
    /// Stops above the automatic exposure, or above that of `display_white_cd_m2`, −20 to 20.
    pub exposure_ev: f64,
    /// Luminance that becomes display white at 0 stops, cd m⁻²; `None`: measured from the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display_white_cd_m2: Option<f64>,
    /// Degree to which the eye has adapted to the white, 0 to 1.
    pub adaptation: f64,
    /// Temperature of the black body that is white, K, 1000 to 20000; `None`: `white_xy`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub white_k: Option<f64>,
    /// CIE 1931 x and y of the white; `None`: measured from the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub white_xy: Option<[f64; 2]>,
    /// How light becomes display values.
    pub curve: Curve,
    /// Luminance to which the eye's curve responds half, cd m⁻²; `None`: follows the measured exposure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_saturation_cd_m2: Option<f64>,
    /// Whether luminance is shown in stops, each of a colour, in place of the picture.
    pub false_colour: bool,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            exposure_ev: 0.0,
            display_white_cd_m2: None,
            adaptation: 0.2,
            white_k: None,
            white_xy: None,
            curve: Curve::default(),
            half_saturation_cd_m2: None,
            false_colour: false,
        }
    }
}

impl ViewSettings {
    /// What the renderer's floor takes.
    pub fn params(&self) -> ViewParams {
        ViewParams {
            exposure_ev: self.exposure_ev,
            display_white_cd_m2: self.display_white_cd_m2,
            adaptation: self.adaptation,
            white_k: self.white_k,
            white_xy: self.white_xy,
            curve: self.curve,
            half_saturation_cd_m2: self.half_saturation_cd_m2,
            false_colour: self.false_colour,
        }
    }

    /// Sets by hand what was measured, so that other pictures are developed alike. What is set already stays; of a film on
    /// which nothing was lit there is nothing to set.
    pub fn hold(&mut self, measured: &Metering) {
        if measured.bright_y <= 0.0 {
            return;
        }
        let [least, most] = DISPLAY_WHITE_CD_M2;
        self.display_white_cd_m2
            .get_or_insert(measured.display_white_cd_m2().clamp(least, most));
        if let (None, Some(xy)) = (self.white_k, measured.white_xy()) {
            let [least, most] = WHITE_XY;
            self.white_xy
                .get_or_insert(xy.map(|part| part.clamp(least, most)));
        }
    }

    /// Leaves to be measured what [`ViewSettings::hold`] sets.
    pub fn let_go(&mut self) {
        self.display_white_cd_m2 = None;
        self.white_xy = None;
    }
}
