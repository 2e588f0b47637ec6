//! What accuracy costs in the scene on show: looked at in the background once a fine picture of it is there.
//!
//! A look tells which numbers are good enough for the quality that is wished; the document takes them. While the chart is open
//! every variant is measured as well, one after another.

use std::sync::Arc;

use super::background::{Ended, Rank, Running, Wake};
use crate::engine::Packed;
use crate::project::{self, Job};
use crate::render::Plan;
use crate::study::{self, Choice, Error, Numbers, Pilot, Point};

/// Share of an error that the next better choice has at most.
const NEXT: f64 = 0.5;

/// What is known of the scene on show.
pub(super) struct Accuracy {
    /// Whether numbers are chosen at all.
    chooses: bool,
    known: Option<Known>,
    looking: Option<Looking>,
    measured: Option<Measured>,
    measuring: Option<Running<(Point, usize)>>,
    wake: Wake,
}

/// A scene that is being looked at.
struct Looking {
    view: Job,
    wished: Wished,
    running: Running<Option<Looked>>,
}

/// A scene that was looked at.
struct Known {
    view: Job,
    /// What it was looked at for.
    wished: Wished,
    /// `None` where nothing is to be seen.
    looked: Option<Looked>,
}

/// What a look has found.
struct Looked {
    pilot: Arc<Pilot>,
    /// What it was tried with, if that was another plan than the picture's: its fields may serve the next picture.
    tried: Option<Arc<Plan>>,
}

/// A scene whose variants are being measured.
struct Measured {
    view: Job,
    points: Vec<Point>,
    /// How many there will be, once that is known.
    of: usize,
}

/// What decides how a scene is looked at: the wish, and a step that was set by hand.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wished {
    accuracy: project::Accuracy,
    step_voxels: Option<f64>,
}

impl Wished {
    fn of(job: &Job) -> Self {
        let accuracy = job.accuracy;
        Self {
            accuracy,
            step_voxels: (!accuracy.step).then_some(job.settings.step_voxels),
        }
    }
}

/// What is said of the picture on show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Told {
    /// The picture's own.
    pub(super) here: Choice,
    /// The cheapest that is clearly better, if one of those that are tried is.
    pub(super) next: Option<Choice>,
    /// What a comparison of the whole picture with the reference has found, where there was one.
    pub(super) measured: Option<Error>,
}

impl Accuracy {
    /// Calls `wake`, from any thread, when there is something new.
    pub(super) fn new(wake: Wake) -> Self {
        Self {
            chooses: true,
            known: None,
            looking: None,
            measured: None,
            measuring: None,
            wake,
        }
    }

    /// Whether numbers are chosen. If not, those of a scene that nobody has looked at stay.
    pub(super) fn choose(&mut self, chooses: bool) {
        self.chooses = chooses;
        if !chooses {
            self.looking = None;
            self.known = None;
        }
    }

    /// Whether there is nothing more to come for this job's numbers.
    pub(super) fn is_settled(&self, job: &Job) -> bool {
        !self.chooses || !job.accuracy.is_open() || self.is_known(job)
    }

    fn is_known(&self, job: &Job) -> bool {
        self.known_of(job).is_some()
    }

    /// What was found out for a job's wish. A look shows what numbers that were all set by hand are worth, whatever it was for.
    fn known_of(&self, job: &Job) -> Option<&Known> {
        let serves = |known: &&Known| {
            let is_for_it = known.wished == Wished::of(job) || !job.accuracy.is_open();
            is_for_it && known.view == view_of(job)
        };
        self.known.as_ref().filter(serves)
    }

    /// What was found out about the scene of a job.
    pub(super) fn pilot(&self, job: &Job) -> Option<&Arc<Pilot>> {
        Some(&self.known_of(job)?.looked.as_ref()?.pilot)
    }

    /// The plan that a job's scene was looked at with, if that was another than its picture's.
    pub(super) fn tried(&self, job: &Job) -> Option<Arc<Plan>> {
        self.known_of(job)?.looked.as_ref()?.tried.clone()
    }

    /// What is to be said of a job's picture, in which so many wavelengths are carried if that is known.
    pub(super) fn told(&self, job: &Job, wavelengths: Option<u32>) -> Option<Told> {
        let pilot = self.pilot(job)?;
        let asked = Numbers::of(&job.settings);
        let here = pilot.choice(wavelengths.map_or(asked, |count| asked.carrying(count)));
        let better = NEXT * here.error.all.de95;
        let table = pilot.table().iter();
        let good = table.filter(|it| it.error.all.de95 <= better && it.cpu_s > here.cpu_s);
        let next = good.min_by(|one, other| one.work.total_cmp(&other.work));
        Some(Told {
            here,
            next: next.copied(),
            measured: None,
        })
    }

