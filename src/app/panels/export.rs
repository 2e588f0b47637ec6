//! Writing the picture into a file: what to ask for, how far it is, and what became of it.

mod many;
mod size;
mod target;

use egui::{
    Button, Context, DragValue, Grid, Label, ProgressBar, RichText, ScrollArea, TextEdit, Ui,
};

use self::many::ManyRows;
use self::size::Size;
use self::target::Target;
use super::{Command, centred, short};
use crate::app::exporter::{Exactness, Exporter, Outcome, Progress, Wish};
use crate::app::timeline::Timeline;
use crate::app::words::name_of;
use crate::app::{App, Document};
use crate::export::Format;
use crate::render::{MAX_SIDE, Settings};

/// Width of the window's contents in points.
const WIDTH: f32 = 440.0;
/// Height of its title and margins in points, with some to spare.
const BAR: f32 = 70.0;

/// What the window remembers between frames.
#[derive(Debug, Default)]
pub(in crate::app) struct ExportPanel {
    is_open: bool,
    target: Target,
    size: Size,
    exactness: Exactness,
    many: ManyRows,
}

impl ExportPanel {
    /// Opens the window; what became of the last export was read and goes.
    pub(in crate::app) fn open(&mut self, document: &Document, exporter: &mut Exporter) {
        self.is_open = true;
        exporter.dismiss();
        self.target
            .name_after(document.volume().map_or(&[], |volume| &volume.sources));
    }

    /// Whether the window is open.
    pub(in crate::app) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Closes the window, if it is open. True if it was.
    pub(in crate::app) fn close(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Draws the window if it is open. `canvas` is the size of the picture on show in pixels.
    pub(in crate::app) fn show(
        &mut self,
        ctx: &Context,
        document: &Document,
        (exporter, timeline): (&Exporter, &Timeline),
        canvas: [u32; 2],
        commands: &mut Vec<Command>,
    ) {
        if !self.is_open {
            return;
        }
        let whole = ctx.content_rect();
        centred(ctx, "Export").show(ctx, |ui| {
            ScrollArea::vertical()
                .max_height(whole.height() - BAR)
                .show(ui, |ui| {
                    ui.set_width(WIDTH.min(whole.width() - 40.0));
                    self.contents(ui, document, (exporter, timeline), canvas, commands);
                });
        });
    }

    fn contents(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        (exporter, timeline): (&Exporter, &Timeline),
        canvas: [u32; 2],
        commands: &mut Vec<Command>,
    ) {
        Grid::new("export").num_columns(2).show(ui, |ui| {
            self.file(ui);
            ui.end_row();
            self.format(ui);
            ui.end_row();
            self.sides(ui, canvas);
            ui.end_row();
            self.quality(ui);
            ui.end_row();
        });
        ui.label(RichText::new(self.target.whereabouts()).small().weak());
        if let Some(words) = self.target.problem() {
            warn(ui, words);
        }
        let size = self.size.of(canvas);
        let settings = self.exactness.of(&document.project).settings(size);
        match &settings {
            Ok(settings) => drop(ui.label(meaning(settings))),
            Err(error) => warn(ui, &error.to_string()),
        }
        if let Some(words) = size::beside(size, canvas) {
            ui.label(words);
        }
        ui.separator();
        if let Some((_, progress)) = exporter.running() {
            ui.add(ProgressBar::new(progress.share as f32).text(words_of(progress)))
                .on_hover_text("How much of the picture is rendered.");
        }
        let wish = match (self.target.file(), settings.is_ok()) {
            (Some((path, format)), true) => Some(Wish {
                path,
                format,
                size,
                exactness: self.exactness,
            }),
            _ => None,
        };
        if exporter.running().is_none() {
            self.many.show(ui, timeline, wish.as_ref(), commands);
        }
        self.buttons(ui, exporter, wish, commands);
        if let Some(outcome) = exporter.last() {
            tell(ui, Label::new, outcome);
        }
    }

    fn file(&mut self, ui: &mut Ui) {
        self.target.receive();
        let name = ui.label("File");
        ui.horizontal(|ui| {
            let width = ui.available_width() - 90.0;
            let field = TextEdit::singleline(&mut self.target.text).desired_width(width);
            ui.add(field)
                .labelled_by(name.id)
                .on_hover_text(self.target.whereabouts());
            let choose = ui
                .button("Choose…")
                .on_hover_text("Choose a folder and a name with the desktop's dialog.");
            if choose.clicked() {
                self.target.ask(ui.ctx());
            }
        });
    }

    fn format(&mut self, ui: &mut Ui) {
        ui.label("Format");
        ui.horizontal(|ui| {
            for format in Format::ALL {
                let chosen = self.target.format() == Some(format);
                let tip = match format {
                    Format::Png(_) => "The picture as it looks, with exposure and adaptation.",
                    Format::Exr => {
                        "The light itself in cd/m², with transmittance: for compositing. Exposure and adaptation are \
                         not in it."
                    }
                };
                let button = ui.selectable_label(chosen, format.name());
                if button.on_hover_text(tip).clicked() {
                    self.target.set_format(format);
                }
            }
        });
    }

    fn sides(&mut self, ui: &mut Ui, canvas: [u32; 2]) {
        ui.label("Size");
        ui.horizontal(|ui| {
            for (axis, name) in ["Width", "Height"].into_iter().enumerate() {
                let mut side = self.size.of(canvas)[axis];
                let number = DragValue::new(&mut side)
                    .range(1..=MAX_SIDE)
                    .update_while_editing(false);
                let number = ui.add(number).accessible_name(name);
                if number.on_hover_text(format!("{name} in pixels.")).changed() {
                    self.size.set_side(axis, side, canvas);
                }
                ui.label(["×", "pixels"][axis]);
            }
            let mut keeps = self.size.keeps_shape();
            let keep = ui.checkbox(&mut keeps, "Keep shape");
            if keep
                .on_hover_text("When a side is changed, the other follows.")
                .changed()
            {
                self.size.keep_shape(keeps, canvas);
            }
        });
        ui.end_row();
        ui.label("");
        ui.horizontal_wrapped(|ui| {
            for (words, size) in size::presets(canvas) {
                if ui.button(words).clicked() {
                    self.size.set(size);
                }
            }
        });
    }

    fn quality(&mut self, ui: &mut Ui) {
        ui.label("Quality");
        ui.horizontal(|ui| {
            for (exactness, words) in [
                (Exactness::Final, "Final quality"),
                (Exactness::AsSeen, "As I see it"),
            ] {
                ui.radio_value(&mut self.exactness, exactness, words);
            }
        });
    }

    fn buttons(
        &mut self,
        ui: &mut Ui,
        exporter: &Exporter,
        wish: Option<Wish>,
        commands: &mut Vec<Command>,
    ) {
        let runs = exporter.running().is_some();
        let existing = self.target.existing(runs);
        ui.horizontal(|ui| {
            if runs {
                many::pause(ui, exporter, commands);
                if ui.button("Cancel").clicked() {
                    commands.push(Command::CancelExport);
                }
            } else {
                let words = if existing.is_some() {
                    "Replace"
                } else {
                    "Export"
                };
                let button = ui.add_enabled(wish.is_some(), Button::new(words));
                if let (true, Some(wish)) = (button.clicked(), wish) {
                    commands.push(Command::Export(wish));
                }
            }
            self.is_open &= !ui.button("Close").on_hover_text("Key: Esc").clicked();
            // What was just written needs no warning.
            let told = runs || exporter.last().is_some();
            if let (Some(name), false) = (existing, told) {
                ui.add(
                    Label::new(
                        RichText::new(format!("{name} exists")).color(ui.visuals().warn_fg_color),
                    )
                    .truncate(),
                );
            }
        });
    }
}

/// One short line on the export that runs or has ended, while its window is closed.
pub(in crate::app) fn line(ui: &mut Ui, app: &App, commands: &mut Vec<Command>) {
    if app.panels.export.is_open {
        return;
    }
    if let Some((path, progress)) = app.exporter.running() {
        let words = format!("{} {}", name_of(path), words_of(progress));
        if ui.small_button("Cancel export").clicked() {
            commands.push(Command::CancelExport);
        }
        ui.add(Label::new(words).truncate());
    } else if let Some(outcome) = app.exporter.last() {
        let tip = "Takes these words away.";
        if ui.small_button("OK").on_hover_text(tip).clicked() {
            commands.push(Command::ForgetExport);
        }
        tell(ui, |text| Label::new(text).truncate(), outcome);
    }
}

fn warn(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).color(ui.visuals().warn_fg_color));
}

