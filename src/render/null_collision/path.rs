//! One path of light, followed from the eye.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::colour::reflectance::Reflectance;
use crate::math::Ray;
use crate::math::random::Stream;
use crate::physics::phase::HenyeyGreenstein;
use crate::render::walk::Stretch;
use crate::scene::{Medium, Scene};
use crate::spectral::Wavelengths;

use super::bricks::{self, Bounds};
use super::light::{Collision, Light};
use super::optics::{Optics, Place};
use super::params::Params;
use super::surfaces::{self, Surfaces};

/// Scatterings for each flight that [`Params::scattering_points`] see to: e^{−1/2} of all flights stay unscattered.
const SCATTERED: f64 = 0.5;

/// Follows paths through one flame.
pub(super) struct Tracer<'a> {
    medium: &'a Medium,
    optics: Optics,
    bounds: Vec<Bounds>,
    /// Extinction above which a place counts as no denser, 1/m.
    densest: f64,
    max_bounces: u32,
    min_bounces: u32,
    /// Spectral radiance of the surroundings at each wavelength.
    environment: Vec<f64>,
    emission_points: f64,
    scattering_points: f64,
    surfaces: Surfaces<'a>,
}

/// Optical depth of a voxel's edge beyond which soot counts as no denser. What lies a hundredth of a voxel behind such soot's
/// surface is not seen either way, and a path that crosses the clear part of a brick must not collide with nothing a thousand
/// million times.
const DENSEST: f64 = 1e2;

/// How a flight between two scatterings ends.
enum Flight {
    /// Out of the medium.
    Escaped,
    /// Lost at roulette.
    Ended,
    /// Scattered, so far along the ray (m).
    Scattered(f64),
}

