//! What glows in the hot gas beside soot: metals' lines and bands, and the radicals of the burning itself.
//!
//! # Metals
//!
//! A salt comes with the fuel. Mixing with air dilutes it as it dilutes the heat, so gas of temperature T holds
//!
//! ```text
//! X(T) = X₀ (T − T_air)/(T_flame − T_air) · smoothstep(900 K, 1200 K, T)
//! ```
//!
//! of it, at most X₀; below about 1000 K salts are no vapour. The metal is in equilibrium with the gas, so Kirchhoff's law holds: lines and bands emit σ_a B and absorb.
//!
//! # Radicals
//!
//! CH, C₂ and CO₂* are born excited in the reaction zone: a source j in proportion to the flame field, without
//! absorption. How much is *illustrative*: [`HEAT_RELEASE`] where the field is 1, of which [`LIGHT_OF_HEAT`] is light of
//! these bands, with the spectrum measured on a butane torch.
//!
//! # On a set of wavelengths
//!
//! A line is some picometres wide and a band some nanometres, so no set that is made for soot can hold them. Each
//! becomes a [`Feature`] with a wavelength of its own, at which soot dims it, and with its colour, the mean of the
//! observer over its shape. A set is so *extended*, not refitted, and the area of every line and band is that of the
//! laws whatever the set. Radicals are taken together in four parts of the spectrum.

use super::air::{Air, products_share};
use super::fuel::Fuel;
use super::salt::Salt;
use crate::physics::blackbody;
use crate::physics::constants::METRES_PER_NM;
use crate::physics::lines::{self, ATMOSPHERE_PA};

mod emitter;
mod feature;

pub use emitter::{HEAT_RELEASE, LIGHT_OF_HEAT};
pub use feature::{Feature, Growth, Kind, Source, Spread};

use emitter::Emitter;

/// Temperatures between which a salt becomes vapour, K.
pub const VAPOUR_K: [f64; 2] = [900.0, 1200.0];

/// What is asked for beside soot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlowParams {
    /// The salt.
    pub salt: Salt,
    /// Mole fraction of its metal in the undiluted gas, parts in a million; 0 for none.
    pub salt_ppm: f64,
    /// Whether its atoms' lines are wanted.
    pub lines: bool,
    /// Whether its molecules' bands are wanted.
    pub bands: bool,
    /// Multiplies the light of the radicals; 0 for none.
    pub radicals: f64,
    /// Whether gas counts as burning by its heat where there is no flame field.
    pub by_heat: bool,
    /// Temperature of gas of which the volume says nothing, K: gas as cool as that holds no salt, even where the file's
    /// mapping makes it hotter than the air.
    pub clear_k: f64,
}

impl Default for GlowParams {
    /// Nothing; of a salt that is put in, all that it has.
    fn default() -> Self {
        Self {
            salt: Salt::default(),
            salt_ppm: 0.0,
            lines: true,
            bands: true,
            radicals: 0.0,
            by_heat: false,
            clear_k: 0.0,
        }
    }
}

/// What glows in one flame's gas.
#[derive(Debug, Clone, PartialEq)]
pub struct Glow {
    emitters: Vec<Emitter>,
    /// Of the air, and of undiluted gas, K.
    dilution_k: [f64; 2],
}

/// What the gas does to light in a bin, beside soot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GasCoefficients {
    /// Mean absorption coefficient, 1/m.
    pub absorption: f64,
    /// Mean emission coefficient, W m⁻³ sr⁻¹ nm⁻¹.
    pub emission: f64,
}

impl Glow {
    /// What glows in the gas of a fuel.
    pub fn new(params: &GlowParams, fuel: Fuel, air: &Air) -> Self {
        let mut emitters = Vec::new();
        if params.salt_ppm > 0.0 {
            emitter::metal(&mut emitters, params.salt, 1e-6 * params.salt_ppm);
            emitters.retain(|emitter| match emitter.kind() {
                Kind::Line => params.lines,
                Kind::Band => params.bands,
                Kind::Radical => true,
            });
        }
        if params.radicals > 0.0 {
            emitter::radicals(&mut emitters, fuel, params.radicals);
        }
        let glow = Self {
            emitters,
            dilution_k: [air.temperature_k.max(params.clear_k), fuel.row().flame_k],
        };
        // Without metal its dilution is nothing: so that equal glows are equal.
        if glow.has_metal() {
            glow
        } else {
            Self {
                dilution_k: [0.0, 1.0],
                ..glow
            }
        }
    }

