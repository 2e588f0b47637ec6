//! Frames read ahead on a thread of their own, a few at a time.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use crate::project::Project;
use crate::range;
use crate::sequence::Sequence;
use crate::volume::{Limits, Volume, Wanted, Watch};

/// So many frames are wanted at once: the one that is asked for, and those after it.
pub(super) const AHEAD: usize = 4;
/// What frames that were read ahead may take in memory, bytes; the one that is asked for is read whatever it takes.
const MOST_BYTES: u64 = 1 << 30;

/// A frame, or why there is none.
type Read = Result<Arc<Volume>, String>;

/// Reads frames. Dropping it stops.
pub(in crate::app) struct Store {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    stop: bool,
    /// Files whose siblings are looked for.
    look: Option<Vec<PathBuf>>,
    /// Siblings that were found.
    found: Option<(Vec<PathBuf>, Sequence)>,
    /// What frames are read of, and for what.
    about: Option<About>,
    /// Which are wanted, the first before the others.
    numbers: Vec<u64>,
    read: BTreeMap<u64, Read>,
    /// The frame that is being read, and the means to stop it.
    reading: Option<(u64, Watch)>,
}

/// What frames are read of, and for what: of another nothing that was read serves.
#[derive(Clone)]
struct About {
    sequence: Arc<Sequence>,
    project: Project,
    wanted: Wanted,
    limits: Limits,
}

impl About {
    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.sequence, &other.sequence)
            && self.wanted == other.wanted
            && self.limits == other.limits
    }
}

impl Store {
    /// A store without frames, whose thread begins when it is first needed. It calls `wake` when there is something new.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            shared: Arc::default(),
            thread: None,
            wake,
        }
    }

    /// Looks for the siblings of files; whatever was read is forgotten.
    pub(super) fn look_for_siblings(&mut self, files: &[PathBuf]) {
        let mut state = self.shared.lock();
        state.forget();
        state.about = None;
        state.found = None;
        state.look = (!files.is_empty()).then(|| files.to_vec());
        let is_needed = state.look.is_some();
        drop(state);
        if is_needed {
            self.go_on();
        }
    }

    /// Siblings that were found, once, with the files whose they are.
    pub(super) fn siblings(&self) -> Option<(Vec<PathBuf>, Sequence)> {
        self.shared.lock().found.take()
    }

    /// Reads these frames, the first before the others, as a project needs them.
    pub(super) fn want(&mut self, sequence: &Arc<Sequence>, numbers: &[u64], project: &Project) {
        let about = About {
            sequence: Arc::clone(sequence),
            wanted: project.wanted(),
            limits: project.volume.limits(),
            project: project.clone(),
        };
        let mut state = self.shared.lock();
        let is_same = state.about.as_ref().is_some_and(|it| it.is_same(&about));
        if is_same && state.numbers == numbers {
            return;
        }
        if !is_same {
            state.forget();
            state.about = Some(about);
        }
        state.numbers = numbers.to_vec();
        if let Some((_, watch)) = state
            .reading
            .as_ref()
            .filter(|(number, _)| !numbers.contains(number))
        {
            watch.cancel();
        }
        state.read.retain(|number, _| numbers.contains(number));
        drop(state);
        self.go_on();
    }

    /// A frame that was read, or why it could not be.
    pub(super) fn take(&self, number: u64) -> Option<Read> {
        let mut state = self.shared.lock();
        let read = state.read.remove(&number)?;
        // It is not to be read again before somebody wants it.
        state.numbers.retain(|&it| it != number);
        Some(read)
    }

    fn go_on(&mut self) {
        if self.thread.is_none() {
            let (shared, wake) = (Arc::clone(&self.shared), Arc::clone(&self.wake));
            let thread = std::thread::Builder::new().name("sootlight-frames".into());
            // Without a thread there are no frames, and the open file stays.
            self.thread = thread.spawn(move || shared.serve(wake.as_ref())).ok();
        }
        self.shared.changed.notify_one();
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        state.stop = true;
        state.forget();
        drop(state);
        self.shared.changed.notify_one();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was caught where it happened.
            let _ = thread.join();
        }
    }
}

impl State {
    fn forget(&mut self) {
        self.numbers.clear();
        self.read.clear();
        if let Some((_, watch)) = &self.reading {
            watch.cancel();
        }
    }

    fn bytes(&self) -> u64 {
        let volumes = self.read.values().flatten();
        volumes.map(|volume| bytes_of(volume)).sum()
    }

    /// The next frame to read.
    fn next(&self) -> Option<(u64, About)> {
        let about = self.about.clone()?;
        let number = *self.numbers.iter().find(|it| !self.read.contains_key(it))?;
        let is_first = self.numbers.first() == Some(&number);
        (is_first || self.bytes() < MOST_BYTES).then_some((number, about))
    }
}

fn bytes_of(volume: &Volume) -> u64 {
    volume.grids.iter().map(crate::volume::Grid::bytes).sum()
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The thread's whole life.
    fn serve(&self, wake: &(dyn Fn() + Send + Sync)) {
        let mut state = self.lock();
        loop {
            if state.stop {
                return;
            }
            if let Some(files) = state.look.take() {
                drop(state);
                let found = Sequence::of_all(&files);
                state = self.lock();
                if let (Ok(sequence), None) = (found, &state.look) {
                    state.found = Some((files, sequence));
                    wake();
                }
            } else if let Some((number, about)) = state.next() {
                let watch = Watch::default();
                state.reading = Some((number, watch.clone()));
                drop(state);
                let read = catch_unwind(AssertUnwindSafe(|| read(number, &about, &watch)));
                let read =
                    read.unwrap_or_else(|_| Err("reading it failed unexpectedly".to_owned()));
                state = self.lock();
                state.reading = None;
                let is_wanted = state.numbers.contains(&number)
                    && state.about.as_ref().is_some_and(|it| it.is_same(&about));
                if is_wanted && !watch.is_cancelled() {
                    state.read.insert(number, read);
                    wake();
                }
            } else {
                let woken = self.changed.wait(state);
                state = woken.unwrap_or_else(PoisonError::into_inner);
            }
        }
    }
}

fn read(number: u64, about: &About, watch: &Watch) -> Read {
    let paths = about.sequence.paths(number);
    let volume = range::open(&about.project, &paths, watch).map_err(|error| error.to_string())?;
    // What a camera frames takes a walk over all voxels: here, not where the window waits for it.
    for grid in &volume.grids {
        grid.bulk();
    }
    Ok(volume)
}
