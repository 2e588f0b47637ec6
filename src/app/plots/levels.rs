//! The histogram: how often each level of the display is on show, and what is lost at its ends.

use egui::{Align, Color32, Layout, RichText, Role, Ui, WidgetInfo, vec2};
use egui_plot::{GridMark, Line, PlotBounds, PlotPoints};

use super::chart::still_plot;
use crate::colour::display::View;
use crate::render::Film;
use crate::render::levels::{LEVELS, Levels};

/// Height of the chart in points.
const HEIGHT: f32 = 180.0;
/// Pixels that are counted at most: what they tell is as smooth as can be seen, and takes two milliseconds.
const MOST_PIXELS: usize = 40_000;
/// Share of the lit pixels above which what is clipped is marked.
const MARKED: f64 = 1e-3;
/// Red, green and blue of the curves, where the chart is dark and where it is light.
const COLOURS: [[Color32; 3]; 2] = [
    [
        Color32::from_rgb(0xff, 0x5c, 0x50),
        Color32::from_rgb(0x5c, 0xd0, 0x6a),
        Color32::from_rgb(0x5c, 0x9c, 0xff),
    ],
    [
        Color32::from_rgb(0xc8, 0x28, 0x1e),
        Color32::from_rgb(0x1e, 0x82, 0x32),
        Color32::from_rgb(0x28, 0x5a, 0xc8),
    ],
];

/// Draws the chart of a film as a view shows it, and whether what is clipped is marked in the picture.
pub(super) fn show(ui: &mut Ui, film: &Film, view: &View, marks_clipped: &mut bool) {
    let levels = Levels::of(film, view, MOST_PIXELS);
    marks(ui, &levels);
    let label = format!(
        "Histogram of the picture: black {}, at the highest level red {}, green {}, blue {}",
        percent(levels.black),
        percent(levels.clipped[0]),
        percent(levels.clipped[1]),
        percent(levels.clipped[2]),
    );
    let peak = f64::from(levels.peak()).max(f64::MIN_POSITIVE);
    let plot = still_plot("levels", HEIGHT)
        .show_y(false)
        .x_grid_spacer(|_| {
            let mark = |value: u32| GridMark {
                value: f64::from(value),
                step_size: 64.0,
            };
            [0, 64, 128, 192, 255].into_iter().map(mark).collect()
        })
        .y_grid_spacer(|_| Vec::new())
        .y_axis_label(RichText::new("how many pixels").small().weak())
        .y_axis_formatter(|_, _| String::new())
        .label_formatter(|_| None);
    let colours = COLOURS[usize::from(!ui.visuals().dark_mode)];
    let shown = plot.show(ui, |plot| {
        plot.set_plot_bounds(PlotBounds::from_min_max(
            [-1.0, 0.0],
            [1.03 * LEVELS as f64, 1.05 * peak],
        ));
        for ((shares, colour), name) in levels
            .shares
            .iter()
            .zip(colours)
            .zip(["Red", "Green", "Blue"])
        {
            let point = |(level, share): (usize, &f32)| [level as f64, f64::from(*share)];
            let points: Vec<[f64; 2]> = shares.iter().enumerate().map(point).collect();
            plot.line(
                Line::new(name, PlotPoints::from(points))
                    .color(colour)
                    .width(1.5)
                    .fill(0.0)
                    .fill_alpha(0.15),
            );
        }
    });
    shown
        .response
        .widget_info(|| WidgetInfo::labeled(Role::Image, true, label.as_str()));
    let words = "Of what is not black, level by level as the display shows it. What piles up at the right has lost its \
                 colours and shapes: less exposure, or a softer curve, brings them back.";
    ui.label(RichText::new(words).small().weak());
    let tip = "Lays stripes over every pixel of the picture that is at the highest level of red, green or blue. Key: J";
    ui.checkbox(marks_clipped, "Mark what is clipped")
        .on_hover_text(tip);
}

/// What is lost at either end, above that end.
fn marks(ui: &mut Ui, levels: &Levels) {
    ui.horizontal(|ui| {
        let black = format!("black {}", percent(levels.black));
        ui.label(RichText::new(black).small().weak())
            .on_hover_text("Share of the whole picture that is black in every channel.");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let is_clipped = levels.clipped.iter().any(|share| *share > MARKED);
            let words = levels.clipped.map(percent).join(" · ");
            let visuals = ui.visuals();
            let colour = if is_clipped {
                visuals.warn_fg_color
            } else {
                visuals.weak_text_color()
            };
            ui.label(
                RichText::new(format!("clipped R·G·B {words}"))
                    .small()
                    .color(colour),
            )
            .on_hover_text(
                "Share of what is not black that is at the highest level of red, green and blue.",
            );
        });
        ui.allocate_space(vec2(0.0, 0.0));
    });
}

/// A share as a person reads it.
fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        little if little < 0.1 => "under 0.1 %".to_owned(),
        some if some < 9.95 => format!("{some:.1} %"),
        much => format!("{much:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_told_with_two_digits_at_most() {
        let told = [0.0, 0.0004, 0.034, 0.5, 1.0].map(percent);
        assert_eq!(told, ["0 %", "under 0.1 %", "3.4 %", "50 %", "100 %"]);
    }
}
