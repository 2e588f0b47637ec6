//! What a path weighs at each wavelength, and the roulette that ends light ones.

use crate::math::random::Stream;

use super::optics::Optics;

/// A path whose heaviest weight is below this plays roulette for going on.
const ROULETTE: f64 = 1e-3;

/// What a path has been through: for each wavelength the product of what physics says, and of how probable the
/// decisions would have been had it been in charge. Both are densities of the same path, up to a common factor.
pub(super) struct Weights {
    pub(super) value: Vec<f64>,
    pub(super) density: Vec<f64>,
    /// What turns a value into a weight: one over the mean density.
    pub(super) share: f64,
}

impl Weights {
    pub(super) fn new(count: usize) -> Self {
        Self {
            value: vec![1.0; count],
            density: vec![1.0; count],
            share: 1.0,
        }
    }

    /// Finds the share after a change of the densities.
    pub(super) fn weigh(&mut self) {
        self.share = self.density.len() as f64 / self.density.iter().sum::<f64>();
    }

    /// A turn by an angle of this cosine, drawn from the phase function of the wavelength in charge: each wavelength's
    /// value and density take their own phase function's value, over that one's.
    pub(super) fn turn(&mut self, optics: &Optics, hero: usize, cosine: f64) {
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
    pub(super) fn normalise(&mut self) {
        for number in self.value.iter_mut().chain(&mut self.density) {
            *number *= self.share;
        }
        self.share = 1.0;
    }

    /// Plays roulette if all weights are small; whether the path goes on. A survivor weighs as much more as its survival
    /// was improbable, so that the mean stays (J. Arvo and D. Kirk, SIGGRAPH 1990).
    pub(super) fn survive(&mut self, random: &mut Stream) -> bool {
        let heavier = |most: f64, value: &f64| most.max(value.abs());
        let heaviest = self.value.iter().fold(0.0, heavier) * self.share;
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

#[cfg(test)]
mod tests {
    use super::*;

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
