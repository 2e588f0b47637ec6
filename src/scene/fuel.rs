//! Fuels: one row of a table for each, with its sources.

use super::named::named_rows;
use crate::physics::hot_gas::Atoms;
use crate::physics::soot::{SootLaw, SootModel};
use crate::physics::soot_index::SootIndex;

/// What is known of a fuel. To add a fuel, add a row to [`FUELS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FuelRow {
    /// The name in the scene file.
    pub name: &'static str,
    /// The name for a person.
    pub label: &'static str,
    /// What a molecule or a typical unit is made of, and so its smoke gas; nothing for what is no substance.
    pub atoms: Atoms,
    /// Whose measured soot index is its own, or the nearest; `None` for grey soot.
    pub soot: Option<SootIndex>,
    /// Soot for that of propane, where a volume leaves its amount to be assumed.
    pub soot_yield: f64,
    /// Adiabatic flame temperature in air at 1 atm, K: gas as hot as this is undiluted smoke gas.
    pub flame_k: f64,
    /// Light of the radicals CH, C₂ and CO₂* for that of a butane torch.
    pub radicals: [f64; 3],
    /// What the row was taken from.
    pub source: &'static str,
}

const fn atoms(carbon: f64, hydrogen: f64, oxygen: f64) -> Atoms {
    Atoms {
        carbon,
        hydrogen,
        oxygen,
    }
}

/// Sources of most rows.
const TURNS: &str = "flame temperature: Turns, An Introduction to Combustion (2012), table B.1";
const UNMEASURED: &str = "no index of its own was measured: that of propane soot";

/// The table. Soot yields are smoke yields of well-ventilated fires over propane's 0.024 (A. Tewarson, SFPE Handbook of
/// Fire Protection Engineering, 3rd ed. (2002), table 3-4.14); for methane, which has none there, smoke points.
/// Radicals are *illustrative*, after the spectra in A. G. Gaydon, *The Spectroscopy of Flames* (1974): the more carbon
/// for its hydrogen, the more C₂; alcohols have hardly any.
pub const FUELS: &[FuelRow] = &[
    FuelRow {
        name: "propane",
        label: "Propane, C₃H₈",
        atoms: atoms(3.0, 8.0, 0.0),
        soot: Some(SootIndex::Propane),
        soot_yield: 1.0,
        flame_k: 2267.0,
        radicals: [1.0, 1.0, 1.0],
        source: "soot: Dalzell & Sarofim (1969)",
    },
    FuelRow {
        name: "acetylene",
        label: "Acetylene, C₂H₂",
        atoms: atoms(2.0, 2.0, 0.0),
        soot: Some(SootIndex::Acetylene),
        soot_yield: 4.0,
        flame_k: 2539.0,
        radicals: [1.5, 4.0, 1.0],
        source: "soot: Dalzell & Sarofim (1969)",
    },
    FuelRow {
        name: "methane",
        label: "Methane, CH₄ (natural gas)",
        atoms: atoms(1.0, 4.0, 0.0),
        soot: Some(SootIndex::Propane),
        soot_yield: 0.5,
        flame_k: 2226.0,
        radicals: [1.0, 0.5, 1.0],
        source: UNMEASURED,
    },
    FuelRow {
        name: "ethylene",
        label: "Ethylene, C₂H₄",
        atoms: atoms(2.0, 4.0, 0.0),
        soot: Some(SootIndex::Acetylene),
        soot_yield: 1.8,
        flame_k: 2369.0,
        radicals: [1.2, 2.0, 1.0],
        source: "no index of its own was measured: that of acetylene soot, which is as poor in hydrogen",
    },
    FuelRow {
        name: "methanol",
        label: "Methanol, CH₃OH (spirit)",
        atoms: atoms(1.0, 4.0, 1.0),
        soot: Some(SootIndex::Propane),
        soot_yield: 0.0,
        flame_k: 2230.0,
        radicals: [0.15, 0.05, 0.6],
        source: "no soot: Tewarson (2002)",
    },
    FuelRow {
        name: "wood",
        label: "Wood, C₆H₁₀O₅",
        atoms: atoms(6.0, 10.0, 5.0),
        soot: Some(SootIndex::Propane),
        soot_yield: 0.6,
        flame_k: 2250.0,
        radicals: [0.6, 0.5, 1.0],
        source: "red oak: Tewarson (2002); flame temperature of its gases to 50 K",
    },
    FuelRow {
        name: "candle-wax",
        label: "Candle wax, C₂₅H₅₂",
        atoms: atoms(25.0, 52.0, 0.0),
        soot: Some(SootIndex::Propane),
        soot_yield: 2.5,
        flame_k: 2275.0,
        radicals: [1.0, 1.0, 1.0],
        source: "soot as of polyethylene, which has the same chains: Tewarson (2002)",
    },
    FuelRow {
        name: "black-body",
        label: "Black body (grey soot)",
        atoms: atoms(0.0, 0.0, 0.0),
        soot: None,
        soot_yield: 1.0,
        flame_k: 2267.0,
        radicals: [0.0, 0.0, 0.0],
        source: "no fuel: absorbs all colours alike, so that a thick fire is a black body and a thin one its faint copy",
    },
];

named_rows!(
    /// A row of [`FUELS`]; the first is the default.
    Fuel,
    FuelRow,
    FUELS,
    "fuel"
);

impl Fuel {
    /// How this fuel's soot absorbs under a model.
    pub fn soot_law(self, model: SootModel) -> SootLaw {
        match self.row().soot {
            Some(index) => SootLaw::new(model, index),
            None => SootLaw::new(SootModel::Grey, SootIndex::default()),
        }
    }

    /// The row's sources in words.
    pub fn sources(self) -> String {
        format!("{}; {TURNS}", self.row().source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_whole_and_has_a_name_of_its_own() {
        for (i, row) in FUELS.iter().enumerate() {
            assert!(FUELS[..i].iter().all(|other| other.name != row.name));
            assert!(!row.label.is_empty() && !row.source.is_empty());
            assert!((2000.0..3000.0).contains(&row.flame_k), "{}", row.name);
            assert!((0.0..=10.0).contains(&row.soot_yield));
            assert!(
                row.radicals
                    .iter()
                    .all(|light| (0.0..=10.0).contains(light))
            );
            // Soot is a fraction of the fuel's carbon, and so are the radicals.
            if row.radicals.iter().any(|light| *light > 0.0) {
                assert!(row.atoms.carbon > 0.0, "{}", row.name);
            }
        }
    }
}
