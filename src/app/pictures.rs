//! Pictures: jobs go to the engine, and what it renders comes back. The only place that submits.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{App, Document, maps};
use crate::engine::Progress;
use crate::engine::{Generation, Picture};
use crate::project::Job;
use crate::render::plan::Effect;
use crate::render::{Effects, Facts, Region};
use crate::study::Numbers;

/// So long a changed job waits for the first picture of the one before it.
const LONGEST_WAIT: Duration = Duration::from_millis(250);

/// The job that the engine works on.
pub(super) struct Submitted {
    pub(super) job: Job,
    /// The part that is sharpened; `None` for all of it.
    region: Option<Region>,
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

    /// Whether a picture is on its way.
    pub(super) fn is_working(&self) -> bool {
        let progress = &self.picture.progress;
        let has_ended = progress.finished || progress.failure.is_some();
        self.submitted.is_some() && !(self.renders_newest() && has_ended)
    }

    /// Whether the picture is of the open volume and of the job submitted last, however coarse.
    pub(super) fn shows_newest(&self) -> bool {
        let of_the_open_volume = match (self.document.volume(), &self.submitted) {
            (Some(open), Some(submitted)) => Arc::ptr_eq(open, &submitted.job.volume),
            _ => false,
        };
        of_the_open_volume && self.renders_newest() && self.picture.progress.done > 0
    }

    /// Whether the picture has a ray for each pixel, at least, and is of all that is set.
    pub(super) fn shows_a_fine_picture(&self) -> bool {
        let Some(submitted) = &self.submitted else {
            return false;
        };
        let progress = &self.picture.progress;
        let is_newest = self.document.last_job() == Some(&submitted.job) && self.shows_newest();
        let mut whole = progress.passes.iter().take(progress.done);
        is_newest && progress.failure.is_none() && whole.any(|pass| pass.stride == 1)
    }

    /// Keeps how what is open looks, for the list of what was opened before: when its picture is new, or `again`.
    pub(super) fn picture_what_is_open(&mut self, again: bool) {
        let generation = self.picture.generation();
        let is_new = again || self.pictured != generation;
        if !is_new || !self.shows_a_fine_picture() || self.region.is_set() {
            return;
        }
        self.pictured = generation;
        let scene = self.scene_file.path().map(Path::to_owned);
        let volume = || Some(self.document.volume()?.sources.clone());
        let files = scene.map(|path| vec![path]).or_else(volume);
        let entry = files.and_then(|files| self.recent.entry(&files).map(<[_]>::to_vec));
        if let Some(entry) = entry {
            let view = self.view();
            self.thumbnails.keep(&entry, self.picture.film(), &view);
        }
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

    /// Has the scene on show looked at, once there is a fine picture of it.
    pub(super) fn look(&mut self) {
        let Some(submitted) = &self.submitted else {
            return;
        };
        // Whoever lets the picture pause wants the machine for something else.
        if self.engine.pauses() {
            return;
        }
        let is_fine = self.shows_a_fine_picture();
        let packed = if is_fine { self.engine.scene() } else { None };
        self.accuracy.follow(&submitted.job, packed, is_fine);
    }

    /// The map on show as a picture of its own, with what it is of taken in.
    pub(super) fn map(&mut self, ctx: &egui::Context) -> Option<egui::TextureId> {
        let submitted = self.submitted.as_ref()?;
        let is_of_it = self.document.last_job() == Some(&submitted.job) && self.shows_newest();
        let about = maps::About {
            picture: &self.picture,
            job: is_of_it.then_some(&submitted.job),
            pilot: self.accuracy.pilot(&submitted.job),
            sees_nothing: self.accuracy.sees_nothing(&submitted.job),
            packed: self.engine.scene().filter(|_| is_of_it),
        };
        self.maps.follow(&about);
        self.maps.texture(ctx, &about)
    }

    /// Says what was measured of the picture on show in place of what is expected of it.
    pub(super) fn tell_measured(&mut self) {
        let shows_newest = self.shows_newest() && self.picture.progress.finished;
        if let (Some(told), Some(submitted)) = (&mut self.told, &self.submitted) {
            let measured = self.maps.measured(&submitted.job, &self.picture);
            told.measured = measured.filter(|_| shows_newest);
        }
    }

    /// The document's job for a canvas, with the numbers that its quality comes to if the scene was looked at.
    fn job_to_render(&mut self, canvas: [u32; 2]) -> Option<Job> {
        let job = self.document.job(canvas)?.clone();
        let Some(numbers) = self.accuracy.chosen(&job) else {
            return Some(job);
        };
        self.document.choose(job.accuracy, numbers);
        self.document.job(canvas).cloned()
    }

    /// Submits the document's job if it is another than the one submitted last.
    pub(super) fn follow(&mut self) {
        let Some(size) = self.canvas_size else { return };
        let Some(job) = self.job_to_render(size) else {
            return;
        };
        let region = self.region.pixels(job.settings.size);
        match &mut self.submitted {
            // The same picture may be meant by other numbers, such as a humidity that nothing shows.
            Some(submitted) if submitted.job == job && submitted.region == region => {
                submitted.job = job;
            }
            // A slider that moves faster than pictures come would starve them all.
            Some(submitted) if submitted.is_worth_waiting_for(&job, &self.picture) => {}
            submitted => {
                let chosen = self.document.is_chosen();
                let is_the_same_view = submitted
                    .as_ref()
                    .is_some_and(|it| it.job == job || chosen && is_the_same_view(&it.job, &job));
                let generation = if is_the_same_view {
                    let tried = self.accuracy.tried(&job);
                    self.engine.refine(job.clone(), region, tried)
                } else {
                    self.engine.submit_within(job.clone(), region)
                };
                self.submitted = Some(Submitted {
                    job,
                    region,
                    generation,
                    at: Instant::now(),
                    begun: None,
                });
            }
        }
    }
}

/// Whether two jobs differ by numbers that nobody set by hand.
fn is_the_same_view(one: &Job, other: &Job) -> bool {
    let mut same = one.clone();
    let numbers =
        Numbers::of(&other.settings).where_free(other.accuracy, Numbers::of(&one.settings));
    same.settings = numbers.within(&one.settings);
    // Whether wavelengths may be more follows from whether their number was set.
    same.settings.effects.wavelengths = other.settings.effects.wavelengths;
    same == *other
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
