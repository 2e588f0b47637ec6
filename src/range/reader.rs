//! The fires of one picture after another, read and packed.

use std::path::PathBuf;
use std::sync::Arc;

use super::shots::Shot;
use super::{FrameError, open, project_of};
use crate::export::Still;
use crate::project::Project;
use crate::render::Cancel;
use crate::scene::Scene;
use crate::volume::{Volume, VolumeError, Wanted, Watch};

/// Reads fires, and keeps the last: a turntable is of one.
pub(super) struct Reader<'a> {
    cancel: &'a Cancel,
    read: Option<Read>,
    scene: Option<Scene>,
}

/// What was read last.
struct Read {
    paths: Vec<PathBuf>,
    wanted: Wanted,
    volume: Arc<Volume>,
}

impl<'a> Reader<'a> {
    /// A reader that stops in the middle of a file once it is cancelled.
    pub(super) fn new(cancel: &'a Cancel) -> Self {
        Self {
            cancel,
            read: None,
            scene: None,
        }
    }

    /// What a project needs of a picture's files.
    ///
    /// # Errors
    /// Any [`VolumeError`].
    pub(super) fn volume(
        &mut self,
        project: &Project,
        shot: &Shot,
    ) -> Result<Arc<Volume>, VolumeError> {
        let wanted = project.wanted();
        let known = self.read.as_ref();
        if let Some(known) = known.filter(|it| it.paths == shot.paths && it.wanted == wanted) {
            return Ok(Arc::clone(&known.volume));
        }
        // Two fires in memory are one more than is needed.
        (self.read, self.scene) = (None, None);
        let volume = if shot.paths.is_empty() {
            Arc::new(project.volume.built_in.volume())
        } else {
            let cancel = self.cancel.clone();
            let watch = Watch::with_listener(move |watch| {
                if cancel.is_cancelled() {
                    watch.cancel();
                }
            });
            open(project, &shot.paths, &watch)?
        };
        self.read = Some(Read {
            paths: shot.paths.clone(),
            wanted,
            volume: Arc::clone(&volume),
        });
        Ok(volume)
    }

    /// The still of a picture of a range that is held. What its file does without is among its flaws.
    ///
    /// # Errors
    /// Any [`FrameError`].
    pub(super) fn still(&mut self, held: &Project, shot: &Shot) -> Result<Still, FrameError> {
        let volume = self.volume(held, shot)?;
        let (project, without) = project_of(&shot.seen(held), shot.paths.clone(), &volume);
        let mut still = Still::new(&project, &volume, None)?;
        still.job.flaws.extend(without);
        Ok(still)
    }

    /// A still's scene, which takes over what was packed for the one before.
    pub(super) fn scene(&mut self, still: &Still) -> Scene {
        let scene = still.scene_after(self.scene.as_ref());
        self.scene = Some(scene.clone());
        scene
    }
}
