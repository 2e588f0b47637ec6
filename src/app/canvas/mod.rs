//! The picture on the screen: what a person sees of the film, and what the pointer and the keys do there.
//!
//! Zoom and pan of the picture belong to the canvas and start no render. Moves of the camera are only asked for: the
//! window writes them into the document.

mod buttons;
mod display;
mod moves;
mod placement;
mod sheet;
mod wipe;

use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{
    Color32, InputState, Label, Pos2, Rect, Response, Role, Sense, Shape, TextureId, Ui,
    WidgetInfo, pos2, vec2,
};

pub(super) use self::buttons::place as buttons_place;
pub use self::display::Display;
pub use self::placement::Mapping;
pub(super) use self::wipe::Beside;

use self::moves::{Moves, Space};
use self::placement::Sizes;
use self::sheet::{Content, Sheet};
use crate::colour::display::View;
use crate::engine::Picture;
use crate::scene::Camera;

/// Longest side of a texture that every graphics card takes.
const LONGEST_SIDE: u32 = 8192;

/// Between words over the canvas and its edge, points.
const GAP: f32 = 12.0;

/// Beside the picture: dark and neutral, and yet not black, so that the picture's edge is seen.
const BESIDE: Color32 = Color32::from_gray(22);

/// How soon a frame follows while a scroll runs: its end, which ends a step of undo, brings no event.
const SCROLL_END: Duration = Duration::from_millis(50);

/// Shows a picture in the space that is left for it.
pub(super) struct Canvas {
    /// `None` where nothing is drawn: a test without a graphics card.
    state: Option<RenderState>,
    /// The picture on show, and the one that it is compared with.
    sheet: Sheet,
    beside: Sheet,
    moves: Moves,
}

/// What lies over the picture.
#[derive(Clone, Copy, Default)]
pub(super) struct Over<'a> {
    /// A map of it.
    pub(super) map: Option<TextureId>,
    /// Whether what is at the display's highest level is marked.
    pub(super) marks_clipped: bool,
    /// A snapshot.
    pub(super) beside: Option<Beside<'a>>,
}

/// What came of a frame of the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shown {
    /// The space in screen pixels: the size of a picture that fits exactly.
    pub(super) size: [u32; 2],
    /// The camera after this frame's moves, if it moved.
    pub(super) camera: Option<Camera>,
    /// Whether all of the flame shall be framed.
    pub(super) frame_all: bool,
    /// Whether a scroll over the picture still runs: its frames belong together.
    pub(super) scrolling: bool,
    /// Where a hand moved the line between the snapshot and the picture, as a share of the picture's width.
    pub(super) wiped: Option<f32>,
    /// Where the picture lies on the screen, and where on it the pointer is.
    pub(super) place: PicturePlace,
}

/// The picture on the screen and the pointer on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PicturePlace {
    /// The canvas, points.
    pub(super) canvas: Rect,
    /// The picture, points; it may reach beyond the canvas.
    pub(super) picture: Rect,
    /// The pointer, as shares of the picture's width and height, while nothing lies over the picture there.
    pub(super) pointer: Option<[f64; 2]>,
    /// Whether the picture was clicked there.
    pub(super) clicked: bool,
}

impl PicturePlace {
    fn new(canvas: Rect, corner: [f64; 2], size: [f64; 2], response: &Response) -> Self {
        let [offset, size] = [corner, size].map(|[x, y]| vec2(x as f32, y as f32));
        let picture = Rect::from_min_size(canvas.min + offset, size);
        let pointer = response.hover_pos().filter(|at| picture.contains(*at));
        let share = |at: f32, from: f32, length: f32| f64::from((at - from) / length.max(1e-6));
        Self {
            canvas,
            picture,
            pointer: pointer.map(|at| {
                [
                    share(at.x, picture.min.x, picture.width()),
                    share(at.y, picture.min.y, picture.height()),
                ]
            }),
            clicked: response.clicked() && !response.double_clicked(),
        }
    }

    /// The same without a pointer that is over a snapshot: what is there is not of this picture.
    fn right_of(self, beside: &Beside<'_>) -> Self {
        let line = wipe::line_x(self.canvas, self.picture, beside);
        let is_over_it = |pointer: &[f64; 2]| {
            self.picture.min.x + pointer[0] as f32 * self.picture.width() < line
        };
        if self.pointer.as_ref().is_some_and(is_over_it) {
            return Self {
                pointer: None,
                clicked: false,
                ..self
            };
        }
        self
    }
}

impl Canvas {
    /// A canvas that draws with egui's own device.
    pub(super) fn new(state: Option<RenderState>) -> Self {
        Self {
            state,
            sheet: Sheet::new(0),
            beside: Sheet::new(1),
            moves: Moves::default(),
        }
    }

