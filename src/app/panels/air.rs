//! The air around the fire, and how far its bending of light moves what is behind.

use egui::Ui;

use super::knob::{Choice, Knob, note};
use super::{Known, section, short, unit};
use crate::project::{AirSettings, Control, Project, Saturation, ranges};

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project, known: Known<'_>) {
    section(ui, "Air", true, |ui| {
        let default = AirSettings::default();
        let air = &mut project.air;
        Knob {
            label: "Humidity",
            unit: unit::PERCENT,
            slider: ranges::HUMIDITY,
            range: ranges::HUMIDITY,
            logarithmic: false,
            default: default.humidity,
            tip: "Relative humidity. Moist air bends light a little less than dry air (n − 1 falls by one part in \
                  200 from dry to saturated at 300 K), which moves what is seen through it.",
            idle: known.idle(Control::Humidity),
        }
        .show(ui, &mut air.humidity);
        saturation(ui, air, known);
        Knob {
            label: "CO₂",
            unit: unit::PPM,
            slider: ranges::CO2_PPM,
            range: ranges::CO2_PPM,
            logarithmic: false,
            default: default.co2_ppm,
            tip: "Carbon dioxide in the air, molecules in a million. It bends light a little more than air does (n − 1 \
                  grows by one part in 2000 for each 1000 ppm), which moves what is seen through it.",
            idle: known.idle(Control::Co2),
        }
        .show(ui, &mut air.co2_ppm);
        Knob {
            label: "Pressure",
            unit: unit::HECTOPASCAL,
            slider: [50_000.0, 110_000.0],
            range: ranges::PRESSURE_PA,
            logarithmic: false,
            default: default.pressure_pa,
            tip: "Pressure of the air. Denser air bends light more, in proportion: at half the pressure, 5500 m up, what \
                  is behind the fire moves by half.",
            idle: known.idle(Control::Pressure),
        }
        .show(ui, &mut air.pressure_pa);
        Knob {
            label: "Air temp.",
            unit: unit::KELVIN,
            slider: [250.0, 320.0],
            range: ranges::AIR_TEMPERATURE_K,
            logarithmic: false,
            default: default.temperature_k,
            tip: "Temperature of the air around the fire, and of gas of which the file says nothing. Colder air is \
                  denser: it differs more from the hot gas, and bends light more.",
            idle: known.idle(Control::AirTemperature),
        }
        .show(ui, &mut air.temperature_k);
        let has_heat = known
            .job
            .is_some_and(|job| job.flame.maps.temperature.is_some());
        if has_heat && known.idle(Control::AirTemperature).is_none() {
            note(
                ui,
                "within the fire the file says how hot it is: this is the air around it",
            );
        }
        Knob {
            label: "Exaggeration",
            unit: unit::TIMES,
            slider: ranges::REFRACTION_GAIN,
            range: ranges::REFRACTION_GAIN,
            logarithmic: true,
            default: default.refraction_gain,
            tip: "Multiplies how strongly hot gas bends light, for the eye. 1 is nature's; more is no longer faithful, \
                  and said below.",
            idle: known.idle(Control::RefractionGain),
        }
        .show(ui, &mut air.refraction_gain);
        if known.job.is_some_and(|job| job.flame.bending.is_some()) {
            note(ui, &shift(known.facts.largest_shift_px));
        }
    });
}

/// Whose saturation pressure.
fn saturation(ui: &mut Ui, air: &mut AirSettings, known: Known<'_>) {
    let options = Saturation::ALL.map(|whose| {
        let (words, tip) = match whose {
            Saturation::Huang => (
                "Huang 1998 (steam tables)",
                "Over water, over ice below freezing; as NIST works the index out.",
            ),
            Saturation::Davis => (
                "Davis 1992",
                "Over water at every temperature; as Ciddor published it in 1996.",
            ),
        };
        (whose, words.to_owned(), tip)
    });
    Choice {
        label: "Saturation",
        options: &options,
        tip: "Whose measurement says how much water air can hold, and so how much the humidity is.",
        default: Saturation::default(),
        idle: known.idle(Control::Saturation),
    }
    .show(ui, &mut air.saturation);
}

/// How far what is behind moves, in words.
fn shift(largest_px: Option<f64>) -> String {
    let words = largest_px.map_or_else(
        || "not yet measured".to_owned(),
        |pixels| format!("by at most {} px", short(pixels)),
    );
    format!("refraction moves what is behind: {words}")
}

#[cfg(test)]
mod tests {
    use super::shift;

    #[test]
    fn a_shift_is_told_in_pixels_once_it_is_measured() {
        assert!(shift(None).ends_with("not yet measured"));
        assert!(shift(Some(1.7)).ends_with("by at most 1.7 px"));
    }
}
