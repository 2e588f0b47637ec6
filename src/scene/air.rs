//! The air around a fire.

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
}

impl Default for Air {
    /// A room: 300 K, half saturated, with the carbon dioxide of the open air in the 2020s.
    fn default() -> Self {
        Self {
            temperature_k: 300.0,
            humidity: 0.5,
            co2_ppm: 420.0,
        }
    }
}
