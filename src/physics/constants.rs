//! Constants of nature that more than one law uses.
//!
//! Since the SI of 2019 these three have no uncertainty: the units are defined by them.
//!
//! Source: BIPM, *The International System of Units*, 9th edition (2019), section 2.2, table 1.

/// Planck constant h, J s. Exact.
pub const PLANCK_J_S: f64 = 6.62607015e-34;

/// Boltzmann constant k, J K⁻¹. Exact.
pub const BOLTZMANN_J_PER_K: f64 = 1.380649e-23;

/// Speed of light in vacuum c₀, m s⁻¹. Exact.
pub const LIGHT_SPEED_M_PER_S: f64 = 299_792_458.0;

/// Metres in a nanometre.
pub const METRES_PER_NM: f64 = 1e-9;
