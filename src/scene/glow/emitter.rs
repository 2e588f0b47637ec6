//! The lines and bands that a salt and a fuel have, with their strengths.

use std::f64::consts::PI;

use super::super::fuel::Fuel;
use super::super::salt::Salt;
use super::feature::Kind;
use crate::physics::bands::{self, Band};
use crate::physics::blackbody;
use crate::physics::constants::METRES_PER_NM;
use crate::physics::lines::Line;

/// Heat that a burning volume releases where its flame field is 1, W m⁻³: the mean over the volume of buoyant turbulent
/// flames (L. Orloff and J. de Ris, Symp. (Int.) Combust. 19 (1982) 885).
pub const HEAT_RELEASE: f64 = 1.2e6;
/// Share of the heat that leaves as light of CH, C₂ and CO₂* between 380 and 700 nm. Illustrative, to a factor of 3.
pub const LIGHT_OF_HEAT: f64 = 3e-5;
/// Classical electron radius, m (CODATA 2018): ∫ σ dλ = π r_e λ² f for each molecule.
const ELECTRON_RADIUS_M: f64 = 2.8179403262e-15;
/// Temperature at which the emitted areas of a molecule's bands have their published ratios, K.
const BANDS_K: f64 = 2000.0;

/// One line or band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Emitter {
    /// Free atoms: mole fraction in the undiluted gas.
    Line { line: Line, mole_fraction: f64 },
    /// A molecule's band: its area in the absorption coefficient for each molecule in a cubic metre, m³, and the mole fraction.
    Band {
        band: Band,
        area_m3: f64,
        mole_fraction: f64,
    },
    /// A radical's band: W m⁻³ sr⁻¹ where the flame field is 1.
    Radical { band: Band, emission: f64 },
}

impl Emitter {
    pub(super) fn kind(&self) -> Kind {
        match self {
            Self::Line { .. } => Kind::Line,
            Self::Band { .. } => Kind::Band,
            Self::Radical { .. } => Kind::Radical,
        }
    }
}

/// Lines of the free atoms and bands of the molecules of a salt.
pub(super) fn metal(emitters: &mut Vec<Emitter>, salt: Salt, mole_fraction: f64) {
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
                area_m3: PI * ELECTRON_RADIUS_M * lambda_m * lambda_m * oscillator,
                mole_fraction: mole_fraction * molecule.share,
            }
        }));
    }
}

/// Bands of the radicals of a fuel.
pub(super) fn radicals(emitters: &mut Vec<Emitter>, fuel: Fuel, amount: f64) {
    let groups = [bands::CH, bands::C2, bands::CO2];
    let all: f64 = groups.iter().copied().flatten().map(|band| band.area).sum();
    let full = HEAT_RELEASE * LIGHT_OF_HEAT / (4.0 * PI);
    for (group, share) in groups.into_iter().zip(fuel.row().radicals) {
        if share > 0.0 {
            emitters.extend(group.iter().map(|band| Emitter::Radical {
                band: *band,
                emission: amount * share * full * band.area / all,
            }));
        }
    }
}
