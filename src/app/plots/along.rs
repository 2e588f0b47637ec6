//! What the ray of one pixel passes: temperature and soot by the distance from the eye.

use egui::{Color32, RichText, Role, Ui, WidgetInfo, vec2};
use egui_plot::{Line, PlotPoints};

use super::chart::still_plot;
use crate::app::panels::short;
use crate::render::along::{Along, DEPTH_NM, Place};

/// Height of each chart in points.
const HEIGHT: f32 = 96.0;
/// Colour of the temperature's line, that of hot soot: where the chart is dark, and where it is light.
const KELVIN: [Color32; 2] = [
    Color32::from_rgb(0xff, 0xa0, 0x40),
    Color32::from_rgb(0xb8, 0x5a, 0x00),
];

/// Draws both charts, and what they come to in words above them.
pub(super) fn show(ui: &mut Ui, along: &Along) {
    ui.label(words_of(along));
    if along.hottest().is_none() {
        return;
    }
    let known = |place: &&Place| place.temperature_k > 0.0;
    let places: Vec<&Place> = along.places.iter().filter(known).collect();
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return;
    };
    let ends = [first.distance_m, last.distance_m];
    let strong = ui.visuals().strong_text_color();
    for (label, axis, colour, value) in [
        (
            "Temperature along the ray against distance",
            "K",
            KELVIN[usize::from(!ui.visuals().dark_mode)],
            (|place| place.temperature_k) as fn(&Place) -> f64,
        ),
        (
            "Soot along the ray against distance",
            "soot, ppm",
            strong,
            |place| 1e6 * place.soot,
        ),
    ] {
        let points: Vec<[f64; 2]> = places
            .iter()
            .map(|place| [place.distance_m, value(place)])
            .collect();
        let plot = still_plot(label, HEIGHT)
            .default_x_bounds(ends[0], ends[1])
            .auto_bounds([true, true])
            .include_y(0.0)
            .set_margin_fraction(vec2(0.0, 0.05))
            .x_axis_formatter(|mark, _| format!("{} m", short(mark.value)))
            .y_axis_label(RichText::new(axis).small().weak())
            .y_axis_formatter(|mark, _| short(mark.value))
            .y_axis_min_width(58.0)
            .label_formatter(|_| None);
        let shown = plot.show(ui, |plot| {
            plot.line(
                Line::new(axis, PlotPoints::from(points))
                    .color(colour)
                    .width(1.5),
            );
        });
        shown
            .response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
    }
}

/// How deep the fire is there, and how hot.
fn words_of(along: &Along) -> String {
    match along.hottest() {
        Some(place) => format!(
            "optical depth {} at {DEPTH_NM} nm   hottest soot {:.0} K, {} m away",
            short(along.depth()),
            place.temperature_k,
            short(place.distance_m)
        ),
        None => "no soot along the ray".to_owned(),
    }
}
