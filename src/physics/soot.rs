//! Absorption and scattering of light by soot.
//!
//! ```text
//! σ_a = 6π E(m) f_v / λ = 36π f_v n k / (λ D)
//! σ_s = 4π F(m) f_v x³ / λ,   x = 2πR/λ,   so   σ_s/σ_a = (2/3) x³ F/E
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | σ_a, σ_s | absorption and scattering coefficient | m⁻¹ |
//! | f_v | soot volume fraction, N·(4/3)πR³ | 1 |
//! | E, F, D | functions of the index m = n − ik, see [`super::soot_index`] | 1 |
//! | λ | vacuum wavelength | m in the formulae, nm in the arguments |
//! | R | radius of the primary particles | m |
//! | x | size parameter | 1 |
//!
//! **Validity.** Spheres small against the wavelength (Rayleigh), far enough apart to act alone. Against the Mie series
//! for propane soot, σ_a is low by 2 % at x = 0.17, 5 % at 0.30, 11 % at 0.49 and 13 % at 0.59; σ_s is within 1 % up to
//! x = 0.49, then 7 % high at 0.69 and 29 % at 0.91. At 550 nm those x are R = 15, 26, 43, 52, 60 and 80 nm.
//!
//! Scattering is therefore that of [`super::mie`]: the ratio above times Q_sca of the sphere over its small-particle
//! limit, and the sphere's mean cosine. Absorption stays the small-particle law, for that is what a file's volume
//! fraction was measured with; [`SootLaw::absorption_left_out`] says what Mie's series would add.
//!
//! **The law of Hottel and Broughton** replaces the dispersion of the index by a power found by experiment:
//! σ_a(λ) = σ_a(550 nm)·(550 nm/λ)^1.39, with E(m) taken at 550 nm only. It was measured in visible light.
//!
//! **Sources.** C. F. Bohren and D. R. Huffman, *Absorption and Scattering of Light by Small Particles* (1983), eq. 5.7
//! to 5.9; H. C. Hottel and F. P. Broughton, Ind. Eng. Chem. Anal. Ed. 4 (1932) 166; G. Dorta-Perez, *Realistic fire
//! rendering* (2015), eq. 3.7, whose factor π is restored here.

use std::f64::consts::PI;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::constants::METRES_PER_NM;
use super::mie::{self, Efficiencies};
use super::soot_index::{self, ComplexIndex, SootIndex};

/// Radius at which a soot volume fraction given by a file is taken to hold, nm. Midway in the sizes found in flames.
pub const REFERENCE_RADIUS_NM: f64 = 21.25;
/// Smallest radius of primary particles found in flames, nm: the diameters reported begin at 50 Å.
pub const SMALLEST_RADIUS_NM: f64 = 2.5;
/// Largest radius of primary particles found in flames, nm: the diameters reported end at 800 Å.
pub const LARGEST_RADIUS_NM: f64 = 40.0;
/// Largest radius for which the small-particle formulae are offered, nm: aggregates thought of as spheres.
pub const LARGEST_AGGREGATE_RADIUS_NM: f64 = 80.0;

/// Exponent of Hottel and Broughton's law, dimensionless (1932).
const HOTTEL_EXPONENT: f64 = 1.39;
/// Wavelength at which Hottel and Broughton's law is tied to the index, nm.
const HOTTEL_REFERENCE_NM: f64 = 550.0;
/// Wavelength whose absorption grey soot has everywhere, nm: where the eye is most sensitive.
const GREY_REFERENCE_NM: f64 = 550.0;

/// How absorption depends on wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SootModel {
    /// The index by Chang and Charalampopoulos (1990), the same for all fuels.
    #[default]
    Chang,
    /// The fuel's own table by Dalzell and Sarofim (1969).
    DalzellSarofim,
    /// The power law of Hottel and Broughton (1932), tied to the fuel's table at 550 nm.
    HottelBroughton,
    /// The same for all colours, as Chang and Charalampopoulos's at 550 nm: no soot is so, but it shows Planck's law
    /// alone.
    Grey,
}

