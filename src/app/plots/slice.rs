//! What is in the volume: a plane through it, and its profile along the same axis.

use egui::{
    Color32, ColorImage, Image, RichText, Role, Sense, Slider, TextureHandle, TextureOptions, Ui,
    WidgetInfo, vec2,
};
use egui_plot::{Line, PlotPoints, VLine};

use super::chart::still_plot;
use crate::app::panels::short;
use crate::colour::false_colour::{BLACK, STOPS};
use crate::engine::{Engine, Generation};
use crate::scene::slice::{Cell, Slice, axes_of, profile};

/// Most cells on a side of the plane.
const MOST_CELLS: usize = 160;
/// Planes of the profile, and cells on a side of each.
const PROFILE: [usize; 2] = [64, 32];
/// Greatest height of the plane, and height of the profile, points.
const HEIGHT: f32 = 250.0;
const PROFILE_HEIGHT: f32 = 96.0;
/// Where the scale of temperatures begins, K.
const COLD_K: f32 = 300.0;
const AXES: [&str; 3] = ["x", "y", "z"];

/// What is shown of the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Field {
    #[default]
    Temperature,
    Soot,
}

/// Which plane, and what was made of it.
pub(super) struct SlicePlot {
    axis: usize,
    share: f64,
    field: Field,
    shown: Option<Shown>,
}

impl Default for SlicePlot {
    fn default() -> Self {
        Self {
            // As the front sees it.
            axis: 1,
            share: 0.5,
            field: Field::default(),
            shown: None,
        }
    }
}

/// A plane, and of what.
struct Shown {
    of: (Generation, usize, u64, Field),
    slice: Slice,
    texture: TextureHandle,
    /// What the lightest colour stands for, K or volume fraction.
    most: f32,
    profile: Vec<(f64, f32, f32)>,
    /// What a volume fraction of the medium is multiplied by.
    amount: f64,
}

