//! Geometry and arithmetic that know nothing of fire: rays, boxes, lanes.

pub mod aabb;
pub mod lanes;
pub mod ray;

pub use aabb::Aabb;
pub use ray::Ray;
