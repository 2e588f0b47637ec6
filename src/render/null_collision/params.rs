//! What the reference simulates.

use crate::physics::blackbody;
use crate::physics::phase::HenyeyGreenstein;

/// What the reference simulates. By default what the march does: emission and absorption before black surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// How the medium scatters.
    pub scattering: Scattering,
    /// Into which directions it does, at all wavelengths; [`Scattering::Flame`] has phases of its own.
    pub phase: HenyeyGreenstein,
    /// How often light may have been scattered before it reaches the eye. What is scattered once more is lost, so each
    /// order adds to the picture; 0 shows the flame dimmed by scattering as well as by absorption.
    pub max_bounces: u32,
    /// How often light must have been scattered before it reaches the eye to be counted: with 0 all is, with 2 what a
    /// picture of light scattered once leaves out. Nothing where it exceeds `max_bounces`.
    pub min_bounces: u32,
    /// How often light may have been reflected by the surfaces of the stage. 1 shows them in the fire's own light; with 0
    /// they are black, and so is what would be reflected once more.
    pub max_reflections: u32,
    /// What shines from all sides.
    pub environment: Environment,
    /// Collisions that each flight whose light counts spends where the medium glows, beyond those that extinction asks for:
    /// more make a path dearer and its light less noisy. 0 or more.
    pub emission_points: f64,
    /// So many collisions in proportion to extinction, if it asks for fewer, on flights that may still be scattered, which
    /// about two in five of them then are, however thin the medium. Without, light that is rarely scattered is rarely seen, and the few paths that see it
    /// do not show how uncertain their mean is. 0 or more; with 0 light is scattered as often as in nature.
    pub scattering_points: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            scattering: Scattering::Off,
            phase: HenyeyGreenstein::ISOTROPIC,
            max_bounces: u32::MAX,
            min_bounces: 0,
            max_reflections: 1,
            environment: Environment::Dark,
            emission_points: 16.0,
            scattering_points: 0.0,
        }
    }
}

/// How the medium scatters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scattering {
    /// Not at all: light is absorbed and emitted only.
    Off,
    /// As small particles of this radius (nm, at least 0) do, beside absorbing as they would without.
    Soot {
        /// Radius of a primary particle, nm.
        radius_nm: f64,
    },
    /// As the flame itself says: soot and smoke each with its own coefficient, and at each wavelength with the phase
    /// function of its own mean cosine. Nothing where its scattering is not to be computed.
    Flame,
    /// This share (0 to 1) of what the soot would absorb is scattered instead: extinction stays. With 1 nothing is
    /// absorbed and nothing glows.
    Albedo(f64),
}

/// Light that comes from all sides alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Environment {
    /// None.
    Dark,
    /// The same spectral radiance at all wavelengths, W m⁻² sr⁻¹ nm⁻¹.
    Uniform(f64),
    /// A black body of this temperature, K.
    BlackBody(f64),
}

impl Environment {
    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹.
    pub fn radiance(self, lambda_nm: f64) -> f64 {
        match self {
            Self::Dark => 0.0,
            Self::Uniform(radiance) => radiance,
            Self::BlackBody(kelvin) => blackbody::spectral_radiance(lambda_nm, kelvin),
        }
    }
}
