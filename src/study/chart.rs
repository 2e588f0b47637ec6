//! The work-precision chart: seconds along the bottom, error up the side, both in equal factors; further down and further left
//! is better.

use std::error::Error as StdError;

use plotters::coord::Shift;
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use thiserror::Error;

use super::report::{Point, Report, Status};
use super::variant::Family;

/// Width and height of the chart in pixels.
const SIZE: (u32, u32) = (1280, 860);
/// What scalable graphics ask their reader for; for pixels it is our own font, the same everywhere.
const FONT: &str = "sans-serif";
/// A difference that is just seen.
const SEEN_DE: f64 = 1.0;

/// Why there is no chart.
#[derive(Debug, Error)]
#[error("the chart cannot be drawn: {0}")]
pub struct ChartError(String);

/// A report, to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct Chart<'a> {
    /// What was measured.
    pub report: &'a Report,
    /// What the scene is called.
    pub title: &'a str,
}

type Plane<'a, DB> = ChartContext<'a, DB, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

impl Chart<'_> {
    /// As scalable vector graphics.
    ///
    /// # Errors
    /// [`ChartError`]: nothing was measured.
    pub fn to_svg(self) -> Result<String, ChartError> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area())?;
        Ok(text)
    }

    /// As red, green and blue bytes, row by row, with width and height in pixels.
    ///
    /// # Errors
    /// As [`Chart::to_svg`].
    pub fn to_rgb(self) -> Result<(Vec<u8>, [u32; 2]), ChartError> {
        let mut pixels = vec![0; 3 * SIZE.0 as usize * SIZE.1 as usize];
        self.draw(&BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area())?;
        Ok((pixels, [SIZE.0, SIZE.1]))
    }

    fn draw<DB: DrawingBackend>(self, area: &DrawingArea<DB, Shift>) -> Result<(), ChartError>
    where
        DB::ErrorType: 'static,
    {
        // The same font again is no error.
        let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        self.lay_out(area)
            .map_err(|error| ChartError(error.to_string()))
    }

    fn lay_out<DB: DrawingBackend>(
        self,
        area: &DrawingArea<DB, Shift>,
    ) -> Result<(), Box<dyn StdError>>
    where
        DB::ErrorType: 'static,
    {
        area.fill(&WHITE)?;
        let failed = self.report.points.iter().filter(|it| !is_placed(it));
        let failed: Vec<String> = failed
            .map(|it| format!("{}: {}", it.variant.in_words(), it.status.reason()))
            .collect();
        let below = 26 * (1 + failed.len() as u32);
        let (above, caption) =
            area.split_vertically(SIZE.1.saturating_sub(below + 10).max(SIZE.1 / 2));
        let placed = self
            .report
            .points
            .iter()
            .filter(|it: &&Point| is_placed(it));
        let places: Vec<[f64; 2]> = placed.map(place).collect();
        let [x, y] = [0, 1].map(|axis| around(places.iter().map(|place| place[axis])));
        let [x, y] = [
            x.ok_or("nothing was measured")?,
            y.ok_or("nothing was measured")?,
        ];
        let y = y.start.min(0.5 * SEEN_DE)..y.end.max(2.0 * SEEN_DE);
        let mut plane = ChartBuilder::on(&above)
            .caption(format!("What accuracy costs: {}", self.title), (FONT, 28))
            .margin(14)
            .x_label_area_size(52)
            .y_label_area_size(76)
            .build_cartesian_2d(x.clone().log_scale(), y.log_scale())?;
        plane
            .configure_mesh()
            .x_desc("seconds for the whole picture")
            .y_desc("error, ΔE_ITP (95 % of lit pixels are nearer)")
            .x_labels(14)
            .y_labels(14)
            .x_label_formatter(&|value| label(*value))
            .y_label_formatter(&|value| label(*value))
            .label_style((FONT, 17))
            .axis_desc_style((FONT, 19))
            .light_line_style(RGBColor(240, 240, 240))
            .bold_line_style(RGBColor(215, 215, 215))
            .draw()?;
        let seen = [(x.start, SEEN_DE), (x.end, SEEN_DE)];
        plane.draw_series(DashedLineSeries::new(
            seen,
            8,
            6,
            BLACK.mix(0.6).stroke_width(1),
        ))?;
        let at_left = (x.start, SEEN_DE);
        plane.draw_series([EmptyElement::at(at_left)
            + Text::new(
                "ΔE = 1: just seen",
                (8, -20),
                (FONT, 17).into_font().color(&BLACK.mix(0.7)),
            )])?;
        self.front(&mut plane)?;
        for family in Family::ALL {
            self.family(&mut plane, family)?;
        }
        self.qualities(&mut plane)?;
        plane
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .label_font((FONT, 17))
            .background_style(WHITE.mix(0.9))
            .border_style(RGBColor(200, 200, 200))
            .draw()?;
        let [width, height] = self.report.size;
        let about = format!(
            "{width} × {height} pixels, {} threads of {}; measured on {:.1} % of the pixels; the reference is off by {} ΔE itself. \
             Hollow: not to be trusted.",
            self.report.threads,
            machine(),
            100.0 * self.report.share,
            label(self.report.own.de95),
        );
        for (i, line) in std::iter::once(about).chain(failed).enumerate() {
            let at = (16, 26 * i as i32);
            caption.draw(&Text::new(
                line,
                at,
                (FONT, 17).into_font().color(&BLACK.mix(0.8)),
            ))?;
        }
        area.present()?;
        Ok(())
    }

    /// The front, broad and pale below all else.
    fn front<DB: DrawingBackend>(self, plane: &mut Plane<'_, DB>) -> Result<(), Box<dyn StdError>>
    where
        DB::ErrorType: 'static,
    {
        let on_front = self
            .report
            .points
            .iter()
            .filter(|it| it.on_front && is_placed(it));
        let mut front: Vec<[f64; 2]> = on_front.map(place).collect();
        front.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let style = RGBColor(120, 120, 120).mix(0.35).stroke_width(9);
        plane
            .draw_series(LineSeries::new(front.iter().map(|&[x, y]| (x, y)), style))?
            .label("nothing is both quicker and nearer")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], style));
        Ok(())
    }

    fn family<DB: DrawingBackend>(
        self,
        plane: &mut Plane<'_, DB>,
        family: Family,
    ) -> Result<(), Box<dyn StdError>>
    where
        DB::ErrorType: 'static,
    {
        let points = self.report.points.iter();
        let mut points: Vec<&Point> = points
            .filter(|it| it.variant.family == family && is_placed(it))
            .collect();
        points.sort_by(|one, other| place(one)[0].total_cmp(&place(other)[0]));
        if points.is_empty() {
            return Ok(());
        }
        let colour = colour(family);
        let line = points.iter().map(|it| place(it)).map(|[x, y]| (x, y));
        // Effects and interpolations are no line: each is a thing of its own.
        let is_line = !matches!(family, Family::Effects | Family::Interpolation);
        let line = line.filter(|_| is_line);
        plane
            .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
            .label(family.title())
            .legend(move |(x, y)| Circle::new((x + 12, y), 5, colour.filled()));
        plane.draw_series(points.iter().map(|it| {
            let [x, y] = place(it);
            let style = if it.status == Status::Measured {
                colour.filled()
            } else {
                colour.stroke_width(2)
            };
            Circle::new((x, y), 5, style)
        }))?;
        Ok(())
    }

    /// Where the qualities of this scene are.
    fn qualities<DB: DrawingBackend>(
        self,
        plane: &mut Plane<'_, DB>,
    ) -> Result<(), Box<dyn StdError>>
    where
        DB::ErrorType: 'static,
    {
        let mut named: Vec<([f64; 2], String)> = Vec::new();
        for (quality, numbers) in &self.report.qualities {
            let point = self.report.points.iter().find(|it| {
                it.variant.family == Family::Chosen
                    && it.variant.numbers == *numbers
                    && is_placed(it)
            });
            let Some(point) = point else { continue };
            match named.iter_mut().find(|(at, _)| *at == place(point)) {
                Some((_, names)) => *names = format!("{names}, {}", quality.name()),
                None => named.push((place(point), quality.name().to_owned())),
            }
        }
        let style = (FONT, 19).into_font().color(&BLACK);
        plane.draw_series(named.into_iter().map(|([x, y], name)| {
            EmptyElement::at((x, y))
                + Circle::new((0, 0), 9, BLACK.stroke_width(2))
                + Text::new(name, (13, -9), style.clone())
        }))?;
        Ok(())
    }
}

