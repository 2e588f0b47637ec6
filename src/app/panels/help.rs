//! One page of everything that keys and hands do.

use egui::{Align, Context, Grid, Layout, RichText, ScrollArea, Ui};

use super::centred;

/// Height of the window's title and margins in points, with some to spare.
const BAR: f32 = 80.0;

/// Width of the page in points.
const WIDTH: f32 = 920.0;
/// Sections in the left column.
const COLUMN: usize = 3;

/// What it is about; each hand, and what it does.
type Section = (&'static str, &'static [(&'static str, &'static str)]);

const HANDS: &[Section] = &[
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
    (
        "Picture",
        &[
            ("Ctrl + wheel, + and −", "zoom the picture"),
            ("right drag", "move it"),
            ("double click, 0", "fit it"),
            ("S", "spectrum under the pointer; a click keeps the pixel"),
            ("H", "histogram, and what is clipped"),
            ("J", "mark what is clipped in the picture"),
            ("V", "a plane through the volume, and its profile"),
            ("C", "what accuracy costs; a click on a dot adopts it"),
            (
                "Ctrl+B, Ctrl+Alt+B",
                "sharpen a region, which a drag frames; the whole picture",
            ),
            ("P", "pause the picture, and go on"),
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
            ("F2", "dark and light window"),
            ("F1", "this page"),
        ],
    ),
];

/// Draws the page if it is open.
pub(in crate::app) fn show(ctx: &Context, is_open: &mut bool) {
    let whole = ctx.content_rect();
    centred(ctx, "Keys and hands")
        .open(is_open)
        .show(ctx, |ui| {
            ui.set_width(WIDTH.min(whole.width() - 40.0));
            ScrollArea::vertical()
                .max_height(whole.height() - BAR)
                .show(ui, |ui| {
                    // Where the window is narrow they stand below each other.
                    let layout = if whole.width() >= WIDTH + 40.0 {
                        Layout::left_to_right(Align::Min)
                    } else {
                        Layout::top_down(Align::Min)
                    };
                    ui.with_layout(layout, |ui| {
                        let (left, right) = HANDS.split_at(COLUMN);
                        for (number, column) in [left, right].into_iter().enumerate() {
                            ui.vertical(|ui| page(ui, number, column));
                        }
                    });
                });
        });
}

fn page(ui: &mut Ui, number: usize, sections: &[Section]) {
    Grid::new(("hands", number)).num_columns(2).show(ui, |ui| {
        for (about, hands) in sections {
            ui.label(RichText::new(*about).strong());
            ui.end_row();
            for (hand, does) in *hands {
                ui.label(RichText::new(*hand).weak());
                ui.label(*does);
                ui.end_row();
            }
        }
    });
}
