//! The two streams: answers go to standard output, errors and progress to standard error. A stream that nobody
//! reads any more is no error: `sootlight info fire.vdb | head` is a fair question.

use std::error::Error;
use std::fmt;
use std::io::{self, IsTerminal as _, Write as _};
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use crate::render::preparation::Preparation;

/// Writes lines to standard output.
pub(super) fn say(text: &str) {
    let _ = writeln!(io::stdout().lock(), "{text}");
}

/// Writes an error with everything that caused it.
pub(super) fn error(error: &dyn Error) {
    let mut stream = io::stderr().lock();
    let mut said = error.to_string();
    let _ = writeln!(stream, "error: {said}");
    let mut cause = error.source();
    while let Some(error) = cause {
        let words = error.to_string();
        // Some errors quote their cause: once is enough.
        if !said.ends_with(&words) {
            let _ = writeln!(stream, "  caused by: {words}");
            said = words;
        }
        cause = error.source();
    }
}

/// Writes one line about something that is passed over to standard error.
pub(super) fn warn(words: &str) {
    let _ = writeln!(io::stderr().lock(), "{words}");
}

/// Steps of a progress bar: a tenth of a percent.
const STEPS: f64 = 1000.0;

/// How often its time is drawn anew.
const TICK: Duration = Duration::from_millis(250);

/// A bar on a terminal, nothing in a pipe. While light is worked out before the first rays, it tells how far that is.
pub(super) fn progress_bar(preparation: &Preparation) -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(STEPS as u64);
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed}, {rest}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let preparation = preparation.clone();
    let rest = move |state: &ProgressState, line: &mut dyn fmt::Write| {
        let _ = match preparation.share() {
            Some(share) => {
                line.write_fmt(format_args!("light from all sides {:.0} %", 100.0 * share))
            }
            None => line.write_fmt(format_args!("{} to go", HumanDuration(state.eta()))),
        };
    };
    bar.enable_steady_tick(TICK);
    bar.with_style(style.with_key("rest", rest))
}

/// A bar for so many pictures, with a message, on a terminal; nothing in a pipe.
pub(super) fn frames_bar(frames: usize) -> ProgressBar {
    let bar = progress_bar(&Preparation::default());
    bar.set_length(frames as u64 * STEPS as u64);
    let style = ProgressStyle::with_template("{bar:40} {msg}  {elapsed}, {eta} to go");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Moves a bar of frames to a share between 0 and 1 of the frame in hand.
pub(super) fn advance_frame(bar: &ProgressBar, share: f64) {
    let (position, steps) = (bar.position(), STEPS as u64);
    let within = (share * STEPS) as u64;
    // The last step is the frame's end.
    let position = position.max(position / steps * steps + within.min(steps - 1));
    bar.set_position(position);
}

/// Moves a bar of frames to where so many are done with.
pub(super) fn next_frame(bar: &ProgressBar, done: usize, noun: &str) {
    let frames = bar.length().unwrap_or(0) / STEPS as u64;
    bar.set_position(done as u64 * STEPS as u64);
    bar.set_message(format!("{done} of {frames} {noun}s"));
}

/// Moves a bar to a share between 0 and 1, never back: workers report in any order.
pub(super) fn advance(bar: &ProgressBar, share: f64) {
    let position = (share * STEPS) as u64;
    if position > bar.position() {
        bar.set_position(position);
    }
}
