//! What all charts of the window have in common: wavelengths along the bottom, a unit up the side, and nothing that
//! moves by accident.

use egui::{
    AsIdSalt, Color32, RichText, Role, Sense, Shape, Stroke, Ui, Visuals, WidgetInfo, vec2,
};
use egui_plot::{Bar, BarChart, GridMark, HoverPosition, Line, LineStyle, Plot, PlotPoints};
use glam::DVec3;

use crate::app::panels::short;
use crate::colour::cie;
use crate::colour::xyz::{rgb_from_xyz, srgb_encode};

/// Ends of the wavelengths that are shown, nm.
pub(super) const VISIBLE_NM: [f64; 2] = [380.0, 780.0];

/// How far a pure colour is moved towards white, of the way that would bring it within what a display has: all the way
/// red would be pink, and without it green a plateau.
const PALER: f64 = 0.3;

/// Share of a chart's height, from the bottom, where the number of a value would lie on that of a wavelength.
const CORNER: f64 = 0.07;

/// A curve against wavelength.
pub(super) struct Curve<'a> {
    pub(super) name: &'a str,
    /// Wavelength (nm) and value.
    pub(super) points: Vec<[f64; 2]>,
    pub(super) style: LineStyle,
    /// Whether it steps back behind the others.
    pub(super) faint: bool,
}

/// How the values' axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    /// Evenly, from 0 on.
    FromZero,
    /// Evenly, over what the curves take up.
    Close,
    /// Equal steps are equal factors. What is not above 0 is drawn along the bottom, and a curve that is nowhere
    /// above it is left out.
    Logarithmic,
}

impl Curve<'_> {
    fn colour(&self, visuals: &Visuals) -> Color32 {
        if self.faint {
            visuals.weak_text_color()
        } else {
            visuals.strong_text_color()
        }
    }
}

/// Curves that share an axis.
pub(super) struct Chart<'a> {
    /// What is drawn, told to those who cannot see it.
    pub(super) label: &'a str,
    /// Unit of the values, and what they are.
    pub(super) axis: &'a str,
    pub(super) curves: Vec<Curve<'a>>,
    pub(super) height: f32,
    pub(super) division: Axis,
    /// Whether the light is drawn in its colours below the first curve, whose points lie this far apart (nm).
    pub(super) in_colour: Option<f64>,
}

/// A chart in which nothing moves by accident, of this height in points.
pub(super) fn still_plot<'a>(id: impl AsIdSalt, height: f32) -> Plot<'a> {
    Plot::new(id)
        .height(height)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
}

impl Chart<'_> {
    /// Draws it over the width there is.
    pub(super) fn show(self, ui: &mut Ui) {
        let logarithmic = self.division == Axis::Logarithmic;
        let value_of = move |y: f64| if logarithmic { 10_f64.powf(y) } else { y };
        if self.curves.len() > 1 {
            legend(ui, &self.curves);
        }
        let is_empty = self.curves.iter().all(|curve| curve.points.is_empty());
        let told: Vec<(String, Vec<[f64; 2]>)> = self
            .curves
            .iter()
            .map(|curve| (curve.name.to_owned(), curve.points.clone()))
            .collect();
        let words = RichText::new(self.axis).small().weak();
        // What an empty chart shows must not stay when there is a curve.
        let mut plot = still_plot((self.label, is_empty), self.height)
            .default_x_bounds(VISIBLE_NM[0], VISIBLE_NM[1])
            .auto_bounds([false, true])
            .set_margin_fraction(vec2(0.0, 0.05))
            .x_grid_spacer(|_| wavelength_marks())
            .y_grid_spacer(move |seen| {
                let (low, high) = seen.bounds;
                let mut marks = value_marks(seen.bounds, logarithmic);
                marks.retain(|mark| mark.value == 0.0 || mark.value - low > CORNER * (high - low));
                marks
            })
            .x_axis_formatter(|mark, _| format!("{:.0} nm", mark.value))
            .y_axis_label(words)
            .y_axis_formatter(move |mark, _| short(value_of(mark.value)))
            .y_axis_min_width(58.0)
            .label_formatter(move |at| {
                let (HoverPosition::NearDataPoint { position, .. }
                | HoverPosition::Elsewhere { position }) = at;
                Some(told_at(position.x, &told))
            });
        if is_empty {
            plot = plot
                .default_y_bounds(0.0, 1.0)
                .auto_bounds(false)
                .y_axis_formatter(|_, _| String::new());
        } else if self.division == Axis::FromZero {
            plot = plot.include_y(0.0);
        }
        let visuals = ui.visuals().clone();
        let curves = self.curves;
        let bottom = bottom_of(&curves);
        let in_colour = self.in_colour;
        let shown = plot.show(ui, |plot| {
            for curve in curves {
                let colour = curve.colour(&visuals);
                let points: Vec<[f64; 2]> = if logarithmic {
                    let is_lit = curve.points.iter().any(|[_, y]| *y > 0.0);
                    let points = curve.points.iter().filter(|_| is_lit);
                    points.map(|&[nm, y]| [nm, y.max(bottom).log10()]).collect()
                } else {
                    curve.points
                };
                if points.is_empty() {
                    continue;
                }
                if let Some(width) = in_colour {
                    plot.bar_chart(light_below(&points, width));
                }
                plot.line(
                    Line::new(curve.name, PlotPoints::from(points))
                        .color(colour)
                        .width(1.5)
                        .style(curve.style),
                );
            }
        });
        let label = self.label;
        shown
            .response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
    }
}

