//! A still, or a range of frames, written in the background while the window stays live: at most one at a time, on a named
//! thread with a rayon pool of its own, beside the engine that goes on rendering what is on show.
//!
//! An [`Order`] is plain data, taken when Export is pressed: what is edited or opened afterwards does not change it.

mod order;
mod outcome;
mod range;
mod still;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::words::with_causes;
use crate::export::ExportError;
use crate::render::Cancel;
use crate::render::Gate;
use crate::render::preparation::Preparation;

pub(super) use order::{Exactness, Order, Wish};
pub(super) use outcome::Outcome;
use still::{NotExported, export, pool};

pub(super) use range::{Counts, Playing, RangeOrder};

/// Between two calls that wake the window, milliseconds.
const WAKE_MS: u64 = 50;

/// How far an export is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Progress {
    /// Rendered share, 0 to 1.
    pub(super) share: f64,
    /// Share of the light from all sides, 0 to 1, while it is worked out before the first rays.
    pub(super) preparing: Option<f64>,
    /// Time in which that was rendered: what is looked at and worked out before the first ray of a still does not count.
    pub(super) elapsed: Duration,
}

/// Exports in the background. Dropping it cancels and joins.
pub(super) struct Exporter {
    running: Option<Running>,
    last: Option<Outcome>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

struct Running {
    path: PathBuf,
    begun: Instant,
    /// Whether it can pause: a range does between two frames.
    is_range: bool,
    shared: Arc<Shared>,
    outcome: Receiver<Outcome>,
    thread: JoinHandle<()>,
}

/// What the window and the thread both see.
#[derive(Default)]
struct Shared {
    /// Raised to cancel.
    generation: Arc<AtomicU64>,
    /// Where a range pauses.
    gate: Gate,
    /// The rendered share in millionths: a whole number can only rise.
    millionths: AtomicU64,
    /// When the window was last woken, milliseconds since the beginning.
    woken_ms: AtomicU64,
    /// How far the light is that is worked out before the first rays.
    preparation: Preparation,
    /// When a still's rays began.
    rays: OnceLock<Instant>,
}

const MILLION: f64 = 1e6;

impl Exporter {
    /// An exporter that calls `wake`, from any thread, when there is something new to draw.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            running: None,
            last: None,
            wake,
        }
    }

    /// Begins to export, unless an export runs.
    pub(super) fn begin(&mut self, order: Order) {
        self.start(order.path.clone(), false, move |shared, begun, wake| {
            shared.outcome(begun, wake, |cancel, progress| {
                let begin = || {
                    let _ = shared.rays.set(Instant::now());
                };
                export(&order, cancel, (&shared.preparation, &begin), progress).map(|flaws| {
                    Outcome::Done {
                        path: order.path.clone(),
                        size: order.project.render.size,
                        seconds: begun.elapsed().as_secs_f64(),
                        flaws,
                    }
                })
            })
        });
    }

    /// Begins to export all pictures of a range, unless an export runs.
    pub(super) fn begin_range(&mut self, order: RangeOrder) {
        self.start(order.output.clone(), true, move |shared, begun, wake| {
            let outcome = shared.outcome(begun, wake, |cancel, progress| {
                let gate = &shared.gate;
                let exported = pool()?.install(|| range::export(order, gate, cancel, progress));
                exported.map(|(counts, flaws)| Outcome::Range {
                    counts,
                    seconds: begun.elapsed().as_secs_f64(),
                    flaws,
                })
            });
            match outcome {
                Outcome::Cancelled => Outcome::Stopped,
                outcome => outcome,
            }
        });
    }

    /// Pauses the range that runs before its next frame, or lets it go on.
    pub(super) fn pause(&self, pauses: bool) {
        if let Some(running) = &self.running {
            running.shared.gate.set_shut(pauses);
        }
    }

    /// Whether the range that runs pauses; `None` where none runs.
    pub(super) fn pauses(&self) -> Option<bool> {
        let range = self.running.as_ref().filter(|running| running.is_range);
        range.map(|running| running.shared.gate.is_shut())
    }

    fn start(
        &mut self,
        path: PathBuf,
        is_range: bool,
        work: impl FnOnce(&Shared, Instant, &(dyn Fn() + Send + Sync)) -> Outcome + Send + 'static,
    ) {
        if self.running.is_some() {
            return;
        }
        self.last = None;
        let begun = Instant::now();
        let shared = Arc::new(Shared::default());
        let (sender, outcome) = channel();
        let spawned = std::thread::Builder::new()
            .name("sootlight-export".into())
            .spawn({
                let (shared, wake) = (Arc::clone(&shared), Arc::clone(&self.wake));
                move || {
                    // The window may be gone.
                    let _ = sender.send(work(&shared, begun, wake.as_ref()));
                    wake();
                }
            });
        match spawned {
            Ok(thread) => {
                self.running = Some(Running {
                    path,
                    begun,
                    is_range,
                    shared,
                    outcome,
                    thread,
                });
            }
            Err(error) => {
                let words = format!("the thread to export with cannot be started: {error}");
                self.last = Some(Outcome::Failed(words));
            }
        }
    }

    /// Stops what runs; nothing is written.
    pub(super) fn cancel(&self) {
        if let Some(running) = &self.running {
            running.shared.generation.fetch_add(1, Ordering::SeqCst);
        }
    }

    /// Takes in the outcome, once there is one: true then.
    pub(super) fn poll(&mut self) -> bool {
        let Some(running) = &self.running else {
            return false;
        };
        let outcome = match running.outcome.try_recv() {
            Ok(outcome) => outcome,
            Err(TryRecvError::Empty) => return false,
            Err(TryRecvError::Disconnected) => {
                Outcome::Failed("the export ended without a word; nothing was written".to_owned())
            }
        };
        self.last = Some(outcome);
        if let Some(running) = self.running.take() {
            // It has said its last word.
            let _ = running.thread.join();
        }
        true
    }

    /// The file that is being made, and how far it is.
    pub(super) fn running(&self) -> Option<(&Path, Progress)> {
        self.running.as_ref().map(|running| {
            let share = running.shared.millionths.load(Ordering::Relaxed) as f64 / MILLION;
            let rays = running.shared.rays.get();
            let elapsed = rays.unwrap_or(&running.begun).elapsed();
            let preparing = running.shared.preparation.share();
            let progress = Progress {
                share,
                preparing,
                elapsed,
            };
            (running.path.as_path(), progress)
        })
    }

    /// What became of the last export, until the next begins or it is dismissed.
    pub(super) fn last(&self) -> Option<&Outcome> {
        self.last.as_ref()
    }

    /// Forgets what became of the last export.
    pub(super) fn dismiss(&mut self) {
        self.last = None;
    }
}

