//! Opening files without holding up the window: each load and each dialog runs on a named thread of its own.
//!
//! The newest request that can be read wins: what an older one brings waits until no newer one is left, and is
//! dropped once a newer one has come. What no longer counts is stopped. A failure is a sentence, never a panic.

mod asked;
mod request;

use std::panic::{AssertUnwindSafe, UnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

pub(super) use asked::Asked;
use request::load;
pub(super) use request::{Outcome, Request};

use crate::volume::{Limits, Watch};

/// A dialog that closes sooner was never seen by anybody.
const TOO_QUICK_FOR_A_PERSON: Duration = Duration::from_millis(400);

/// A load that has not failed and was not overtaken by one that succeeded.
struct Load {
    ticket: u64,
    /// What is being loaded, for a person.
    words: String,
    /// How far its thread is, and the means to stop it.
    watch: Watch,
    /// What it brought, while a newer load may yet fail.
    brought: Option<Outcome>,
}

/// A load on its way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Loading<'a> {
    /// What is being loaded, for a person.
    pub(super) words: &'a str,
    /// How much of it is done, 0 to 1.
    pub(super) share: f32,
}

/// Loads in the background.
pub(super) struct Loader {
    sender: Sender<(u64, Outcome)>,
    receiver: Receiver<(u64, Outcome)>,
    newest: u64,
    /// Loads that may still be shown, oldest first.
    loads: Vec<Load>,
    dialog_open: bool,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Loader {
    /// A loader that calls `wake`, from any thread, when there is something to poll.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (sender, receiver) = channel();
        Self {
            sender,
            receiver,
            newest: 0,
            loads: Vec::new(),
            dialog_open: false,
            wake,
        }
    }

    /// The newest load.
    pub(super) fn loading(&self) -> Option<Loading<'_>> {
        self.loads.last().map(|load| Loading {
            words: &load.words,
            share: load.watch.share(),
        })
    }

    /// Begins to load what may cost so much; an older load counts only if this one fails.
    pub(super) fn begin(&mut self, request: Request, limits: Limits) {
        self.newest += 1;
        let ticket = self.newest;
        let watch = Watch::default();
        self.loads.push(Load {
            ticket,
            words: request.words(),
            watch: watch.clone(),
            brought: None,
        });
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let lost = request.clone();
        let spawned = std::thread::Builder::new()
            .name("sootlight-loader".into())
            .spawn(move || {
                let again = request.clone();
                let outcome = catch_unwind(AssertUnwindSafe(|| load(request, &limits, &watch)))
                    .unwrap_or_else(|_| {
                        let words = format!(
                            "{}: reading it failed unexpectedly; nothing was opened",
                            again.words()
                        );
                        Outcome::Failed {
                            request: again,
                            words,
                        }
                    });
                // The window may be gone.
                let _ = sender.send((ticket, outcome));
                wake();
            });
        if let Err(error) = spawned {
            let words = format!("cannot start a thread to read files: {error}");
            let _ = self.sender.send((
                ticket,
                Outcome::Failed {
                    request: lost,
                    words,
                },
            ));
        }
    }

    /// Asks for files with the desktop's own dialog.
    pub(super) fn ask(&mut self) {
        if self.dialog_open {
            return;
        }
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let spawned = std::thread::Builder::new()
            .name("sootlight-dialog".into())
            .spawn(move || {
                let dialog = rfd::FileDialog::new().set_title("Open a volume");
                let outcome = match answer(|| dialog.pick_files()) {
                    Answer::Chosen(paths) => Outcome::Chosen(paths),
                    Answer::Closed => Outcome::Chosen(Vec::new()),
                    Answer::NoDialog => Outcome::NoDialog,
                };
                let _ = sender.send((0, outcome));
                wake();
            });
        match spawned {
            Ok(_) => self.dialog_open = true,
            Err(_) => drop(self.sender.send((0, Outcome::NoDialog))),
        }
    }

    /// Stops every load. What one of them may still bring is dropped.
    pub(super) fn cancel(&mut self) {
        for load in self.loads.drain(..) {
            load.watch.cancel();
        }
    }

    /// What was polled is on show: an older load no longer counts, and is stopped.
    pub(super) fn forget_older(&mut self) {
        self.cancel();
    }

    /// The next outcome, if there is one. Older loads go on counting until [`Loader::forget_older`].
    pub(super) fn poll(&mut self) -> Option<Outcome> {
        loop {
            if let Some(outcome) = self.loads.last_mut().and_then(|load| load.brought.take()) {
                self.loads.pop();
                return Some(outcome);
            }
            let (ticket, outcome) = self.receiver.try_recv().ok()?;
            if ticket == 0 {
                self.dialog_open = false;
                return Some(outcome);
            }
            let Some(at) = self.loads.iter().position(|load| load.ticket == ticket) else {
                continue;
            };
            if !matches!(outcome, Outcome::Failed { .. }) {
                self.loads[at].brought = Some(outcome);
            } else if at + 1 == self.loads.len() {
                // The load before it, if it still runs, is the newest again.
                self.loads.truncate(at);
                return Some(outcome);
            } else {
                self.loads.remove(at);
            }
        }
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// What a person answered in a dialog of the desktop.
#[derive(Debug, PartialEq)]
pub(super) enum Answer<T> {
    /// This.
    Chosen(T),
    /// Nothing.
    Closed,
    /// Nobody was asked: this desktop shows no dialog.
    NoDialog,
}

/// Asks with a dialog that waits for its answer: not on the window's thread.
pub(super) fn answer<T>(dialog: impl FnOnce() -> Option<T> + UnwindSafe) -> Answer<T> {
    let begun = Instant::now();
    match catch_unwind(dialog) {
        Ok(Some(chosen)) => Answer::Chosen(chosen),
        Ok(None) if begun.elapsed() > TOO_QUICK_FOR_A_PERSON => Answer::Closed,
        Ok(None) | Err(_) => Answer::NoDialog,
    }
}

/// What a person typed or pasted, as paths: one for each line, quotes and a `file://` taken off.
pub(super) fn paths_of(text: &str) -> Vec<PathBuf> {
    text.lines()
        .map(|line| line.trim().trim_matches(['"', '\'']))
        .map(|line| line.strip_prefix("file://").unwrap_or(line))
        .filter(|line| !line.is_empty())
        .map(PathBuf::from)
        .collect()
}

#[cfg(test)]
mod tests;
