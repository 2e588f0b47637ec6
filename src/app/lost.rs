//! A graphics device that is gone: its driver was reset, or it was taken away. Nothing can be drawn on it any more, so the
//! window closes and says why; what was open and set is kept for the next.

use std::sync::{Arc, OnceLock};

/// Whether the device is lost.
#[derive(Debug, Clone, Default)]
pub(super) struct Lost(Arc<OnceLock<String>>);

impl Lost {
    /// Hears of it from here on, and wakes the window.
    pub(super) fn watch(&self, device: &wgpu::Device, ctx: &egui::Context) {
        let (lost, ctx) = (self.clone(), ctx.clone());
        device.set_device_lost_callback(move |reason, words| {
            let words = if words.is_empty() {
                format!("{reason:?}")
            } else {
                words
            };
            // The first word counts.
            let _ = lost.0.set(words);
            ctx.request_repaint();
        });
    }

    /// The driver's words, once the device is lost.
    pub(super) fn words(&self) -> Option<&str> {
        let words = self.0.get()?;
        (!words.is_empty()).then_some(words)
    }

    /// The window closes: a device that goes with it is not lost.
    pub(super) fn end(&self) {
        let _ = self.0.set(String::new());
    }
}
