//! What stands around a fire, as a scene file has it.

use std::path::PathBuf;

use serde::{Deserialize, Serialize, Serializer};

/// `[stage]`
///
/// Colours are diffuse albedos: linear Rec. 709 red, green, blue, each 0 to 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StageSettings {
    /// Whether there is a ground.
    pub ground: bool,
    /// z of the ground, m; `None`: the lower end of the fire's box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_height_m: Option<f64>,
    /// Colour of the ground.
    pub ground_colour: [f64; 3],
    /// x, y, z and radius of each sphere, m.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spheres: Vec<[f64; 4]>,
    /// Colour of the spheres.
    pub sphere_colour: [f64; 3],
    /// x, y, z of one end of each log's middle line, of the other end, and its radius, m.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub logs: Vec<[f64; 7]>,
    /// Colour of the logs.
    pub log_colour: [f64; 3],
    /// What is behind everything.
    pub backdrop: BackdropKind,
    /// Distance of the backdrop behind the camera's target, m; `None`: twice the largest side of the fire's box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backdrop_distance_m: Option<f64>,
    /// Edge of a checker's square, m; `None`: a twelfth of the frame's height there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backdrop_square_m: Option<f64>,
    /// Luminance of the backdrop's white, cd m⁻², 0 to 1000000000.
    pub backdrop_luminance_cd_m2: f64,
    /// A PNG file. In a scene file relative to that file.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "as_text")]
    pub backdrop_picture: Option<PathBuf>,
}

impl Default for StageSettings {
    /// Nothing, and the colours that things would have: of dry soil, grey card and bark.
    fn default() -> Self {
        Self {
            ground: false,
            ground_height_m: None,
            ground_colour: [0.25, 0.22, 0.2],
            spheres: Vec::new(),
            sphere_colour: [0.5; 3],
            logs: Vec::new(),
            log_colour: [0.2, 0.13, 0.08],
            backdrop: BackdropKind::default(),
            backdrop_distance_m: None,
            backdrop_square_m: None,
            // As bright as paper under an overcast sky: bright enough to be seen beside a fire.
            backdrop_luminance_cd_m2: 2000.0,
            backdrop_picture: None,
        }
    }
}

/// What is on the backdrop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BackdropKind {
    /// There is none.
    #[default]
    None,
    /// Squares.
    Checker,
    /// From black at the bottom to white at the top.
    Gradient,
    /// The picture of `stage.backdrop_picture`.
    Picture,
}

impl BackdropKind {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::None, Self::Checker, Self::Gradient, Self::Picture];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Checker => "checker",
            Self::Gradient => "gradient",
            Self::Picture => "picture",
        }
    }
}

/// What is not UTF-8 is written with replacement characters.
#[allow(clippy::ref_option, reason = "serde hands the field over so")]
fn as_text<S: Serializer>(path: &Option<PathBuf>, serializer: S) -> Result<S::Ok, S::Error> {
    let text = path.as_ref().map(|path| path.to_string_lossy());
    text.serialize(serializer)
}
