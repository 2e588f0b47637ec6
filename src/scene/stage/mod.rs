//! What stands around the fire: ground, spheres and logs that its light falls on, and a backdrop behind everything.
//!
//! Surfaces are matt: they send what falls on them evenly into all directions (Lambert). They do not glow, light does
//! not go from one to another, and the fire's gas flows through them as if they were not there.

use glam::DVec3;

use crate::math::Ray;

mod backdrop;
mod shapes;

pub use backdrop::{Backdrop, BackdropPicture, Pattern, Screen};
pub use shapes::{Ground, Log, Sphere};

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray, m.
    pub distance_m: f64,
    /// The point, m.
    pub point: DVec3,
    /// Unit normal on the side that the ray comes from.
    pub normal: DVec3,
    /// Diffuse albedo: linear Rec. 709 red, green, blue.
    pub colour: [f64; 3],
}

/// What stands around the fire, in the world of metres with z up. Empty by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stage {
    /// The ground.
    pub ground: Option<Ground>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
    /// Logs: capsules.
    pub logs: Vec<Log>,
    /// What is behind everything.
    pub backdrop: Option<Backdrop>,
}

impl Stage {
    /// Whether the fire's light can fall on anything.
    pub fn has_surfaces(&self) -> bool {
        self.ground.is_some() || !self.spheres.is_empty() || !self.logs.is_empty()
    }

    /// The first surface that a ray meets before a distance (m, may be infinite).
    pub fn hit(&self, ray: &Ray, limit_m: f64) -> Option<Hit> {
        let _ = (ray, limit_m);
        None
    }

    /// Whether anything can be seen through the fire.
    pub fn shows_behind(&self) -> bool {
        self.has_surfaces() || self.backdrop.is_some()
    }
}
