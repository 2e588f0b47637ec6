//! Pictures that are written together, from the window that asks for an export: all frames from in to out, or views from all
//! around.

use std::path::PathBuf;

use egui::{Button, DragValue, Ui};

use super::{Command, short, warn};
use crate::app::exporter::{Exporter, Wish};
use crate::app::panels::Many;
use crate::app::panels::believed::Believed;
use crate::app::timeline::Timeline;
use crate::app::words::name_of;
use crate::range::{Shots, VIEWS};

/// What is remembered between frames.
#[derive(Debug)]
pub(super) struct ManyRows {
    views: u32,
    /// Which pictures of the range, and of the turntable, exist.
    existing: [Believed<Vec<PathBuf>, usize>; 2],
}

impl Default for ManyRows {
    fn default() -> Self {
        Self {
            // Ten degrees: the fewest that turn without a jerk.
            views: 36,
            existing: Default::default(),
        }
    }
}

impl ManyRows {
    /// A row for the range, where the open file is a frame, and one for a turntable.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        timeline: &Timeline,
        wish: Option<&Wish>,
        commands: &mut Vec<Command>,
    ) {
        let [of_frames, of_views] = &mut self.existing;
        if let Some(playing) = timeline.playing() {
            let shots = playing.shots();
            let targets = wish.map(|wish| shots.targets(&playing.output(&wish.path)).collect());
            ui.horizontal(|ui| {
                let tip = about("Writes the frames from in to out", targets.as_deref());
                if ui
                    .add_enabled(wish.is_some(), Button::new("Export range"))
                    .on_hover_text(tip)
                    .clicked()
                {
                    ask(wish, Many::Frames, commands);
                }
                ui.label(format!("{} frames from in to out", shots.len()));
            });
            tell_existing(ui, of_frames, targets);
        }
        let mut targets = None;
        ui.horizontal(|ui| {
            let shots = Shots::turntable(&[], self.views);
            targets = wish.map(|wish| shots.targets(&wish.path).collect());
            let tip = about(
                "Writes views once round the fire, beginning with what is on show",
                targets.as_deref(),
            );
            if ui
                .add_enabled(wish.is_some(), Button::new("Export turntable"))
                .on_hover_text(tip)
                .clicked()
            {
                ask(wish, Many::Turntable(self.views), commands);
            }
            let views = DragValue::new(&mut self.views)
                .range(VIEWS[0]..=VIEWS[1])
                .update_while_editing(false);
            let views = ui.add(views).accessible_name("Views");
            views.on_hover_text("How many pictures a turn round the fire takes.");
            let apart = short(360.0 / f64::from(self.views));
            ui.label(format!("views all around, {apart}° apart"));
        });
        tell_existing(ui, of_views, targets);
    }
}

fn ask(wish: Option<&Wish>, many: Many, commands: &mut Vec<Command>) {
    commands.extend(wish.map(|wish| Command::ExportMany(wish.clone(), many)));
}

/// What a button does, and into which files.
fn about(what: &str, targets: Option<&[PathBuf]>) -> String {
    let Some([first, .., last]) = targets else {
        return format!("{what}.");
    };
    let [from, to] = [first, last].map(|path| name_of(path));
    format!(
        "{what}, {from} to {to}. Those that are there, made from the same files and settings, are kept: what was stopped \
         goes on."
    )
}

/// Warns of pictures that are there.
fn tell_existing(
    ui: &mut Ui,
    existing: &mut Believed<Vec<PathBuf>, usize>,
    targets: Option<Vec<PathBuf>>,
) {
    let Some(targets) = targets else { return };
    let count = |targets: &Vec<PathBuf>| targets.iter().filter(|path| path.exists()).count();
    let all = targets.len();
    let there = *existing.of(targets, count);
    if there > 0 {
        warn(
            ui,
            &format!("{there} of {all} exist. Those of other files or settings will be replaced."),
        );
    }
}

/// The button that pauses what is exported, or lets it go on, where that can pause.
pub(super) fn pause(ui: &mut Ui, exporter: &Exporter, commands: &mut Vec<Command>) {
    let (words, pauses) = match exporter.pauses() {
        None => return,
        Some(false) => ("Pause export", true),
        Some(true) => ("Go on exporting", false),
    };
    let tip = "The frame in hand is finished first.";
    if ui.button(words).on_hover_text(tip).clicked() {
        commands.push(Command::PauseExport(pauses));
    }
}
