//! The refractive index of hot gas, and of a fire's gas at any temperature.
//!
//! ```text
//! hot gas   n − 1 = k_comp (n_as − 1)(λ) Z_a (288.15 K/T)(p/101325 Pa),   k_comp = Σ x_i r_i / r_air
//! any T     n − 1 = (k_comp/k_air)[(1 − w) Ciddor(T) + w k_air hot(T)],   w = smoothstep(373.15 K, 400 K, T)
//! products  C_a H_b O_c + ν(O₂ + 3.76 N₂) → a CO₂ + b/2 H₂O + 3.76 ν N₂,   ν = a + b/4 − c/2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | n_as, Z_a | index and compressibility of standard air, see [`super::moist_air`] | 1 |
//! | k_comp | refractivity of the mixture over that of dry air, at one density of molecules | 1 |
//! | k_air | k_comp of the air around: 1 − x_w + x_w r_H₂O/r_air | 1 |
//! | x_i | mole fraction of a gas | 1 |
//! | r_i | its n − 1 at 0 °C and 101325 Pa near 589 nm: N₂ 2.98, O₂ 2.71, Ar 2.81, CO₂ 4.49, H₂O 2.54, air 2.922458 | 1e-4 |
//! | T, p | temperature and pressure | K, Pa |
//!
//! **Validity.** An ideal gas whose molecules bend light as cold ones do (Gladstone and Dale), with the dispersion of
//! air. Composition and polarisability leave about 1 % to doubt at 2000 K. At 373 K it meets Ciddor's equation within
//! 7e-5 (dry) to 1.7e-4 (saturated at 20 °C) of n − 1, and the blend hides that step. Carbon dioxide of the air around is part of
//! Ciddor's equation only.
//!
//! **Sources.** Gladstone and Dale, Phil. Trans. R. Soc. 153 (1863) 317; refractivities as in D. R. Lide (ed.), *CRC
//! Handbook of Chemistry and Physics*, index of refraction of gases; stoichiometry as in S. R. Turns, *An Introduction to
//! Combustion* (2000), eq. 2.30.

use super::moist_air::{
    AMBIENT_RANGE_K, AirError, Ambient, Dispersion, Edition, MoistAir, STANDARD_COMPRESSIBILITY,
    STANDARD_PRESSURE_PA, STANDARD_TEMPERATURE_K,
};

/// r of N₂, CO₂, H₂O and dry air, 1e-4.
const NITROGEN: f64 = 2.98;
const CARBON_DIOXIDE: f64 = 4.49;
const WATER: f64 = 2.54;
const DRY_AIR: f64 = 2.922458;

/// Moles of nitrogen (with argon) that come with one of oxygen.
const NITROGEN_PER_OXYGEN: f64 = 3.76;

/// Where Ciddor's equation begins to give way to the hot gas's, and where it has, K.
const BLEND_K: [f64; 2] = [373.15, AMBIENT_RANGE_K[1]];

/// n − 1 of hot dry air, k_comp = 1. Preconditions: `temperature_k` > 0, `pressure_pa` ≥ 0, both finite.
pub fn hot_refractivity(dispersion: Dispersion, temperature_k: f64, pressure_pa: f64) -> f64 {
    debug_assert!(temperature_k > 0.0, "{temperature_k} K");
    dispersion.standard_air
        * STANDARD_COMPRESSIBILITY
        * (STANDARD_TEMPERATURE_K / temperature_k)
        * (pressure_pa / STANDARD_PRESSURE_PA)
}

/// k_air of air with a mole fraction `water` (0 to 1) of water.
pub fn moist_air_factor(water: f64) -> f64 {
    1.0 - water + water * WATER / DRY_AIR
}

/// What a molecule of fuel is made of. Fractions are fine: wood is CH₁.₄O₀.₆.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atoms {
    /// Atoms of carbon, at least 0.
    pub carbon: f64,
    /// Atoms of hydrogen, at least 0.
    pub hydrogen: f64,
    /// Atoms of oxygen, at least 0.
    pub oxygen: f64,
}

