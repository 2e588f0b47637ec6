//! A backdrop in its place before one camera.
//!
//! The screen is the plane across the line of sight, so far behind the camera's target. It fills the frame and goes on
//! beyond it, for rays that the fire has bent may meet it there: squares go on, the gradient stays black or white, around
//! a picture is nothing.
//!
//! Its luminance is that of display white times what the pattern has there; as X, Y, Z that is
//! M · rgb · luminance / K_m, with M the matrix of Rec. 709 whose white is D65.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::backdrop::{Backdrop, BackdropPicture, Pattern};
use crate::colour::cie::MAX_LUMINOUS_EFFICACY;
use crate::colour::xyz;
use crate::math::Ray;
use crate::scene::camera::{Camera, CameraError};

/// Luminance of a dark square in units of a white one: a tenth, so that what lies before it is still seen against it.
const DARK_SQUARE: f64 = 0.1;

/// A backdrop in its place before one camera.
#[derive(Debug, Clone)]
pub struct Screen {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Distance from the eye along the line of sight, m.
    depth_m: f64,
    /// Half width and half height of the frame on the screen, m.
    half_m: [f64; 2],
    /// Width and height of the frame in pixels.
    size: [f64; 2],
    pattern: Pattern,
    /// From linear Rec. 709 to W m⁻² sr⁻¹.
    xyz_from_rgb: DMat3,
}

impl Backdrop {
    /// The screen that faces a camera, for a picture of `size` pixels.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn facing(&self, camera: &Camera, size: [u32; 2]) -> Result<Screen, CameraError> {
        let [forward, right, up] = camera.basis()?;
        let depth_m = (camera.target - camera.eye).dot(forward) + self.distance_m;
        let size = size.map(f64::from);
        let half_height = depth_m * (0.5 * camera.fov_deg).to_radians().tan();
        Ok(Screen {
            eye: camera.eye,
            forward,
            right,
            up,
            depth_m,
            half_m: [half_height * size[0] / size[1], half_height],
            size,
            pattern: self.pattern.clone(),
            xyz_from_rgb: xyz::xyz_from_rgb() * (self.luminance_cd_m2 / MAX_LUMINOUS_EFFICACY),
        })
    }
}

impl Screen {
    /// X, Y, Z of what a ray sees on the screen, W m⁻² sr⁻¹; black where it meets none of it.
    pub fn xyz(&self, ray: &Ray) -> [f64; 3] {
        let Some(place) = self.place(ray) else {
            return [0.0; 3];
        };
        let rgb = match &self.pattern {
            Pattern::Checker { square_m } => DVec3::splat(self.checker(place, *square_m)),
            Pattern::Gradient => {
                DVec3::splat((0.5 * (1.0 + place[1] / self.half_m[1])).clamp(0.0, 1.0))
            }
            Pattern::Picture(picture) => self.picture(picture, place),
        };
        (self.xyz_from_rgb * rgb).to_array()
    }

    /// Where on the picture (pixels from the upper left corner) the point of the screen that a ray meets would be seen if
    /// light went straight; `None` where it meets none.
    pub fn pixel(&self, ray: &Ray) -> Option<[f64; 2]> {
        let [x, y] = self.place(ray)?;
        Some([
            0.5 * (1.0 + x / self.half_m[0]) * self.size[0],
            0.5 * (1.0 - y / self.half_m[1]) * self.size[1],
        ])
    }

    /// Where a ray meets the screen: m to the right of and above the middle of the frame.
    fn place(&self, ray: &Ray) -> Option<[f64; 2]> {
        let from_eye = ray.origin - self.eye;
        let t = (self.depth_m - from_eye.dot(self.forward)) / ray.direction.dot(self.forward);
        (t.is_finite() && t >= 0.0).then(|| {
            let point = from_eye + t * ray.direction;
            [point.dot(self.right), point.dot(self.up)]
        })
    }

    /// Mean of the squares over a pixel of the frame around a place. Each square is the product of a square wave of ±1
    /// along each axis, so the mean is, too.
    fn checker(&self, place: [f64; 2], square_m: f64) -> f64 {
        let pixel = 2.0 * self.half_m[1] / self.size[1] / square_m;
        let sign = |square: f64| 1.0 - 2.0 * square.rem_euclid(2.0);
        let wave = |at: f64| {
            let [low, high] = [-0.5, 0.5].map(|side| at / square_m + side * pixel);
            let [first, last] = [low.floor(), high.floor()];
            // Of a pixel that is next to nothing beside a square, a difference of integrals would leave no digit.
            if first == last {
                sign(first)
            } else if last - first == 1.0 {
                sign(last) * ((high - last) - (last - low)) / (high - low)
            } else {
                (triangle(high) - triangle(low)) / pixel
            }
        };
        let white = 0.5 * (1.0 + wave(place[0]) * wave(place[1]));
        DARK_SQUARE + (1.0 - DARK_SQUARE) * white
    }

    /// Between the four pixels of a picture around a place; black outside.
    fn picture(&self, picture: &Arc<BackdropPicture>, [x, y]: [f64; 2]) -> DVec3 {
        let [width, height] = picture.size.map(f64::from);
        let pixels_per_m = height / (2.0 * self.half_m[1]);
        let across = 0.5 * width + x * pixels_per_m;
        let down = 0.5 * height - y * pixels_per_m;
        if !((0.0..=width).contains(&across) && (0.0..=height).contains(&down)) {
            return DVec3::ZERO;
        }
        let pixel = |column: f64, row: f64| {
            let column = column.clamp(0.0, width - 1.0) as usize;
            let row = row.clamp(0.0, height - 1.0) as usize;
            let found = picture.pixels.get(row * picture.size[0] as usize + column);
            found.map_or(DVec3::ZERO, |rgb| DVec3::from(rgb.map(f64::from)))
        };
        let (left, top) = ((across - 0.5).floor(), (down - 0.5).floor());
        let [u, v] = [across - 0.5 - left, down - 0.5 - top];
        let row = |row: f64| pixel(left, row).lerp(pixel(left + 1.0, row), u);
        row(top).lerp(row(top + 1.0), v)
    }
}

/// The integral from 0 of a wave that is 1 from 0 to 1, −1 from 1 to 2 and so on.
fn triangle(at: f64) -> f64 {
    1.0 - (at.rem_euclid(2.0) - 1.0).abs()
}
