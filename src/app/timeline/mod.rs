//! The frames of the sequence that the open file is one of: which is on show, how they play, and which are bad.
//!
//! Beside a file that is opened its siblings are listed in the background; the file itself is shown as ever. A step to
//! another frame asks the [`Store`] for it; once it is read it takes the open volume's place, with everything held that
//! would flicker. While frames play, the next comes when the time of this one is over and its first picture is there.

mod play;
mod store;
mod strip;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

pub(super) use store::Store;
pub(super) use strip::strip;

use self::play::Range;
use super::App;
use super::exporter::Playing;
use crate::project::Job;
use crate::range::{self, Taken};
use crate::sequence::Sequence;
use crate::volume::Volume;

/// Frames per second at first: those of the cinema.
const FPS: f64 = 24.0;
/// What may be set.
pub(super) const FPS_RANGE: [f64; 2] = [0.1, 240.0];

/// What the strip shows.
pub(super) struct Timeline {
    open: Option<Open>,
    /// The open files, as far as it knows.
    files: Vec<PathBuf>,
    store: Store,
    /// Frames per second.
    pub(super) fps: f64,
    /// Whether the first frame follows the last.
    pub(super) loops: bool,
    /// Whether the pointer was pressed while the space bar was: a drag, and no word to play.
    pub(super) space_drags: bool,
    /// What was assumed of the frame that others follow, in words: where a number is held, none is assumed any more.
    assumed: Vec<String>,
}

/// An open sequence.
struct Open {
    sequence: Arc<Sequence>,
    range: Range,
    /// On show.
    current: u64,
    /// Asked for, while it is read.
    wanted: Option<u64>,
    /// When the next frame is due, while they play.
    due: Option<Instant>,
    /// Frames that cannot be shown, and why.
    bad: BTreeMap<u64, String>,
}

/// What is asked of the timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Play, or pause.
    Toggle,
    /// The frame before.
    Back,
    /// The frame after.
    Forth,
    /// This frame, or the nearest that there is.
    To(u64),
    /// The first frame that plays.
    In(u64),
    /// The last frame that plays.
    Out(u64),
}

impl Timeline {
    /// A timeline without frames, that wakes the window when one is read.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            open: None,
            files: Vec::new(),
            store: Store::new(wake),
            fps: FPS,
            loops: true,
            space_drags: false,
            assumed: Vec::new(),
        }
    }

    /// Whether there is a sequence.
    pub(super) fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Whether frames play.
    pub(super) fn plays(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.due.is_some())
    }

    /// The number of the frame on show.
    pub(super) fn current(&self) -> Option<u64> {
        self.open.as_ref().map(|open| open.current)
    }

    /// Whether a frame is being read that was asked for.
    pub(super) fn waits(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.wanted.is_some())
    }

    /// The frames that play, and what is held over them.
    pub(super) fn playing(&self) -> Option<Playing> {
        let open = self.open.as_ref()?;
        Some(Playing {
            sequence: Arc::clone(&open.sequence),
            numbers: open.range.numbers().to_vec(),
            current: open.current,
            assumed: self.assumed.clone(),
        })
    }

    /// What was assumed of a file before it was held over all, in words.
    pub(super) fn assumed(&self) -> impl Iterator<Item = &str> {
        self.assumed.iter().map(String::as_str)
    }

    /// Other files are open: their siblings are looked for.
    fn begin(&mut self, files: &[PathBuf]) {
        self.open = None;
        self.assumed.clear();
        self.files = files.to_vec();
        self.store.look_for_siblings(files);
    }

    /// Takes in which files are open, and their siblings once those are known.
    fn follow(&mut self, files: &[PathBuf]) {
        // An undo may have brought back others.
        if files != self.files {
            self.begin(files);
        }
        let Some((of, sequence)) = self.store.siblings() else {
            return;
        };
        let current = sequence.number_of(files);
        if let (true, Some(current)) = (of == files, current) {
            self.open = Some(Open {
                range: Range::of(&sequence),
                sequence: Arc::new(sequence),
                current,
                wanted: None,
                due: None,
                bad: BTreeMap::new(),
            });
        }
    }
}

impl Open {
    /// The next frame to show, with what is bad passed over; `None` at the end.
    fn next(&self, from: u64, forth: bool, loops: bool) -> Option<u64> {
        self.range
            .next(from, forth, loops, |number| self.bad.contains_key(&number))
    }

    /// The frame that is wanted, and those that are likely to be wanted after it.
    fn ahead(&self, loops: bool) -> Vec<u64> {
        let mut from = self.wanted.unwrap_or(self.current);
        let mut ahead: Vec<u64> = self.wanted.into_iter().collect();
        while ahead.len() < store::AHEAD {
            match self.next(from, true, loops) {
                Some(number) if !ahead.contains(&number) && number != self.current => {
                    ahead.push(number);
                    from = number;
                }
                _ => break,
            }
        }
        ahead
    }
}

impl App {
    /// Other files are shown: the strip is theirs, as soon as their siblings are known.
    pub(super) fn look_for_frames(&mut self) {
        let sources = self.document.volume().map(|volume| volume.sources.clone());
        self.timeline.begin(&sources.unwrap_or_default());
    }