/// How often a flight collides.
struct Rates {
    /// Collisions for each unit of the bricks' glow, and of their extinction.
    per_glow: f64,
    per_depth: f64,
    /// Least probability of scattering at a collision where there is any.
    least_odds: f64,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene, wavelengths: &Wavelengths, params: &Params) -> Self {
        let flame = &scene.flame;
        let optics = Optics::new(flame, wavelengths, params);
        let densest = DENSEST / flame.medium().voxel_size_m();
        let mut bounds = bricks::bounds(flame.medium(), &optics);
        for bound in &mut bounds {
            bound.extinction = bound.extinction.min(densest);
        }
        let shine = |&nm: &f64| params.environment.radiance(nm);
        Self {
            medium: flame.medium(),
            bounds,
            densest,
            max_bounces: if optics.scatters() {
                params.max_bounces
            } else {
                0
            },
            min_bounces: params.min_bounces,
            environment: wavelengths.nodes_nm.iter().map(shine).collect(),
            emission_points: params.emission_points.max(0.0),
            scattering_points: params.scattering_points.max(0.0),
            surfaces: Surfaces::new(&scene.stage, params.max_reflections),
            optics,
        }
    }

    /// Adds to `radiance` (one number for each of [`Tracer::len`]) what one path from the ray's origin brings.
    pub(super) fn trace(
        &self,
        ray: &Ray,
        random: &mut Stream,
        stretches: &mut Vec<Stretch>,
        radiance: &mut [f64],
    ) {
        let count = self.optics.len();
        let hero = ((random.uniform() * count as f64) as usize).min(count.saturating_sub(1));
        let mut light = Light::new(hero, self.min_bounces == 0, radiance);
        let mut ray = *ray;
        let mut bounces = 0;
        let mut reflections = 0;
        loop {
            let may_scatter = bounces < self.max_bounces;
            let wall = self.surfaces.hit(&ray);
            let limit = wall.map_or(f64::INFINITY, |wall| wall.distance_m);
            match self.fly(&ray, limit, may_scatter, &mut light, random, stretches) {
                Flight::Ended => return,
                Flight::Escaped => {
                    if let Some(wall) = wall {
                        if !self.surfaces.may_reflect(reflections) {
                            return;
                        }
                        reflections += 1;
                        let reflectance = Reflectance::of(wall.colour);
                        for (n, value) in light.weights.value.iter_mut().enumerate() {
                            *value *= reflectance.at(self.optics.lambda_nm(n));
                        }
                        ray = surfaces::reflected(&wall, random);
                        continue;
                    }
                    if light.counts {
                        light.add(self.environment.iter().copied());
                    }
                    return;
                }
                Flight::Scattered(distance) => {
                    bounces += 1;
                    light.counts = bounces >= self.min_bounces;
                    let phase = self.optics.phase(light.hero);
                    let (direction, cosine) = turned(ray.direction, phase, random);
                    light.weights.turn(&self.optics, light.hero, cosine);
                    light.weights.normalise();
                    ray = Ray {
                        origin: ray.at(distance),
                        direction,
                    };
                }
            }
        }
    }

    /// From the ray's origin to the next scattering, or out, or to a limit along the ray (m), taking up the emission on
    /// the way.
    fn fly(
        &self,
        ray: &Ray,
        limit: f64,
        may_scatter: bool,
        light: &mut Light<'_>,
        random: &mut Stream,
        stretches: &mut Vec<Stretch>,
    ) -> Flight {
        let Some((local, range)) = self.medium.enter(ray) else {
            return Flight::Escaped;
        };
        bricks::stretches(self.medium, &local, range, stretches);
        let Rates {
            per_glow,
            per_depth,
            least_odds,
        } = self.rates(light.counts, may_scatter, stretches);
        for stretch in &*stretches {
            let bounds = self.bounds[stretch.slot as usize];
            let rate = bounds.extinction * per_depth + per_glow * bounds.glow;
            if rate <= 0.0 {
                continue;
            }
            let mut t = stretch.from;
            let end = stretch.to.min(limit);
            loop {
                t += random.exponential() / rate;
                if t >= end {
                    break;
                }
                let place = self.place(local.at(t));
                if place.soot <= 0.0 && place.flame <= 0.0 {
                    continue;
                }
                let collision = Collision { place, rate };
                let scattered = if may_scatter {
                    let decision = random.uniform();
                    light.collide(&self.optics, &collision, least_odds, decision)
                } else {
                    light.pass(&self.optics, &collision);
                    false
                };
                if !light.weights.survive(random) {
                    return Flight::Ended;
                }
                if scattered {
                    return Flight::Scattered(t);
                }
            }
        }
        Flight::Escaped
    }

    /// What the medium holds at a point of the lattice.
    fn place(&self, position: DVec3) -> Place {
        let [soot, kelvin] = self.medium.sample(position);
        let mut place = Place {
            soot,
            kelvin,
            flame: self.medium.flame(position),
            smoke: self.medium.smoke(position),
        };
        let denser = self.optics.extinction(&place) / self.densest;
        if denser > 1.0 {
            place.soot /= denser;
            place.smoke /= denser;
        }
        place
    }

    /// X, Y, Z of what [`Tracer::trace`] brought.
    pub(super) fn xyz_of(&self, wavelengths: &Wavelengths, light: &[f64]) -> [f64; 3] {
        self.optics.xyz_of(wavelengths, light)
    }

    /// How many numbers [`Tracer::trace`] brings.
    pub(super) fn len(&self) -> usize {
        self.optics.len()
    }

    /// How often a flight along these stretches collides. What is taken up on the way wants points in proportion to it, and
    /// a scattering that is rare wants places where it may happen; where the medium is deep, extinction alone gives them.
    fn rates(&self, counts: bool, may_scatter: bool, stretches: &[Stretch]) -> Rates {
        let sum = |what: fn(&Bounds) -> f64| -> f64 {
            let of = |stretch: &Stretch| {
                what(&self.bounds[stretch.slot as usize]) * (stretch.to - stretch.from)
            };
            stretches.iter().map(of).sum()
        };
        let (depth, glow) = (sum(|bounds| bounds.extinction), sum(|bounds| bounds.glow));
        let of_glow = if counts { self.emission_points } else { 0.0 };
        let of_depth = if may_scatter {
            (self.scattering_points - depth).max(0.0)
        } else {
            0.0
        };
        let finite = |ratio: f64| if ratio.is_finite() { ratio } else { 0.0 };
        // Where many collisions are expected, each must scatter the less: odds that were too high at all of them would let
        // the weight of what comes through grow without bound.
        Rates {
            per_glow: finite(of_glow / glow),
            per_depth: 1.0 + finite(of_depth / depth),
            least_odds: if self.scattering_points > 0.0 {
                SCATTERED / (depth + of_depth + of_glow).max(1.0)
            } else {
                0.0
            },
        }
    }
}

/// A direction after scattering, and the cosine of the turn.
fn turned(direction: DVec3, phase: HenyeyGreenstein, random: &mut Stream) -> (DVec3, f64) {
    let cosine = phase.sample_cosine(random.uniform());
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let (up, across) = (TAU * random.uniform()).sin_cos();
    let (u, v) = direction.any_orthonormal_pair();
    let after = cosine * direction + sine * (across * u + up * v);
    (after.normalize(), cosine)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn directions_turn_by_the_mean_cosine_and_evenly_around() {
        let before = DVec3::new(0.6, -0.48, 0.64);
        for asymmetry in [-0.99, -0.4, 0.0, 0.4, 0.99] {
            let phase = HenyeyGreenstein::new(asymmetry).unwrap();
            let mut random = Stream::new(1, [0, 0], 0);
            let count = 20_000;
            let mut mean = DVec3::ZERO;
            for _ in 0..count {
                let (after, _) = turned(before, phase, &mut random);
                assert!((after.length() - 1.0).abs() < 1e-14);
                mean += after / f64::from(count);
            }
            // Five standard errors of a number within ±1.
            let off = (mean - asymmetry * before).length();
            assert!(off < 5.0 / f64::from(count).sqrt(), "g {asymmetry}: {off}");
        }
    }
}
