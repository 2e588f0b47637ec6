//! `sootlight render --frames A-B`: a range of a sequence, frame by frame.

use std::collections::BTreeSet;
use std::path::PathBuf;

use indicatif::ProgressBar;
use serde_json::{Value, json};

use super::accuracy::Accuracy;
use super::command::Render;
use super::error::CliError;
use super::output;
use super::pool::pool;
use super::stats::{self, Stats};
use crate::export::{self, is_same_file};
use crate::range::{self, Ended, Locked, Made, Order, Outcome, RangeError};
use crate::render::{Cancel, Gate};
use crate::sequence::{Frames, Sequence};

impl Render {
    /// Renders these frames. What is bad is told, and the rest goes on.
    pub(super) fn run_frames(&self, frames: Frames) -> Result<(), CliError> {
        let sequence = Sequence::of_all(&self.project.volume.path)
            .map_err(|error| CliError::failed("there is no sequence to render", error))?;
        let numbers = frames.of(&sequence);
        let Some(&first) = numbers.first() else {
            let [from, to] = sequence.ends().map(|end| sequence.padded(end));
            return Err(CliError::Said(format!(
                "no frame of {frames} is there: {} has frames from {from} to {to}",
                sequence.pattern()
            )));
        };
        self.check_targets(&sequence, &numbers)?;
        for words in sequence.notes() {
            output::say(&format!("note: {words}"));
        }
        let pool = pool(self.threads)?;
        let mut project = self.project.clone();
        project.volume.path = sequence.paths(first);

        let never = Cancel::never();
        let bar = output::frames_bar(numbers.len());
        bar.set_message("measuring what is held over the range");
        let locked = pool
            .install(|| range::lock(&project, &sequence, &numbers, &never, &|_| {}))
            .map_err(range_failed)?;
        let order = Order {
            project: locked.project.clone(),
            sequence,
            numbers,
            output: self.output.clone(),
            format: self.format,
            assumed: locked.assumed.clone(),
        };
        let mut told = Told::new(self, &order, frames, &bar);
        let progress = |share: f64| output::advance_frame(&bar, share);
        let written = pool.install(|| {
            range::write(&order, &Gate::default(), &never, &progress, &mut |ended| {
                told.take(&ended);
            })
        });
        bar.finish_and_clear();
        let told = told.end();
        if let Some(path) = &self.stats {
            let text = format!("{:#}\n", told.to_json(&locked, frames));
            export::write(path, text.as_bytes()).map_err(|error| {
                CliError::failed(
                    "the pictures were written, their statistics were not",
                    error,
                )
            })?;
        }
        written.map_err(range_failed)?;
        told.judged()
    }

    /// Pictures that cannot be written are not worth the measuring; statistics may take the place of neither a picture nor what
    /// one is made from.
    fn check_targets(&self, sequence: &Sequence, numbers: &[u64]) -> Result<(), CliError> {
        let refused = |error| CliError::failed("nothing was rendered", error);
        let sources: Vec<PathBuf> = numbers
            .iter()
            .flat_map(|&number| sequence.paths(number))
            .collect();
        if let Some(&first) = numbers.first() {
            let first = range::target(&self.output, first, sequence.padding());
            export::check_target(&first, &sources).map_err(refused)?;
        }
        let Some(stats) = &self.stats else {
            return Ok(());
        };
        export::check_target(stats, &sources).map_err(refused)?;
        let target = |&number: &u64| range::target(&self.output, number, sequence.padding());
        let mut targets = numbers.iter().map(target);
        match targets.find(|target| is_same_file(stats, target)) {
            Some(target) => Err(CliError::Usage(format!(
                "--stats {}: the picture of a frame is the same file, {}; choose a name of its own",
                stats.display(),
                target.display()
            ))),
            None => Ok(()),
        }
    }
}

fn range_failed(error: RangeError) -> CliError {
    CliError::failed("the range was not rendered to its end", error)
}

/// What is told of the frames, a line each, and for statistics.
struct Told<'a> {
    render: &'a Render,
    order: &'a Order,
    bar: &'a ProgressBar,
    /// First and last number of each gap that is still to be told.
    gaps: std::iter::Peekable<std::vec::IntoIter<[u64; 2]>>,
    /// A flaw that all frames share is told once.
    flaws: BTreeSet<String>,
    frames: Vec<Value>,
    counts: Counts,
}

#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    rendered: usize,
    kept: usize,
    failed: usize,
}

