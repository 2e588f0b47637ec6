//! The part of the picture that is sharpened, where a person wants to see that part soon: a frame that is drawn on the picture.

use egui::{Color32, CursorIcon, Id, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, vec2};

use super::canvas::PicturePlace;
use crate::render::Region;

/// Sides below which a frame is a slip of the hand, points.
const LEAST_SIDE: f32 = 4.0;

/// The frame, and whether one is being drawn.
#[derive(Debug, Default)]
pub(super) struct RegionFrame {
    /// Two corners as shares of the picture's sides, the upper left one first.
    shares: Option<[[f64; 2]; 2]>,
    is_choosing: bool,
    /// Where the drag began, a share of the picture's sides.
    from: Option<[f64; 2]>,
}

impl RegionFrame {
    /// The part in pixels of a picture of this size; `None` where all of it is meant.
    pub(super) fn pixels(&self, size: [u32; 2]) -> Option<Region> {
        let [from, to] = self.shares?;
        let at = |axis: usize, share: f64| share * f64::from(size[axis]);
        // A share lies within 0 and 1, so these are pixels of the picture.
        let first = [0, 1].map(|axis| (at(axis, from[axis]).floor() as u32).min(size[axis] - 1));
        let last = [0, 1].map(|axis| (at(axis, to[axis]).ceil() as u32).max(first[axis] + 1));
        Some(Region {
            from: first,
            to: last,
        })
    }

    /// Whether a part is sharpened, and not the whole.
    pub(super) fn is_set(&self) -> bool {
        self.shares.is_some()
    }

    /// Whether the next drag over the picture draws the frame.
    pub(super) fn is_choosing(&self) -> bool {
        self.is_choosing
    }

    /// Lets the next drag draw the frame, or no more.
    pub(super) fn toggle_choosing(&mut self) {
        self.is_choosing = !self.is_choosing;
        self.from = None;
    }

    /// Draws no frame, if one was about to be drawn. True if so.
    pub(super) fn stop_choosing(&mut self) -> bool {
        self.from = None;
        std::mem::take(&mut self.is_choosing)
    }

    /// Sharpens the whole picture again.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes the drag over the picture while the frame is chosen, and draws it.
    pub(super) fn show(&mut self, ui: &Ui, place: &PicturePlace) {
        if self.is_choosing {
            self.take_drag(ui, place);
        }
        let Some([from, to]) = self.shares else {
            return;
        };
        let at = |share: [f64; 2]| -> Pos2 {
            place.picture.min + place.picture.size() * vec2(share[0] as f32, share[1] as f32)
        };
        let frame = Rect::from_min_max(at(from), at(to));
        let painter = ui.painter().with_clip_rect(place.canvas);
        // Dark beside light: seen on black and on white.
        for (width, colour) in [
            (3.0, Color32::from_black_alpha(140)),
            (1.0, Color32::from_gray(235)),
        ] {
            let stroke = Stroke::new(width, colour);
            painter.rect_stroke(frame, 0.0, stroke, StrokeKind::Middle);
        }
    }

    fn take_drag(&mut self, ui: &Ui, place: &PicturePlace) {
        // Over the picture, whose own drags turn the camera.
        let over = ui.interact(place.canvas, Id::unique("region"), Sense::drag());
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        let share = |at: Pos2| {
            let within = (at - place.picture.min) / place.picture.size();
            [within.x, within.y].map(|share| f64::from(share.clamp(0.0, 1.0)))
        };
        if over.drag_started() {
            // A drag is known as one only after some way.
            let origin = ui.input(|input| input.pointer.press_origin());
            self.from = origin.map(share);
        }
        let to = over.interact_pointer_pos().map(share);
        if let (Some(from), Some(to)) = (self.from, to) {
            let [low, high] = [f64::min, f64::max].map(|of| [0, 1].map(|c| of(from[c], to[c])));
            let sides =
                place.picture.size() * vec2((high[0] - low[0]) as f32, (high[1] - low[1]) as f32);
            if sides.min_elem() >= LEAST_SIDE {
                self.shares = Some([low, high]);
            }
        }
        if over.drag_stopped() {
            self.stop_choosing();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_holds_every_pixel_that_it_touches_and_never_none() {
        let frame = |shares| RegionFrame {
            shares: Some(shares),
            ..RegionFrame::default()
        };
        let pixels = |shares, size| frame(shares).pixels(size).map(|it| [it.from, it.to]);
        assert_eq!(
            pixels([[0.25, 0.5], [0.501, 1.0]], [100, 50]),
            Some([[25, 25], [51, 50]])
        );
        assert_eq!(pixels([[1.0; 2]; 2], [7, 9]), Some([[6, 8], [7, 9]]));
        assert_eq!(pixels([[0.0; 2]; 2], [1, 1]), Some([[0, 0], [1, 1]]));
        assert_eq!(RegionFrame::default().pixels([9, 9]), None);
    }
}
