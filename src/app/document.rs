//! What is open and what a person set: a [`Project`] with undo, and the volume it is about.
//!
//! The document asks nobody to render. It only says, when asked, which [`Job`] it stands for; the window compares
//! that with what it submitted last.

mod volumes;

use std::path::PathBuf;
use std::sync::Arc;

use super::history::History;
use crate::colour::display::View;
use crate::project::{Accuracy, Backdrops, Job, Project, ViewSettings};
use crate::render::Facts;
use crate::render::costs::Cost;
use crate::render::develop::Metering;
use crate::render::plan::Decision;
use crate::scene::{Camera, flame};
use crate::study::Numbers;
use crate::volume::{FieldKind, Recognised, Volume, Wanted};

/// Steps that can be taken back.
const MOST_UNDO: usize = 200;
/// Volumes that are kept in memory for the sake of undo, beside the open one: they may be large.
const MOST_UNDO_VOLUMES: usize = 1;

/// A project and its open volume.
#[derive(Debug)]
pub struct Document {
    /// All that a person can set. Panels change it freely; [`Document::remember`] makes the change undoable.
    pub project: Project,
    /// Size of the picture in pixels; `None`: as large as the canvas. Not a part of the scene, so no step of undo.
    pub fixed_size: Option<[u32; 2]>,
    /// Brightness and white of the open volume, measured once: what the view's exposure counts from. `None` before a
    /// picture of it could be seen.
    pub metering: Option<Metering>,
    /// Which effects the newest picture is computed with, and why; empty while nobody has decided.
    pub decisions: Vec<Decision>,
    /// What effects cost in it; empty while that is not measured.
    pub costs: Vec<Cost>,
    /// What was found out about it.
    pub facts: Facts,
    /// How many wavelengths are carried in it, which may be more than were asked for; `None` while that is not known.
    pub carried: Option<u32>,
    open: Option<Arc<OpenVolume>>,
    history: History<Step>,
    /// Numbers that were chosen for a wish, in place of those for a scene that nobody has looked at.
    chosen: Option<(Accuracy, Numbers)>,
    /// The last job that could be rendered.
    job: Option<Job>,
    /// What was last asked of the open volume: the answer stands while this does.
    asked: Option<Project>,
    problem: Option<String>,
    /// What could not be read, or was not to be: it is not tried again.
    given_up: Option<Wanted>,
    /// The picture behind the fire, so that it is read once.
    backdrops: Backdrops,
}

#[derive(Debug)]
struct OpenVolume {
    volume: Arc<Volume>,
    recognised: Recognised,
    /// Whether it is a frame that was stepped to: it may lack grids that others of its sequence have.
    is_a_step: bool,
}

/// What an undo brings back. An opening is a step as well: a file dropped by mistake costs nothing.
#[derive(Debug, Clone)]
pub(super) struct Step {
    project: Project,
    metering: Option<Metering>,
    open: Option<Arc<OpenVolume>>,
}

impl Step {
    /// All that was set.
    pub(super) fn project(&self) -> &Project {
        &self.project
    }

    /// Whether the volume that it is about is in memory for its sake.
    pub(super) fn holds_a_volume(&self) -> bool {
        self.open.is_some()
    }

    /// Whether two are about one volume in memory.
    pub(super) fn is_of_one_volume_with(&self, other: &Self) -> bool {
        is_same(self.open.as_ref(), other.open.as_ref())
    }

    /// Holds the volume no more: it has to be read again.
    pub(super) fn let_the_volume_go(&mut self) {
        self.open = None;
    }
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
            fixed_size: None,
            metering: None,
            decisions: Vec::new(),
            costs: Vec::new(),
            facts: Facts::default(),
            carried: None,
            open: None,
            history: History::default(),
            chosen: None,
            job: None,
            asked: None,
            problem: None,
            given_up: None,
            backdrops: Backdrops::default(),
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

    fn restore(&mut self, open: Option<Arc<OpenVolume>>) {
        if !is_same(self.open.as_ref(), open.as_ref()) {
            self.given_up = None;
            self.open = open;
            self.chosen = None;
            self.job = None;
            self.asked = None;
        }
    }

    /// All that an undo brings back, as it is.
    pub(super) fn step(&self) -> Step {
        Step {
            project: self.project.clone(),
            metering: self.metering,
            open: self.open.clone(),
        }
    }

