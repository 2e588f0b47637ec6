//! What is behind everything: a shining screen that faces the camera.

use std::sync::Arc;

/// A screen that faces the camera and fills its picture, so far behind the point that the camera looks at. It shines by
/// itself, the same into all directions, and lights nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Backdrop {
    /// What is on it.
    pub pattern: Pattern,
    /// Distance behind the camera's target along the line of sight, m, above 0.
    pub distance_m: f64,
    /// Luminance of its white, cd m⁻², at least 0.
    pub luminance_cd_m2: f64,
}

/// What is on a backdrop.
#[derive(Debug, Clone, PartialEq)]
pub enum Pattern {
    /// Squares of white and a tenth of it.
    Checker {
        /// Edge of a square, m, above 0.
        square_m: f64,
    },
    /// From black at the lower edge of the picture to white at the upper one, evenly in luminance.
    Gradient,
    /// A picture, fitted to the frame's height.
    Picture(Arc<BackdropPicture>),
}

/// Pixels of a picture on a backdrop.
#[derive(Debug, Clone, PartialEq)]
pub struct BackdropPicture {
    /// Width and height in pixels, both at least 1.
    pub size: [u32; 2],
    /// Linear Rec. 709 red, green, blue, row by row from the top; white is 1.
    pub pixels: Vec<[f32; 3]>,
}
