//! The plan: which effects are computed, what each changes and costs, and a switch for those that a person can switch.

use egui::Ui;

use super::knob::{Choice, name, note};
use super::{Known, section, short};
use crate::project::Control;
use crate::render::costs::Cost;
use crate::render::plan::{Decision, Effect};
use crate::render::{Effects, Switch};

/// An effect: its name among the plan's decisions, its label, what it is, and its switch.
type Row<'a> = (Effect, &'static str, &'static str, &'a mut Switch);

/// Draws the section.
pub(super) fn show(ui: &mut Ui, effects: &mut Effects, known: Known<'_>) {
    section(ui, "Effects", true, |ui| {
        // Nobody switches soot: it is the fire.
        told(
            ui,
            Effect::Soot,
            "Soot",
            "Soot glows by its heat, and absorbs.",
            known,
        );
        for (effect, label, tip, switch) in rows(effects) {
            let idle = (effect == Effect::Dispersion && *switch == Switch::On)
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
            decided(ui, effect, known);
        }
        told(
            ui,
            Effect::Wavelengths,
            "Colours",
            "At how many wavelengths light is carried: where those of the quality are too few for the colours of this \
             fire, more are taken, unless their number is set by hand under Quality.",
            known,
        );
    });
}

/// What can be switched, in the order of the plan.
fn rows(effects: &mut Effects) -> [Row<'_>; 9] {
    [
        (
            Effect::Smoke,
            "Smoke",
            "Smoke beside the soot: cold, and mostly dark. Auto: where it can be seen. Off leaves it out of the picture \
             and out of memory.",
            &mut effects.smoke,
        ),
        (
            Effect::Lines,
            "Salt lines",
            "Lines of a salt's atoms, each of one colour. Auto: where they can be seen.",
            &mut effects.lines,
        ),
        (
            Effect::Bands,
            "Salt bands",
            "Bands of a salt's molecules: the green of copper, the red of strontium. Auto: where they can be seen.",
            &mut effects.bands,
        ),
        (
            Effect::Chemiluminescence,
            "Radicals",
            "The blue light of burning gas. Auto: where a flame field says what burns, and soot does not outshine \
             it. On: where the gas is hot, if there is no such field.",
            &mut effects.chemiluminescence,
        ),
        (
            Effect::Scattering,
            "Scattered light",
            "The fire's own light, scattered once towards the eye by soot and smoke: a glow in smoke that is cold \
             and would only darken. Auto: where it can be seen.",
            &mut effects.scattering,
        ),
        (
            Effect::ScatteringOrders,
            "Scattered again",
            "Light that is scattered more than once on its way to the eye, without noise: thick white smoke is bright by \
             it. Auto: where it can be seen.",
            &mut effects.scattering_orders,
        ),
        (
            Effect::Refraction,
            "Refraction",
            "Light bent by hot gas, which is thinner than the air: the fire itself and what is behind it shimmer. Auto: \
             where it can be seen.",
            &mut effects.refraction,
        ),
        (
            Effect::Dispersion,
            "Dispersion",
            "Blue is bent more than red, by a fiftieth. Auto: where a backdrop shows it.",
            &mut effects.dispersion,
        ),
        (
            Effect::FireLight,
            "Fire light",
            "The fire as a light for the stage, with its shadows. Auto: where it can be seen on ground, a sphere or a \
             log.",
            &mut effects.fire_light,
        ),
    ]
}

/// An effect without a switch.
fn told(ui: &mut Ui, effect: Effect, label: &str, tip: &str, known: Known<'_>) {
    if known.decisions.iter().any(|it| it.effect == effect) {
        name(ui, label, tip);
        decided(ui, effect, known);
    }
}

/// What was decided of an effect, and why.
fn decided(ui: &mut Ui, effect: Effect, known: Known<'_>) {
    let Some(decision) = known.decisions.iter().find(|it| it.effect == effect) else {
        return;
    };
    let cost = known.costs.iter().find(|it| it.effect == effect);
    let reason = if decision.switch == Switch::Off && effect != Effect::Wavelengths {
        "it was switched off"
    } else {
        &decision.reason
    };
    note(ui, &format!("{}\n{reason}", state(decision, cost)));
    let left_out = known.facts.orders_left_out;
    let left_out = left_out.filter(|share| *share >= LEAST_SHARE_TOLD);
    if let (Effect::ScatteringOrders, Some(share)) = (effect, left_out) {
        note(ui, &orders_left_out(share));
    }
}

/// State, change and cost in one line.
fn state(decision: &Decision, cost: Option<&Cost>) -> String {
    // That fewer wavelengths are taken than there are leaves nothing out.
    let mut words = if decision.effect == Effect::Wavelengths && !decision.on {
        vec!["as many as the quality says".to_owned()]
    } else {
        vec![decision.state().to_owned()]
    };
    if let Some(change) = decision.change() {
        words.push(if decision.on {
            format!("changes {change}")
        } else {
            change
        });
    }
    if let Some(cost) = cost {
        let verb = if decision.on { "costs" } else { "saves" };
        words.push(format!("{verb} {}", cost.in_words()));
    }
    words.join(" · ")
}

/// Least share of the fire's light that is worth a line.
const LEAST_SHARE_TOLD: f64 = 1e-4;

/// What of the scattered light is left out, in words.
fn orders_left_out(share: f64) -> String {
    format!(
        "light scattered more than once is left out: about {} % of the fire's",
        short(100.0 * share)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_state_change_and_cost() {
        let decision = |on, bound| Decision {
            effect: Effect::Scattering,
            switch: Switch::Auto,
            on,
            bound,
            reason: String::new(),
        };
        let cost = |seconds, at_least| Cost {
            effect: Effect::Scattering,
            seconds,
            at_least,
        };
        let line = |on, bound, cost: Option<Cost>| state(&decision(on, bound), cost.as_ref());
        assert_eq!(
            line(true, Some(12.3), Some(cost(0.8, false))),
            "computed · changes at most 12 ΔE · costs 0.80 s"
        );
        assert_eq!(
            line(false, Some(0.0402), Some(cost(1.2, true))),
            "left out · at most 0.040 ΔE · saves more than 1.2 s"
        );
        assert_eq!(
            line(false, Some(0.001), Some(cost(0.0, false))),
            "left out · under 0.01 ΔE · saves less than 0.01 s"
        );
        assert_eq!(line(true, None, None), "computed");
        assert_eq!(line(false, Some(0.0), None), "left out");
    }
}
