//! The refractive index of moist air.
//!
//! ```text
//! n − 1 = (ρ_a/ρ_axs)(n_axs − 1) + (ρ_w/ρ_ws)(n_ws − 1)
//! 10⁸ (n_as − 1) = 5792105/(238.0185 − σ²) + 167917/(57.362 − σ²)
//! n_axs − 1      = (n_as − 1)(1 + 0.534e-6 (x_c − 450))
//! 10⁸ (n_ws − 1) = 1.022 (295.235 + 2.6422 σ² − 0.032380 σ⁴ + 0.004028 σ⁶)
//! x_w = f h p_sv/p,   f = 1.00062 + 3.14e-8 p + 5.6e-7 t²
//! ρ_a = p m_a (1 − x_w)/(Z R T),   ρ_w = p M_w x_w/(Z R T),   ρ_axs = 101325 m_a/(Z_a R 288.15)
//! Z = 1 − (p/T)[a₀ + a₁t + a₂t² + (b₀ + b₁t) x_w + (c₀ + c₁t) x_w²] + (p/T)² (d + e x_w²)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | n_as, n_axs, n_ws | index of standard air, of air with x_c, of water vapour, each at its standard density | 1 |
//! | σ | vacuum wavenumber 1/λ | µm⁻¹ |
//! | T, t | temperature, T and t = T − 273.15 | K, °C |
//! | p | pressure | Pa |
//! | h | relative humidity | 1 |
//! | p_sv | saturation pressure, see [`super::saturation`] | Pa |
//! | x_w | mole fraction of water | 1 |
//! | x_c | mole fraction of carbon dioxide | 1e-6 |
//! | ρ_a, ρ_w | density of the dry part and of the water | kg m⁻³ |
//! | m_a, M_w | molar mass of dry air, which cancels, and of water | kg mol⁻¹ |
//! | Z | compressibility | 1 |
//! | R | gas constant | J mol⁻¹ K⁻¹ |
//!
//! **Validity.** 300 to 1690 nm, −40 to 100 °C, 80 to 120 kPa, x_c to 2000: there n is right to a few 1e-8. It is
//! refused below 230 nm, where the resonances of the fit lie (132.0 and 64.8 nm), below 200 K, and where more water than
//! air would be needed. **Humidity is never worked out in hot gas**: at 50 % it would ask for 13 parts of water in one
//! part of air at 500 K. It fixes x_w once, at the temperature of the surroundings; the gas carries it from there. How hot
//! gas bends light is in [`super::hot_gas`].
//!
//! **Source.** P. E. Ciddor, Appl. Opt. 35 (1996) 1566, appendices A and B; Z and f after Davis, Metrologia 29 (1992) 67.
//! G. Dorta-Perez, *Realistic fire rendering* (2015), eq. 3.9 to 3.25, prints the standard state of air as 20 °C and
//! 101.325 Pa; here it is that of the source.

use thiserror::Error;

use super::saturation::{self, MELTING_POINT_K};

/// Shortest vacuum wavelength, nm.
pub const SHORTEST_NM: f64 = 230.0;
/// Lowest and highest temperature of the surroundings, K. Above, relative humidity says nothing useful.
pub const AMBIENT_RANGE_K: [f64; 2] = [200.0, 400.0];
/// Highest pressure, Pa: ten times that of the atmosphere; the virial series for Z has two terms.
pub const HIGHEST_PRESSURE_PA: f64 = 1e6;
/// Most carbon dioxide, 1e-6.
pub const MOST_CO2_PPM: f64 = 2000.0;

/// Standard pressure, Pa.
pub const STANDARD_PRESSURE_PA: f64 = 101_325.0;
/// Temperature of standard air, K: 15 °C.
pub const STANDARD_TEMPERATURE_K: f64 = 288.15;
/// Compressibility Z_a of dry standard air at 15 °C and 101325 Pa.
pub const STANDARD_COMPRESSIBILITY: f64 = 0.9995922115;
/// Density ρ_ws of the water vapour that n_ws is for (20 °C, 1333 Pa), kg m⁻³.
const STANDARD_VAPOUR_DENSITY: f64 = 0.00985938;
/// Molar mass M_w of water, kg mol⁻¹.
const WATER_MOLAR_MASS: f64 = 0.018015;

