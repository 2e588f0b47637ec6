//! The optics of one place of the fire against wavelength: what the command `spectrum` writes and the window plots.

use thiserror::Error;

use super::flame::FlameParams;
use super::optics::{Coefficients, Local, Optics};
use crate::physics::hot_gas::FireGas;
use crate::physics::moist_air::{AirError, Dispersion, SHORTEST_NM};
use crate::volume::{FieldMap, Volume};

/// Temperature and soot of a place that nobody has chosen: the body of a sooty flame.
pub const USUAL_PLACE: Local = Local {
    soot_volume_fraction: 1e-6,
    temperature_k: 1800.0,
    flame: 1.0,
};

/// Longest wavelength, nm: the far infrared.
const LONGEST_NM: f64 = 1e6;
/// Smallest and greatest distance of two wavelengths, nm. So the first band begins above 0.
const STEP_NM: [f64; 2] = [1e-3, 400.0];
/// Most wavelengths.
const MOST_BANDS: f64 = 1e6;

/// Wavelengths at equal distances, each the middle of a band that begins where the one before ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands {
    first_nm: f64,
    step_nm: f64,
    count: u32,
}

/// Why there are no such bands.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum BandsError {
    /// The ends are not two rising wavelengths.
    #[error(
        "the range is {}-{} nm: it must rise, from {SHORTEST_NM} nm on and up to {LONGEST_NM} nm",
        range[0], range[1]
    )]
    Range {
        /// What was asked for, nm.
        range: [f64; 2],
    },
    /// The step is no step.
    #[error("the step is {step} nm: it must lie between {} and {} nm", STEP_NM[0], STEP_NM[1])]
    Step {
        /// What was asked for, nm.
        step: f64,
    },
    /// The step is too small for the range.
    #[error(
        "that is {count:.0} wavelengths: at most {MOST_BANDS} are worked out; take a longer step or a shorter range"
    )]
    TooMany {
        /// What was asked for.
        count: f64,
    },
}

impl Bands {
    /// Bands around the wavelengths from the first to the last end of a range (or as far as whole steps lead), nm.
    ///
    /// # Errors
    /// [`BandsError`] says what the range, the step or both must be.
    pub fn new(range_nm: [f64; 2], step_nm: f64) -> Result<Self, BandsError> {
        let [first, last] = range_nm;
        if !(STEP_NM[0]..=STEP_NM[1]).contains(&step_nm) {
            return Err(BandsError::Step { step: step_nm });
        }
        if !(first >= SHORTEST_NM && first <= last && last <= LONGEST_NM) {
            return Err(BandsError::Range { range: range_nm });
        }
        // A range that is whole steps long up to rounding ends with its last wavelength.
        let count = ((last - first) / step_nm * (1.0 + 1e-12) + 1e-9).floor() + 1.0;
        if count > MOST_BANDS {
            return Err(BandsError::TooMany { count });
        }
        Ok(Self {
            first_nm: first,
            step_nm,
            count: count as u32,
        })
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// Whether there is none; there is always one.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Distance of two wavelengths and width of a band, nm.
    pub fn step_nm(&self) -> f64 {
        self.step_nm
    }

    /// The middle of a band, nm.
    pub fn wavelength_nm(&self, index: u32) -> f64 {
        self.first_nm + f64::from(index) * self.step_nm
    }

    /// Where a band begins, and where the next one does, nm. Half open: a line lies in one band only.
    pub fn band_nm(&self, index: u32) -> [f64; 2] {
        [index, index + 1].map(|edge| self.first_nm + (f64::from(edge) - 0.5) * self.step_nm)
    }
}

/// The optics of a place in one band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Vacuum wavelength in the band's middle, nm.
    pub lambda_nm: f64,
    /// Means over the band.
    pub coefficients: Coefficients,
    /// Refractive index less one, at the band's middle.
    pub n_minus_1: f64,
}

/// Everything that light meets at one place, for any wavelength.
#[derive(Debug, Clone)]
pub struct Curves {
    optics: Optics,
    gas: FireGas,
    local: Local,
    products: f64,
}

