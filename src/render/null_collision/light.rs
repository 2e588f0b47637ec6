//! What a path carries and has brought, and what a collision does to it.

use super::optics::{Local, Optics, Place};
use super::weights::Weights;

/// A tentative collision.
pub(super) struct Collision {
    pub(super) place: Place,
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
    /// What the place of a collision does to each wavelength.
    locals: Vec<Local>,
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

    /// Takes up what a collision's place emits, and finds its optics.
    fn meet(&mut self, optics: &Optics, Collision { place, rate }: &Collision) {
        self.locals.clear();
        self.locals
            .extend((0..optics.len()).map(|n| optics.local(n, place)));
        if self.counts {
            self.add((0..optics.len()).map(|n| optics.emission(n, place) / rate));
        }
    }

    /// A collision at which light may scatter; `decision` is a number in 0..1. Returns whether it does.
    pub(super) fn collide(
        &mut self,
        optics: &Optics,
        collision: &Collision,
        least_odds: f64,
        decision: f64,
    ) -> bool {
        self.meet(optics, collision);
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
    pub(super) fn pass(&mut self, optics: &Optics, collision: &Collision) {
        self.meet(optics, collision);
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
