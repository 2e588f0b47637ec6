//! The small buttons over the lower left corner of the picture.

use egui::{
    Align, Button, Color32, Frame, Label, Layout, Margin, Rect, RichText, Role, Theme, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};

use super::moves::Action;

/// Height of a row of buttons, and the gap to the edges of the canvas, points.
const ROW: f32 = 26.0;
const GAP: f32 = 8.0;
/// Width of all buttons in one row, points: a narrower canvas gets two.
const WIDTH: f32 = 286.0;
/// Width of the wider one of two rows.
const NARROW: f32 = 162.0;
/// Width of the number, points: it does not move the buttons while it runs.
const NUMBER: f32 = 52.0;

/// A button: what it shows, what it is called, what it does in words, and what it asks for.
type Entry = (&'static str, &'static str, &'static str, Action);

const SMALLER: Entry = (
    "−",
    "Zoom out",
    "Makes the picture smaller. The camera stays. Key: −",
    Action::Smaller,
);
const LARGER: Entry = (
    "+",
    "Zoom in",
    "Makes the picture larger. The camera stays. Key: +",
    Action::Larger,
);
const OTHERS: [Entry; 3] = [
    (
        "1:1",
        "One to one",
        "A pixel of the picture is a pixel of the screen.",
        Action::OneToOne,
    ),
    (
        "Fit",
        "Fit",
        "The whole picture, as large as the window lets it be. Key: 0, or a double click on the picture",
        Action::Fit,
    ),
    (
        "Frame all",
        "Frame all",
        "Moves the camera so that all of the flame is seen. Key: Home",
        Action::FrameAll,
    ),
];

const ZOOM_TIP: &str = "Screen pixels for a pixel of the picture. Ctrl and the wheel, or a pinch, change it; the right \
                        button, or Space and the left one, move the picture. Nothing is rendered again.";

/// Where they are on a canvas: one row, or two where it is narrow.
pub(in crate::app) fn place(canvas: Rect) -> Rect {
    let wide = canvas.width() >= WIDTH + 2.0 * GAP;
    let size = if wide {
        vec2(WIDTH, ROW)
    } else {
        vec2(NARROW, 2.0 * ROW)
    };
    let corner = pos2(canvas.min.x + GAP, canvas.max.y - GAP - size.y);
    Rect::from_min_size(corner, size)
}

/// Draws them over a canvas whose picture has this zoom. Returns what was pressed.
pub(super) fn show(ui: &mut Ui, canvas: Rect, zoom: f64, is_fit: bool) -> Vec<Action> {
    let place = place(canvas);
    let wide = place.height() <= ROW;
    let builder = UiBuilder::new()
        .max_rect(Rect::from_min_size(place.min, vec2(WIDTH, place.height())))
        .layout(Layout::top_down(Align::Min));
    let mut pressed = Vec::new();
    let size = |ui: &mut Ui, pressed: &mut Vec<Action>| {
        button(ui, &SMALLER, false, pressed);
        let words = percent(zoom);
        let number = Label::new(RichText::new(&words).small()).selectable(false);
        ui.add_sized(vec2(NUMBER, ROW - 4.0), number)
            .on_hover_text(ZOOM_TIP)
            .widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Zoom {words}")));
        button(ui, &LARGER, false, pressed);
    };
    let others = |ui: &mut Ui, pressed: &mut Vec<Action>| {
        for entry in &OTHERS {
            button(ui, entry, is_fit && entry.3 == Action::Fit, pressed);
        }
    };
    ui.scope_builder(builder, |ui| {
        ui.shrink_clip_rect(canvas);
        // The ground below them is dark in either look of the window.
        ui.style_mut().visuals = ui.ctx().style_of(Theme::Dark).visuals.clone();
        ui.spacing_mut().item_spacing = vec2(2.0, 2.0);
        ui.spacing_mut().button_padding = vec2(6.0, 2.0);
        if wide {
            plate(ui, |ui| {
                size(ui, &mut pressed);
                others(ui, &mut pressed);
            });
        } else {
            plate(ui, |ui| size(ui, &mut pressed));
            plate(ui, |ui| others(ui, &mut pressed));
        }
    });
    pressed
}

/// A row on a dark ground, which keeps it readable over a bright fire.
fn plate(ui: &mut Ui, row: impl FnOnce(&mut Ui)) {
    Frame::new()
        .fill(Color32::from_black_alpha(150))
        .corner_radius(4)
        .inner_margin(Margin::same(1))
        .show(ui, |ui| ui.horizontal(row));
}

fn button(ui: &mut Ui, entry: &Entry, selected: bool, pressed: &mut Vec<Action>) {
    let (words, name, tip, action) = *entry;
    let button = Button::new(RichText::new(words).small())
        .frame_when_inactive(selected)
        .selected(selected);
    let response = ui.add(button).on_hover_text(tip);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, name));
    if response.clicked() {
        pressed.push(action);
    }
}

/// A zoom in words.
fn percent(zoom: f64) -> String {
    let percent = 100.0 * zoom;
    // Tenths where they are told apart.
    if percent < 10.0 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn a_zoom_is_told_in_percent() {
        let told = [1.0, 1.0 / 16.0, 0.5, 64.0, 1.333].map(percent);
        assert_eq!(told, ["100 %", "6.2 %", "50 %", "6400 %", "133 %"]);
    }
}
