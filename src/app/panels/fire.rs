//! What burns and what it is made of.

use egui::Ui;

use super::{Knob, headline};
use crate::physics::soot::{
    Hold, LARGEST_AGGREGATE_RADIUS_NM, REFERENCE_RADIUS_NM, SMALLEST_RADIUS_NM,
};
use crate::project::Project;

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project) {
    headline(ui, "Fire");
    Knob {
        label: "Soot radius",
        unit: " nm",
        range: [SMALLEST_RADIUS_NM, LARGEST_AGGREGATE_RADIUS_NM],
        logarithmic: false,
        default: REFERENCE_RADIUS_NM,
        tip: "Radius of the soot's particles. Larger ones scatter more light. What the fire looks like depends on \
              what stays the same meanwhile: the volume of soot (it glows as before), or the number of particles \
              (there is more soot, with the cube of the radius: brighter, denser, less transparent).",
    }
    .show(ui, &mut project.soot.radius_nm);
    ui.horizontal(|ui| {
        ui.label("Keep the soot's");
        let hold = &mut project.soot.hold;
        ui.selectable_value(hold, Hold::Volume, "volume")
            .on_hover_text("The volume of soot stays: fewer, larger particles.");
        ui.selectable_value(hold, Hold::Number, "number")
            .on_hover_text(
                "The number of particles stays: each grows, and so does the amount of soot.",
            );
    });
    ui.add_space(5.0);
    Knob {
        label: "Soot amount",
        unit: " ×",
        range: [0.01, 100.0],
        logarithmic: true,
        default: 1.0,
        tip: "Multiplies the soot of the file. More soot glows more and hides more of what is behind it: a thick \
              fire shines like a solid of its own temperature, a thin one is transparent.",
    }
    .show(ui, &mut project.soot.amount);
}
