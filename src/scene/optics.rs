//! What a place in the fire does to light of a narrow band: the coefficients of the equation of transfer.
//!
//! The command `spectrum` and the window's plots read this, and pictures are held to it: what is said here of a place
//! is what the march does there.

use super::flame::FlameParams;
use super::glow::Glow;
use crate::physics::blackbody;
use crate::physics::constants::METRES_PER_NM;
use crate::physics::soot::{self, SootLaw};

/// What is at a place of the fire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Soot volume fraction of the field, before the amounts and the radius of the parameters, 0 to 1.
    pub soot_volume_fraction: f64,
    /// Temperature, K, at least 0.
    pub temperature_k: f64,
    /// Progress of the reaction, 0 to 1.
    pub flame: f64,
}

/// Means over a band of wavelengths.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coefficients {
    /// Emission coefficient j, W m⁻³ sr⁻¹ nm⁻¹.
    pub emission: f64,
    /// Absorption coefficient σ_a, 1/m.
    pub absorption: f64,
    /// Scattering coefficient σ_s, 1/m.
    pub scattering: f64,
}

/// The optics of a fire, wherever it is looked at.
#[derive(Debug, Clone)]
pub struct Optics {
    soot: SootLaw,
    radius_m: f64,
    /// Multiplies the field's soot: amount and radius.
    volume_fraction_factor: f64,
    glow: Glow,
}

impl Optics {
    /// The optics of these parameters. The amount that counts is the soot's.
    pub fn new(params: &FlameParams) -> Self {
        Self {
            soot: params.fuel.soot_law(params.soot_model),
            glow: Glow::new(&params.glow, params.fuel, &params.air),
            radius_m: params.soot_radius_nm * METRES_PER_NM,
            volume_fraction_factor: params.soot_amount
                * soot::volume_fraction_factor(params.soot_hold, params.soot_radius_nm),
        }
    }

    /// Soot volume fraction that a place of the field comes to, with amount and radius: what the laws see.
    pub fn soot_volume_fraction(&self, local: &Local) -> f64 {
        self.volume_fraction_factor * local.soot_volume_fraction
    }

    /// Vacuum wavelengths of the atoms' lines that a range of bands does not hold, nm: nothing of them is in any mean.
    pub fn lines_outside(&self, range_nm: [f64; 2]) -> Vec<f64> {
        self.glow.lines_outside(range_nm)
    }

    /// The mean coefficients of a place over the band `[from, to)`, nm.
    ///
    /// Preconditions: 0 < from < to, both finite; `local` within its ranges.
    pub fn coefficients(&self, band_nm: [f64; 2], local: &Local) -> Coefficients {
        let [from, to] = band_nm;
        debug_assert!(0.0 < from && from < to, "{from} to {to} nm");
        let mut mean = Coefficients::default();
        for (lambda_nm, weight) in continuum_nodes(band_nm) {
            let soot = self.soot_at(lambda_nm, local);
            mean.emission += weight * soot.emission;
            mean.absorption += weight * soot.absorption;
            mean.scattering += weight * soot.scattering;
        }
        // At 0 K there is no gas.
        if local.temperature_k > 0.0 {
            let gas = self
                .glow
                .coefficients(band_nm, local.temperature_k, local.flame);
            mean.emission += gas.emission;
            mean.absorption += gas.absorption;
        }
        mean
    }

    /// What soot does at one wavelength.
    fn soot_at(&self, lambda_nm: f64, local: &Local) -> Coefficients {
        let absorption =
            self.soot_volume_fraction(local) * self.soot.absorption_per_volume_fraction(lambda_nm);
        Coefficients {
            emission: absorption * blackbody::spectral_radiance(lambda_nm, local.temperature_k),
            absorption,
            scattering: absorption * self.soot.scattering_ratio(lambda_nm, self.radius_m),
        }
    }
}

/// Longest panel of a mean over a smooth spectrum, nm: Planck's law at 800 K changes by a factor of e in 10 nm.
const PANEL_NM: f64 = 2.0;

