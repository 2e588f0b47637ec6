//! The controls. A panel changes the document's plain data; what it cannot do itself it asks for with a
//! [`Command`], which is obeyed once every panel is drawn.

mod air;
mod believed;
mod camera;
mod compare;
mod effects;
mod export;
mod file;
mod fire;
pub(super) mod help;
mod knob;
mod legend;
mod overlay;
mod presets;
mod quality;
mod save;
mod stage;
mod status;
mod unit;
mod view;
mod volume;

use std::path::PathBuf;

use egui::{Align2, CollapsingHeader, Context, Frame, Panel, RichText, ScrollArea, Ui, Window};

pub(super) use overlay::overlay;
use presets::PresetsMenu;
pub(super) use status::status;

use super::Document;
use super::accuracy::Told;
use super::closing::Close;
use super::exporter::Wish;
use super::maps::Map;
use super::recent::Recent;
use super::region::RegionFrame;
use super::snapshots::{Snapshots, Way};
use super::thumbnails::Thumbnails;
use super::timeline::Step;
use crate::project::{Control, Job, Mend, Preset, why_idle};
use crate::render::Facts;
use crate::render::costs::Cost;
use crate::render::plan::Decision;
use crate::study::Numbers;
use crate::volume::BuiltIn;

/// What a panel cannot do itself.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Ask for files with the desktop's dialog.
    Ask,
    /// Open these files.
    Open(Vec<PathBuf>),
    /// Show the built-in flame.
    BuiltIn(BuiltIn),
    /// Burn as in a preset.
    Preset(&'static Preset),
    /// Burn as in this scene file.
    BurnAs(PathBuf),
    /// Keep what burns as a preset in this file.
    KeepPreset(PathBuf),
    /// Stop reading files.
    CancelLoading,
    /// Take the last change back.
    Undo,
    /// Take the last undo back.
    Redo,
    /// Change what keeps the picture black.
    Mend(Mend),
    /// Measure exposure and white on the present picture, and expose so.
    AutoExposure,
    /// Show the controls, or hide them.
    TogglePanel,
    /// Show the spectra, or hide them.
    ToggleSpectrum,
    /// Show the histogram, or hide it.
    ToggleLevels,
    /// Mark what is clipped in the picture, or no more.
    ToggleClipped,
    /// Show a cut through the volume, or hide it.
    ToggleVolume,
    /// Show what accuracy costs, or hide it.
    ToggleAccuracy,
    /// Render with these numbers from here on.
    Adopt(Numbers),
    /// Show a map over the picture, or take it away.
    ToggleMap(Map),
    /// Sharpen only a part of the picture, which the next drag over it frames; or do not frame one.
    ChooseRegion,
    /// Sharpen all of the picture.
    WholePicture,
    /// Let the picture pause, or go on.
    PausePicture,
    /// Keep the picture with all that is set.
    GrabSnapshot,
    /// Compare the picture with a snapshot this way, or no more.
    Compare(Way),
    /// Compare with the snapshot of this number.
    CompareWith(u64),
    /// Set what was set when the snapshot of this number was grabbed.
    RestoreSnapshot(u64),
    /// Throw the snapshot of this number away.
    ForgetSnapshot(u64),
    /// Go to another frame, play, or bound what plays.
    Step(Step),
    /// Take the notice away.
    Dismiss,
    /// Open and set what was in a window that did not end by itself.
    Restore,
    /// Take away what is kept of that window.
    ForgetSession,
    /// Show the window that asks for an export.
    OpenExport,
    /// Export this.
    Export(Wish),
    /// Export all frames that play, or so many views from all around, named after this.
    ExportMany(Wish, Many),
    /// Pause the range that is exported, or go on.
    PauseExport(bool),
    /// Stop exporting.
    CancelExport,
    /// Close the window, or keep it open, as was answered.
    Close(Close),
    /// Save what is set where it was saved before, or ask where.
    Save,
    /// Ask where to save what is set.
    SaveAs,
    /// Save it there.
    SaveTo(PathBuf),
    /// Save nothing.
    CloseSave,
    /// Put all that is set on the clipboard, as a scene's text.
    CopySettings,
    /// Set what is on the clipboard.
    PasteSettings,
    /// Show what keys and hands do, or hide it.
    ToggleHelp,
    /// Put the other look on.
    ToggleTheme,
    /// Take away what is said of the last export.
    ForgetExport,
}

