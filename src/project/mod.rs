//! All that a person can set: the scene file.
//!
//! A [`Project`] is plain data, written and read as TOML ([`mod@file`]), changed key by key ([`set`]), and turned
//! into what the floors below take: [`Project::job`] for the renderer, [`Project::view`] for the picture.

mod error;
mod fields;
pub mod file;
pub mod job;
pub mod one_or_many;
pub mod set;
pub mod settings;

pub use error::ProjectError;
pub use job::Job;
pub use settings::{
    AirSettings, CameraSettings, FieldSettings, FuelSettings, Project, Quality, RenderSettings,
    SmokeSettings, SootSettings, ViewSettings, VolumeSettings,
};
