//! Opening volumes: what is asked for, what came of it, and what is shown where it failed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::files::{Outcome, Request};
use super::scene_file::is_scene;
use super::words::with_causes;
use super::{App, Document};
use crate::project::{BackdropKind, CameraSettings, Project, ProjectError};
use crate::volume::{BuiltIn, Volume};

/// Whether a file is a picture by its name: it goes behind the fire.
pub(super) fn is_picture(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

impl App {
    /// Opens files as if they had been dropped on the window: volumes, or one picture for the backdrop.
    pub fn open(&mut self, paths: Vec<PathBuf>) {
        if let [path] = paths.as_slice()
            && is_picture(path)
            && self.document.volume().is_some()
        {
            self.document.change(|document| {
                let stage = &mut document.project.stage;
                stage.backdrop = BackdropKind::Picture;
                stage.backdrop_picture = Some(path.clone());
            });
            return;
        }
        let request = match (self.document.wants_a_partner(), paths.as_slice()) {
            (_, []) => return,
            (_, [path]) if is_scene(path) => Request::Scene(path.clone()),
            // A folder is a sequence, and never a missing field.
            (Some(open), [path]) if !path.is_dir() => {
                Request::Partner(Arc::clone(open), path.clone())
            }
            _ => Request::Files(paths, self.document.wanted_of_another()),
        };
        self.notice = None;
        self.begin(request);
    }

    /// Stops whatever is being loaded; what is open stays. Where nothing is open yet, the built-in flame is loaded.
    pub fn cancel_loading(&mut self) {
        if self.loader.loading().is_none() {
            return;
        }
        self.loader.cancel();
        self.document.do_without_the_rest();
        if self.document.volume().is_none() {
            self.fall_back();
        }
    }

    /// Begins to read grids of the open files that were left unread, and that the settings have come to need.
    pub(super) fn read_what_is_lacking(&mut self) {
        if self.loader.loading().is_some() {
            return;
        }
        if let (Some(open), Some(wanted)) = (self.document.volume(), self.document.lacking()) {
            let request = Request::Lacking(Arc::clone(open), wanted);
            self.begin(request);
        }
    }

    /// Lets the fire burn as in a scene: a file's fire as it is, one of the program's own in the flame of the scene, if it is of
    /// one.
    pub(super) fn burn_as(&mut self, scene: Project) {
        let open = self.document.volume().and_then(|volume| volume.built_in);
        let best = scene.volume.built_in;
        if scene.volume.path.is_empty() && open.is_some_and(|open| open != best) {
            self.begin(Request::OtherBuiltIn(best, Some(Arc::new(scene))));
        } else {
            self.document
                .change(|document| document.project.burn_as(scene));
            // What burns otherwise may be a thousand times as bright.
            self.expose_anew = true;
        }
    }

    /// The same as in a scene file, which may be a preset that somebody kept.
    pub(super) fn burn_as_file(&mut self, path: &Path) {
        match Project::read(path) {
            Ok(scene) => self.burn_as(scene),
            Err(error) => self.notice = Some(with_causes(&error)),
        }
    }

    /// Keeps what burns as a preset in a file, wholly or not at all.
    pub(super) fn keep_preset(&mut self, path: &Path) {
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let kept = made.map_err(|error| error.to_string()).and_then(|()| {
            let scene = self.document.project.what_burns();
            scene.write(path).map_err(|error| with_causes(&error))
        });
        if let Err(words) = kept {
            self.notice = Some(format!("the preset was not kept: {words}"));
        }
    }

    /// Begins to open what was open in a window that did not end by itself. What is open stays until that is read.
    pub(super) fn restore(&mut self) {
        if let Some(project) = self.autosave.left().cloned() {
            let limits = project.volume.limits();
            self.notice = None;
            self.loader
                .begin(Request::Session(Arc::new(project)), limits);
        }
    }

    /// Takes in what the loader read.
    pub(super) fn receive(&mut self) {
        while let Some(outcome) = self.loader.poll() {
            match outcome {
                Outcome::Shown(volume) => {
                    self.by_itself(|app| app.show(volume, Document::open));
                }
                Outcome::Restored(volume, project) => {
                    self.show_with(volume, &project);
                    let was_left = self.autosave.left() == Some(&*project);
                    if was_left && self.document.project == *project {
                        self.autosave.take_over(&project);
                    }
                }
                Outcome::Opened(volume, project, path) => {
                    if self.show_with(volume, &project) {
                        self.is_of(path, &project);
                    }
                }
                Outcome::Replaced(volume) => {
                    self.show_another(volume);
                }
                Outcome::Burning(volume, scene) => {
                    let was_unsaved = self.is_unsaved();
                    let shown = self.show(volume, |document, volume| {
                        document.replace_and(volume, |project| project.burn_as((*scene).clone()))
                    });
                    if shown {
                        self.begin_scene(was_unsaved);
                    }
                }
                Outcome::Completed { open, both } => {
                    let now = self.document.volume();
                    let same = now.is_some_and(|now| Arc::ptr_eq(now, &open));
                    if same {
                        self.by_itself(|app| app.show(both, Document::complete));
                    } else {
                        // Settings made for another volume do not suit these files.
                        self.show_another(both);
                    }
                }
                Outcome::Filled { open, volume } => {
                    let now = self.document.volume();
                    if now.is_some_and(|now| Arc::ptr_eq(now, &open)) {
                        self.document.fill(volume);
                    }
                }
                Outcome::Failed { request, words } => {
                    if matches!(request, Request::Lacking(..)) {
                        self.document.do_without_the_rest();
                    }
                    self.refuse(&words, !matches!(request, Request::BuiltIn(_)));
                }
                Outcome::Chosen(paths) => self.open(paths),
                Outcome::NoDialog => self.panels.file.no_dialog = true,
            }
        }
    }

    /// Shows a volume as a project sets it, or says why not.
    fn show_with(&mut self, volume: Arc<Volume>, project: &Project) -> bool {
        self.show(volume, |document, volume| {
            document.replace_and(volume, |changed| changed.clone_from(project))
        })
    }

    /// Shows a volume in the place of the open one: its scene begins.
    fn show_another(&mut self, volume: Arc<Volume>) {
        let was_unsaved = self.is_unsaved();
        if self.show(volume, Document::replace) {
            self.begin_scene(was_unsaved);
        }
    }

    /// Shows a volume in one of the document's ways, or says why not. Whether it is shown.
    fn show(
        &mut self,
        volume: Arc<Volume>,
        way: impl FnOnce(&mut Document, Arc<Volume>) -> Result<(), ProjectError>,
    ) -> bool {
        let name = |path: &PathBuf| path.display().to_string();
        let names = volume.sources.iter().map(name).collect::<Vec<_>>();
        match way(&mut self.document, volume) {
            Ok(()) => {
                self.loader.forget_older();
                self.look_for_frames();
                self.panels.file.path.clear();
                self.exporter.dismiss();
                if let Some(volume) = self.document.volume() {
                    self.recent.add(&volume.sources);
                }
                true
            }
            Err(error) => {
                self.refuse(&format!("{}: {error}", names.join(", ")), true);
                false
            }
        }
    }

    /// Says why something was not opened. Where that would leave the window without anything, the built-in flame
    /// is shown, unless that is what failed.
    fn refuse(&mut self, words: &str, built_in_may_help: bool) {
        let empty = self.document.volume().is_none() && self.loader.loading().is_none();
        let mut end = "";
        if empty && built_in_may_help {
            self.fall_back();
            end = ". The built-in flame is shown instead";
        }
        self.notice = Some(format!("{words}{end}"));
    }

    /// Loads the built-in flame in place of what the project names.
    fn fall_back(&mut self) {
        // The settings were made for files that are not shown.
        let project = &mut self.document.project;
        project.volume = project.volume.for_another_file();
        project.camera = CameraSettings::default();
        self.begin(Request::BuiltIn(BuiltIn::default()));
    }

    /// Begins to load, under the limits that are set.
    pub(super) fn begin(&mut self, request: Request) {
        let limits = self.document.project.volume.limits();
        self.loader.begin(request, limits);
    }
}
