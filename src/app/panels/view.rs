//! How the light becomes a picture. Nothing here is rendered again.

use egui::Ui;

use super::{Command, Knob, headline};
use crate::project::{Project, ViewSettings};

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project, commands: &mut Vec<Command>) {
    headline(ui, "View");
    let default = ViewSettings::default();
    let view = &mut project.view;
    Knob {
        label: "Exposure",
        unit: " EV",
        range: [-10.0, 10.0],
        logarithmic: false,
        default: default.exposure_ev,
        tip: "How long the picture is exposed, in stops: one more doubles the light. Counted from the exposure \
              that was measured when the fire was first seen. The fire itself stays as it is.",
    }
    .show(ui, &mut view.exposure_ev);
    let auto = ui.button("Auto exposure").on_hover_text(
        "Measures brightness and white again, on the picture as it is now, and sets the exposure to 0.",
    );
    if auto.clicked() {
        view.exposure_ev = default.exposure_ev;
        commands.push(Command::Meter);
    }
    ui.add_space(5.0);
    Knob {
        label: "Adaptation",
        unit: "",
        range: [0.0, 1.0],
        logarithmic: false,
        default: default.adaptation,
        tip: "How far the eye has got used to the fire's own light. At 0 a flame is as deep orange as it would be \
              beside daylight; at 1 its hottest part looks white, as after minutes in a dark room.",
    }
    .show(ui, &mut view.adaptation);
}
