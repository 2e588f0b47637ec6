//! What hands do to the whole window: keys, files let go over it, and the commands of panels.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers, ViewportCommand};

use super::closing::Close;
use super::exporter::Wish;
use super::files::{Request, paths_of};
use super::maps::Map;
use super::panels::{Command, Many};
use super::scene_file::is_settings;
use super::snapshots::{MOST, Way};
use super::timeline::Step;
use super::{App, theme};
use crate::render::develop::Metering;

/// Shortcuts, longer ones first: a shorter one would also match them.
const SHORTCUTS: [(Modifiers, Key, Command); 23] = [
    (
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::Z,
        Command::Redo,
    ),
    (
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::S,
        Command::SaveAs,
    ),
    (Modifiers::COMMAND, Key::S, Command::Save),
    (Modifiers::COMMAND, Key::Z, Command::Undo),
    (Modifiers::COMMAND, Key::Y, Command::Redo),
    (Modifiers::COMMAND, Key::O, Command::Ask),
    (Modifiers::COMMAND, Key::E, Command::OpenExport),
    (
        Modifiers::COMMAND.plus(Modifiers::ALT),
        Key::B,
        Command::WholePicture,
    ),
    (Modifiers::COMMAND, Key::B, Command::ChooseRegion),
    (Modifiers::NONE, Key::P, Command::PausePicture),
    (Modifiers::NONE, Key::F1, Command::ToggleHelp),
    (Modifiers::NONE, Key::N, Command::TogglePanel),
    (Modifiers::NONE, Key::S, Command::ToggleSpectrum),
    (Modifiers::NONE, Key::H, Command::ToggleLevels),
    (Modifiers::NONE, Key::J, Command::ToggleClipped),
    (Modifiers::NONE, Key::F2, Command::ToggleTheme),
    (Modifiers::NONE, Key::V, Command::ToggleVolume),
    (Modifiers::NONE, Key::C, Command::ToggleAccuracy),
    (Modifiers::NONE, Key::K, Command::ToggleMap(Map::Cost)),
    (Modifiers::NONE, Key::E, Command::ToggleMap(Map::Error)),
    (Modifiers::NONE, Key::G, Command::GrabSnapshot),
    (Modifiers::NONE, Key::W, Command::Compare(Way::Wipe)),
    (Modifiers::NONE, Key::Q, Command::Compare(Way::Flip)),
];

impl App {
    /// Does what panels and keys asked for.
    pub(super) fn obey(&mut self, ctx: &Context, commands: Vec<Command>) {
        for command in commands {
            match command {
                Command::Ask => self.loader.ask(),
                Command::Open(paths) => self.open(paths),
                Command::BuiltIn(flame) => self.begin(Request::OtherBuiltIn(flame, None)),
                Command::Preset(preset) => self.burn_as(preset.project()),
                Command::BurnAs(path) => self.burn_as_file(&path),
                Command::KeepPreset(path) => self.keep_preset(&path),
                Command::CancelLoading => self.cancel_loading(),
                Command::Undo => self.document.undo(),
                Command::Redo => self.document.redo(),
                Command::Mend(mend) => self
                    .document
                    .change(|document| mend.apply(&mut document.project)),
                Command::AutoExposure => {
                    // A picture of another volume says nothing of this one, which is measured when it is seen.
                    let film = self.shows_newest().then(|| self.picture.film());
                    let measured = film.and_then(|film| self.meter.measured(film));
                    self.document.change(|document| {
                        document.metering = measured.or(document.metering);
                        document.project.view.exposure_ev = 0.0;
                        document.project.view.let_go();
                    });
                }
                Command::TogglePanel => self.panels.hidden = !self.panels.hidden,
                Command::ToggleSpectrum => self.plots.toggle(),
                Command::ToggleVolume => self.plots.toggle_volume(),
                Command::ToggleLevels => self.plots.toggle_levels(),
                Command::ToggleClipped => self.plots.toggle_marks(),
                Command::ToggleAccuracy => self.plots.toggle_accuracy(),
                Command::Adopt(numbers) => self
                    .document
                    .change(|document| numbers.by_hand(&mut document.project.render)),
                Command::ToggleMap(map) => self.maps.toggle(map),
                Command::ChooseRegion => self.region.toggle_choosing(),
                Command::WholePicture => self.region.clear(),
                Command::PausePicture => {
                    let pauses = self.is_working() && !self.engine.pauses();
                    self.engine.pause(pauses);
                }
                Command::GrabSnapshot => self.grab(),
                Command::Compare(way) => {
                    // There is nothing to compare with yet: this picture will be it.
                    if self.snapshots.chosen().is_none() {
                        self.grab();
                    }
                    self.snapshots.toggle(way);
                }
                Command::CompareWith(number) => self.snapshots.choose(number),
                Command::RestoreSnapshot(number) => self.go_back_to(number),
                Command::ForgetSnapshot(number) => self.snapshots.forget(number),
                Command::Step(step) => self.step(step),
                Command::Dismiss => self.notice = None,
                Command::Restore => self.restore(),
                Command::ForgetSession => self.autosave.forget(),
                Command::OpenExport => self.panels.export.open(&self.document, &mut self.exporter),
                Command::Export(wish) => {
                    let (metering, effects) = (self.lasting_metering(), self.effects_on_show());
                    if let Some(order) = wish.order(&self.document, metering, effects) {
                        self.exporter.begin(order);
                    }
                }
                Command::ExportMany(wish, many) => self.export_many(wish, many),
                Command::PauseExport(pauses) => self.exporter.pause(pauses),
                Command::CancelExport => self.exporter.cancel(),
                Command::Close(close) => self.close(close, ctx),
                Command::Save => self.save(ctx),
                Command::SaveAs => {
                    let saved = self.scene_file.path();
                    self.panels.save.open(&self.document, saved);
                }
                Command::SaveTo(path) => self.save_to(path, ctx),
                Command::CloseSave => {
                    self.panels.save.close();
                    self.stay_open();
                }
                Command::CopySettings => ctx.copy_text(self.document.project.copied()),
                Command::PasteSettings => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
                Command::ToggleHelp => self.panels.shows_help = !self.panels.shows_help,
                Command::ToggleTheme => theme::toggle(ctx),
                Command::ForgetExport => self.exporter.dismiss(),
            }
        }
    }

