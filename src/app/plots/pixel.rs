//! The light of one pixel: of the one under the pointer, or of one that was clicked.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use egui::{Color32, Context, LayerId, RichText, Sense, Stroke, StrokeKind, Ui, vec2};
use egui_plot::LineStyle;

use super::along;
use super::chart::{Axis, Chart, Curve};
use crate::app::canvas::PicturePlace;
use crate::app::panels::short;
use crate::colour::display::{BakedView, View};
use crate::engine::{Engine, Generation, Packed};
use crate::render::along::Along;
use crate::render::develop::can_be_seen;
use crate::render::{Probe, Prober};

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
    /// What reads the pixels of one picture.
    prober: Option<(Generation, Prober)>,
    /// The next one, while a thread works out what it needs.
    coming: Option<Receiver<(Generation, Prober)>>,
}

/// What was read, and of what.
struct Reading {
    generation: Generation,
    pixel: [u32; 2],
    probe: Probe,
    along: Along,
}

impl PixelPlot {
    /// Reads the pixel if it or its picture is another, and draws what was read.
    pub(super) fn show(&mut self, ui: &mut Ui, engine: &Engine, view: &View, place: &PicturePlace) {
        self.follow(place);
        self.read(engine, ui.ctx());
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
        if let Some(reading) = reading {
            along::show(ui, &reading.along);
        }
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
    fn read(&mut self, engine: &Engine, ctx: &Context) {
        let Some((share, packed)) = self.share.zip(engine.scene()) else {
            return;
        };
        let (generation, size) = (packed.generation, packed.size);
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
        self.fetch(&packed, ctx);
        let centre = pixel.map(|at| f64::from(at) + 0.5);
        let prober = self.prober.as_ref().filter(|(of, _)| *of == generation);
        let read = |prober: &Prober| Some((prober.read(centre).ok()?, prober.along(centre).ok()?));
        if let Some((probe, along)) = prober.and_then(|(_, prober)| read(prober)) {
            self.reading = Some(Reading {
                generation,
                pixel,
                probe,
                along,
            });
        }
    }

    /// Sees to it that there is a reader of the present picture, now or soon: what takes its time is worked out on a
    /// thread of its own, one at a time.
    fn fetch(&mut self, packed: &Packed, ctx: &Context) {
        if let Some(coming) = &self.coming {
            match coming.try_recv() {
                Ok(made) => (self.prober, self.coming) = (Some(made), None),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => self.coming = None,
            }
        }
        let generation = packed.generation;
        if self
            .prober
            .as_ref()
            .is_some_and(|(of, _)| *of == generation)
        {
            return;
        }
        let prober = Prober::new(&packed.scene, packed.size, packed.effects);
        if prober.is_ready() {
            self.prober = Some((generation, prober));
            return;
        }
        let (sender, receiver) = channel();
        let ctx = ctx.clone();
        let work = move || {
            // One core: the picture has the others.
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            if let Ok(pool) = pool {
                pool.install(|| prober.prepare());
                // A window that was closed meanwhile wants nothing any more.
                let _ = sender.send((generation, prober));
                ctx.request_repaint();
            }
        };
        let thread = std::thread::Builder::new().name("sootlight-spectrum".into());
        // Without a thread the reading before stands.
        self.coming = thread.spawn(work).is_ok().then_some(receiver);
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
            ui.label(RichText::new("a click on the picture keeps it").weak());
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