    /// The names of the open files without their folders, or what is shown instead of files.
    pub fn title(&self) -> String {
        let sources = self
            .volume()
            .map_or(&self.project.volume.path, |v| &v.sources);
        if sources.is_empty() {
            return format!("built-in {}", self.project.volume.built_in.name());
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
        if self.lacking().is_some() {
            return self.job.as_ref();
        }
        let open = self.open.as_ref()?;
        if open.volume.lacks(&self.project.wanted()).is_none() {
            self.given_up = None;
        }
        let canvas = self.fixed_size.unwrap_or(canvas);
        let volume = &self.open.as_ref()?.volume;
        let asked = self.asked.as_ref();
        // A job has no view: exposure and adaptation ask for none.
        let mut sized = self.project.clone();
        sized.render.size = canvas;
        sized.view = ViewSettings::default();
        if asked == Some(&sized) {
            return self.job.as_ref();
        }
        match volumes::job_of(&sized, volume, open.is_a_step, &mut self.backdrops) {
            Ok(mut job) => {
                if let Some((wished, numbers)) = self.chosen
                    && wished == job.accuracy
                {
                    let given = Numbers::of(&job.settings);
                    job.settings = numbers.where_free(wished, given).within(&job.settings);
                }
                self.job = Some(job);
                self.problem = None;
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
        self.asked = Some(sized);
        self.job.as_ref()
    }

    /// From here on these numbers stand for this wish.
    pub fn choose(&mut self, wished: Accuracy, numbers: Numbers) {
        if self.chosen != Some((wished, numbers)) {
            self.chosen = Some((wished, numbers));
            self.asked = None;
        }
    }

    /// Whether the numbers of the last valid job were chosen for its wish.
    pub fn is_chosen(&self) -> bool {
        let wished = self.job.as_ref().map(|job| job.accuracy);
        wished.is_some_and(|wished| self.chosen.is_some_and(|(it, _)| it == wished))
    }

    /// The last valid job.
    pub fn last_job(&self) -> Option<&Job> {
        self.job.as_ref()
    }

    /// The project to be changed, beside the last valid job.
    pub fn parts(&mut self) -> (&mut Project, Option<&Job>) {
        (&mut self.project, self.job.as_ref())
    }

    /// Looks from here on with this camera, whatever the flame's size.
    pub fn move_camera(&mut self, camera: &Camera) {
        self.project.camera.look_with(camera);
    }

    /// Moves the camera so that all of the flame is seen, from the side that it is seen from now. From the front that
    /// is the camera of a project that sets none, which goes on to frame the flame when the window's size changes.
    pub fn frame_all(&mut self) {
        let Some(job) = &self.job else { return };
        if job.camera.is_at_the_front() {
            self.project.camera.frame_the_flame();
            return;
        }
        let placement = &job.flame.placement;
        let bounds = flame::world_bounds(&job.volume, &job.flame.maps, placement);
        let [width, height] = job.settings.size.map(f64::from);
        let framed = job.camera.framed(&bounds, width / height);
        self.move_camera(&framed);
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
        let before = (self.project != before).then(|| Step {
            project: before,
            ..self.step()
        });
        self.history
            .follow(before, held, within_bounds(self.open.clone()));
    }

    /// Makes a change that is one step of undo.
    pub fn change(&mut self, change: impl FnOnce(&mut Self)) {
        let before = self.step();
        change(self);
        if self.project != before.project || self.metering != before.metering {
            self.history.push(before, within_bounds(self.open.clone()));
        }
    }

    /// Takes in what was measured of the open volume by itself. What earlier steps were measured with is replaced, too:
    /// nobody has chosen it.
    pub fn measured(&mut self, metering: Metering) {
        let old = self.metering.replace(metering);
        let open = self.open.clone();
        self.history.for_each(|step| {
            if is_same(step.open.as_ref(), open.as_ref()) && step.metering == old {
                step.metering = Some(metering);
            }
        });
    }

    /// How the picture is developed: what a person set, over what was measured.
    pub fn view(&self) -> View {
        self.metered().view(&self.project.view())
    }

    /// Luminance to which the eye's curve responds half if none is set, cd m⁻².
    pub fn automatic_half_saturation_cd_m2(&self) -> f64 {
        self.metered().automatic_half_saturation_cd_m2()
    }

    /// What was measured, or a stand-in for as long as nothing was, with what is set in its place.
    fn metered(&self) -> Metering {
        let measured = self.metering.unwrap_or(Metering {
            exposure: 1.0,
            white_xyz: [0.0; 3],
            bright_y: 0.0,
        });
        measured.with_set(&self.project.view())
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        let now = self.step();
        if let Some(before) = self.history.undo(now) {
            self.go_to(before);
        }
    }

    /// Takes the last undo back.
    pub fn redo(&mut self) {
        let now = self.step();
        if let Some(after) = self.history.redo(now) {
            self.go_to(after);
        }
    }

    /// Whether there is something to take back.
    pub fn can_undo(&self) -> bool {
        self.history.can_undo()
    }

    /// Whether there is an undo to take back.
    pub fn can_redo(&self) -> bool {
        self.history.can_redo()
    }

    /// Goes back to what was, as one step of undo.
    pub(super) fn return_to(&mut self, step: &Step) {
        let before = self.step();
        self.go_to(step.clone());
        let is_same = is_same(self.open.as_ref(), before.open.as_ref());
        if !is_same || self.project != before.project || self.metering != before.metering {
            self.history.push(before, within_bounds(self.open.clone()));
        }
    }

    fn go_to(&mut self, step: Step) {
        self.project = step.project;
        self.metering = step.metering;
        self.restore(step.open);
    }
}

/// Which steps are kept, asked newest first: so many, with so few volumes beside the open one.
fn within_bounds(open: Option<Arc<OpenVolume>>) -> impl FnMut(&Step) -> bool + use<> {
    let mut newer = open;
    let (mut steps, mut volumes) = (0, 0);
    move |step| {
        steps += 1;
        volumes += usize::from(!is_same(newer.as_ref(), step.open.as_ref()));
        newer.clone_from(&step.open);
        steps <= MOST_UNDO && volumes <= MOST_UNDO_VOLUMES
    }
}

fn is_same(one: Option<&Arc<OpenVolume>>, other: Option<&Arc<OpenVolume>>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other),
        (one, other) => one.is_none() && other.is_none(),
    }
}

#[cfg(test)]
mod tests;