    /// Draws the picture over all that is left of `ui`, and takes what pointer and keys do to it and to the camera that
    /// the next picture is asked for with. Keys only count if they are meant for the picture.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        picture: &Picture,
        view: &View,
        camera: Option<Camera>,
        over: &Over<'_>,
        keys: bool,
    ) -> Shown {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Picture"));
        let (rect, canvas) = snapped(rect, ui.pixels_per_point());
        // Before there is a picture, the one to come is thought of.
        let ready = picture.version > 0;
        let film = if ready { picture.film().size() } else { canvas };
        let sizes = Sizes { film, canvas };
        ui.painter().rect_filled(rect, 0.0, BESIDE);
        // The picture and what is over it lie below the buttons, and yet are where those put them in this frame.
        let below = [(); 4].map(|()| ui.painter().add(Shape::Noop));
        let zoom = self.moves.placement.mapping(sizes).zoom;
        let pressed = buttons::show(ui, rect, zoom, self.moves.placement.is_fit());

        let space = Space {
            origin: rect.min,
            pixels_per_point: ui.pixels_per_point(),
            sizes,
            keys,
        };
        // A hand on the picture has left the field that it was typing into.
        if response.is_pointer_button_down_on() {
            ui.memory_mut(egui::Memory::stop_text_input);
        }
        let mut moved = camera;
        let frame_all = self.moves.take(&response, space, &pressed, &mut moved);
        let mapping = self.moves.placement.mapping(sizes);
        if mapping.zoom != zoom {
            ui.ctx().request_repaint();
        }
        let in_points = |length: f64| length / f64::from(ui.pixels_per_point());
        let place = PicturePlace::new(
            rect,
            mapping.corner.map(in_points),
            film.map(|side| in_points(mapping.zoom * f64::from(side))),
            &response,
        );
        if !self.can_show(film) {
            let longest = self.longest_side();
            let words = format!(
                "The picture is too large to be shown: a side may have {longest} pixels on this graphics card. It \
                 can still be rendered to a file."
            );
            ui.put(rect.shrink(GAP), Label::new(words).wrap());
        } else if ready {
            let content = Content {
                version: picture.version,
                film: picture.film(),
                strides: picture.strides(),
                view,
                marks_clipped: over.marks_clipped,
                mapping,
            };
            self.draw(ui, below, &place, &content, over);
        }
        let beside = over.beside.filter(|_| ready);
        let place = beside.map_or(place, |beside| place.right_of(&beside));
        let wiped = beside.and_then(|beside| wipe::show(ui, rect, place.picture, &beside));

        let scrolling = response.contains_pointer() && ui.input(InputState::is_scrolling);
        if scrolling {
            ui.ctx().request_repaint_after(SCROLL_END);
        }
        Shown {
            place,
            wiped,
            size: canvas,
            camera: moved.filter(|moved| camera != Some(*moved) && moved.view([1, 1]).is_ok()),
            frame_all,
            scrolling,
        }
    }

    /// Whether a film of this size can be shown.
    pub(super) fn can_show(&self, size: [u32; 2]) -> bool {
        let longest = self.longest_side();
        size.iter().all(|&side| side <= longest)
    }

    /// The longest side of a film that the graphics card takes, pixels.
    fn longest_side(&self) -> u32 {
        self.state.as_ref().map_or(LONGEST_SIDE, |state| {
            state.device.limits().max_texture_dimension_2d
        })
    }

    /// Draws the picture, a map of it, and the snapshot that it is compared with, in the places `below`.
    fn draw(
        &mut self,
        ui: &Ui,
        below: [egui::layers::ShapeIdx; 4],
        place: &PicturePlace,
        content: &Content<'_>,
        over: &Over<'_>,
    ) {
        let canvas = place.canvas;
        let line = over
            .beside
            .map(|beside| wipe::line_x(canvas, place.picture, &beside));
        let [mut left, mut right] = [canvas; 2];
        (left.max.x, right.min.x) = line.map_or((canvas.min.x, canvas.min.x), |x| (x, x));
        let painter = |clip: Rect| ui.painter().with_clip_rect(clip);
        if let Some(map) = over.map {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let image = Shape::image(map, place.picture, whole, Color32::WHITE);
            painter(right).set(below[1], image);
        }
        let Some(state) = &self.state else { return };
        if let Some(shape) = self.sheet.prepare(state, canvas, content) {
            ui.painter().set(below[0], shape);
        }
        let Some(beside) = &over.beside else { return };
        // A snapshot of another shape leaves room beside it.
        let ground = Shape::rect_filled(left, 0.0, BESIDE);
        painter(left).set(below[2], ground);
        let content = Content {
            version: beside.number,
            film: beside.film,
            strides: beside.strides,
            view: beside.view,
            marks_clipped: content.marks_clipped,
            mapping: content
                .mapping
                .for_another(content.film.size(), beside.film.size()),
        };
        if let Some(shape) = self.beside.prepare(state, canvas, &content) {
            painter(left).set(below[3], shape);
        }
    }
}

/// A rectangle moved to whole pixels, and how many they are.
fn snapped(rect: Rect, pixels_per_point: f32) -> (Rect, [u32; 2]) {
    let whole = |at: Pos2| [at.x, at.y].map(|v| (v * pixels_per_point).round());
    let (low, high) = (whole(rect.min), whole(rect.max));
    let size = [0, 1].map(|axis| ((high[axis] - low[axis]) as u32).clamp(1, LONGEST_SIDE));
    let point = |at: [f32; 2]| Pos2::new(at[0], at[1]) / pixels_per_point;
    (Rect::from_min_max(point(low), point(high)), size)
}
