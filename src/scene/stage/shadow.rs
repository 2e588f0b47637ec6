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

use std::f64::consts::SQRT_2;

use glam::DVec3;

use super::shapes::{Ground, Log, Sphere};

/// How near a surface a point is taken to lie on it, in units of the lengths that it comes from: a hit is pushed off by a
/// billionth of them.
const ON: f64 = 1e-7;

/// A point of a surface, which light falls on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

impl Place {
    /// Within which of it a surface of an object of a size (m) is the receiving one, m.
    fn on_m(&self, size_m: f64) -> f64 {
        ON * (self.point.length() + size_m)
    }

    /// Whether it lies on an object's surface and looks away from it, given from the object's middle.
    fn lies_on(&self, from_middle: DVec3, radius_m: f64) -> bool {
        let away = (from_middle.length() - radius_m).abs();
        away <= self.on_m(radius_m) && from_middle.dot(self.normal) > 0.0
    }
}

/// From a point to a luminous ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    /// To the ball's centre, m.
    axis: DVec3,
    radius_m: f64,
    length_m: f64,
    /// Lengths of the tangents to the ball and to one √2 as large, m; NaN inside.
    tangents_m: [f64; 2],
}

impl Beam {
    /// From a point to a ball of a radius (m, above 0).
    pub(super) fn new(from: DVec3, to: DVec3, radius_m: f64) -> Self {
        let axis = to - from;
        let radius_m = radius_m.max(f64::MIN_POSITIVE);
        let length2 = axis.length_squared();
        Self {
            axis,
            radius_m,
            length_m: length2.sqrt(),
            tangents_m: [1.0, 2.0].map(|times| (length2 - times * radius_m * radius_m).sqrt()),
        }
    }
}

/// An object as it is seen from one point: all of its shadow that is the same for every light.
#[derive(Debug, Clone, Copy)]
pub(super) enum Caster {
    /// The point is inside of it.
    Around,
    /// The ground that far below the point, m.
    Ground(f64),
    Sphere(Round),
    Log(LogSeen),
}

impl Caster {
    /// The ground, unless it hides nothing from the place.
    pub(super) fn of_ground(place: &Place, ground: &Ground) -> Option<Self> {
        let above = place.point.z - ground.height_m;
        let on = above.abs() <= place.on_m(ground.height_m.abs()) && place.normal.z > 0.0;
        // Light goes down through the ground from nowhere: it is not there from below.
        (!on && above >= 0.0).then_some(Self::Ground(above))
    }

    /// A sphere, unless the place is on it.
    pub(super) fn of_sphere(place: &Place, sphere: &Sphere) -> Option<Self> {
        let to_centre = sphere.centre - place.point;
        if place.lies_on(-to_centre, sphere.radius_m) {
            return None;
        }
        Some(Round::new(to_centre, sphere.radius_m).map_or(Self::Around, Self::Sphere))
    }

    /// A log, unless the place is on it.
    pub(super) fn of_log(place: &Place, log: &Log) -> Option<Self> {
        let (axis, length_m) = log.axis();
        let [to_end, to_other] = log.ends.map(|end| end - place.point);
        let nearest = to_end + (-to_end.dot(axis)).clamp(0.0, length_m) * axis;
        if place.lies_on(-nearest, log.radius_m) {
            return None;
        }
        let round = |to: DVec3| Round::new(to, log.radius_m);
        let (Some(end), Some(other)) = (round(to_end), round(to_other)) else {
            return Some(Self::Around);
        };
        if nearest.length() <= log.radius_m {
            return Some(Self::Around);
        }
        Some(Self::Log(LogSeen {
            axis,
            length_m,
            to_end_m: to_end.dot(axis),
            across: round(to_end - to_end.dot(axis) * axis),
            ends: [end, other],
        }))
    }

    /// Which share of the ball's light it leaves.
    #[inline]
    pub(super) fn leaves(&self, beam: &Beam) -> f64 {
        match self {
            Self::Around => 0.0,
            Self::Ground(above) => one_side((above + beam.axis.z) / beam.radius_m),
            Self::Sphere(round) => round.leaves(beam),
            Self::Log(log) => log.leaves(beam),
        }
    }
}

/// A ball that hides light, or across its line a log, from a point outside of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Round {
    direction: DVec3,
    distance_m: f64,
    radius_m: f64,
    /// Tangent of the angle between its middle and its edge.
    slope: f64,
}

/// A log from a point outside of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogSeen {
    axis: DVec3,
    length_m: f64,
    /// Along the line from the point to the first end, m.
    to_end_m: f64,
    /// Across its line it is a circle; none where the point is in line with it.
    across: Option<Round>,
    ends: [Round; 2],
}

