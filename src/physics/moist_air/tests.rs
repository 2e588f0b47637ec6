#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::super::golden_csv::{Row, Table};
use super::*;

const CIDDOR_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/ciddor.csv"
));
const PUBLISHED_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/ciddor_validation.csv"
));

/// A room.
const ROOM: Ambient = Ambient {
    temperature_k: 293.15,
    pressure_pa: STANDARD_PRESSURE_PA,
    humidity: 0.5,
    co2_ppm: 450.0,
};

fn green() -> Dispersion {
    Dispersion::at(550.0).unwrap()
}

fn ambient_of(row: &Row<'_>) -> Ambient {
    Ambient {
        temperature_k: row.number("t_C") + MELTING_POINT_K,
        pressure_pa: row.number("p_Pa"),
        humidity: row.number("RH"),
        co2_ppm: row.number("CO2_ppm"),
    }
}

#[test]
fn refractivity_agrees_with_fifty_digit_arithmetic() {
    let (mut compared, mut refused) = (0, 0);
    for row in Table::parse(CIDDOR_CSV).rows() {
        let ambient = ambient_of(&row);
        let dispersion = Dispersion::at(row.number("lambda_nm")).unwrap();
        for (edition, name) in [(Edition::Ciddor1996, "davis"), (Edition::Nist, "nist")] {
            let water = row.number(&format!("x_w_{name}"));
            let air = MoistAir::by(edition, &ambient);
            if water > 1.0 {
                assert!(
                    matches!(air, Err(AirError::TooMuchWater(x)) if (x / water - 1.0).abs() < 1e-13),
                    "{ambient:?}: {air:?}"
                );
                refused += 1;
                continue;
            }
            let air = air.unwrap();
            let got = air.refractivity(dispersion, ambient.temperature_k);
            let expected = row.number(&format!("n_minus_1_{name}"));
            assert!((air.water() - water).abs() <= 1e-13 * water, "{ambient:?}");
            assert!(
                (got - expected).abs() < 1e-15,
                "{name}, {ambient:?}: {got:e}, expected {expected:e}"
            );
            compared += 1;
        }
    }
    assert!(compared > 400 && refused >= 8, "{compared}, {refused}");
}

#[test]
fn refractivity_agrees_with_the_printed_tables() {
    let mut compared = 0;
    for row in Table::parse(PUBLISHED_CSV).rows() {
        let nist = row.text("source").starts_with("NIST");
        let edition = if nist {
            Edition::Nist
        } else {
            Edition::Ciddor1996
        };
        let air = MoistAir {
            pressure_pa: row.number("p_Pa"),
            water: row.number("x_w"),
            co2_ppm: row.number("CO2_ppm"),
            gas_constant: edition.gas_constant(),
        };
        let dispersion = Dispersion::at(row.number("lambda_nm")).unwrap();
        let got = air.refractivity(dispersion, row.number("t_C") + MELTING_POINT_K);
        let printed = row.number("published_n_minus_1");
        // The tables print nine decimals of n.
        let tolerance = match row.text("matches") {
            "yes" => 0.5e-9,
            "within 1 ulp" => 1e-9,
            _ => continue,
        };
        assert!(
            (got - printed).abs() <= tolerance * (1.0 + 1e-6),
            "{}: {got:e}, printed {printed:e}",
            row.text("source")
        );
        compared += 1;
    }
    assert!(compared > 50, "only {compared} rows");
}

#[test]
fn the_two_editions_differ_by_less_than_air_is_known_to() {
    for celsius in [0.0, 10.0, 20.0, 30.0] {
        let ambient = Ambient {
            temperature_k: MELTING_POINT_K + celsius,
            humidity: 1.0,
            ..ROOM
        };
        let [a, b] = [Edition::Ciddor1996, Edition::Nist].map(|edition| {
            let air = MoistAir::by(edition, &ambient).unwrap();
            air.refractivity(green(), ambient.temperature_k)
        });
        assert!((a - b).abs() < 1e-10, "{celsius} °C: {a:e}, {b:e}");
    }
}

#[test]
fn case_44_humidity_is_refused_in_hot_gas() {
    for temperature_k in [400.1, 500.0, 1500.0] {
        let hot = Ambient {
            temperature_k,
            ..ROOM
        };
        assert_eq!(
            MoistAir::new(&hot),
            Err(AirError::Temperature(temperature_k))
        );
    }
}

#[test]
fn case_46_air_colder_than_any_on_earth_is_refused() {
    for temperature_k in [199.9, 0.0, -1.0, f64::NAN] {
        let cold = Ambient {
            temperature_k,
            ..ROOM
        };
        assert!(matches!(
            MoistAir::new(&cold),
            Err(AirError::Temperature(_))
        ));
    }
}

#[test]
fn case_47_more_water_than_air_is_refused() {
    let kettle = |humidity, pressure_pa| Ambient {
        temperature_k: 373.15,
        pressure_pa,
        humidity,
        ..ROOM
    };
    for (pressure_pa, expected) in [(80_000.0, 1.278), (STANDARD_PRESSURE_PA, 1.01)] {
        match MoistAir::new(&kettle(1.0, pressure_pa)) {
            Err(AirError::TooMuchWater(x)) => assert!((x - expected).abs() < 1e-3, "{x}"),
            other => panic!("{other:?}"),
        }
    }
    let steam = MoistAir::new(&kettle(0.98, STANDARD_PRESSURE_PA)).unwrap();
    assert!(steam.water() < 1.0 && steam.refractivity(green(), 373.15) > 0.0);
}

#[test]
fn case_48_a_vacuum_does_not_bend_light() {
    for humidity in [0.0, 0.5, 1.0] {
        let vacuum = Ambient {
            pressure_pa: 0.0,
            humidity,
            ..ROOM
        };
        let air = MoistAir::new(&vacuum).unwrap();
        assert_eq!(air.water(), 0.0);
        assert_eq!(air.refractivity(green(), 300.0), 0.0);
    }
}

#[test]
fn case_49_wavelengths_at_the_resonances_are_refused() {
    for lambda_nm in [229.9, 132.0, 64.8, 0.0, -550.0, f64::INFINITY, f64::NAN] {
        assert!(
            matches!(Dispersion::at(lambda_nm), Err(AirError::Wavelength(_))),
            "{lambda_nm} nm"
        );
    }
    // Normal dispersion from the first wavelength on: shorter waves are bent more.
    let indices: Vec<f64> = [230.0, 300.0, 550.0, 800.0, 1e4]
        .map(|nm| Dispersion::at(nm).unwrap().standard_air)
        .to_vec();
    assert!(indices.is_sorted_by(|a, b| a > b), "{indices:?}");
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    for (ambient, expected) in [
        (
            Ambient {
                pressure_pa: -1.0,
                ..ROOM
            },
            "the pressure is -1 Pa",
        ),
        (
            Ambient {
                humidity: 1.5,
                ..ROOM
            },
            "the relative humidity is 1.5",
        ),
        (
            Ambient {
                co2_ppm: 2001.0,
                ..ROOM
            },
            "2001 ppm",
        ),
    ] {
        let error = MoistAir::new(&ambient).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
}
