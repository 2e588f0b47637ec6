//! How far what is worked out before the rays is: light from all sides takes seconds, in which no pixel changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

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

    /// Tells the share of this part that is done.
    pub(super) fn tell(&self, share: f64) {
        self.preparation
            .tell(self.from + share * (self.to - self.from));
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
    use super::*;

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
