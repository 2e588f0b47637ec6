//! Snapshots: grab, wipe, flip, go back.

use egui::{Button, Image, RichText, Sense, Ui, WidgetInfo, vec2};

use super::knob::note;
use super::{Command, section};
use crate::app::snapshots::{MOST, Snapshot, Snapshots, Way};

/// Width of a thumbnail, points.
const THUMBNAIL: f32 = 84.0;

/// Draws the section.
pub(super) fn show(ui: &mut Ui, snapshots: &Snapshots, commands: &mut Vec<Command>) {
    section(ui, "Compare", true, |ui| {
        ui.horizontal_wrapped(|ui| {
            let grab = ui.add_enabled(!snapshots.is_full(), Button::new("Grab snapshot"));
            let grab = grab
                .on_hover_text("Keeps the picture as it is, with all that is set. Key: G")
                .on_disabled_hover_text(format!("{MOST} are kept at most: forget one first."));
            if grab.clicked() {
                commands.push(Command::GrabSnapshot);
            }
            let any = snapshots.chosen().is_some();
            for (way, words, tip) in [
                (
                    Way::Wipe,
                    "Wipe",
                    "The snapshot left of a line that you drag, the picture right of it. Key: W",
                ),
                (
                    Way::Flip,
                    "Flip",
                    "The snapshot in place of the picture, to go back and forth. Key: Q",
                ),
            ] {
                let button = Button::selectable(snapshots.way() == way, words);
                let button = ui.add_enabled(any, button).on_hover_text(tip);
                let button = button.on_disabled_hover_text("Grab a snapshot first.");
                if button.clicked() {
                    commands.push(Command::Compare(way));
                }
            }
        });
        if snapshots.all().is_empty() {
            note(ui, "grab one, change something, and wipe between the two");
        }
        for snapshot in snapshots.all() {
            let is_chosen = snapshots
                .chosen()
                .is_some_and(|chosen| chosen.number == snapshot.number);
            row(ui, snapshot, is_chosen, commands);
        }
    });
}

fn row(ui: &mut Ui, snapshot: &Snapshot, is_chosen: bool, commands: &mut Vec<Command>) {
    let number = snapshot.number;
    ui.horizontal(|ui| {
        let [width, height] = snapshot.film.size().map(|side| side as f32);
        let size = vec2(THUMBNAIL, THUMBNAIL * height / width);
        let size = size * (THUMBNAIL / size.y.max(THUMBNAIL));
        let image = Image::new((snapshot.thumbnail.id(), size)).sense(Sense::click());
        let image = ui.add(image);
        image.widget_info(|| {
            WidgetInfo::selected(egui::Role::Button, true, is_chosen, snapshot.name())
        });
        if is_chosen {
            let stroke = ui.visuals().selection.stroke;
            ui.painter()
                .rect_stroke(image.rect, 2.0, stroke, egui::StrokeKind::Outside);
        }
        let tip = format!("{}. A click compares with it.", snapshot.title);
        if image.on_hover_text(tip).clicked() {
            commands.push(Command::CompareWith(number));
        }
        ui.vertical(|ui| {
            let name = RichText::new(snapshot.name());
            ui.label(if is_chosen { name.strong() } else { name });
            ui.horizontal(|ui| {
                let restore = ui.add(Button::new("Restore").small());
                let tip = "Sets all that was set when it was grabbed. Undo takes it back.";
                if restore.on_hover_text(tip).clicked() {
                    commands.push(Command::RestoreSnapshot(number));
                }
                let forget = ui.add(Button::new("Forget").small());
                if forget.on_hover_text("Throws the snapshot away.").clicked() {
                    commands.push(Command::ForgetSnapshot(number));
                }
            });
        });
    });
}