impl<'a> Told<'a> {
    fn new(render: &'a Render, order: &'a Order, frames: Frames, bar: &'a ProgressBar) -> Self {
        Self {
            render,
            order,
            bar,
            gaps: frames.gaps(&order.sequence).into_iter().peekable(),
            flaws: BTreeSet::new(),
            frames: Vec::new(),
            counts: Counts::default(),
        }
    }

    fn say(&self, words: &str) {
        self.bar.suspend(|| output::say(words));
    }

    /// Tells of the gaps before a frame.
    fn tell_gaps(&mut self, before: Option<u64>) {
        while let Some([first, last]) = self
            .gaps
            .next_if(|[first, _]| before.is_none_or(|number| *first < number))
        {
            let [from, to] = [first, last].map(|end| self.order.sequence.padded(end));
            if first == last {
                self.say(&format!("frame {from}: skipped, there is no such file"));
            } else {
                self.say(&format!(
                    "frames {from} to {to}: skipped, there are no such files"
                ));
            }
        }
    }

    fn take(&mut self, ended: &Ended) {
        self.tell_gaps(Some(ended.number));
        let target = ended.target.display();
        let mut told = json!({ "frame": ended.number, "picture": target.to_string() });
        match &ended.outcome {
            Outcome::Written(made) => {
                self.counts.rendered += 1;
                told["state"] = json!("rendered");
                let stats = self.stats(made);
                if let (Value::Object(told), Value::Object(stats)) = (&mut told, stats) {
                    told.extend(stats);
                }
                let [width, height] = made.frame.film.size();
                let seconds = made.seconds;
                let total = seconds.load + seconds.bake + seconds.render + seconds.write;
                self.say(&format!(
                    "{target}: {width} × {height} pixels in {total:.2} s"
                ));
                for flaw in made.written.flaws.iter() {
                    // Frames differ in the number in their files' names.
                    let number = self.order.sequence.padded(ended.number);
                    if self.flaws.insert(flaw.replace(&number, "#")) {
                        self.say(&format!("  flaw: {flaw}"));
                    }
                }
            }
            Outcome::Kept => {
                self.counts.kept += 1;
                told["state"] = json!("kept");
                self.say(&format!(
                    "{target}: kept, made from the same files and settings"
                ));
            }
            Outcome::Failed(error) => {
                self.counts.failed += 1;
                told["state"] = json!("failed");
                told["reason"] = json!(error.to_string());
                let number = self.order.sequence.padded(ended.number);
                self.bar
                    .suspend(|| output::warn(&format!("frame {number}: skipped, {error}")));
            }
        }
        self.frames.push(told);
        output::next_frame(self.bar, self.frames.len());
    }

    fn stats(&self, made: &Made) -> Value {
        if self.render.stats.is_none() {
            return Value::Null;
        }
        let (still, aim) = (&made.still, &made.aim);
        let stats = Stats {
            seconds: stats::Seconds {
                load: made.seconds.load,
                bake: made.seconds.bake,
                render: made.seconds.render,
                write: made.seconds.write,
            },
            render_cpu_s: made.seconds.render_cpu,
            accuracy: Accuracy::of(aim, still.job.accuracy, &made.frame, false),
            threads: self.render.threads,
            project: &still.project,
            job: &still.job,
            scene: &made.scene,
            frame: &made.frame,
            // What an effect costs is measured for a picture alone: it would take longer than some frames do.
            costs: &[],
            metering: &made.written.metering,
            view: &still.project.view(),
            flaws: &made.written.flaws,
        };
        stats.to_json()
    }

    /// Tells of what comes after the last frame.
    fn end(mut self) -> Summary {
        self.tell_gaps(None);
        Summary {
            counts: self.counts,
            frames: self.frames,
        }
    }
}

/// A whole range.
struct Summary {
    counts: Counts,
    frames: Vec<Value>,
}

impl Summary {
    fn to_json(&self, locked: &Locked, frames: Frames) -> Value {
        json!({
            "range": frames.to_string(),
            "measured_on_frame": locked.measured_on,
            "frames": self.frames,
        })
    }

    /// The last line, and whether all is well.
    fn judged(&self) -> Result<(), CliError> {
        let Counts {
            rendered,
            kept,
            failed,
        } = self.counts;
        let all = rendered + kept + failed;
        output::say(&format!(
            "{all} {}: {rendered} rendered, {kept} kept, {failed} failed",
            if all == 1 { "frame" } else { "frames" }
        ));
        match failed {
            0 => Ok(()),
            _ => Err(CliError::Said(format!(
                "{failed} of {all} frames could not be rendered: mend their files and call again, what is done is kept"
            ))),
        }
    }
}
