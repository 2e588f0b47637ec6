//! What accuracy costs in the scene on show: seconds of the march along the bottom, error up the side, both in equal factors. The pale line
//! is what is expected of the best choices, dots are what was measured, the ring is the picture on show. A click adopts a dot.

use egui::{Color32, RichText, Role, Sense, Ui, Vec2, WidgetInfo};
use egui_plot::{
    GridMark, HLine, Line, LineStyle, MarkerShape, PlotBounds, PlotPoint, PlotPoints, Points,
};

use super::chart::still_plot;
use crate::app::accuracy::{Accuracy, Told};
use crate::app::panels::{Command, short};
use crate::engine::Engine;
use crate::project::Job;
use crate::study::{Choice, Family, Numbers, Point, Status};

/// Height of the chart in points.
const HEIGHT: f32 = 260.0;
/// How near to a dot a pointer means it, in points.
const NEAR: f32 = 12.0;
/// Decades beyond the outermost dots.
const MARGIN: f64 = 0.2;

/// One dot.
struct Dot {
    /// Logarithms of seconds and of the error.
    at: [f64; 2],
    family: Option<Family>,
    numbers: Numbers,
    words: String,
    /// Why it is not to be trusted; empty if nothing is wrong.
    against: String,
}

/// Draws the chart; a click on a dot asks for its numbers.
pub(super) fn show(
    ui: &mut Ui,
    accuracy: &Accuracy,
    job: Option<&Job>,
    told: Option<&Told>,
    commands: &mut Vec<Command>,
) {
    let (Some(job), Some(told)) = (job, told) else {
        ui.label(if job.is_some_and(|job| accuracy.sees_nothing(job)) {
            "Nothing is seen in this picture: there is no error to speak of."
        } else {
            "The scene is looked at as soon as there is a fine picture of it."
        });
        return;
    };
    let Some(pilot) = accuracy.pilot(job) else {
        return;
    };
    let of_choice = |choice: &Choice| place(choice.cpu_s, choice.error.all.de95);
    let expected = on_front(pilot.table());
    let (points, of) = accuracy.points(job);
    let dots = dots(&expected, points);
    ui.label(progress_words(points.len(), of));
    let ends = ends(dots.iter().map(|dot| dot.at).chain([of_choice(&told.here)]));
    let label = "Error against seconds";
    let front: Vec<[f64; 2]> = expected.iter().map(|it| of_choice(it)).collect();
    let here = of_choice(&told.here);
    let plot = still_plot("accuracy", HEIGHT)
        .x_grid_spacer(|seen| decades(seen.bounds))
        .y_grid_spacer(|seen| decades(seen.bounds))
        .x_axis_formatter(|mark, _| format!("{} s", short(10_f64.powf(mark.value))))
        .y_axis_formatter(|mark, _| short(10_f64.powf(mark.value)))
        .y_axis_label(RichText::new("error, ΔE (95 %)").small().weak())
        .y_axis_min_width(58.0)
        .label_formatter(|_| None);
    let strong = ui.visuals().strong_text_color();
    let (weak, is_dark) = (ui.visuals().weak_text_color(), ui.visuals().dark_mode);
    let shown = plot.show(ui, |plot| {
        plot.set_plot_bounds(PlotBounds::from_min_max(ends[0], ends[1]));
        plot.hline(
            HLine::new("just seen", 0.0)
                .color(weak)
                .style(LineStyle::dashed_loose()),
        );
        let line = Line::new("expected", PlotPoints::from(front));
        plot.line(line.color(strong.gamma_multiply(0.35)).width(5.0));
        for dot in dots.iter().filter(|dot| dot.family.is_some()) {
            let mark = Points::new("", PlotPoints::from(vec![dot.at]));
            let mark = mark
                .color(dot.family.map_or(weak, |it| colour(it, is_dark)))
                .radius(4.0)
                .shape(MarkerShape::Circle);
            plot.points(mark.filled(dot.against.is_empty()));
        }
        let ring = Points::new("this picture", PlotPoints::from(vec![here]));
        plot.points(
            ring.color(strong)
                .radius(8.0)
                .filled(false)
                .shape(MarkerShape::Circle),
        );
    });
    shown
        .response
        .widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
    let pointer = shown.response.hover_pos();
    let near = pointer.and_then(|pointer| {
        let on_screen = |dot: &&Dot| {
            let at = PlotPoint::new(dot.at[0], dot.at[1]);
            (shown.transform.position_from_point(&at) - pointer).length()
        };
        let dots = dots.iter().filter(|dot| on_screen(dot) < NEAR);
        dots.min_by(|one, other| on_screen(one).total_cmp(&on_screen(other)))
    });
    let clicked = shown.response.clicked();
    if let Some(dot) = near {
        shown.response.on_hover_ui_at_pointer(|ui| {
            let [seconds, de] = dot.at.map(|it| 10_f64.powf(it));
            ui.label(&dot.words);
            ui.label(format!(
                "{} ΔE in {} s. A click adopts it.",
                short(de),
                short(seconds)
            ));
            if !dot.against.is_empty() {
                ui.label(&dot.against);
            }
        });
        if clicked {
            commands.push(Command::Adopt(dot.numbers));
        }
    }
    legend(ui);
}

