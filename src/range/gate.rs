//! Where a range pauses.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use crate::render::Cancel;

/// How often a range that pauses looks whether it was cancelled.
const LOOK: Duration = Duration::from_millis(50);

/// A gate before each frame: the one in hand is finished, the next waits while the gate is shut.
#[derive(Debug, Default)]
pub struct Gate {
    shut: Mutex<bool>,
    opened: Condvar,
}

impl Gate {
    /// Shuts it, or opens it again.
    pub fn set_shut(&self, shut: bool) {
        *self.shut.lock().unwrap_or_else(PoisonError::into_inner) = shut;
        self.opened.notify_all();
    }

    /// Whether it is shut.
    pub fn is_shut(&self) -> bool {
        *self.shut.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until it is open, or nobody wants to pass any more.
    pub(super) fn pass(&self, cancel: &Cancel) {
        let mut shut = self.shut.lock().unwrap_or_else(PoisonError::into_inner);
        while *shut && !cancel.is_cancelled() {
            let waited = self.opened.wait_timeout(shut, LOOK);
            shut = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}
