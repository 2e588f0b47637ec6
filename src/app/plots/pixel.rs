//! The light of one pixel: of the one under the pointer, or of one that was clicked.

use egui::{Color32, Context, LayerId, RichText, Sense, Stroke, StrokeKind, Ui, vec2};
use egui_plot::LineStyle;

use super::chart::{Axis, Chart, Curve};
use crate::app::canvas::PicturePlace;
use crate::app::panels::short;
use crate::app::theme::IDLE;
use crate::colour::display::{BakedView, View};
use crate::engine::{Engine, Generation, Packed};
use crate::render::Probe;
use crate::render::develop::can_be_seen;

/// Height of the chart in points.
const HEIGHT: f32 = 210.0;
/// Radius of the ring around a kept pixel, points.
const RING: f32 = 7.0;

/// The pixel and its light.
#[derive(Default)]
pub(super) struct PixelPlot {
    /// Where it is, as shares of the picture's sides.
    share: Option<[f64; 2]>,
    /// Whether it stays where it is, whatever the pointer does.
    kept: bool,
    reading: Option<Reading>,
}

/// What was read, and of what.
struct Reading {
    generation: Generation,
    pixel: [u32; 2],
    probe: Probe,
}

impl PixelPlot {
    /// Reads the pixel if it or its picture is another, and draws what was read.
    pub(super) fn show(&mut self, ui: &mut Ui, engine: &Engine, view: &View, place: &PicturePlace) {
        self.follow(place);
        self.read(engine);
        let reading = self.reading.as_ref();
        self.kept &= !heading(ui, reading, self.kept);
        let probe = reading.map(|reading| &reading.probe);
        ui.horizontal(|ui| {
            swatch(ui, probe, view);
            ui.label(probe.map_or_else(String::new, words_of));
        });
        // What cannot be seen has no curve: its shape would be that of rounding.
        let lit = probe.filter(|probe| can_be_seen(probe.xyz[1]));
        let points = lit.map_or_else(Vec::new, |probe| probe.spectrum.clone());
        let band = points.iter().zip(points.iter().skip(1)).next();
        Chart {
            label: "Spectral radiance of the pixel against wavelength",
            axis: "radiance, W/(m² sr nm)",
            height: HEIGHT,
            division: Axis::FromZero,
            in_colour: band.map(|(first, second)| second[0] - first[0]),
            curves: vec![Curve {
                name: "Radiance",
                points,
                style: LineStyle::Solid,
                faint: false,
            }],
        }
        .show(ui);
    }

    /// Rings the pixel that a click has kept.
    pub(super) fn mark(&self, ctx: &Context, place: &PicturePlace) {
        let Some([x, y]) = self.share.filter(|_| self.kept) else {
            return;
        };
        let at = place.picture.min + place.picture.size() * vec2(x as f32, y as f32);
        if place.canvas.contains(at) {
            let painter = ctx
                .layer_painter(LayerId::background())
                .with_clip_rect(place.canvas);
            // Dark beside light: seen on black and on white.
            painter.circle_stroke(at, RING, Stroke::new(3.0, Color32::from_black_alpha(140)));
            painter.circle_stroke(at, RING, Stroke::new(1.0, Color32::from_gray(235)));
        }
    }

    /// Goes where the pointer is, unless a click has kept a pixel.
    fn follow(&mut self, place: &PicturePlace) {
        let Some(pointer) = place.pointer else { return };
        if place.clicked {
            self.kept = true;
            self.share = Some(pointer);
        } else if !self.kept {
            self.share = Some(pointer);
        }
    }

    /// Marches a ray if there is something new to read; what was read last stands until then.
    fn read(&mut self, engine: &Engine) {
        let Some((share, packed)) = self.share.zip(engine.scene()) else {
            return;
        };
        let Packed {
            generation,
            scene,
            size,
        } = packed;
        let pixel = [0, 1].map(|axis| {
            let at = share[axis] * f64::from(size[axis]);
            (at as u32).min(size[axis] - 1)
        });
        let known = self
            .reading
            .as_ref()
            .is_some_and(|known| known.generation == generation && known.pixel == pixel);
        if known {
            return;
        }
        let centre = pixel.map(|at| f64::from(at) + 0.5);
        if let Ok(probe) = Probe::new(&scene, size, centre) {
            self.reading = Some(Reading {
                generation,
                pixel,
                probe,
            });
        }
    }
}

/// Which pixel it is, and whether it is kept. True if it shall be let go.
fn heading(ui: &mut Ui, reading: Option<&Reading>, kept: bool) -> bool {
    ui.horizontal(|ui| {
        let words = reading.map_or_else(
            || "Point at the picture".to_owned(),
            |Reading { pixel: [x, y], .. }| format!("Pixel {x}, {y}"),
        );
        ui.label(words);
        if kept {
            let button = ui.small_button("Follow the pointer");
            let tip = "Let the pixel go that a click has kept.";
            button.on_hover_text(tip).clicked()
        } else {
            ui.label(RichText::new("a click on the picture keeps it").color(IDLE));
            false
        }
    })
    .inner
}

/// The pixel's colour as the picture shows it.
fn swatch(ui: &mut Ui, probe: Option<&Probe>, view: &View) {
    let (rect, _) = ui.allocate_exact_size(vec2(22.0, 16.0), Sense::hover());
    let [red, green, blue] = BakedView::new(view)
        .apply(probe.map_or([0.0; 3], |probe| probe.xyz.map(|v| v as f32)))
        .map(|v| (255.0 * v).round() as u8);
    ui.painter()
        .rect_filled(rect, 2.0, Color32::from_rgb(red, green, blue));
    let edge = Stroke::new(1.0, Color32::from_gray(90));
    ui.painter()
        .rect_stroke(rect, 2.0, edge, StrokeKind::Inside);
}

/// Brightness and colour in words.
fn words_of(probe: &Probe) -> String {
    let visible = can_be_seen(probe.xyz[1]);
    let Some([x, y]) = probe.chromaticity().filter(|_| visible) else {
        return "0 cd/m², black".to_owned();
    };
    let mut words = format!("{} cd/m²   x {x:.3}  y {y:.3}", short(probe.luminance()));
    if let Some(kelvin) = probe.black_body_k() {
        words = format!("{words}   as a black body of {kelvin:.0} K");
    }
    words
}
