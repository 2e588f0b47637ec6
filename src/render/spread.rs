//! Light that is worked out at a few wavelengths, and asked for at many.
//!
//! Light from all sides is smooth over wavelengths: black bodies' through soot. Over that of one black body it is nearly a
//! polynomial in λ, which is taken through the six nearest of the wavelengths at which it is known (Lagrange); beyond the
//! outermost it stays as it is there.
//!
//! ```text
//! L(λ) = B(λ, T) Σ_i ℓ_i(λ) L(λ_i)/B(λ_i, T)
//! ```
//!
//! **Validity.** From 16 wavelengths, for black bodies of 0.6 to 1.4 T, as they are or scattered as λ⁻⁴: within 0.2 %
//! between the outermost wavelengths, and beyond them, where the eye sees next to nothing, by half.

use crate::physics::blackbody;

/// Wavelengths that each value is made of.
const TAPS: usize = 6;
/// Most wavelengths that are known.
pub(super) const MOST_FEW: usize = 16;

/// From a few wavelengths to many.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spread {
    /// For each of the many, the first of the few that it is made of, and their weights.
    rows: Vec<(usize, [f32; TAPS])>,
}

impl Spread {
    /// From wavelengths to others, nm; both rise. The light is much like that of a black body of so many kelvin. `None` where
    /// there are fewer than six or more than sixteen to start from.
    pub(super) fn new(few: &[f64], many: &[f64], kelvin: f64) -> Option<Self> {
        if !(TAPS..=MOST_FEW).contains(&few.len()) {
            return None;
        }
        let row = |&nm: &f64| {
            let above = few.partition_point(|&known| known < nm);
            let first = above.saturating_sub(TAPS / 2).min(few.len() - TAPS);
            let inside = nm >= few[0] && nm <= few[few.len() - 1];
            let taken = match (inside, nm < few[0]) {
                (true, _) => 0..TAPS,
                (false, true) => 0..1,
                (false, false) => TAPS - 1..TAPS,
            };
            let mut weights = [0.0; TAPS];
            for i in taken.clone() {
                let known = few[first + i];
                let polynomial: f64 = taken
                    .clone()
                    .filter(|&j| j != i)
                    .map(|j| (nm - few[first + j]) / (known - few[first + j]))
                    .product();
                let [here, there] = [nm, known].map(|nm| blackbody::spectral_radiance(nm, kelvin));
                weights[i] = (polynomial * here / there) as f32;
            }
            (first, weights)
        };
        Some(Self {
            rows: many.iter().map(row).collect(),
        })
    }

    /// The value at one of the many.
    #[inline(always)]
    pub(super) fn at(&self, which: usize, few: impl Fn(usize) -> f32) -> f32 {
        let (first, weights) = self.rows[which];
        let mut sum = 0.0;
        for (i, weight) in weights.into_iter().enumerate() {
            sum += weight * few(first + i);
        }
        sum
    }

    /// How many values it makes.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use crate::physics::soot::SootLaw;
    use crate::scene::WavelengthSet;

    #[test]
    fn fires_light_is_found_between_a_few_wavelengths() {
        let few = WavelengthSet::Plain(16)
            .wavelengths(SootLaw::default())
            .nodes_nm;
        let many = WavelengthSet::Plain(64)
            .wavelengths(SootLaw::default())
            .nodes_nm;
        let spread = Spread::new(&few, &many, 1500.0).unwrap();
        assert_eq!(spread.len(), 64);
        for kelvin in [900.0, 1500.0, 2000.0, 2100.0] {
            let light = |nm: f64| blackbody::spectral_radiance(nm, kelvin);
            let scattered = |nm: f64| light(nm) * (nm / 555.0).powi(-4);
            for spectrum in [&light as &dyn Fn(f64) -> f64, &scattered] {
                for (i, &nm) in many.iter().enumerate() {
                    let found = spread.at(i, |i| spectrum(few[i]) as f32);
                    let error = f64::from(found) / spectrum(nm) - 1.0;
                    let inside = (few[0]..few[15]).contains(&nm);
                    let bound = if inside { 2e-3 } else { 0.5 };
                    assert!(error.abs() < bound, "{kelvin} K, {nm} nm: {error}");
                }
            }
        }
    }

    #[test]
    fn what_is_known_stays_as_it_is() {
        let few = [410.0, 470.0, 520.0, 570.0, 620.0, 690.0];
        let spread = Spread::new(&few, &few, 1500.0).unwrap();
        let value = |i: usize| [3.0_f32, 1.0, 4.0, 1.0, 5.0, 9.0][i];
        for i in 0..6 {
            assert_eq!(spread.at(i, value), value(i));
        }
        assert_eq!(Spread::new(&few[..5], &few, 1500.0), None);
    }
}
