//! The air around the fire.

use egui::Ui;

use super::knob::Knob;
use super::{section, unit};
use crate::project::{AirSettings, Control, Job, Project, ranges, why_idle};

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project, job: Option<&Job>) {
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
            idle: job.and_then(|job| why_idle(job, Control::Humidity, &[])),
        }
        .show(ui, &mut air.humidity);
        Knob {
            label: "CO₂",
            unit: unit::PPM,
            slider: ranges::CO2_PPM,
            range: ranges::CO2_PPM,
            logarithmic: false,
            default: default.co2_ppm,
            tip: "Carbon dioxide in the air, molecules in a million. It bends light a little more than air does (n − 1 \
                  grows by one part in 2000 for each 1000 ppm), which moves what is seen through it.",
            idle: job.and_then(|job| why_idle(job, Control::Co2, &[])),
        }
        .show(ui, &mut air.co2_ppm);
    });
}
