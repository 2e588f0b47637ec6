//! A snapshot beside the picture: what is seen of it, and the line between the two that a hand moves.

use egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Id, Key, Rect, Sense, Stroke, Ui, WidgetInfo,
    pos2, vec2,
};

use crate::colour::display::View;
use crate::render::Film;

/// Half the width in which a pointer holds the line, points.
const HOLD: f32 = 7.0;
/// Room that is left to the buttons below, points.
const BUTTONS: f32 = 64.0;
/// By how much an arrow key moves the line, shares of the picture.
const KEY_STEP: f32 = 0.01;
/// Between words and what they stand beside, points.
const GAP: f32 = 8.0;

/// A picture to compare with.
#[derive(Clone, Copy)]
pub(in crate::app) struct Beside<'a> {
    /// Another number for another picture.
    pub(in crate::app) number: u64,
    pub(in crate::app) name: &'a str,
    pub(in crate::app) film: &'a Film,
    pub(in crate::app) strides: &'a [u8],
    pub(in crate::app) view: &'a View,
    /// Share of the picture's width, from its left, that it is seen in.
    pub(in crate::app) share: f32,
    /// Whether there is a line to be moved.
    pub(in crate::app) has_line: bool,
}

/// Where the line is on the screen.
pub(super) fn line_x(canvas: Rect, picture: Rect, beside: &Beside<'_>) -> f32 {
    if !beside.has_line {
        return canvas.max.x;
    }
    let x = picture.min.x + beside.share * picture.width();
    x.clamp(canvas.min.x, canvas.max.x)
}

/// Draws the line and the names on both sides of it. Returns where a hand moved it, as a share of the picture's width.
pub(super) fn show(ui: &mut Ui, canvas: Rect, picture: Rect, beside: &Beside<'_>) -> Option<f32> {
    let x = line_x(canvas, picture, beside);
    let top = canvas.min.y.max(picture.min.y) + GAP;
    if !beside.has_line {
        name(
            ui,
            canvas,
            Align2::CENTER_TOP,
            [canvas.center().x, top],
            beside.name,
        );
        return None;
    }
    let hold = Rect::from_min_max(
        pos2(x - HOLD, canvas.min.y),
        pos2(x + HOLD, (canvas.max.y - BUTTONS).max(canvas.min.y)),
    );
    let response = ui.interact(hold, Id::unique("wipe"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(true, f64::from(beside.share), "Wipe line"));
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    let painter = ui.painter().with_clip_rect(canvas);
    painter.vline(
        x,
        canvas.y_range(),
        Stroke::new(3.0, Color32::from_black_alpha(160)),
    );
    painter.vline(
        x,
        canvas.y_range(),
        Stroke::new(1.0, Color32::from_gray(235)),
    );
    let is_held = response.dragged() || response.has_focus();
    let radius = if is_held { 7.0 } else { 5.0 };
    painter.circle(
        pos2(x, hold.center().y),
        radius,
        Color32::from_gray(235),
        Stroke::new(1.5, Color32::from_black_alpha(160)),
    );
    name(ui, canvas, Align2::RIGHT_TOP, [x - GAP, top], beside.name);
    name(ui, canvas, Align2::LEFT_TOP, [x + GAP, top], "now");

    let dragged = response
        .interact_pointer_pos()
        .filter(|_| response.dragged());
    let by_hand = dragged.map(|at| (at.x - picture.min.x) / picture.width().max(1.0));
    if response.has_focus() {
        // Arrows move the line, and not the focus.
        let arrows = EventFilter {
            horizontal_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    }
    let by_key = response.has_focus().then(|| {
        ui.input(|input| {
            let pressed = |key| f32::from(u8::from(input.key_pressed(key)));
            KEY_STEP * (pressed(Key::ArrowRight) - pressed(Key::ArrowLeft))
        })
    });
    let by_key = by_key.filter(|by| *by != 0.0).map(|by| beside.share + by);
    by_hand.or(by_key).map(|share| share.clamp(0.0, 1.0))
}

fn name(ui: &Ui, canvas: Rect, align: Align2, [x, y]: [f32; 2], words: &str) {
    let painter = ui.painter().with_clip_rect(canvas);
    let font = FontId::proportional(12.5);
    let galley = painter.layout_no_wrap(words.to_owned(), font, Color32::from_gray(235));
    let rect = align.anchor_size(pos2(x, y), galley.size());
    painter.rect_filled(
        rect.expand2(vec2(5.0, 2.0)),
        3.0,
        Color32::from_black_alpha(150),
    );
    painter.galley(rect.min, galley, Color32::WHITE);
}
