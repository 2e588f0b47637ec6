//! Lines, bands and radicals as the march carries them: each at a wavelength of its own, with its colour.

use super::emitter::Emitter;
use crate::colour::cie;
use crate::physics::bands::Band;
use crate::physics::constants::{BOLTZMANN_J_PER_K, METRES_PER_NM};
use crate::physics::lines::{self, ATMOSPHERE_PA};

/// Borders of the parts in which the radicals' light is carried, nm: violet, blue, green, yellow and red.
const PARTS_NM: [f64; 5] = [360.0, 455.0, 500.0, 545.0, 830.0];
/// Spacing of the sums over shapes, nm.
const FINE_NM: f64 = 0.5;

/// A line, a band, or a part of the radicals' light as the march carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Where soot's absorption and Planck's law are taken, nm.
    pub lambda_nm: f64,
    /// X, Y and Z of a radiance of 1 W m⁻² sr⁻¹ of its shape.
    pub colour: [f64; 3],
    /// What it is.
    pub source: Source,
    /// How its light lies over the wavelengths.
    pub spread: Spread,
}

/// How a feature's light lies over the wavelengths.
#[derive(Debug, Clone, PartialEq)]
pub enum Spread {
    /// All at one wavelength, nm.
    Line(f64),
    /// Bands with their shares of the light, cut off at two wavelengths, nm.
    Bands {
        /// Where it is cut off.
        within_nm: [f64; 2],
        /// Each with its light.
        bands: Vec<(Band, f64)>,
    },
}

impl Spread {
    /// Share 0 to 1 of the light that lies in a bin of wavelengths; a line lies in one bin only.
    pub fn share_in(&self, [from, to]: [f64; 2]) -> f64 {
        match self {
            Self::Line(nm) => f64::from(u8::from(lines::is_in_bin(*nm, [from, to]))),
            Self::Bands { within_nm, bands } => {
                let light_in = |bin: [f64; 2]| -> f64 {
                    let light = bands.iter().map(|(band, light)| light * band.share_in(bin));
                    light.sum()
                };
                let bin = [from.max(within_nm[0]), to.min(within_nm[1])];
                if bin[0] < bin[1] {
                    light_in(bin) / light_in(*within_nm)
                } else {
                    0.0
                }
            }
        }
    }

    /// Mean of the observer over the light.
    fn colour(&self) -> [f64; 3] {
        match self {
            Self::Line(nm) => cie::colour_matching(*nm),
            Self::Bands { within_nm, .. } => {
                let mut sum = [0.0; 3];
                for bin in fine_bins(*within_nm) {
                    let bar = cie::colour_matching(0.5 * (bin[0] + bin[1]));
                    let share = self.share_in(bin);
                    sum = std::array::from_fn(|c| sum[c] + share * bar[c]);
                }
                sum
            }
        }
    }

    /// Middle of what the eye takes of the light, nm; `None` if it takes nothing.
    fn middle_nm(&self) -> Option<f64> {
        let Self::Bands { within_nm, .. } = self else {
            return None;
        };
        let (mut seen, mut weighted_nm) = (0.0, 0.0);
        for bin in fine_bins(*within_nm) {
            let nm = 0.5 * (bin[0] + bin[1]);
            let light = self.share_in(bin) * cie::colour_matching(nm).iter().sum::<f64>();
            seen += light;
            weighted_nm += light * nm;
        }
        (seen > 0.0).then(|| weighted_nm / seen)
    }
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

/// Whose light a feature is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Of a metal's free atoms.
    Line,
    /// Of a metal's molecules.
    Band,
    /// Of radicals where gas burns.
    Radical,
}

impl Feature {
    /// Whose light it is.
    pub fn kind(&self) -> Kind {
        match self.source {
            Source::Thermal {
                growth: Growth::Line,
                ..
            } => Kind::Line,
            Source::Thermal {
                growth: Growth::Box,
                ..
            } => Kind::Band,
            Source::Radical(_) => Kind::Radical,
        }
    }

    /// Whether it is light of radicals.
    pub fn is_radical(&self) -> bool {
        self.kind() == Kind::Radical
    }
}

/// The features of emitters: thermal ones one by one, then the radicals' light part by part.
pub(super) fn features(emitters: &[Emitter]) -> Vec<Feature> {
    let thermal = emitters.iter().filter_map(thermal);
    let parts = PARTS_NM
        .windows(2)
        .filter_map(|part| radical_part(emitters, [part[0], part[1]]));
    thermal.chain(parts).collect()
}

/// A metal's line or band as a feature.
fn thermal(emitter: &Emitter) -> Option<Feature> {
    // Molecules in a cubic metre times T, for a mole fraction of 1.
    let molecules_k = ATMOSPHERE_PA / BOLTZMANN_J_PER_K;
    let feature = |lambda_nm: f64, spread: Spread, source: Source| Feature {
        lambda_nm,
        colour: spread.colour(),
        source,
        spread,
    };
    match *emitter {
        Emitter::Line {
            line,
            mole_fraction,
        } => {
            let width_m = 2.0 * std::f64::consts::PI * line.half_width_m();
            let source = Source::Thermal {
                width_nm: width_m / METRES_PER_NM,
                strength: mole_fraction * molecules_k * line.cold_area_per_atom() / width_m,
                lower_k: line.lower_k(),
                growth: Growth::Line,
            };
            let spread = Spread::Line(line.lambda_nm);
            Some(feature(line.lambda_nm, spread, source))
        }
        Emitter::Band {
            band,
            area_m3,
            mole_fraction,
        } => {
            let width_nm = band.box_width_nm();
            let source = Source::Thermal {
                width_nm,
                strength: mole_fraction * molecules_k * area_m3 / (width_nm * METRES_PER_NM),
                lower_k: 0.0,
                growth: Growth::Box,
            };
            let spread = Spread::Bands {
                within_nm: band.reach_nm(),
                bands: vec![(band, 1.0)],
            };
            Some(feature(band.at_nm, spread, source))
        }
        Emitter::Radical { .. } => None,
    }
}

/// The radicals' light between two wavelengths as one feature.
fn radical_part(emitters: &[Emitter], within_nm: [f64; 2]) -> Option<Feature> {
    let bands: Vec<(Band, f64)> = emitters
        .iter()
        .filter_map(|emitter| match *emitter {
            Emitter::Radical { band, emission } => Some((band, emission)),
            Emitter::Line { .. } | Emitter::Band { .. } => None,
        })
        .collect();
    let light = bands
        .iter()
        .map(|(band, light)| light * band.share_in(within_nm));
    let emission: f64 = light.sum();
    let spread = Spread::Bands { within_nm, bands };
    Some(Feature {
        lambda_nm: spread.middle_nm().filter(|_| emission > 0.0)?,
        colour: spread.colour(),
        source: Source::Radical(emission),
        spread,
    })
}

fn fine_bins([from, to]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let count = ((to - from) / FINE_NM).ceil();
    let width = (to - from) / count;
    (0..count as u32).map(move |i| {
        let start = from + f64::from(i) * width;
        [start, start + width]
    })
}
