//! How far what is worked out before the rays is: light from all sides takes seconds, in which no pixel changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use super::Cancel;

/// Parts in which a share is told.
const PARTS: f64 = 10_000.0;

/// Told from any thread, asked from any other. Cheap to clone: all clones are one.
#[derive(Debug, Clone, Default)]
pub struct Preparation(Arc<AtomicU32>);

impl Preparation {
    /// The share that is done, 0 to 1; `None` where nothing is being worked out.
    pub fn share(&self) -> Option<f64> {
        let parts = self.0.load(Ordering::Relaxed).checked_sub(1)?;
        Some(f64::from(parts) / PARTS)
    }

    /// Does the work, whose share is told meanwhile.
    pub(super) fn during<T>(&self, cancel: &Cancel, work: impl FnOnce(&Watch<'_>) -> T) -> T {
        let _ended = Ended(self);
        self.tell(0.0);
        work(&Watch {
            cancel,
            preparation: self,
            from: 0.0,
            to: 1.0,
        })
    }

    fn tell(&self, share: f64) {
        let parts = (share.clamp(0.0, 1.0) * PARTS) as u32;
        self.0.store(parts + 1, Ordering::Relaxed);
    }
}

/// A part of the work: it asks whether to stop, and tells how far it is.
#[derive(Debug)]
pub(super) struct Watch<'a> {
    cancel: &'a Cancel,
    preparation: &'a Preparation,
    from: f64,
    to: f64,
}

impl Watch<'_> {
    /// A part of it.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        let at = |share: f64| self.from + share * (self.to - self.from);
        Watch {
            cancel: self.cancel,
            preparation: self.preparation,
            from: at(from),
            to: at(to),
        }
    }

    /// Whether to stop.
    pub(super) fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// The same for work in so many pieces.
    pub(super) fn pieces(&self, count: usize) -> Pieces<'_> {
        Pieces {
            watch: self,
            begun: AtomicUsize::new(0),
            count,
        }
    }

    /// Tells the share of this part that is done.
    pub(super) fn tell(&self, share: f64) {
        self.preparation
            .tell(self.from + share * (self.to - self.from));
    }
}

/// Work of so many pieces alike, done in any order by any threads.
#[derive(Debug)]
pub(super) struct Pieces<'a> {
    watch: &'a Watch<'a>,
    begun: AtomicUsize,
    count: usize,
}

impl Pieces<'_> {
    /// Tells that one more is begun; `None` if it shall not be.
    pub(super) fn begin(&self) -> Option<()> {
        if self.watch.is_cancelled() {
            return None;
        }
        let before = self.begun.fetch_add(1, Ordering::Relaxed);
        self.watch.tell(before as f64 / self.count.max(1) as f64);
        Some(())
    }
}

/// Ends what a preparation tells, however the work ended.
struct Ended<'a>(&'a Preparation);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.0.store(0, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU64;

    use super::*;

    #[test]
    fn pieces_are_told_as_they_begin_until_it_is_cancelled() {
        let told = Preparation::default();
        let current = Arc::new(AtomicU64::new(0));
        let cancel = Cancel::when_passed(Arc::clone(&current), 0);
        told.during(&cancel, |watch| {
            let half = watch.part(0.0, 0.5);
            let pieces = half.pieces(4);
            assert!((0..3).all(|_| pieces.begin().is_some()));
            assert_eq!(told.share(), Some(0.25));
            current.store(1, Ordering::Relaxed);
            assert_eq!(pieces.begin(), None);
        });
    }

    #[test]
    fn parts_of_parts_are_shares_of_all_and_nothing_is_told_after_the_end() {
        let told = Preparation::default();
        assert_eq!(told.share(), None);
        let never = Cancel::never();
        told.during(&never, |watch| {
            assert_eq!(told.share(), Some(0.0));
            watch.part(0.5, 1.0).part(0.0, 0.5).tell(0.5);
            assert_eq!(told.clone().share(), Some(0.625));
        });
        assert_eq!(told.share(), None);
    }
}
