//! The scene file of a window: where what is set was saved, and whether it has changed since.
//!
//! Written on a thread of its own, wholly or not at all: a disk may be slow, and the picture does not wait.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Weak};

use super::App;
use super::words::with_causes;
use crate::project::file::SceneFileError;
use crate::project::{CameraSettings, Project};
use crate::volume::Volume;

/// Ending of a scene file's name.
pub(super) const ENDING: &str = "toml";

/// Whether a file is a scene by its name.
pub(super) fn is_scene(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// How many scenes of one window are remembered: an undo may bring any of them back.
const MOST: usize = 32;

/// What a window knows of its scenes' files: that of the fire on show, and of those which an undo brings back.
#[derive(Debug)]
pub(super) struct SceneFile {
    /// The scene of the fire on show is the last.
    known: Vec<Scene>,
    writing: Option<Writing>,
    newest: u64,
}

#[derive(Debug)]
struct Scene {
    number: u64,
    /// The volume that was on show of it last.
    volume: Weak<Volume>,
    /// Its file, once it has one.
    path: Option<PathBuf>,
    /// What was set when it was begun, opened or saved.
    kept: Project,
}

#[derive(Debug)]
struct Writing {
    /// The scene that is written.
    number: u64,
    path: PathBuf,
    project: Project,
    outcome: Receiver<Result<(), SceneFileError>>,
    /// Whether it was to be saved once more meanwhile.
    again: bool,
}

impl SceneFile {
    /// A scene that no file holds.
    pub(super) fn new(project: &Project) -> Self {
        let mut scenes = Self {
            known: Vec::new(),
            writing: None,
            newest: 0,
        };
        scenes.begin(None, project.clone());
        scenes
    }

    fn begin(&mut self, path: Option<PathBuf>, kept: Project) {
        self.newest += 1;
        self.known.push(Scene {
            number: self.newest,
            volume: Weak::new(),
            path,
            kept,
        });
        if self.known.len() > MOST {
            self.known.remove(0);
        }
    }

    fn scene(&self) -> Option<&Scene> {
        self.known.last()
    }

    /// Its file, once it has one.
    pub(super) fn path(&self) -> Option<&Path> {
        self.scene()?.path.as_deref()
    }

    /// Whether what is set is in no file, and worth a question before it is lost. Where somebody looks from is not, unless it
    /// was saved once; nor is which frame of a sequence is on show.
    pub(super) fn is_unsaved(&self, project: &Project) -> bool {
        let Some(scene) = self.scene() else {
            return false;
        };
        let mut kept = scene.kept.clone();
        if scene.path.is_none() {
            kept.camera = CameraSettings {
                views: kept.camera.views,
                ..project.camera.clone()
            };
        }
        if is_same_fire(&kept, project) {
            kept.volume.path.clone_from(&project.volume.path);
        }
        kept != *project
    }

    /// Another fire is on show: an undo or a snapshot may have brought one back whose scene is known. If not, its scene begins,
    /// and what is set is what an undo would bring back.
    fn follow(&mut self, project: &Project, volume: Option<&Arc<Volume>>) {
        let shown = volume.map_or_else(Weak::new, Arc::downgrade);
        let of_volume = |it: &Scene| volume.is_some() && it.volume.ptr_eq(&shown);
        if self.scene().is_some_and(of_volume) {
            return;
        }
        let of_fire = |it: &Scene| is_same_fire(&it.kept, project);
        let known = self.known.iter().rposition(of_volume);
        match known.or_else(|| self.known.iter().rposition(of_fire)) {
            Some(at) => {
                let scene = self.known.remove(at);
                self.known.push(scene);
            }
            None => self.begin(None, project.clone()),
        }
        if let Some(scene) = self.known.last_mut() {
            scene.volume = shown;
        }
    }

    /// What is set was not changed by a person: it is no more unsaved than it was.
    fn keep(&mut self, project: &Project) {
        if let Some(scene) = self.known.last_mut() {
            scene.kept.clone_from(project);
        }
    }

    /// Whether it is being written.
    pub(super) fn is_writing(&self) -> bool {
        self.writing.is_some()
    }

    fn poll(&mut self) -> Option<(Result<PathBuf, SceneFileError>, bool)> {
        let writing = self.writing.as_ref()?;
        let outcome = match writing.outcome.try_recv() {
            Ok(outcome) => outcome,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err(SceneFileError::Write {
                path: writing.path.clone(),
                source: std::io::Error::other("writing it ended without a word"),
            }),
        };
        let Writing {
            number,
            path,
            project,
            again,
            ..
        } = self.writing.take()?;
        let written = outcome.map(|()| {
            // Another fire may be on show by now.
            if let Some(scene) = self.known.iter_mut().find(|it| it.number == number) {
                scene.path = Some(path.clone());
                scene.kept = project;
            }
            path
        });
        Some((written, again))
    }
}

/// Whether two projects show one fire, or frames of one sequence: files whose names differ by numbers alone.
fn is_same_fire(one: &Project, other: &Project) -> bool {
    let pattern = |path: &PathBuf| {
        path.to_string_lossy()
            .replace(|c: char| c.is_ascii_digit(), "")
    };
    let patterns = |project: &Project| project.volume.path.iter().map(pattern).collect::<Vec<_>>();
    patterns(one) == patterns(other)
        && (!one.volume.path.is_empty() || one.volume.built_in == other.volume.built_in)
}

impl App {
    /// Whether what is set is in no file, and would be lost with the window.
    pub fn is_unsaved(&self) -> bool {
        self.scene_file.is_unsaved(&self.document.project)
    }

    /// Begins to save what is set into a scene file; once more afterwards, if one is being written.
    pub(super) fn save_to(&mut self, path: PathBuf, ctx: &egui::Context) {
        if let Some(writing) = &mut self.scene_file.writing {
            writing.again = true;
            return;
        }
        self.scene_file
            .follow(&self.document.project, self.document.volume());
        let Some(number) = self.scene_file.scene().map(|scene| scene.number) else {
            return;
        };
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
                    number,
                    path,
                    project,
                    outcome,
                    again: false,
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
    pub(super) fn receive_saved(&mut self, ctx: &egui::Context) {
        self.scene_file
            .follow(&self.document.project, self.document.volume());
        let Some((outcome, again)) = self.scene_file.poll() else {
            return;
        };
        match outcome {
            Ok(path) => {
                self.panels.save.close();
                self.recent.add(std::slice::from_ref(&path));
                // What was changed while it was written is meant as well.
                let closes = self.closes_once_saved();
                if (again || closes) && self.is_unsaved() {
                    self.save_to(path, ctx);
                } else if closes {
                    self.close_now();
                }
            }
            Err(error) => {
                // What was to be closed stays open: nothing is lost.
                self.stay_open();
                self.notice = Some(with_causes(&error));
            }
        }
    }

    /// A volume was opened in the place of another: the scene that was saved is not this one. What was set before and is in no
    /// file stays so.
    pub(super) fn begin_scene(&mut self, was_unsaved: bool) {
        let project = &self.document.project;
        let mut kept = project.clone();
        if let Some(before) = self.scene_file.scene().filter(|_| was_unsaved) {
            kept = Project {
                volume: kept.volume,
                camera: kept.camera,
                ..before.kept.clone()
            };
        }
        self.scene_file.begin(None, kept);
        self.shows_its_volume();
    }

    /// A scene was opened from its file.
    pub(super) fn is_of(&mut self, path: PathBuf, project: &Arc<Project>) {
        self.recent.add(std::slice::from_ref(&path));
        self.scene_file.begin(Some(path), (**project).clone());
        self.shows_its_volume();
    }

    /// What is open was read from a scene's file, which says this; what was set beside is in no file yet.
    pub fn is_of_scene(&mut self, path: &Path, said: Project) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.add(std::slice::from_ref(&path));
        self.scene_file.begin(Some(path), said);
    }

    /// The scene that was begun last is that of the volume on show.
    fn shows_its_volume(&mut self) {
        if let (Some(scene), Some(volume)) =
            (self.scene_file.known.last_mut(), self.document.volume())
        {
            scene.volume = Arc::downgrade(volume);
        }
    }

    /// Saves what is set where it was saved before, or asks where.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        match self.scene_file.path().map(Path::to_owned) {
            Some(path) => self.save_to(path, ctx),
            None => self.panels.save.open(&self.document, None),
        }
    }

    /// Does what changes what is set without a person's hand.
    pub(super) fn by_itself<T>(&mut self, change: impl FnOnce(&mut Self) -> T) -> T {
        let was_unsaved = self.is_unsaved();
        let done = change(self);
        if !was_unsaved {
            self.scene_file.keep(&self.document.project);
        }
        done
    }

    /// Sets what was copied as a scene's text, as one step of undo. The open fire stays; only if it is the one that the text was
    /// copied from, its mapping and the camera are taken as well.
    pub(super) fn paste_settings(&mut self, text: &str) {
        match self.document.project.with_pasted(text) {
            Ok(project) => {
                self.document.change(|document| document.project = project);
                // What burns otherwise may be a thousand times as bright.
                self.expose_anew = true;
            }
            Err(words) => self.notice = Some(format!("what was pasted cannot be set: {words}")),
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
mod tests;