/// Where a logarithmic axis ends for curves of which some are 0 in places: low enough that a line stands out, and
/// never so low that the rest is a line along the top.
fn bottom_of(curves: &[Curve<'_>]) -> f64 {
    let values = curves.iter().flat_map(|curve| &curve.points);
    let values = values.map(|[_, y]| *y).filter(|y| y.is_finite());
    let (lit, dark): (Vec<f64>, Vec<f64>) = values.partition(|y| *y > 0.0);
    let peak = lit.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let lowest = lit.into_iter().fold(peak, f64::min);
    let most = if dark.is_empty() { peak } else { 1e-3 * peak };
    lowest.clamp(1e-12 * peak, most).max(f64::MIN_POSITIVE)
}

/// The curves' names, each behind a piece of its line. Above the chart, where it hides none of them.
fn legend(ui: &mut Ui, curves: &[Curve<'_>]) {
    ui.horizontal(|ui| {
        for curve in curves {
            let (rect, _) = ui.allocate_exact_size(vec2(26.0, 10.0), Sense::hover());
            let line = [rect.left_center(), rect.right_center()];
            let stroke = Stroke::new(1.5, curve.colour(ui.visuals()));
            if curve.style == LineStyle::Solid {
                ui.painter().line_segment(line, stroke);
            } else {
                ui.painter()
                    .extend(Shape::dashed_line(&line, stroke, 7.0, 4.0));
            }
            ui.label(RichText::new(curve.name).small());
        }
    });
}

/// The curves' values at the wavelength under the pointer.
fn told_at(lambda_nm: f64, curves: &[(String, Vec<[f64; 2]>)]) -> String {
    let nearest = |points: &[[f64; 2]]| {
        let after = points.partition_point(|[nm, _]| *nm < lambda_nm);
        let near = [after.saturating_sub(1), after].map(|at| points.get(at).copied());
        let distance = |point: &[f64; 2]| (point[0] - lambda_nm).abs();
        near.into_iter()
            .flatten()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let lines = curves.iter().filter_map(|(name, points)| {
        let [nm, value] = nearest(points)?;
        Some(format!("{nm:.0} nm   {name} {}", short(value)))
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Marks of the wavelengths: every 100 nm, and fainter halfway.
fn wavelength_marks() -> Vec<GridMark> {
    let [first, last] = VISIBLE_NM.map(|nm| (nm / 50.0).floor() as i32);
    let marks = (first..=last).map(|i| GridMark {
        value: 50.0 * f64::from(i),
        step_size: if i % 2 == 0 { 100.0 } else { 50.0 },
    });
    marks.collect()
}

/// Into how many steps an axis of values is divided at most: more, and their numbers would not fit beside it.
const MOST_STEPS: f64 = 5.0;

/// Marks of the values at round numbers; on a logarithmic axis at the powers of ten, and where these are
/// few at twice and five times as much.
fn value_marks((low, high): (f64, f64), logarithmic: bool) -> Vec<GridMark> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let step = round_step(span / MOST_STEPS);
    let at = |value: f64, step_size: f64| GridMark { value, step_size };
    let multiples = |step: f64| {
        let (first, last) = ((low / step).ceil(), (high / step).floor());
        (0..=(last - first) as u32).map(move |i| (first + f64::from(i)) * step)
    };
    if !logarithmic {
        return multiples(step).map(|value| at(value, step)).collect();
    }
    let between: &[f64] = if span < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let decades = multiples(step.max(1.0).ceil());
    // A decade below the lowest power has marks that are seen, too.
    let decades = std::iter::once(low.floor()).chain(decades);
    let marks =
        decades.flat_map(|decade| between.iter().map(move |factor| decade + factor.log10()));
    let mut marks: Vec<f64> = marks.filter(|mark| (low..=high).contains(mark)).collect();
    marks.dedup();
    marks.into_iter().map(|value| at(value, 1.0)).collect()
}

/// The smallest of 1, 2, 5 and 10 times a power of ten that is not below a length.
fn round_step(length: f64) -> f64 {
    let power = 10_f64.powf(length.log10().floor());
    let mut times = [1.0, 2.0, 5.0].into_iter();
    times.find(|times| times * power >= length).unwrap_or(10.0) * power
}

/// Bars in the colour of their wavelength, as high as the curve.
fn light_below(points: &[[f64; 2]], width: f64) -> BarChart {
    let bars = points.iter().map(|&[nm, y]| {
        // A little wider, so that no seam is seen between two.
        Bar::new(nm, y)
            .width(1.3 * width)
            .fill(colour_of(nm))
            .stroke(Stroke::NONE)
    });
    BarChart::new("", bars.collect()).allow_hover(false)
}

/// A wavelength's colour, made a little paler, for no display has it; dark where the eye hardly sees.
fn colour_of(lambda_nm: f64) -> Color32 {
    let xyz = cie::colour_matching(lambda_nm);
    let rgb = rgb_from_xyz() * DVec3::from_array(xyz);
    let rgb = (rgb - PALER * rgb.min_element().min(0.0)).max(DVec3::ZERO);
    // The square root keeps red and violet visible, whose share of the eye's answer is small.
    let seen = DVec3::from_array(xyz).max_element().min(1.0).sqrt();
    let shown = rgb / rgb.max_element().max(1e-9) * seen;
    let [red, green, blue] = shown
        .to_array()
        .map(|v| (255.0 * srgb_encode(v as f32)).round() as u8);
    Color32::from_rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_neither_few_nor_many() {
        for (low, high) in [
            (0.0, 7.3),
            (41.38, 42.9),
            (-3.0, 450.0),
            (0.0, 1e-26),
            (1e5, 9e5),
        ] {
            let marks = value_marks((low, high), false);
            assert!(
                (2..=6).contains(&marks.len()),
                "{low} to {high}: {}",
                marks.len()
            );
            assert!(marks.iter().all(|mark| (low..=high).contains(&mark.value)));
        }
        assert!(value_marks((0.0, 0.0), false).is_empty());
        assert!(value_marks((0.0, f64::NAN), true).is_empty());
    }

    #[test]
    fn logarithmic_marks_are_powers_and_a_little_between() {
        let told = |low: f64, high: f64| -> Vec<String> {
            let marks = value_marks((low.log10(), high.log10()), true);
            marks
                .iter()
                .map(|mark| short(10_f64.powf(mark.value)))
                .collect()
        };
        assert_eq!(told(0.03, 30.0), ["0.1", "1", "10"]);
        assert_eq!(told(4.0, 60.0), ["5", "10", "20", "50"]);
        assert!(told(1e-20, 1e3).len() < 12);
    }

    #[test]
    fn a_lone_line_stands_on_the_bottom_of_a_logarithmic_axis() {
        let curve = |values: &[f64]| Curve {
            name: "",
            points: values.iter().map(|&y| [500.0, y]).collect(),
            style: LineStyle::Solid,
            faint: false,
        };
        let bottom = |values: &[f64]| bottom_of(&[curve(values)]);
        assert!((bottom(&[0.0, 40.0, 50.0, 0.0]) - 0.05).abs() < 1e-12);
        assert_eq!(bottom(&[2.0, 40.0]), 2.0);
        assert_eq!(bottom(&[0.0, 1e-5, 1.0]), 1e-5);
        assert!(bottom(&[0.0]) > 0.0 && bottom(&[]) > 0.0);
    }

    #[test]
    fn the_value_told_is_the_curves_own() {
        let curves = [("Light".to_owned(), vec![[400.0, 1.0], [500.0, 2.0]])];
        assert_eq!(told_at(460.0, &curves), "500 nm   Light 2");
        assert_eq!(told_at(300.0, &curves), "400 nm   Light 1");
        assert_eq!(told_at(900.0, &curves), "500 nm   Light 2");
    }

    #[test]
    fn colours_run_from_violet_to_red_and_fade_at_the_ends() {
        let [violet, green, red] = [440.0, 530.0, 620.0].map(colour_of);
        assert!(violet.b() > violet.r() && violet.r() > violet.g());
        assert!(green.g() > green.r() && green.g() > green.b());
        assert!(red.r() > 2 * red.g().max(red.b()));
        assert!(colour_of(385.0).b() < violet.b() / 2 && colour_of(775.0).r() < red.r() / 2);
    }
}
