//! One page of everything that keys and hands do.

use egui::{Align2, Context, Grid, RichText, ScrollArea, Window};

use crate::app::theme::IDLE;

/// Height of the window's title and margins in points, with some to spare.
const BAR: f32 = 80.0;

/// What a hand does and what that does, by what it is about.
pub(in crate::app) const HANDS: &[(&str, &[(&str, &str)])] = &[
    (
        "Files",
        &[
            ("Ctrl+O", "open volumes or a scene; or drop them anywhere"),
            ("Ctrl+S", "save the scene; with Shift under another name"),
            ("Ctrl+E", "export the picture"),
            ("Ctrl+Z", "undo; Ctrl+Shift+Z or Ctrl+Y: redo"),
            ("Ctrl+Shift+C", "copy all that is set, as text"),
            ("Ctrl+V", "paste settings, or the path of a file"),
        ],
    ),
    (
        "Camera",
        &[
            ("drag, middle drag", "orbit"),
            ("Shift + drag", "pan the camera"),
            ("wheel, Ctrl + middle drag", "nearer and further"),
            ("Home", "frame all of the fire"),
            ("1, 3, 7", "front, right, top; with Ctrl the other side"),
        ],
    ),
    (
        "Picture",
        &[
            ("Ctrl + wheel, + and −", "zoom the picture"),
            ("right drag", "move it"),
            ("double click, 0", "fit it"),
            ("S", "spectrum under the pointer; a click keeps the pixel"),
            ("C", "what accuracy costs; a click on a dot adopts it"),
            ("K, E", "map of what each pixel costs, of its error"),
            ("G, W, Q", "grab a snapshot; wipe against it; flip to it"),
        ],
    ),
    (
        "Frames",
        &[
            ("Space", "play and pause"),
            ("Left, Right", "the frame before, and after; or , and ."),
        ],
    ),
    (
        "Window",
        &[
            ("N", "hide and show the panel"),
            ("Esc", "close what was opened last, or stop loading"),
            ("F1", "this page"),
        ],
    ),
    (
        "Controls",
        &[
            ("double click", "back to the default"),
            (
                "drag on a number",
                "change it; a click types one, with its unit",
            ),
            ("Tab, arrows", "the next control; change it"),
        ],
    ),
];

/// Draws the page if it is open.
pub(in crate::app) fn show(ctx: &Context, is_open: &mut bool) {
    let whole = ctx.content_rect();
    Window::new("Keys and hands")
        .open(is_open)
        .collapsible(false)
        .pivot(Align2::CENTER_CENTER)
        .default_pos(whole.center())
        .auto_sized()
        .show(ctx, |ui| {
            ScrollArea::vertical()
                .max_height(whole.height() - BAR)
                .show(ui, |ui| {
                    Grid::new("hands").num_columns(2).show(ui, |ui| {
                        for (about, hands) in HANDS {
                            ui.label(RichText::new(*about).strong());
                            ui.end_row();
                            for (hand, does) in *hands {
                                ui.label(RichText::new(*hand).color(IDLE));
                                ui.label(*does);
                                ui.end_row();
                            }
                        }
                    });
                });
        });
}
