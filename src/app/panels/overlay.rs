//! What lies over the picture: what went wrong, and where dropped files will land.

use egui::{
    Align2, Area, Color32, FontId, Frame, Id, LayerId, Order, RichText, Stroke, StrokeKind, Ui,
    vec2,
};

use super::Command;
use crate::app::App;
use crate::app::theme::ERROR;

/// Height of a line of the drop target in points.
const LINE: f32 = 30.0;
/// Widest note in points.
const NOTE_WIDTH: f32 = 520.0;

/// Draws notes in the corner of the picture, and the drop target while files hover.
pub(in crate::app) fn overlay(ui: &mut Ui, app: &App, commands: &mut Vec<Command>) {
    notes(ui, app, commands);
    let hovering = ui.input(|input| input.raw.hovered_files.clone());
    if !hovering.is_empty() {
        drop_target(ui, &hovering);
    }
}

fn notes(ui: &mut Ui, app: &App, commands: &mut Vec<Command>) {
    let failure = app.picture.progress.failure.as_deref();
    let notes: Vec<(&str, bool)> = [
        (app.notice(), true),
        (app.document.problem(), false),
        (failure, false),
    ]
    .into_iter()
    .filter_map(|(words, dismissible)| Some((words?, dismissible)))
    .chain(app.meter.flaws().iter().map(|words| (words, false)))
    .collect();
    if notes.is_empty() {
        return;
    }
    let corner = ui.max_rect().min + vec2(12.0, 12.0);
    Area::new(Id::unique("notes"))
        .order(Order::Foreground)
        .fixed_pos(corner)
        .show(ui.ctx(), |ui| {
            ui.set_max_width(NOTE_WIDTH.min(ui.ctx().content_rect().width() - 360.0));
            for (words, dismissible) in notes {
                Frame::popup(ui.style())
                    .stroke(Stroke::new(1.0, ERROR))
                    .show(ui, |ui| {
                        ui.label(RichText::new(words).color(Color32::from_gray(225)));
                        if dismissible && ui.button("Dismiss").clicked() {
                            commands.push(Command::Dismiss);
                        }
                    });
            }
        });
}

fn drop_target(ui: &Ui, hovering: &[egui::HoveredFile]) {
    let names: Vec<String> = hovering
        .iter()
        .filter_map(|file| {
            Some(
                file.path
                    .as_ref()?
                    .file_name()?
                    .to_string_lossy()
                    .into_owned(),
            )
        })
        .collect();
    let painter = ui
        .ctx()
        .layer_painter(LayerId::new(Order::Tooltip, Id::unique("drop")));
    let window = ui.ctx().content_rect();
    painter.rect_filled(window, 0.0, Color32::from_black_alpha(170));
    let stroke = Stroke::new(2.0, Color32::from_gray(220));
    painter.rect_stroke(window.shrink(12.0), 6.0, stroke, StrokeKind::Inside);
    let lines = std::iter::once("Drop to open").chain(names.iter().map(String::as_str));
    let middle = window.center() - vec2(0.0, 0.5 * LINE * names.len() as f32);
    for (i, line) in lines.enumerate() {
        let (at, font) = (
            middle + vec2(0.0, LINE * i as f32),
            FontId::proportional(20.0),
        );
        painter.text(at, Align2::CENTER_CENTER, line, font, Color32::WHITE);
    }
}
