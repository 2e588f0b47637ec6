//! The air around a fire.

use super::fuel::Fuel;
use crate::physics::hot_gas::FireGas;
use crate::physics::moist_air::{AirError, Ambient, Edition, STANDARD_PRESSURE_PA};

/// What the air is like, far from the flame.
///
/// Its temperature is that of gas for which a volume has no temperature. Humidity and carbon dioxide change only its
/// refractive index (P. E. Ciddor, Appl. Opt. 35 (1996) 1566): in visible light moist air is clear over the size of a
/// fire. So they show where something behind the fire is seen through bent light, and nowhere else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Temperature, K, 200 to 400.
    pub temperature_k: f64,
    /// Relative humidity, 0 (dry) to 1 (saturated).
    pub humidity: f64,
    /// Mole fraction of carbon dioxide, parts in a million, 0 to 2000: the range of Ciddor's equation.
    pub co2_ppm: f64,
    /// Pressure, Pa, 0 to 1e6. It counts for the refractive index only.
    pub pressure_pa: f64,
    /// Whose saturation pressure says how much water the humidity is.
    pub edition: Edition,
}

impl Default for Air {
    /// A room: 300 K, half saturated, with the carbon dioxide of the open air in the 2020s.
    fn default() -> Self {
        Self {
            temperature_k: 300.0,
            humidity: 0.5,
            co2_ppm: 420.0,
            pressure_pa: STANDARD_PRESSURE_PA,
            edition: Edition::default(),
        }
    }
}

impl Air {
    /// How the gas of a fire in this air bends light.
    ///
    /// # Errors
    /// [`AirError`]: a number is out of range, or the air cannot hold so much water.
    pub fn gas(&self, fuel: Fuel) -> Result<FireGas, AirError> {
        let ambient = Ambient {
            temperature_k: self.temperature_k,
            pressure_pa: self.pressure_pa,
            humidity: self.humidity,
            co2_ppm: self.co2_ppm,
        };
        FireGas::by(self.edition, &ambient, Some(fuel.row().atoms))
    }

    /// Which share of the gas has burnt where it is so hot: all of it at the fuel's flame temperature, nothing at the
    /// air's own; between, hot products and cold air are mixed until they are as warm as that.
    pub fn products_share(&self, fuel: Fuel, temperature_k: f64) -> f64 {
        products_share([self.temperature_k, fuel.row().flame_k], temperature_k)
    }
}

/// Share 0 to 1 of hot products in gas of a temperature, given those of the air and of the undiluted products, K: heat
/// and products mix alike (conserved scalars: S. P. Burke and T. E. W. Schumann, Ind. Eng. Chem. 20 (1928) 998).
pub(super) fn products_share([air_k, products_k]: [f64; 2], temperature_k: f64) -> f64 {
    // Air as hot as the products is no air: what is hotter still is products alone.
    ((temperature_k - air_k) / (products_k - air_k).max(1.0)).clamp(0.0, 1.0)
}
