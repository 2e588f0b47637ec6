//! A window that is to be closed while something would be lost with it: an export that runs, or what is set and in no file.

use egui::{Context, ViewportCommand};

use super::App;

/// What becomes of such a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Closing {
    /// Nobody asked.
    #[default]
    No,
    /// It was asked for while something is exported, and the answer is awaited.
    AskedExporting,
    /// It was asked for while what is set was in no file, and the answer is awaited.
    AskedUnsaved,
    /// It closes once what is set was saved.
    AfterSave,
    /// It closes once the export has ended.
    AfterExport,
    /// It closes, whatever runs.
    Now,
}

impl Closing {
    /// Whether an answer is awaited.
    pub(super) fn is_asked(self) -> bool {
        matches!(self, Self::AskedExporting | Self::AskedUnsaved)
    }
}

/// An answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Close {
    /// As soon as the export is done.
    AfterExport,
    /// Once the export is stopped.
    StopExport,
    /// Once what is set was saved.
    AfterSave,
    /// Whatever is lost with it.
    Now,
    /// Stay open.
    Not,
}

impl App {
    /// Does what was answered.
    pub(super) fn close(&mut self, close: Close, ctx: &Context) {
        match close {
            Close::AfterExport => {
                // A range that pauses would never be done.
                self.exporter.pause(false);
                self.closing = Closing::AfterExport;
            }
            Close::StopExport => {
                self.exporter.cancel();
                self.closing = if self.is_unsaved() {
                    Closing::AskedUnsaved
                } else {
                    Closing::Now
                };
            }
            Close::AfterSave => {
                self.closing = Closing::AfterSave;
                self.save(ctx);
            }
            Close::Now => self.closing = Closing::Now,
            Close::Not => self.closing = Closing::No,
        }
    }

    /// A window that exports, or whose settings are in no file, is not closed without a word: they would be lost.
    pub(super) fn guard_what_would_be_lost(&mut self, ctx: &Context) {
        let exports = self.exporter.running().is_some();
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        match self.closing {
            Closing::Now => ctx.send_viewport_cmd(ViewportCommand::Close),
            // Without a graphics device nothing can be asked; what is set was kept.
            Closing::AfterExport
                if !exports && (self.lost.words().is_some() || !self.is_unsaved()) =>
            {
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
            Closing::AfterExport if !exports => self.closing = Closing::AskedUnsaved,
            _ if exports && is_asked => {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.closing = Closing::AskedExporting;
            }
            Closing::AskedExporting if !exports => self.closing = Closing::No,
            Closing::AskedUnsaved if !self.is_unsaved() => self.closing = Closing::No,
            Closing::No | Closing::AskedUnsaved | Closing::AfterSave
                if is_asked && self.is_unsaved() =>
            {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.closing = Closing::AskedUnsaved;
            }
            _ => {}
        }
    }

    /// Whether the window is to be closed once what is set was saved.
    pub(super) fn closes_once_saved(&self) -> bool {
        self.closing == Closing::AfterSave
    }

    /// Closes the window, whatever runs.
    pub(super) fn close_now(&mut self) {
        self.closing = Closing::Now;
    }

    /// What was to be closed stays open.
    pub(super) fn stay_open(&mut self) {
        self.closing = Closing::No;
    }
}
