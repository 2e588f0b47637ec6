//! All frames from in to out, from the window that asks for an export.

use egui::{Label, RichText, Ui};

use super::{Command, target};
use crate::app::exporter::{Counts, Exporter, Wish, numbered};
use crate::app::theme::WARNING;
use crate::app::timeline::Timeline;
use crate::range;

/// The button that begins a range, where the open file is a frame; and that which pauses one that runs.
pub(super) fn buttons(
    ui: &mut Ui,
    exporter: &Exporter,
    timeline: &Timeline,
    wish: Option<&Wish>,
    commands: &mut Vec<Command>,
) {
    if exporter.running().is_some() {
        let (words, pauses) = match exporter.pauses() {
            None => return,
            Some(false) => ("Pause export", true),
            Some(true) => ("Go on exporting", false),
        };
        let tip = "The frame in hand is finished first.";
        if ui.button(words).on_hover_text(tip).clicked() {
            commands.push(Command::PauseExport(pauses));
        }
        return;
    }
    let Some(playing) = timeline.playing() else {
        return;
    };
    let [Some(first), Some(last)] = [playing.numbers.first(), playing.numbers.last()] else {
        return;
    };
    let button = ui.add_enabled(wish.is_some(), egui::Button::new("Export range"));
    let Some(wish) = wish else { return };
    let output = numbered(&wish.path, &playing.sequence.padded(playing.current));
    let padding = playing.sequence.padding();
    let [from, to] =
        [first, last].map(|&number| target::name_of(&range::target(&output, number, padding)));
    let count = playing.numbers.len();
    let button = button.on_hover_text(format!(
        "Writes the {count} frames from in to out, {from} to {to}. Those that are there, made from the same files and \
         settings, are kept: a range that was stopped goes on."
    ));
    if button.clicked() {
        commands.push(Command::ExportRange(wish.clone()));
    }
}

/// What became of a range.
pub(super) fn tell(
    ui: &mut Ui,
    label: impl FnOnce(RichText) -> Label,
    counts: &Counts,
    seconds: f64,
    more: &str,
) {
    let Counts {
        written,
        kept,
        failed,
    } = counts;
    let mut words = format!("{written} frames written, {kept} kept, {seconds:.1} s");
    let mut text = RichText::new(&words);
    let mut more = more.to_owned();
    if !failed.is_empty() {
        words = format!("{words}, {} failed", failed.len());
        text = RichText::new(&words).color(WARNING);
        for reason in failed {
            more = format!("{more}\n• {reason}");
        }
    }
    ui.add(label(text)).on_hover_text(more);
}
