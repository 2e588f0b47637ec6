//! Geometry and arithmetic that know nothing of fire: rays, boxes, lanes, random numbers.

pub mod aabb;
pub mod lanes;
pub mod random;
pub mod ray;

pub use aabb::Aabb;
pub use ray::Ray;