impl SootModel {
    /// All models, the default first.
    pub const ALL: [Self; 4] = [
        Self::Chang,
        Self::DalzellSarofim,
        Self::HottelBroughton,
        Self::Grey,
    ];

    /// The name used in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Chang => "chang",
            Self::DalzellSarofim => "dalzell-sarofim",
            Self::HottelBroughton => "hottel-broughton",
            Self::Grey => "grey",
        }
    }
}

impl fmt::Display for SootModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What is held when the particle radius changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hold {
    /// The number of particles: larger ones hold more soot, σ_a ∝ R³.
    #[default]
    Number,
    /// The volume of soot: the radius changes scattering only.
    Volume,
}

/// By how much the volume fraction at [`REFERENCE_RADIUS_NM`] changes at another radius: (R/21.25 nm)³ if the number of
/// particles is held, 1 if their volume is. Precondition: `radius_nm` ≥ 0 and finite.
pub fn volume_fraction_factor(hold: Hold, radius_nm: f64) -> f64 {
    match hold {
        Hold::Number => (radius_nm / REFERENCE_RADIUS_NM).powi(3),
        Hold::Volume => 1.0,
    }
}

/// Absorption coefficient σ_a in m⁻¹ of soot of a given index.
///
/// Preconditions: `volume_fraction` in 0..=1, `lambda_nm` > 0. A volume fraction of 0 gives exactly 0.
pub fn absorption_coefficient(volume_fraction: f64, lambda_nm: f64, index: ComplexIndex) -> f64 {
    debug_assert!((0.0..=1.0).contains(&volume_fraction), "{volume_fraction}");
    6.0 * PI * index.absorption_function() * volume_fraction / (lambda_nm * METRES_PER_NM)
}

/// Scattering coefficient σ_s in m⁻¹ of soot of a given index, in a form that needs neither N nor R⁶: a radius of 0 and
/// a particle that does not absorb are both fine.
///
/// Preconditions: `volume_fraction` in 0..=1, `lambda_nm` > 0, `radius_m` ≥ 0.
pub fn scattering_coefficient(
    volume_fraction: f64,
    lambda_nm: f64,
    radius_m: f64,
    index: ComplexIndex,
) -> f64 {
    debug_assert!((0.0..=1.0).contains(&volume_fraction), "{volume_fraction}");
    let x = size_parameter(lambda_nm, radius_m);
    4.0 * PI * index.scattering_function() * volume_fraction * x.powi(3)
        / (lambda_nm * METRES_PER_NM)
}

/// Size parameter x = 2πR/λ.
fn size_parameter(lambda_nm: f64, radius_m: f64) -> f64 {
    2.0 * PI * radius_m / (lambda_nm * METRES_PER_NM)
}

/// The optics of one kind of soot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SootLaw {
    /// How absorption depends on wavelength.
    pub model: SootModel,
    /// Whose table Dalzell and Sarofim's index comes from; the models [`SootModel::Chang`] and
    /// [`SootModel::Grey`] do not look at it.
    pub fuel_index: SootIndex,
}

impl SootLaw {
    /// The law of a model for a fuel's soot. Models that do not look at the fuel give one law for all, so that equal
    /// laws are equal.
    pub fn new(model: SootModel, fuel_index: SootIndex) -> Self {
        let fuel_index = match model {
            SootModel::Chang | SootModel::Grey => SootIndex::default(),
            SootModel::DalzellSarofim | SootModel::HottelBroughton => fuel_index,
        };
        Self { model, fuel_index }
    }

