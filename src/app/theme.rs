//! The look of the window: neutral greys, dark or light, so that the only colour on the screen is the fire's.

use egui::style::WidgetVisuals;
use egui::{Color32, Context, CornerRadius, Stroke, Style, TextStyle, Theme, Visuals, vec2};

/// Under which name it is stored which one is on.
const KEY: &str = "theme";
/// How the light one is stored.
const LIGHT: &str = "light";

/// The greys of a theme, and its two colours.
struct Greys {
    /// Behind the controls.
    panel: Color32,
    window: Color32,
    /// Fields to type in, the rails of sliders, and charts.
    well: Color32,
    faint: Color32,
    edge: Color32,
    text: Color32,
    /// Words beside what matters more.
    weak: Color32,
    /// Words that matter most.
    strong: Color32,
    /// What is selected, and the part of a rail left of its handle.
    selected: Color32,
    /// What is not as it should be.
    warning: Color32,
    /// What went wrong.
    error: Color32,
}

const DARK: Greys = Greys {
    panel: Color32::from_gray(30),
    window: Color32::from_gray(38),
    well: Color32::from_gray(18),
    faint: Color32::from_gray(35),
    edge: Color32::from_gray(52),
    text: Color32::from_gray(205),
    weak: Color32::from_gray(150),
    strong: Color32::from_gray(240),
    selected: Color32::from_gray(92),
    warning: Color32::from_rgb(226, 178, 104),
    error: Color32::from_rgb(240, 128, 104),
};

const BRIGHT: Greys = Greys {
    panel: Color32::from_gray(208),
    window: Color32::from_gray(216),
    well: Color32::from_gray(232),
    faint: Color32::from_gray(200),
    edge: Color32::from_gray(176),
    text: Color32::from_gray(32),
    weak: Color32::from_gray(78),
    strong: Color32::from_gray(0),
    selected: Color32::from_gray(150),
    warning: Color32::from_rgb(118, 66, 0),
    error: Color32::from_rgb(156, 24, 8),
};

/// Puts both looks on, and begins with that which an earlier window was left with.
pub(super) fn put_on(ctx: &Context, storage: Option<&dyn eframe::Storage>) {
    ctx.style_mut_of(Theme::Dark, |style| dress(style, &DARK));
    ctx.style_mut_of(Theme::Light, |style| dress(style, &BRIGHT));
    let stored = storage.and_then(|storage| storage.get_string(KEY));
    ctx.set_theme(match stored.as_deref() {
        Some(LIGHT) => Theme::Light,
        _ => Theme::Dark,
    });
}

/// The other look.
pub(super) fn toggle(ctx: &Context) {
    ctx.set_theme(match ctx.theme() {
        Theme::Dark => Theme::Light,
        Theme::Light => Theme::Dark,
    });
}

/// Stores it for the next window.
pub(super) fn save(ctx: &Context, storage: &mut dyn eframe::Storage) {
    let name = match ctx.theme() {
        Theme::Dark => "dark",
        Theme::Light => LIGHT,
    };
    storage.set_string(KEY, name.to_owned());
}

fn dress(style: &mut Style, greys: &Greys) {
    colour(&mut style.visuals, greys);
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

fn colour(visuals: &mut Visuals, greys: &Greys) {
    visuals.panel_fill = greys.panel;
    visuals.window_fill = greys.window;
    visuals.extreme_bg_color = greys.well;
    visuals.faint_bg_color = greys.faint;
    visuals.warn_fg_color = greys.warning;
    visuals.error_fg_color = greys.error;
    visuals.weak_text_color = Some(greys.weak);
    visuals.hyperlink_color = greys.strong;
    visuals.selection.bg_fill = greys.selected;
    visuals.selection.stroke = Stroke::new(1.0, greys.strong);
    visuals.text_cursor.stroke.color = greys.strong;
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke.color = greys.text;
    widgets.noninteractive.bg_stroke.color = greys.edge;
    let all: [&mut WidgetVisuals; 4] = [
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ];
    for widget in all {
        widget.corner_radius = CornerRadius::same(3);
        widget.expansion = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::recent::tests::Memory;

    /// Luminance relative to white (WCAG 2.2, "relative luminance").
    fn luminance(colour: Color32) -> f32 {
        let [r, g, b, _] = egui::Rgba::from(colour).to_array();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    fn contrast(one: Color32, other: Color32) -> f32 {
        let [one, other] = [one, other].map(|it| luminance(it) + 0.05);
        one.max(other) / one.min(other)
    }

    #[test]
    fn the_next_window_looks_as_this_one_did() {
        let mut storage = Memory::default();
        for expected in [Theme::Dark, Theme::Light, Theme::Dark] {
            let ctx = Context::default();
            put_on(&ctx, Some(&storage));
            assert_eq!(ctx.theme(), expected);
            toggle(&ctx);
            save(&ctx, &mut storage);
        }
    }

    #[test]
    fn all_words_stand_out_from_what_is_behind_them() {
        for greys in [&DARK, &BRIGHT] {
            for ground in [greys.panel, greys.window, greys.well] {
                for words in [
                    greys.text,
                    greys.weak,
                    greys.strong,
                    greys.warning,
                    greys.error,
                ] {
                    // WCAG 2.2, 1.4.3: at least 4.5 to 1.
                    let found = contrast(words, ground);
                    assert!(found > 4.5, "{words:?} on {ground:?}: {found}");
                }
            }
        }
    }
}