impl Atoms {
    /// k_comp of what is left when this has burnt wholly in just the air it needs; `None` where there is nothing to
    /// burn: no carbon, no hydrogen, or more oxygen than they bind.
    pub fn products_factor(self) -> Option<f64> {
        let oxygen = self.carbon + 0.25 * self.hydrogen - 0.5 * self.oxygen;
        if !(oxygen > 0.0 && oxygen.is_finite()) {
            return None;
        }
        let gases = [
            (self.carbon, CARBON_DIOXIDE),
            (0.5 * self.hydrogen, WATER),
            (NITROGEN_PER_OXYGEN * oxygen, NITROGEN),
        ];
        let moles: f64 = gases.iter().map(|(moles, _)| moles).sum();
        let refractivity: f64 = gases.iter().map(|(moles, r)| moles * r).sum();
        Some(refractivity / moles / DRY_AIR)
    }
}

/// The gas of a fire: air of the surroundings, mixed with products of the fuel. Made once for a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FireGas {
    air: MoistAir,
    air_factor: f64,
    products_factor: f64,
}

impl FireGas {
    /// The gas of a fire that burns `fuel` in these surroundings. Without a fuel that burns, its products are air.
    ///
    /// # Errors
    /// [`AirError`] names the number that is out of range, or that air cannot hold so much water.
    pub fn new(ambient: &Ambient, fuel: Option<Atoms>) -> Result<Self, AirError> {
        Self::by(Edition::default(), ambient, fuel)
    }

    /// [`FireGas::new`] in a chosen edition of Ciddor's equation.
    ///
    /// # Errors
    /// As [`FireGas::new`].
    pub fn by(edition: Edition, ambient: &Ambient, fuel: Option<Atoms>) -> Result<Self, AirError> {
        let air = MoistAir::by(edition, ambient)?;
        let air_factor = moist_air_factor(air.water());
        let products_factor = fuel.and_then(Atoms::products_factor).unwrap_or(air_factor);
        Ok(Self {
            air,
            air_factor,
            products_factor,
        })
    }

    /// The air around.
    pub fn air(&self) -> &MoistAir {
        &self.air
    }

    /// k_comp of the fuel's products.
    pub fn products_factor(&self) -> f64 {
        self.products_factor
    }

    /// n − 1 at a temperature, of gas in which the share `products` (mole fraction, 0 air to 1 products alone) has
    /// burnt.
    ///
    /// Preconditions: `temperature_k` finite, `products` in 0..=1. Below 200 K, where Ciddor's equation ends, the value
    /// at 200 K is held: a fire has no such gas, a file may hold such a number.
    pub fn refractivity(&self, dispersion: Dispersion, temperature_k: f64, products: f64) -> f64 {
        debug_assert!((0.0..=1.0).contains(&products), "{products}");
        let temperature_k = temperature_k.max(AMBIENT_RANGE_K[0]);
        let mixture = self.air_factor + products * (self.products_factor - self.air_factor);
        let hot_share = smoothstep(BLEND_K, temperature_k);
        let hot = if hot_share > 0.0 {
            let dry = hot_refractivity(dispersion, temperature_k, self.air.pressure_pa());
            hot_share * mixture * dry
        } else {
            0.0
        };
        let cold = if hot_share < 1.0 {
            let air = self.air.refractivity(dispersion, temperature_k);
            (1.0 - hot_share) * (mixture / self.air_factor) * air
        } else {
            0.0
        };
        cold + hot
    }
}