    /// What was measured, unless that was on a coarse picture and is about to be measured again.
    fn lasting_metering(&self) -> Option<Metering> {
        let metering = self.document.metering;
        metering.filter(|_| !self.meter.is_coarse())
    }

    fn export_many(&mut self, wish: Wish, many: Many) {
        let (metering, effects) = (self.lasting_metering(), self.effects_on_show());
        let document = &self.document;
        let order = match (many, self.timeline.playing()) {
            (Many::Frames, None) => None,
            (Many::Frames, Some(playing)) => wish.range(document, playing, metering, effects),
            (Many::Turntable(views), _) => {
                let assumed = self.timeline.assumed().map(String::from).collect();
                wish.turntable(document, (views, assumed), metering, effects)
            }
        };
        if let Some(order) = order {
            self.exporter.begin_range(order);
        }
    }

    /// Keeps the picture on show with what is set, if that is what it was made with; says why if not.
    fn grab(&mut self) {
        // What has changed in this frame is not on show yet.
        self.follow();
        let is_shown = self.canvas.can_show(self.picture.film().size());
        let refused = if self.snapshots.is_full() {
            format!("{MOST} snapshots are kept at most: forget one first.")
        } else if !self.shows_a_fine_picture() || self.document.problem().is_some() {
            "A snapshot is of a picture as sharp as its pixels: wait until this one is.".to_owned()
        } else if self.region.is_set() {
            "A snapshot is of a whole picture: only a part of this one is sharp.".to_owned()
        } else if !is_shown {
            "This picture is too large to be shown, so nothing can be compared with it.".to_owned()
        } else {
            let (view, title) = (self.view(), self.document.title());
            let step = self.document.step();
            self.snapshots.grab(&self.picture, &view, title, step);
            return;
        };
        self.notice = Some(refused);
    }

    /// Sets what was set when a snapshot was grabbed; reads its volume again if that was let go.
    fn go_back_to(&mut self, number: u64) {
        let Some(snapshot) = self.snapshots.get(number) else {
            return;
        };
        if snapshot.step.holds_a_volume() {
            self.document.return_to(&snapshot.step);
        } else {
            let project = snapshot.step.project().clone();
            let limits = project.volume.limits();
            self.loader
                .begin(Request::Session(Arc::new(project)), limits);
        }
    }

    /// Files let go over the window, and paths or settings pasted where nothing else takes them.
    pub(super) fn take_drops(&mut self, ctx: &Context) {
        let mut paths: Vec<PathBuf> = ctx.input(|input| {
            let dropped = input.raw.dropped_files.iter();
            dropped.map(|file| file.path().to_owned()).collect()
        });
        if paths.is_empty() && !ctx.text_edit_focused() {
            for text in pasted(ctx) {
                if is_settings(&text) {
                    self.paste_settings(&text);
                } else {
                    paths.extend(paths_of(&text));
                }
            }
        }
        self.open(paths);
    }

