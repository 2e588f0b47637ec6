//! Spheres and logs: each a row or two of numbers.

use egui::{DragValue, Ui};

use super::colour;
use crate::app::panels::knob::name;
use crate::app::panels::unit::METRES;
use crate::project::ranges::{MOST_SHAPES, STAGE_LENGTH_M, STAGE_POSITION_M};
use crate::project::{StageDefaults, StageSettings};

/// How far a dragged number moves for each point, as a share of the fire's size.
const DRAG_SHARE: f64 = 0.005;

/// Draws what there is, and the buttons for more.
pub(super) fn show(ui: &mut Ui, stage: &mut StageSettings, defaults: &StageDefaults) {
    ui.horizontal_wrapped(|ui| {
        let more = |ui: &mut Ui, label: &str, count: usize, tip: &str| {
            let button = ui.add_enabled(count < MOST_SHAPES, egui::Button::new(label));
            button.on_hover_text(tip).clicked()
        };
        let tip = "Adds a sphere beside the fire, on the ground.";
        if more(ui, "Add a sphere", stage.spheres.len(), tip) {
            stage.spheres.push(defaults.sphere());
        }
        let tip = "Adds a log under the fire.";
        if more(ui, "Add a log", stage.logs.len(), tip) {
            stage.logs.push(defaults.logs()[stage.logs.len() % 2]);
        }
        let tip = "Sets a ground, two crossed logs and a sphere, as large as suits the fire, in place of those that \
                   stand here.";
        if ui.button("Logs and a sphere").on_hover_text(tip).clicked() {
            stage.set_logs_and_a_sphere(defaults);
        }
    });
    let speed = DRAG_SHARE * defaults.fire.size().max_element();
    let gone = rows(ui, &mut stage.spheres, speed, &SPHERE);
    if let Some(gone) = gone {
        stage.spheres.remove(gone);
    }
    let default = StageSettings::default();
    if !stage.spheres.is_empty() {
        colour(
            ui,
            "Sphere colour",
            &mut stage.sphere_colour,
            default.sphere_colour,
        );
    }
    let gone = rows(ui, &mut stage.logs, speed, &LOG);
    if let Some(gone) = gone {
        stage.logs.remove(gone);
    }
    if !stage.logs.is_empty() {
        colour(ui, "Log colour", &mut stage.log_colour, default.log_colour);
    }
}

/// How a kind of shape is written: its name, and the letters and meanings of its numbers.
struct Kind<const N: usize> {
    name: &'static str,
    letters: [(&'static str, &'static str); N],
}

const SPHERE: Kind<4> = Kind {
    name: "Sphere",
    letters: [("x", "x"), ("y", "y"), ("z", "z"), ("r", "radius")],
};
const LOG: Kind<7> = Kind {
    name: "Log",
    letters: [
        ("x", "from x"),
        ("y", "from y"),
        ("z", "from z"),
        ("x", "to x"),
        ("y", "to y"),
        ("z", "to z"),
        ("r", "radius"),
    ],
};

/// Draws the shapes of a kind. `Some`: one is to be taken away.
fn rows<const N: usize>(
    ui: &mut Ui,
    shapes: &mut [[f64; N]],
    speed: f64,
    kind: &Kind<N>,
) -> Option<usize> {
    let mut gone = None;
    for (index, shape) in shapes.iter_mut().enumerate() {
        let title = format!("{} {}", kind.name, index + 1);
        ui.push_id(&title, |ui| {
            ui.horizontal(|ui| {
                name(
                    ui,
                    &title,
                    "Where it is, in metres; z is up. Drag, or click and type.",
                );
                let take_away = format!("Take {} away", title.to_lowercase());
                let button = ui.button("Remove").on_hover_text(&take_away);
                ui.ctx()
                    .accesskit_node_builder(button.id, |node| node.set_label(take_away));
                if button.clicked() {
                    gone = Some(index);
                }
            });
            ui.horizontal_wrapped(|ui| {
                for (value, (letter, meaning)) in shape.iter_mut().zip(kind.letters) {
                    length(ui, value, speed, letter, &format!("{title} {meaning}"));
                }
            });
        });
    }
    gone
}

/// One number of a shape.
fn length(ui: &mut Ui, value: &mut f64, speed: f64, letter: &str, label: &str) {
    let [low, high] = if letter == "r" {
        STAGE_LENGTH_M
    } else {
        STAGE_POSITION_M
    };
    let old = *value;
    let field = DragValue::new(value)
        .range(low..=high)
        .clamp_existing_to_range(false)
        .update_while_editing(false)
        .speed(speed)
        .max_decimals(12)
        .prefix(format!("{letter} "))
        .suffix(" m")
        .custom_formatter(|value, _| METRES.number(value))
        // A field that was only looked into has the value that it had, not the few digits that it shows.
        .custom_parser(move |typed| {
            let untouched = typed.trim() == METRES.number(old);
            if untouched {
                Some(old)
            } else {
                METRES.parse(typed)
            }
        });
    let field = ui.add(field);
    let words = label.to_owned();
    ui.ctx()
        .accesskit_node_builder(field.id, |node| node.set_label(words));
    field.on_hover_text(format!("{label}: type a length ({})", METRES.example));
}
