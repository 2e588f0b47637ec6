//! The window, or one sentence that says why there is none and what to do instead.

use super::command::Window;
use super::error::CliError;

/// What works without a window.
const INSTEAD: &str =
    "to make a picture without one, run `cargo run --release -- render -o fire.png`";

impl Window {
    /// Opens the window and stays until it is closed.
    #[cfg(feature = "window")]
    pub(super) fn run(self) -> Result<(), CliError> {
        if !has_display() {
            return Err(CliError::Said(format!(
                "there is no display for a window: {INSTEAD}"
            )));
        }
        crate::app::run(self.project, self.scene).map_err(|error| {
            if matches!(error, crate::app::AppError::DeviceLost(_)) {
                return CliError::Said(error.to_string());
            }
            // A driver's words may be many lines.
            let words = error.to_string().replace('\n', " ");
            CliError::Said(format!("the window cannot be opened ({words}): {INSTEAD}"))
        })
    }

    /// This build has none.
    #[cfg(not(feature = "window"))]
    pub(super) fn run(self) -> Result<(), CliError> {
        // What was typed is checked in either build.
        drop(self.scene);
        drop(self.project);
        Err(CliError::Said(format!(
            "this build has no window: {INSTEAD}"
        )))
    }
}

/// Whether a window could be shown. Asked first, because the window's libraries do not all fail politely.
#[cfg(feature = "window")]
fn has_display() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let needs_server = cfg!(all(
        unix,
        not(any(
            target_os = "macos",
            target_os = "ios",
            target_os = "android"
        ))
    ));
    !needs_server || set("DISPLAY") || set("WAYLAND_DISPLAY") || set("WAYLAND_SOCKET")
}
