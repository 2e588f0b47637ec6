//! Soft shadows without random numbers: how much of a small luminous ball is seen past an object.
//!
//! The beam from a point P to a ball of radius R around Q is a cone. At the share s of its way it is sR wide, so an
//! object whose surface keeps the distance c(s) from the axis hides nothing where c ≥ sR and all where c ≤ −sR. With
//!
//! ```text
//! x = min over 0 < s ≤ 1 of c(s)/(sR)         clearance
//! F(x) = (2 + 3x − x³)/4                      share of a ball on one side of a plane, −1 ≤ x ≤ 1
//! hidden = F(x + 2ρ) − F(x)                   between two parallel edges 2ρ apart, in units of sR
//! ```
//!
//! F is also the share of the ball's light that one straight edge leaves if the ball is clear and glows evenly. In
//! u = 1/s the clearance u·c(1/u) is convex, for a distance from a convex body's middle is; the minimum is known in closed
//! form. For a sphere of radius a at the distance L, seen at the angle θ from the axis, it lies at
//!
//! ```text
//! u = |PQ| (sin θ tan α + cos θ)/L,   x = |PQ| sin(θ − α)/R,   sin α = a/L
//! ```
//!
//! or at u = 1 where that lies behind the ball.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | c | distance of the object's surface from the beam's axis, negative inside | m |
//! | R, a | radius of the ball, of the object | m |
//! | ρ | radius of the object over the beam's at the closest place | 1 |
//!
//! **Validity.** Exact for R → 0 and for a ball and an object that are small as seen from P beside each other's distance
//! from the edge: the beam's edge is taken as straight. Of several objects each hides its share of what the others leave.
//!
//! **Source.** Own derivation. Penumbrae from the least clearance: R. Parker, P. Shirley and B. Smits, Single sample soft
//! shadows, Univ. of Utah UUCS-98-019 (1998).

use glam::DVec3;

use super::shapes::{Ground, Log, Sphere};

/// How near a surface a point is taken to lie on it, in units of the lengths that it comes from: a hit is pushed off by a
/// billionth of them.
const ON: f64 = 1e-7;

/// From a point of a surface to a luminous ball.
pub(super) struct Beam {
    from: DVec3,
    normal: DVec3,
    /// To the ball's centre, m.
    axis: DVec3,
    radius_m: f64,
    /// Within which a surface is the receiving one, m.
    on_m: f64,
}

/// Clearance x, and ρ, the object's radius beside the beam's.
#[derive(Clone, Copy)]
struct Clearance {
    x: f64,
    rho: f64,
}

impl Clearance {
    const INSIDE: Self = Self {
        x: f64::NEG_INFINITY,
        rho: f64::INFINITY,
    };
}

impl Beam {
    /// From a point with a unit normal to a ball of a radius (m, above 0).
    pub(super) fn new(from: DVec3, normal: DVec3, to: DVec3, radius_m: f64) -> Self {
        let axis = to - from;
        Self {
            from,
            normal,
            axis,
            radius_m: radius_m.max(f64::MIN_POSITIVE),
            on_m: ON * from.length(),
        }
    }

    /// What the ground leaves of the ball: what is above it.
    pub(super) fn past_ground(&self, ground: &Ground) -> f64 {
        let from = self.from.z - ground.height_m;
        let to = from + self.axis.z;
        let on = self.on_m + ON * ground.height_m.abs();
        if from.abs() <= on && self.normal.z > 0.0 {
            return 1.0;
        }
        // Light goes down through the ground from nowhere: it is not there from below.
        if from < 0.0 {
            return 1.0;
        }
        one_side(to / self.radius_m)
    }

    /// What a sphere leaves.
    pub(super) fn past_sphere(&self, sphere: &Sphere) -> f64 {
        let to_centre = sphere.centre - self.from;
        if self.lies_on(-to_centre, sphere.radius_m) {
            return 1.0;
        }
        self.past_ball(to_centre, sphere.radius_m)
    }

    /// What a log leaves.
    pub(super) fn past_log(&self, log: &Log) -> f64 {
        let (axis, length) = log.axis();
        let to_end = log.ends[0] - self.from;
        let nearest = to_end + (-to_end.dot(axis)).clamp(0.0, length) * axis;
        if self.lies_on(-nearest, log.radius_m) {
            return 1.0;
        }
        if nearest.length() <= log.radius_m {
            return 0.0;
        }
        // Across its line a log is a circle. Where along the line is that clearance?
        let across = |v: DVec3| v - v.dot(axis) * axis;
        let (far, near) = (across(self.axis), across(to_end));
        let past_strip = if near.length() > log.radius_m {
            let (u, clearance) = self.clearance(near, far, log.radius_m);
            // As much of the strip is there as the log covers of the beam's width along its line.
            let position = self.axis.dot(axis) / u - to_end.dot(axis);
            let width = self.radius_m / u;
            let covered = one_side((length - position) / width) - one_side(-position / width);
            1.0 - covered * between_edges(clearance)
        } else {
            1.0
        };
        let ends = log.ends.map(|end| end - self.from);
        let [a, b] = ends.map(|end| self.past_ball(end, log.radius_m));
        a.min(b).min(past_strip)
    }

    /// Whether the point, given from the object's middle, lies on the object's surface and looks away from it.
    fn lies_on(&self, from_middle: DVec3, radius_m: f64) -> bool {
        let away = (from_middle.length() - radius_m).abs();
        away <= self.on_m + ON * radius_m && from_middle.dot(self.normal) > 0.0
    }

    /// What a ball leaves, given from the point.
    fn past_ball(&self, to_centre: DVec3, radius_m: f64) -> f64 {
        let (_, clearance) = self.clearance(to_centre, self.axis, radius_m);
        let hidden = between_edges(clearance);
        // A ball hides no more than a small disc in the middle of the light does: 1 − (1 − ρ²)^{3/2}.
        let left = (1.0 - clearance.rho * clearance.rho).max(0.0);
        1.0 - hidden.min(1.0 - left * left.sqrt())
    }

    /// The least clearance of a ball (or, across its line, a cylinder) with its u = 1/s.
    fn clearance(&self, to_centre: DVec3, axis: DVec3, radius_m: f64) -> (f64, Clearance) {
        let distance = to_centre.length();
        let tangent2 = distance * distance - radius_m * radius_m;
        if tangent2 <= 0.0 {
            return (f64::INFINITY, Clearance::INSIDE);
        }
        let direction = to_centre / distance;
        let along = axis.dot(direction);
        let aside = (axis - along * direction).length();
        let u = ((aside * radius_m / tangent2.sqrt() + along) / distance).max(1.0);
        let apart = (distance * u - along).hypot(aside);
        let clearance = Clearance {
            x: (apart - radius_m * u) / self.radius_m,
            rho: radius_m * u / self.radius_m,
        };
        (u, clearance)
    }
}

/// F: share of a ball of radius 1 on the positive side of a plane that lies −x from its centre.
fn one_side(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.25 * (2.0 + x * (3.0 - x * x))
}

/// What is hidden between an object's two edges.
fn between_edges(clearance: Clearance) -> f64 {
    if clearance.x >= 1.0 {
        return 0.0;
    }
    one_side(clearance.x + 2.0 * clearance.rho) - one_side(clearance.x)
}
