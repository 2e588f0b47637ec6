//! A still: every pass of a picture, on one film.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::plan::Decision;
use super::{Cancel, Facts, Film, Flaws, Plan, Settings, pass, render_pass};
use crate::scene::Scene;

/// A still: the film of every pass, with counts.
#[derive(Debug, Clone)]
pub struct Frame {
    /// The accumulated picture.
    pub film: Film,
    /// Rays marched.
    pub rays: u64,
    /// Samples of the medium taken.
    pub samples: u64,
    /// Which effects were computed, and why.
    pub decisions: Vec<Decision>,
    /// What was found out on the way.
    pub facts: Facts,
    /// What the settings could not show faithfully.
    pub flaws: Flaws,
    /// Whether every pass is whole.
    pub finished: bool,
}

/// Renders every sample of a still in the calling thread's rayon pool, without coarse passes.
///
/// `progress` hears the finished share, 0 to 1, after each tile, from any thread. `None` if cancelled.
pub fn render_still(
    scene: &Scene,
    settings: &Settings,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
) -> Option<Frame> {
    let plan = Plan::new(scene, settings);
    render_planned(scene, &plan, settings, cancel, progress)
}

/// [`render_still`] after a plan of the same scene and settings, which whoever made it may go on using.
pub fn render_planned(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
) -> Option<Frame> {
    let passes = pass::ladder(settings, pass::Audience::Still);
    let frame = render_passes(scene, plan, settings, &passes, [cancel; 2], progress);
    (!cancel.is_cancelled() && frame.finished).then_some(frame)
}

/// The same, which ends at a moment if it has not ended by itself, with what there is by then and a flaw that says so. Coarse
/// passes go before, and the first of them is finished however soon that moment is: the picture is whole.
pub fn render_until(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    end: Instant,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
) -> Option<Frame> {
    let passes = pass::ladder(settings, pass::Audience::Window);
    let in_time = cancel.or_at(end);
    let cancels = [cancel, &in_time];
    let mut frame = render_passes(scene, plan, settings, &passes, cancels, progress);
    if cancel.is_cancelled() {
        return None;
    }
    if !frame.finished {
        frame
            .flaws
            .add("unfinished: the time was up. Give more, or wish it less exact");
    }
    Some(frame)
}

/// Renders the passes until one is cancelled: the first by its own cancel.
fn render_passes(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    passes: &[pass::Pass],
    [first, later]: [&Cancel; 2],
    progress: &(dyn Fn(f64) + Sync),
) -> Frame {
    let film = Mutex::new(Film::new(settings.size));
    let counts = [AtomicU64::new(0), AtomicU64::new(0)];
    let all: u64 = passes.iter().map(|pass| pass.rays(settings.size)).sum();
    let finished = passes.iter().enumerate().all(|(i, pass)| {
        let cancel = if i == 0 { first } else { later };
        render_pass(scene, plan, pass, cancel, &|tile| {
            counts[1].fetch_add(tile.samples(), Ordering::Relaxed);
            film.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .merge(&tile);
            let rays = counts[0].fetch_add(tile.pixels.len() as u64, Ordering::Relaxed);
            progress((rays + tile.pixels.len() as u64) as f64 / all as f64);
        })
    });
    let [rays, samples] = counts.map(AtomicU64::into_inner);
    Frame {
        film: film.into_inner().unwrap_or_else(PoisonError::into_inner),
        rays,
        samples,
        decisions: plan.decisions.clone(),
        facts: plan.facts(),
        flaws: plan.flaws.clone(),
        finished,
    }
}
