//! The controls. A panel changes the document's plain data; what it cannot do itself it asks for with a
//! [`Command`], which is obeyed once every panel is drawn.

mod export;
mod file;
mod fire;
mod overlay;
mod quality;
mod status;
mod view;

use std::path::PathBuf;

use egui::{
    DragValue, Frame, Label, Panel, Response, RichText, ScrollArea, Slider, SliderClamping, Ui,
};

pub(super) use overlay::overlay;
pub(super) use status::status;

use super::Document;
use super::exporter::Wish;

/// What a panel cannot do itself.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Ask for files with the desktop's dialog.
    Ask,
    /// Open these files.
    Open(Vec<PathBuf>),
    /// Measure exposure and white on the present picture.
    Meter,
    /// Take the notice away.
    Dismiss,
    /// Show the window that asks for an export.
    OpenExport,
    /// Export this.
    Export(Wish),
    /// Stop exporting.
    CancelExport,
}

/// Width of the panel in points, scroll bar included.
const WIDTH: f32 = 312.0;
/// Space around the controls.
const MARGIN: i8 = 14;

/// The panel at the right, with what is typed but not yet entered.
#[derive(Debug, Default)]
pub(super) struct Panels {
    pub(super) file: file::FilePanel,
    pub(super) export: export::ExportPanel,
}

impl Panels {
    /// Draws every section.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        document: &mut Document,
        flaws: &[String],
        commands: &mut Vec<Command>,
    ) {
        let frame = Frame::new().fill(ui.visuals().panel_fill);
        Panel::right("controls")
            .resizable(false)
            .exact_size(WIDTH)
            .frame(frame)
            .show(ui, |ui| {
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    Frame::new().inner_margin(MARGIN).show(ui, |ui| {
                        self.file.show(ui, document, commands);
                        fire::show(ui, &mut document.project);
                        view::show(ui, &mut document.project, commands);
                        quality::show(ui, &mut document.project);
                        file::findings(ui, document);
                        file::flaws(ui, flaws);
                    });
                });
            });
    }
}

/// The headline of a section.
fn headline(ui: &mut Ui, title: &str) {
    ui.add_space(14.0);
    ui.label(RichText::new(title).strong());
    ui.separator();
}

/// A number to be set: name and value above, slider below; a double click sets the default.
struct Knob<'a> {
    label: &'a str,
    unit: &'a str,
    range: [f64; 2],
    logarithmic: bool,
    default: f64,
    /// What it does to the fire, and why.
    tip: &'a str,
}

impl Knob<'_> {
    /// Draws it. True if the value was changed; it stays within the range unless it came from outside.
    fn show(&self, ui: &mut Ui, value: &mut f64) -> bool {
        let old = *value;
        let [low, high] = self.range;
        let tip = format!(
            "{} Double-click: back to {}{}.",
            self.tip,
            short(self.default),
            self.unit
        );
        let number = |value| {
            DragValue::new(value)
                .range(low..=high)
                .clamp_existing_to_range(false)
                .speed(0.004 * (high - low))
                .min_decimals(2)
                .max_decimals(2)
                .suffix(self.unit)
        };
        let name = ui
            .horizontal(|ui| {
                let name = ui
                    .add(Label::new(self.label).selectable(false))
                    .on_hover_text(&tip);
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    ui.add(number(value)).labelled_by(name.id);
                });
                name
            })
            .inner;
        ui.spacing_mut().slider_width = ui.available_width();
        let slider = Slider::new(value, low..=high)
            .logarithmic(self.logarithmic)
            .clamping(SliderClamping::Edits)
            .show_value(false);
        let slider = ui.add(slider).labelled_by(name.id).on_hover_text(&tip);
        ui.add_space(5.0);
        let double_clicked = |on: &Response| {
            on.contains_pointer()
                && ui.input(|input| {
                    input
                        .pointer
                        .button_double_clicked(egui::PointerButton::Primary)
                })
        };
        if double_clicked(&slider) || double_clicked(&name) {
            *value = self.default;
        }
        *value != old
    }
}

/// A number in as few characters as tell it.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 5) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short_and_keep_their_meaning() {
        let told = [0.0, 1.0, 1950.0, 0.25, -2.5, 3.0e-6, 123_456.0, 0.001_234].map(short);
        assert_eq!(
            told,
            [
                "0", "1", "1950", "0.25", "-2.5", "3.00e-6", "1.23e5", "0.00123"
            ]
        );
    }
}
