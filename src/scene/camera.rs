//! A pinhole camera in a world of metres with z up.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::math::{Aabb, Ray};

/// Where the eye is and how it looks.
///
/// Row 0 of a picture is its top; pixels are square; the field of view is that of the picture's height.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Position of the eye, m.
    pub eye: DVec3,
    /// The point in the middle of the picture, m.
    pub target: DVec3,
    /// The direction that is up in the picture; need not be perpendicular to the line of sight.
    pub up: DVec3,
    /// Vertical field of view, degrees, 0 < fov < 180.
    pub fov_deg: f64,
    /// By how much the camera is turned about its line of sight, degrees clockwise as it looks: the picture turns the other way.
    #[serde(default)]
    pub roll_deg: f64,
}

/// Why a camera cannot see.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A coordinate is NaN or infinite.
    #[error("camera: a coordinate is not a finite number")]
    NotFinite,
    /// Eye and target coincide.
    #[error("camera.eye and camera.target are the same point: move one of them")]
    NoDirection,
    /// Up is zero or along the line of sight.
    #[error("camera.up is zero or points along the line of sight: choose another direction")]
    NoUp,
    /// The field of view is outside its range.
    #[error("camera.fov_deg is {0}: it must lie between 0.01 and 179 degrees")]
    FieldOfView(f64),
}

/// Field of view of a camera that frames a box: a 50 mm lens on a 24 mm high frame sees 27°; 32° keeps a fire's
/// depth without its perspective becoming a caricature.
pub const FRAMING_FOV_DEG: f64 = 32.0;

/// How much wider than the box a framing is, so that the flame does not touch the picture's edge.
pub(super) const FRAMING_MARGIN: f64 = 1.12;

/// Least and greatest vertical field of view, degrees.
pub const FOV_RANGE_DEG: [f64; 2] = [0.01, 179.0];

/// Half the height of the frame that focal lengths are given for, mm: still film of 36 × 24 mm.
const HALF_FRAME_MM: f64 = 12.0;

/// Focal length in mm of a lens that sees the vertical field of view (degrees, 0 < fov < 180) on a frame of
/// 36 × 24 mm.
pub fn focal_length_mm(fov_deg: f64) -> f64 {
    HALF_FRAME_MM / (0.5 * fov_deg).to_radians().tan()
}

/// Vertical field of view in degrees of a lens of this focal length (mm, above 0) on a frame of 36 × 24 mm.
pub fn fov_deg(focal_length_mm: f64) -> f64 {
    2.0 * (HALF_FRAME_MM / focal_length_mm).atan().to_degrees()
}

/// Middle and size of a box that may be flat or empty, with room for a camera to look at.
pub(super) fn room_of(bounds: &Aabb) -> (DVec3, DVec3) {
    let centre = if bounds.is_empty() {
        DVec3::ZERO
    } else {
        bounds.centre()
    };
    (centre, bounds.size().max(DVec3::splat(1e-6)))
}

/// An orthonormal basis of the picture: forward, right, up.
#[derive(Debug, Clone, Copy)]
pub struct View {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half height and half width of the picture at distance 1.
    half: [f64; 2],
    size: [u32; 2],
}

impl Camera {
    /// A camera at the side of a box (looking along +y), that sees all of it in a picture of the given
    /// width/height with a vertical field of view in degrees.
    pub fn framing(bounds: &Aabb, aspect: f64, fov_deg: f64) -> Self {
        let (centre, size) = room_of(bounds);
        let half_tan = (0.5 * fov_deg).to_radians().tan();
        let half_height = FRAMING_MARGIN * 0.5 * size.z.max(size.x / aspect);
        let distance = half_height / half_tan + 0.5 * size.y;
        Self {
            eye: centre - DVec3::Y * distance,
            target: centre,
            up: DVec3::Z,
            fov_deg,
            roll_deg: 0.0,
        }
    }

    /// This camera's basis for a picture of `size` = width, height in pixels (both at least 1).
    ///
    /// # Errors
    /// [`CameraError`] names the first thing that keeps the camera from seeing.
    pub fn view(&self, size: [u32; 2]) -> Result<View, CameraError> {
        let [forward, right, up] = self.basis()?;
        let half_height = (0.5 * self.fov_deg).to_radians().tan();
        let half_width = half_height * f64::from(size[0]) / f64::from(size[1]);
        Ok(View {
            eye: self.eye,
            forward,
            right,
            up,
            half: [half_width, half_height],
            size,
        })
    }

    /// Unit vectors forward, right and up of the picture.
    ///
    /// # Errors
    /// [`CameraError`] names the first thing that keeps the camera from seeing.
    pub(super) fn basis(&self) -> Result<[DVec3; 3], CameraError> {
        let points = [self.eye, self.target, self.up];
        if !(points.iter().all(|point| point.is_finite()) && self.roll_deg.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if !(FOV_RANGE_DEG[0]..=FOV_RANGE_DEG[1]).contains(&self.fov_deg) {
            return Err(CameraError::FieldOfView(self.fov_deg));
        }
        let forward = (self.target - self.eye)
            .try_normalize()
            .ok_or(CameraError::NoDirection)?;
        let sideways = forward.cross(self.up.try_normalize().ok_or(CameraError::NoUp)?);
        if sideways.length() < 1e-9 {
            return Err(CameraError::NoUp);
        }
        let upright = sideways.normalize();
        let (sin, cos) = self.roll_deg.to_radians().sin_cos();
        let right = cos * upright - sin * upright.cross(forward);
        Ok([forward, right, right.cross(forward)])
    }
}

impl View {
    /// The ray through a point of the picture in pixels from its upper left corner; pixel centres are at
    /// halves.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let across = (2.0 * x / f64::from(self.size[0]) - 1.0) * self.half[0];
        let upwards = (1.0 - 2.0 * y / f64::from(self.size[1])) * self.half[1];
        let direction = self.forward + across * self.right + upwards * self.up;
        Ray {
            origin: self.eye,
            direction: direction.normalize(),
        }
    }

