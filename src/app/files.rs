//! Opening files without holding up the window: each load and each dialog runs on a named thread of its own.
//!
//! The newest request that can be read wins: what an older one brings waits until no newer one is left, and is
//! dropped once a newer one has come. What no longer counts is stopped. A failure is a sentence, never a panic.

use std::panic::{AssertUnwindSafe, UnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use crate::volume::{self, Limits, Volume, VolumeError, Watch};

/// A dialog that closes sooner was never seen by anybody.
const TOO_QUICK_FOR_A_PERSON: Duration = Duration::from_millis(400);
/// Share of a partner's load that opening it with the open volume takes: seldom must it be read again alone.
const TOGETHER: f32 = 0.8;

/// What to open.
#[derive(Debug, Clone)]
pub(super) enum Request {
    /// The flame that needs no file.
    BuiltIn,
    /// What the project names: settings stay as they are.
    Project(Vec<PathBuf>),
    /// These files as one volume, instead of what is open; the built-in flame if there are none.
    Files(Vec<PathBuf>),
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
    /// The open volume with a field that it lacked.
    Completed(Arc<Volume>),
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
            Self::BuiltIn => "the built-in flame".to_owned(),
            Self::Files(paths) if paths.is_empty() => "the built-in flame".to_owned(),
            Self::Project(paths) | Self::Files(paths) => names(paths),
            Self::Partner(_, path) => path.display().to_string(),
        }
    }
}

fn load(request: Request, watch: &Watch) -> Outcome {
    let limits = Limits::default();
    let open = |paths| volume::open_watched(paths, &limits, watch);
    let outcome = match &request {
        Request::BuiltIn => {
            volume::procedural::torch_watched(watch).map(|v| Outcome::Shown(v.into()))
        }
        Request::Project(paths) => open(paths).map(|v| Outcome::Shown(v.into())),
        Request::Files(paths) if paths.is_empty() => {
            volume::procedural::torch_watched(watch).map(|v| Outcome::Replaced(v.into()))
        }
        Request::Files(paths) => open(paths).map(|v| Outcome::Replaced(v.into())),
        Request::Partner(open, path) => open_partner(open, path, &limits, watch),
    };
    outcome.unwrap_or_else(|error| Outcome::Failed {
        request,
        words: error.to_string(),
    })
}