/// Okabe and Ito's colours (2008), which are told apart by every eye.
fn colour(family: Family) -> RGBColor {
    match family {
        Family::Chosen => RGBColor(0, 0, 0),
        Family::Step => RGBColor(213, 94, 0),
        Family::Wavelengths => RGBColor(0, 114, 178),
        Family::Samples => RGBColor(0, 158, 115),
        Family::Interpolation => RGBColor(204, 121, 167),
        Family::Effects => RGBColor(230, 159, 0),
        Family::Baked => RGBColor(86, 180, 233),
    }
}

fn is_placed(point: &Point) -> bool {
    !matches!(point.status, Status::Failed(_))
        && place(point).iter().all(|it| it.is_finite() && *it > 0.0)
}

fn place(point: &Point) -> [f64; 2] {
    [point.took.wall_s, point.error.de95]
}

/// A range around values, a little wider than they are.
fn around(values: impl Iterator<Item = f64>) -> Option<std::ops::Range<f64>> {
    const WIDER: f64 = 1.5;
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (low <= high).then(|| low / WIDER..high * WIDER)
}

/// A number of an axis in as few characters as tell it.
fn label(value: f64) -> String {
    let decimals = (1 - value.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// What the processor calls itself, where the system says it.
fn machine() -> String {
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = about.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == "model name").then(|| value.trim().to_owned())
    });
    name.unwrap_or_else(|| format!("{} on {}", std::env::consts::ARCH, std::env::consts::OS))
}