/// Wavelengths and weights that average a smooth spectrum over a band: panels of at most [`PANEL_NM`], each by Gauss's
/// two points, exact for cubics.
fn continuum_nodes([from, to]: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
    let panels = ((to - from) / PANEL_NM).ceil().max(1.0);
    let width = (to - from) / panels;
    (0..panels as u32).flat_map(move |panel| {
        let middle = from + width * (f64::from(panel) + 0.5);
        let reach = 0.5 * width / 3.0_f64.sqrt();
        [middle - reach, middle + reach].map(|nm| (nm, 0.5 / panels))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;

    use super::*;
    use crate::physics::soot::{Hold, SootModel};
    use crate::scene::Salt;
    use crate::scene::{Air, Flame, Fuel, GlowParams, Interpolation, Placement};
    use crate::volume::{self, Producer, procedural};

    fn params() -> FlameParams {
        let volume = procedural::torch();
        let preset = volume::preset(Producer::Physical, &volume);
        FlameParams {
            maps: preset.maps,
            placement: Placement {
                up: preset.up,
                metres_per_unit: 1.0,
            },
            fuel: Fuel::named("acetylene").unwrap(),
            soot_model: SootModel::DalzellSarofim,
            soot_radius_nm: 30.0,
            soot_hold: Hold::Number,
            soot_amount: 2.5,
            smoke_amount: 1.0,
            smoke_left_out: None,
            glow: GlowParams::default(),
            interpolation: Interpolation::default(),
            air: Air::default(),
            scattering: None,
            bending: None,
        }
    }

    const PLACE: Local = Local {
        soot_volume_fraction: 1e-6,
        temperature_k: 1800.0,
        flame: 0.0,
    };

    fn narrow(lambda_nm: f64) -> [f64; 2] {
        [lambda_nm - 1e-3, lambda_nm + 1e-3]
    }

    #[test]
    fn a_place_absorbs_as_the_march_says_it_does() {
        let params = params();
        let flame = Flame::new(&Arc::new(procedural::torch()), &params, None);
        for lambda_nm in [400.0, 480.0, 550.0, 700.0] {
            let got = Optics::new(&params).coefficients(narrow(lambda_nm), &PLACE);
            let expected = 1e-6 * flame.absorption_per_sample(lambda_nm);
            assert!((got.absorption / expected - 1.0).abs() < 1e-6, "{got:?}");
            let planck = blackbody::spectral_radiance(lambda_nm, 1800.0);
            assert!((got.emission / (expected * planck) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_radius_sets_the_scattering_whatever_is_held() {
        let ratio = |soot_hold, soot_radius_nm| {
            let params = FlameParams {
                soot_radius_nm,
                soot_hold,
                ..params()
            };
            let at = Optics::new(&params).coefficients(narrow(550.0), &PLACE);
            at.scattering / at.absorption
        };
        for hold in [Hold::Number, Hold::Volume] {
            // As R³ in Rayleigh's limit; spheres of 80 nm scatter a third less than that says.
            assert!((ratio(hold, 0.4) / ratio(hold, 0.2) - 8.0).abs() < 1e-4);
            let large = ratio(hold, 80.0) / ratio(hold, 0.2) / 400_f64.powi(3);
            assert!((0.6..0.9).contains(&large), "{large}");
        }
        assert!((5e-3..2e-2).contains(&ratio(Hold::Volume, 21.0)));
    }

    #[test]
    fn the_mean_of_a_band_is_that_of_its_parts() {
        let optics = Optics::new(&params());
        for temperature_k in [600.0, 1200.0, 2400.0] {
            let local = Local {
                temperature_k,
                ..PLACE
            };
            let whole = optics.coefficients([500.0, 540.0], &local);
            let parts: Vec<Coefficients> = (0..400)
                .map(|i| 500.0 + 0.1 * f64::from(i))
                .map(|nm| optics.coefficients([nm, nm + 0.1], &local))
                .collect();
            let mean = |of: fn(&Coefficients) -> f64| parts.iter().map(of).sum::<f64>() / 400.0;
            for (got, expected) in [
                (whole.emission, mean(|it| it.emission)),
                (whole.absorption, mean(|it| it.absorption)),
                (whole.scattering, mean(|it| it.scattering)),
            ] {
                assert!((got / expected - 1.0).abs() < 1e-5, "{temperature_k} K");
            }
        }
    }

    #[test]
    fn a_line_adds_its_area_to_one_band_and_radicals_glow_without_absorbing() {
        let salted = FlameParams {
            glow: GlowParams {
                salt: Salt::named("sodium").unwrap(),
                salt_ppm: 1.0,
                ..GlowParams::default()
            },
            ..params()
        };
        let (plain, salted) = (Optics::new(&params()), Optics::new(&salted));
        let added = |step: f64| {
            let bins = (0..(400.0 / step) as u32).map(|i| 380.0 + f64::from(i) * step);
            let lit: Vec<f64> = bins
                .map(|nm| {
                    let of = |optics: &Optics| optics.coefficients([nm, nm + step], &PLACE);
                    step * (of(&salted).absorption - of(&plain).absorption)
                })
                .filter(|area| *area > 1e-9)
                .collect();
            (lit.len(), lit.iter().sum::<f64>())
        };
        // D1 and D2 lie 0.6 nm apart, in one bin of 5 nm.
        let ((wide, area), (narrow, same)) = (added(5.0), added(0.1));
        assert_eq!((wide, narrow), (1, 2));
        assert!((area / same - 1.0).abs() < 1e-9, "{area} {same}");

        let blue = FlameParams {
            glow: GlowParams {
                radicals: 100.0,
                ..GlowParams::default()
            },
            ..params()
        };
        let place = Local {
            flame: 1.0,
            ..PLACE
        };
        let of = |optics: &Optics| optics.coefficients([425.0, 435.0], &place);
        let (plain, blue) = (of(&plain), of(&Optics::new(&blue)));
        assert!(blue.emission > plain.emission);
        assert_eq!(blue.absorption, plain.absorption);
    }

    #[test]
    fn without_soot_there_is_nothing() {
        let none = Local {
            soot_volume_fraction: 0.0,
            ..PLACE
        };
        let got = Optics::new(&params()).coefficients([380.0, 780.0], &none);
        assert_eq!(got, Coefficients::default());
    }
}
