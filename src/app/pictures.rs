//! Pictures: jobs go to the engine, and what it renders comes back. The only place that submits.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{App, Document};
use crate::engine::picture::Progress;
use crate::engine::{Generation, Picture};
use crate::project::Job;
use crate::render::plan::Effect;
use crate::render::{Effects, Facts};

/// So long a changed job waits for the first picture of the one before it.
const LONGEST_WAIT: Duration = Duration::from_millis(250);

/// The job that the engine works on.
pub(super) struct Submitted {
    pub(super) job: Job,
    pub(super) generation: Generation,
    /// When.
    pub(super) at: Instant,
    /// When its first news came: the medium is packed then.
    begun: Option<Instant>,
}

impl Submitted {
    /// Whether the first picture of this job is about to come, so that another of the same volume waits for it. While
    /// the medium is packed nothing could begin anyway; after that the wait is bounded.
    fn is_worth_waiting_for(&self, next: &Job, picture: &Picture) -> bool {
        let progress = &picture.progress;
        let is_newest = picture.generation() == Some(self.generation);
        let came = is_newest && (progress.done > 0 || progress.failure.is_some());
        let long = self
            .begun
            .is_some_and(|begun| begun.elapsed() > LONGEST_WAIT);
        Arc::ptr_eq(&self.job.volume, &next.volume) && !came && !long
    }
}

impl App {
    /// Whether the engine's news are about the job submitted last.
    pub(super) fn renders_newest(&self) -> bool {
        self.generation().is_some() && self.picture.generation() == self.generation()
    }

    /// Whether the picture is of the open volume and of the job submitted last, however coarse.
    pub(super) fn shows_newest(&self) -> bool {
        let of_the_open_volume = match (self.document.volume(), &self.submitted) {
            (Some(open), Some(submitted)) => Arc::ptr_eq(open, &submitted.job.volume),
            _ => false,
        };
        of_the_open_volume && self.renders_newest() && self.picture.progress.done > 0
    }

    /// Which effects are on show, each on or off, if that is known of the document as it stands.
    pub(super) fn effects_on_show(&self) -> Option<Effects> {
        let submitted = self.submitted.as_ref()?;
        let decisions = &self.picture.progress.decisions;
        let is_of_it = self.document.last_job() == Some(&submitted.job) && self.renders_newest();
        (is_of_it && !decisions.is_empty())
            .then(|| submitted.job.settings.effects.as_decided(decisions))
    }

    /// Takes in what the engine rendered.
    pub(super) fn drain(&mut self) {
        for update in self.engine.drain() {
            self.picture.take(update);
        }
        learn(&mut self.document, &self.picture.progress);
        if self.renders_newest()
            && let Some(submitted) = &mut self.submitted
        {
            submitted.begun.get_or_insert_with(Instant::now);
        }
        let Some(submitted) = &self.submitted else {
            return;
        };
        if !self.shows_newest() {
            return;
        }
        let flame = &submitted.job.flame;
        // A picture from before the change says nothing of what is to be exposed anew.
        if self.expose_anew && self.document.last_job() == Some(&submitted.job) {
            self.expose_anew = false;
            let metering = self.meter.follow(&self.picture, flame, None);
            // Undo brings back what was measured before the change.
            self.document.metering = metering.or(self.document.metering);
        } else if let Some(metering) =
            self.meter
                .follow(&self.picture, flame, self.document.metering)
        {
            self.document.measured(metering);
        }
    }

    /// Submits the document's job if it is another than the one submitted last.
    pub(super) fn follow(&mut self) {
        let Some(size) = self.canvas_size else { return };
        let Some(job) = self.document.job(size) else {
            return;
        };
        match &mut self.submitted {
            // The same picture may be meant by other numbers, such as a humidity that nothing shows.
            Some(submitted) if submitted.job == *job => submitted.job = job.clone(),
            // A slider that moves faster than pictures come would starve them all.
            Some(submitted) if submitted.is_worth_waiting_for(job, &self.picture) => {}
            _ => {
                let generation = self.engine.submit(job.clone());
                self.submitted = Some(Submitted {
                    job: job.clone(),
                    generation,
                    at: Instant::now(),
                    begun: None,
                });
            }
        }
    }
}

/// Takes over what the newest picture's plan decided, and what was found out on the way. What is not known yet of a
/// picture that has just begun stays as it was, so that words do not flicker while a hand drags.
fn learn(document: &mut Document, progress: &Progress) {
    if !progress.decisions.is_empty() && progress.decisions != document.decisions {
        document.decisions.clone_from(&progress.decisions);
    }
    // What another picture took says nothing of this one.
    match &progress.costs {
        Some(costs) if *costs != document.costs => document.costs.clone_from(costs),
        Some(_) => {}
        None => document.costs.clear(),
    }
    let is_on = |effect: Effect| {
        let decided = document.decisions.iter().find(|it| it.effect == effect);
        decided.is_some_and(|decision| decision.on)
    };
    let newer =
        |found: Option<f64>, known: Option<f64>, effect| found.or(known).filter(|_| is_on(effect));
    let (found, known) = (progress.facts, document.facts);
    document.facts = Facts {
        largest_shift_px: newer(
            found.largest_shift_px,
            known.largest_shift_px,
            Effect::Refraction,
        ),
        orders_left_out: newer(
            found.orders_left_out,
            known.orders_left_out,
            Effect::Scattering,
        ),
    };
}
