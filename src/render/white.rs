//! The white of a black body: what a candle, a lamp or daylight is to an eye that has got used to it.
//!
//! ```text
//! X = Σ B(λ, T) x̄(λ) Δλ,   Y and Z likewise, over the observer's table at 1 nm
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | T | temperature | K |
//! | B | spectral radiance of a black body, see [`crate::physics::blackbody`] | W m⁻² sr⁻¹ nm⁻¹ |
//! | x̄, ȳ, z̄ | the standard observer, see [`crate::colour::cie`] | 1 |
//!
//! **Validity.** T from some 200 K, below which no light is left in f64, upwards; below it, and for what is no
//! temperature, black.

use crate::colour::cie::{OBSERVER_FIRST_NM, OBSERVER_LAST_NM, colour_matching};
use crate::physics::blackbody::spectral_radiance;

/// XYZ of a black body in W m⁻² sr⁻¹.
pub fn black_body_xyz(temperature_k: f64) -> [f64; 3] {
    if !(temperature_k > 0.0 && temperature_k.is_finite()) {
        return [0.0; 3];
    }
    (OBSERVER_FIRST_NM as u32..=OBSERVER_LAST_NM as u32)
        .map(f64::from)
        .fold([0.0; 3], |sum, nm| {
            let radiance = spectral_radiance(nm, temperature_k);
            let matching = colour_matching(nm);
            [0, 1, 2].map(|i| sum[i] + radiance * matching[i])
        })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// T, X, Y, Z of the reference file, which is divided by Σ ȳ.
    fn references() -> Vec<[f64; 4]> {
        let csv = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/golden/cie_integrals.csv"
        ));
        let lines = csv.lines().filter(|line| !line.starts_with(['#', 'T']));
        lines
            .map(|line| {
                let mut fields = line.split(',').map(|field| field.parse().unwrap());
                std::array::from_fn(|_| fields.next().unwrap())
            })
            .collect()
    }

    #[test]
    fn a_white_is_the_black_body_of_the_reference() {
        let norm: f64 = (360..=830)
            .map(|nm| colour_matching(f64::from(nm))[1])
            .sum();
        let references = references();
        assert!(references.len() > 15);
        for [kelvin, expected @ ..] in references {
            for (got, expected) in black_body_xyz(kelvin).into_iter().zip(expected) {
                assert!((got / (expected * norm) - 1.0).abs() < 1e-13, "{kelvin} K");
            }
        }
    }

    #[test]
    fn what_is_no_temperature_is_black() {
        for kelvin in [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0] {
            assert_eq!(black_body_xyz(kelvin), [0.0; 3]);
        }
    }
}
