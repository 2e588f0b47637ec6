//! The sections of a scene file with their defaults and ranges.
//!
//! `None` means *chosen from the file or the scene*: a producer's preset, a camera that frames the flame, the
//! numbers of a quality.

use std::path::PathBuf;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::physics::soot::{Hold, REFERENCE_RADIUS_NM, SootModel};
use crate::render::Effects;
use crate::scene::{Camera, Fuel, Salt};
use crate::volume::{BuiltIn, Limits, Producer};

mod air;
mod render;
mod stage;
mod view;

pub use air::{AirSettings, Saturation};
pub use render::{Quality, RenderSettings};
pub use stage::{BackdropKind, StageSettings};
pub use view::ViewSettings;

/// A whole scene file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Project {
    /// Which files, and what their fields mean.
    pub volume: VolumeSettings,
    /// What burns.
    pub fuel: FuelSettings,
    /// The soot's particles and amount.
    pub soot: SootSettings,
    /// Cold smoke.
    pub smoke: SmokeSettings,
    /// The air around.
    pub air: AirSettings,
    /// What stands around the fire.
    pub stage: StageSettings,
    /// Which effects are computed.
    pub effects: Effects,
    /// Where the eye is.
    pub camera: CameraSettings,
    /// How accurate, and how large.
    pub render: RenderSettings,
    /// How the light becomes a picture.
    pub view: ViewSettings,
}

/// `[volume]`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VolumeSettings {
    /// One path or a list; empty for the built-in flame. In a scene file relative to that file.
    #[serde(with = "super::one_or_many", skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<PathBuf>,
    /// Which of the program's own flames is shown where there is no path.
    #[serde(skip_serializing_if = "is_default")]
    pub built_in: BuiltIn,
    /// Whose conventions the fields follow; auto: recognised from the file.
    pub producer: Producer,
    /// Which axis of the file points up.
    pub up: Up,
    /// Edge of a voxel in metres; `None`: the file's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub voxel_size_m: Option<f64>,
    /// What a file, its grids and what is packed of them may cost in memory, each, in megabytes of 10⁶ bytes; `None`:
    /// [`Limits::default`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory_limit_mb: Option<f64>,
    /// Overrides of the preset, field by field.
    #[serde(skip_serializing_if = "FieldSettings::is_unset")]
    pub soot: FieldSettings,
    /// Overrides of the preset's smoke.
    #[serde(skip_serializing_if = "FieldSettings::is_unset")]
    pub smoke: FieldSettings,
    /// Overrides of the preset's flame.
    #[serde(skip_serializing_if = "FieldSettings::is_unset")]
    pub flame: FieldSettings,
    /// Overrides of the preset's temperature.
    #[serde(skip_serializing_if = "FieldSettings::is_unset")]
    pub temperature: FieldSettings,
}

impl VolumeSettings {
    /// What the volume may cost.
    pub fn limits(&self) -> Limits {
        self.memory_limit_mb
            .map_or_else(Limits::default, Limits::of_memory_mb)
    }

    /// What holds for any file: the limits of this machine, and nothing that was said of the file.
    #[must_use]
    pub fn for_another_file(&self) -> Self {
        Self {
            memory_limit_mb: self.memory_limit_mb,
            ..Self::default()
        }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Which axis of the file points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Up {
    /// As the producer writes it.
    #[default]
    Auto,
    /// y.
    Y,
    /// z.
    Z,
}

/// Overrides of one field's mapping, physical = clamp(scale · raw + offset, min, max). What is `None` comes from
/// the producer's preset.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FieldSettings {
    /// Name of the grid; empty switches the field off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<String>,
    /// Physical units for one unit of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Physical value of a raw zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Least physical value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest physical value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

impl FieldSettings {
    /// Whether the preset's mapping stands as it is.
    pub fn is_unset(&self) -> bool {
        *self == Self::default()
    }
}

/// `[fuel]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FuelSettings {
    /// What burns.
    pub name: Fuel,
    /// A salt in it that colours the flame.
    pub salt: Salt,
    /// Mole fraction of the salt's metal in the undiluted hot gas, parts in a million, 0 to 100000.
    pub salt_ppm: f64,
    /// Multiplies the blue light of the reaction zone, 0 to 10000.
    pub blue_glow: f64,
}

impl Default for FuelSettings {
    fn default() -> Self {
        Self {
            name: Fuel::default(),
            salt: Salt::default(),
            salt_ppm: 100.0,
            blue_glow: 1.0,
        }
    }
}

/// `[soot]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SootSettings {
    /// Radius of a primary particle, nm, 1 to 100.
    pub radius_nm: f64,
    /// Multiplies the soot field, 0 to 10000.
    pub amount: f64,
    /// How absorption depends on wavelength.
    pub model: SootModel,
    /// What stays when the radius changes: the number of particles or the volume of soot.
    pub hold: Hold,
    /// Mean cosine of the scattering, −0.99 to 0.99; `None`: that of spheres of the radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub asymmetry: Option<f64>,
}

impl Default for SootSettings {
    fn default() -> Self {
        Self {
            radius_nm: REFERENCE_RADIUS_NM,
            amount: 1.0,
            model: SootModel::default(),
            hold: Hold::default(),
            asymmetry: None,
        }
    }
}

/// `[smoke]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SmokeSettings {
    /// Multiplies the smoke field, 0 to 10000.
    pub amount: f64,
    /// Share of what smoke takes from light that it scatters, 0 to 0.99.
    pub albedo: f64,
}

