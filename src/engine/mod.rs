//! Background rendering for the window: [`Engine::submit`] a job, [`Engine::drain`] its tiles.
//!
//! The latest job wins. A generation is an atomic number that a submit raises: workers ask for it before each
//! packet of rays, and publishing asks again inside the lock, so that no tile of an old picture ever lands in a
//! new one. Jobs do not queue up: a submit replaces the job that waits and throws away what was not drained. What
//! waits to be drained is at most the tiles of the running job.
//!
//! The engine has a thread of its own, which packs media and runs the passes on its own rayon pool; the window
//! never waits for a lock (see [`Engine::drain`]). A worker's panic becomes an [`News::Failed`]; the next job
//! runs as if nothing had happened.

mod news;
mod picture;
mod progress;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

pub use news::{Generation, News, Packed, Update};
pub use picture::Picture;
pub use progress::Progress;

use crate::project::Job;
use crate::render::costs::costs;
use crate::render::plan::Decision;
use crate::render::{Cancel, Gate, Pass, Plan, Region, pass, render_pass};
use crate::scene::Scene;
use crate::volume::Volume;

/// Renders in the background. Dropping it cancels and joins.
pub struct Engine {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What a job leaves to the next one.
struct Before {
    generation: Generation,
    scene: Scene,
    volume: Arc<Volume>,
    decisions: Vec<Decision>,
    /// Whether a picture with a ray for each pixel is on show.
    is_fine: bool,
}

/// So long costs are measured at most, beside the picture's own fields.
const MEASURING: Duration = Duration::from_millis(1500);

struct Shared {
    /// Raised by each submit; what a [`Cancel`] compares with.
    current: Arc<AtomicU64>,
    stop: AtomicBool,
    /// Shut while the running job pauses.
    gate: Gate,
    waiting: Mutex<Option<Waiting>>,
    arrived: Condvar,
    outbox: Mutex<Vec<Update>>,
    /// The scene of the running or last job, once it is packed.
    packed: Mutex<Option<Packed>>,
    wake: Box<dyn Fn() + Send + Sync>,
}

/// A job that waits for the engine.
struct Waiting {
    generation: Generation,
    job: Job,
    /// The part that it is to be sharp in; `None` for all of it.
    region: Option<Region>,
    /// What it shows in the same way with other numbers, if it does.
    refines: Option<Refined>,
    submitted: Instant,
}

/// What is known of a job that shows what another shows, with other numbers.
struct Refined {
    /// The other.
    generation: Generation,
    /// A plan of the same scene, whose fields may serve.
    tried: Option<Arc<Plan>>,
}

/// A poisoned lock guards data that is whole at every moment: a panic between two pushes leaves a valid list.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Engine {
    /// An engine with a pool of `threads` workers (at least one), that calls `wake` from any thread when there is
    /// something to drain.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn new(threads: usize, wake: Box<dyn Fn() + Send + Sync>) -> std::io::Result<Self> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.max(1))
            .thread_name(|i| format!("sootlight-worker-{i}"))
            .build()
            .map_err(std::io::Error::other)?;
        let shared = Arc::new(Shared {
            current: Arc::default(),
            stop: AtomicBool::new(false),
            gate: Gate::default(),
            waiting: Mutex::new(None),
            arrived: Condvar::new(),
            outbox: Mutex::new(Vec::new()),
            packed: Mutex::new(None),
            wake,
        });
        let thread = std::thread::Builder::new()
            .name("sootlight-engine".into())
            .spawn({
                let shared = Arc::clone(&shared);
                move || shared.serve(&pool)
            })?;
        Ok(Self {
            shared,
            thread: Some(thread),
        })
    }

    /// Workers for a window on this machine: every core, but for one where there are more than two, so that the
    /// window keeps drawing.
    pub fn threads_beside_a_window() -> usize {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        if cores > 2 { cores - 1 } else { cores }
    }

    /// Renders this job from now on; whatever was running, waiting or not yet drained is forgotten.
    pub fn submit(&self, job: Job) -> Generation {
        self.submit_within(job, None)
    }

    /// The same, sharp only in a part of the picture, if one is given.
    pub fn submit_within(&self, job: Job, region: Option<Region>) -> Generation {
        self.take(job, region, |_| None)
    }

    /// The same for a job that shows what the one before shows, with other numbers: no coarse picture of it takes the place of
    /// a fine one, and what was worked out for that, or for a plan that somebody `tried` with the same scene, is not worked out
    /// again.
    pub fn refine(&self, job: Job, region: Option<Region>, tried: Option<Arc<Plan>>) -> Generation {
        self.take(job, region, |generation| {
            Some(Refined { generation, tried })
        })
    }

    /// Lets the running job pause after the tiles in hand, or go on. The next job goes on by itself.
    pub fn pause(&self, pauses: bool) {
        self.shared.gate.set_shut(pauses);
    }

    /// Whether it pauses.
    pub fn pauses(&self) -> bool {
        self.shared.gate.is_shut()
    }

    fn take(
        &self,
        job: Job,
        region: Option<Region>,
        refines: impl FnOnce(Generation) -> Option<Refined>,
    ) -> Generation {
        let mut waiting = lock(&self.shared.waiting);
        let before = Generation(self.shared.current.load(Ordering::SeqCst));
        let generation = self.shared.next_generation();
        *waiting = Some(Waiting {
            generation,
            job,
            region,
            refines: refines(before),
            submitted: Instant::now(),
        });
        drop(waiting);
        self.pause(false);
        self.shared.arrived.notify_one();
        generation
    }

    /// Stops what runs, without another job.
    pub fn cancel(&self) {
        let mut waiting = lock(&self.shared.waiting);
        self.shared.next_generation();
        *waiting = None;
        drop(waiting);
        self.pause(false);
    }

    /// Everything published since the last drain, oldest first. Never waits: empty if a worker is publishing
    /// at this very moment (it wakes the window afterwards).
    pub fn drain(&self) -> Vec<Update> {
        match self.shared.outbox.try_lock() {
            Ok(mut outbox) => std::mem::take(&mut *outbox),
            Err(TryLockError::Poisoned(outbox)) => std::mem::take(&mut *outbox.into_inner()),
            Err(TryLockError::WouldBlock) => Vec::new(),
        }
    }

    /// The packed scene of the job submitted last, cheap to have. `None` while that is being packed, after a failure, and
    /// (for it never waits) if a worker is publishing one at this very moment.
    pub fn scene(&self) -> Option<Packed> {
        let packed = match self.shared.packed.try_lock() {
            Ok(packed) => packed.clone(),
            Err(TryLockError::Poisoned(packed)) => packed.into_inner().clone(),
            Err(TryLockError::WouldBlock) => None,
        };
        let current = Generation(self.shared.current.load(Ordering::SeqCst));
        packed.filter(|packed| packed.generation == current)
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::SeqCst);
        self.cancel();
        self.shared.arrived.notify_one();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was reported when it happened.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// Ends the current generation: nothing of it is published from here on, and what was is thrown away.
    fn next_generation(&self) -> Generation {
        let mut outbox = lock(&self.outbox);
        let generation = Generation(self.current.fetch_add(1, Ordering::SeqCst) + 1);
        let stale = std::mem::take(&mut *outbox);
        drop(outbox);
        // Tiles are freed outside the lock, so that no worker waits for it.
        drop(stale);
        generation
    }

    /// The engine's thread: waits for jobs until told to stop.
    fn serve(&self, pool: &ThreadPool) {
        let mut before: Option<Before> = None;
        while let Some(next) = self.next() {
            let generation = next.generation;
            let outcome = catch_unwind(AssertUnwindSafe(|| {
                pool.install(|| self.render(&next, before.as_ref()))
            }));
            match outcome {
                Ok(done) => before = Some(done),
                Err(panic) => {
                    before = None;
                    *lock(&self.packed) = None;
                    self.publish(generation, News::Failed(words_of(panic.as_ref())));
                }
            }
        }
    }

    /// The next job, as soon as there is one; `None` when the engine is dropped.
    fn next(&self) -> Option<Waiting> {
        let mut waiting = lock(&self.waiting);
        loop {
            if self.stop.load(Ordering::SeqCst) {
                return None;
            }
            if let Some(next) = waiting.take() {
                return Some(next);
            }
            waiting = self
                .arrived
                .wait(waiting)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Packs the medium, then runs pass after pass until done or overtaken. Returns what the next job may use.
    fn render(&self, next: &Waiting, before: Option<&Before>) -> Before {
        let (generation, job) = (next.generation, &next.job);
        let cancel = Cancel::when_passed(Arc::clone(&self.current), generation.0);
        let begun = Instant::now();
        let scene = job.scene(before.map(|before| &before.scene));
        // Of another volume nothing says what was on show of this one.
        let decided = before.filter(|before| Arc::ptr_eq(&before.volume, &job.volume));
        let decided = decided.map_or(&[][..], |before| &before.decisions);
        let mut plan = Plan::after(&scene, &job.settings, decided);
        // A job that was overtaken before it began is not what this one refines.
        let refined = next.refines.as_ref().zip(before);
        let refined = refined.filter(|(refined, before)| refined.generation == before.generation);
        if let Some((refined, _)) = refined {
            let packed = lock(&self.packed).clone();
            let packed = packed.filter(|packed| packed.generation == refined.generation);
            let known = [packed.map(|packed| packed.plan), refined.tried.clone()];
            for known in known.iter().flatten() {
                plan.take_over(known);
            }
        }
        let plan = Arc::new(plan);
        let replaced = lock(&self.packed).replace(Packed {
            generation,
            scene: scene.clone(),
            size: job.settings.size,
            effects: job.settings.effects.as_decided(&plan.decisions),
            settings: job.settings,
            plan: Arc::clone(&plan),
        });
        // What may be the last of an old volume is freed outside the lock.
        drop(replaced);
        let shows_enough = refined.is_some_and(|(_, before)| before.is_fine);
        let passes = match next.region {
            Some(region) => pass::ladder_within(&job.settings, region),
            None if shows_enough => pass::ladder_again(&job.settings),
            None => pass::ladder(&job.settings, pass::Audience::Window),
        };
        let started = News::Started {
            passes: passes.clone(),
            size: job.settings.size,
            bake: begun.elapsed(),
            flaws: plan.flaws.clone(),
            decisions: plan.decisions.clone(),
        };
        self.publish(generation, started);
        let submitted = next.submitted;
        let whole = self.render_passes(generation, &scene, &plan, &passes, submitted, &cancel);
        if whole == passes.len() {
            self.publish(generation, News::Finished);
            let measured = costs(&scene, &job.settings, &plan, MEASURING, &cancel);
            if let Some(costs) = measured {
                self.publish(generation, News::Costs(costs));
            }
        }
        Before {
            generation,
            scene,
            volume: Arc::clone(&job.volume),
            decisions: plan.decisions.clone(),
            is_fine: next.region.is_none()
                && (shows_enough || passes.iter().take(whole).any(|pass| pass.stride == 1)),
        }
    }

    /// Runs pass after pass until overtaken. Returns how many are whole.
    fn render_passes(
        &self,
        generation: Generation,
        scene: &Scene,
        plan: &Plan,
        passes: &[Pass],
        submitted: Instant,
        cancel: &Cancel,
    ) -> usize {
        for (index, pass) in passes.iter().enumerate() {
            let begun = Instant::now();
            if plan.fields(scene, pass.level(), cancel).is_none() {
                return index;
            }
            let since_submit = submitted.elapsed();
            self.publish(generation, News::PassBegun { since_submit });
            let whole = render_pass(scene, plan, pass, cancel, &|tile| {
                self.publish(generation, News::Tile(tile));
                self.gate.pass(cancel);
            });
            if !whole || cancel.is_cancelled() {
                return index;
            }
            let took = begun.elapsed();
            self.publish(
                generation,
                News::PassDone {
                    index,
                    since_submit: submitted.elapsed(),
                    took,
                    facts: plan.facts(),
                },
            );
        }
        passes.len()
    }

    /// Adds to the outbox what still belongs to the current job, and wakes the window.
    fn publish(&self, generation: Generation, news: News) {
        {
            let mut outbox = lock(&self.outbox);
            if self.current.load(Ordering::SeqCst) != generation.0 {
                return;
            }
            outbox.push(Update { generation, news });
        }
        (self.wake)();
    }
}

fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let words = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!(
        "rendering failed: {}. The picture before stays; change a setting to try again",
        words.unwrap_or("no reason given")
    )
}
