//! `sootlight render --frames A-B` and `--turntable N`: a range of a sequence, or one fire from all around, picture by picture.

use std::collections::{BTreeSet, VecDeque};
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
use crate::range::{self, Ended, Locked, Made, Order, Outcome, RangeError, Shots};
use crate::render::{Cancel, Gate};
use crate::sequence::{Frames, Sequence};

/// The pictures that were asked for.
struct Asked {
    shots: Shots,
    /// What one of them is called.
    noun: &'static str,
    /// All of them in words, for statistics.
    words: String,
    /// The first number of each gap, with what is said of it before the next picture.
    gaps: VecDeque<(u64, String)>,
}

impl Asked {
    fn frames(frames: Frames, sequence: &Sequence) -> Result<Self, CliError> {
        let numbers = frames.of(sequence);
        if numbers.is_empty() {
            let [from, to] = sequence.ends().map(|end| sequence.padded(end));
            return Err(CliError::Said(format!(
                "no frame of {frames} is there: {} has frames from {from} to {to}",
                sequence.pattern()
            )));
        }
        let gap = |[first, last]: [u64; 2]| {
            let [from, to] = [first, last].map(|end| sequence.padded(end));
            let words = if first == last {
                format!("frame {from}: skipped, there is no such file")
            } else {
                format!("frames {from} to {to}: skipped, there are no such files")
            };
            (first, words)
        };
        Ok(Self {
            shots: Shots::frames(sequence, &numbers),
            noun: "frame",
            words: frames.to_string(),
            gaps: frames.gaps(sequence).into_iter().map(gap).collect(),
        })
    }

    fn turntable(views: u32, paths: &[PathBuf]) -> Self {
        Self {
            shots: Shots::turntable(paths, views),
            noun: "view",
            words: format!("turntable of {views} views"),
            gaps: VecDeque::new(),
        }
    }
}

impl Render {
    /// Renders these frames. What is bad is told, and the rest goes on.
    pub(super) fn run_frames(&self, frames: Frames) -> Result<(), CliError> {
        let sequence = Sequence::of_all(&self.project.volume.path)
            .map_err(|error| CliError::failed("there is no sequence to render", error))?;
        let asked = Asked::frames(frames, &sequence)?;
        for words in sequence.notes() {
            output::say(&format!("note: {words}"));
        }
        self.run_range(asked)
    }

    /// Renders so many views from all around.
    pub(super) fn run_turntable(&self, views: u32) -> Result<(), CliError> {
        self.run_range(Asked::turntable(views, &self.project.volume.path))
    }

    fn run_range(&self, asked: Asked) -> Result<(), CliError> {
        self.check_targets(&asked)?;
        let pool = pool(self.threads)?;
        let mut project = self.project.clone();
        if let Some(first) = asked.shots.iter().next() {
            project.volume.path.clone_from(&first.paths);
        }

        let never = Cancel::never();
        let bar = output::frames_bar(asked.shots.len());
        bar.set_message("measuring what is held over the range");
        let locked = pool
            .install(|| range::lock(&project, &asked.shots, &never, &|_| {}))
            .map_err(range_failed)?;
        let order = Order {
            project: locked.project.clone(),
            shots: asked.shots.clone(),
            output: self.output.clone(),
            format: self.format,
            assumed: locked.assumed.clone(),
        };
        let words = asked.words.clone();
        let mut told = Told::new(self, asked, &bar);
        let progress = |share: f64| output::advance_frame(&bar, share);
        let written = pool.install(|| {
            range::write(&order, &Gate::default(), &never, &progress, &mut |ended| {
                told.take(&ended);
            })
        });
        bar.finish_and_clear();
        let told = told.end();
        if let Some(path) = &self.stats {
            let text = format!("{:#}\n", told.to_json(&locked, &words));
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
    fn check_targets(&self, asked: &Asked) -> Result<(), CliError> {
        let Asked { shots, noun, .. } = asked;
        let refused = |error| CliError::failed("nothing was rendered", error);
        let sources: Vec<PathBuf> = shots.iter().flat_map(|shot| shot.paths.clone()).collect();
        let mut targets = shots.targets(&self.output);
        if let Some(first) = targets.next() {
            export::check_target(&first, &sources).map_err(refused)?;
        }
        let Some(stats) = &self.stats else {
            return Ok(());
        };
        export::check_target(stats, &sources).map_err(refused)?;
        let mut targets = shots.targets(&self.output);
        match targets.find(|target| is_same_file(stats, target)) {
            Some(target) => Err(CliError::Usage(format!(
                "--stats {}: the picture of a {noun} is the same file, {}; choose a name of its own",
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
    /// Whose gaps are those that are still to be told.
    asked: Asked,
    bar: &'a ProgressBar,
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
    fn new(render: &'a Render, asked: Asked, bar: &'a ProgressBar) -> Self {
        Self {
            render,
            asked,
            bar,
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
        let is_before = |&mut (first, _): &mut (u64, String)| before.is_none_or(|it| first < it);
        while let Some((_, words)) = self.asked.gaps.pop_front_if(is_before) {
            self.say(&words);
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
                    let number = self.asked.shots.padded(ended.number);
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
                let (noun, number) = (self.asked.noun, self.asked.shots.padded(ended.number));
                self.bar
                    .suspend(|| output::warn(&format!("{noun} {number}: skipped, {error}")));
            }
        }
        self.frames.push(told);
        output::next_frame(self.bar, self.frames.len(), self.asked.noun);
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
            noun: self.asked.noun,
            counts: self.counts,
            frames: self.frames,
        }
    }
}

/// A whole range.
struct Summary {
    noun: &'static str,
    counts: Counts,
    frames: Vec<Value>,
}

impl Summary {
    fn to_json(&self, locked: &Locked, range: &str) -> Value {
        json!({
            "range": range,
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
        let (noun, plural) = (self.noun, if all == 1 { "" } else { "s" });
        output::say(&format!(
            "{all} {noun}{plural}: {rendered} rendered, {kept} kept, {failed} failed"
        ));
        match failed {
            0 => Ok(()),
            _ => Err(CliError::Said(format!(
                "{failed} of {all} {noun}s could not be rendered: mend their files and call again, what is done is kept"
            ))),
        }
    }
}
