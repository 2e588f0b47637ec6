//! Which effects a picture would be computed with, as a table: the list that the window shows.

use std::time::Duration;

use super::table::Table;
use crate::project::Job;
use crate::render::costs::{Cost, costs};
use crate::render::plan::Decision;
use crate::render::{Cancel, Plan, Switch};

/// So long costs are measured at most, beside the picture's own fields.
const MEASURING: Duration = Duration::from_secs(4);

/// The plan of a job's picture in words, its costs measured on all cores.
pub(super) fn told(job: &Job) -> String {
    let (scene, settings) = (job.scene(None), &job.settings);
    let plan = Plan::new(&scene, settings);
    let costs = costs(&scene, settings, &plan, MEASURING, &Cancel::never()).unwrap_or_default();
    let mut table = Table::new(&["effect", "switch", "state", "changes", "seconds", "why"]);
    for decision in &plan.decisions {
        let cost = costs.iter().find(|it| it.effect == decision.effect);
        table.row([
            decision.effect.name().to_owned(),
            switch(decision).to_owned(),
            decision.state().to_owned(),
            decision.change().unwrap_or_else(|| "-".to_owned()),
            cost.map_or_else(|| "-".to_owned(), |cost| seconds(decision, cost)),
            decision.reason.clone(),
        ]);
    }
    let [width, height] = settings.size;
    format!("\nwhat a picture of {width} × {height} pixels is computed with\n{table}")
}

fn switch(decision: &Decision) -> &'static str {
    match decision.switch {
        Switch::Auto => "auto",
        Switch::On => "on",
        Switch::Off => "off",
    }
}

fn seconds(decision: &Decision, cost: &Cost) -> String {
    let verb = if decision.on { "costs" } else { "saves" };
    format!("{verb} {}", cost.in_words())
}