    /// The index at a wavelength. Hottel and Broughton's law stands in for dispersion, so there it is that of 550 nm.
    pub fn complex_index(self, lambda_nm: f64) -> ComplexIndex {
        match self.model {
            SootModel::Chang => soot_index::chang(lambda_nm),
            SootModel::DalzellSarofim => soot_index::dalzell_sarofim(self.fuel_index, lambda_nm),
            SootModel::HottelBroughton => {
                soot_index::dalzell_sarofim(self.fuel_index, HOTTEL_REFERENCE_NM)
            }
            SootModel::Grey => soot_index::chang(GREY_REFERENCE_NM),
        }
    }

    /// Absorption coefficient per volume fraction σ_a/f_v in m⁻¹. Precondition: `lambda_nm` > 0.
    pub fn absorption_per_volume_fraction(self, lambda_nm: f64) -> f64 {
        let index = self.complex_index(lambda_nm);
        match self.model {
            SootModel::Chang | SootModel::DalzellSarofim => {
                absorption_coefficient(1.0, lambda_nm, index)
            }
            SootModel::HottelBroughton => {
                // The power is of a ratio of wavelengths: with λ in metres alone it would be wrong by a factor of 276.
                absorption_coefficient(1.0, HOTTEL_REFERENCE_NM, index)
                    * (HOTTEL_REFERENCE_NM / lambda_nm).powf(HOTTEL_EXPONENT)
            }
            SootModel::Grey => absorption_coefficient(1.0, GREY_REFERENCE_NM, index),
        }
    }

    /// σ_s/σ_a = (2/3) x³ F/E in the limit of small particles. Scattering is formed as σ_a times a ratio, because R⁶
    /// underflows single precision.
    ///
    /// Preconditions: `lambda_nm` > 0, `radius_m` ≥ 0.
    pub fn small_particle_scattering_ratio(self, lambda_nm: f64, radius_m: f64) -> f64 {
        let index = self.complex_index(lambda_nm);
        let x = size_parameter(lambda_nm, radius_m);
        2.0 / 3.0 * x.powi(3) * index.scattering_function() / index.absorption_function()
    }

    /// σ_s of spheres of this radius, by Mie's series, over the small-particle σ_a: what the absorption of this law is
    /// multiplied by.
    ///
    /// Preconditions: `lambda_nm` > 0, `radius_m` ≥ 0.
    pub fn scattering_ratio(self, lambda_nm: f64, radius_m: f64) -> f64 {
        let small = self.small_particle_scattering_ratio(lambda_nm, radius_m);
        let spheres = self.spheres(lambda_nm, radius_m);
        small * spheres.map_or(1.0, |[mie, limit]| mie.scattering / limit.scattering)
    }

    /// Mean cosine of the scattering of spheres of this radius, by Mie's series; 0 for the smallest.
    ///
    /// Preconditions: `lambda_nm` > 0, `radius_m` ≥ 0.
    pub fn asymmetry(self, lambda_nm: f64, radius_m: f64) -> f64 {
        let spheres = self.spheres(lambda_nm, radius_m);
        spheres.map_or(0.0, |[mie, _]| mie.asymmetry)
    }

    /// By which share Mie's absorption exceeds that of small particles, which is what is computed: 0.05 is 5 %.
    ///
    /// Preconditions: `lambda_nm` > 0, `radius_m` ≥ 0.
    pub fn absorption_left_out(self, lambda_nm: f64, radius_m: f64) -> f64 {
        let spheres = self.spheres(lambda_nm, radius_m);
        spheres.map_or(0.0, |[mie, limit]| mie.absorption / limit.absorption - 1.0)
    }

    /// A sphere of this radius by Mie's series, and in the limit of small ones; `None` where they do not differ.
    fn spheres(self, lambda_nm: f64, radius_m: f64) -> Option<[Efficiencies; 2]> {
        let index = self.complex_index(lambda_nm);
        let x = size_parameter(lambda_nm, radius_m);
        (x >= mie::SMALLEST).then(|| {
            [
                Efficiencies::of_sphere(index, x),
                Efficiencies::of_small_sphere(index, x),
            ]
        })
    }
}

#[cfg(test)]
mod tests;