impl Drop for Exporter {
    fn drop(&mut self) {
        self.cancel();
        if let Some(running) = self.running.take() {
            // A panic of the thread was caught where it happened.
            let _ = running.thread.join();
        }
    }
}

impl Shared {
    /// Does the work, and says what became of it.
    fn outcome(
        &self,
        begun: Instant,
        wake: &(dyn Fn() + Send + Sync),
        work: impl FnOnce(&Cancel, &(dyn Fn(f64) + Sync)) -> Result<Outcome, NotExported>,
    ) -> Outcome {
        let progress = |share: f64| {
            self.millionths
                .fetch_max((share * MILLION) as u64, Ordering::Relaxed);
            let now = begun.elapsed().as_millis() as u64;
            let woken = self.woken_ms.load(Ordering::Relaxed);
            let is_mine = now >= woken + WAKE_MS
                && self
                    .woken_ms
                    .compare_exchange(woken, now, Ordering::Relaxed, Ordering::Relaxed)
                    .is_ok();
            if is_mine {
                wake();
            }
        };
        let cancel = Cancel::when_passed(Arc::clone(&self.generation), 0);
        match catch_unwind(AssertUnwindSafe(|| work(&cancel, &progress))) {
            Ok(Ok(outcome)) => outcome,
            Ok(Err(NotExported::Export(ExportError::Cancelled))) => Outcome::Cancelled,
            Ok(Err(error)) => Outcome::Failed(with_causes(&error)),
            Err(panic) => {
                let words = panic.downcast_ref::<&str>().copied();
                let words = words.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
                let words = words.unwrap_or("no reason given");
                Outcome::Failed(format!("the export failed: {words}. Nothing was written"))
            }
        }
    }
}

#[cfg(test)]
mod tests;
