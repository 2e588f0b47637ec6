//! How far the opening of files has come, and the means to stop it.
//!
//! A [`Watch`] is what a person holds: a share and a way to cancel. Readers see a [`Stretch`] of it, the part of
//! the share that their step covers, so that none needs to know what comes before or after.

use std::fmt::{Debug, Formatter, Result as FmtResult};
use std::io::{Error, Read, Result as IoResult};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use super::VolumeError;

/// A listener is called at most this often in one open.
const CALLS: f32 = 200.0;

/// Watches one opening of files from any thread: how far it is, and whether it shall stop.
///
/// Clones watch the same open. A watch serves one open, and a [part](Watch::part) of it one of several that follow
/// each other; cancelled once, it stays so.
#[derive(Clone)]
pub struct Watch {
    shared: Arc<Shared>,
    /// The part of the share that this open covers.
    from: f32,
    to: f32,
}

type Listener = Box<dyn Fn(&Watch) + Send + Sync>;

#[derive(Default)]
struct Shared {
    /// Bits of the share: for floats that are not negative, the order of the bits is the order of the numbers.
    share: AtomicU32,
    cancelled: AtomicBool,
    listener: Option<Listener>,
}

impl Default for Watch {
    fn default() -> Self {
        Self::of(Shared::default())
    }
}

impl Watch {
    fn of(shared: Shared) -> Self {
        Self {
            shared: Arc::new(shared),
            from: 0.0,
            to: 1.0,
        }
    }

    /// A watch that calls `listener` whenever the share has grown by a two-hundredth or reached 1. The calls come
    /// from the threads that read, which wait for it: it should be quick.
    pub fn with_listener(listener: impl Fn(&Self) + Send + Sync + 'static) -> Self {
        Self::of(Shared {
            listener: Some(Box::new(listener)),
            ..Shared::default()
        })
    }

    /// A watch for an open that is only a part of the work, from one share of it to another, 0 to 1. Share and
    /// cancelling are those of the whole work.
    #[must_use]
    pub fn part(&self, from: f32, to: f32) -> Self {
        let Stretch { from, to, .. } = self.whole().part(from, to);
        Self {
            shared: Arc::clone(&self.shared),
            from,
            to,
        }
    }

    /// The finished share of the time that opening takes, roughly: 0 to 1. It never goes back, and is 1 once
    /// everything was read.
    pub fn share(&self) -> f32 {
        f32::from_bits(self.shared.share.load(Ordering::Relaxed))
    }

    /// Stops the open: it ends soon with [`VolumeError::Cancelled`].
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether the open was told to stop.
    pub fn is_cancelled(&self) -> bool {
        self.shared.cancelled.load(Ordering::Relaxed)
    }

    /// All of the share.
    pub(super) fn whole(&self) -> Stretch<'_> {
        Stretch {
            watch: self,
            from: self.from,
            to: self.to,
        }
    }

    fn reach(&self, share: f32) {
        let share = share.clamp(0.0, 1.0);
        let before = self
            .shared
            .share
            .fetch_max(share.to_bits(), Ordering::Relaxed);
        if let Some(listener) = &self.shared.listener
            && (f32::from_bits(before) * CALLS).floor() < (share * CALLS).floor()
        {
            listener(self);
        }
    }
}

impl Debug for Watch {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        f.debug_struct("Watch")
            .field("share", &self.share())
            .field("is_cancelled", &self.is_cancelled())
            .finish_non_exhaustive()
    }
}

/// The part of a watch's share that one step of an open covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'a> {
    watch: &'a Watch,
    from: f32,
    to: f32,
}

impl<'a> Stretch<'a> {
    /// A part of this stretch; `from` and `to` are shares of it, 0 to 1.
    pub(super) fn part(self, from: f32, to: f32) -> Self {
        Self {
            from: self.at(from),
            to: self.at(to),
            ..self
        }
    }

    pub(super) fn is_cancelled(self) -> bool {
        self.watch.is_cancelled()
    }

    /// Tells that `done` of `all` is done, in any unit.
    ///
    /// # Errors
    /// [`VolumeError::Cancelled`].
    pub(super) fn reach(self, done: u64, all: u64) -> Result<(), VolumeError> {
        self.check()?;
        self.tell(done, all);
        // A listener may have had enough.
        self.check()
    }

    /// # Errors
    /// [`VolumeError::Cancelled`].
    pub(super) fn check(self) -> Result<(), VolumeError> {
        if self.is_cancelled() {
            Err(VolumeError::Cancelled)
        } else {
            Ok(())
        }
    }

    /// Counts what many threads do, `all` pieces together.
    pub(super) fn counter(self, all: usize) -> Counter<'a> {
        Counter {
            stretch: self,
            done: AtomicU64::new(0),
            all: all as u64,
        }
    }

    /// `inner` with about `length` bytes to come. Once cancelled its reads fail.
    pub(super) fn reader<R: Read>(self, inner: R, length: u64) -> WatchedRead<'a, R> {
        WatchedRead {
            inner,
            stretch: self,
            done: 0,
            length,
        }
    }

    fn tell(self, done: u64, all: u64) {
        self.watch
            .reach(self.at(done.min(all) as f32 / all.max(1) as f32));
    }

    /// A share of this stretch as a share of everything; the ends are met exactly.
    fn at(self, share: f32) -> f32 {
        self.from * (1.0 - share) + self.to * share
    }
}

/// Counts pieces of a step over many threads.
pub(super) struct Counter<'a> {
    stretch: Stretch<'a>,
    done: AtomicU64,
    all: u64,
}

impl Counter<'_> {
    /// Counts one piece more; false if it shall not be begun.
    pub(super) fn goes_on(&self) -> bool {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        self.stretch.reach(done, self.all).is_ok()
    }
}

/// Bytes on their way from a file.
pub(super) struct WatchedRead<'a, R> {
    inner: R,
    stretch: Stretch<'a>,
    done: u64,
    length: u64,
}

impl<R: Read> Read for WatchedRead<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> IoResult<usize> {
        if self.stretch.is_cancelled() {
            // Not `Interrupted`, which callers try again.
            return Err(Error::other("cancelled"));
        }
        let count = self.inner.read(buffer)?;
        self.done += count as u64;
        self.stretch.tell(self.done, self.length);
        Ok(count)
    }
}
