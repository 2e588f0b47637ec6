//! Work beside the picture, on a thread of its own that nobody waits for.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use thread_priority::{ThreadPriority, set_current_thread_priority};

use crate::engine::Engine;
use crate::render::Cancel;

/// What tells the window, from any thread, that there is something new.
pub(super) type Wake = Arc<dyn Fn() + Send + Sync>;

/// How the work stands to the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rank {
    /// The next picture waits for it.
    WithThePicture,
    /// For somebody who looks on, where the system finds nothing else to do.
    BehindThePicture,
}

/// Work that runs, until it ends or this is dropped.
pub(super) struct Running<T> {
    generation: Arc<AtomicU64>,
    news: Receiver<T>,
}

impl<T> Running<T> {
    /// Begins work in a pool of its own, whose news come one by one. A panic in it ends it. `None` if the system gives no
    /// thread.
    pub(super) fn begin(
        name: &str,
        rank: Rank,
        wake: &Wake,
        work: impl FnOnce(&Cancel, &(dyn Fn(T) + Sync)) + Send + 'static,
    ) -> Option<Self>
    where
        T: Send + 'static,
    {
        let (sender, news): (Sender<T>, _) = channel();
        let generation = Arc::new(AtomicU64::new(0));
        let cancel = Cancel::when_passed(Arc::clone(&generation), 0);
        let wake = Arc::clone(wake);
        let all = move || {
            if let Ok(pool) = pool(rank) {
                let tell = {
                    let wake = Arc::clone(&wake);
                    move |news: T| {
                        // Nobody listens any more when the window has gone on to something else.
                        let _ = sender.send(news);
                        wake();
                    }
                };
                let work = AssertUnwindSafe(|| pool.install(|| work(&cancel, &tell)));
                // A panic was told where it happened; who waits hears that nobody sends any more.
                let _ = catch_unwind(work);
            }
            wake();
        };
        let thread = std::thread::Builder::new().name(format!("sootlight-{name}"));
        thread
            .spawn(all)
            .is_ok()
            .then_some(Self { generation, news })
    }

    /// What has come since, one by one; `Err` once all has come and the work has ended.
    pub(super) fn next(&self) -> Result<Option<T>, Ended> {
        match self.news.try_recv() {
            Ok(news) => Ok(Some(news)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(Ended),
        }
    }
}

impl<T> Drop for Running<T> {
    fn drop(&mut self) {
        // The thread ends by itself, soon.
        self.generation.fetch_add(1, Ordering::SeqCst);
    }
}

/// The work has ended, well or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Ended;

fn pool(rank: Rank) -> Result<rayon::ThreadPool, rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new();
    match rank {
        // The window has what the picture leaves it.
        Rank::WithThePicture => pool.num_threads(Engine::threads_beside_a_window()),
        Rank::BehindThePicture => pool.start_handler(|_| {
            // Where the system does not let a thread give way, it works all the same.
            let _ = set_current_thread_priority(ThreadPriority::Min);
        }),
    }
    .build()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn all<T: Send + 'static>(running: &Running<T>) -> Vec<T> {
        let mut news = Vec::new();
        loop {
            match running.next() {
                Ok(Some(one)) => news.push(one),
                Ok(None) => std::thread::yield_now(),
                Err(Ended) => return news,
            }
        }
    }

    fn wake() -> Wake {
        Arc::new(|| {})
    }

    #[test]
    fn news_come_in_their_order_and_then_the_end() {
        let rank = Rank::BehindThePicture;
        let running = Running::begin("test", rank, &wake(), |_, tell| (0..3).for_each(tell));
        assert_eq!(all(&running.unwrap()), [0, 1, 2]);
    }

    #[test]
    fn a_panic_is_an_end() {
        let rank = Rank::WithThePicture;
        let running = Running::begin("test", rank, &wake(), |_, tell| {
            tell(1);
            panic!("planted");
        });
        assert_eq!(all(&running.unwrap()), [1]);
    }

    #[test]
    fn what_nobody_holds_is_cancelled() {
        let (seen, saw) = channel();
        let rank = Rank::WithThePicture;
        let running = Running::<()>::begin("test", rank, &wake(), move |cancel, _| {
            while !cancel.is_cancelled() {
                std::thread::yield_now();
            }
            seen.send(()).unwrap();
        });
        drop(running);
        saw.recv().unwrap();
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn who_works_behind_the_picture_gives_way() {
        // Field 19 of a thread's line: niceness. The name before it may hold spaces, not a bracket.
        let niceness = || {
            let line = std::fs::read_to_string("/proc/thread-self/stat").unwrap();
            let after = line.rsplit(')').next().map(str::to_owned);
            let field = after
                .as_deref()
                .and_then(|it| it.split_whitespace().nth(16));
            field.and_then(|it| it.parse::<i32>().ok()).unwrap()
        };
        let own = niceness();
        for (rank, gives_way) in [
            (Rank::WithThePicture, false),
            (Rank::BehindThePicture, true),
        ] {
            let running = Running::begin("test", rank, &wake(), move |_, tell| tell(niceness()));
            let found = all(&running.unwrap());
            assert_eq!(found[0] > own, gives_way, "{rank:?}: {found:?} {own}");
        }
    }
}
