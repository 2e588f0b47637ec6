//! Which volume is open: shown, replaced, completed by another file, filled with what was left unread.

use std::sync::Arc;

use super::{Document, OpenVolume, Step, is_same, within_bounds};
use crate::app::history::History;
use crate::project::{Backdrops, CameraSettings, Job, Project, ProjectError, VolumeSettings};
use crate::range;
use crate::volume::{Volume, Wanted, recognise};

impl Document {
    /// Shows a volume with the settings as they are: the one that the project itself names. No undo reaches behind it.
    ///
    /// # Errors
    /// [`ProjectError`]: it comes from files that cannot be rendered so. Everything stays as it was.
    pub fn open(&mut self, volume: Arc<Volume>) -> Result<(), ProjectError> {
        // The built-in flame can be rendered: there it is a setting that cannot, which a person can change.
        if !volume.sources.is_empty() {
            self.project.job_keeping(&volume, &mut self.backdrops)?;
            // A folder was named in the place of a frame in it.
            self.project.volume.path.clone_from(&volume.sources);
        }
        self.put(volume);
        self.history = History::default();
        Ok(())
    }

    /// Shows another volume than the project's. What belonged to the old file — its fields' mapping, where the
    /// camera stood — goes back to what is chosen from the file; fuel, soot, quality and view stay.
    /// An undo brings the old one back.
    ///
    /// # Errors
    /// [`ProjectError`]: there is nothing to render in it. Everything stays as it was.
    pub fn replace(&mut self, volume: Arc<Volume>) -> Result<(), ProjectError> {
        self.replace_and(volume, |_| {})
    }

    /// [`Document::replace`], with more changes in the same step.
    ///
    /// # Errors
    /// As [`Document::replace`].
    pub fn replace_and(
        &mut self,
        volume: Arc<Volume>,
        change: impl FnOnce(&mut Project),
    ) -> Result<(), ProjectError> {
        let mut project = self.project.clone();
        project.volume = VolumeSettings {
            path: volume.sources.clone(),
            built_in: volume.built_in.unwrap_or_default(),
            ..project.volume.for_another_file()
        };
        project.camera = CameraSettings::default();
        change(&mut project);
        project.job_keeping(&volume, &mut self.backdrops)?;
        let before = self.step();
        self.project = project;
        self.put_after(before, volume);
        Ok(())
    }

    /// Shows the open volume with a field more: every setting stays, and so does undo.
    ///
    /// # Errors
    /// [`ProjectError`]: it cannot be rendered with these settings. Everything stays as it was.
    pub fn complete(&mut self, volume: Arc<Volume>) -> Result<(), ProjectError> {
        self.project.job_keeping(&volume, &mut self.backdrops)?;
        let before = self.step();
        self.project.volume.path.clone_from(&volume.sources);
        self.put_after(before, volume);
        Ok(())
    }

    /// Shows a volume as a step of undo. There is none back to a window that shows nothing.
    fn put_after(&mut self, before: Step, volume: Arc<Volume>) {
        self.put(volume);
        if before.open.is_some() {
            self.history.push(before, within_bounds(self.open.clone()));
        } else {
            self.history = History::default();
        }
    }

    fn put(&mut self, volume: Arc<Volume>) {
        let recognised = recognise(&volume);
        self.restore(Some(Arc::new(OpenVolume {
            volume,
            recognised,
            is_a_step: false,
        })));
        self.metering = None;
    }

    /// Whether one more file may complete the open volume: it came from files and has a single field.
    pub fn wants_a_partner(&self) -> Option<&Arc<Volume>> {
        self.volume()
            .filter(|volume| volume.grid_names().count() == 1 && !volume.sources.is_empty())
    }

    /// What the settings need of the open files and was left unread; the last valid job stands until it is there.
    pub fn lacking(&self) -> Option<Wanted> {
        let volume = self.volume()?;
        let wanted = self.project.wanted();
        let is_new = volume.lacks(&wanted).is_some() && self.given_up.as_ref() != Some(&wanted);
        is_new.then_some(wanted)
    }

    /// What would be needed of other files, opened with these settings.
    pub fn wanted_of_another(&self) -> Wanted {
        let volume = self.project.volume.for_another_file();
        Project {
            volume,
            ..self.project.clone()
        }
        .wanted()
    }

    /// Shows the open volume with grids of its files that were left unread. No step of undo: the files are the same.
    pub fn fill(&mut self, volume: Arc<Volume>) {
        let recognised = recognise(&volume);
        let is_a_step = self.open.as_ref().is_some_and(|open| open.is_a_step);
        let filled = Some(Arc::new(OpenVolume {
            volume,
            recognised,
            is_a_step,
        }));
        let before = self.open.clone();
        self.history.for_each(|step| {
            if is_same(step.open.as_ref(), before.as_ref()) {
                step.open.clone_from(&filled);
            }
        });
        self.restore(filled);
    }

    /// Shows another frame of the sequence that the open files are one of: every setting stays, and what was measured. No
    /// step of undo: all steps are of this frame from here on.
    ///
    /// # Errors
    /// [`ProjectError`]: it cannot be rendered with these settings. Everything stays as it was.
    pub fn show_frame(&mut self, volume: Arc<Volume>) -> Result<(), ProjectError> {
        job_of(&self.project, &volume, true, &mut self.backdrops)?;
        let chosen = self.chosen;
        let paths = volume.sources.clone();
        let recognised = recognise(&volume);
        let frame = Some(Arc::new(OpenVolume {
            volume,
            recognised,
            is_a_step: true,
        }));
        let before = self.open.clone();
        self.history.for_each(|step| {
            if is_same(step.open.as_ref(), before.as_ref()) {
                step.open.clone_from(&frame);
                step.project.volume.path.clone_from(&paths);
            }
        });
        self.project.volume.path = paths;
        self.restore(frame);
        self.chosen = chosen;
        Ok(())
    }

    /// Sets what nobody chose, so that other frames are shown alike: no step of undo, and what it would bring back of the open
    /// volume holds it, too.
    pub fn hold(&mut self, hold: impl Fn(&mut Project)) {
        hold(&mut self.project);
        let open = self.open.clone();
        self.history.for_each(|step| {
            if is_same(step.open.as_ref(), open.as_ref()) {
                hold(&mut step.project);
            }
        });
    }

    /// Gives up on what is lacking, until something else is wanted or open.
    pub fn do_without_the_rest(&mut self) {
        self.given_up = self.lacking();
    }
}

/// The job of a project; of a frame that was stepped to without the fields whose grids it lacks, which is told.
pub(super) fn job_of(
    project: &Project,
    volume: &Arc<Volume>,
    is_a_step: bool,
    backdrops: &mut Backdrops,
) -> Result<Job, ProjectError> {
    if !is_a_step {
        return project.job_keeping(volume, backdrops);
    }
    let paths = project.volume.path.clone();
    let (project, without) = range::project_of(project, paths, volume);
    let mut job = project.job_keeping(volume, backdrops)?;
    job.flaws.extend(without);
    Ok(job)
}
