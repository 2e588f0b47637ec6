//! Opening the window, and what to say where that fails.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::OnceLock;

use eframe::egui_wgpu::WgpuError;
use thiserror::Error;

use super::App;
use super::lost::Lost;
use crate::project::Project;

/// Why there is no window.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AppError {
    /// Neither Vulkan nor OpenGL.
    #[error(
        "no graphics driver was found ({0}): install a Vulkan or OpenGL driver, such as mesa-vulkan-drivers or \
         libgl1-mesa-dri; `sootlight render` needs none"
    )]
    NoGraphicsDriver(String),
    /// A library of the desktop is missing.
    #[error(
        "a library that windows need is missing ({0}): install libxkbcommon-x11-0 libxcursor1 libxi6 libxrandr2; \
         `sootlight render` needs none of them"
    )]
    MissingLibrary(String),
    /// No desktop to open a window on.
    #[error(
        "there is no desktop to open a window on ({0}): set DISPLAY or WAYLAND_DISPLAY, or use `sootlight render`"
    )]
    NoDesktop(String),
    /// The system gives no threads.
    #[error("the render threads could not be started")]
    Threads(#[source] std::io::Error),
    /// The graphics device is gone: its driver was reset, or it was taken away.
    #[error(
        "the graphics device was lost ({0}): open the window again, which offers to restore what was open and set"
    )]
    DeviceLost(String),
    /// The program is wrong.
    #[error("the window failed unexpectedly: {0}")]
    Failed(String),
}

/// Size of a new window in points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// Least size at which every control can be reached.
const LEAST_SIZE: [f32; 2] = [720.0, 480.0];

/// Opens the window on a project, and on a scene's file with what that says by itself if there is one; stays until it is
/// closed.
///
/// # Errors
/// [`AppError`]: there is no desktop, no graphics driver, or something that both need.
pub fn run(project: Project, scene: Option<(PathBuf, Project)>) -> Result<(), AppError> {
    let title = title_of(&project);
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title(title.as_str())
            .with_app_id(super::APP_ID)
            .with_inner_size(SIZE)
            .with_min_inner_size(LEAST_SIZE)
            .with_icon(egui::IconData::default())
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        ..eframe::NativeOptions::default()
    };
    let device = OnceLock::new();
    let open = || {
        let device = &device;
        let create = move |creation: &eframe::CreationContext<'_>| {
            let mut app = App::new(creation, project)?;
            if let Some((path, said)) = scene {
                app.is_of_scene(&path, said);
            }
            let _ = device.set(app.lost.clone());
            Ok(Box::new(app) as Box<dyn eframe::App>)
        };
        eframe::run_native(&title, options, Box::new(create))
    };
    // A dependency panics where a library of X11 cannot be loaded.
    match catch_unwind(AssertUnwindSafe(open)) {
        Ok(Ok(())) => match device.get().and_then(Lost::words) {
            Some(words) => Err(AppError::DeviceLost(words.to_owned())),
            None => Ok(()),
        },
        Ok(Err(error)) => Err(from_eframe(error)),
        Err(panic) => {
            let words = panic.downcast_ref::<&str>().copied();
            let words = words.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
            Err(from_words(words.unwrap_or("no reason given")))
        }
    }
}

/// The window's title for a project that is not open yet.
fn title_of(project: &Project) -> String {
    format!(
        "Sootlight — {}",
        super::Document::new(project.clone()).title()
    )
}

fn from_eframe(error: eframe::Error) -> AppError {
    match error {
        eframe::Error::Wgpu(WgpuError::HandleError(error)) => {
            AppError::NoDesktop(error.to_string())
        }
        eframe::Error::Wgpu(error) => AppError::NoGraphicsDriver(error.to_string()),
        eframe::Error::AppCreation(error) => match error.downcast::<AppError>() {
            Ok(error) => *error,
            Err(error) => AppError::Failed(error.to_string()),
        },
        other => from_words(&other.to_string()),
    }
}

/// Sorts what a dependency said by what it speaks of.
fn from_words(words: &str) -> AppError {
    // An error of the system may begin with a place in a dependency's source, which tells a person nothing.
    let told = words
        .split_once(".rs:")
        .and_then(|(_, rest)| rest.split_once(": "));
    let words = told
        .map_or(words, |(_, said)| said)
        .trim_end_matches('.')
        .to_owned();
    let lower = words.to_lowercase();
    let speaks_of = |terms: &[&str]| terms.iter().any(|term| lower.contains(term));
    if speaks_of(&[".so", "xkbcommon", "shared librar", "could not be loaded"]) {
        AppError::MissingLibrary(words)
    } else if speaks_of(&[
        "display",
        "wayland",
        "event loop",
        "compositor",
        "connection",
    ]) {
        AppError::NoDesktop(words)
    } else {
        AppError::Failed(words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_is_told_from_a_missing_desktop() {
        for said in [
            "Library libxkbcommon-x11.so could not be loaded.",
            "os error at /a/b/mod.rs:788: Failed to load one of xlib's shared libraries",
        ] {
            let library = from_words(said);
            assert!(matches!(library, AppError::MissingLibrary(_)), "{library}");
            assert!(!library.to_string().contains("mod.rs"), "{library}");
        }
        let desktop = from_words("neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.");
        assert!(matches!(desktop, AppError::NoDesktop(_)), "{desktop}");
        assert!(matches!(
            from_words("index out of bounds"),
            AppError::Failed(_)
        ));
    }
}
