//! What a place in the fire does to light: the curves of `sootlight spectrum`, for the fuel and the air that are set.

use egui::{RichText, Slider, Ui};
use egui_plot::LineStyle;

use super::chart::{Axis, Chart, Curve, VISIBLE_NM};
use crate::app::panels::short;
use crate::project::Job;
use crate::scene::curves::{Bands, Curves, Row, peak_of};
use crate::scene::{FlameParams, Local};

/// Distance of the curves' points, nm.
const STEP_NM: f64 = 1.0;
/// Height of a chart in points.
const HEIGHT: f32 = 140.0;
/// What the sliders span: kelvin, and soot volume fraction.
const TEMPERATURES_K: [f64; 2] = [300.0, 3000.0];
const SOOT: [f64; 2] = [1e-9, 1e-4];
/// n − 1 is drawn in millionths.
const MILLIONTH: f64 = 1e-6;

/// The place and its curves.
#[derive(Default)]
pub(super) struct OpticsPlots {
    /// The place that a person has chosen; `None`: the fire's hottest gas and densest soot.
    chosen: Option<Local>,
    logarithmic: bool,
    known: Option<Known>,
}

/// Curves, and what they are of.
struct Known {
    params: FlameParams,
    place: Local,
    rows: Result<Vec<Row>, String>,
}

impl OpticsPlots {
    /// Draws sliders for the place, and the curves of the job's fuel and air there.
    pub(super) fn show(&mut self, ui: &mut Ui, job: Option<&Job>) {
        let Some(job) = job else {
            ui.label("There is no fire yet.");
            return;
        };
        let place = self.place(ui, job);
        let rows = match self.rows(&job.flame, place) {
            Ok(rows) => rows.clone(),
            Err(words) => {
                ui.label(RichText::new(words.as_str()).color(ui.visuals().warn_fg_color));
                return;
            }
        };
        let curve = |name, style, value: fn(&Row) -> f64| Curve {
            name,
            points: rows.iter().map(|row| [row.lambda_nm, value(row)]).collect(),
            faint: style != LineStyle::Solid,
            style,
        };
        let emission = if self.logarithmic {
            Axis::Logarithmic
        } else {
            Axis::FromZero
        };
        for chart in [
            Chart {
                label: "Emission against wavelength",
                axis: "emission, W/(m³ sr nm)",
                curves: vec![curve("Emission", LineStyle::Solid, |row| {
                    row.coefficients.emission
                })],
                height: HEIGHT,
                division: emission,
                in_colour: (!self.logarithmic).then_some(STEP_NM),
            },
            Chart {
                label: "Absorption and scattering against wavelength",
                axis: "1/m",
                curves: vec![
                    curve("Absorption", LineStyle::Solid, |row| {
                        row.coefficients.absorption
                    }),
                    curve("Scattering", LineStyle::dashed_loose(), |row| {
                        row.coefficients.scattering
                    }),
                ],
                height: HEIGHT,
                division: Axis::Logarithmic,
                in_colour: None,
            },
            Chart {
                label: "Refractive index less one against wavelength",
                axis: "n − 1, millionths",
                curves: vec![curve("n − 1", LineStyle::Solid, |row| {
                    row.n_minus_1 / MILLIONTH
                })],
                height: HEIGHT,
                division: Axis::Close,
                in_colour: None,
            },
        ] {
            chart.show(ui);
        }
    }

    /// The place that is looked at, after what the sliders do to it in this frame.
    fn place(&mut self, ui: &mut Ui, job: &Job) -> Local {
        let fires = peak_of(&job.volume, &job.flame);
        let mut place = self.chosen.unwrap_or(fires);
        ui.add(
            Slider::new(
                &mut place.temperature_k,
                TEMPERATURES_K[0]..=TEMPERATURES_K[1],
            )
            .clamping(egui::SliderClamping::Edits)
            .suffix(" K")
            .fixed_decimals(0)
            .text("Temperature there"),
        )
        .on_hover_text("Of the gas and of the soot in it.");
        ui.add(
            Slider::new(&mut place.soot_volume_fraction, SOOT[0]..=SOOT[1])
                .clamping(egui::SliderClamping::Edits)
                .logarithmic(true)
                .custom_formatter(|value, _| short(value))
                .text("Soot there"),
        )
        .on_hover_text("Volume of soot in a volume of gas, before the soot amount multiplies it.");
        if place != self.chosen.unwrap_or(fires) {
            self.chosen = Some(place);
        }
        ui.horizontal(|ui| {
            ui.checkbox(&mut self.logarithmic, "Logarithmic emission")
                .on_hover_text("Equal steps of the axis are equal factors: faint bands are seen beside bright soot.");
            if self.chosen.is_some() {
                let back = ui.small_button("Back to the fire's");
                if back.on_hover_text("The hottest gas and the densest soot of this fire.").clicked() {
                    self.chosen = None;
                }
            } else {
                ui.label(RichText::new("the hottest and densest of this fire").weak());
            }
        });
        place
    }

    /// The curves, worked out when something about them has changed.
    fn rows(&mut self, params: &FlameParams, place: Local) -> &Result<Vec<Row>, String> {
        let same = |known: &Known| known.params == *params && known.place == place;
        let known = self.known.take().filter(same).unwrap_or_else(|| Known {
            params: params.clone(),
            place,
            rows: rows_of(params, place),
        });
        &self.known.insert(known).rows
    }
}

fn rows_of(params: &FlameParams, place: Local) -> Result<Vec<Row>, String> {
    let bands = Bands::new(VISIBLE_NM, STEP_NM).map_err(|error| error.to_string())?;
    Curves::new(params, place)
        .and_then(|curves| curves.rows(&bands))
        .map_err(|error| error.to_string())
}
