//! What is open and what a person set: a [`Project`] with undo, and the volume it is about.
//!
//! The document asks nobody to render. It only says, when asked, which [`Job`] it stands for; the window compares
//! that with what it submitted last.

use std::path::PathBuf;
use std::sync::Arc;

use crate::project::{Job, Project, VolumeSettings};
use crate::volume::{FieldKind, Recognised, Volume, recognise};

/// Steps that can be taken back.
const MOST_UNDO: usize = 200;

/// A project and its open volume.
#[derive(Debug)]
pub struct Document {
    /// All that a person can set. Panels change it freely; [`Document::remember`] makes the change undoable.
    pub project: Project,
    open: Option<OpenVolume>,
    past: Vec<Project>,
    future: Vec<Project>,
    /// Whether the newest undo step still grows with the slider that is held.
    gesture: bool,
    /// The last job that could be rendered.
    job: Option<Job>,
    problem: Option<String>,
}

#[derive(Debug)]
struct OpenVolume {
    volume: Arc<Volume>,
    recognised: Recognised,
}

/// One physical field of the open volume, for a person to check.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldRow {
    /// Which field.
    pub kind: FieldKind,
    /// The grid that it is made from.
    pub grid: String,
    /// Lowest and highest value in the file.
    pub raw: (f64, f64),
    /// Lowest and highest physical value.
    pub mapped: (f64, f64),
}

impl Document {
    /// A document without a volume yet.
    pub fn new(project: Project) -> Self {
        Self {
            project,
            open: None,
            past: Vec::new(),
            future: Vec::new(),
            gesture: false,
            job: None,
            problem: None,
        }
    }

    /// The open volume.
    pub fn volume(&self) -> Option<&Arc<Volume>> {
        self.open.as_ref().map(|open| &open.volume)
    }

    /// Who is thought to have written it, and why.
    pub fn recognised(&self) -> Option<&Recognised> {
        self.open.as_ref().map(|open| &open.recognised)
    }

    /// Shows a volume with the settings as they are: the one that the project itself names.
    pub fn open(&mut self, volume: Arc<Volume>) {
        let recognised = recognise(&volume);
        self.open = Some(OpenVolume { volume, recognised });
        self.job = None;
        // Undo does not reach behind an opening: an older project names grids of a volume that is gone.
        self.past.clear();
        self.future.clear();
        self.gesture = false;
    }

    /// Shows another volume than the project's. What belonged to the old file — its fields' mapping, where the
    /// camera stood — goes back to what is chosen from the file; fuel, soot, quality and view stay.
    pub fn replace(&mut self, volume: Arc<Volume>) {
        self.project.volume = VolumeSettings {
            path: volume.sources.clone(),
            ..VolumeSettings::default()
        };
        self.project.camera = crate::project::CameraSettings::default();
        self.open(volume);
    }

    /// Whether one more file may complete the open volume: it came from files and has a single field.
    pub fn wants_a_partner(&self) -> Option<&Arc<Volume>> {
        self.volume()
            .filter(|volume| volume.grids.len() == 1 && !volume.sources.is_empty())
    }

    /// The names of the open files without their folders, or what is shown instead of files.
    pub fn title(&self) -> String {
        let sources = self
            .volume()
            .map_or(&self.project.volume.path, |v| &v.sources);
        if sources.is_empty() {
            return "built-in flame".to_owned();
        }
        let name = |path: &PathBuf| {
            let name = path.file_name().unwrap_or(path.as_os_str());
            name.to_string_lossy().into_owned()
        };
        sources.iter().map(name).collect::<Vec<_>>().join(" + ")
    }

    /// What to render for a canvas of this many pixels: the last job that was valid, if the project is not.
    /// `None` while there is no volume.
    pub fn job(&mut self, canvas: [u32; 2]) -> Option<&Job> {
        let volume = &self.open.as_ref()?.volume;
        let mut sized = self.project.clone();
        sized.render.size = canvas;
        match sized.job(volume) {
            Ok(job) => {
                self.job = Some(job);
                self.problem = None;
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
        self.job.as_ref()
    }

    /// The last valid job.
    pub fn last_job(&self) -> Option<&Job> {
        self.job.as_ref()
    }

    /// Why the project as it stands cannot be rendered, in words.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// The fields of the last valid job with their ranges.
    pub fn fields(&self) -> Vec<FieldRow> {
        let Some(job) = &self.job else {
            return Vec::new();
        };
        let row = |(kind, map): (FieldKind, &crate::volume::FieldMap)| {
            let (low, high) = job.volume.grid(&map.grid)?.range();
            let raw = (f64::from(low), f64::from(high));
            let mapped = map.mapped_range(raw);
            Some(FieldRow {
                kind,
                grid: map.grid.clone(),
                raw,
                mapped,
            })
        };
        job.flame.maps.iter().filter_map(row).collect()
    }

    /// Makes the changes since `before` one step of undo. While something is `held` (a slider under the pointer)
    /// all its changes are the same step.
    pub fn remember(&mut self, before: Project, held: bool) {
        if self.project != before {
            if !self.gesture {
                self.past.push(before);
                let surplus = self.past.len().saturating_sub(MOST_UNDO);
                self.past.drain(..surplus);
            }
            self.future.clear();
            self.gesture = true;
        }
        self.gesture &= held;
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        if let Some(before) = self.past.pop() {
            self.future
                .push(std::mem::replace(&mut self.project, before));
        }
    }

    /// Takes the last undo back.
    pub fn redo(&mut self) {
        if let Some(after) = self.future.pop() {
            self.past.push(std::mem::replace(&mut self.project, after));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(document: &mut Document, radius_nm: f64, held: bool) {
        let before = document.project.clone();
        document.project.soot.radius_nm = radius_nm;
        document.remember(before, held);
    }

    #[test]
    fn a_drag_is_one_step_and_a_click_another() {
        let mut document = Document::new(Project::default());
        let first = document.project.soot.radius_nm;
        for radius in [30.0, 31.0, 32.0] {
            set(&mut document, radius, true);
        }
        set(&mut document, 32.0, false);
        set(&mut document, 60.0, false);
        document.undo();
        assert_eq!(document.project.soot.radius_nm, 32.0);
        document.undo();
        assert_eq!(document.project.soot.radius_nm, first);
        document.redo();
        assert_eq!(document.project.soot.radius_nm, 32.0);
        set(&mut document, 5.0, false);
        document.redo();
        assert_eq!(document.project.soot.radius_nm, 5.0);
    }

    #[test]
    fn a_document_without_a_volume_asks_for_nothing() {
        let mut document = Document::new(Project::default());
        assert!(document.job([64, 64]).is_none());
        assert!(document.problem().is_none());
    }
}
