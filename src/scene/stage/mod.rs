//! What stands around the fire: ground, spheres and logs that its light falls on, and a backdrop behind everything.
//!
//! Surfaces are matt: they send what falls on them evenly into all directions (Lambert). They do not glow, light does
//! not go from one to another, and the fire's gas flows through them as if they were not there.
//!
//! `shapes` say what there is, `meet` where a ray meets it, `shadow` what it hides of a small luminous ball,
//! `shadows` what may be in the way at all.

use glam::DVec3;

use crate::math::Ray;

mod backdrop;
mod meet;
mod screen;
mod shadow;
mod shadows;
mod shapes;

pub use backdrop::{Backdrop, BackdropPicture, Pattern};
pub use screen::Screen;
pub use shadows::Shadows;
pub use shapes::{Ground, Log, Sphere};

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray, m.
    pub distance_m: f64,
    /// The point, m: a billionth of the lengths that went into it before the surface, on the side that the ray comes
    /// from, so that a ray that goes on from here does not meet the same surface again.
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

    /// The first surface that a ray meets before a distance (m, may be infinite). From below the ground is not there;
    /// from inside a sphere or a log its inner side is.
    pub fn hit(&self, ray: &Ray, limit_m: f64) -> Option<Hit> {
        let ground = self.ground.iter().filter_map(|ground| ground.meet(ray));
        let spheres = self.spheres.iter().filter_map(|sphere| sphere.meet(ray));
        let logs = self.logs.iter().filter_map(|log| log.meet(ray));
        ground
            .chain(spheres)
            .chain(logs)
            .filter(|hit| hit.distance_m < limit_m)
            .min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
    }

    /// What of the stage may throw a shadow on a point of a surface with a unit normal where all light comes from within a
    /// ball (its centre and radius, m).
    pub fn shadows_at(&self, point: DVec3, normal: DVec3, lights: (DVec3, f64)) -> Shadows {
        Shadows::new(self, point, normal, lights)
    }

    /// How much of the light of a small luminous ball (radius in m), 0 to 1, comes past what stands on the stage to a point
    /// of a surface with a unit normal. The surface's own horizon is left to the cosine.
    pub fn visibility(&self, from: DVec3, normal: DVec3, to: DVec3, radius_m: f64) -> f64 {
        self.shadows_at(from, normal, (to, radius_m))
            .visibility(to, radius_m)
    }

    /// Whether anything can be seen through the fire.
    pub fn shows_behind(&self) -> bool {
        self.has_surfaces() || self.backdrop.is_some()
    }
}

#[cfg(test)]
mod tests;
