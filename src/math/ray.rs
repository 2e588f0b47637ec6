//! A half-line in f64: where a path of light is followed from the eye outwards.

use glam::{DAffine3, DVec3};

/// A ray `origin + t · direction`, `t ≥ 0`.
///
/// The direction made by [`Ray::new`] is a unit vector, so `t` is a length in the units of the frame. After
/// [`Ray::transformed`] it is not: `t` keeps meaning the length in the *old* frame, which is what lets a march
/// in voxel coordinates count in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: DVec3,
    /// Change of position per unit of `t`.
    pub direction: DVec3,
}

impl Ray {
    /// A ray from `origin` along `direction`, normalised once here. `None` if the direction has no finite,
    /// non-zero length.
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        direction
            .try_normalize()
            .map(|direction| Self { origin, direction })
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// The same points in another frame; `t` keeps its meaning.
    #[must_use]
    pub fn transformed(&self, to_from: &DAffine3) -> Self {
        Self {
            origin: to_from.transform_point3(self.origin),
            direction: to_from.transform_vector3(self.direction),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_without_length_is_refused() {
        assert!(Ray::new(DVec3::ZERO, DVec3::ZERO).is_none());
        assert!(Ray::new(DVec3::ZERO, DVec3::new(f64::NAN, 0.0, 1.0)).is_none());
    }

    #[test]
    fn a_transform_keeps_the_meaning_of_t() {
        let scale = DAffine3::from_scale(DVec3::splat(4.0));
        let ray = Ray {
            origin: DVec3::X,
            direction: DVec3::Z,
        };
        assert_eq!(
            ray.transformed(&scale).at(2.0),
            scale.transform_point3(ray.at(2.0))
        );
    }
}
