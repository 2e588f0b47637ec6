//! Where a render pauses.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use super::Cancel;

/// How often what pauses looks whether it was cancelled.
const LOOK: Duration = Duration::from_millis(50);

/// A gate before each piece of work, such as a tile or a frame: the one in hand is finished, the next waits while the gate is
/// shut.
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
    pub fn pass(&self, cancel: &Cancel) {
        let mut shut = self.shut.lock().unwrap_or_else(PoisonError::into_inner);
        while *shut && !cancel.is_cancelled() {
            let waited = self.opened.wait_timeout(shut, LOOK);
            shut = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;

    #[test]
    fn a_shut_gate_holds_until_it_opens_or_nobody_wants_to_pass() {
        let (gate, generation) = (Gate::default(), Arc::new(AtomicU64::new(0)));
        let cancel = Cancel::when_passed(Arc::clone(&generation), 0);
        // Open, it holds nobody.
        gate.pass(&cancel);
        for opens in [true, false] {
            gate.set_shut(true);
            std::thread::scope(|scope| {
                let passes = scope.spawn(|| gate.pass(&cancel));
                std::thread::sleep(2 * LOOK);
                assert!(!passes.is_finished() && gate.is_shut());
                if opens {
                    gate.set_shut(false);
                } else {
                    generation.store(1, Ordering::SeqCst);
                }
                passes.join().unwrap();
            });
        }
    }
}
