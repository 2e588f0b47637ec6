//! The legend of false colours and of maps, over the lower right corner of the picture, above the buttons where it is narrow.

use egui::{
    Align, Color32, Frame, Label, Layout, Margin, Rect, RichText, Sense, Ui, UiBuilder, vec2,
};

use super::short;
use crate::app::canvas::buttons_place;
use crate::colour::cie::MAX_LUMINOUS_EFFICACY;
use crate::colour::display::View;
use crate::colour::false_colour::{Band, Level};

/// A legend.
pub(super) struct Legend {
    /// What stands above, if something does.
    pub(super) title: Option<String>,
    /// Colours and what they stand for, the least first.
    pub(super) rows: Vec<(Color32, String)>,
}

/// Gap to the edges of the canvas, points.
const GAP: f32 = 8.0;
/// Greatest and least height of a row, points.
const ROW: [f32; 2] = [8.0, 16.0];
/// Size of the words for the height of a row.
const WORDS: f32 = 0.72;
/// Widths of a patch of colour and of all, for the height of a row.
const PATCH: f32 = 1.6;
const WIDTH: f32 = 10.5;
/// Width with a title, which is wrapped.
const TITLED: f32 = 15.0;
/// Lines of a title, and of it what counts as a row.
const TITLE_ROWS: f32 = 2.5;

impl Legend {
    /// That of false colours.
    pub(super) fn of(view: &View) -> Self {
        let bands = view.bands();
        let white_cd_m2 = MAX_LUMINOUS_EFFICACY / view.exposure;
        let rows = bands.iter().enumerate().map(|(i, band)| {
            let end = bands.get(i + 1).map_or(f64::INFINITY, |next| next.from);
            let [r, g, b] = band.srgb;
            (Color32::from_rgb(r, g, b), words(band, end, white_cd_m2))
        });
        Self {
            title: None,
            rows: rows.collect(),
        }
    }
}

/// Draws it: what each colour stands for, the most on top.
pub(super) fn show(ui: &mut Ui, legend: &Legend, canvas: Rect) {
    let (title_rows, width) = match &legend.title {
        Some(_) => (TITLE_ROWS, TITLED),
        None => (0.0, WIDTH),
    };
    let rows = legend.rows.len() as f32 + title_rows;
    let place = |space: Rect| {
        let row = (space.height() / (rows + 1.0)).clamp(ROW[0], ROW[1]);
        let size = vec2(row * width, row * (rows + 0.5));
        (row, Rect::from_min_size(space.max - size, size))
    };
    let mut space = canvas.shrink(GAP);
    let buttons = buttons_place(canvas);
    if place(space).1.intersects(buttons) {
        space.max.y = buttons.min.y - GAP;
    }
    let (row, rect) = place(space);
    let builder = UiBuilder::new()
        .max_rect(rect)
        .layout(Layout::top_down(Align::Min));
    ui.scope_builder(builder, |ui| {
        ui.shrink_clip_rect(canvas);
        Frame::new()
            .fill(Color32::from_black_alpha(170))
            .corner_radius(4)
            .inner_margin(Margin::same((0.25 * row) as i8))
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing = vec2(0.4 * row, 0.0);
                ui.spacing_mut().interact_size.y = row;
                let text = |words: &str| {
                    let text = RichText::new(words).size(WORDS * row);
                    text.color(Color32::from_gray(235))
                };
                if let Some(title) = &legend.title {
                    ui.set_width((width - 1.0) * row);
                    ui.add(Label::new(text(title)).selectable(false).wrap());
                }
                for (colour, words) in legend.rows.iter().rev() {
                    ui.horizontal(|ui| {
                        let (patch, _) =
                            ui.allocate_exact_size(vec2(PATCH * row, row), Sense::hover());
                        ui.painter().rect_filled(patch, 0.0, *colour);
                        ui.add(Label::new(text(words)).selectable(false).extend());
                    });
                }
            });
    });
}

/// What a band stands for, where display white is so many cd m⁻².
fn words(band: &Band, end: f64, white_cd_m2: f64) -> String {
    let luminance = |share: f64| match share * white_cd_m2 {
        cd if cd < 1e5 => format!("{} cd/m²", short(cd)),
        cd => format!("{} kcd/m²", short(1e-3 * cd)),
    };
    match band.level {
        Level::Black => format!("black, below {}", luminance(end)),
        Level::White => format!("white, from {}", luminance(band.from)),
        // Between its edges by ratio, where mid grey lies in its own.
        Level::Stop(stop) => {
            let middle = luminance((band.from * end).sqrt());
            match stop {
                0 => format!("0 mid grey, {middle}"),
                stop if stop < 0 => format!("−{}, {middle}", -stop),
                stop => format!("+{stop}, {middle}"),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_tells_its_stops_and_its_luminance() {
        let told = |level, from, end| {
            let band = Band {
                level,
                from,
                srgb: [0; 3],
            };
            words(&band, end, 1000.0)
        };
        assert_eq!(told(Level::Stop(0), 0.125, 0.25), "0 mid grey, 176.8 cd/m²");
        assert_eq!(told(Level::Stop(-3), 1.0, 4.0), "−3, 2000 cd/m²");
        assert_eq!(told(Level::Stop(7), 16.0, 25.0), "+7, 20000 cd/m²");
        assert_eq!(told(Level::Stop(7), 1000.0, 4000.0), "+7, 2000 kcd/m²");
        assert_eq!(told(Level::Black, 0.0, 0.002), "black, below 2 cd/m²");
        assert_eq!(
            told(Level::White, 32.0, f64::INFINITY),
            "white, from 32000 cd/m²"
        );
    }
}