impl Default for SmokeSettings {
    fn default() -> Self {
        Self {
            amount: 1.0,
            // The black smoke of overfire soot scatters a fifth to a quarter of what it takes: G. W. Mulholland and
            // M. Y. Choi, Proc. Combust. Inst. 27 (1998) 1515.
            albedo: 0.2,
        }
    }
}

/// `[camera]`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraSettings {
    /// Position of the eye, m; with `target`. `None`: frames the flame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<DVec3>,
    /// The point in the middle of the picture, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<DVec3>,
    /// What is up in the picture; z if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<DVec3>,
    /// Vertical field of view, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_deg: Option<f64>,
    /// Turn of the camera about its line of sight, degrees clockwise; 0 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_deg: Option<f64>,
    /// Views that were kept by a name, in the order in which they are offered.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub views: Vec<NamedView>,
}

/// A camera that was kept by a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedView {
    /// What a person calls it.
    pub name: String,
    /// Position of the eye, m.
    pub eye: DVec3,
    /// The point in the middle of the picture, m.
    pub target: DVec3,
    /// What is up in the picture.
    pub up: DVec3,
    /// Vertical field of view, degrees.
    pub fov_deg: f64,
    /// Turn about the line of sight, degrees clockwise.
    #[serde(default)]
    pub roll_deg: f64,
}

impl NamedView {
    /// A camera by a name.
    pub fn new(name: &str, camera: &Camera) -> Self {
        Self {
            name: name.to_owned(),
            eye: camera.eye,
            target: camera.target,
            up: camera.up,
            fov_deg: camera.fov_deg,
            roll_deg: camera.roll_deg,
        }
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        Camera {
            eye: self.eye,
            target: self.target,
            up: self.up,
            fov_deg: self.fov_deg,
            roll_deg: self.roll_deg,
        }
    }
}

impl CameraSettings {
    /// This very camera from here on, whatever the flame's size; views that were kept stay.
    pub fn look_with(&mut self, camera: &Camera) {
        *self = Self {
            views: std::mem::take(&mut self.views),
            ..Self::from(camera)
        };
    }

    /// Frames the flame from here on; lens, roll and the views that were kept stay.
    pub fn frame_the_flame(&mut self) {
        (self.eye, self.target, self.up) = (None, None, None);
    }

    /// Keeps a camera by a name, in the place of one that had it.
    pub fn keep_view(&mut self, name: &str, camera: &Camera) {
        let view = NamedView::new(name, camera);
        match self.views.iter_mut().find(|known| known.name == name) {
            Some(known) => *known = view,
            None => self.views.push(view),
        }
    }
}

impl From<&Camera> for CameraSettings {
    /// This very camera, whatever the flame's size.
    fn from(camera: &Camera) -> Self {
        Self {
            eye: Some(camera.eye),
            target: Some(camera.target),
            up: Some(camera.up),
            fov_deg: Some(camera.fov_deg),
            roll_deg: (camera.roll_deg != 0.0).then_some(camera.roll_deg),
            views: Vec::new(),
        }
    }
}

/// A project whose every key is set: what lists of keys are held against.
#[cfg(test)]
pub(super) fn everything_set() -> Project {
    use crate::scene::{Interpolation, WavelengthSet};
    let field = |grid: &str| FieldSettings {
        grid: Some(grid.to_owned()),
        scale: Some(1e-7),
        offset: Some(-0.1),
        min: Some(0.0),
        max: Some(f64::INFINITY),
    };
    Project {
        volume: VolumeSettings {
            path: vec![PathBuf::from("a.vdb"), PathBuf::from("b \"quoted\".vdb")],
            built_in: BuiltIn::Burner,
            producer: Producer::Physical,
            up: Up::Y,
            voxel_size_m: Some(0.1 + 0.2),
            memory_limit_mb: Some(64.5),
            soot: field("soot"),
            smoke: field(""),
            flame: field("flames"),
            temperature: field("1"),
        },
        soot: SootSettings {
            asymmetry: Some(-0.25),
            ..SootSettings::default()
        },
        stage: StageSettings {
            ground: true,
            ground_height_m: Some(-0.1),
            spheres: vec![[0.1, 0.2, 0.3, 0.4]],
            logs: vec![[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [1.0; 7]],
            backdrop: BackdropKind::Picture,
            backdrop_distance_m: Some(2.5),
            backdrop_square_m: Some(0.25),
            backdrop_picture: Some(PathBuf::from("behind \"it\".png")),
            ..StageSettings::default()
        },
        camera: CameraSettings {
            eye: Some(DVec3::new(0.1, -2.0, 1e-300)),
            target: Some(DVec3::ZERO),
            up: Some(DVec3::Z),
            fov_deg: Some(40.0),
            roll_deg: Some(-12.5),
            views: vec![NamedView {
                name: "close \"up\"".to_owned(),
                eye: DVec3::new(0.1, -2.0, 0.3),
                target: DVec3::ZERO,
                up: DVec3::Z,
                fov_deg: 20.0,
                roll_deg: 3.0,
            }],
        },
        render: RenderSettings {
            size: [640, 360],
            quality: Quality::Final,
            target_error: Some(0.2),
            step_voxels: Some(0.5),
            wavelengths: Some(WavelengthSet::Fitted(8)),
            interpolation: Interpolation::Tricubic,
            samples_per_pixel: Some(4),
            scattering_orders: 1,
        },
        view: ViewSettings {
            display_white_cd_m2: Some(4e4),
            white_k: Some(2000.0),
            white_xy: Some([0.5, 0.4]),
            half_saturation_cd_m2: Some(1e5),
            ..ViewSettings::default()
        },
        ..Project::default()
    }
}
