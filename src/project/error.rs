//! Why a project cannot become a picture.

use thiserror::Error;

use super::backdrops::PictureError;
use super::ranges::MOST_SHAPES;
use crate::physics::moist_air::AirError;
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
    /// A field names a grid that was left unread when the file was opened.
    #[error("{key} is \"{name}\", which was not read from the file: open the file again")]
    GridNotRead {
        /// Dotted key of the scene file.
        key: String,
        /// What was set.
        name: String,
    },
    /// Nothing in the file can glow or absorb.
    #[error(
        "nothing to render: no grid is mapped to soot or smoke. The file has {available}; set volume.soot.grid"
    )]
    NothingToRender {
        /// The grids there are.
        available: String,
    },
    /// A shape on the stage is nowhere, or has no size.
    #[error(
        "{key}: the {what} of {name} {number} is {value} m: it must lie between {min} and {max} m"
    )]
    Shape {
        /// Dotted key of the scene file.
        key: &'static str,
        /// What the list is of.
        name: &'static str,
        /// Which of the list, counted from 1.
        number: usize,
        /// Which of its numbers.
        what: &'static str,
        /// What was set.
        value: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
    },
    /// A list of shapes is too long.
    #[error(
        "{key} has {count} entries: at most {MOST_SHAPES} of a kind can stand on the stage; take some away"
    )]
    TooManyShapes {
        /// Dotted key of the scene file.
        key: &'static str,
        /// How many were set.
        count: usize,
    },
    /// A backdrop of a picture that is not named.
    #[error(
        "stage.backdrop is picture, but no picture is named: set stage.backdrop_picture to a PNG file"
    )]
    NoPicture,
    /// The backdrop's picture cannot be had.
    #[error("stage.backdrop_picture: {0}")]
    Picture(#[from] PictureError),
    /// The air cannot be as it is set.
    #[error("{0} (air.humidity, air.temperature_k, air.pressure_pa)")]
    Air(#[from] AirError),
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