/// Clearance x, and ρ, the object's radius beside the beam's.
#[derive(Clone, Copy)]
struct Clearance {
    x: f64,
    rho: f64,
}

impl Round {
    /// One in that direction and distance of the point, m; none if the point is inside.
    fn new(to_centre: DVec3, radius_m: f64) -> Option<Self> {
        let distance_m = to_centre.length();
        let tangent2 = distance_m * distance_m - radius_m * radius_m;
        (tangent2 > 0.0).then(|| Self {
            direction: to_centre / distance_m,
            distance_m,
            radius_m,
            slope: radius_m / tangent2.sqrt(),
        })
    }

    /// The least clearance of a beam with an axis, with its u = 1/s.
    #[inline]
    fn clearance(&self, axis: DVec3, beam_m: f64) -> (f64, Clearance) {
        let along = axis.dot(self.direction);
        let aside = (axis - along * self.direction).length();
        let u = ((aside * self.slope + along) / self.distance_m).max(1.0);
        let ahead = self.distance_m * u - along;
        let apart = (ahead * ahead + aside * aside).sqrt();
        let clearance = Clearance {
            x: (apart - self.radius_m * u) / beam_m,
            rho: self.radius_m * u / beam_m,
        };
        (u, clearance)
    }

    /// What the ball leaves.
    #[inline]
    fn leaves(&self, beam: &Beam) -> f64 {
        let (_, clearance) = self.clearance(beam.axis, beam.radius_m);
        if clearance.x >= 1.0 {
            return 1.0;
        }
        let hidden = between_edges(clearance);
        // A ball hides no more than a small disc in the middle of the light does: 1 − (1 − ρ²)^{3/2}.
        let left = (1.0 - clearance.rho * clearance.rho).max(0.0);
        1.0 - hidden.min(1.0 - left * left.sqrt())
    }
}

impl LogSeen {
    /// What the log leaves.
    fn leaves(&self, beam: &Beam) -> f64 {
        let past_strip = if let Some(across) = &self.across {
            let along = beam.axis.dot(self.axis);
            let (u, clearance) = across.clearance(beam.axis - along * self.axis, beam.radius_m);
            if clearance.x >= 1.0 {
                return 1.0;
            }
            // Where along the line is that clearance? As much of the strip is there as the log covers of the beam's width
            // along its line.
            let position = along / u - self.to_end_m;
            let width = beam.radius_m / u;
            let covered =
                one_side((self.length_m - position) / width) - one_side(-position / width);
            1.0 - covered * between_edges(clearance)
        } else {
            1.0
        };
        let [a, b] = self.ends.map(|end| end.leaves(beam));
        a.min(b).min(past_strip)
    }
}

/// A ball that an object casts no shadow from outside of, for looking away quickly where it is not in a beam's way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    /// Unit vector to its middle.
    direction: DVec3,
    distance_m: f64,
    radius_m: f64,
    /// Sine and cosine of the angle between its middle and its edge; the cosine is NaN inside.
    sine: f64,
    cosine: f64,
    /// Which of the beam's two balls it looks at, and that one's radius over the beam's.
    which: usize,
    times: f64,
}

impl Bound {
    /// Around a sphere.
    pub(super) fn of_sphere(place: &Place, sphere: &Sphere) -> Self {
        Self::new(place, sphere.centre, sphere.radius_m, 0)
    }

    /// Around a log. Beside its ends it counts in a beam of the width w up to w off along its line while up to w off across
    /// it: that is √2 w.
    pub(super) fn of_log(place: &Place, log: &Log) -> Self {
        let [a, b] = log.ends;
        let radius_m = 0.5 * a.distance(b) + log.radius_m;
        Self::new(place, 0.5 * (a + b), radius_m, 1)
    }

    fn new(place: &Place, centre: DVec3, radius_m: f64, which: usize) -> Self {
        let to_centre = centre - place.point;
        let distance_m = to_centre.length();
        let sine = radius_m / distance_m;
        Self {
            direction: to_centre / distance_m,
            distance_m,
            radius_m,
            sine,
            cosine: (1.0 - sine * sine).sqrt(),
            which,
            times: [1.0, SQRT_2][which],
        }
    }

    /// Whether it is not in a beam's way: beside its cone, or behind the light. Never so for a NaN.
    #[inline]
    pub(super) fn is_clear_of(&self, beam: &Beam) -> bool {
        let wide_m = self.times * beam.radius_m;
        // cos θ ≤ cos (α + β), times the distance of the light.
        self.direction.dot(beam.axis)
            <= self.cosine * beam.tangents_m[self.which] - self.sine * wide_m
            || self.distance_m - self.radius_m >= beam.length_m + wide_m
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
