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
use super::optics::{Local, Optics, Place};
use super::params::Params;
use super::surfaces::{self, Surfaces};

/// A path whose heaviest weight is below this plays roulette for going on.
const ROULETTE: f64 = 1e-3;

/// Scatterings for each flight that [`Params::scattering_points`] see to: e^{−1/2} of all flights stay unscattered.
const SCATTERED: f64 = 0.5;

/// Follows paths through one flame.
pub(super) struct Tracer<'a> {
    medium: &'a Medium,
    optics: Optics,
    bounds: Vec<Bounds>,
    max_bounces: u32,
    min_bounces: u32,
    /// Spectral radiance of the surroundings at each wavelength.
    environment: Vec<f64>,
    emission_points: f64,
    scattering_points: f64,
    /// Least probability of scattering at a collision where there is any.
    least_odds: f64,
    surfaces: Surfaces<'a>,
}

/// How a flight between two scatterings ends.
enum Flight {
    /// Out of the medium.
    Escaped,
    /// Lost at roulette.
    Ended,
    /// Scattered, so far along the ray (m).
    Scattered(f64),
}

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene, wavelengths: &Wavelengths, params: &Params) -> Self {
        let flame = &scene.flame;
        let optics = Optics::new(flame, wavelengths, params);
        let shine = |&nm: &f64| params.environment.radiance(nm);
        Self {
            medium: flame.medium(),
            bounds: bricks::bounds(flame.medium(), &optics),
            max_bounces: if optics.scatters() {
                params.max_bounces
            } else {
                0
            },
            min_bounces: params.min_bounces,
            environment: wavelengths.nodes_nm.iter().map(shine).collect(),
            emission_points: params.emission_points.max(0.0),
            scattering_points: params.scattering_points.max(0.0),
            least_odds: if params.scattering_points > 0.0 {
                let points = params.emission_points.max(0.0) + params.scattering_points;
                SCATTERED / points.max(1.0)
            } else {
                0.0
            },
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
        let mut light = Light {
            weights: Weights::new(count),
            hero: ((random.uniform() * count as f64) as usize).min(count.saturating_sub(1)),
            counts: self.min_bounces == 0,
            radiance,
        };
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
                        let share = light.weights.share;
                        for (n, shine) in self.environment.iter().enumerate() {
                            light.radiance[n] += light.weights.value[n] * share * shine;
                        }
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
        let glow = |bounds: &Bounds| bounds.glow;
        let points_per_glow = self.points_per(self.emission_points, glow, stretches);
        let points_per_depth = if may_scatter {
            let extinction = |bounds: &Bounds| bounds.extinction;
            self.points_per(self.scattering_points, extinction, stretches)
        } else {
            0.0
        };
        for stretch in &*stretches {
            let bounds = self.bounds[stretch.slot as usize];
            let rate = bounds.extinction * (1.0 + points_per_depth) + points_per_glow * bounds.glow;
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
                let scattered = if may_scatter {
                    let decision = random.uniform();
                    light.collide(&self.optics, &place, rate, self.least_odds, decision)
                } else {
                    light.pass(&self.optics, &place, rate);
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
        Place {
            soot,
            kelvin,
            flame: self.medium.flame(position),
            smoke: self.medium.smoke(position),
        }
    }

    /// X, Y, Z of what [`Tracer::trace`] brought.
    pub(super) fn xyz_of(&self, wavelengths: &Wavelengths, light: &[f64]) -> [f64; 3] {
        self.optics.xyz_of(wavelengths, light)
    }

    /// How many numbers [`Tracer::trace`] brings.
    pub(super) fn len(&self) -> usize {
        self.optics.len()
    }

    /// By how much a unit of `what` raises the rate of collisions, so that the flight has so many points more; 0 where
    /// there is nothing of it.
    fn points_per(&self, points: f64, what: impl Fn(&Bounds) -> f64, stretches: &[Stretch]) -> f64 {
        let all: f64 = stretches
            .iter()
            .map(|stretch| what(&self.bounds[stretch.slot as usize]) * (stretch.to - stretch.from))
            .sum();
        let points = points / all;
        if points.is_finite() { points } else { 0.0 }
    }
}

/// What a path carries and has brought.
struct Light<'a> {
    weights: Weights,
    /// The wavelength that decides.
    hero: usize,
    /// Whether what is met now has been scattered often enough on its way to the eye.
    counts: bool,
    radiance: &'a mut [f64],
}

impl Light<'_> {
    /// A collision at which light may scatter; `decision` is a number in 0..1. Returns whether it does.
    fn collide(
        &mut self,
        optics: &Optics,
        place: &Place,
        rate: f64,
        least_odds: f64,
        decision: f64,
    ) -> bool {
        let scattered = decision < odds(&optics.local(self.hero, place), rate, least_odds);
        let share = self.weights.share;
        for n in 0..optics.len() {
            let local = optics.local(n, place);
            let (value, density) = (&mut self.weights.value[n], &mut self.weights.density[n]);
            if self.counts {
                self.radiance[n] += *value * share * local.emission / rate;
            }
            let odds = odds(&local, rate, least_odds);
            if scattered {
                *value *= local.sigma_s / rate;
                *density *= odds;
            } else {
                *value *= (rate - local.sigma_a - local.sigma_s) / rate;
                *density *= 1.0 - odds;
            }
        }
        self.weights.weigh();
        scattered
    }

    /// A collision at which scattered light is lost, with nothing to decide.
    fn pass(&mut self, optics: &Optics, place: &Place, rate: f64) {
        let share = self.weights.share;
        for n in 0..optics.len() {
            let local = optics.local(n, place);
            let value = &mut self.weights.value[n];
            if self.counts {
                self.radiance[n] += *value * share * local.emission / rate;
            }
            *value *= (rate - local.sigma_a - local.sigma_s) / rate;
        }
    }
}

