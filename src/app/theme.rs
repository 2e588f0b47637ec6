//! The look of the window: neutral dark greys, so that the only colour on the screen is the fire's.

use egui::{Color32, CornerRadius, Stroke, Style, TextStyle, Theme, vec2};

/// Behind the controls.
const PANEL: Color32 = Color32::from_gray(30);
/// Fields to type in, and the rails of sliders.
const WELL: Color32 = Color32::from_gray(18);
/// Words.
const TEXT: Color32 = Color32::from_gray(205);
/// What is selected, and the part of a rail left of its handle.
const SELECTED: Color32 = Color32::from_gray(92);
/// What is so, and explains why a control does nothing.
pub(super) const IDLE: Color32 = Color32::from_gray(150);
/// What is not as it should be.
pub(super) const WARNING: Color32 = Color32::from_rgb(226, 178, 104);
/// What went wrong.
pub(super) const ERROR: Color32 = Color32::from_rgb(240, 128, 104);

/// Puts the look on.
pub(super) fn put_on(ctx: &egui::Context) {
    ctx.set_theme(Theme::Dark);
    ctx.style_mut_of(Theme::Dark, dress);
}

fn dress(style: &mut Style) {
    let visuals = &mut style.visuals;
    visuals.panel_fill = PANEL;
    visuals.window_fill = Color32::from_gray(38);
    visuals.extreme_bg_color = WELL;
    visuals.faint_bg_color = Color32::from_gray(35);
    visuals.warn_fg_color = WARNING;
    visuals.error_fg_color = ERROR;
    visuals.hyperlink_color = Color32::from_gray(225);
    visuals.selection.bg_fill = SELECTED;
    visuals.selection.stroke = Stroke::new(1.0, Color32::from_gray(240));
    visuals.text_cursor.stroke.color = Color32::from_gray(230);
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke.color = TEXT;
    widgets.noninteractive.bg_stroke.color = Color32::from_gray(52);
    for widget in [
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(3);
        widget.expansion = 0.0;
    }
    style.spacing.item_spacing = vec2(8.0, 5.0);
    style.spacing.button_padding = vec2(8.0, 3.0);
    style.spacing.interact_size.y = 22.0;
    style.spacing.slider_rail_height = 5.0;
    style.spacing.tooltip_width = 280.0;
    for (text, size) in [
        (TextStyle::Body, 13.5),
        (TextStyle::Button, 13.5),
        (TextStyle::Small, 11.5),
    ] {
        if let Some(font) = style.text_styles.get_mut(&text) {
            font.size = size;
        }
    }
}
