//! Where the scene is saved: a path that is typed or chosen.

use std::path::{Path, PathBuf};

use egui::{Context, Key, Label, RichText, TextEdit};

use rfd::FileDialog;

use super::{Command, centred};
use crate::app::Document;
use crate::app::files::{Asked, paths_of};
use crate::app::scene_file::{ENDING, is_scene};

/// Width of the window's contents in points.
const WIDTH: f32 = 440.0;

/// What the window remembers between frames.
#[derive(Debug, Default)]
pub(in crate::app) struct SavePanel {
    is_open: bool,
    text: String,
    dialog: Asked,
    /// Whether there is a file of the name `text`, as it was found when that was typed.
    exists: Option<(String, bool)>,
}

impl SavePanel {
    /// Opens the window. Where nothing was saved yet, the scene is named after the volume and lies beside it.
    pub(in crate::app) fn open(&mut self, document: &Document, saved: Option<&Path>) {
        self.is_open = true;
        self.exists = None;
        let named = || {
            let sources = document.volume().map_or(&[][..], |it| &it.sources);
            let volume = sources.first();
            let beside = volume.map(|path| path.with_extension(ENDING));
            beside.unwrap_or_else(|| PathBuf::from("fire").with_extension(ENDING))
        };
        let path = saved.map_or_else(named, Path::to_owned);
        self.text = path.display().to_string();
    }

    /// Closes the window, if it is open. True if it was.
    pub(in crate::app) fn close(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// The file that is typed: a name without an ending gets that of scenes.
    fn path(&self) -> Option<PathBuf> {
        let path = paths_of(&self.text).into_iter().next()?;
        Some(if is_scene(&path) {
            path
        } else {
            let mut name = path.file_name()?.to_owned();
            name.push(format!(".{ENDING}"));
            path.with_file_name(name)
        })
    }

    /// Draws the window if it is open.
    pub(in crate::app) fn show(
        &mut self,
        ctx: &Context,
        saved: Option<&Path>,
        is_writing: bool,
        commands: &mut Vec<Command>,
    ) {
        if !self.is_open {
            return;
        }
        if let Some(path) = self.dialog.answered() {
            self.text = path.display().to_string();
        }
        let whole = ctx.content_rect();
        centred(ctx, "Save the scene")
            .show(ctx, |ui| {
                ui.set_width(WIDTH.min(whole.width() - 40.0));
                let (mut saves, mut enters) = (false, false);
                ui.horizontal(|ui| {
                    let choose = ui
                        .button("Choose…")
                        .on_hover_text("Choose with the desktop's dialog.");
                    if choose.clicked() {
                        let dialog = FileDialog::new()
                            .set_title("Save the scene")
                            .add_filter("Scenes", &[ENDING]);
                        let near = self.path().and_then(|path| std::path::absolute(path).ok());
                        self.dialog.ask(dialog, FileDialog::save_file, near.as_deref(), ctx);
                    }
                    let field = TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY);
                    let field = ui.add(field).accessible_name("Scene file");
                    enters = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                    field.on_hover_text("The path of the scene file.");
                });
                let words = "A scene file holds all that is set, and names the volume; it is text. Open it here or give it to \
                             the command line with --scene.";
                ui.add(Label::new(RichText::new(words).small().weak()).wrap());
                if self.dialog.has_none() {
                    let words = "This desktop offers no file dialog: type a path.";
                    ui.label(RichText::new(words).color(ui.visuals().warn_fg_color));
                }
                let path = self.path();
                let exists = path.as_ref().is_some_and(|path| self.exists(path));
                let is_own = path.as_deref() == saved;
                // A file is not replaced by a key that is pressed before the eye was there.
                saves |= enters && (!exists || is_own);
                ui.horizontal(|ui| {
                    let label = if exists && !is_own { "Replace" } else { "Save" };
                    let may = path.is_some() && !is_writing;
                    let save = ui.add_enabled(may, egui::Button::new(label));
                    saves |= save.clicked();
                    if ui.button("Cancel").clicked() {
                        commands.push(Command::CloseSave);
                    }
                    if exists && !is_own {
                        ui.label(RichText::new("There is such a file already.").color(ui.visuals().warn_fg_color));
                    }
                });
                if let (true, Some(path)) = (saves && !is_writing, path) {
                    commands.push(Command::SaveTo(path));
                }
            });
    }

    /// Whether there is such a file. Looked up once for each name that is typed: a disk may be slow.
    fn exists(&mut self, path: &Path) -> bool {
        let known = self.exists.as_ref().filter(|(text, _)| *text == self.text);
        if let Some((_, exists)) = known {
            return *exists;
        }
        let exists = path.exists();
        self.exists = Some((self.text.clone(), exists));
        exists
    }
}
