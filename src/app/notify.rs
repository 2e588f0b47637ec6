//! Telling a person who looks elsewhere that an export has ended.

use egui::{Context, UserAttentionType, ViewportCommand};
use notify_rust::Notification;

use super::App;

impl App {
    /// Tells the desktop what became of the export, unless the window is looked at, which tells it itself.
    pub(super) fn tell_ended(&self, ctx: &Context) {
        let Some(outcome) = self.exporter.last() else {
            return;
        };
        if ctx.input(|input| input.focused) {
            return;
        }
        let attention = UserAttentionType::Informational;
        ctx.send_viewport_cmd(ViewportCommand::RequestUserAttention(attention));
        let words = outcome.in_words();
        // Asking the desktop may take its time, and there may be none to answer.
        let told = std::thread::Builder::new().name("sootlight-notify".into());
        let _ = told.spawn(move || {
            let mut notification = Notification::new();
            notification
                .appname("Sootlight")
                .summary("Sootlight")
                .body(&words);
            let _ = notification.show();
        });
    }
}