/// a₀, a₁, a₂ of Z: K Pa⁻¹, Pa⁻¹, K⁻¹ Pa⁻¹.
const Z_A: [f64; 3] = [1.58123e-6, -2.9331e-8, 1.1043e-10];
/// b₀, b₁ of Z: K Pa⁻¹, Pa⁻¹.
const Z_B: [f64; 2] = [5.707e-6, -2.051e-8];
/// c₀, c₁ of Z: K Pa⁻¹, Pa⁻¹.
const Z_C: [f64; 2] = [1.9898e-4, -2.376e-6];
/// d, e of Z: K² Pa⁻².
const Z_D: [f64; 2] = [1.83e-11, -0.765e-8];

/// Why the index of air cannot be given.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AirError {
    /// The wavelength lies at the resonances of the fit.
    #[error(
        "the wavelength is {0} nm: the refractive index of air is known from {SHORTEST_NM} nm on"
    )]
    Wavelength(f64),
    /// The temperature of the surroundings is out of range.
    #[error(
        "the air is at {0} K: it must lie between {low} and {high} K, hotter gas belongs to the flame",
        low = AMBIENT_RANGE_K[0], high = AMBIENT_RANGE_K[1]
    )]
    Temperature(f64),
    /// The pressure is no pressure.
    #[error("the pressure is {0} Pa: it must lie between 0 and {HIGHEST_PRESSURE_PA} Pa")]
    Pressure(f64),
    /// The relative humidity is no share.
    #[error("the relative humidity is {0}: it must lie between 0 and 1")]
    Humidity(f64),
    /// The carbon dioxide is out of range.
    #[error("there are {0} ppm of carbon dioxide: it must be 0 to {MOST_CO2_PPM}")]
    CarbonDioxide(f64),
    /// So much water would displace all air.
    #[error(
        "at this temperature, pressure and humidity the air would hold {0:.3} moles of water in one mole of air: lower \
         the humidity or the temperature"
    )]
    TooMuchWater(f64),
}

/// The surroundings, as a thermometer, a barometer and a hygrometer tell them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient {
    /// Temperature, K, in [`AMBIENT_RANGE_K`].
    pub temperature_k: f64,
    /// Pressure, Pa, 0 to [`HIGHEST_PRESSURE_PA`].
    pub pressure_pa: f64,
    /// Relative humidity, 0 to 1.
    pub humidity: f64,
    /// Carbon dioxide, 1e-6 of the dry air's molecules, 0 to [`MOST_CO2_PPM`].
    pub co2_ppm: f64,
}

/// Whose saturation pressure and gas constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Edition {
    /// As published in 1996: Davis's saturation pressure, over water at every temperature, and R = 8.314510.
    Ciddor1996,
    /// As NIST works it out: the steam tables over water, ice below 0 °C, and R = 8.314472.
    #[default]
    Nist,
}

impl Edition {
    /// Saturation pressure, Pa, at a temperature in [`AMBIENT_RANGE_K`], where each line exists.
    fn saturation_pressure(self, temperature_k: f64) -> f64 {
        match self {
            Self::Ciddor1996 => saturation::davis(temperature_k),
            Self::Nist => saturation::over_water_or_ice(temperature_k).unwrap_or(f64::INFINITY),
        }
    }

    /// Gas constant R, J mol⁻¹ K⁻¹.
    fn gas_constant(self) -> f64 {
        match self {
            Self::Ciddor1996 => 8.314510,
            Self::Nist => 8.314472,
        }
    }
}

/// How air and water vapour bend light of one wavelength, each at its standard density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispersion {
    /// n_as − 1 of standard dry air: 15 °C, 101325 Pa, 450 ppm of carbon dioxide.
    pub standard_air: f64,
    /// n_ws − 1 of water vapour at 20 °C and 1333 Pa.
    pub vapour: f64,
}

impl Dispersion {
    /// That of a vacuum wavelength in nm.
    ///
    /// # Errors
    /// [`AirError::Wavelength`] below [`SHORTEST_NM`], at infinity and for what is no number.
    pub fn at(lambda_nm: f64) -> Result<Self, AirError> {
        if !(lambda_nm >= SHORTEST_NM && lambda_nm.is_finite()) {
            return Err(AirError::Wavelength(lambda_nm));
        }
        let per_micrometre = 1e3 / lambda_nm;
        let s = per_micrometre * per_micrometre;
        let vapour = 295.235 + s * (2.6422 + s * (-0.032380 + s * 0.004028));
        Ok(Self {
            standard_air: 1e-8 * (5_792_105.0 / (238.0185 - s) + 167_917.0 / (57.362 - s)),
            vapour: 1e-8 * 1.022 * vapour,
        })
    }
}

