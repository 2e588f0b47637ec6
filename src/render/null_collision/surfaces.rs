//! The stage as a path meets it: surfaces that stop light and send it back evenly (Lambert).
//!
//! A direction drawn with the density cos θ/π carries the radiance ρ L on: the cosine and the π of reflection are in the
//! density.

use std::f64::consts::TAU;

use crate::math::Ray;
use crate::math::random::Stream;
use crate::scene::Stage;
use crate::scene::stage::Hit;

/// The surfaces of one stage.
pub(super) struct Surfaces<'a> {
    stage: &'a Stage,
    max_reflections: u32,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(stage: &'a Stage, max_reflections: u32) -> Self {
        Self {
            stage,
            max_reflections,
        }
    }

    /// The surface that a ray meets.
    pub(super) fn hit(&self, ray: &Ray) -> Option<Hit> {
        self.stage.hit(ray, f64::INFINITY)
    }

    /// Whether light that has been reflected so often may be once more.
    pub(super) fn may_reflect(&self, reflections: u32) -> bool {
        reflections < self.max_reflections
    }
}

/// The ray on from a surface, its direction drawn with the density cos θ/π.
pub(super) fn reflected(hit: &Hit, random: &mut Stream) -> Ray {
    let share = random.uniform();
    let (up, across) = (TAU * random.uniform()).sin_cos();
    let (u, v) = hit.normal.any_orthonormal_pair();
    let sine = share.sqrt();
    let direction = (1.0 - share).sqrt() * hit.normal + sine * (across * u + up * v);
    Ray {
        origin: hit.point,
        direction: direction.normalize(),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn light_goes_on_by_the_cosine() {
        // Of ∫ cos θ · cos θ/π dω the mean is 2/3, of its square 1/2.
        let normal = DVec3::new(0.6, -0.48, 0.64);
        let hit = Hit {
            distance_m: 1.0,
            point: DVec3::ONE,
            normal,
            colour: [1.0; 3],
        };
        let mut random = Stream::new(3, [0, 0], 0);
        let count = 20_000;
        let (mut mean, mut square) = (DVec3::ZERO, 0.0);
        for _ in 0..count {
            let ray = reflected(&hit, &mut random);
            assert!(ray.direction.dot(normal) >= 0.0 && ray.origin == hit.point);
            mean += ray.direction / f64::from(count);
            square += ray.direction.dot(normal).powi(2) / f64::from(count);
        }
        let five_errors = 5.0 / f64::from(count).sqrt();
        assert!(
            (mean - normal * (2.0 / 3.0)).length() < five_errors,
            "{mean}"
        );
        assert!((square - 0.5).abs() < five_errors, "{square}");
    }
}
