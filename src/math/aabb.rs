//! Axis-aligned boxes and the slab test of a ray against one.

use glam::{DAffine3, DVec3};

use super::Ray;

/// A box between two corners, closed. Empty if any `min` exceeds its `max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: DVec3,
    /// Upper corner.
    pub max: DVec3,
}

impl Aabb {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// Whether no point is inside.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Edge lengths; zero for an empty box.
    pub fn size(&self) -> DVec3 {
        if self.is_empty() {
            DVec3::ZERO
        } else {
            self.max - self.min
        }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The smallest box around this one's image under an affine map.
    #[must_use]
    pub fn transformed(&self, to_from: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        self.corners().fold(Self::EMPTY, |hull, corner| {
            let image = to_from.transform_point3(corner);
            Self {
                min: hull.min.min(image),
                max: hull.max.max(image),
            }
        })
    }

    /// The eight corners.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..8).map(|corner| {
            let pick = |axis: usize| {
                if corner >> axis & 1 == 0 {
                    self.min[axis]
                } else {
                    self.max[axis]
                }
            };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// The part `[t_enter, t_exit]` of the ray inside the box, clipped to `t ≥ 0` (the eye may be inside).
    ///
    /// A ray parallel to a face is not constrained by it when it runs between the two faces, and misses
    /// otherwise; nothing is divided by a zero component, so no 0·∞ arises. `None` for a miss; a graze of an
    /// edge gives an interval of length zero.
    pub fn intersect(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (mut t_enter, mut t_exit) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (self.min[axis], self.max[axis]);
            if direction == 0.0 {
                if origin < low || origin > high {
                    return None;
                }
                continue;
            }
            let (near, far) = ((low - origin) / direction, (high - origin) / direction);
            t_enter = t_enter.max(near.min(far));
            t_exit = t_exit.min(near.max(far));
        }
        (t_enter <= t_exit && t_exit.is_finite()).then_some((t_enter, t_exit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Aabb = Aabb {
        min: DVec3::ZERO,
        max: DVec3::ONE,
    };

    fn hit(origin: [f64; 3], direction: [f64; 3]) -> Option<(f64, f64)> {
        UNIT.intersect(&Ray {
            origin: origin.into(),
            direction: direction.into(),
        })
    }

    #[test]
    fn a_ray_through_the_box_gives_its_chord() {
        assert_eq!(hit([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0]), Some((1.0, 2.0)));
    }

    #[test]
    fn an_eye_inside_starts_at_zero() {
        assert_eq!(hit([0.25, 0.5, 0.5], [1.0, 0.0, 0.0]), Some((0.0, 0.75)));
    }

    #[test]
    fn a_ray_in_the_plane_of_a_face_touches_and_one_outside_misses() {
        assert_eq!(hit([-1.0, 0.0, 0.5], [1.0, 0.0, -0.0]), Some((1.0, 2.0)));
        assert_eq!(hit([-1.0, -1e-9, 0.5], [1.0, -0.0, 0.0]), None);
    }

    #[test]
    fn a_graze_of_an_edge_has_length_zero() {
        let diagonal = DVec3::new(1.0, -1.0, 0.0).normalize().to_array();
        let (enter, exit) = hit([-1.0, 1.0, 0.5], diagonal).unwrap_or((0.0, f64::NAN));
        assert!((exit - enter).abs() < 1e-15);
    }

    #[test]
    fn a_box_behind_the_eye_is_missed() {
        assert_eq!(hit([2.0, 0.5, 0.5], [1.0, 0.0, 0.0]), None);
    }
}
