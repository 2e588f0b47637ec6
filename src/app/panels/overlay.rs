//! What lies over the picture: what its colours mean, what went wrong, and where dropped files will land.

use egui::{
    Align2, Area, Color32, FontId, Frame, Id, LayerId, Modal, Order, Rect, RichText, Stroke,
    StrokeKind, Ui, vec2,
};

use super::Command;
use super::legend::{self, Legend};
use crate::app::App;
use crate::app::closing::{Close, Closing};
use crate::app::opening::is_picture;
use crate::project::Darkness;

/// Height of a line of the drop target in points.
const LINE: f32 = 30.0;
/// Widest note in points.
const NOTE_WIDTH: f32 = 520.0;

/// Draws the legend of the colours on show, notes in the corner of the picture, and the drop target while files hover.
pub(in crate::app) fn overlay(ui: &mut Ui, app: &App, canvas: Rect, commands: &mut Vec<Command>) {
    let flipped = app.snapshots.flipped();
    let of_map = app.maps.legend(&app.picture);
    let of_map = of_map.filter(|_| flipped.is_none());
    let of_map = of_map.map(|(title, rows)| Legend {
        title: Some(title),
        rows,
    });
    let view = flipped.map_or(app.view(), |snapshot| snapshot.view);
    let of_light = view.false_colour && app.document.metering.is_some();
    if let Some(legend) = of_map.or_else(|| of_light.then(|| Legend::of(&view))) {
        legend::show(ui, &legend, canvas);
    }
    notes(ui, app, canvas, commands);
    match app.closing {
        Closing::AskedExporting => ask_before_closing(
            ui,
            "An export is running. If the window closes now, nothing will be written.",
            [
                ("Close when it is done", Command::Close(Close::AfterExport)),
                ("Stop it and close", Command::Close(Close::StopExport)),
                ("Go on working", Command::Close(Close::Not)),
            ],
            commands,
        ),
        Closing::AskedUnsaved => ask_before_closing(
            ui,
            "What is set is in no file. If the window closes now, it is lost.",
            [
                ("Save and close", Command::Close(Close::AfterSave)),
                ("Close without saving", Command::Close(Close::Now)),
                ("Go on working", Command::Close(Close::Not)),
            ],
            commands,
        ),
        Closing::No | Closing::AfterSave | Closing::AfterExport | Closing::Now => {}
    }
    let hovering = ui.input(|input| input.raw.hovered_files.clone());
    if !hovering.is_empty() {
        let picture = match hovering.as_slice() {
            [file] => file.path.as_deref().is_some_and(is_picture),
            _ => false,
        };
        let words = if picture && app.document.volume().is_some() {
            "Drop to put it behind the fire"
        } else {
            "Drop to open"
        };
        drop_target(ui, words, &hovering);
    }
}

/// The window is to be closed while something would be lost with it.
fn ask_before_closing(
    ui: &Ui,
    words: &str,
    answers: [(&str, Command); 3],
    commands: &mut Vec<Command>,
) {
    Modal::new(Id::unique("closing")).show(ui.ctx(), |ui| {
        ui.set_width(NOTE_WIDTH.min(0.8 * ui.ctx().content_rect().width()));
        ui.label(words);
        ui.add_space(8.0);
        ui.horizontal_wrapped(|ui| {
            for (label, command) in answers {
                if ui.button(label).clicked() {
                    commands.push(command);
                }
            }
        });
    });
}

/// Something to tell over the picture, and what can be done about it.
struct Note {
    words: String,
    remedies: Vec<(String, Command)>,
}

impl Note {
    fn plain(words: &str) -> Self {
        Self {
            words: words.to_owned(),
            remedies: Vec::new(),
        }
    }
}

fn all_notes(app: &App) -> Vec<Note> {
    let mut notes = Vec::new();
    notes.extend(app.autosave.offer().map(|words| Note {
        words,
        remedies: vec![
            ("Restore what was open".to_owned(), Command::Restore),
            ("Forget it".to_owned(), Command::ForgetSession),
        ],
    }));
    notes.extend(app.notice().map(|words| Note {
        words: words.to_owned(),
        remedies: vec![("Dismiss".to_owned(), Command::Dismiss)],
    }));
    notes.extend(app.document.problem().map(Note::plain));
    notes.extend(app.picture.progress.failure.as_deref().map(Note::plain));
    notes.extend(app.meter.flaws().iter().map(Note::plain));
    let job = app.generation().filter(|_| app.shows_newest());
    if job.is_some_and(|job| app.meter.is_black(job)) {
        notes.extend(app.job().map(|job| {
            let darkness = Darkness::of(job);
            let remedies = darkness.mend.into_iter();
            Note {
                words: darkness.words,
                remedies: remedies
                    .map(|mend| (mend.label(), Command::Mend(mend)))
                    .collect(),
            }
        }));
    } else if app.shows_newest() && app.meter.is_underexposed(&app.view()) {
        notes.push(Note {
            words: "the picture is black at this exposure".to_owned(),
            remedies: vec![("Expose it automatically".to_owned(), Command::AutoExposure)],
        });
    }
    notes
}

fn notes(ui: &mut Ui, app: &App, canvas: Rect, commands: &mut Vec<Command>) {
    let notes = all_notes(app);
    if notes.is_empty() {
        return;
    }
    Area::new(Id::unique("notes"))
        .order(Order::Foreground)
        .fixed_pos(canvas.min + vec2(12.0, 12.0))
        .show(ui.ctx(), |ui| {
            ui.set_max_width(NOTE_WIDTH.min(canvas.width() - 24.0));
            for note in notes {
                Frame::popup(ui.style())
                    .stroke(Stroke::new(1.0, ui.visuals().error_fg_color))
                    .show(ui, |ui| {
                        ui.label(RichText::new(note.words).strong());
                        ui.horizontal_wrapped(|ui| {
                            for (label, command) in note.remedies {
                                if ui.button(label).clicked() {
                                    commands.push(command);
                                }
                            }
                        });
                    });
            }
        });
}

fn drop_target(ui: &Ui, words: &str, hovering: &[egui::HoveredFile]) {
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
    let lines = std::iter::once(words).chain(names.iter().map(String::as_str));
    let middle = window.center() - vec2(0.0, 0.5 * LINE * names.len() as f32);
    for (i, line) in lines.enumerate() {
        let (at, font) = (
            middle + vec2(0.0, LINE * i as f32),
            FontId::proportional(20.0),
        );
        painter.text(at, Align2::CENTER_CENTER, line, font, Color32::WHITE);
    }
}
