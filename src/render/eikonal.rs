//! Bent paths of light: the ray equation of geometrical optics.
//!
//! ```text
//! d/ds (n dr/ds) = ∇n,   or   dr/ds = t,   dt/ds = (∇n − (∇n·t) t)/n
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | r | a point of the path, in the world | m |
//! | s | length along the path | m |
//! | t | its direction, a unit vector | 1 |
//! | n | refractive index; given as n − 1 | 1 |
//!
//! Integrated by the embedded pair of Bogacki and Shampine, of third order with an estimate of second: three evaluations
//! a step, for the last of a step is the first of the next. The step shrinks where the estimate exceeds the tolerance.
//!
//! Only the part of ∇n across the path counts, so total reflection is no special case: at a grazing angle the path turns
//! round smoothly. Where ∇n is zero nothing is added to t, and a straight ray keeps every bit of its direction; where
//! something is, its length is set back to 1.
//!
//! **Validity.** n varies little over a wavelength. Where ∇n jumps a step is only as accurate as it is short.
//!
//! **Sources.** M. Born and E. Wolf, *Principles of Optics*, 7th ed. (1999), section 3.2.1, eq. 2; P. Bogacki and L. F.
//! Shampine, Appl. Math. Lett. 2 (1989) 321; the choice of the step after E. Hairer, S. P. Nørsett and G. Wanner, *Solving
//! Ordinary Differential Equations I* (1993), section II.4.

use glam::DVec3;

use crate::math::Ray;

/// The refractive index at a point of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Index {
    /// n − 1.
    pub(super) refractivity: f64,
    /// ∇n, 1/m.
    pub(super) gradient: DVec3,
}

/// How accurate a step is, and how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tolerance {
    /// Greatest estimated error of a step in position, m.
    pub(super) position_m: f64,
    /// Greatest estimated error of a step in direction, rad.
    pub(super) direction_rad: f64,
    /// Longest step, m: nothing shorter is overlooked.
    pub(super) longest_m: f64,
}

/// By how much a step may change from one to the next, and how much shorter than the estimate says it is chosen: customary
/// (Hairer et al., eq. 4.13).
const SHRINK: f64 = 0.2;
const GROW: f64 = 5.0;
const SAFETY: f64 = 0.9;
/// Shortest step as a share of the longest: at a jump of ∇n the estimate never becomes small, and the path must go on.
const SHORTEST: f64 = 1e-4;

/// A path on its way.
pub(super) struct Path<F> {
    index: F,
    tolerance: Tolerance,
    /// Where it is, and where it goes.
    at: Ray,
    /// dt/ds there, 1/m.
    turn: DVec3,
    /// Length of the next step, m.
    step_m: f64,
}

impl<F: Fn(DVec3) -> Index> Path<F> {
    /// A path that begins as this ray does, whose direction is a unit vector, in a gas of this index.
    pub(super) fn new(index: F, ray: Ray, tolerance: Tolerance) -> Self {
        let turn = turn(&index(ray.origin), ray.direction);
        Self {
            index,
            tolerance,
            at: ray,
            turn,
            step_m: tolerance.longest_m,
        }
    }

    /// Where the path is, and its direction, a unit vector.
    pub(super) fn at(&self) -> Ray {
        self.at
    }

    /// Goes a step that keeps to the tolerance and is no longer than `limit_m`, above 0. Its length, m, above 0.
    pub(super) fn advance(&mut self, limit_m: f64) -> f64 {
        let Tolerance {
            position_m,
            direction_rad,
            longest_m,
        } = self.tolerance;
        let shortest_m = SHORTEST * longest_m;
        loop {
            let step_m = self.step_m.min(limit_m);
            let (end, turn, error) = self.tried(step_m);
            // What is estimated is not what is kept: the third-order end is.
            let excess =
                (error.origin.length() / position_m).max(error.direction.length() / direction_rad);
            let rejected = excess > 1.0 && step_m > shortest_m;
            // A step cut short by the limit says nothing against longer ones.
            if rejected || step_m == self.step_m {
                self.step_m = self.next_step(step_m, excess).max(shortest_m);
            }
            if !rejected {
                (self.at, self.turn) = (end, turn);
                return step_m;
            }
        }
    }

    /// The step after one whose estimated error is so many times the tolerance, m.
    fn next_step(&self, step_m: f64, excess: f64) -> f64 {
        let longest_m = self.tolerance.longest_m;
        // The usual case, and no root of it: a good step that could not be longer.
        if excess <= SAFETY.powi(3) && step_m >= longest_m {
            return longest_m;
        }
        let factor = if excess > 0.0 {
            (SAFETY / excess.cbrt()).clamp(SHRINK, GROW)
        } else {
            GROW
        };
        (step_m * factor).min(longest_m)
    }

    /// The end of a step, dt/ds there, and the estimated error of both parts.
    #[inline(always)]
    fn tried(&self, h: f64) -> (Ray, DVec3, Ray) {
        let Ray { origin, direction } = self.at;
        let slope = |origin: DVec3, direction: DVec3| turn(&(self.index)(origin), direction);

        // Half of the way, three quarters, all of it.
        let t1 = direction;
        let k1 = self.turn;
        let t2 = t1 + 0.5 * h * k1;
        let k2 = slope(origin + 0.5 * h * t1, t2);
        let t3 = t1 + 0.75 * h * k2;
        let k3 = slope(origin + 0.75 * h * t2, t3);
        let end_direction = t1 + h / 9.0 * (2.0 * k1 + 3.0 * k2 + 4.0 * k3);
        let end_origin = origin + h / 9.0 * (2.0 * t1 + 3.0 * t2 + 4.0 * t3);
        // A direction that nothing has turned keeps its bits.
        let end_direction = if end_direction == direction {
            direction
        } else {
            end_direction * end_direction.length_recip()
        };
        let t4 = end_direction;
        let k4 = slope(end_origin, t4);

        // The third order less the second.
        let less = |k: [DVec3; 4]| h / 72.0 * (-5.0 * k[0] + 6.0 * k[1] + 8.0 * k[2] - 9.0 * k[3]);
        let error = Ray {
            origin: less([t1, t2, t3, t4]),
            direction: less([k1, k2, k3, k4]),
        };
        let end = Ray {
            origin: end_origin,
            direction: end_direction,
        };
        (end, k4, error)
    }
}

/// dt/ds of a path of this direction, 1/m.
#[inline(always)]
fn turn(index: &Index, direction: DVec3) -> DVec3 {
    let across = index.gradient - index.gradient.dot(direction) * direction;
    across * (1.0 + index.refractivity).recip()
}

#[cfg(test)]
mod tests;
