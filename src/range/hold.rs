//! What one frame takes from its own file, set as keys so that others take the same.

use glam::DVec3;

use crate::math::Aabb;
use crate::project::settings::VolumeSettings;
use crate::project::{BackdropKind, FieldSettings, Job, Project, Up};
use crate::scene::flame;
use crate::volume::{FieldKind, FieldMap, FieldMaps, Producer, UpAxis};

/// Whether a job of a project takes nothing from its file's own peaks: every field that it maps is set with all its numbers.
pub fn is_held(project: &Project, job: &Job) -> bool {
    job.flame.maps.iter().all(|(kind, _)| {
        let field = project.volume.field(kind);
        let numbers = [field.scale, field.offset, field.min, field.max];
        field.grid.is_some() && numbers.iter().all(Option::is_some)
    })
}

/// What a picture takes from its file where nothing is set.
#[derive(Debug, Clone, PartialEq)]
pub struct Taken {
    /// Whose conventions the fields follow.
    producer: Producer,
    maps: FieldMaps,
    /// The highest value of each mapped field in the file.
    peaks: Vec<(FieldKind, f64)>,
    up: UpAxis,
    /// Edge of a voxel, m, where the file's own was not taken.
    voxel_size_m: Option<f64>,
    /// The box of the fire, m; empty if there is none.
    fire: Aabb,
}

impl Taken {
    /// What a job of this project took from its volume.
    pub fn of(project: &Project, job: &Job) -> Self {
        let placement = &job.flame.placement;
        let mut maps = job.flame.maps.clone();
        // The fuel says how much soot there is only where no number does: from here on one does.
        if job.soot_follows_fuel
            && let Some(soot) = &mut maps.soot
        {
            let factor = project.fuel.name.row().soot_yield;
            *soot = FieldMap::new(
                &soot.grid,
                factor * soot.scale,
                factor * soot.offset,
                factor * soot.min,
                factor * soot.max,
            );
        }
        let peak = |(kind, map): (FieldKind, &FieldMap)| {
            let (_, high) = job.volume.grid(&map.grid)?.range();
            Some((kind, f64::from(high)))
        };
        Self {
            producer: job.producer,
            peaks: maps.iter().filter_map(peak).collect(),
            maps,
            up: placement.up,
            voxel_size_m: (placement.metres_per_unit != 1.0)
                .then_some(project.volume.voxel_size_m.unwrap_or(job.proposed_voxel_m)),
            fire: flame::world_bounds(&job.volume, &job.flame.maps, placement),
        }
    }

    /// The highest value of a field in the file; 0 where it has none.
    pub(super) fn peak(&self, kind: FieldKind) -> f64 {
        let mut peaks = self.peaks.iter();
        peaks
            .find(|(other, _)| *other == kind)
            .map_or(0.0, |(_, peak)| *peak)
    }

    /// Takes in another frame: its fire is framed as well, a field that is mapped by its peak is mapped by the higher one, and
    /// one that only the other has is taken as it is there.
    pub(super) fn join(&mut self, other: &Self) {
        self.fire = self.fire.union(&other.fire);
        if self.producer != other.producer {
            return;
        }
        for kind in FieldKind::ALL {
            let theirs = other.maps.get(kind);
            let is_better = match (self.maps.get(kind), theirs) {
                (Some(ours), Some(theirs)) => {
                    ours.grid == theirs.grid && other.peak(kind) > self.peak(kind)
                }
                // A field that is empty in this frame; no grid becomes two fields by that.
                (None, Some(theirs)) => self.maps.iter().all(|(_, map)| map.grid != theirs.grid),
                (_, None) => false,
            };
            if !is_better {
                continue;
            }
            let theirs = theirs.cloned();
            match kind {
                FieldKind::Soot => self.maps.soot = theirs,
                FieldKind::Smoke => self.maps.smoke = theirs,
                FieldKind::Flame => self.maps.flame = theirs,
                FieldKind::Temperature => self.maps.temperature = theirs,
            }
            self.peaks.retain(|(it, _)| *it != kind);
            self.peaks.push((kind, other.peak(kind)));
        }
    }

    /// Makes room for the fire as it is seen from all around.
    pub(super) fn turn_round(&mut self) {
        if self.fire.is_empty() {
            return;
        }
        let (centre, half) = (self.fire.centre(), 0.5 * self.fire.size());
        let radius = half.x.hypot(half.y);
        let half = DVec3::new(radius, radius, half.z);
        self.fire = Aabb {
            min: centre - half,
            max: centre + half,
        };
    }

    /// Sets it all in a project, for pictures of its size. What is set by hand stays, and a field that was not made from
    /// anything stays as it is: another frame may have it.
    pub fn hold(&self, project: &mut Project) {
        if self.maps.iter().next().is_some() {
            self.hold_fields(&mut project.volume);
        }
        if !self.fire.is_empty() {
            self.hold_view(project);
        }
    }

    /// The same for frames that were all looked at: a field that none of them has stays away.
    pub(super) fn hold_all(&self, project: &mut Project) {
        self.hold(project);
        for kind in FieldKind::ALL {
            if self.maps.get(kind).is_none() {
                project.volume.field_mut(kind).grid = Some(String::new());
            }
        }
    }

    fn hold_fields(&self, volume: &mut VolumeSettings) {
        volume.producer = self.producer;
        volume.up = match self.up {
            UpAxis::Y => Up::Y,
            UpAxis::Z => Up::Z,
        };
        volume.voxel_size_m = volume.voxel_size_m.or(self.voxel_size_m);
        for (kind, map) in self.maps.iter() {
            let field = volume.field_mut(kind);
            if field.grid.as_ref().is_some_and(|grid| *grid != map.grid) {
                continue;
            }
            *field = FieldSettings {
                grid: Some(map.grid.clone()),
                scale: field.scale.or(Some(map.scale)),
                offset: field.offset.or(Some(map.offset)),
                min: field.min.or(Some(map.min)),
                max: field.max.or(Some(map.max)),
            };
        }
    }

    fn hold_view(&self, project: &mut Project) {
        let camera = project.camera(&self.fire, project.render.size);
        project.camera.look_with(&camera);
        let defaults = project.stage.defaults(&self.fire, &camera);
        let stage = &mut project.stage;
        if stage.ground {
            stage
                .ground_height_m
                .get_or_insert(defaults.ground_height_m);
        }
        if stage.backdrop != BackdropKind::None {
            stage
                .backdrop_distance_m
                .get_or_insert(defaults.backdrop_distance_m);
        }
        if stage.backdrop == BackdropKind::Checker {
            stage
                .backdrop_square_m
                .get_or_insert(defaults.backdrop_square_m);
        }
    }
}
