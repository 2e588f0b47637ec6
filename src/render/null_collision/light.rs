//! What a path carries and has brought, and what a collision does to it.

use glam::DVec3;

use super::optics::{Local, Optics, Place};
use super::weights::Weights;

/// Light that is known to arrive from all sides at each place. A path that knows it takes it up where it may scatter, in
/// the place of what the medium itself emits.
pub(in crate::render) trait Around: Sync {
    /// ∫ L Φ dω along `direction` at a position of the lattice that emits and dims so much (W m⁻³ sr⁻¹ nm⁻¹, 1/m), in W
    /// m⁻² sr⁻¹ nm⁻¹: at each wavelength, then (without nm⁻¹) for each of the radicals' parts.
    fn read(&self, position: DVec3, direction: DVec3, here: [&[f64]; 2], light: &mut [f64]);
}

/// A tentative collision.
pub(super) struct Collision {
    pub(super) place: Place,
    /// Where it is, on the lattice.
    pub(super) position: DVec3,
    /// The direction in which light goes to the eye, in the world.
    pub(super) direction: DVec3,
    /// Collisions for each metre.
    pub(super) rate: f64,
}

/// What a path carries and has brought.
pub(super) struct Light<'a> {
    pub(super) weights: Weights,
    /// The wavelength that decides.
    pub(super) hero: usize,
    /// Whether what is met now has been scattered often enough on its way to the eye.
    pub(super) counts: bool,
    radiance: &'a mut [f64],
    /// Of the place of a collision, for each wavelength: its optics, emission, extinction, and what it sends to the eye,
    /// W m⁻³ sr⁻¹ nm⁻¹.
    locals: Vec<Local>,
    emission: Vec<f64>,
    extinction: Vec<f64>,
    source: Vec<f64>,
}

impl<'a> Light<'a> {
    pub(super) fn new(hero: usize, counts: bool, radiance: &'a mut [f64]) -> Self {
        let count = radiance.len();
        Self {
            weights: Weights::new(count),
            hero,
            counts,
            radiance,
            locals: Vec::with_capacity(count),
            emission: vec![0.0; count],
            extinction: vec![0.0; count],
            source: vec![0.0; count],
        }
    }

    /// Adds light at each wavelength, as much as the path's weight lets come.
    pub(super) fn add(&mut self, shines: impl Iterator<Item = f64>) {
        let share = self.weights.share;
        let weighed = self.radiance.iter_mut().zip(&self.weights.value);
        for ((radiance, value), shines) in weighed.zip(shines) {
            *radiance += value * share * shines;
        }
    }

    /// Takes up what a collision's place sends, and finds its optics.
    fn meet(&mut self, optics: &Optics, around: Option<&dyn Around>, collision: &Collision) {
        let place = &collision.place;
        self.locals.clear();
        self.locals
            .extend((0..optics.len()).map(|n| optics.local(n, place)));
        if !self.counts {
            return;
        }
        for (n, emission) in self.emission.iter_mut().enumerate() {
            *emission = optics.emission(n, place);
        }
        let mut sent = std::mem::take(&mut self.source);
        match around {
            None => sent.copy_from_slice(&self.emission),
            Some(around) => {
                for (extinction, local) in self.extinction.iter_mut().zip(&self.locals) {
                    *extinction = local.extinction();
                }
                let here = [&self.emission[..], &self.extinction];
                around.read(collision.position, collision.direction, here, &mut sent);
                for (sent, local) in sent.iter_mut().zip(&self.locals) {
                    *sent *= local.sigma_s;
                }
            }
        }
        self.add(sent.iter().map(|sent| sent / collision.rate));
        self.source = sent;
    }

    /// A collision at which light may scatter; `decision` is a number in 0..1. Returns whether it does.
    pub(super) fn collide(
        &mut self,
        optics: &Optics,
        around: Option<&dyn Around>,
        collision: &Collision,
        least_odds: f64,
        decision: f64,
    ) -> bool {
        self.meet(optics, around, collision);
        let rate = collision.rate;
        let scattered = decision < odds(&self.locals[self.hero], rate, least_odds);
        for (n, local) in self.locals.iter().enumerate() {
            let (value, density) = (&mut self.weights.value[n], &mut self.weights.density[n]);
            let odds = odds(local, rate, least_odds);
            if scattered {
                *value *= local.sigma_s / rate;
                *density *= odds;
            } else {
                *value *= (rate - local.extinction()) / rate;
                *density *= 1.0 - odds;
            }
        }
        self.weights.weigh();
        scattered
    }

    /// A collision at which scattered light is lost, with nothing to decide.
    pub(super) fn pass(
        &mut self,
        optics: &Optics,
        around: Option<&dyn Around>,
        collision: &Collision,
    ) {
        self.meet(optics, around, collision);
        for (value, local) in self.weights.value.iter_mut().zip(&self.locals) {
            *value *= (collision.rate - local.extinction()) / collision.rate;
        }
    }
}

/// Probability that a wavelength in charge scatters at a collision that does not absorb, where it does at all no less
/// than `least`. A rate below the extinction would make the rest negative: the weights stay right, so the probability only
/// has to be one.
fn odds(local: &Local, rate: f64, least: f64) -> f64 {
    let null = (rate - local.extinction()).abs();
    if local.sigma_s > 0.0 {
        (local.sigma_s / (local.sigma_s + null)).max(least)
    } else {
        0.0
    }
}
