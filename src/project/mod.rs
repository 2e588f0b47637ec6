//! All that a person can set: the scene file.
//!
//! A [`Project`] is plain data, written and read as TOML ([`mod@file`]), changed key by key ([`set`]), and turned
//! into what the floors below take: [`Project::job`] for the renderer, [`Project::view`] for the picture.

mod accuracy;
mod backdrops;
mod check;
mod darkness;
mod error;
mod fields;
pub mod file;
mod idle;
pub mod job;
pub mod one_or_many;
mod pasted;
mod presets;
pub mod ranges;
pub mod set;
pub mod settings;
mod stage;

pub use accuracy::Accuracy;
pub use backdrops::{Backdrops, PictureError};
pub use darkness::{Darkness, Mend};
pub use error::ProjectError;
pub use idle::{Control, why_idle};
pub use job::Job;
pub use presets::{PRESETS, Preset, THUMBNAIL};
pub use settings::{
    AirSettings, BackdropKind, CameraSettings, FieldSettings, FuelSettings, NamedView, Project,
    Quality, RenderSettings, Saturation, SmokeSettings, SootSettings, StageSettings, Up,
    ViewSettings, VolumeSettings,
};
pub use stage::StageDefaults;
