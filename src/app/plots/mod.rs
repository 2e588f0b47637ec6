//! Spectra in a window of their own: the light of one pixel, and what fuel and air do to light of each wavelength.
//!
//! Closed, it costs nothing. Open, it marches at most one ray in a frame, and only through a scene that the engine has
//! packed already.

mod accuracy;
mod along;
mod chart;
mod levels;
mod optics;
mod pixel;
mod slice;

use egui::{Context, Id, ScrollArea, Ui, Window, vec2};

use self::optics::OpticsPlots;
use self::pixel::PixelPlot;
use self::slice::SlicePlot;
use super::accuracy::{Accuracy, Told};
use super::canvas::PicturePlace;
use super::panels::Command;
use crate::colour::display::View;
use crate::engine::Engine;
use crate::project::Job;
use crate::render::Film;

/// What the plots are about.
pub(super) struct Shown<'a> {
    /// The job that was valid last.
    pub(super) job: Option<&'a Job>,
    /// The picture on show.
    pub(super) film: &'a Film,
    /// How its picture is developed.
    pub(super) view: &'a View,
    /// What is known of errors and seconds.
    pub(super) accuracy: &'a Accuracy,
    /// What is said of the picture on show.
    pub(super) told: Option<&'a Told>,
}

/// Width of the window's contents in points.
const WIDTH: f32 = 400.0;
/// Height of its title and margins in points, with some to spare.
const BAR: f32 = 70.0;
/// Between the window and the canvas's edge, points.
const GAP: f32 = 12.0;

/// What is plotted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tab {
    /// The light of one pixel.
    #[default]
    Pixel,
    /// How often each level of the display is on show.
    Levels,
    /// The optics of a place in the fire.
    FuelAndAir,
    /// What is in the volume.
    Volume,
    /// What accuracy costs.
    Accuracy,
}

/// What the window remembers, open or closed.
#[derive(Default)]
pub(super) struct Plots {
    is_open: bool,
    tab: Tab,
    pixel: PixelPlot,
    optics: OpticsPlots,
    slice: SlicePlot,
    marks_clipped: bool,
}

impl Plots {
    /// Whether what is clipped is marked in the picture. In false colour nothing is: it marks it by a colour of its own.
    pub(super) fn marks_clipped(&self, view: &View) -> bool {
        self.marks_clipped && !view.false_colour
    }

    /// Marks what is clipped in the picture, or no more.
    pub(super) fn toggle_marks(&mut self) {
        self.marks_clipped = !self.marks_clipped;
    }

    /// Whether the spectra are on show.
    pub(super) fn is_open(&self) -> bool {
        self.is_open && matches!(self.tab, Tab::Pixel | Tab::FuelAndAir)
    }

    /// Opens the window with the spectra, or closes it if it shows them.
    pub(super) fn toggle(&mut self) {
        let shows = self.is_open();
        self.is_open = !shows;
        if !matches!(self.tab, Tab::Pixel | Tab::FuelAndAir) {
            self.tab = Tab::default();
        }
    }

    /// Whether the histogram is on show.
    pub(super) fn shows_levels(&self) -> bool {
        self.is_open && self.tab == Tab::Levels
    }

    /// Opens the cut through the volume, or closes the window if it is that.
    pub(super) fn toggle_volume(&mut self) {
        self.is_open = !(self.is_open && self.tab == Tab::Volume);
        self.tab = Tab::Volume;
    }

    /// Opens the histogram, or closes the window if it is that.
    pub(super) fn toggle_levels(&mut self) {
        self.is_open = !self.shows_levels();
        self.tab = Tab::Levels;
    }

    /// Closes the window, if it is open. True if it was.
    pub(super) fn close(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Whether the chart of accuracy is on show.
    pub(super) fn shows_accuracy(&self) -> bool {
        self.is_open && self.tab == Tab::Accuracy
    }

    /// Opens the chart of accuracy, or closes the window if it is that.
    pub(super) fn toggle_accuracy(&mut self) {
        self.is_open = !self.shows_accuracy();
        self.tab = Tab::Accuracy;
    }

    /// Draws the window if it is open: of the engine's present scene, for the job that was valid last.
    pub(super) fn show(
        &mut self,
        ctx: &Context,
        engine: &Engine,
        shown: &Shown<'_>,
        place: &PicturePlace,
        commands: &mut Vec<Command>,
    ) {
        if !self.is_open {
            return;
        }
        let (job, view) = (shown.job, shown.view);
        let whole = ctx.content_rect();
        let mut open = true;
        let title = match self.tab {
            Tab::Accuracy => "Accuracy",
            Tab::Levels => "Histogram",
            Tab::Volume => "Volume",
            Tab::Pixel | Tab::FuelAndAir => "Spectrum",
        };
        Window::new(title)
            .id(Id::unique("plots"))
            .open(&mut open)
            .collapsible(false)
            // It grows downwards: the tabs stay under the pointer that has chosen one.
            .default_pos(place.canvas.min + vec2(GAP, GAP))
            .auto_sized()
            .show(ctx, |ui| {
                ScrollArea::vertical()
                    .max_height((whole.height() - BAR).max(BAR))
                    .show(ui, |ui| {
                        ui.set_width(WIDTH.min(whole.width() - 40.0));
                        self.tabs(ui);
                        match self.tab {
                            Tab::Pixel => self.pixel.show(ui, engine, view, place),
                            Tab::Levels => {
                                levels::show(ui, shown.film, view, &mut self.marks_clipped);
                            }
                            Tab::FuelAndAir => self.optics.show(ui, job),
                            Tab::Volume => self.slice.show(ui, engine),
                            Tab::Accuracy => {
                                accuracy::show(ui, shown.accuracy, job, shown.told, commands);
                            }
                        }
                    });
            });
        if self.tab == Tab::Pixel {
            self.pixel.mark(ctx, place);
        }
        self.is_open &= open;
    }

    fn tabs(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            for (tab, words, tip) in [
                (
                    Tab::Pixel,
                    "Pixel",
                    "The light of the pixel under the pointer.",
                ),
                (
                    Tab::Levels,
                    "Histogram",
                    "How often the picture shows each level of red, green and blue, and what is clipped.",
                ),
                (
                    Tab::FuelAndAir,
                    "Fuel and air",
                    "What a place in the fire does to light of each wavelength: it emits, absorbs, scatters and bends it.",
                ),
                (
                    Tab::Volume,
                    "Volume",
                    "What is in the volume: temperature and soot on a plane through it, and their profile.",
                ),
                (
                    Tab::Accuracy,
                    "Accuracy",
                    "What accuracy costs in time: of this scene, on this machine.",
                ),
            ] {
                ui.selectable_value(&mut self.tab, tab, words)
                    .on_hover_text(tip);
            }
        });
        ui.separator();
    }
}