/// 0 up to the first edge, 1 from the second on, a smooth cubic between.
fn smoothstep([low, high]: [f64; 2], x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use proptest::prelude::*;

    use super::super::golden_csv::Table;
    use super::*;

    const HOT_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/refraction_hot.csv"
    ));

    const METHANE: Atoms = Atoms {
        carbon: 1.0,
        hydrogen: 4.0,
        oxygen: 0.0,
    };
    const ROOM: Ambient = Ambient {
        temperature_k: 293.15,
        pressure_pa: STANDARD_PRESSURE_PA,
        humidity: 0.5,
        co2_ppm: 450.0,
    };

    fn green() -> Dispersion {
        Dispersion::at(550.0).unwrap()
    }

    #[test]
    fn hot_gas_agrees_with_fifty_digit_arithmetic() {
        let mut compared = 0;
        for row in Table::parse(HOT_CSV).rows() {
            let dispersion = Dispersion::at(row.number("lambda_nm")).unwrap();
            let got = row.number("k_comp")
                * hot_refractivity(dispersion, row.number("T_K"), STANDARD_PRESSURE_PA);
            let expected = row.number("n_minus_1");
            assert!(
                (got / expected - 1.0).abs() < 1e-14,
                "{} at {} K: {got:e}, expected {expected:e}",
                row.text("composition"),
                row.text("T_K")
            );
            compared += 1;
        }
        assert!(compared > 80, "only {compared} rows");
    }

    #[test]
    fn factors_agree_with_those_of_the_reference() {
        let methane = METHANE.products_factor().unwrap();
        for row in Table::parse(HOT_CSV).rows() {
            let expected = row.number("k_comp");
            let got = match row.text("composition") {
                "dry_air" => moist_air_factor(0.0),
                "CH4_stoich_products" => methane,
                "mix50_CH4_products" => 0.5 * (1.0 + methane),
                moist => {
                    assert!(moist.starts_with("air_xw0.0117"), "{moist}");
                    moist_air_factor(0.0117)
                }
            };
            // The reference's r of dry air has more digits than are printed.
            assert!((got / expected - 1.0).abs() < 1e-6, "{got}, {expected}");
        }
    }

    #[test]
    fn products_bend_light_a_little_more_than_air() {
        let hydrocarbon = |carbon, hydrogen| Atoms {
            carbon,
            hydrogen,
            oxygen: 0.0,
        };
        for (fuel, expected) in [
            (METHANE, 1.040),
            (hydrocarbon(3.0, 8.0), 1.056),
            (hydrocarbon(2.0, 2.0), 1.091),
        ] {
            let factor = fuel.products_factor().unwrap();
            assert!((factor - expected).abs() < 6e-4, "{fuel:?}: {factor}");
        }
    }

    #[test]
    fn what_does_not_burn_leaves_air() {
        for (carbon, hydrogen, oxygen) in [(0.0, 0.0, 0.0), (1.0, 0.0, 2.0), (0.0, 2.0, 1.0)] {
            let ash = Atoms {
                carbon,
                hydrogen,
                oxygen,
            };
            assert_eq!(ash.products_factor(), None, "{ash:?}");
            let gas = FireGas::new(&ROOM, Some(ash)).unwrap();
            assert_eq!(
                gas.refractivity(green(), 1500.0, 1.0),
                gas.refractivity(green(), 1500.0, 0.0)
            );
        }
    }

    #[test]
    fn case_44_hot_moist_air_bends_light_as_hot_gas_does() {
        let gas = FireGas::new(&ROOM, Some(METHANE)).unwrap();
        let hot = gas.refractivity(green(), 1500.0, 0.0);
        assert!((hot / 5.3e-5 - 1.0).abs() < 0.01, "{hot:e}");
        // At 500 K the humidity chain would give −9.9e-6.
        let warm = gas.refractivity(green(), 500.0, 0.0);
        assert!((warm / hot - 3.0).abs() < 1e-12, "{warm:e}");
    }

    #[test]
    fn near_the_surroundings_the_gas_is_ciddors() {
        let gas = FireGas::new(&ROOM, Some(METHANE)).unwrap();
        for temperature_k in [200.0, 293.15, 373.15] {
            assert_eq!(
                gas.refractivity(green(), temperature_k, 0.0),
                gas.air().refractivity(green(), temperature_k)
            );
        }
        assert_eq!(
            gas.refractivity(green(), 1.0, 0.0),
            gas.refractivity(green(), 200.0, 0.0)
        );
    }

    #[test]
    fn the_two_laws_meet_where_one_gives_way_to_the_other() {
        let step = |humidity: f64| {
            let ambient = Ambient { humidity, ..ROOM };
            let gas = FireGas::new(&ambient, None).unwrap();
            let hot = moist_air_factor(gas.air().water())
                * hot_refractivity(green(), 373.0, STANDARD_PRESSURE_PA);
            (hot / gas.air().refractivity(green(), 373.0) - 1.0).abs()
        };
        assert!((step(0.0) - 7e-5).abs() < 1e-5, "{}", step(0.0));
        assert!((step(1.0) - 1.74e-4).abs() < 1e-6, "{}", step(1.0));
    }

    proptest! {
        #[test]
        fn hotter_gas_bends_light_less(
            cold_k in 200.0..2500.0_f64,
            humidity in 0.0..1.0_f64,
            products in 0.0..1.0_f64,
            lambda_nm in 230.0..2000.0_f64,
        ) {
            let gas = FireGas::new(&Ambient { humidity, ..ROOM }, Some(METHANE)).unwrap();
            let dispersion = Dispersion::at(lambda_nm).unwrap();
            let cold = gas.refractivity(dispersion, cold_k, products);
            let hot = gas.refractivity(dispersion, 1.001 * cold_k, products);
            prop_assert!(hot < cold && hot > 0.0, "{cold:e} at {cold_k} K, then {hot:e}");
        }
    }
}