/// The numbers that a picture is rendered with, in words.
fn meaning(settings: &Settings) -> String {
    let counted = |number: f64, unit: &str| {
        let plural = if number == 1.0 { "" } else { "s" };
        format!("{} {unit}{plural}", short(number))
    };
    format!(
        "Steps of {}, {} wavelengths, {} for each pixel. Camera and brightness as in the window.",
        counted(settings.step_voxels, "voxel"),
        settings.wavelengths.count(),
        counted(f64::from(settings.samples_per_pixel), "ray"),
    )
}

/// How far an export is.
fn words_of(progress: Progress) -> String {
    let Progress {
        share,
        preparing,
        elapsed,
    } = progress;
    if let Some(preparing) = preparing {
        return format!("light from all sides, {:.0} %", 100.0 * preparing);
    }
    if share >= 1.0 {
        return "100 %, writing".to_owned();
    }
    let percent = (100.0 * share).floor();
    // The first tiles are those in the middle, which take longest: they tell too little.
    if share < 0.02 {
        return format!("{percent:.0} %");
    }
    let left = elapsed.as_secs_f64() * (1.0 - share) / share;
    let minutes = (left / 60.0).floor();
    if minutes >= 1.0 {
        format!("{percent:.0} %, {minutes:.0} min left")
    } else {
        format!("{percent:.0} %, {:.0} s left", left.ceil())
    }
}

/// What became of an export, with everything else that is to be said of it under the pointer.
fn tell(ui: &mut Ui, label: impl FnOnce(RichText) -> Label, outcome: &Outcome) {
    let mut text = RichText::new(outcome.in_words());
    if !outcome.went_well() {
        let visuals = ui.visuals();
        text = text.color(match outcome {
            Outcome::Failed(_) => visuals.error_fg_color,
            _ => visuals.warn_fg_color,
        });
    }
    ui.add(label(text)).on_hover_text(outcome.in_full());
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn time_left_is_told_once_there_is_something_to_tell_it_from() {
        let told = |share, seconds| {
            words_of(Progress {
                share,
                preparing: None,
                elapsed: Duration::from_secs(seconds),
            })
        };
        assert_eq!(told(0.019, 1), "1 %");
        assert_eq!(told(0.25, 1), "25 %, 3 s left");
        assert_eq!(told(0.5, 130), "50 %, 2 min left");
        assert_eq!(told(0.9999, 10), "99 %, 1 s left");
        assert_eq!(told(1.0, 1), "100 %, writing");
        let before_the_rays = Progress {
            share: 0.0,
            preparing: Some(0.5),
            elapsed: Duration::ZERO,
        };
        assert_eq!(words_of(before_the_rays), "light from all sides, 50 %");
    }
}
