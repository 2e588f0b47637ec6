//! The picture on the backdrop: a path that is typed or chosen.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use egui::{Context, Key, RichText, TextEdit, Ui};

use crate::app::files::{Answer, answer, paths_of};
use crate::app::panels::knob::name;
use crate::app::theme::WARNING;

/// The field, with what is typed but not yet entered.
#[derive(Debug, Default)]
pub(super) struct PicturePath {
    text: String,
    /// The path that the field was filled with.
    shown: Option<PathBuf>,
    /// The dialog that is open.
    dialog: Option<Receiver<Answer<PathBuf>>>,
    /// Whether this desktop turned out to have no dialog.
    no_dialog: bool,
}

impl PicturePath {
    /// Draws the field and its button.
    pub(super) fn show(&mut self, ui: &mut Ui, picture: &mut Option<PathBuf>) {
        if let Some(chosen) = self.receive() {
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
                self.ask(ui.ctx());
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
        if self.no_dialog {
            let words = "This desktop offers no file dialog: type a path.";
            ui.label(RichText::new(words).small().color(WARNING));
        }
    }

    /// Asks with the desktop's dialog, on a thread of its own.
    fn ask(&mut self, ctx: &Context) {
        if self.dialog.is_some() {
            return;
        }
        let dialog = rfd::FileDialog::new()
            .set_title("A picture behind the fire")
            .add_filter("PNG pictures", &["png"]);
        let (sender, receiver) = channel();
        let ctx = ctx.clone();
        let spawned = std::thread::Builder::new()
            .name("sootlight-dialog".into())
            .spawn(move || {
                // The window may be gone.
                let _ = sender.send(answer(|| dialog.pick_file()));
                ctx.request_repaint();
            });
        match spawned {
            Ok(_) => self.dialog = Some(receiver),
            Err(_) => self.no_dialog = true,
        }
    }

    /// What was chosen, once somebody did.
    fn receive(&mut self) -> Option<PathBuf> {
        let answer = match self.dialog.as_ref()?.try_recv() {
            Ok(answer) => answer,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Answer::NoDialog,
        };
        self.dialog = None;
        self.no_dialog = answer == Answer::NoDialog;
        match answer {
            Answer::Chosen(path) => Some(path),
            Answer::Closed | Answer::NoDialog => None,
        }
    }
}