/// The open volume with the file's field; or the file alone, where it has the same field.
fn open_partner(
    open: &Volume,
    path: &Path,
    limits: &Limits,
    watch: &Watch,
) -> Result<Outcome, VolumeError> {
    match open.with_file_watched(path, limits, &watch.part(0.0, TOGETHER)) {
        Ok(both) => Ok(Outcome::Completed(both.into())),
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
mod tests {
    use super::*;

    #[test]
    fn a_path_may_be_quoted_or_an_address() {
        let paths = paths_of(" \"/a b/c.vdb\" \nfile:///d.vdb\n\n");
        assert_eq!(
            paths,
            [PathBuf::from("/a b/c.vdb"), PathBuf::from("/d.vdb")]
        );
    }

    /// A load whose thread has not ended.
    fn running(ticket: u64) -> Load {
        Load {
            ticket,
            words: ticket.to_string(),
            watch: Watch::default(),
            brought: None,
        }
    }

    fn shown() -> Outcome {
        Outcome::Shown(Arc::new(volume::procedural::torch()))
    }

    fn words(loader: &Loader) -> Option<&str> {
        loader.loading().map(|loading| loading.words)
    }

    /// A loader with two loads, and their watches.
    fn with_two_watched() -> (Loader, [Watch; 2]) {
        let mut loader = Loader::new(Arc::new(|| {}));
        let loads = [1, 2].map(running);
        let watches = loads.each_ref().map(|load| load.watch.clone());
        loader.loads.extend(loads);
        (loader, watches)
    }

    #[test]
    fn cancelled_loads_vanish_at_once_and_what_they_bring_is_dropped() {
        let (mut loader, watches) = with_two_watched();
        // The older one has succeeded and waits for the newer one.
        assert!(loader.sender.send((1, shown())).is_ok());
        assert!(loader.poll().is_none());
        loader.cancel();
        assert!(loader.loading().is_none());
        assert!(watches.iter().all(Watch::is_cancelled));
        // The newer one had succeeded when it was told to stop.
        assert!(loader.sender.send((2, shown())).is_ok());
        assert!(loader.poll().is_none() && loader.loading().is_none());
        // What is asked for next is not held up.
        loader.loads.push(running(3));
        assert!(loader.sender.send((3, shown())).is_ok());
        assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
    }

    #[test]
    fn what_no_longer_counts_is_stopped() {
        let (mut loader, [older, newer]) = with_two_watched();
        assert!(loader.sender.send((2, shown())).is_ok());
        assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
        assert!(!older.is_cancelled());
        loader.forget_older();
        assert!(older.is_cancelled() && !newer.is_cancelled());

        let (loader, watches) = with_two_watched();
        drop(loader);
        assert!(watches.iter().all(Watch::is_cancelled));
    }

    #[test]
    fn every_kind_of_request_stops_when_told() {
        let open = Arc::new(volume::procedural::torch());
        let file = PathBuf::from(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/hostile/ascii_good_constant.txt"
        ));
        for request in [
            Request::BuiltIn,
            Request::Project(vec![file.clone()]),
            Request::Files(vec![file.clone()]),
            Request::Partner(open, file),
        ] {
            let name = request.words();
            assert!(!matches!(
                load(request.clone(), &Watch::default()),
                Outcome::Failed { .. }
            ));
            let watch = Watch::default();
            watch.cancel();
            let Outcome::Failed { words, .. } = load(request, &watch) else {
                panic!("{name} was loaded");
            };
            assert_eq!(words, VolumeError::Cancelled.to_string(), "{name}");
            assert_eq!(watch.share(), 0.0, "{name}");
        }
    }

    #[test]
    fn a_partner_that_must_be_read_alone_goes_on_where_the_pair_ended() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["first_soot.txt", "second_soot.txt"].map(|name| {
            let path = folder.path().join(name);
            std::fs::write(&path, "1 1 2\n1e-6 2e-6\n").unwrap();
            path
        });
        let open = volume::open(&[first], &Limits::default()).unwrap();
        let shares = Arc::new(std::sync::Mutex::new(Vec::new()));
        let heard = Arc::clone(&shares);
        let watch = Watch::with_listener(move |watch| heard.lock().unwrap().push(watch.share()));
        let outcome = open_partner(&open, &second, &Limits::default(), &watch).unwrap();
        assert!(matches!(outcome, Outcome::Replaced(_)));
        let shares = shares.lock().unwrap();
        assert!(
            shares.is_sorted() && shares.last() == Some(&1.0),
            "{shares:?}"
        );
        assert!(
            shares.iter().any(|share| (0.1..TOGETHER).contains(share)),
            "{shares:?}"
        );
        assert!(
            shares
                .iter()
                .any(|share| (TOGETHER + 0.02..0.99).contains(share)),
            "{shares:?}"
        );
    }

    #[test]
    fn a_dialog_that_nobody_saw_is_told_from_one_that_was_closed() {
        assert_eq!(answer(|| Some(7)), Answer::Chosen(7));
        assert_eq!(answer(|| None::<u8>), Answer::NoDialog);
        let closed = answer(|| {
            std::thread::sleep(2 * TOO_QUICK_FOR_A_PERSON);
            None::<u8>
        });
        assert_eq!(closed, Answer::Closed);
    }

    #[test]
    fn an_older_load_wins_only_once_the_newer_one_failed() {
        let failed = || Outcome::Failed {
            request: Request::BuiltIn,
            words: String::new(),
        };
        // Two loads run; the older one is the first to end.
        let with_two = || {
            let mut loader = Loader::new(Arc::new(|| {}));
            loader.loads.extend([1, 2].map(running));
            assert!(loader.sender.send((1, shown())).is_ok());
            assert!(loader.poll().is_none());
            assert_eq!(words(&loader), Some("2"));
            loader
        };

        let mut loader = with_two();
        assert!(loader.sender.send((2, failed())).is_ok());
        assert!(matches!(loader.poll(), Some(Outcome::Failed { .. })));
        assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));

        let mut loader = with_two();
        assert!(loader.sender.send((2, shown())).is_ok());
        assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
        loader.forget_older();
        assert!(loader.poll().is_none() && loader.loading().is_none());
    }
}
