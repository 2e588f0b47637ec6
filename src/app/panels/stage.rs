//! What stands around the fire: a backdrop, ground, spheres and logs.

mod picture;
mod shapes;

use egui::Ui;

use self::picture::PicturePath;
use super::knob::{Choice, Knob, name, note};
use super::{Known, section, unit};
use crate::project::{BackdropKind, Control, Project, StageDefaults, StageSettings, ranges};

/// What the section remembers between frames.
#[derive(Debug, Default)]
pub(super) struct StagePanel {
    picture: PicturePath,
}

impl StagePanel {
    /// Draws the section.
    pub(super) fn show(&mut self, ui: &mut Ui, project: &mut Project, known: Known<'_>) {
        section(ui, "Stage", true, |ui| {
            let Some(defaults) = known.job.map(|job| job.stage_defaults) else {
                return;
            };
            let stage = &mut project.stage;
            self.backdrop(ui, stage, &defaults);
            ground(ui, stage, &defaults);
            shapes::show(ui, stage, &defaults);
            let stands = stage.ground || !stage.spheres.is_empty() || !stage.logs.is_empty();
            if let Some(idle) = known.idle(Control::StageColour).filter(|_| stands) {
                note(ui, &idle);
            }
        });
    }

    fn backdrop(&mut self, ui: &mut Ui, stage: &mut StageSettings, defaults: &StageDefaults) {
        let options = BackdropKind::ALL.map(|kind| {
            let (words, tip) = match kind {
                BackdropKind::None => ("No backdrop", "Black."),
                BackdropKind::Checker => ("Checker", "Squares of white and a tenth of it."),
                BackdropKind::Gradient => ("Gradient", "From black below to white above."),
                BackdropKind::Picture => ("PNG picture", "A file, as high as the frame."),
            };
            (kind, words.to_owned(), tip)
        });
        Choice {
            label: "Backdrop",
            options: &options,
            tip: "A shining screen behind the fire that always faces the camera. It shows how hot gas bends light, and \
                  what soot and smoke hide. It lights nothing.",
            default: BackdropKind::None,
            idle: None,
        }
        .show(ui, &mut stage.backdrop);
        if stage.backdrop == BackdropKind::None {
            return;
        }
        if stage.backdrop == BackdropKind::Picture {
            self.picture.show(ui, &mut stage.backdrop_picture);
        }
        let automatic = defaults.backdrop_distance_m;
        Knob {
            label: "Distance",
            unit: unit::METRES,
            slider: [0.1 * automatic, 10.0 * automatic],
            range: ranges::STAGE_LENGTH_M,
            logarithmic: true,
            default: automatic,
            tip: "How far the backdrop is behind the point that the camera looks at. What is further away moves more when \
                  light is bent.",
            idle: None,
        }
        .show_optional(
            ui,
            &mut stage.backdrop_distance_m,
            "automatic: twice the fire's size",
        );
        if stage.backdrop == BackdropKind::Checker {
            let automatic = defaults.backdrop_square_m;
            Knob {
                label: "Square",
                unit: unit::METRES,
                slider: [0.1 * automatic, 10.0 * automatic],
                range: ranges::STAGE_LENGTH_M,
                logarithmic: true,
                default: automatic,
                tip: "Edge of a square of the checker.",
                idle: None,
            }
            .show_optional(
                ui,
                &mut stage.backdrop_square_m,
                "automatic: a dozen fill the frame's height",
            );
        }
        Knob {
            label: "Luminance",
            unit: unit::LUMINANCE,
            slider: [1.0, 1e6],
            range: ranges::BACKDROP_CD_M2,
            logarithmic: true,
            default: StageSettings::default().backdrop_luminance_cd_m2,
            tip: "How bright the backdrop's white is. A flame has 10000 cd/m² and more, a screen 300.",
            idle: None,
        }
        .show(ui, &mut stage.backdrop_luminance_cd_m2);
    }
}

fn ground(ui: &mut Ui, stage: &mut StageSettings, defaults: &StageDefaults) {
    ui.horizontal(|ui| {
        let tip = "A level plane that the fire's light falls on. Double-click the name: none.";
        if name(ui, "Ground", tip).double_clicked() {
            stage.ground = false;
        }
        ui.checkbox(&mut stage.ground, "a level ground")
            .on_hover_text(tip);
    });
    if !stage.ground {
        return;
    }
    let (lower, upper) = (defaults.ground_height_m, defaults.fire.size().max_element());
    Knob {
        label: "Ground height",
        unit: unit::METRES,
        slider: [lower - upper, lower + upper],
        range: ranges::STAGE_POSITION_M,
        logarithmic: false,
        default: lower,
        tip: "How high the ground is; z is up.",
        idle: None,
    }
    .show_optional(
        ui,
        &mut stage.ground_height_m,
        "automatic: the lower end of the fire",
    );
    let default = StageSettings::default().ground_colour;
    colour(ui, "Ground colour", &mut stage.ground_colour, default);
}

/// Steps in which a colour is kept: finer ones cannot be seen, and would fill the scene file with digits.
const COLOUR_STEPS: f64 = 1e4;

/// A colour to be chosen. A double click on the name sets the default.
fn colour(ui: &mut Ui, label: &str, value: &mut [f64; 3], default: [f64; 3]) {
    ui.horizontal(|ui| {
        let tip = "How much red, green and blue the surface sends back, evenly into all directions.\nDouble-click the \
                   name: back to the default.";
        let name = name(ui, label, tip);
        let mut rgb = value.map(|channel| channel as f32);
        let before = rgb;
        let edit = ui.color_edit_button_rgb(&mut rgb);
        edit.labelled_by(name.id).on_hover_text(tip);
        if rgb != before {
            *value = rgb.map(|it| (f64::from(it) * COLOUR_STEPS).round() / COLOUR_STEPS);
        }
        if name.double_clicked() {
            *value = default;
        }
    });
}