/// Air of a fixed composition at a fixed pressure, whatever its temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoistAir {
    pressure_pa: f64,
    water: f64,
    co2_ppm: f64,
    gas_constant: f64,
}

impl MoistAir {
    /// The air of these surroundings, as NIST works it out. In a vacuum there is no water either.
    ///
    /// # Errors
    /// [`AirError`] names the number that is out of range, or that air cannot hold so much water.
    pub fn new(ambient: &Ambient) -> Result<Self, AirError> {
        Self::by(Edition::default(), ambient)
    }

    /// The air of these surroundings in a chosen edition.
    ///
    /// # Errors
    /// As [`MoistAir::new`].
    pub fn by(edition: Edition, ambient: &Ambient) -> Result<Self, AirError> {
        let Ambient {
            temperature_k,
            pressure_pa,
            humidity,
            co2_ppm,
        } = *ambient;
        if !(AMBIENT_RANGE_K[0]..=AMBIENT_RANGE_K[1]).contains(&temperature_k) {
            return Err(AirError::Temperature(temperature_k));
        }
        if !(0.0..=HIGHEST_PRESSURE_PA).contains(&pressure_pa) {
            return Err(AirError::Pressure(pressure_pa));
        }
        if !(0.0..=1.0).contains(&humidity) {
            return Err(AirError::Humidity(humidity));
        }
        if !(0.0..=MOST_CO2_PPM).contains(&co2_ppm) {
            return Err(AirError::CarbonDioxide(co2_ppm));
        }
        let celsius = temperature_k - MELTING_POINT_K;
        let enhancement = 1.00062 + 3.14e-8 * pressure_pa + 5.6e-7 * celsius * celsius;
        let water_pa = enhancement * humidity * edition.saturation_pressure(temperature_k);
        // Nothing of nothing is nothing: a vacuum has no water, and dry air none at any pressure.
        let water = if pressure_pa == 0.0 || humidity == 0.0 {
            0.0
        } else {
            water_pa / pressure_pa
        };
        if water > 1.0 {
            return Err(AirError::TooMuchWater(water));
        }
        Ok(Self {
            pressure_pa,
            water,
            co2_ppm,
            gas_constant: edition.gas_constant(),
        })
    }

    /// Pressure, Pa.
    pub fn pressure_pa(&self) -> f64 {
        self.pressure_pa
    }

    /// Mole fraction x_w of water, 0 to 1.
    pub fn water(&self) -> f64 {
        self.water
    }

    /// n − 1 of this air at a temperature. Precondition: `temperature_k` in [`AMBIENT_RANGE_K`].
    pub fn refractivity(&self, dispersion: Dispersion, temperature_k: f64) -> f64 {
        debug_assert!(
            (AMBIENT_RANGE_K[0]..=AMBIENT_RANGE_K[1]).contains(&temperature_k),
            "{temperature_k} K"
        );
        let with_co2 = dispersion.standard_air * (1.0 + 0.534e-6 * (self.co2_ppm - 450.0));
        // In ρ_a/ρ_axs the molar mass m_a and the gas constant cancel; in ρ_w/ρ_ws the gas constant stays.
        let over_ideal = self.pressure_pa / (self.compressibility(temperature_k) * temperature_k);
        let standard = STANDARD_PRESSURE_PA / (STANDARD_COMPRESSIBILITY * STANDARD_TEMPERATURE_K);
        let dry = (1.0 - self.water) * over_ideal / standard;
        let vapour = self.water * over_ideal * WATER_MOLAR_MASS
            / (self.gas_constant * STANDARD_VAPOUR_DENSITY);
        dry * with_co2 + vapour * dispersion.vapour
    }

    /// Compressibility Z.
    fn compressibility(&self, temperature_k: f64) -> f64 {
        let t = temperature_k - MELTING_POINT_K;
        let (x, density) = (self.water, self.pressure_pa / temperature_k);
        let first = Z_A[0]
            + t * (Z_A[1] + t * Z_A[2])
            + x * (Z_B[0] + t * Z_B[1])
            + x * x * (Z_C[0] + t * Z_C[1]);
        1.0 - density * first + density * density * (Z_D[0] + x * x * Z_D[1])
    }
}

#[cfg(test)]
mod tests;