    /// Whether the scene of a job was looked at and nothing is to be seen in it.
    pub(super) fn sees_nothing(&self, job: &Job) -> bool {
        self.known_of(job)
            .is_some_and(|known| known.looked.is_none())
    }

    /// The numbers that a job's wish comes to, once that is known.
    pub(super) fn chosen(&self, job: &Job) -> Option<Numbers> {
        if !job.accuracy.is_open() {
            return None;
        }
        let pilot = self.pilot(job)?;
        Some(pilot.choose(job.accuracy, Numbers::of(&job.settings)))
    }

    /// Takes in what was found; begins to look at the scene on show if nobody has, once there is a fine picture of it.
    pub(super) fn follow(&mut self, job: &Job, packed: Option<Packed>, is_fine: bool) {
        self.receive();
        let view = view_of(job);
        let wanted_for = Wished::of(job);
        let looking = self.looking.as_ref();
        if looking.is_some_and(|it| it.view != view || it.wished != wanted_for) {
            self.looking = None;
        }
        if self.measured.as_ref().is_some_and(|it| it.view != view) {
            self.measuring = None;
            self.measured = None;
        }
        // What is known of another volume is not worth its memory.
        let is_of_it = |known: &Known| Arc::ptr_eq(&known.view.volume, &job.volume);
        if !self.known.as_ref().is_some_and(is_of_it) {
            self.known = None;
        }
        let wanted = self.chooses && is_fine && self.looking.is_none() && !self.is_known(job);
        if wanted && packed.is_none() {
            // The engine was publishing at this very moment: ask again.
            (self.wake)();
        }
        if let (true, Some(packed)) = (wanted, packed) {
            let wished = job.accuracy;
            let rank = Rank::WithThePicture;
            let running = Running::begin("look", rank, &self.wake, move |cancel, tell| {
                let Packed {
                    scene,
                    plan,
                    settings,
                    ..
                } = &packed;
                let looked = Pilot::new(scene, plan, settings, wished, cancel);
                if !cancel.is_cancelled() {
                    tell(looked.map(|(pilot, tried)| Looked {
                        pilot: Arc::new(pilot),
                        tried: tried.map(Arc::new),
                    }));
                }
            });
            self.looking = running.map(|running| Looking {
                view,
                wished: wanted_for,
                running,
            });
        }
    }

    /// Begins to measure every variant of a job's scene, for somebody who looks at the chart. It goes on while the scene is on
    /// show, whether or not the chart is.
    pub(super) fn measure(&mut self, job: &Job, packed: Option<Packed>) {
        let view = view_of(job);
        let Some(packed) = packed.filter(|_| self.measured.is_none() && self.pilot(job).is_some())
        else {
            return;
        };
        self.measured = Some(Measured {
            view,
            points: Vec::new(),
            of: 0,
        });
        let job = job.clone();
        let rank = Rank::BehindThePicture;
        self.measuring = Running::begin("study", rank, &self.wake, move |cancel, tell| {
            let _ = study::report(&job, &packed.scene, cancel, &mut |point, of| {
                tell((point.clone(), of));
            });
        });
    }

    /// What has been measured of a job's scene so far, and how much there will be if it goes on.
    pub(super) fn points(&self, job: &Job) -> (&[Point], usize) {
        let view = view_of(job);
        let measured = self.measured.as_ref().filter(|it| it.view == view);
        measured.map_or((&[], 0), |it| (&it.points, it.of))
    }

    fn receive(&mut self) {
        if let Some(looking) = &self.looking {
            let found = match looking.running.next() {
                Ok(found) => found,
                // It failed: the numbers stay as they are.
                Err(Ended) => Some(None),
            };
            if let Some(looked) = found {
                self.known = Some(Known {
                    view: looking.view.clone(),
                    wished: looking.wished,
                    looked,
                });
                self.looking = None;
            }
        }
        if let (Some(measuring), Some(measured)) = (&self.measuring, &mut self.measured) {
            let ended = loop {
                match measuring.next() {
                    Ok(Some((point, of))) => {
                        measured.of = of;
                        measured.points.push(point);
                    }
                    Ok(None) => break false,
                    Err(Ended) => break true,
                }
            };
            if ended {
                measured.of = measured.points.len();
                self.measuring = None;
            }
        }
    }
}

/// A job without its numbers: what is known of one is known of all with the same.
pub(super) fn view_of(job: &Job) -> Job {
    let mut view = job.clone();
    let numbers = Numbers {
        step_voxels: 1.0,
        ..study::REFERENCE
    };
    view.settings = numbers.within(&view.settings);
    view.settings.effects.wavelengths = crate::render::Switch::Auto;
    view
}