/// Probability that a wavelength in charge scatters at a collision that does not absorb, where it does at all no less
/// than `least`. A rate below the extinction would make the rest negative: the weights stay right, so the probability only
/// has to be one.
fn odds(local: &Local, rate: f64, least: f64) -> f64 {
    let null = (rate - local.sigma_a - local.sigma_s).abs();
    if local.sigma_s > 0.0 {
        (local.sigma_s / (local.sigma_s + null)).max(least)
    } else {
        0.0
    }
}

/// What a path has been through: for each wavelength the product of what physics says, and of how probable the
/// decisions would have been had it been in charge. Both are densities of the same path, up to a common factor.
struct Weights {
    value: Vec<f64>,
    density: Vec<f64>,
    /// What turns a value into a weight: one over the mean density.
    share: f64,
}

impl Weights {
    fn new(count: usize) -> Self {
        Self {
            value: vec![1.0; count],
            density: vec![1.0; count],
            share: 1.0,
        }
    }

    /// Finds the share after a change of the densities.
    fn weigh(&mut self) {
        self.share = self.density.len() as f64 / self.density.iter().sum::<f64>();
    }

    /// A turn by an angle of this cosine, drawn from the phase function of the wavelength in charge: each wavelength's
    /// value and density take their own phase function's value, over that one's.
    fn turn(&mut self, optics: &Optics, hero: usize, cosine: f64) {
        let drawn = optics.phase(hero);
        for n in 0..self.value.len() {
            let own = optics.phase(n);
            // Where all are one, nothing is rounded.
            if own != drawn {
                let ratio = own.value(cosine) / drawn.value(cosine);
                self.value[n] *= ratio;
                self.density[n] *= ratio;
            }
        }
        self.weigh();
    }

    /// Takes out the common factor, so that long paths do not underflow.
    fn normalise(&mut self) {
        for number in self.value.iter_mut().chain(&mut self.density) {
            *number *= self.share;
        }
        self.share = 1.0;
    }

    /// Plays roulette if all weights are small; whether the path goes on.
    fn survive(&mut self, random: &mut Stream) -> bool {
        let heaviest = self
            .value
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        let heaviest = heaviest * self.share;
        if heaviest >= ROULETTE {
            return true;
        }
        if random.uniform() * ROULETTE >= heaviest {
            return false;
        }
        for value in &mut self.value {
            *value *= ROULETTE / heaviest;
        }
        true
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

    #[test]
    fn roulette_keeps_the_mean() {
        let mut random = Stream::new(2, [0, 0], 0);
        let count = 100_000;
        let small = 0.2 * ROULETTE;
        let mut sum = 0.0;
        for _ in 0..count {
            let mut weights = Weights::new(2);
            weights.value = vec![small, 0.5 * small];
            if weights.survive(&mut random) {
                sum += weights.value[1];
            }
        }
        let mean = sum / f64::from(count) / (0.5 * small);
        assert!((mean - 1.0).abs() < 0.04, "{mean}");
    }
}
