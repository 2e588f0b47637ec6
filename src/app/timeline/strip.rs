//! The strip under the picture.

use egui::{
    Checkbox, Color32, DragValue, Frame, Label, Margin, Panel, Response, RichText, Slider, Ui, pos2,
};

use super::{FPS_RANGE, Open, Step};
use crate::app::App;
use crate::app::panels::Command;

/// Width of a mark on the rail, points.
const MARK: f32 = 3.0;
/// Most gaps that are marked: more could not be told apart.
const MOST_GAPS: usize = 500;
/// Space around it, points.
const MARGIN: Margin = Margin::symmetric(12, 4);

/// Draws the strip, if the open file is a frame.
pub(in crate::app) fn strip(ui: &mut Ui, app: &mut App, commands: &mut Vec<Command>) {
    let timeline = &mut app.timeline;
    let Some(open) = &timeline.open else { return };
    let mut ask = |step: Step| commands.push(Command::Step(step));
    let frame = Frame::new()
        .fill(ui.visuals().panel_fill)
        .inner_margin(MARGIN);
    Panel::bottom("timeline")
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            scrub(ui, open, &mut ask);
            ui.horizontal_wrapped(|ui| {
                let button = |ui: &mut Ui, symbol: &str, name: &str, tip: &str| {
                    let button = ui.button(symbol).accessible_name(name);
                    button.on_hover_text(tip).clicked()
                };
                if button(ui, "Previous", "Previous frame", "The frame before (left arrow, or a comma).") {
                    ask(Step::Back);
                }
                let plays = open.due.is_some();
                let [symbol, name] = if plays { ["Pause"; 2] } else { ["Play"; 2] };
                if button(ui, symbol, name, "Play the frames from in to out, or pause (space bar).") {
                    ask(Step::Toggle);
                }
                if button(ui, "Next", "Next frame", "The frame after (right arrow, or a full stop).") {
                    ask(Step::Forth);
                }
                ui.add(Label::new(words(open)).extend());
                let [mut first, mut last] = open.range.ends();
                let [low, high] = open.sequence.ends();
                let number = |ui: &mut Ui, name: &str, tip: &str, value: &mut u64| {
                    ui.label(name);
                    let field = DragValue::new(value).range(low..=high).update_while_editing(false);
                    let field = ui.add(field).accessible_name(name);
                    field.on_hover_text(tip).changed()
                };
                if number(ui, "In", "The first frame that plays and is exported.", &mut first) {
                    ask(Step::In(first));
                }
                if number(ui, "Out", "The last frame that plays and is exported.", &mut last) {
                    ask(Step::Out(last));
                }
                let fps = DragValue::new(&mut timeline.fps)
                    .range(FPS_RANGE[0]..=FPS_RANGE[1])
                    .speed(0.1)
                    .suffix(" fps");
                ui.add(fps).accessible_name("Frames per second").on_hover_text(
                    "How many frames a second are played at most: each stays until the first picture of it is there.",
                );
                ui.add(Checkbox::new(&mut timeline.loops, "Loop"))
                    .on_hover_text("After the last frame the first follows.");
                if let Some((number, reason)) = open.bad.last_key_value() {
                    let words = match open.bad.len() {
                        1 => format!("frame {number} is bad"),
                        count => format!("{count} frames are bad"),
                    };
                    ui.label(RichText::new(words).color(ui.visuals().error_fg_color)).on_hover_text(reason);
                }
            });
        });
}

/// The slider, with marks where frames are missing or bad.
fn scrub(ui: &mut Ui, open: &Open, ask: &mut impl FnMut(Step)) {
    let [low, high] = open.sequence.ends();
    let shown = open.wanted.unwrap_or(open.current);
    let mut number = shown;
    ui.spacing_mut().slider_width = ui.available_width();
    let slider = Slider::new(&mut number, low..=high).show_value(false);
    let slider = ui
        .add(slider)
        .accessible_name("Frame")
        .on_hover_text(format!("{}, of {}", words(open), open.sequence.pattern()));
    if slider.changed() && number != shown {
        ask(Step::To(number));
    }
    let visuals = ui.visuals();
    let (weak, error, warning) = (
        visuals.weak_text_color(),
        visuals.error_fg_color,
        visuals.warn_fg_color,
    );
    let gaps = open.sequence.numbers().zip(open.sequence.numbers().skip(1));
    for (before, after) in gaps
        .filter(|(before, after)| after - before > 1)
        .take(MOST_GAPS)
    {
        mark(ui, &slider, [low, high], [before + 1, after - 1], weak);
    }
    for &number in open.bad.keys() {
        mark(ui, &slider, [low, high], [number; 2], error);
    }
    for end in open.range.ends() {
        mark(ui, &slider, [low, high], [end; 2], warning);
    }
}

/// Marks numbers under the rail.
fn mark(ui: &Ui, slider: &Response, [low, high]: [u64; 2], [from, to]: [u64; 2], colour: Color32) {
    // The handle keeps its own half width from both ends.
    let rail = slider
        .rect
        .shrink2(egui::vec2(slider.rect.height() / 2.5, 0.0));
    let at = |number: u64| {
        let share = (number - low) as f32 / (high - low).max(1) as f32;
        rail.left() + share * rail.width()
    };
    let y = rail.bottom();
    let rect = egui::Rect::from_min_max(
        pos2(at(from) - 0.5 * MARK, y - MARK),
        pos2(at(to) + 0.5 * MARK, y),
    );
    ui.painter().rect_filled(rect, 1.0, colour);
}

/// Which frame is on show.
fn words(open: &Open) -> String {
    let padded = |number| open.sequence.padded(number);
    let [low, high] = open.sequence.ends();
    let mut words = format!("frame {}", padded(open.current));
    if let Some(wanted) = open.wanted {
        words = format!("frame {}…", padded(wanted));
    }
    format!("{words} of {} to {}", padded(low), padded(high))
}
