//! `sootlight render`: load, bake, render, write, each on the clock.

use std::time::{Duration, Instant};

use indicatif::ProgressBar;

use super::accuracy::Accuracy;
use super::command::Render;
use super::error::CliError;
use super::pictures::Pictures;
use super::pool::pool;
use super::stats::{Seconds, Stats};
use super::{load, output};
use crate::export::{self, ExportError, Still};
use crate::render::clock::timed_on_pool;
use crate::render::costs::costs;
use crate::render::still::render_until;
use crate::render::{Cancel, Frame, Plan};
use crate::scene::Scene;
use crate::study::{self, Numbers};

impl Render {
    /// Does it. The clock is read here only: what the core makes does not depend on time.
    pub(super) fn run(&self) -> Result<(), CliError> {
        match self.pictures {
            Pictures::One => {}
            Pictures::Frames(frames) => return self.run_frames(frames),
            Pictures::Turntable(views) => return self.run_turntable(views),
        }
        // A picture that could not be written is not worth its rendering.
        export::check_target(&self.output, &self.project.sources())
            .and_then(|()| self.stats.as_deref().map_or(Ok(()), export::check_writable))
            .map_err(|error| CliError::failed("nothing was rendered", error))?;
        let pool = pool(self.threads)?;

        let (volume, load) = timed(|| pool.install(|| load::volume(&self.project)));
        let mut still = Still::new(&self.project, &volume?, None).map_err(CliError::project)?;
        let (scene, bake) = timed(|| pool.install(|| still.scene()));
        let end = self
            .time_limit
            .and_then(|limit| Instant::now().checked_add(Duration::from_secs_f64(limit)));
        let planned = || {
            let (settings, wished) = (&still.job.settings, still.job.accuracy);
            let (never, plan) = (Cancel::never(), still.plan(&scene));
            let bar = output::progress_bar(plan.preparation());
            let aim = study::aim(&scene, plan, settings, wished, end, &never);
            still.job.settings = aim.settings;
            if end.is_some() {
                // What a clock has chosen no scene file would come to again.
                Numbers::of(&aim.settings).by_hand(&mut still.project.render);
            }
            let frame = with_a_bar(&bar, &still, &scene, &aim.plan, end);
            (aim, frame)
        };
        let ((aim, frame), took) = pool.install(|| timed_on_pool(planned));
        let render = took.wall_s;
        let not_written = |error| CliError::failed("the picture was not written", error);
        let frame = frame.map_err(not_written)?;
        let (written, write) = timed(|| {
            pool.install(|| still.write(&frame, self.format, &self.output, &Cancel::never()))
        });
        let export::Written { metering, flaws } = written.map_err(not_written)?;

        let seconds = Seconds {
            load,
            bake,
            render,
            write,
        };
        if let Some(path) = &self.stats {
            let (threads, metering, flaws) = (self.threads, &metering, &flaws);
            let (settings, never) = (&still.job.settings, Cancel::never());
            let budget = MEASURING + Duration::from_secs_f64(MEASURING_SHARE * render);
            let costs = pool.install(|| costs(&scene, settings, &aim.plan, budget, &never));
            let stats = Stats {
                seconds,
                render_cpu_s: took.cpu_s,
                accuracy: Accuracy::of(&aim, still.job.accuracy, &frame, end.is_some()),
                threads,
                project: &still.project,
                job: &still.job,
                scene: &scene,
                frame: &frame,
                costs: &costs.unwrap_or_default(),
                metering,
                view: &self.project.view(),
                flaws,
            };
            let text = format!("{:#}\n", stats.to_json());
            export::write(path, text.as_bytes()).map_err(|error| {
                CliError::failed("the picture was written, its statistics were not", error)
            })?;
        }
        let [width, height] = frame.film.size();
        let total = load + bake + render + write;
        output::say(&format!(
            "{}: {width} × {height} pixels in {total:.2} s",
            self.output.display()
        ));
        for flaw in flaws.iter() {
            output::say(&format!("  flaw: {flaw}"));
        }
        Ok(())
    }
}

/// So long the costs of effects are measured for statistics at most, and that share of the time that the picture took.
const MEASURING: Duration = Duration::from_secs(1);
const MEASURING_SHARE: f64 = 0.1;

fn with_a_bar(
    bar: &ProgressBar,
    still: &Still,
    scene: &Scene,
    plan: &Plan,
    end: Option<Instant>,
) -> Result<Frame, ExportError> {
    let (never, settings) = (Cancel::never(), &still.job.settings);
    let progress = |share: f64| output::advance(bar, share);
    let frame = match end {
        Some(end) => render_until(scene, plan, settings, end, &never, &progress)
            .ok_or(ExportError::Cancelled),
        None => still.render_planned(scene, plan, &never, &progress),
    };
    bar.finish_and_clear();
    frame
}

/// What a step gives, and its wall-clock seconds.
fn timed<T>(step: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let made = step();
    (made, start.elapsed().as_secs_f64())
}