    /// A vector of the world from the eye (m): along the picture's width and height in pixels times the third number, which
    /// is how far it goes forward, m. The point of the picture is the first two over the third, where that is above 0.
    pub(crate) fn seen(&self, from_eye: DVec3) -> DVec3 {
        let forward = from_eye.dot(self.forward);
        let [half_width, half_height] = self.half;
        let [width, height] = self.size.map(f64::from);
        let across = from_eye.dot(self.right) / half_width;
        let upwards = from_eye.dot(self.up) / half_height;
        DVec3::new(
            0.5 * width * (forward + across),
            0.5 * height * (forward - upwards),
            forward,
        )
    }

    /// Where the eye is, m.
    pub(crate) fn eye(&self) -> DVec3 {
        self.eye
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn a_point_is_seen_where_its_ray_goes_through_the_picture() {
        let camera = Camera {
            eye: DVec3::new(1.0, -3.0, 2.0),
            target: DVec3::new(0.2, 0.5, 0.1),
            up: DVec3::new(0.1, 0.0, 1.0),
            fov_deg: 50.0,
            roll_deg: 0.0,
        };
        let view = camera.view([300, 200]).unwrap();
        for (x, y, far) in [(0.0, 0.0, 0.1), (150.0, 100.0, 7.0), (299.5, 3.25, 2.0)] {
            let ray = view.ray(x, y);
            let seen = view.seen(far * ray.direction);
            let [at_x, at_y] = [seen.x / seen.z, seen.y / seen.z];
            assert!((at_x - x).abs() + (at_y - y).abs() < 1e-9, "{at_x} {at_y}");
            assert!(seen.z > 0.0 && view.seen(-ray.direction).z < 0.0);
        }
    }

    #[test]
    fn the_centre_looks_at_the_target_and_row_zero_is_on_top() {
        let camera = Camera {
            eye: DVec3::new(1.0, -3.0, 0.5),
            target: DVec3::ZERO,
            up: DVec3::Z,
            fov_deg: 40.0,
            roll_deg: 0.0,
        };
        let view = camera.view([200, 100]).unwrap();
        let forward = (camera.target - camera.eye).normalize();
        assert!(view.ray(100.0, 50.0).direction.abs_diff_eq(forward, 1e-15));
        assert!(view.ray(100.0, 0.0).direction.z > forward.z);
        let top = view
            .ray(100.0, 0.0)
            .direction
            .angle_between(forward)
            .to_degrees();
        assert!((top - 20.0).abs() < 1e-6);
    }

    #[test]
    fn a_framing_sees_every_corner() {
        let bounds = Aabb {
            min: DVec3::new(-1.0, 2.0, 0.0),
            max: DVec3::new(0.5, 3.0, 4.0),
        };
        for aspect in [0.3, 1.0, 16.0 / 9.0] {
            for fov_deg in [FRAMING_FOV_DEG, 10.0, 100.0] {
                let camera = Camera::framing(&bounds, aspect, fov_deg);
                assert_eq!(camera.fov_deg, fov_deg);
                let forward = (camera.target - camera.eye).normalize();
                let half = (0.5 * camera.fov_deg).to_radians().tan();
                for corner in bounds.corners() {
                    let to = corner - camera.eye;
                    let depth = to.dot(forward);
                    assert!((to.z - forward.z * depth).abs() / depth <= half);
                    assert!((to.x - forward.x * depth).abs() / depth <= half * aspect);
                }
            }
        }
    }

    #[test]
    fn a_lens_and_its_field_of_view_are_two_names_of_one_thing() {
        // A right angle on a frame 24 mm high, and the usual lens of the box that framings are based on.
        assert!((focal_length_mm(90.0) - 12.0).abs() < 1e-12);
        assert!((fov_deg(50.0) - 26.991_466).abs() < 1e-6);
        for mm in [8.0, 24.0, 50.0, 400.0] {
            assert!((focal_length_mm(fov_deg(mm)) - mm).abs() < 1e-9 * mm);
        }
    }

    #[test]
    fn blind_cameras_say_why() {
        let good = Camera::framing(
            &Aabb {
                min: DVec3::ZERO,
                max: DVec3::ONE,
            },
            1.0,
            FRAMING_FOV_DEG,
        );
        let size = [8, 8];
        assert_eq!(
            Camera {
                eye: good.target,
                ..good
            }
            .view(size)
            .unwrap_err(),
            CameraError::NoDirection
        );
        assert_eq!(
            Camera {
                up: DVec3::Y,
                ..good
            }
            .view(size)
            .unwrap_err(),
            CameraError::NoUp
        );
        assert_eq!(
            Camera {
                fov_deg: 180.0,
                ..good
            }
            .view(size)
            .unwrap_err(),
            CameraError::FieldOfView(180.0)
        );
        let lost = Camera {
            eye: DVec3::new(f64::NAN, 0.0, 0.0),
            ..good
        };
        assert_eq!(lost.view(size).unwrap_err(), CameraError::NotFinite);
    }
}
