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
//! of it, at most X₀ (both are conserved scalars: Burke & Schumann 1928); below about 1000 K salts are no vapour. The
//! metal is in equilibrium with the gas, so Kirchhoff's law holds: lines and bands emit σ_a B and absorb.
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

use super::air::Air;
use super::fuel::Fuel;
use super::salt::Salt;
use crate::colour::cie;
use crate::physics::bands::{self, Band};
use crate::physics::blackbody;
use crate::physics::constants::{BOLTZMANN_J_PER_K, METRES_PER_NM};
use crate::physics::lines::{self, ATMOSPHERE_PA, Line};

/// Heat that a burning volume releases where its flame field is 1, W m⁻³: the mean over the volume of buoyant turbulent
/// flames (L. Orloff and J. de Ris, Symp. (Int.) Combust. 19 (1982) 885).
pub const HEAT_RELEASE: f64 = 1.2e6;
/// Share of the heat that leaves as light of CH, C₂ and CO₂* between 380 and 700 nm. Illustrative, to a factor of 3.
pub const LIGHT_OF_HEAT: f64 = 3e-5;
/// Temperatures between which a salt becomes vapour, K.
pub const VAPOUR_K: [f64; 2] = [900.0, 1200.0];

/// Classical electron radius, m (CODATA 2018): ∫ σ dλ = π r_e λ² f for each molecule.
const ELECTRON_RADIUS_M: f64 = 2.8179403262e-15;
/// Temperature at which the emitted areas of a molecule's bands have their published ratios, K.
const BANDS_K: f64 = 2000.0;
/// Borders of the parts in which the radicals' light is carried, nm: violet, blue, green, yellow and red.
const PARTS_NM: [f64; 5] = [360.0, 455.0, 500.0, 545.0, 830.0];
/// Spacing of the sums over shapes, nm.
const FINE_NM: f64 = 0.5;

/// What is asked for beside soot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GlowParams {
    /// The salt.
    pub salt: Salt,
    /// Mole fraction of its metal in the undiluted gas, parts in a million; 0 for none.
    pub salt_ppm: f64,
    /// Multiplies the light of the radicals; 0 for none.
    pub radicals: f64,
}

/// What glows in one flame's gas.
#[derive(Debug, Clone, PartialEq)]
pub struct Glow {
    emitters: Vec<Emitter>,
    /// Of the air, and of undiluted gas, K.
    dilution_k: [f64; 2],
}

/// One line or band.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Emitter {
    /// Free atoms: mole fraction in the undiluted gas.
    Line { line: Line, mole_fraction: f64 },
    /// A molecule's band: its area in the absorption coefficient for a molecule, m², and the mole fraction.
    Band {
        band: Band,
        area_m2: f64,
        mole_fraction: f64,
    },
    /// A radical's band: W m⁻³ sr⁻¹ where the flame field is 1.
    Radical { band: Band, emission: f64 },
}

/// A line, a band, or a part of the radicals' light as the march carries it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feature {
    /// Where soot's absorption and Planck's law are taken, nm.
    pub lambda_nm: f64,
    /// X, Y and Z of a radiance of 1 W m⁻² sr⁻¹ of its shape.
    pub colour: [f64; 3],
    /// What it is.
    pub source: Source,
}

/// Where a feature's light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// Gas in equilibrium: over a path it gives B times the width times what its growth says.
    Thermal {
        /// 2πγ of a line, the box of a band, nm.
        width_nm: f64,
        /// Depth y gathered in a metre, K m⁻¹, before vapour share, 1/T, Boltzmann factors.
        strength: f64,
        /// Lower level over k, K.
        lower_k: f64,
        /// How the width grows with depth.
        growth: Growth,
    },
    /// Radicals: W m⁻³ sr⁻¹ where the flame field is 1.
    Radical(f64),
}

