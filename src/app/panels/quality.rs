//! How exactly the fire is computed, and what that costs.

use egui::Ui;

use super::{Knob, headline};
use crate::project::Project;

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project) {
    headline(ui, "Quality");
    let (default, ..) = project.render.quality.numbers();
    let mut step = project.render.step_voxels.unwrap_or(default);
    let changed = Knob {
        label: "Step size",
        unit: " voxels",
        range: [0.25, 8.0],
        logarithmic: true,
        default,
        tip: "How far apart the fire is sampled along a line of sight. Longer steps are faster in proportion, but \
              step over thin sheets of flame: they become blurred and too dim or too bright.",
    }
    .show(ui, &mut step);
    if changed {
        project.render.step_voxels = (step != default).then_some(step);
    }
}
