//! What all charts of the window have in common: wavelengths along the bottom, a unit up the side, and nothing that
//! moves by accident.

use egui::{Color32, RichText, Role, Ui, WidgetInfo};
use egui_plot::{Bar, BarChart, HoverPosition, Legend, Line, LineStyle, Plot, PlotPoints};

use crate::app::panels::short;
use crate::app::theme::IDLE;
use crate::colour::cie;
use crate::colour::xyz::{rgb_from_xyz, srgb_encode};

/// Ends of the wavelengths that are shown, nm.
pub(super) const VISIBLE_NM: [f64; 2] = [380.0, 780.0];

/// A curve against wavelength.
pub(super) struct Curve<'a> {
    pub(super) name: &'a str,
    /// Wavelength (nm) and value.
    pub(super) points: Vec<[f64; 2]>,
    pub(super) style: LineStyle,
}

/// Curves that share an axis.
pub(super) struct Chart<'a> {
    /// What is drawn, told to those who cannot see it.
    pub(super) label: &'a str,
    /// Unit of the values, and what they are.
    pub(super) axis: &'a str,
    pub(super) curves: Vec<Curve<'a>>,
    pub(super) height: f32,
    /// Whether the values' axis is logarithmic; what is not above 0 is left out then.
    pub(super) logarithmic: bool,
    /// Whether the light is drawn in its colours below the first curve, whose points lie this far apart (nm).
    pub(super) in_colour: Option<f64>,
}

impl Chart<'_> {
    /// Draws it over the width there is.
    pub(super) fn show(self, ui: &mut Ui) {
        let logarithmic = self.logarithmic;
        let value_of = move |y: f64| if logarithmic { 10_f64.powf(y) } else { y };
        let words = RichText::new(self.axis).small().color(IDLE);
        let mut plot = Plot::new(self.label)
            .height(self.height)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_axis_zoom_drag(false)
            .include_x(VISIBLE_NM[0])
            .include_x(VISIBLE_NM[1])
            .x_axis_formatter(|mark, _| format!("{:.0} nm", mark.value))
            .y_axis_label(words)
            .y_axis_formatter(move |mark, _| short(value_of(mark.value)))
            .y_axis_min_width(58.0)
            .label_formatter(move |at| {
                let (HoverPosition::NearDataPoint {
                    position: point, ..
                }
                | HoverPosition::Elsewhere { position: point }) = at;
                Some(format!("{:.0} nm: {}", point.x, short(value_of(point.y))))
            });
        if !logarithmic {
            plot = plot.include_y(0.0);
        }
        if self.curves.len() > 1 {
            plot = plot.legend(Legend::default().background_alpha(0.5));
        }
        let colour = ui.visuals().strong_text_color();
        let curves = self.curves;
        let in_colour = self.in_colour;
        let shown = plot.show(ui, |plot| {
            for curve in curves {
                let points: Vec<[f64; 2]> = if logarithmic {
                    let lit = curve.points.iter().filter(|[_, y]| *y > 0.0);
                    lit.map(|&[nm, y]| [nm, y.log10()]).collect()
                } else {
                    curve.points
                };
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

/// Bars in the colour of their wavelength, as high as the curve.
fn light_below(points: &[[f64; 2]], width: f64) -> BarChart {
    let bars = points.iter().map(|&[nm, y]| {
        Bar::new(nm, y)
            .width(width)
            .fill(colour_of(nm))
            .stroke(egui::Stroke::NONE)
    });
    BarChart::new("", bars.collect()).allow_hover(false)
}

/// A wavelength's colour, as near as a display comes to it; dark where the eye hardly sees.
fn colour_of(lambda_nm: f64) -> Color32 {
    let xyz = cie::colour_matching(lambda_nm);
    let rgb = rgb_from_xyz() * glam::DVec3::from_array(xyz);
    let rgb = rgb.max(glam::DVec3::ZERO);
    // The square root keeps red and violet visible, whose share of the eye's answer is small.
    let seen = xyz[0].max(xyz[1]).max(xyz[2]).min(1.0).sqrt();
    let shown = rgb / rgb.max_element().max(1e-9) * seen;
    let [red, green, blue] = shown
        .to_array()
        .map(|v| (255.0 * srgb_encode(v as f32)).round() as u8);
    Color32::from_rgb(red, green, blue)
}
