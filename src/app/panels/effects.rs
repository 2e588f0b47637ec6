//! Which effects are computed, and what was decided where that is automatic.

use egui::Ui;

use super::knob::{Choice, note};
use super::{Known, section, short};
use crate::project::{Control, EffectSettings};
use crate::render::Switch;

/// An effect: its name among the plan's decisions, its label, what it is, and its switch.
type Row<'a> = (&'static str, &'static str, &'static str, &'a mut Switch);

/// Draws the section.
pub(super) fn show(ui: &mut Ui, effects: &mut EffectSettings, known: Known<'_>) {
    section(ui, "Effects", true, |ui| {
        let rows: [Row<'_>; 6] = [
            (
                "scattering",
                "Scattered light",
                "The fire's own light, scattered once towards the eye by soot and smoke: a glow in smoke that is cold \
                 and would only darken. Auto: where it can be seen.",
                &mut effects.scattering,
            ),
            (
                "refraction",
                "Refraction",
                "Light bent by hot gas, which is thinner than the air: what is behind the fire shimmers. Auto: where a \
                 backdrop or a stage shows it.",
                &mut effects.refraction,
            ),
            (
                "dispersion",
                "Dispersion",
                "Blue is bent more than red, by a fiftieth. Auto: never.",
                &mut effects.dispersion,
            ),
            (
                "fire_light",
                "Fire light",
                "The fire as a light for the stage, with its shadows. Auto: where there is ground, a sphere or a log.",
                &mut effects.fire_light,
            ),
            (
                "lines",
                "Salt lines",
                "Lines and bands of a salt's metal. Auto: where there is a salt.",
                &mut effects.lines,
            ),
            (
                "chemiluminescence",
                "Radicals",
                "The blue light of burning gas. Auto: where a flame field says what burns, and soot does not outshine \
                 it. On: where the gas is hot, if there is no such field.",
                &mut effects.chemiluminescence,
            ),
        ];
        for (effect, label, tip, switch) in rows {
            let idle = (effect == "dispersion" && *switch == Switch::On)
                .then(|| known.idle(Control::Dispersion))
                .flatten();
            let options = [
                (Switch::Auto, "Auto"),
                (Switch::On, "On"),
                (Switch::Off, "Off"),
            ]
            .map(|(switch, words)| (switch, words.to_owned(), ""));
            Choice {
                label,
                options: &options,
                tip,
                default: Switch::Auto,
                idle,
            }
            .show(ui, switch);
            let decided = known.decisions.iter().find(|it| it.effect == effect);
            if let Some(decision) = decided {
                let state = if decision.on { "computed" } else { "left out" };
                note(ui, &format!("{state}: {}", decision.reason));
                if let ("scattering", Some(share)) = (effect, known.facts.orders_left_out) {
                    note(ui, &orders_left_out(share));
                }
            }
        }
    });
}

/// What of the scattered light is left out, in words.
fn orders_left_out(share: f64) -> String {
    format!(
        "light scattered more than once is left out: about {} % of the fire's",
        short(100.0 * share)
    )
}
