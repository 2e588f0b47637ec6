//! Saturation pressure of water vapour: how much water air can hold.
//!
//! ```text
//! Davis            p = exp(A T² + B T + C + D/T) Pa
//! over water       p = 1e6 [2c/(−b + √(b² − 4ac))]⁴ Pa,   Ω = T + K₉/(T − K₁₀)
//!                  a = Ω² + K₁Ω + K₂,  b = K₃Ω² + K₄Ω + K₅,  c = K₆Ω² + K₇Ω + K₈
//! over ice         p = 611.657 exp(−13.928169 (1 − θ^−1.5) + 34.7078238 (1 − θ^−1.25)) Pa,   θ = T/273.16 K
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | p | saturation pressure | Pa |
//! | T | temperature | K |
//!
//! **Validity.** [`davis`] was fitted between 0 and 27 °C and follows the line over water to −100 and 100 °C (3e-4 at
//! 100 °C); below 0 °C it stays with supercooled water, which over ice is 5 % too much at −5 °C and 48 % at −40 °C.
//! [`over_water`] is the saturation line of the steam tables, 273.15 to 647.096 K, and continues smoothly over
//! supercooled water; at 650.175 K it is singular, and above the critical point there is no line at all. [`over_ice`]
//! holds below 273.16 K.
//!
//! **Sources.** R. S. Davis, Metrologia 29 (1992) 67, eq. A1.1 (CIPM-81/91); W. Wagner et al., J. Eng. Gas Turbines
//! Power 122 (2000) 150 (IAPWS-IF97, region 4), in the form of P. H. Huang's *New equations for water vapor pressure*
//! (1998), as the Engineering Metrology Toolbox of NIST quotes it; over ice that Toolbox, after IAPWS (1993).

/// Temperature of melting ice at ordinary pressure, K: 0 °C.
pub const MELTING_POINT_K: f64 = 273.15;
/// Critical temperature of water, K: above it liquid and vapour are one.
pub const CRITICAL_POINT_K: f64 = 647.096;

/// Davis: coefficients of T², T, 1 and 1/T in the exponent.
const DAVIS: [f64; 4] = [1.2378847e-5, -1.9121316e-2, 33.93711047, -6343.1645];

/// K₁ to K₁₀ of the saturation line over water.
const WATER: [f64; 10] = [
    1167.05214528,
    -724213.167032,
    -17.0738469401,
    12020.8247025,
    -3232555.03223,
    14.9151086135,
    -4823.26573616,
    405113.405421,
    -0.238555575678,
    650.175348448,
];

/// Temperature of water's triple point, K, and its pressure, Pa.
const TRIPLE_POINT: (f64, f64) = (273.16, 611.657);
/// Coefficients of the line over ice.
const ICE: [f64; 2] = [-13.928169, 34.7078238];

/// Saturation pressure over water in Pa by Davis's equation. Precondition: `temperature_k` > 0, meaningful within
/// −100 to 100 °C.
pub fn davis(temperature_k: f64) -> f64 {
    let [square, linear, constant, inverse] = DAVIS;
    let t = temperature_k;
    // Summed as the powers are written: a Horner form rounds the large terms that cancel differently.
    (square * t * t + linear * t + constant + inverse / t).exp()
}

/// Saturation pressure over liquid water in Pa on the line of the steam tables; `None` above the critical point, where
/// there is none, and below 200 K, where water has long frozen.
pub fn over_water(temperature_k: f64) -> Option<f64> {
    if !(200.0..=CRITICAL_POINT_K).contains(&temperature_k) {
        return None;
    }
    let k = |i: usize| WATER[i - 1];
    let omega = temperature_k + k(9) / (temperature_k - k(10));
    let quadratic = |first: f64, second: f64, third: f64| (first * omega + second) * omega + third;
    let a = quadratic(1.0, k(1), k(2));
    let b = quadratic(k(3), k(4), k(5));
    let c = quadratic(k(6), k(7), k(8));
    let root = 2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt());
    Some(1e6 * root.powi(4))
}

/// Saturation pressure over ice in Pa; `None` above the triple point, where ice melts. Precondition: `temperature_k` ≥ 0.
pub fn over_ice(temperature_k: f64) -> Option<f64> {
    let (triple_k, triple_pa) = TRIPLE_POINT;
    if !(0.0..=triple_k).contains(&temperature_k) {
        return None;
    }
    let theta = temperature_k / triple_k;
    let exponent = ICE[0] * (1.0 - theta.powf(-1.5)) + ICE[1] * (1.0 - theta.powf(-1.25));
    Some(triple_pa * exponent.exp())
}

/// Saturation pressure in Pa over what is there: ice below 0 °C, water from there to the critical point; `None` beyond.
pub fn over_water_or_ice(temperature_k: f64) -> Option<f64> {
    if temperature_k < MELTING_POINT_K {
        over_ice(temperature_k)
    } else {
        over_water(temperature_k)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::super::golden_csv::Table;
    use super::*;

    const PRESSURE_CSV: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/vapor_pressure.csv"
    ));

    #[test]
    fn pressures_agree_with_fifty_digit_arithmetic() {
        let mut compared = [0; 4];
        for row in Table::parse(PRESSURE_CSV).rows() {
            let t = row.number("T_K");
            let columns = [
                ("davis_Pa", Some(davis(t))),
                ("huang_water_Pa", over_water(t)),
                ("ice_Pa", over_ice(t)),
                ("nist_Pa", over_water_or_ice(t)),
            ];
            for ((column, got), compared) in columns.into_iter().zip(&mut compared) {
                if row.text(column).is_empty() {
                    assert!(got.is_none(), "{column} at {t} K: {got:?}");
                    continue;
                }
                let (got, expected) = (got.unwrap(), row.number(column));
                assert!(
                    (got / expected - 1.0).abs() < 5e-14,
                    "{column} at {t} K: {got:e}, expected {expected:e}"
                );
                *compared += 1;
            }
        }
        assert!(
            compared.iter().all(|&count| count >= 11),
            "{compared:?} comparisons"
        );
    }

    #[test]
    fn case_45_above_the_critical_point_there_is_no_saturation() {
        // IAPWS: 22.064 MPa at the critical point.
        let critical = over_water(CRITICAL_POINT_K).unwrap();
        assert!((critical / 22.064e6 - 1.0).abs() < 1e-6, "{critical}");
        for t in [647.2, 650.17534844798, 1000.0, f64::INFINITY, f64::NAN] {
            assert_eq!(over_water(t), None, "{t} K");
            assert_eq!(over_water_or_ice(t), None, "{t} K");
        }
    }

    #[test]
    fn case_46_over_ice_there_is_less_than_over_supercooled_water() {
        for (celsius, excess) in [(-5.0, 0.050), (-20.0, 0.216), (-40.0, 0.481)] {
            let t = MELTING_POINT_K + celsius;
            let found = davis(t) / over_water_or_ice(t).unwrap() - 1.0;
            assert!((found - excess).abs() < 5e-4, "{celsius} °C: {found}");
        }
        assert_eq!(davis(1e-3), 0.0);
        assert_eq!(over_ice(280.0), None);
    }
}
