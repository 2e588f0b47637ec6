//! Spectra in a window of their own: the light of one pixel, and what fuel and air do to light of each wavelength.
//!
//! Closed, it costs nothing. Open, it marches at most one ray in a frame, and only through a scene that the engine has
//! packed already.

mod chart;
mod optics;
mod pixel;

use egui::{Context, ScrollArea, Ui, Window, vec2};

use self::optics::OpticsPlots;
use self::pixel::PixelPlot;
use super::canvas::PicturePlace;
use crate::colour::display::View;
use crate::engine::Engine;
use crate::project::Job;

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
    /// The optics of a place in the fire.
    FuelAndAir,
}

/// What the window remembers, open or closed.
#[derive(Default)]
pub(super) struct Plots {
    is_open: bool,
    tab: Tab,
    pixel: PixelPlot,
    optics: OpticsPlots,
}

impl Plots {
    /// Whether the window is open.
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Opens the window, or closes it.
    pub(super) fn toggle(&mut self) {
        self.is_open = !self.is_open;
    }

    /// Closes the window, if it is open. True if it was.
    pub(super) fn close(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Draws the window if it is open: of the engine's present scene, for the job that was valid last.
    pub(super) fn show(
        &mut self,
        ctx: &Context,
        engine: &Engine,
        job: Option<&Job>,
        view: &View,
        place: &PicturePlace,
    ) {
        if !self.is_open {
            return;
        }
        let whole = ctx.content_rect();
        let mut open = true;
        Window::new("Spectrum")
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
                            Tab::FuelAndAir => self.optics.show(ui, job),
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
                    Tab::FuelAndAir,
                    "Fuel and air",
                    "What a place in the fire does to light of each wavelength: it emits, absorbs, scatters and bends it.",
                ),
            ] {
                ui.selectable_value(&mut self.tab, tab, words)
                    .on_hover_text(tip);
            }
        });
        ui.separator();
    }
}
