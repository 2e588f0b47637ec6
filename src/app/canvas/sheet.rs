//! A film on the graphics card, with what the card has of it.

use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, RenderState, wgpu};
use egui::{Rect, Shape};

use super::display::Display;
use super::placement::Mapping;
use crate::colour::display::{BakedView, View};
use crate::render::Film;

/// Every display of the canvas, among egui's resources.
struct Displays(Vec<Display>);

/// One film on the card.
pub(super) struct Sheet {
    /// Which of the displays.
    slot: usize,
    film: Option<u64>,
    /// With whether what is clipped is marked.
    view: Option<(View, bool)>,
    mapping: Option<Mapping>,
}

/// What a sheet is to show.
pub(super) struct Content<'a> {
    /// Another number for another film.
    pub(super) version: u64,
    pub(super) film: &'a Film,
    pub(super) strides: &'a [u8],
    pub(super) view: &'a View,
    /// Whether what the view clips is marked.
    pub(super) marks_clipped: bool,
    pub(super) mapping: Mapping,
}

impl Sheet {
    pub(super) fn new(slot: usize) -> Self {
        Self {
            slot,
            film: None,
            view: None,
            mapping: None,
        }
    }

    /// Brings to the card what it does not have yet; what then draws it over a canvas.
    pub(super) fn prepare(
        &mut self,
        state: &RenderState,
        canvas: Rect,
        content: &Content<'_>,
    ) -> Option<Shape> {
        let mut renderer = state.renderer.write();
        let resources = &mut renderer.callback_resources;
        let displays = resources
            .entry::<Displays>()
            .or_insert_with(|| Displays(Vec::new()));
        while displays.0.len() <= self.slot {
            displays
                .0
                .push(Display::new(&state.device, state.target_format));
        }
        let display = displays.0.get_mut(self.slot)?;
        if self.film != Some(content.version) {
            display.upload(&state.device, &state.queue, content.film, content.strides);
            self.film = Some(content.version);
        }
        let view = (*content.view, content.marks_clipped);
        if self.view != Some(view) {
            let baked = BakedView::new(content.view);
            display.set_view(&state.queue, &baked, content.marks_clipped);
            self.view = Some(view);
        }
        if self.mapping != Some(content.mapping) {
            display.set_mapping(&state.queue, &content.mapping);
            self.mapping = Some(content.mapping);
        }
        let paint = Paint { slot: self.slot };
        Some(egui_wgpu::Callback::new_paint_callback(canvas, paint).into())
    }
}

/// Draws the display of a slot.
struct Paint {
    slot: usize,
}

impl CallbackTrait for Paint {
    fn paint(
        &self,
        _: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let displays = resources.get::<Displays>();
        if let Some(display) = displays.and_then(|displays| displays.0.get(self.slot)) {
            display.paint(pass);
        }
    }
}
