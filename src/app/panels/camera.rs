//! The lens, and the shape of the picture. The camera itself is moved on the canvas.

use egui::{Id, Key, Role, TextEdit, Ui, WidgetInfo};

use super::knob::{Choice, Knob, name, note};
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
        views(ui, document);
        note(
            ui,
            "Drag the picture to orbit, with Shift to pan; the wheel moves nearer; Home frames all of the fire.",
        );
    });
}

/// Views that were kept by a name, and a field to keep the present one.
fn views(ui: &mut Ui, document: &mut Document) {
    let Some(camera) = document.last_job().map(|job| job.camera) else {
        return;
    };
    let (mut go_to, mut forget) = (None, None);
    let kept = &document.project.camera.views;
    ui.horizontal_wrapped(|ui| {
        for (i, view) in kept.iter().enumerate() {
            let is_here = view.camera() == camera;
            let button = ui.selectable_label(is_here, &view.name);
            if button.on_hover_text("Look from there again.").clicked() {
                go_to = Some(view.camera());
            }
            let cross = ui.small_button("×").on_hover_text("Forget this view.");
            let label = format!("Forget view {}", view.name);
            cross.widget_info(|| WidgetInfo::labeled(Role::Button, true, label.as_str()));
            if cross.clicked() {
                forget = Some(i);
            }
        }
    });
    if let Some(camera) = go_to {
        document.move_camera(&camera);
    }
    if let Some(i) = forget {
        document.project.camera.views.remove(i);
    }
    let id = Id::unique("view to be kept");
    let mut typed = ui.data_mut(|data| data.get_temp::<String>(id).unwrap_or_default());
    let tip = "Keeps where the camera stands and what lens it has, by a name; a scene file holds it as well.";
    ui.horizontal(|ui| {
        let name = name(ui, "Keep view as", tip);
        let field = TextEdit::singleline(&mut typed)
            .hint_text("a name, then Enter")
            .desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(name.id).on_hover_text(tip);
        let enters = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if enters && !typed.trim().is_empty() {
            document.project.camera.keep_view(typed.trim(), &camera);
            typed.clear();
        }
    });
    ui.data_mut(|data| data.insert_temp(id, typed));
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