    /// What the keys ask for, unless they are being typed into a field.
    pub(super) fn take_keys(&mut self, ctx: &Context) -> Vec<Command> {
        let pressed = |modifiers, key| {
            let shortcut = KeyboardShortcut::new(modifiers, key);
            ctx.input_mut(|input| input.consume_shortcut(&shortcut))
        };
        if ctx.text_edit_focused() {
            // No field takes these keys; what is typed in it and not entered is not saved.
            let saves = SHORTCUTS
                .into_iter()
                .filter(|(_, _, command)| matches!(command, Command::Save | Command::SaveAs));
            let saves = saves.filter(|(modifiers, key, _)| pressed(*modifiers, *key));
            return saves.map(|(_, _, command)| command).collect();
        }
        // A question that is open is answered first.
        if self.closing.is_asked() {
            let stays = pressed(Modifiers::NONE, Key::Escape);
            let stay = stays.then_some(Command::Close(Close::Not));
            return stay.into_iter().collect();
        }
        // A key that is held down switches once; undo goes on and on.
        let held = |key: Key| {
            let is_repeat = |event: &Event| matches!(event, Event::Key { key: it, repeat: true, .. } if *it == key);
            ctx.input(|input| input.events.iter().any(is_repeat))
        };
        let mut commands: Vec<Command> = SHORTCUTS
            .into_iter()
            .filter(|(modifiers, key, _)| !modifiers.is_none() || !held(*key))
            .filter_map(|(modifiers, key, command)| pressed(modifiers, key).then_some(command))
            .collect();
        if self.timeline.is_open() && !self.panels.export.is_open() {
            commands.extend(self.frame_keys(ctx));
        }
        // With Shift, for without it what is selected in the panel is copied.
        let copies = |event: &Event| matches!(event, Event::Copy);
        if ctx.input(|input| input.modifiers.shift && input.events.iter().any(copies)) {
            commands.push(Command::CopySettings);
        }
        // A menu that is open is what is meant: it closes itself.
        if egui::Popup::is_any_open(ctx) {
            return commands;
        }
        if self.loader.loading().is_some() && pressed(Modifiers::NONE, Key::Escape) {
            commands.push(Command::CancelLoading);
        } else if pressed(Modifiers::NONE, Key::Escape) {
            // What was opened last is most likely meant; the export stands in front.
            let saves = self.panels.save.close();
            if saves {
                self.stay_open();
            }
            let _ = saves
                || self.region.stop_choosing()
                || std::mem::take(&mut self.panels.shows_help)
                || self.panels.export.close()
                || self.plots.close()
                || self.maps.close()
                || self.snapshots.close();
        }
        commands
    }
}

impl App {
    /// What keys ask of the frames. Arrows and the space bar are those of a control that has the focus.
    fn frame_keys(&mut self, ctx: &Context) -> Vec<Command> {
        let is_free = ctx.memory(|memory| memory.focused().is_none());
        let pressed = |key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let mut steps = Vec::new();
        for (key, arrow, step) in [
            (Key::Comma, Key::ArrowLeft, Step::Back),
            (Key::Period, Key::ArrowRight, Step::Forth),
        ] {
            if pressed(key) || is_free && pressed(arrow) {
                steps.push(step);
            }
        }
        // The space bar with a drag zooms: it plays when it is let go, unless it was for that.
        let (held, down, let_go) = ctx.input(|input| {
            (
                input.key_down(Key::Space),
                input.pointer.any_down(),
                input.key_released(Key::Space),
            )
        });
        self.timeline.space_drags = (held || let_go) && (self.timeline.space_drags || down);
        if let_go && is_free && !self.timeline.space_drags {
            steps.push(Step::Toggle);
        }
        steps.into_iter().map(Command::Step).collect()
    }
}

/// Texts that were pasted in this frame.
fn pasted(ctx: &Context) -> Vec<String> {
    ctx.input(|input| {
        let pasted = input.events.iter().filter_map(|event| match event {
            Event::Paste(text) => Some(text.clone()),
            _ => None,
        });
        pasted.collect()
    })
}

/// Whether what changes belongs to the same step of undo: something is held, or was clicked so shortly before that a
/// second click makes it a double one.
pub(super) fn is_held(ctx: &Context) -> bool {
    let double_click_s = ctx.options(|options| options.input_options.max_double_click_delay);
    let (down, since_s) = ctx.input(|input| {
        let pointer = &input.pointer;
        (
            pointer.any_down(),
            f64::from(pointer.time_since_last_click()),
        )
    });
    let clicked = since_s < double_click_s;
    if clicked {
        // The step ends in a frame of its own: nothing else may come before the next change.
        ctx.request_repaint_after(Duration::from_secs_f64(double_click_s));
    }
    down || clicked
}
