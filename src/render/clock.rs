//! The core's only clock. It tells a person what work took; no picture depends on it.

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;

/// What work took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Took {
    /// Wall-clock seconds.
    pub wall_s: f64,
    /// Seconds of processor time of all threads that worked: what else the machine does is not in it.
    pub cpu_s: f64,
}

impl std::ops::Add for Took {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            wall_s: self.wall_s + other.wall_s,
            cpu_s: self.cpu_s + other.cpu_s,
        }
    }
}

/// What work gives, and its wall-clock seconds.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let made = work();
    (made, begun.elapsed().as_secs_f64())
}

/// What work gives that this thread does alone, and its seconds of processor time.
pub(super) fn timed_alone<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = ThreadTime::now();
    let made = work();
    (made, begun.elapsed().as_secs_f64())
}

/// What work gives that the calling thread's rayon pool does together, and what it took: of that pool alone, so it must be
/// called from within.
pub fn timed_on_pool<T>(work: impl FnOnce() -> T) -> (T, Took) {
    let before = of_pool();
    let (made, wall_s) = timed(work);
    let cpu_s = (of_pool().saturating_sub(before)).as_secs_f64();
    (made, Took { wall_s, cpu_s })
}

/// Processor time of every thread of the pool since it began.
fn of_pool() -> Duration {
    let of_each = rayon::broadcast(|_| ThreadTime::now().as_duration());
    of_each.into_iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sleep_takes_time_but_no_processor() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        let sleep = || std::thread::sleep(Duration::from_millis(60));
        let took = pool.map(|pool| pool.install(|| timed_on_pool(sleep).1));
        assert!(took.is_ok_and(|took| took.wall_s >= 0.06 && took.cpu_s < 0.05));
    }

    #[test]
    fn work_of_every_thread_counts() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        // Each thread works until it has had so much of a processor, however long that takes.
        let work = || {
            rayon::broadcast(|_| {
                let begun = ThreadTime::now();
                while begun.elapsed() < Duration::from_millis(30) {
                    std::hint::spin_loop();
                }
            })
        };
        let took = pool.map(|pool| pool.install(|| timed_on_pool(work).1));
        assert!(took.is_ok_and(|took| (0.06..0.2).contains(&took.cpu_s)));
    }
}
