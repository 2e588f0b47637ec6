//! How finely the march must look at each brick: where a fire's light changes from voxel to voxel, steps are cut.
//!
//! With j = f_v B(λ, T) a step of length h takes j at its middle for the mean, and is off by j″ h³/24. Let bricks have steps
//! of their own: of all choices with the same number of samples Σ L/h, the sum of squares of errors Σ (j″ h²)² is least where
//!
//! ```text
//! h ∝ |j″|^{−2/5}
//! ```
//!
//! For j″ of a brick stands the greatest second difference between its samples along any axis. What it is measured by is
//! the root mean square of all second differences: most of a fire keeps the step that was asked for, and its thin hot sheets,
//! where nearly all error comes from, get shorter ones. None gets a longer one, so that whatever else is seen, of gas or of
//! what lies behind, is taken as finely as was asked for.
//!
//! No law of soot is in it: it is worked out once for each packed medium.

use rayon::prelude::*;

use super::medium::{BRICK_SAMPLES, Medium, SAMPLES, Sample};
use crate::math::lanes;
use crate::physics::blackbody::SECOND_RADIATION_CONSTANT_NM_K;

/// Wavelength at which a fire's light is looked at, nm: where what is seen of soot at 1800 K is brightest.
const LAMBDA_NM: f64 = 610.0;
/// Exponent of the rule above.
const EXPONENT: f64 = 0.4;
/// Most samples of a step.
const MOST_CUTS: f64 = 16.0;

impl Medium {
    /// Into how many samples a step of the march is cut in each stored brick; worked out when it is asked for first.
    pub(crate) fn cuts(&self) -> &[u8] {
        self.cuts.get_or_init(|| of_bricks(&self.samples))
    }
}

fn of_bricks(samples: &[Sample]) -> Vec<u8> {
    let bricks = samples.par_chunks_exact(BRICK_SAMPLES);
    let rough: Vec<[f64; 2]> = bricks.map(roughness).collect();
    // In order, so that the sum is the same whatever the number of threads.
    let mean = rough.iter().map(|[_, mean]| mean).sum::<f64>() / rough.len().max(1) as f64;
    let usual = mean.sqrt();
    let cuts = |[greatest, _]: &[f64; 2]| {
        if usual > 0.0 {
            let cuts = (greatest / usual).powf(EXPONENT);
            cuts.round().clamp(1.0, MOST_CUTS) as u8
        } else {
            1
        }
    };
    rough.iter().map(cuts).collect()
}

/// The greatest second difference of f_v B between a brick's samples, and the mean of their squares; in any unit.
fn roughness(samples: &[Sample]) -> [f64; 2] {
    let exponent = (-SECOND_RADIATION_CONSTANT_NM_K / LAMBDA_NM) as f32;
    let mut light = [0.0_f32; BRICK_SAMPLES];
    for (light, [soot, kelvin]) in light.iter_mut().zip(samples) {
        *light = soot * lanes::exp(exponent / kelvin);
    }
    let (mut greatest, mut squares, mut count) = (0.0_f32, 0.0_f64, 0.0_f64);
    for stride in [1, SAMPLES, SAMPLES * SAMPLES] {
        // Of each line along the axis all but its ends; what reaches into the next line is left out.
        for at in stride..BRICK_SAMPLES - stride {
            let place = at / stride % SAMPLES;
            if place == 0 || place == SAMPLES - 1 {
                continue;
            }
            let second = light[at - stride] - 2.0 * light[at] + light[at + stride];
            greatest = greatest.max(second.abs());
            squares += f64::from(second).powi(2);
            count += 1.0;
        }
    }
    [f64::from(greatest), squares / count]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A brick of one temperature whose soot is given by place.
    fn brick(soot: impl Fn([usize; 3]) -> f32) -> Vec<Sample> {
        let place = |i: usize| [i % SAMPLES, i / SAMPLES % SAMPLES, i / (SAMPLES * SAMPLES)];
        (0..BRICK_SAMPLES)
            .map(|i| [soot(place(i)), 1800.0])
            .collect()
    }

    #[test]
    fn sheets_are_cut_finely_whatever_their_direction_and_ramps_are_not() {
        let ramp = brick(|[x, y, z]| 1e-7 * (x + 2 * y + 3 * z) as f32);
        let sheet = |axis: usize| brick(move |at| if at[axis] == 4 { 1e-6 } else { 0.0 });
        let all: Vec<Sample> = [&ramp, &sheet(0), &sheet(1), &sheet(2)]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let cuts = of_bricks(&all);
        assert_eq!(cuts[0], 1);
        // (2 / rms of (1, −2, 1) over a third of 7 places in three bricks of four)^0.4 is about 2.
        assert!(
            cuts[1] >= 2 && cuts[1] == cuts[2] && cuts[2] == cuts[3],
            "{cuts:?}"
        );
    }

    #[test]
    fn an_even_fire_keeps_to_the_nominal_step() {
        assert_eq!(of_bricks(&brick(|_| 1e-6)), [1]);
        assert!(of_bricks(&[]).is_empty());
    }
}
