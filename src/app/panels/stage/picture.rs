//! The picture on the backdrop: a path that is typed or chosen.

use std::path::{Path, PathBuf};

use egui::{Key, RichText, TextEdit, Ui};
use rfd::FileDialog;

use crate::app::files::{Asked, paths_of};
use crate::app::panels::knob::name;

/// The field, with what is typed but not yet entered.
#[derive(Debug, Default)]
pub(super) struct PicturePath {
    text: String,
    /// The path that the field was filled with.
    shown: Option<PathBuf>,
    dialog: Asked,
}

impl PicturePath {
    /// Draws the field and its button.
    pub(super) fn show(&mut self, ui: &mut Ui, picture: &mut Option<PathBuf>) {
        if let Some(chosen) = self.dialog.answered() {
            *picture = Some(chosen);
        }
        // An undo or a dropped file changes the path from outside.
        if self.shown != *picture {
            self.shown.clone_from(picture);
            let text = picture.as_deref().map(Path::display);
            self.text = text.map_or_else(String::new, |text| text.to_string());
        }
        ui.horizontal(|ui| {
            let tip = "The picture on the backdrop: a PNG file. Type its path and Enter, choose it, or drop it on the \
                       window. Double-click the name: none.";
            let name = name(ui, "PNG file", tip);
            if ui.button("Choose…").on_hover_text(tip).clicked() {
                let dialog = FileDialog::new()
                    .set_title("A picture behind the fire")
                    .add_filter("PNG pictures", &["png"]);
                self.dialog.ask(dialog, FileDialog::pick_file, None, ui.ctx());
            }
            let field = TextEdit::singleline(&mut self.text)
                .hint_text("a path, then Enter")
                .desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(name.id).on_hover_text(tip);
            if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                *picture = paths_of(&self.text).into_iter().next();
            }
            if name.double_clicked() {
                *picture = None;
            }
        });
        if self.dialog.has_none() {
            let words = "This desktop offers no file dialog: type a path.";
            ui.label(
                RichText::new(words)
                    .small()
                    .color(ui.visuals().warn_fg_color),
            );
        }
    }
}
