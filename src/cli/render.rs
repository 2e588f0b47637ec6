//! `sootlight render`: load, bake, render, write, each on the clock.

use std::time::Instant;

use super::command::{Format, Render};
use super::error::CliError;
use super::stats::{Seconds, Stats};
use super::{load, output};
use crate::colour::display::BakedView;
use crate::export::{self, Encoded, Provenance};
use crate::project::{Darkness, Job};
use crate::render::develop::{Metering, flaws_of};
use crate::render::{Cancel, Flaws, Frame, render_still};
use crate::scene::Scene;

impl Render {
    /// Does it. The clock is read here only: what the core makes does not depend on time.
    pub(super) fn run(&self) -> Result<(), CliError> {
        // A picture that could not be written is not worth its rendering.
        for path in std::iter::once(&self.output).chain(&self.stats) {
            export::check_writable(path)
                .map_err(|error| CliError::failed("nothing was rendered", error))?;
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build()
            .map_err(|error| {
                CliError::failed(
                    "the threads cannot be started; give fewer by --threads",
                    error,
                )
            })?;

        let (volume, load) = timed(|| pool.install(|| load::volume(&self.project)));
        let job = self.project.job(&volume?).map_err(CliError::project)?;
        let (scene, bake) = timed(|| pool.install(|| job.scene(None)));
        let (frame, render) = timed(|| pool.install(|| still(&scene, &job)));
        let frame = frame?;
        let (written, write) = timed(|| pool.install(|| self.write(&job, &frame)));
        let (metering, flaws) = written?;

        let seconds = Seconds {
            load,
            bake,
            render,
            write,
        };
        if let Some(path) = &self.stats {
            let view = self.project.view();
            let (threads, metering, flaws) = (self.threads, &metering, &flaws);
            let stats = Stats {
                seconds,
                threads,
                job: &job,
                scene: &scene,
                frame: &frame,
                metering,
                view: &view,
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

    /// Encodes and writes the picture; gives what the meter saw, and every flaw.
    fn write(&self, job: &Job, frame: &Frame) -> Result<(Metering, Flaws), CliError> {
        let metering = Metering::of(&frame.film);
        let mut flaws = job.flaws.clone();
        flaws.extend(frame.flaws.iter().map(String::from));
        flaws.extend(flaws_of(&frame.film).iter().map(String::from));
        if metering.is_black() {
            flaws.add(Darkness::of(job).words);
        }
        let encode = || -> Result<Encoded, export::ExportError> {
            let provenance = Provenance::new(&self.project, &flaws);
            match self.format {
                Format::Png(bits) => {
                    let view = BakedView::new(&metering.view(&self.project.view()));
                    export::png::encode(&frame.film, &view, bits, &provenance)
                }
                Format::Exr => export::exr::encode(&frame.film, &provenance),
            }
        };
        let failed = |error| CliError::failed("the picture was not written", error);
        let encoded = encode().map_err(failed)?;
        export::write(&self.output, &encoded.bytes).map_err(failed)?;
        Ok((metering, flaws))
    }
}

fn still(scene: &Scene, job: &Job) -> Result<Frame, CliError> {
    let bar = output::progress_bar();
    let frame = render_still(scene, &job.settings, &Cancel::never(), &|share| {
        output::advance(&bar, share);
    });
    bar.finish_and_clear();
    frame.ok_or_else(|| CliError::Said("the render was cancelled".to_owned()))
}

/// What a step gives, and its wall-clock seconds.
fn timed<T>(step: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let made = step();
    (made, start.elapsed().as_secs_f64())
}