/// Pictures that are exported together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Many {
    /// The frames that play.
    Frames,
    /// So many views once round the fire.
    Turntable(u32),
}

/// Width of the panel in points, scroll bar included.
const WIDTH: f32 = 372.0;
/// Widest share of the window that the panel takes.
const MOST_OF_WINDOW: f32 = 0.6;
/// Space around the controls.
const MARGIN: i8 = 12;

/// The panel at the right, with what is typed but not yet entered.
#[derive(Default)]
pub(super) struct Panels {
    pub(super) file: file::FilePanel,
    /// Whether the panel is out of sight, for the picture's sake.
    pub(super) hidden: bool,
    pub(super) export: export::ExportPanel,
    pub(super) save: save::SavePanel,
    pub(super) presets: PresetsMenu,
    /// Whether the page of keys is open.
    pub(super) shows_help: bool,
    stage: stage::StagePanel,
}

/// What the controls show beside the document.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    /// What is said of the picture's error.
    pub(super) told: Option<&'a Told>,
    /// The map over the picture.
    pub(super) map: Option<Map>,
    /// The part of it that is sharpened.
    pub(super) region: &'a RegionFrame,
    pub(super) snapshots: &'a Snapshots,
    pub(super) recent: &'a Recent,
    pub(super) thumbnails: &'a Thumbnails,
}

/// What is known of the picture that the controls change.
#[derive(Clone, Copy)]
struct Known<'a> {
    /// The last valid job.
    job: Option<&'a Job>,
    /// What its plan decided; empty while that is not known.
    decisions: &'a [Decision],
    /// What effects cost in it; empty while that is not measured.
    costs: &'a [Cost],
    /// What was found out about it.
    facts: Facts,
}

impl Known<'_> {
    /// Why a control cannot change the picture, if it cannot.
    fn idle(&self, control: Control) -> Option<String> {
        self.job
            .and_then(|job| why_idle(job, control, self.decisions))
    }
}

impl Panels {
    /// Draws every section.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        document: &mut Document,
        beside: &Beside<'_>,
        flaws: &[String],
        commands: &mut Vec<Command>,
    ) {
        if self.hidden {
            return;
        }
        let width = WIDTH.min(MOST_OF_WINDOW * ui.ctx().content_rect().width());
        let frame = Frame::new().fill(ui.visuals().panel_fill);
        Panel::right("controls")
            .resizable(false)
            .exact_size(width)
            .frame(frame)
            .show(ui, |ui| {
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    Frame::new().inner_margin(MARGIN).show(ui, |ui| {
                        // Whatever a row says, the panel is as wide as it is.
                        ui.set_max_width(width - 2.0 * f32::from(MARGIN));
                        self.file.show(ui, document, beside, commands);
                        let recognised = document.recognised().cloned();
                        let automatic_half = document.automatic_half_saturation_cd_m2();
                        let decisions = document.decisions.clone();
                        let costs = document.costs.clone();
                        let facts = document.facts;
                        let (project, job) = document.parts();
                        let known = Known {
                            job,
                            decisions: &decisions,
                            costs: &costs,
                            facts,
                        };
                        fire::show(ui, project, known, &mut self.presets, commands);
                        view::show(ui, project, automatic_half, commands);
                        compare::show(ui, beside.snapshots, commands);
                        quality::show(ui, project, known, beside, commands);
                        fire::heat_and_smoke(ui, project, known);
                        air::show(ui, project, known);
                        self.stage.show(ui, project, known);
                        effects::show(ui, &mut project.effects, known);
                        volume::show(ui, project, job, recognised.as_ref());
                        camera::show(ui, document);
                        file::findings(ui, document);
                        file::flaws(ui, flaws);
                    });
                });
            });
    }
}

/// A window in the middle that is as large as what is in it.
fn centred<'a>(ctx: &Context, title: &'a str) -> Window<'a> {
    Window::new(title)
        .collapsible(false)
        .pivot(Align2::CENTER_CENTER)
        .default_pos(ctx.content_rect().center())
        .auto_sized()
}

/// A section that folds.
fn section(ui: &mut Ui, title: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    ui.add_space(6.0);
    CollapsingHeader::new(RichText::new(title).strong())
        .default_open(open)
        .show_unindented(ui, |ui| {
            ui.add_space(2.0);
            content(ui);
        });
}

/// A number in as few characters as tell it.
pub(super) fn short(value: f64) -> String {
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