impl Curves {
    /// The curves of a place of this fire.
    ///
    /// # Errors
    /// [`AirError`]: there is no such air.
    pub fn new(params: &FlameParams, local: Local) -> Result<Self, AirError> {
        Ok(Self {
            optics: Optics::new(params),
            gas: params.air.gas(params.fuel)?,
            local,
            products: params.air.products_share(params.fuel, local.temperature_k),
        })
    }

    /// The gas.
    pub fn gas(&self) -> &FireGas {
        &self.gas
    }

    /// Which share of the gas has burnt, 0 to 1.
    pub fn products_share(&self) -> f64 {
        self.products
    }

    /// The soot volume fraction with the scene's amount and radius.
    pub fn soot_volume_fraction(&self) -> f64 {
        self.optics.soot_volume_fraction(&self.local)
    }

    /// Vacuum wavelengths of the atoms' lines that lie in none of the bands, nm.
    pub fn lines_outside(&self, bands: &Bands) -> Vec<f64> {
        let last = bands.count.saturating_sub(1);
        self.optics
            .lines_outside([bands.band_nm(0)[0], bands.band_nm(last)[1]])
    }

    /// One row for each band.
    ///
    /// # Errors
    /// None for [`Bands`] as they are made: they begin where the index of air is known.
    pub fn rows(&self, bands: &Bands) -> Result<Vec<Row>, AirError> {
        let row = |index| {
            let lambda_nm = bands.wavelength_nm(index);
            let dispersion = Dispersion::at(lambda_nm)?;
            let temperature_k = self.local.temperature_k;
            Ok(Row {
                lambda_nm,
                coefficients: self.optics.coefficients(bands.band_nm(index), &self.local),
                n_minus_1: self
                    .gas
                    .refractivity(dispersion, temperature_k, self.products),
            })
        };
        (0..bands.count).map(row).collect()
    }
}

/// The hottest gas and the densest soot of a volume, as one place; what it has no field for is that of
/// [`USUAL_PLACE`].
pub fn peak_of(volume: &Volume, params: &FlameParams) -> Local {
    let peak = |map: &Option<FieldMap>| {
        let map = map.as_ref()?;
        let (low, high) = volume.grid(&map.grid)?.range();
        Some(map.mapped_range((low.into(), high.into())).1)
    };
    let maps = &params.maps;
    let soot = peak(&maps.soot).or_else(|| peak(&maps.smoke));
    Local {
        soot_volume_fraction: soot.unwrap_or(USUAL_PLACE.soot_volume_fraction),
        temperature_k: peak(&maps.temperature).unwrap_or(USUAL_PLACE.temperature_k),
        flame: USUAL_PLACE.flame,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn bands_lie_side_by_side_and_end_where_the_range_does() {
        let bands = Bands::new([380.0, 780.0], 1.0).unwrap();
        assert_eq!(bands.len(), 401);
        assert_eq!(bands.wavelength_nm(0), 380.0);
        assert_eq!(bands.wavelength_nm(400), 780.0);
        for step in [0.1, 0.3, 1.0, 7.0] {
            let bands = Bands::new([380.0, 780.0], step).unwrap();
            let last = bands.len() as u32 - 1;
            assert!((780.0 - bands.wavelength_nm(last)) < step * (1.0 - 1e-9));
            for index in 0..last {
                assert_eq!(bands.band_nm(index)[1], bands.band_nm(index + 1)[0]);
            }
        }
        assert_eq!(Bands::new([500.0, 500.0], 2.0).unwrap().len(), 1);
    }

    #[test]
    fn impossible_bands_say_what_would_do() {
        for (range, step, expected) in [
            ([780.0, 380.0], 1.0, "must rise"),
            ([200.0, 380.0], 1.0, "230 nm"),
            ([f64::NAN, 380.0], 1.0, "NaN"),
            ([380.0, f64::INFINITY], 1.0, "inf"),
            ([380.0, 780.0], 0.0, "the step is 0 nm"),
            ([380.0, 780.0], f64::NAN, "the step is NaN"),
            ([230.0, 1e6], 1e-3, "longer step"),
            ([240.0, 780.0], 500.0, "between 0.001 and 400 nm"),
        ] {
            let error = Bands::new(range, step).unwrap_err().to_string();
            assert!(error.contains(expected), "{range:?}, {step}: {error}");
        }
    }
}