/// How equivalent width over [`Source::Thermal`]'s width grows with depth y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Growth {
    /// A Lorentz line: the curve of growth.
    Line,
    /// A box: 1 − e^{−y}.
    Box,
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
            metal(&mut emitters, params.salt, 1e-6 * params.salt_ppm);
        }
        if params.radicals > 0.0 {
            radicals(&mut emitters, fuel, params.radicals);
        }
        let glow = Self {
            emitters,
            dilution_k: [air.temperature_k, fuel.row().flame_k],
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

    /// Whether hot gas glows by itself.
    pub fn has_metal(&self) -> bool {
        self.emitters.iter().any(Emitter::is_thermal)
    }

    /// Whether burning gas glows.
    pub fn has_radicals(&self) -> bool {
        !self.emitters.iter().all(Emitter::is_thermal)
    }

    /// Of the air, and of gas that holds all of its salt, K.
    pub fn dilution_k(&self) -> [f64; 2] {
        self.dilution_k
    }

    /// Share 0 to 1 of the salt's mole fraction that gas of a temperature holds as vapour.
    pub fn vapour_share(&self, temperature_k: f64) -> f64 {
        let [air, flame] = self.dilution_k;
        let mixed = ((temperature_k - air) / (flame - air)).clamp(0.0, 1.0);
        let [solid, gas] = VAPOUR_K;
        let t = ((temperature_k - solid) / (gas - solid)).clamp(0.0, 1.0);
        mixed * t * t * (3.0 - 2.0 * t)
    }

    /// The features in which the march carries this glow.
    pub fn features(&self) -> Vec<Feature> {
        let thermal = self.emitters.iter().filter_map(Emitter::feature);
        let parts = PARTS_NM
            .windows(2)
            .filter_map(|part| self.radical_part([part[0], part[1]]));
        thermal.chain(parts).collect()
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
                    area_m2,
                    mole_fraction,
                } => {
                    let x =
                        blackbody::SECOND_RADIATION_CONSTANT_NM_K / (band.at_nm * temperature_k);
                    let area = molecules * mole_fraction * area_m2 * -(-x).exp_m1();
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

    /// The radicals' light between two wavelengths as one feature, at the middle of what the eye takes of it.
    fn radical_part(&self, part_nm: [f64; 2]) -> Option<Feature> {
        let (mut emission, mut weighted_nm, mut xyz) = (0.0, 0.0, [0.0; 3]);
        for emitter in &self.emitters {
            let Emitter::Radical {
                band,
                emission: all,
            } = emitter
            else {
                continue;
            };
            for bin in fine_bins(part_nm) {
                let light = all * band.share_in(bin);
                let bar = cie::colour_matching(0.5 * (bin[0] + bin[1]));
                emission += light;
                weighted_nm += light * bar.iter().sum::<f64>() * 0.5 * (bin[0] + bin[1]);
                xyz = std::array::from_fn(|c| xyz[c] + light * bar[c]);
            }
        }
        (xyz[1] > 0.0).then(|| Feature {
            lambda_nm: weighted_nm / xyz.iter().sum::<f64>(),
            colour: xyz.map(|v| v / emission),
            source: Source::Radical(emission),
        })
    }
}

impl Emitter {
    fn is_thermal(&self) -> bool {
        !matches!(self, Self::Radical { .. })
    }

    /// A metal's line or band as a feature.
    fn feature(&self) -> Option<Feature> {
        // Molecules in a cubic metre times T, for a mole fraction of 1.
        let molecules_k = ATMOSPHERE_PA / BOLTZMANN_J_PER_K;
        match *self {
            Self::Line {
                line,
                mole_fraction,
            } => {
                let width_m = 2.0 * std::f64::consts::PI * line.half_width_m();
                Some(Feature {
                    lambda_nm: line.lambda_nm,
                    colour: cie::colour_matching(line.lambda_nm),
                    source: Source::Thermal {
                        width_nm: width_m / METRES_PER_NM,
                        strength: mole_fraction * molecules_k * line.cold_area_per_atom() / width_m,
                        lower_k: line.lower_k(),
                        growth: Growth::Line,
                    },
                })
            }
            Self::Band {
                band,
                area_m2,
                mole_fraction,
            } => {
                let width_nm = band.box_width_nm();
                Some(Feature {
                    lambda_nm: band.at_nm,
                    colour: colour_of(&band),
                    source: Source::Thermal {
                        width_nm,
                        strength: mole_fraction * molecules_k * area_m2
                            / (width_nm * METRES_PER_NM),
                        lower_k: 0.0,
                        growth: Growth::Box,
                    },
                })
            }
            Self::Radical { .. } => None,
        }
    }
}

/// Lines of the free atoms and bands of the molecules of a salt.
fn metal(emitters: &mut Vec<Emitter>, salt: Salt, mole_fraction: f64) {
    let row = salt.row();
    emitters.extend(row.lines.iter().map(|&line| Emitter::Line {
        line,
        mole_fraction: mole_fraction * row.free,
    }));
    for molecule in row.molecules {
        // Areas are published as emitted; absorption has them without λ² and Planck's law.
        let absorbed = |band: &Band| {
            band.area / (band.at_nm.powi(2) * blackbody::spectral_radiance(band.at_nm, BANDS_K))
        };
        let all: f64 = molecule.bands.iter().map(absorbed).sum();
        emitters.extend(molecule.bands.iter().map(|band| {
            let lambda_m = band.at_nm * METRES_PER_NM;
            let oscillator = molecule.oscillator * absorbed(band) / all;
            Emitter::Band {
                band: *band,
                area_m2: std::f64::consts::PI
                    * ELECTRON_RADIUS_M
                    * lambda_m
                    * lambda_m
                    * oscillator,
                mole_fraction: mole_fraction * molecule.share,
            }
        }));
    }
}

/// Bands of the radicals of a fuel.
fn radicals(emitters: &mut Vec<Emitter>, fuel: Fuel, amount: f64) {
    let groups = [bands::CH, bands::C2, bands::CO2];
    let all: f64 = groups.iter().copied().flatten().map(|band| band.area).sum();
    let full = HEAT_RELEASE * LIGHT_OF_HEAT / (4.0 * std::f64::consts::PI);
    for (group, share) in groups.into_iter().zip(fuel.row().radicals) {
        if share > 0.0 {
            emitters.extend(group.iter().map(|band| Emitter::Radical {
                band: *band,
                emission: amount * share * full * band.area / all,
            }));
        }
    }
}

/// Mean of the observer over a band.
fn colour_of(band: &Band) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for bin in fine_bins(band.reach_nm()) {
        let bar = cie::colour_matching(0.5 * (bin[0] + bin[1]));
        sum = std::array::from_fn(|c| sum[c] + band.share_in(bin) * bar[c]);
    }
    sum
}

fn fine_bins([from, to]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let count = ((to - from) / FINE_NM).ceil();
    let width = (to - from) / count;
    (0..count as u32).map(move |i| {
        let start = from + f64::from(i) * width;
        [start, start + width]
    })
}
