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
