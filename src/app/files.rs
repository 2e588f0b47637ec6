//! Opening files without holding up the window: each load and each dialog runs on a named thread of its own.
//!
//! The newest request that can be read wins: what an older one brings waits until no newer one is left, and is
//! dropped once a newer one has come. What no longer counts is stopped. A failure is a sentence, never a panic.

use std::panic::{AssertUnwindSafe, UnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use crate::project::Preset;
use crate::volume::{self, BuiltIn, Limits, Volume, VolumeError, Watch};

/// A dialog that closes sooner was never seen by anybody.
const TOO_QUICK_FOR_A_PERSON: Duration = Duration::from_millis(400);
/// Share of a partner's load that opening it with the open volume takes: seldom must it be read again alone.
const TOGETHER: f32 = 0.8;

/// What to open.
#[derive(Debug, Clone)]
pub(super) enum Request {
    /// A flame that needs no file: settings stay as they are.
    BuiltIn(BuiltIn),
    /// What the project names: settings stay as they are.
    Project(Vec<PathBuf>),
    /// These files as one volume, instead of what is open.
    Files(Vec<PathBuf>),
    /// A flame that needs no file, instead of what is open, burning as in a preset if one was chosen.
    OtherBuiltIn(BuiltIn, Option<&'static Preset>),
    /// A file that may bring the missing field of the open volume, or else replaces it.
    Partner(Arc<Volume>, PathBuf),
}

/// What became of a request.
#[derive(Debug)]
pub(super) enum Outcome {
    /// A volume for the project as it stands.
    Shown(Arc<Volume>),
    /// A volume that takes the place of the open one.
    Replaced(Arc<Volume>),
    /// One that does so and burns as in a preset.
    Burning(Arc<Volume>, &'static Preset),
    /// The open volume with a field that it lacked.
    Completed {
        /// What was open when this was asked for.
        open: Arc<Volume>,
        /// Both together.
        both: Arc<Volume>,
    },
    /// Nothing was opened, and why.
    Failed {
        /// What was asked for.
        request: Request,
        /// Why not, in words.
        words: String,
    },
    /// Somebody chose files in the dialog.
    Chosen(Vec<PathBuf>),
    /// The dialog never appeared.
    NoDialog,
}

impl Outcome {
    /// The volume that it brought.
    fn volume(&self) -> Option<&Arc<Volume>> {
        match self {
            Self::Shown(volume) | Self::Replaced(volume) | Self::Burning(volume, _) => Some(volume),
            Self::Completed { both, .. } => Some(both),
            Self::Failed { .. } | Self::Chosen(_) | Self::NoDialog => None,
        }
    }
}

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

    /// Begins to load; an older load counts only if this one fails.
    pub(super) fn begin(&mut self, request: Request) {
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
                let outcome = catch_unwind(AssertUnwindSafe(|| load(request, &watch)))
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

impl Request {
    fn words(&self) -> String {
        let names = |paths: &[PathBuf]| {
            let name = |path: &PathBuf| path.display().to_string();
            paths.iter().map(name).collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::BuiltIn(flame) | Self::OtherBuiltIn(flame, _) => {
                format!("the built-in {}", flame.name())
            }
            Self::Project(paths) | Self::Files(paths) => names(paths),
            Self::Partner(_, path) => path.display().to_string(),
        }
    }
}

fn load(request: Request, watch: &Watch) -> Outcome {
    let limits = Limits::default();
    let open = |paths| volume::open_watched(paths, &limits, watch);
    let outcome = match &request {
        Request::BuiltIn(flame) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Shown(v.into())),
        Request::OtherBuiltIn(flame, None) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Replaced(v.into())),
        Request::OtherBuiltIn(flame, Some(preset)) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Burning(v.into(), preset)),
        Request::Project(paths) => open(paths).map(|v| Outcome::Shown(v.into())),
        Request::Files(paths) => open(paths).map(|v| Outcome::Replaced(v.into())),
        Request::Partner(open, path) => open_partner(open, path, &limits, watch),
    };
    let outcome = outcome.unwrap_or_else(|error| Outcome::Failed {
        request,
        words: error.to_string(),
    });
    // What a camera frames takes a walk over all voxels: here, not where the window waits for it.
    for grid in outcome.volume().iter().flat_map(|volume| &volume.grids) {
        grid.bulk();
    }
    outcome
}

/// The open volume with the file's field; or the file alone, where it has the same field.
fn open_partner(
    open: &Arc<Volume>,
    path: &Path,
    limits: &Limits,
    watch: &Watch,
) -> Result<Outcome, VolumeError> {
    match open.with_file_watched(path, limits, &watch.part(0.0, TOGETHER)) {
        Ok(both) => Ok(Outcome::Completed {
            open: Arc::clone(open),
            both: both.into(),
        }),
        Err(VolumeError::Cancelled) => Err(VolumeError::Cancelled),
        Err(together) => {
            let watch = watch.part(TOGETHER, 1.0);
            let alone = volume::open_watched(&[path.to_owned()], limits, &watch)?;
            let partner = matches!(together, VolumeError::DimensionsDiffer { .. })
                && alone
                    .grids
                    .iter()
                    .all(|grid| open.grid(&grid.name).is_none());
            // A temperature of other dimensions was meant for this density, and cannot serve it.
            if partner {
                Err(together)
            } else {
                Ok(Outcome::Replaced(alone.into()))
            }
        }
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
