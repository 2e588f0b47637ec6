//! Why a project cannot become a picture.

use thiserror::Error;

use crate::render::SettingsError;
use crate::scene::PackingError;
use crate::scene::camera::CameraError;

/// Why a project cannot be rendered.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// A number lies outside its range.
    #[error("{key} is {value}: it must lie between {min} and {max}")]
    Range {
        /// Dotted key of the scene file.
        key: &'static str,
        /// What was set.
        value: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
    },
    /// A factor or an offset is no number.
    #[error("{key} is {value}: it must be a finite number")]
    NotFinite {
        /// Dotted key of the scene file.
        key: String,
        /// What was set.
        value: f64,
    },
    /// A field could become what no gas can be.
    #[error("{key} is {value}: it must lie between 0 and {greatest}")]
    FieldRange {
        /// Dotted key of the scene file.
        key: String,
        /// What was set.
        value: f64,
        /// Greatest allowed.
        greatest: f64,
    },
    /// Nothing lies between a field's bounds.
    #[error(
        "{key} is {min}, which is not below the greatest value {max}: give a min that is at most max"
    )]
    NoInterval {
        /// Dotted key of the scene file.
        key: String,
        /// The least value.
        min: f64,
        /// The greatest value.
        max: f64,
    },
    /// A field names a grid that the file does not have.
    #[error("{key} is \"{name}\", but the file has {available}{hint}")]
    NoSuchGrid {
        /// Dotted key of the scene file.
        key: String,
        /// What was set.
        name: String,
        /// The grids there are.
        available: String,
        /// "; did you mean …?" or nothing.
        hint: String,
    },
    /// Nothing in the file can glow or absorb.
    #[error(
        "nothing to render: no grid is mapped to soot or smoke. The file has {available}; set volume.soot.grid"
    )]
    NothingToRender {
        /// The grids there are.
        available: String,
    },
    /// A number of the render section.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The fields cannot be packed side by side.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// The camera cannot see.
    #[error(transparent)]
    Camera(#[from] CameraError),
}
