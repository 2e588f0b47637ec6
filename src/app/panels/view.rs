//! How the light becomes a picture. Nothing here is rendered again.

use egui::Ui;

use super::knob::{Choice, Knob};
use super::{Command, section, unit};
use crate::colour::display::Curve;
use crate::project::{Project, ViewSettings, ranges};

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project, commands: &mut Vec<Command>) {
    section(ui, "View", true, |ui| {
        let default = ViewSettings::default();
        let view = &mut project.view;
        Knob {
            label: "Exposure",
            unit: unit::STOPS,
            slider: [-10.0, 10.0],
            range: ranges::EXPOSURE_EV,
            logarithmic: false,
            default: default.exposure_ev,
            tip: "How long the picture is exposed, in stops: one more doubles the light. Counted from the exposure \
                  that was measured when the fire was first seen. The fire itself stays as it is.",
            idle: None,
        }
        .show(ui, &mut view.exposure_ev);
        Knob {
            label: "Adaptation",
            unit: unit::PERCENT,
            slider: ranges::ADAPTATION,
            range: ranges::ADAPTATION,
            logarithmic: false,
            default: default.adaptation,
            tip: "How far the eye has got used to the fire's own light. At 0 % a flame is as deep orange as it would \
                  be beside daylight; at 100 % its hottest part looks white, as after minutes in a dark room.",
            idle: None,
        }
        .show(ui, &mut view.adaptation);
        let options = [
            (
                Curve::Filmic,
                "Filmic".to_owned(),
                "A shoulder, as of film: bright parts turn yellow, then white, and keep their shapes.",
            ),
            (
                Curve::Linear,
                "Linear".to_owned(),
                "Light as it is, cut off at display white: for measuring.",
            ),
        ];
        Choice {
            label: "Curve",
            options: &options,
            tip: "How light is brought into the range of a display.",
            default: default.curve,
            idle: None,
        }
        .show(ui, &mut view.curve);
        let auto = ui.button("Auto exposure").on_hover_text(
            "Measures brightness and white again, on the picture as it is now, and sets the exposure to 0.",
        );
        if auto.clicked() {
            commands.push(Command::AutoExposure);
        }
    });
}
