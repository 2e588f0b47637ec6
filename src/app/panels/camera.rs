//! The lens, and the shape of the picture. The camera itself is moved on the canvas.

use egui::Ui;

use super::knob::{Choice, Knob, note};
use super::{section, unit};
use crate::app::Document;
use crate::project::ranges;
use crate::scene::camera::{FRAMING_FOV_DEG, focal_length_mm, fov_deg};

/// Focal lengths of the slider, mm: from a very wide lens to a long one.
const FOCAL_LENGTHS_MM: [f64; 2] = [8.0, 400.0];
/// Shapes that are offered, pixels.
const SIZES: [[u32; 2]; 6] = [
    [1280, 720],
    [1920, 1080],
    [3840, 2160],
    [1080, 1080],
    [1080, 1350],
    [1080, 1920],
];

/// Draws the section.
pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    section(ui, "Camera", true, |ui| {
        lens(ui, document);
        let mut sizes = SIZES.to_vec();
        let own = document.project.render.size;
        if !sizes.contains(&own) {
            sizes.insert(0, own);
        }
        let filling = (None, "fills the window".to_owned(), "");
        let fixed = sizes
            .into_iter()
            .map(|size| (Some(size), format!("{} × {}", size[0], size[1]), ""));
        let options: Vec<_> = std::iter::once(filling).chain(fixed).collect();
        Choice {
            label: "Picture",
            options: &options,
            tip: "The shape of the picture: as large as the window lets it, or as many pixels as a still will have.",
            default: None,
            idle: None,
        }
        .show(ui, &mut document.fixed_size);
        note(
            ui,
            "Drag the picture to orbit, with Shift to pan; the wheel moves nearer; Home frames all of the fire.",
        );
    });
}

fn lens(ui: &mut Ui, document: &mut Document) {
    let (project, job) = document.parts();
    let fov = project.camera.fov_deg.unwrap_or(FRAMING_FOV_DEG);
    let mut focal = focal_length_mm(fov);
    let default = focal_length_mm(FRAMING_FOV_DEG);
    let [narrowest, widest] = ranges::FOV_DEG;
    let changed = Knob {
        label: "Focal length",
        unit: unit::FOCAL_LENGTH,
        slider: FOCAL_LENGTHS_MM,
        range: [focal_length_mm(widest), focal_length_mm(narrowest)],
        logarithmic: true,
        default,
        tip: "Of the lens, on a frame of 36 × 24 mm. A longer one sees a smaller part, larger; the camera stays where \
              it is.",
        idle: None,
    }
    .show(ui, &mut focal);
    if changed {
        // Another lens does not move the camera, so it stands by itself from here on.
        if let Some(job) = job {
            project.camera.eye.get_or_insert(job.camera.eye);
            project.camera.target.get_or_insert(job.camera.target);
        }
        let wanted = fov_deg(focal).clamp(narrowest, widest);
        project.camera.fov_deg = (focal != default).then_some(wanted);
    }
    note(
        ui,
        &format!("sees {:.1}° from top to bottom", fov_deg(focal)),
    );
    let mut roll = project.camera.roll_deg.unwrap_or(0.0);
    let changed = Knob {
        label: "Roll",
        unit: unit::DEGREES,
        slider: ranges::ROLL_DEG,
        range: ranges::ROLL_DEG,
        logarithmic: false,
        default: 0.0,
        tip: "Turns the camera about its line of sight, clockwise as it looks: the fire leans the other way.",
        idle: None,
    }
    .show(ui, &mut roll);
    if changed {
        project.camera.roll_deg = (roll != 0.0).then_some(roll);
    }
}
