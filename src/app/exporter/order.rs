//! What is to be exported, as plain data.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::Document;
use crate::export::Format;
use crate::project::{CameraSettings, Project, Quality};
use crate::render::Effects;
use crate::render::develop::Metering;
use crate::study::Numbers;
use crate::volume::Volume;

/// How exactly an export is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(in crate::app) enum Exactness {
    /// With the numbers of [`Quality::Final`].
    #[default]
    Final,
    /// With the numbers of the window.
    AsSeen,
}

/// What a person asked for.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) struct Wish {
    /// Where to.
    pub(in crate::app) path: PathBuf,
    /// As what.
    pub(in crate::app) format: Format,
    /// Width and height in pixels.
    pub(in crate::app) size: [u32; 2],
    /// How exactly.
    pub(in crate::app) exactness: Exactness,
}

/// A still to be written.
#[derive(Clone)]
pub(in crate::app) struct Order {
    /// What is rendered, at the size of `render.size`.
    pub(in crate::app) project: Project,
    /// The open volume.
    pub(in crate::app) volume: Arc<Volume>,
    /// Brightness and white of the window; measured on the still itself if the window has none yet.
    pub(in crate::app) metering: Option<Metering>,
    /// Which effects the window shows, where that is known: an export leaves none of them out, and adds none.
    pub(in crate::app) effects: Option<Effects>,
    /// Where to.
    pub(in crate::app) path: PathBuf,
    /// As what.
    pub(in crate::app) format: Format,
}

impl Exactness {
    /// The project with the numbers that it is exported with.
    pub(in crate::app) fn of(self, project: &Project) -> Project {
        let mut project = project.clone();
        if self == Self::Final {
            let render = &mut project.render;
            render.quality = Quality::Final;
            render.target_error = None;
            render.step_voxels = None;
            render.wavelengths = None;
            render.samples_per_pixel = None;
        }
        project
    }
}

impl Wish {
    /// The order that it stands for: the document's volume and settings, seen from where the window sees them, with
    /// its brightness. `None` while nothing is shown.
    pub(in crate::app) fn order(
        self,
        document: &Document,
        metering: Option<Metering>,
        on_show: Option<Effects>,
    ) -> Option<Order> {
        let volume = Arc::clone(document.volume()?);
        let project = self.project(document)?;
        Some(Order {
            project,
            volume,
            metering,
            effects: on_show,
            path: self.path,
            format: self.format,
        })
    }

    /// What is set, with size, camera and numbers of this wish.
    pub(super) fn project(&self, document: &Document) -> Option<Project> {
        // A camera that frames the flame would stand elsewhere in a picture of another shape.
        let camera = document.last_job()?.camera;
        let mut project = self.exactness.of(&document.project);
        if self.exactness == Exactness::AsSeen {
            // What was chosen for the window, and is carried in it, is what is seen.
            let asked = Numbers::of(&document.last_job()?.settings);
            let carried = document.carried;
            carried
                .map_or(asked, |count| asked.carrying(count))
                .by_hand(&mut project.render);
        }
        project.camera = CameraSettings::from(&camera);
        project.render.size = self.size;
        Some(project)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn final_numbers_take_the_place_of_every_override() {
        let mut project = Project::default();
        let overrides = [
            "render.step_voxels=4",
            "render.wavelengths=4",
            "render.samples_per_pixel=2",
        ];
        project.set_all(overrides).unwrap();
        assert_eq!(Exactness::AsSeen.of(&project), project);
        let settings = Exactness::Final.of(&project).settings([8, 8]).unwrap();
        let numbers = (
            settings.step_voxels,
            settings.wavelengths,
            settings.samples_per_pixel,
        );
        assert_eq!(numbers, Quality::Final.numbers());
    }
}