/// Logarithms of seconds, of this many threads, and of the error.
fn place(cpu_s: f64, de: f64) -> [f64; 2] {
    let threads = Engine::threads_beside_a_window() as f64;
    [(cpu_s / threads).log10(), de.log10()]
}

/// What is expected, and what was measured.
fn dots(expected: &[&Choice], points: &[Point]) -> Vec<Dot> {
    let expected = expected.iter().map(|choice| Dot {
        at: place(choice.cpu_s, choice.error.all.de95),
        family: None,
        numbers: choice.numbers,
        words: format!("{}, expected", choice.numbers.in_words()),
        against: String::new(),
    });
    let measured = points
        .iter()
        .filter(|it| !matches!(it.status, Status::Failed(_)));
    let measured = measured.map(|it| Dot {
        at: place(it.march.cpu_s, it.error.de95),
        family: Some(it.variant.family),
        numbers: it.variant.numbers,
        words: format!("{}, measured", it.variant.in_words()),
        against: it.status.reason().to_owned(),
    });
    let all = expected.chain(measured);
    all.filter(|dot| dot.at.iter().all(|it| it.is_finite()))
        .collect()
}

fn progress_words(known: usize, of: usize) -> String {
    match (known, of) {
        (0, _) => "The line is expected; measuring begins when the picture is done.".to_owned(),
        (known, of) if known < of => format!("{known} of {of} measured, in the background"),
        (known, _) => format!("{known} measured"),
    }
}

/// What each colour is.
fn legend(ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let is_dark = ui.visuals().dark_mode;
        for family in Family::ALL {
            let (rect, _) = ui.allocate_exact_size(Vec2::splat(10.0), Sense::hover());
            ui.painter()
                .circle_filled(rect.center(), 4.0, colour(family, is_dark));
            ui.label(RichText::new(family.title()).small());
        }
    });
}

/// Okabe and Ito's colours (2008), lightened where the ground is dark, and two of them darkened where it is light.
fn colour(family: Family, is_dark: bool) -> Color32 {
    let [red, green, blue] = match family {
        Family::Chosen if is_dark => [240, 228, 66],
        Family::Chosen => [130, 120, 0],
        Family::Step => [213, 94, 0],
        Family::Wavelengths => [40, 140, 210],
        Family::Samples => [0, 158, 115],
        Family::Interpolation => [204, 121, 167],
        Family::Effects => [230, 159, 0],
        Family::Baked if is_dark => [120, 200, 240],
        Family::Baked => [0, 60, 140],
    };
    Color32::from_rgb(red, green, blue)
}

/// The choices that no other is both quicker and nearer than, quickest first.
fn on_front(table: &[Choice]) -> Vec<&Choice> {
    let mut all: Vec<&Choice> = table.iter().collect();
    all.sort_by(|one, other| one.cpu_s.total_cmp(&other.cpu_s));
    let mut least = f64::INFINITY;
    all.retain(|choice| {
        let is_better = choice.error.all.de95 < least;
        least = least.min(choice.error.all.de95);
        is_better
    });
    all
}

/// Lowest and highest corner around some places.
fn ends(places: impl Iterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let [low, high] = places.fold(none, |[low, high], place| {
        let low = std::array::from_fn(|axis| place[axis].min(low[axis]));
        let high = std::array::from_fn(|axis| place[axis].max(high[axis]));
        [low, high]
    });
    [
        low.map(|it: f64| it - MARGIN),
        high.map(|it: f64| it + MARGIN),
    ]
}

/// Marks at 1, 2 and 5 times the powers of ten.
fn decades((low, high): (f64, f64)) -> Vec<GridMark> {
    let decades = (low.floor() as i32..=high.ceil() as i32).flat_map(|decade| {
        [1.0_f64, 2.0, 5.0].map(|times| GridMark {
            value: f64::from(decade) + times.log10(),
            step_size: if times == 1.0 { 1.0 } else { 0.5 },
        })
    });
    decades
        .filter(|mark| (low..=high).contains(&mark.value))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within() {
        let marks = decades((-1.1, 0.4));
        let values: Vec<f64> = marks.iter().map(|mark| 10_f64.powf(mark.value)).collect();
        for (found, expected) in values.iter().zip([0.1, 0.2, 0.5, 1.0, 2.0]) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{values:?}");
        }
        assert_eq!(values.len(), 5);
    }
}
