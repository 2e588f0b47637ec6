//! The air around a fire, as a scene file has it.

use serde::{Deserialize, Serialize};

use crate::physics::moist_air::Edition;
use crate::scene::Air;

/// `[air]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AirSettings {
    /// Temperature of the air, K, 200 to 400: where the volume has no temperature field, and around the fire.
    pub temperature_k: f64,
    /// Pressure, Pa, 1000 to 1000000.
    pub pressure_pa: f64,
    /// Relative humidity, 0 to 1.
    pub humidity: f64,
    /// Whose saturation pressure says how much water that is.
    pub saturation: Saturation,
    /// Carbon dioxide, parts in a million of the air's molecules, 0 to 2000.
    pub co2_ppm: f64,
    /// Multiplies how strongly hot gas bends light, 1 (nature) to 20.
    pub refraction_gain: f64,
}

impl Default for AirSettings {
    fn default() -> Self {
        let air = Air::default();
        Self {
            temperature_k: air.temperature_k,
            pressure_pa: air.pressure_pa,
            humidity: air.humidity,
            saturation: Saturation::default(),
            co2_ppm: air.co2_ppm,
            refraction_gain: 1.0,
        }
    }
}

impl From<&AirSettings> for Air {
    fn from(set: &AirSettings) -> Self {
        Self {
            temperature_k: set.temperature_k,
            humidity: set.humidity,
            co2_ppm: set.co2_ppm,
            pressure_pa: set.pressure_pa,
            edition: set.saturation.edition(),
        }
    }
}

/// Whose saturation pressure of water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Saturation {
    /// P. H. Huang's form of the steam tables, over ice below freezing, as NIST has it.
    #[default]
    Huang,
    /// R. S. Davis's equation of 1992, over water throughout, as Ciddor published it.
    Davis,
}

impl Saturation {
    /// Every one, the default first.
    pub const ALL: [Self; 2] = [Self::Huang, Self::Davis];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Huang => "huang",
            Self::Davis => "davis",
        }
    }

    /// The edition of Ciddor's equation that takes it.
    pub fn edition(self) -> Edition {
        match self {
            Self::Huang => Edition::Nist,
            Self::Davis => Edition::Ciddor1996,
        }
    }
}
