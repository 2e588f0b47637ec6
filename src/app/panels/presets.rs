//! Flames to start from: the program's own with their pictures, and those that a person kept.

use std::path::{Path, PathBuf};

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{
    Button, ColorImage, Grid, Image, PopupCloseBehavior, RichText, ScrollArea, TextEdit,
    TextureHandle, TextureOptions, Ui, vec2,
};

use super::Command;
use super::believed::Believed;
use super::knob::{button, name};
use crate::app::scene_file::{ENDING, is_scene};
use crate::project::{PRESETS, Preset, THUMBNAIL};

/// Pictures beside each other.
const COLUMNS: usize = 2;
/// Points for each pixel of a preset's picture: it is as sharp where two pixels are a point.
const SCALE: f32 = 0.5;
/// Most height of the menu, points.
const HEIGHT: f32 = 420.0;

/// What the menu remembers between frames.
#[derive(Default)]
pub(in crate::app) struct PresetsMenu {
    /// Where a person's own presets lie; `None` where nothing is remembered between windows.
    pub(in crate::app) folder: Option<PathBuf>,
    /// In the order of [`PRESETS`], once they were seen.
    pictures: Vec<Option<TextureHandle>>,
    /// Presets in that folder.
    own: Believed<PathBuf, Vec<PathBuf>>,
    name: String,
}

impl PresetsMenu {
    /// Draws the row with its menu.
    pub(super) fn show(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let tip = "Sets what burns: fuel, salt, glow and soot. A file that is open keeps its shape and its mapping; one of \
                       the program's own flames gives way to the one that shows the preset best.";
            name(ui, "Burn as", tip);
            // A click into the field for a name does not close it.
            let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
            let menu = MenuButton::new("a preset…").config(stays);
            let (menu, _) = menu.ui(ui, |ui| {
                ScrollArea::vertical().max_height(HEIGHT).show(ui, |ui| {
                    self.pictured(ui, commands);
                    self.kept(ui, commands);
                });
            });
            menu.on_hover_text(tip);
        });
    }

    fn pictured(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if self.pictures.is_empty() {
            self.pictures = PRESETS
                .iter()
                .map(|preset| {
                    let picture = decoded(preset)?;
                    Some(
                        ui.ctx()
                            .load_texture(preset.name, picture, TextureOptions::LINEAR),
                    )
                })
                .collect();
        }
        let [width, height] = THUMBNAIL.map(|side| SCALE * side as f32);
        Grid::new("presets").num_columns(COLUMNS).show(ui, |ui| {
            for (i, (preset, picture)) in PRESETS.iter().zip(&self.pictures).enumerate() {
                let entry = match picture {
                    Some(picture) => {
                        let image = Image::new(picture).fit_to_exact_size(vec2(width, height));
                        Button::image_and_text(image, preset.label)
                    }
                    None => Button::new(preset.label),
                };
                if ui.add(entry).on_hover_text(preset.words).clicked() {
                    commands.push(Command::Preset(preset));
                    ui.close();
                }
                if i % COLUMNS == COLUMNS - 1 {
                    ui.end_row();
                }
            }
        });
    }

    /// Presets of the person's own, and a field to keep what burns now.
    fn kept(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let Some(folder) = self.folder.clone() else {
            return;
        };
        let own = self.own.of(folder.clone(), |folder| scenes_in(folder));
        ui.separator();
        for path in own {
            let label = path.file_stem().unwrap_or_default().to_string_lossy();
            let entry = ui.button(label).on_hover_text(path.display().to_string());
            if entry.clicked() {
                commands.push(Command::BurnAs(path.clone()));
                ui.close();
            }
        }
        let kept = ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut self.name)
                .hint_text("a name")
                .desired_width(120.0);
            ui.add(field)
                .accessible_name("Name of a preset")
                .on_hover_text("What burns now is kept by this name.");
            let path = path_of(&folder, &self.name);
            let tip = "Keep fuel, salt, glow, soot, smoke and effects as a preset of your own: a scene file in the folder below, \
                       which others can be given.";
            let replaces = path.as_ref().is_some_and(|path| own.contains(path));
            let label = if replaces { "Replace" } else { "Keep" };
            let kept = button(ui, path.is_some(), label, tip);
            if kept {
                commands.extend(path.map(Command::KeepPreset));
                self.name.clear();
                ui.close();
            }
            kept
        });
        if kept.inner {
            self.own.forget();
        }
        let whereabouts = format!("Your presets lie in {}", folder.display());
        ui.label(RichText::new(whereabouts).small().weak());
    }
}

/// A file for a preset; `None` for what can be no file's name.
fn path_of(folder: &Path, name: &str) -> Option<PathBuf> {
    let name = name.trim();
    let is_name = !name.is_empty() && !name.starts_with('.') && !name.contains(['/', '\\', ':']);
    is_name.then(|| folder.join(format!("{name}.{ENDING}")))
}

/// Scene files of a folder by their names; none where there is no folder.
fn scenes_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths.filter(|path| is_scene(path)).collect();
    paths.sort();
    paths
}

/// A preset's picture; `None` if it is none, which a test rules out.
fn decoded(preset: &Preset) -> Option<ColorImage> {
    let picture = image::load_from_memory(preset.picture).ok()?.to_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    Some(ColorImage::from_rgb(size, &picture))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_its_picture() {
        for preset in PRESETS {
            let picture = decoded(preset).map(|picture| picture.size);
            assert_eq!(
                picture,
                Some(THUMBNAIL.map(|side| side as usize)),
                "{}",
                preset.name
            );
        }
    }

    #[test]
    fn a_preset_is_kept_in_its_folder_and_nowhere_else() {
        let folder = Path::new("presets");
        let kept = path_of(folder, " my fire ").map(|path| path.with_extension(""));
        assert_eq!(kept, Some(folder.join("my fire")));
        for name in ["", " ", "../a", "a/b", "c:a", ".hidden", "a\\b"] {
            assert_eq!(path_of(folder, name), None, "{name}");
        }
    }
}