    /// Does what is asked of the timeline.
    pub(super) fn step(&mut self, step: Step) {
        let loops = self.timeline.loops;
        let Some(open) = &mut self.timeline.open else {
            return;
        };
        let from = open.wanted.unwrap_or(open.current);
        let to = match step {
            Step::Toggle => {
                open.due = match open.due {
                    Some(_) => None,
                    None => Some(Instant::now()),
                };
                return;
            }
            Step::In(number) => return open.range.set_in(number),
            Step::Out(number) => return open.range.set_out(number),
            Step::Back => open.next(from, false, loops),
            Step::Forth => open.next(from, true, loops),
            Step::To(number) => open.range.nearest(number),
        };
        if step != Step::Forth {
            open.due = None;
        }
        if let Some(to) = to.filter(|&to| to != from) {
            self.want(to);
        }
    }

    fn want(&mut self, number: u64) {
        if let Some(open) = &mut self.timeline.open {
            // Whoever comes back to a bad frame may have mended it.
            open.bad.remove(&number);
            open.wanted = Some(number).filter(|&number| number != open.current);
        }
    }

    /// Goes on with what plays, and shows the frame that is wanted once it is read. Gives the time after which to look again.
    pub(super) fn play(&mut self) -> Option<Duration> {
        let files = self.document.volume().map(|volume| &volume.sources[..]);
        self.timeline.follow(files.unwrap_or_default());
        let has_picture = self.shows_newest() || self.picture.progress.failure.is_some();
        let (loops, period) = (self.timeline.loops, 1.0 / self.timeline.fps);
        let open = self.timeline.open.as_mut()?;
        let mut wait = None;
        if let (Some(due), None) = (open.due, open.wanted) {
            let now = Instant::now();
            if now < due {
                wait = Some(due - now);
            } else if has_picture {
                match open.next(open.current, true, loops) {
                    Some(next) => {
                        open.due = Some(due.max(now) + Duration::from_secs_f64(period));
                        open.wanted = Some(next);
                    }
                    None => open.due = None,
                }
            }
        }
        let is_held = |job: &Job| range::is_held(&self.document.project, job);
        let is_in_use = open.due.is_some()
            || open.wanted.is_some()
            || self.document.last_job().is_some_and(is_held);
        if is_in_use {
            // Nothing is read ahead for somebody who looks at one file.
            let ahead = open.ahead(loops);
            let sequence = Arc::clone(&open.sequence);
            self.timeline
                .store
                .want(&sequence, &ahead, &self.document.project);
        }
        self.show_wanted();
        wait
    }

    /// Shows the wanted frame, if it is read; passes it over if it is bad.
    fn show_wanted(&mut self) {
        let Some(open) = &self.timeline.open else {
            return;
        };
        let Some(number) = open.wanted else { return };
        let read = self.timeline.store.take(number);
        let shown = match read {
            None => return,
            Some(Ok(volume)) => self.show_frame(volume),
            Some(Err(words)) => Err(words),
        };
        let loops = self.timeline.loops;
        let Some(open) = &mut self.timeline.open else {
            return;
        };
        match shown {
            Ok(()) => {
                open.current = number;
                open.wanted = None;
                self.timeline.files = open.sequence.paths(number);
            }
            Err(words) => {
                let plays = open.due.is_some();
                open.bad.insert(number, words.clone());
                open.wanted = open
                    .next(number, true, loops)
                    .filter(|&next| plays && next != open.current);
                if !plays {
                    self.notice = Some(format!("frame {number} is passed over: {words}"));
                } else if open.wanted.is_none() {
                    open.due = None;
                }
            }
        }
    }

    /// Holds over all frames what the one on show takes from its own file, and the effects that it called for.
    fn hold_what_is_shown(&mut self) {
        let Some(job) = self.document.last_job() else {
            return;
        };
        let was_held = range::is_held(&self.document.project, job);
        let taken = Taken::of(&self.document.project, job);
        let shown = self.effects_on_show();
        let assumed: Vec<String> = job.flaws.iter().map(String::from).collect();
        self.by_itself(|app| {
            app.document.hold(|project| {
                taken.hold(project);
                project.effects = shown.map_or(project.effects, |it| project.effects.computing(it));
            });
        });
        if let (Some(volume), Some(current)) = (self.document.volume(), self.timeline.current())
            && !was_held
            && let Ok(held) = self.document.project.job(volume)
        {
            let told: Vec<&str> = held.flaws.iter().collect();
            let newly = assumed
                .into_iter()
                .filter(|words| !told.contains(&words.as_str()))
                .map(|words| format!("{words} (in frame {current}, and so in all)"));
            self.timeline.assumed.extend(newly);
        }
    }

    /// Shows another frame in place of the one on show, with what would flicker held.
    fn show_frame(&mut self, volume: Arc<Volume>) -> Result<(), String> {
        self.hold_what_is_shown();
        // What was measured on a coarse picture is not measured again on another frame.
        self.meter.settle();
        self.document
            .show_frame(volume)
            .map_err(|error| error.to_string())
    }
}
