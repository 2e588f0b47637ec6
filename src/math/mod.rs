//! Geometry and arithmetic that know nothing of fire: rays, boxes, lanes, whole and random numbers.

pub mod aabb;
mod coprime;
pub mod lanes;
pub mod random;
pub mod ray;

pub use aabb::Aabb;
pub use coprime::{are_coprime, coprime_from};
pub use ray::Ray;
