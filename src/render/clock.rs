//! The core's only clock. It tells a person what work took; no picture depends on it.

use std::time::Instant;

/// What work gives, and its wall-clock seconds.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let made = work();
    (made, begun.elapsed().as_secs_f64())
}
