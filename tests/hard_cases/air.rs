//! Cases 44 to 49: air that is too hot, too cold, too wet or none.

use sootlight::physics::hot_gas::{FireGas, moist_air_factor};
use sootlight::physics::moist_air::{
    AirError, Ambient, Dispersion, Edition, MoistAir, STANDARD_PRESSURE_PA,
};
use sootlight::physics::saturation::{
    CRITICAL_POINT_K, davis, over_ice, over_water, over_water_or_ice,
};
use sootlight::project::ProjectError;

use super::{assert_close, refusal};

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

#[test]
fn case_44_humidity_is_worked_out_in_no_hot_gas() {
    for temperature_k in [400.1, 500.0, 1500.0] {
        let error = MoistAir::new(&Ambient {
            temperature_k,
            ..ROOM
        })
        .unwrap_err();
        assert_eq!(error, AirError::Temperature(temperature_k));
        assert!(
            error
                .to_string()
                .ends_with("hotter gas belongs to the flame"),
            "{error}"
        );
    }
    // Not −9.9e-6 at 500 K and −1.2e-12 at 1500 K, which the humidity's chain would give.
    let gas = FireGas::new(&ROOM, None).unwrap();
    let [warm, hot] = [500.0, 1500.0].map(|kelvin| gas.refractivity(green(), kelvin, 0.0));
    assert_close(hot, 5.3e-5, 0.01, "n − 1 at 1500 K");
    assert_close(warm, 3.0 * hot, 1e-12, "n − 1 at 500 K");
    assert!(
        refusal(&["air.temperature_k=1500"])
            .to_string()
            .contains("between 200 and 400")
    );
}

#[test]
fn case_45_above_the_critical_point_there_is_no_saturation() {
    // 22.064 MPa at the critical point (IAPWS).
    assert_close(
        over_water(CRITICAL_POINT_K).unwrap(),
        22.064e6,
        1e-6,
        "at the critical point",
    );
    for kelvin in [
        647.0961,
        650.0,
        650.17534844798,
        650.2,
        1000.0,
        f64::INFINITY,
        f64::NAN,
    ] {
        assert_eq!(over_water(kelvin), None, "{kelvin} K");
        assert_eq!(over_water_or_ice(kelvin), None, "{kelvin} K");
    }
}

#[test]
fn case_46_over_ice_there_is_less_than_over_supercooled_water_and_no_air_below_200_kelvin() {
    for (celsius, excess) in [(-5.0, 0.050), (-20.0, 0.216), (-40.0, 0.481)] {
        let kelvin = 273.15 + celsius;
        let found = davis(kelvin) / over_ice(kelvin).unwrap() - 1.0;
        assert!((found - excess).abs() < 5e-4, "{celsius} °C: {found}");
    }
    let frost = Ambient {
        temperature_k: 253.15,
        humidity: 1.0,
        ..ROOM
    };
    let [published, nist] = [Edition::Ciddor1996, Edition::Nist].map(|edition| {
        let air = MoistAir::by(edition, &frost).unwrap();
        air.refractivity(green(), frost.temperature_k)
    });
    assert_close((published - nist).abs(), 9.3e-9, 0.01, "in n at −20 °C");
    assert_eq!([davis(1e-3), davis(f64::MIN_POSITIVE)], [0.0; 2]);
    for temperature_k in [199.999, 1.0, 0.0, -1.0, f64::NAN] {
        for edition in [Edition::Ciddor1996, Edition::Nist] {
            let air = MoistAir::by(
                edition,
                &Ambient {
                    temperature_k,
                    ..ROOM
                },
            );
            assert!(
                matches!(air, Err(AirError::Temperature(_))),
                "{temperature_k} K: {air:?}"
            );
        }
    }
    // A file's gas may be as cold: there the value of 200 K is held.
    let gas = FireGas::new(&ROOM, None).unwrap();
    assert_eq!(
        gas.refractivity(green(), 1e-3, 0.0),
        gas.refractivity(green(), 200.0, 0.0)
    );
}

#[test]
fn case_47_more_water_than_air_is_refused() {
    for (pressure_pa, water) in [(80_000.0, 1.278), (STANDARD_PRESSURE_PA, 1.00999)] {
        let kettle = Ambient {
            temperature_k: 373.15,
            pressure_pa,
            humidity: 1.0,
            ..ROOM
        };
        // The stated numbers are of Davis's line.
        let error = MoistAir::by(Edition::Ciddor1996, &kettle).unwrap_err();
        let AirError::TooMuchWater(found) = error else {
            panic!("{error:?}");
        };
        assert!((found - water).abs() < 5e-4, "{found}");
        assert!(
            error
                .to_string()
                .contains("lower the humidity or the temperature"),
            "{error}"
        );
        assert!(matches!(
            MoistAir::new(&kettle),
            Err(AirError::TooMuchWater(_))
        ));
    }
    let asked = [
        "air.temperature_k=373.15",
        "air.humidity=1",
        "effects.refraction=on",
    ];
    let error = refusal(&asked);
    assert!(
        matches!(error, ProjectError::Air(AirError::TooMuchWater(_))),
        "{error:?}"
    );
    assert!(
        error
            .to_string()
            .ends_with("(air.humidity, air.temperature_k, air.pressure_pa)"),
        "{error}"
    );
}

#[test]
fn case_48_a_vacuum_has_an_index_of_one() {
    for humidity in [0.0, 0.5, 1.0] {
        let vacuum = Ambient {
            pressure_pa: 0.0,
            humidity,
            ..ROOM
        };
        for edition in [Edition::Ciddor1996, Edition::Nist] {
            let air = MoistAir::by(edition, &vacuum).unwrap();
            assert_eq!((air.water(), air.refractivity(green(), 300.0)), (0.0, 0.0));
        }
        let gas = FireGas::new(&vacuum, None).unwrap();
        for kelvin in [200.0, 300.0, 390.0, 1500.0] {
            assert_eq!(gas.refractivity(green(), kelvin, 0.0), 0.0, "{kelvin} K");
        }
    }
    assert_eq!(moist_air_factor(0.0), 1.0);
    let error = refusal(&["air.pressure_pa=0"]);
    assert_eq!(
        error.to_string(),
        "air.pressure_pa is 0: it must lie between 1000 and 1000000"
    );
}

#[test]
fn case_49_wavelengths_at_the_resonances_are_refused() {
    for lambda_nm in [
        229.999,
        132.0,
        64.8,
        1.0,
        0.0,
        -550.0,
        f64::INFINITY,
        f64::NAN,
    ] {
        let error = Dispersion::at(lambda_nm).unwrap_err();
        assert!(matches!(error, AirError::Wavelength(_)), "{error:?}");
        assert!(
            error.to_string().ends_with("is known from 230 nm on"),
            "{error}"
        );
    }
    let indices =
        [230.0, 300.0, 550.0, 800.0, 1e4].map(|nm| Dispersion::at(nm).unwrap().standard_air);
    assert!(
        indices.is_sorted_by(|a, b| a > b) && indices[4] > 2.5e-4,
        "{indices:?}"
    );
}
