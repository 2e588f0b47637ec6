//! Where rays meet ground, spheres and logs.
//!
//! A ray o + t d meets a ball of radius r around c where t = −b ± √(r² − q²), with b = (o − c)·d and q the distance of c
//! from the line: taken from the vector itself and not from |o − c|² − b², it keeps its digits for small balls far away.
//! A log is a cylinder of its middle line between two balls: the same in the plane across the line.

use glam::DVec3;

use super::Hit;
use super::shapes::{Ground, Log, Sphere};
use crate::math::Ray;

/// How far a point is pushed off its surface, and how near the ray's origin nothing is met, in units of the lengths that
/// went into it: f64 loses about 1e-15 of them, and a billionth of a metre is seen by nobody.
const OFF: f64 = 1e-9;

impl Ground {
    /// Where a ray from above meets it.
    pub(super) fn meet(&self, ray: &Ray) -> Option<Hit> {
        let above = ray.origin.z - self.height_m;
        if !(above > 0.0 && ray.direction.z < 0.0) {
            return None;
        }
        let t = -above / ray.direction.z;
        t.is_finite()
            .then(|| hit(ray, t, DVec3::Z, self.height_m.abs(), self.colour))
    }
}

impl Sphere {
    /// Where a ray meets it first.
    pub(super) fn meet(&self, ray: &Ray) -> Option<Hit> {
        let least = OFF * self.radius_m;
        let t = crossings(ray.origin - self.centre, ray.direction, self.radius_m)?
            .into_iter()
            .find(|&t| t > least)?;
        let outwards = (ray.at(t) - self.centre) / self.radius_m;
        Some(hit(ray, t, outwards, self.radius_m, self.colour))
    }
}

impl Log {
    /// Unit vector along the middle line and its length, m; any direction where the ends coincide.
    pub(super) fn axis(&self) -> (DVec3, f64) {
        let along = self.ends[1] - self.ends[0];
        let length = along.length();
        (along.try_normalize().unwrap_or(DVec3::Z), length)
    }

    /// Where a ray meets it first.
    pub(super) fn meet(&self, ray: &Ray) -> Option<Hit> {
        let (axis, length) = self.axis();
        let least = OFF * self.radius_m;
        let position = |t: f64| (ray.at(t) - self.ends[0]).dot(axis);
        let mut nearest = f64::INFINITY;
        let mut consider = |crossings: Option<[f64; 2]>, [from, to]: [f64; 2]| {
            for t in crossings.into_iter().flatten() {
                if t > least && (from..=to).contains(&position(t)) {
                    nearest = nearest.min(t);
                }
            }
        };

        // The cylinder, seen along its line: there the direction is shorter, so t is stretched.
        let across = |v: DVec3| v - v.dot(axis) * axis;
        let (origin, direction) = (across(ray.origin - self.ends[0]), across(ray.direction));
        let speed = direction.length();
        if speed > 0.0 {
            let met = crossings(origin, direction / speed, self.radius_m);
            consider(met.map(|t| t.map(|t| t / speed)), [0.0, length]);
        }
        for (end, part) in [
            (self.ends[0], [f64::NEG_INFINITY, 0.0]),
            (self.ends[1], [length, f64::INFINITY]),
        ] {
            consider(
                crossings(ray.origin - end, ray.direction, self.radius_m),
                part,
            );
        }

        let middle = self.ends[0] + position(nearest).clamp(0.0, length) * axis;
        nearest.is_finite().then(|| {
            let outwards = (ray.at(nearest) - middle) / self.radius_m;
            hit(ray, nearest, outwards, self.radius_m, self.colour)
        })
    }
}

/// Where a line of unit direction, from an origin relative to the centre, crosses a circle or ball: the nearer first.
fn crossings(origin: DVec3, direction: DVec3, radius_m: f64) -> Option<[f64; 2]> {
    let b = origin.dot(direction);
    let q2 = (origin - b * direction).length_squared();
    let half = (radius_m * radius_m - q2).sqrt();
    // NaN where the line misses.
    (half > 0.0).then(|| [-b - half, -b + half])
}

/// The hit at a distance, with a normal that may point either way and the size of what is met.
fn hit(ray: &Ray, t: f64, normal: DVec3, size_m: f64, colour: [f64; 3]) -> Hit {
    let normal = normal.normalize_or(DVec3::Z);
    let normal = if normal.dot(ray.direction) > 0.0 {
        -normal
    } else {
        normal
    };
    let off = OFF * (ray.origin.length() + t + size_m);
    Hit {
        distance_m: t,
        point: ray.at(t) + off * normal,
        normal,
        colour,
    }
}
