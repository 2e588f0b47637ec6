//! The scene file of a window: where what is set was saved, and whether it has changed since.
//!
//! Written on a thread of its own, wholly or not at all: a disk may be slow, and the picture does not wait.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use super::App;
use super::words::with_causes;
use crate::project::Project;
use crate::project::file::SceneFileError;

/// Ending of a scene file's name.
pub(super) const ENDING: &str = "toml";

/// Whether a file is a scene by its name.
pub(super) fn is_scene(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// Where the scene stands on disk.
#[derive(Debug)]
pub(super) struct SceneFile {
    /// Its file, once it has one.
    path: Option<PathBuf>,
    /// What was set when it was begun, opened or saved.
    kept: Project,
    writing: Option<Writing>,
}

#[derive(Debug)]
struct Writing {
    path: PathBuf,
    project: Project,
    outcome: Receiver<Result<(), SceneFileError>>,
}

impl SceneFile {
    /// A scene that no file holds.
    pub(super) fn new(project: &Project) -> Self {
        Self {
            path: None,
            kept: project.clone(),
            writing: None,
        }
    }

    /// Its file, once it has one.
    pub(super) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether what is set is in no file, and worth a question before it is lost. Where somebody looks from is not, unless it
    /// was saved once; nor is which frame of a sequence is on show.
    pub(super) fn is_unsaved(&self, project: &Project, is_a_frame: bool) -> bool {
        let mut kept = self.kept.clone();
        if self.path.is_none() {
            kept.camera = project.camera.clone();
        }
        if is_a_frame {
            kept.volume = project.volume.clone();
        }
        kept != *project
    }

    /// A volume took the place of the open one: its scene begins.
    fn begin(&mut self, project: &Project) {
        self.path = None;
        self.kept = project.clone();
    }

    /// Whether it is being written.
    pub(super) fn is_writing(&self) -> bool {
        self.writing.is_some()
    }

    fn poll(&mut self) -> Option<Result<PathBuf, SceneFileError>> {
        let writing = self.writing.as_ref()?;
        let outcome = match writing.outcome.try_recv() {
            Ok(outcome) => outcome,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err(SceneFileError::Write {
                path: writing.path.clone(),
                source: std::io::Error::other("writing it ended without a word"),
            }),
        };
        let writing = self.writing.take()?;
        Some(outcome.map(|()| {
            self.path = Some(writing.path.clone());
            self.kept = writing.project;
            writing.path
        }))
    }
}

impl App {
    /// Whether what is set is in no file, and would be lost with the window.
    pub fn is_unsaved(&self) -> bool {
        self.scene_file
            .is_unsaved(&self.document.project, self.timeline.is_open())
    }

    /// Begins to save what is set into a scene file.
    pub(super) fn save_to(&mut self, path: PathBuf, ctx: &egui::Context) {
        if self.scene_file.is_writing() {
            return;
        }
        let project = self.document.project.clone();
        let (sender, outcome) = channel();
        let spawned = std::thread::Builder::new()
            .name("sootlight-save".into())
            .spawn({
                let (path, project, ctx) = (path.clone(), project.clone(), ctx.clone());
                move || {
                    // The window may be gone.
                    let _ = sender.send(project.write(&path));
                    ctx.request_repaint();
                }
            });
        match spawned {
            Ok(_) => {
                self.scene_file.writing = Some(Writing {
                    path,
                    project,
                    outcome,
                });
            }
            Err(error) => {
                self.notice = Some(format!(
                    "the thread to save with cannot be started: {error}"
                ));
            }
        }
    }

    /// Takes in what became of a scene that was written.
    pub(super) fn receive_saved(&mut self) {
        let Some(outcome) = self.scene_file.poll() else {
            return;
        };
        match outcome {
            Ok(path) => {
                self.panels.save.close();
                self.recent.add(&[path]);
                self.close_once_saved();
            }
            Err(error) => {
                // What was to be closed stays open: nothing is lost.
                self.stay_open();
                self.notice = Some(with_causes(&error));
            }
        }
    }

    /// A volume was opened in the place of another: the scene that was saved is not this one.
    pub(super) fn begin_scene(&mut self) {
        self.scene_file.begin(&self.document.project);
    }

    /// A scene was opened from its file.
    pub(super) fn is_of(&mut self, path: PathBuf, project: &Arc<Project>) {
        self.recent.add(std::slice::from_ref(&path));
        self.scene_file.path = Some(path);
        self.scene_file.kept.clone_from(project);
    }

    /// Sets what was copied as a scene's text, as one step of undo. The open fire stays; only if it is the one that the text was
    /// copied from, its mapping and the camera are taken as well.
    pub(super) fn paste_settings(&mut self, text: &str) {
        let read = Project::from_toml(text, Path::new("")).map_err(|error| error.to_string());
        let checked = read.and_then(|pasted| match pasted.check() {
            Ok(()) => Ok(pasted),
            Err(error) => Err(error.to_string()),
        });
        match checked {
            Ok(pasted) => {
                self.document
                    .change(|document| document.project.take_settings(pasted));
                // What burns otherwise may be a thousand times as bright.
                self.expose_anew = true;
            }
            Err(error) => self.notice = Some(format!("what was pasted cannot be set: {error}")),
        }
    }
}

/// Whether pasted text is meant as settings: paths have no keys.
pub(super) fn is_settings(text: &str) -> bool {
    let is_key = |line: &str| {
        let line = line.trim();
        line.starts_with('[') && line.ends_with(']') || line.contains(" = ")
    };
    text.lines().any(is_key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_unsaved_once_something_worth_keeping_differs() {
        let mut project = Project::default();
        let mut scene = SceneFile::new(&project);
        project.camera.fov_deg = Some(40.0);
        assert!(!scene.is_unsaved(&project, false));
        scene.path = Some(PathBuf::from("a.toml"));
        assert!(scene.is_unsaved(&project, false));
        scene.kept = project.clone();
        assert!(!scene.is_unsaved(&project, false));
        project.volume.path = vec![PathBuf::from("fire_0002.vdb")];
        assert!(scene.is_unsaved(&project, false) && !scene.is_unsaved(&project, true));
        project.soot.amount = 2.0;
        assert!(scene.is_unsaved(&project, true));
    }

    #[test]
    fn settings_are_told_from_paths() {
        assert!(is_settings(&Project::default().to_toml()));
        assert!(is_settings("[soot]\namount = 2"));
        for path in [
            "/fires/a.vdb",
            "C:\\a b\\c.vdb",
            "file:///a.vdb\n/b=c.vdb",
            "",
        ] {
            assert!(!is_settings(path), "{path}");
        }
    }
}