impl SlicePlot {
    /// Draws the plane of the engine's present scene.
    pub(super) fn show(&mut self, ui: &mut Ui, engine: &Engine) {
        self.controls(ui);
        self.follow(ui, engine);
        let Some(shown) = &self.shown else {
            ui.label("The volume is shown as soon as it is there.");
            return;
        };
        let [across, up] = axes_of(self.axis);
        let [low, high] = shown.slice.corners;
        let [width, height] = [0, 1].map(|c| (high[c] - low[c]) as f32);
        let scale = (ui.available_width() / width).min(HEIGHT / height);
        let image = Image::new(&shown.texture)
            .fit_to_exact_size(vec2(scale * width, scale * height))
            .sense(Sense::hover());
        let response = ui.vertical_centered(|ui| ui.add(image)).inner;
        let label = format!("Plane of the volume across {}", AXES[self.axis]);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label.as_str()));
        let under = response.hover_pos().and_then(|at| {
            let share = (at - response.rect.min) / response.rect.size();
            shown.slice.at([share.x, share.y].map(f64::from))
        });
        let words = under.map_or_else(
            || "point at the plane".to_owned(),
            |(place, cell)| {
                format!(
                    "{} {} m, {} {} m   {}",
                    AXES[across],
                    short(place[0]),
                    AXES[up],
                    short(place[1]),
                    words_of(cell, shown.amount)
                )
            },
        );
        ui.label(RichText::new(words).small().weak());
        self.scale(ui, shown);
        self.profile(ui, shown);
    }

    fn controls(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            for (field, words) in [
                (Field::Temperature, "Temperature"),
                (Field::Soot, "Soot fraction"),
            ] {
                ui.selectable_value(&mut self.field, field, words);
            }
            ui.separator();
            ui.label("across");
            for (axis, words) in AXES.into_iter().enumerate() {
                ui.selectable_value(&mut self.axis, axis, words)
                    .on_hover_text("x goes to the right, y away from the front, z up.");
            }
        });
        ui.spacing_mut().slider_width = ui.available_width();
        let slider = Slider::new(&mut self.share, 0.0..=1.0).show_value(false);
        ui.add(slider)
            .on_hover_text("Where the plane lies.")
            .widget_info(|| WidgetInfo::labeled(Role::Slider, true, "Place of the plane"));
    }

    /// Cuts the plane if it, or the scene, is another.
    fn follow(&mut self, ui: &Ui, engine: &Engine) {
        let Some(packed) = engine.scene() else { return };
        let of = (
            packed.generation,
            self.axis,
            self.share.to_bits(),
            self.field,
        );
        if self.shown.as_ref().is_some_and(|shown| shown.of == of) {
            return;
        }
        let flame = &packed.scene.flame;
        let medium = flame.medium();
        let slice = Slice::new(medium, self.axis, self.share, MOST_CELLS);
        let (low, most) = match self.field {
            Field::Temperature => (COLD_K, medium.peak_temperature_k().max(COLD_K + 1.0)),
            Field::Soot => (0.0, medium.peak_volume_fraction().max(f32::MIN_POSITIVE)),
        };
        let pixels = slice.cells.iter().map(|[soot, kelvin]| {
            let value = match self.field {
                Field::Temperature => *kelvin,
                Field::Soot => *soot,
            };
            colour((value - low) / (most - low))
        });
        let image = ColorImage::new(slice.size, pixels.collect());
        // A drag of the plane leaves the profile as it is.
        let before = self.shown.take();
        let before = before.filter(|before| (before.of.0, before.of.1) == (of.0, of.1));
        self.shown = Some(Shown {
            of,
            texture: ui
                .ctx()
                .load_texture("slice", image, TextureOptions::NEAREST),
            slice,
            most,
            profile: before.map_or_else(
                || profile(medium, self.axis, PROFILE[0], PROFILE[1]),
                |before| before.profile,
            ),
            amount: flame.volume_fraction_factor(),
        });
    }

    /// What the colours stand for.
    fn scale(&self, ui: &mut Ui, shown: &Shown) {
        ui.horizontal(|ui| {
            let [from, to] = match self.field {
                Field::Temperature => [
                    format!("{COLD_K:.0} K and less"),
                    format!("{:.0} K", shown.most),
                ],
                Field::Soot => ["none".to_owned(), ppm(shown.most, shown.amount)],
            };
            ui.label(RichText::new(from).small());
            let (rect, _) = ui.allocate_exact_size(vec2(160.0, 10.0), Sense::hover());
            let steps = 2 * STOPS.len();
            for step in 0..steps {
                let mut part = rect;
                part.min.x = rect.min.x + rect.width() * step as f32 / steps as f32;
                part.max.x = rect.min.x + rect.width() * (step + 1) as f32 / steps as f32;
                let at = (step as f32 + 0.5) / steps as f32;
                ui.painter().rect_filled(part, 0.0, colour(at));
            }
            ui.label(RichText::new(to).small());
        });
    }

    /// The same field plane by plane along the axis.
    fn profile(&self, ui: &mut Ui, shown: &Shown) {
        let (label, axis) = match self.field {
            Field::Temperature => ("Hottest soot of each plane", "hottest, K"),
            Field::Soot => ("Mean soot of each plane", "mean, ppm"),
        };
        let name = AXES[self.axis];
        let value = |kelvin: f32, soot: f32| match self.field {
            Field::Temperature => f64::from(kelvin),
            Field::Soot => 1e6 * f64::from(soot) * shown.amount,
        };
        let planes = shown.profile.iter();
        let points: Vec<[f64; 2]> = planes
            .map(|&(at, kelvin, soot)| [at, value(kelvin, soot)])
            .collect();
        let plot = still_plot((label, self.axis), PROFILE_HEIGHT)
            .include_y(0.0)
            .set_margin_fraction(vec2(0.0, 0.05))
            .x_axis_formatter(move |mark, _| format!("{name} {} m", short(mark.value)))
            .y_axis_label(RichText::new(axis).small().weak())
            .y_axis_formatter(|mark, _| short(mark.value))
            .y_axis_min_width(58.0)
            .label_formatter(|_| None);
        let strong = ui.visuals().strong_text_color();
        let weak = ui.visuals().weak_text_color();
        let drawn = plot.show(ui, |plot| {
            plot.line(
                Line::new(label, PlotPoints::from(points))
                    .color(strong)
                    .width(1.5),
            );
            plot.vline(VLine::new("plane", shown.slice.at_m).color(weak));
        });
        drawn
            .response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
    }
}

/// What a cell holds.
fn words_of([soot, kelvin]: Cell, amount: f64) -> String {
    if kelvin <= 0.0 {
        return "clear air".to_owned();
    }
    format!("{kelvin:.0} K, soot {}", ppm(soot, amount))
}

/// A volume fraction of the medium as a person reads it.
fn ppm(fraction: f32, amount: f64) -> String {
    format!("{} ppm", short(1e6 * f64::from(fraction) * amount))
}

/// The colour of a share of the scale: dark and cold for little, light and warm for much.
fn colour(share: f32) -> Color32 {
    let opaque = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    if share <= 0.0 || share.is_nan() {
        return opaque(BLACK);
    }
    let at = share.min(1.0) * (STOPS.len() - 1) as f32;
    let (low, part) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(STOPS.len() - 1);
    let mixed = |c: usize| {
        let [low, high] = [STOPS[low][c], STOPS[high][c]].map(f32::from);
        (low + part * (high - low)).round() as u8
    };
    opaque([0, 1, 2].map(mixed))
}