    /// Whether nothing glows but soot.
    pub fn is_empty(&self) -> bool {
        self.emitters.is_empty()
    }

    /// Whether anything of a kind glows.
    pub fn has(&self, kind: Kind) -> bool {
        self.emitters.iter().any(|emitter| emitter.kind() == kind)
    }

    /// Whether hot gas glows by itself.
    pub fn has_metal(&self) -> bool {
        self.has(Kind::Line) || self.has(Kind::Band)
    }

    /// Whether burning gas glows.
    pub fn has_radicals(&self) -> bool {
        self.has(Kind::Radical)
    }

    /// What of it is of one kind, in the same gas.
    #[must_use]
    pub fn only(&self, kind: Kind) -> Self {
        let emitters = self.emitters.iter().copied();
        Self {
            emitters: emitters.filter(|emitter| emitter.kind() == kind).collect(),
            dilution_k: self.dilution_k,
        }
    }

    /// Of the air, and of gas that holds all of its salt, K.
    pub fn dilution_k(&self) -> [f64; 2] {
        self.dilution_k
    }

    /// Temperature above which gas holds any of the salt as vapour, K.
    pub fn vapour_above_k(&self) -> f64 {
        self.dilution_k[0].max(VAPOUR_K[0])
    }

    /// Share 0 to 1 of the salt's mole fraction that gas of a temperature holds as vapour.
    pub fn vapour_share(&self, temperature_k: f64) -> f64 {
        let mixed = products_share(self.dilution_k, temperature_k);
        let [solid, gas] = VAPOUR_K;
        let t = ((temperature_k - solid) / (gas - solid)).clamp(0.0, 1.0);
        mixed * t * t * (3.0 - 2.0 * t)
    }

    /// Vacuum wavelengths of the atoms' lines that a range does not hold, nm.
    pub fn lines_outside(&self, range_nm: [f64; 2]) -> Vec<f64> {
        let lines = self.emitters.iter().filter_map(|emitter| match emitter {
            Emitter::Line { line, .. } => Some(line.lambda_nm),
            Emitter::Band { .. } | Emitter::Radical { .. } => None,
        });
        lines
            .filter(|&nm| !lines::is_in_bin(nm, range_nm))
            .collect()
    }

    /// The features in which the march carries this glow.
    pub fn features(&self) -> Vec<Feature> {
        feature::features(&self.emitters)
    }

    /// Means over a bin of vacuum wavelengths, thin: what a gas does that is so dilute that no line is saturated. A line
    /// belongs to the one bin that holds it.
    ///
    /// `flame` is the flame field, 0 to 1; preconditions: `temperature_k` > 0, the bin is not empty.
    pub fn coefficients(
        &self,
        bin_nm: [f64; 2],
        temperature_k: f64,
        flame: f64,
    ) -> GasCoefficients {
        let width_nm = bin_nm[1] - bin_nm[0];
        let molecules = lines::number_density(
            self.vapour_share(temperature_k),
            ATMOSPHERE_PA,
            temperature_k,
        );
        let mut sum = GasCoefficients::default();
        let mut thermal = |area: f64, nm: f64| {
            let absorption = area / METRES_PER_NM / width_nm;
            sum.absorption += absorption;
            sum.emission += absorption * blackbody::spectral_radiance(nm, temperature_k);
        };
        let mut source = 0.0;
        for emitter in &self.emitters {
            match *emitter {
                Emitter::Line {
                    line,
                    mole_fraction,
                } => {
                    if lines::is_in_bin(line.lambda_nm, bin_nm) {
                        let area = molecules * mole_fraction * line.area_per_atom(temperature_k);
                        thermal(area, line.lambda_nm);
                    }
                }
                Emitter::Band {
                    band,
                    area_m3,
                    mole_fraction,
                } => {
                    let x =
                        blackbody::SECOND_RADIATION_CONSTANT_NM_K / (band.at_nm * temperature_k);
                    let area = molecules * mole_fraction * area_m3 * -(-x).exp_m1();
                    thermal(area * band.share_in(bin_nm), band.at_nm);
                }
                Emitter::Radical { band, emission } => {
                    source += emission * flame * band.share_in(bin_nm) / width_nm;
                }
            }
        }
        sum.emission += source;
        sum
    }
}
