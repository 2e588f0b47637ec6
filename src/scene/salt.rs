//! Salts that colour a flame: which lines and bands their metal has there, one row for each.

use super::named::named_rows;
use crate::physics::bands::{self, Band};
use crate::physics::lines::{self, Line};

/// What is known of a salt. To add one, add a row to [`SALTS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaltRow {
    /// The name in the scene file.
    pub name: &'static str,
    /// The name for a person, with the colour.
    pub label: &'static str,
    /// Lines of the metal.
    pub lines: &'static [Line],
    /// Share of the metal that is free atoms in the flame.
    pub free: f64,
    /// Its molecules in the flame.
    pub molecules: &'static [Molecule],
}

/// A molecule that a metal forms in the flame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Molecule {
    /// Its bands.
    pub bands: &'static [Band],
    /// Share of the metal that is bound in it.
    pub share: f64,
    /// Oscillator strength of all bands together.
    pub oscillator: f64,
}

/// Oscillator strength of the red and green bands of alkaline earth molecules: radiative lifetimes of some 20 to 30 ns.
const EARTH: f64 = 0.25;
/// Oscillator strength of the bands of copper's molecules: lifetimes near a microsecond.
const COPPER: f64 = 0.01;

const fn molecule(bands: &'static [Band], share: f64, oscillator: f64) -> Molecule {
    Molecule {
        bands,
        share,
        oscillator,
    }
}

const fn atoms(
    name: &'static str,
    label: &'static str,
    lines: &'static [Line],
    free: f64,
) -> SaltRow {
    SaltRow {
        name,
        label,
        lines,
        free,
        molecules: &[],
    }
}

/// The table. Free atoms: fractions measured in air–acetylene flames, rounded (C. T. J. Alkemade et al., *Metal Vapours in
/// Flames* (1982)). What is not free is taken as the molecules named; with chlorine, half of it as chloride. Strengths
/// of the molecules' bands are *illustrative*.
pub const SALTS: &[SaltRow] = &[
    atoms("none", "None", &[], 0.0),
    atoms("sodium", "Sodium (yellow)", lines::SODIUM, 1.0),
    atoms("potassium", "Potassium (lilac)", lines::POTASSIUM, 0.4),
    atoms("lithium", "Lithium (crimson)", lines::LITHIUM, 0.2),
    SaltRow {
        name: "calcium",
        label: "Calcium (brick red)",
        lines: lines::CALCIUM,
        free: 0.07,
        molecules: &[molecule(bands::CALCIUM_HYDROXIDE, 0.9, EARTH)],
    },
    SaltRow {
        name: "calcium-chloride",
        label: "Calcium chloride (orange red)",
        lines: lines::CALCIUM,
        free: 0.07,
        molecules: &[
            molecule(bands::CALCIUM_HYDROXIDE, 0.45, EARTH),
            molecule(bands::CALCIUM_CHLORIDE, 0.45, EARTH),
        ],
    },
    SaltRow {
        name: "strontium",
        label: "Strontium (red)",
        lines: lines::STRONTIUM,
        free: 0.07,
        molecules: &[molecule(bands::STRONTIUM_HYDROXIDE, 0.9, EARTH)],
    },
    SaltRow {
        name: "strontium-chloride",
        label: "Strontium chloride (deep red)",
        lines: lines::STRONTIUM,
        free: 0.07,
        molecules: &[
            molecule(bands::STRONTIUM_HYDROXIDE, 0.45, EARTH),
            molecule(bands::STRONTIUM_CHLORIDE, 0.45, EARTH),
        ],
    },
    SaltRow {
        name: "barium",
        label: "Barium (apple green)",
        lines: lines::BARIUM,
        free: 0.002,
        molecules: &[molecule(bands::BARIUM_HYDROXIDE, 0.99, EARTH)],
    },
    SaltRow {
        name: "barium-chloride",
        label: "Barium chloride (green)",
        lines: lines::BARIUM,
        free: 0.002,
        molecules: &[
            molecule(bands::BARIUM_HYDROXIDE, 0.49, EARTH),
            molecule(bands::BARIUM_CHLORIDE, 0.49, EARTH),
        ],
    },
    SaltRow {
        name: "copper",
        label: "Copper (green)",
        lines: lines::COPPER,
        free: 0.8,
        molecules: &[molecule(bands::COPPER_HYDROXIDE, 0.2, COPPER)],
    },
    SaltRow {
        name: "copper-chloride",
        label: "Copper chloride (blue green)",
        lines: lines::COPPER,
        free: 0.4,
        molecules: &[
            molecule(bands::COPPER_HYDROXIDE, 0.1, COPPER),
            molecule(bands::COPPER_CHLORIDE, 0.5, COPPER),
        ],
    },
];

named_rows!(
    /// A row of [`SALTS`]; the first, none, is the default.
    Salt,
    SaltRow,
    SALTS,
    "salt"
);

impl Salt {
    /// Whether there is no salt.
    pub fn is_none(self) -> bool {
        self.row().lines.is_empty() && self.row().molecules.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_row_has_more_metal_than_there_is() {
        for (i, row) in SALTS.iter().enumerate() {
            assert!(SALTS[..i].iter().all(|other| other.name != row.name));
            let bound: f64 = row.molecules.iter().map(|molecule| molecule.share).sum();
            assert!(row.free + bound <= 1.0 + 1e-12, "{}", row.name);
        }
        assert!(
            Salt::default().is_none() && Salt::all().filter(|salt| salt.is_none()).count() == 1
        );
    }
}
