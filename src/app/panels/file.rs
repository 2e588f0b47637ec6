//! Which files, how they were understood, and what could not be taken from them.

use std::path::PathBuf;

use egui::{Button, Image, Key, Label, RichText, TextEdit, Ui, Vec2, vec2};

use super::knob::button;
use super::{Beside, Command, section, short};
use crate::app::Document;
use crate::app::files::paths_of;
use crate::scene::flame::world_bounds;
use crate::volume::BuiltIn;

/// Room for the picture of what was opened before, points; its shape is kept.
const THUMBNAIL: Vec2 = vec2(72.0, 41.0);

/// What the section remembers between frames.
#[derive(Debug, Default)]
pub(in crate::app) struct FilePanel {
    pub(in crate::app) path: String,
    /// Whether this desktop turned out to have no dialog.
    pub(in crate::app) no_dialog: bool,
}

impl FilePanel {
    /// Draws the section.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        beside: &Beside<'_>,
        commands: &mut Vec<Command>,
    ) {
        ui.add(Label::new(RichText::new(document.title()).strong().size(16.0)).truncate());
        ui.add_space(3.0);
        ui.horizontal_wrapped(|ui| {
            let open = ui.button("Open…").on_hover_text(
                "Open volume files (Ctrl+O). A density and its temperature can be chosen together. Files can also \
                 be dropped anywhere on the window.",
            );
            if open.clicked() {
                commands.push(Command::Ask);
            }
            open_again(ui, beside, commands);
            let export = ui
                .button("Export…")
                .on_hover_text("Write the picture into a file, at any size (Ctrl+E).");
            if export.clicked() {
                commands.push(Command::OpenExport);
            }
            let save = ui.button("Save").on_hover_text(
                "Save all that is set as a scene file (Ctrl+S; with Shift under another name). It names the volume, and is opened \
                 as a volume is.",
            );
            if save.clicked() {
                commands.push(Command::Save);
            }
            settings(ui, commands);
            let tip = "Take the last change back (Ctrl+Z).";
            if button(ui, document.can_undo(), "Undo", tip) {
                commands.push(Command::Undo);
            }
            let tip = "Do again what was taken back (Ctrl+Shift+Z).";
            if button(ui, document.can_redo(), "Redo", tip) {
                commands.push(Command::Redo);
            }
        });
        ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut self.path)
                .hint_text("a path, then Enter")
                .desired_width(f32::INFINITY);
            let field = ui.add(field).on_hover_text("The path of a volume file.");
            if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                // It stays until something was opened: a slip of the finger is soon mended.
                commands.push(Command::Open(paths_of(&self.path)));
            }
        });
        if self.no_dialog {
            let words = "This desktop offers no file dialog: type or paste a path above, or drop files here.";
            ui.label(RichText::new(words).color(ui.visuals().warn_fg_color));
        }
    }
}

/// All that is set, as text, to another window and back.
fn settings(ui: &mut Ui, commands: &mut Vec<Command>) {
    let menu = ui.menu_button("Settings", |ui| {
        for (label, tip, command) in [
            (
                "Copy",
                "Put all that is set on the clipboard as text, the scene file's (Ctrl+Shift+C).",
                Command::CopySettings,
            ),
            (
                "Paste",
                "Set what is on the clipboard (Ctrl+V). The open fire stays; its mapping and the camera change only if the \
                 settings were copied from this fire.",
                Command::PasteSettings,
            ),
            (
                "Save as…",
                "Save the scene under another name (Ctrl+Shift+S).",
                Command::SaveAs,
            ),
            ("Dark or light", "Put the other look on the window: neutral greys both (F2).", Command::ToggleTheme),
            ("Keys and hands", "What keys and hands do (F1).", Command::ToggleHelp),
        ] {
            if ui.button(label).on_hover_text(tip).clicked() {
                commands.push(command);
            }
        }
    });
    menu.response
        .on_hover_text("Copy all that is set, paste it, save it; and what the keys do.");
}

/// What was open before, and the flames that need no file.
fn open_again(ui: &mut Ui, beside: &Beside<'_>, commands: &mut Vec<Command>) {
    let recent = beside.recent;
    let menu = ui.menu_button("Recent", |ui| {
        for files in recent.iter() {
            let name = |path: &PathBuf| {
                let name = path.file_name().unwrap_or(path.as_os_str());
                name.to_string_lossy().into_owned()
            };
            let names: Vec<String> = files.iter().map(name).collect();
            let paths: Vec<String> = files
                .iter()
                .map(|path| path.display().to_string())
                .collect();
            let names = names.join(" + ");
            let entry = match beside.thumbnails.of(files) {
                Some(picture) => {
                    let image = Image::new(picture).fit_to_exact_size(THUMBNAIL);
                    Button::image_and_text(image, names)
                }
                None => Button::new(names),
            };
            if ui.add(entry).on_hover_text(paths.join("\n")).clicked() {
                commands.push(Command::Open(files.to_vec()));
            }
        }
        if recent.iter().next().is_some() {
            ui.separator();
        }
        for (flame, words) in [
            (BuiltIn::Torch, "Built-in torch"),
            (BuiltIn::Burner, "Built-in burner"),
            (BuiltIn::Spirit, "Built-in spirit flame"),
        ] {
            if ui.button(words).clicked() {
                commands.push(Command::BuiltIn(flame));
            }
        }
    });
    menu.response
        .on_hover_text("Files that were opened before, and the built-in flames.");
}

/// What was found in the file: at the end, because it is as long as it must be.
pub(super) fn findings(ui: &mut Ui, document: &Document) {
    let (Some(job), Some(recognised)) = (document.last_job(), document.recognised()) else {
        return;
    };
    section(ui, "What was read", true, |ui| {
        ui.label(format!("Format: {}", job.volume.format.name()));
        let why = if job.producer == recognised.producer {
            recognised.reason.as_str()
        } else {
            "set by hand"
        };
        ui.label(format!("Read as {}: {why}.", job.producer.name()));
        let flame = &job.flame;
        let bounds = world_bounds(&job.volume, &flame.maps, &flame.placement);
        if !bounds.is_empty() {
            let [x, y, z] = bounds.size().to_array().map(short);
            ui.label(format!("Size of the fire: {x} × {y} × {z} m"));
        }
        for row in document.fields() {
            ui.add_space(4.0);
            let title = format!("{} from “{}”", row.kind.name(), row.grid);
            ui.label(RichText::new(title).strong());
            let range = |(low, high): (f64, f64)| format!("{} … {}", short(low), short(high));
            let words = format!(
                "in the file {}\nin the fire {} {}",
                range(row.raw),
                range(row.mapped),
                row.kind.unit()
            );
            ui.label(words.trim_end()).on_hover_text(
                "Lowest and highest value in the file, and what they are taken to be. f_v is the volume of soot in a \
                 volume of gas.",
            );
        }
    });
}

/// Everything assumed or not faithful.
pub(super) fn flaws(ui: &mut Ui, flaws: &[String]) {
    if !flaws.is_empty() {
        section(ui, "Assumed or not faithful", true, |ui| {
            for flaw in flaws {
                ui.label(RichText::new(format!("• {flaw}")).color(ui.visuals().warn_fg_color));
            }
        });
    }
}
