//! From how exact a picture is wished to the numbers that it is rendered with.

use std::time::Instant;

use super::numbers::Numbers;
use super::pilot::Pilot;
use crate::project::Accuracy;
use crate::render::{Cancel, Plan, Settings};
use crate::scene::Scene;

/// What a picture is rendered with.
#[derive(Debug)]
pub struct Aim {
    /// The settings with the numbers chosen.
    pub settings: Settings,
    /// What is computed with them.
    pub plan: Plan,
    /// What is known of errors and seconds; `None` where there was nothing to choose, or nothing to be seen.
    pub pilot: Option<Pilot>,
}

/// Share of the time that is left for which a march is chosen: what it takes is known within a quarter.
const CAUTION: f64 = 0.75;

/// Share of the time in which the scene may be looked at: if that is too little, the numbers stay as they are.
const SHARE_TO_LOOK: f64 = 0.4;

/// Chooses the numbers that are as accurate as wished, in the calling thread's rayon pool, beginning from the settings and
/// plan of a scene that nobody has looked at. `end`: when the picture is to be done at the latest, if that matters; only then
/// the choice depends on the machine.
pub fn aim(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    wished: Accuracy,
    end: Option<Instant>,
    cancel: &Cancel,
) -> Aim {
    let now = Instant::now();
    let to_look = end.map(|end| end.saturating_duration_since(now).mul_f64(SHARE_TO_LOOK));
    let in_time = to_look.map_or_else(|| cancel.clone(), |time| cancel.or_after(time));
    let looked = wished
        .is_open()
        .then(|| Pilot::new(scene, &plan, settings, wished, &in_time));
    let Some((pilot, tried)) = looked.flatten() else {
        return Aim {
            settings: *settings,
            plan,
            pilot: None,
        };
    };
    let given = Numbers::of(settings);
    let numbers = match end {
        Some(end) => {
            let left = end.saturating_duration_since(Instant::now());
            pilot.choose_within(wished, given, CAUTION * left.as_secs_f64())
        }
        None => pilot.choose(wished, given),
    };
    let settings = numbers.within(settings);
    // What is at the border stays as it was decided.
    let chosen = Plan::after(scene, &settings, &plan.decisions);
    let mut chosen = chosen.told_by(plan.preparation());
    for other in [Some(&plan), tried.as_ref()].into_iter().flatten() {
        chosen.take_over(other);
    }
    Aim {
        settings,
        plan: chosen,
        pilot: Some(pilot),
    }
}
