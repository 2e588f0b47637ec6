//! What a path weighs at each wavelength, and the roulette that ends light ones.

use crate::math::random::Stream;

use super::optics::Optics;

/// A path whose heaviest weight is below this plays roulette, as long as it has no par.
const ROULETTE: f64 = 1e-3;

/// The same as a share of the par. Weights that fall from a par to this in one step make the noise of one in four.
const PAR: f64 = 0.25;

/// What a path has been through: for each wavelength the product of what physics says, and of how probable the
/// decisions would have been had it been in charge. Both are densities of the same path, up to a common factor.
pub(super) struct Weights {
    pub(super) value: Vec<f64>,
    pub(super) density: Vec<f64>,
    /// What turns a value into a weight: one over the mean density.
    pub(super) share: f64,
    /// A path whose heaviest weight is below this plays roulette for going on.
    least: f64,
}

impl Weights {
    pub(super) fn new(count: usize) -> Self {
        Self {
            value: vec![1.0; count],
            density: vec![1.0; count],
            share: 1.0,
            least: ROULETTE,
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

    /// From now on, what is left is held against what there is: the rest of the path is worth its time as far as its weight
    /// keeps up.
    pub(super) fn set_par(&mut self) {
        self.least = PAR * self.heaviest();
    }

    fn heaviest(&self) -> f64 {
        let heavier = |most: f64, value: &f64| most.max(value.abs());
        self.value.iter().fold(0.0, heavier) * self.share
    }

    /// Plays roulette if all weights are small; whether the path goes on. A survivor weighs as much more as its survival
    /// was improbable, so that the mean stays (J. Arvo and D. Kirk, SIGGRAPH 1990).
    pub(super) fn survive(&mut self, random: &mut Stream) -> bool {
        let heaviest = self.heaviest();
        if heaviest >= self.least && heaviest > 0.0 {
            return true;
        }
        if random.uniform() * self.least >= heaviest {
            return false;
        }
        for value in &mut self.value {
            *value *= self.least / heaviest;
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
    #[test]
    fn roulette_against_a_par_keeps_the_mean_of_a_whole_path() {
        // A path loses nine tenths at each of four steps and brings its weight at every one; the sum of all is known.
        let mut random = Stream::new(3, [0, 0], 0);
        let count = 200_000;
        let (mut sum, mut steps) = (0.0, 0);
        for _ in 0..count {
            let mut weights = Weights::new(2);
            weights.value = vec![0.01, 0.005];
            weights.set_par();
            for _ in 0..4 {
                weights.value.iter_mut().for_each(|value| *value *= 0.1);
                if !weights.survive(&mut random) {
                    break;
                }
                steps += 1;
                sum += weights.value[1];
            }
        }
        let mean = sum / f64::from(count) / 0.005;
        assert!((mean / 0.1111 - 1.0).abs() < 0.02, "{mean}");
        // Most paths end where going on is not worth it.
        assert!(steps < count * 3 / 4, "{steps}");
    }
}
