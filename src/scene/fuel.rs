//! Fuels: which soot index a fuel's smoke was measured to have.

use serde::{Deserialize, Serialize};

use crate::physics::hot_gas::Atoms;
use crate::physics::soot_index::SootIndex;

/// A fuel that burns with soot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fuel {
    /// C₃H₈. Soot index of Dalzell & Sarofim (1969), propane.
    #[default]
    Propane,
    /// C₂H₂. Soot index of Dalzell & Sarofim (1969), acetylene.
    Acetylene,
}

impl Fuel {
    /// Every fuel, in the order of a menu.
    pub const ALL: [Self; 2] = [Self::Propane, Self::Acetylene];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Propane => "propane",
            Self::Acetylene => "acetylene",
        }
    }

    /// The measured index of this fuel's soot.
    pub fn soot_index(self) -> SootIndex {
        match self {
            Self::Propane => SootIndex::Propane,
            Self::Acetylene => SootIndex::Acetylene,
        }
    }

    /// What its molecule is made of; `None` for what is no substance.
    pub fn atoms(self) -> Option<Atoms> {
        let hydrocarbon = |carbon, hydrogen| Atoms {
            carbon,
            hydrogen,
            oxygen: 0.0,
        };
        match self {
            Self::Propane => Some(hydrocarbon(3.0, 8.0)),
            Self::Acetylene => Some(hydrocarbon(2.0, 2.0)),
        }
    }
}
