//! Ground, spheres and logs.

use glam::DVec3;

/// A level plane that reaches everywhere; below it is nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// z of the plane, m.
    pub height_m: f64,
    /// Diffuse albedo: linear Rec. 709 red, green, blue, each 0 to 1.
    pub colour: [f64; 3],
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Its middle, m.
    pub centre: DVec3,
    /// Radius, m, above 0.
    pub radius_m: f64,
    /// Diffuse albedo: linear Rec. 709 red, green, blue, each 0 to 1.
    pub colour: [f64; 3],
}

/// A log: all points within a radius of a line (a capsule).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Log {
    /// Ends of its middle line, m; they may coincide.
    pub ends: [DVec3; 2],
    /// Radius, m, above 0.
    pub radius_m: f64,
    /// Diffuse albedo: linear Rec. 709 red, green, blue, each 0 to 1.
    pub colour: [f64; 3],
}
