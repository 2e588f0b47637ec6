//! What a volume's grids are taken as: a producer's preset with a person's overrides, and what is still assumed.

use super::error::ProjectError;
use super::set::did_you_mean;
use super::settings::{FieldSettings, Project, VolumeSettings};
use crate::render::{Flaws, Switch};
use crate::volume::{
    self, About, FieldKind, FieldMap, FieldMaps, Preset, Producer, Volume, Wanted,
};

impl VolumeSettings {
    /// The overrides of one field.
    pub fn field(&self, kind: FieldKind) -> &FieldSettings {
        match kind {
            FieldKind::Soot => &self.soot,
            FieldKind::Smoke => &self.smoke,
            FieldKind::Flame => &self.flame,
            FieldKind::Temperature => &self.temperature,
        }
    }

    /// The overrides of one field, to be changed.
    pub fn field_mut(&mut self, kind: FieldKind) -> &mut FieldSettings {
        match kind {
            FieldKind::Soot => &mut self.soot,
            FieldKind::Smoke => &mut self.smoke,
            FieldKind::Flame => &mut self.flame,
            FieldKind::Temperature => &mut self.temperature,
        }
    }
}

impl Project {
    /// Which grids of the files this project needs: no field that only an effect reads which is switched off.
    pub fn wanted(&self) -> Wanted {
        let named = FieldKind::ALL.map(|kind| self.volume.field(kind).grid.clone());
        let left_out = [
            (FieldKind::Flame, self.effects.chemiluminescence),
            (FieldKind::Smoke, self.effects.smoke),
        ];
        Wanted::fields(
            self.volume.producer,
            named.into_iter().flatten(),
            left_out
                .into_iter()
                .filter(|(_, switch)| *switch == Switch::Off)
                .map(|(kind, _)| kind),
        )
    }
}

/// The mappings of all fields: as set, and as they would be without the numbers that a person set. Adds what the preset had to assume, and no setting has settled, to the flaws.
///
/// # Errors
/// A named grid does not exist, a number is out of range, or nothing is left to render.
pub(super) fn field_maps(
    settings: &VolumeSettings,
    volume: &Volume,
    producer: Producer,
    preset: &Preset,
    flaws: &mut Flaws,
) -> Result<(FieldMaps, FieldMaps), ProjectError> {
    for assumption in &preset.assumptions {
        let settled = match assumption.about {
            About::Field(kind) => !settings.field(kind).is_unset(),
            About::VoxelSize => settings.voxel_size_m.is_some(),
        };
        if !settled {
            flaws.add(assumption.words.clone());
        }
    }
    let mut merge = |kind: FieldKind, base: Option<&FieldMap>| {
        merged(volume, producer, kind, settings.field(kind), base, flaws)
    };
    let (soot, soot_proposed) = merge(FieldKind::Soot, preset.maps.soot.as_ref())?.unzip();
    // A grid that a person made the soot is not smoke as well, unless she says so.
    let taken = |smoke: &&FieldMap| soot.as_ref().is_some_and(|soot| soot.grid == smoke.grid);
    let smoke = preset.maps.smoke.as_ref().filter(|smoke| !taken(smoke));
    let (smoke, smoke_proposed) = merge(FieldKind::Smoke, smoke)?.unzip();
    let (flame, flame_proposed) = merge(FieldKind::Flame, preset.maps.flame.as_ref())?.unzip();
    let (temperature, temperature_proposed) =
        merge(FieldKind::Temperature, preset.maps.temperature.as_ref())?.unzip();
    let maps = FieldMaps {
        soot,
        smoke,
        flame,
        temperature,
    };
    let proposed = FieldMaps {
        soot: soot_proposed,
        smoke: smoke_proposed,
        flame: flame_proposed,
        temperature: temperature_proposed,
    };
    // What was repaired in a grid that no field uses is no flaw of the picture.
    let unused = |note: &&String| {
        let mut grids = volume.grids.iter();
        grids.any(|grid| {
            note.starts_with(&format!("{}: ", grid.name))
                && maps.iter().all(|(_, map)| map.grid != grid.name)
        })
    };
    flaws.extend(volume.notes.iter().filter(|note| !unused(note)).cloned());
    if maps.soot.is_none() && maps.smoke.is_none() {
        return Err(ProjectError::NothingToRender {
            available: grid_names(volume),
        });
    }
    Ok((maps, proposed))
}

/// One field: the preset's mapping, or that of the grid a person chose, with the numbers she set and without them.
fn merged(
    volume: &Volume,
    producer: Producer,
    kind: FieldKind,
    set: &FieldSettings,
    base: Option<&FieldMap>,
    flaws: &mut Flaws,
) -> Result<Option<(FieldMap, FieldMap)>, ProjectError> {
    let key = |part: &str| format!("volume.{}.{part}", kind.name());
    let mut map = match (set.grid.as_deref(), base) {
        (Some(""), _) | (None, None) => return Ok(None),
        (None, Some(base)) => base.clone(),
        (Some(name), Some(base)) if base.grid == name => base.clone(),
        (Some(name), _) => {
            let grid = volume.grid(name).ok_or_else(|| {
                if volume.grid_names().any(|other| other == name) {
                    return ProjectError::GridNotRead {
                        key: key("grid"),
                        name: name.to_owned(),
                    };
                }
                ProjectError::NoSuchGrid {
                    key: key("grid"),
                    hint: did_you_mean(name, volume.grid_names())
                        .map_or(String::new(), |name| format!("; did you mean \"{name}\"?")),
                    available: grid_names(volume),
                    name: name.to_owned(),
                }
            })?;
            let (map, assumed) = volume::mapping(kind, grid, producer);
            // Whoever gives the scale knows the units.
            if set.scale.is_none() {
                flaws.extend(assumed.into_iter().map(|assumption| assumption.words));
            }
            map
        }
    };
    let proposed = map.clone();
    for (target, value) in [
        (&mut map.scale, set.scale),
        (&mut map.offset, set.offset),
        (&mut map.min, set.min),
        (&mut map.max, set.max),
    ] {
        if let Some(value) = value {
            *target = value;
        }
    }
    for (part, value) in [("scale", map.scale), ("offset", map.offset)] {
        if !value.is_finite() {
            return Err(ProjectError::NotFinite {
                key: key(part),
                value,
            });
        }
    }
    if [set.scale, set.offset, set.min, set.max]
        .iter()
        .any(Option::is_some)
    {
        say_clamped(volume, kind, &map, flaws);
    }
    let greatest = kind.greatest();
    for (part, value) in [("min", map.min), ("max", map.max)] {
        if !(0.0..=greatest).contains(&value) {
            return Err(ProjectError::FieldRange {
                key: key(part),
                value,
                greatest,
            });
        }
    }
    if map.min > map.max {
        return Err(ProjectError::NoInterval {
            key: key("min"),
            min: map.min,
            max: map.max,
        });
    }
    Ok(Some((map, proposed)))
}

/// Adds a flaw where the numbers that a person set reach beyond the mapping's own bounds.
fn say_clamped(volume: &Volume, kind: FieldKind, map: &FieldMap, flaws: &mut Flaws) {
    let Some(grid) = volume.grid(&map.grid) else {
        return;
    };
    let free = FieldMap {
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
        ..map.clone()
    };
    let (low, high) = free.mapped_range((f64::from(grid.range().0), f64::from(grid.range().1)));
    // A hair beyond the bounds is rounding, not a clamp that shows.
    let slack = 1e-6 * (map.max - map.min);
    if low < map.min - slack || high > map.max + slack {
        flaws.add(format!(
            "{} would reach from {low:.3e} to {high:.3e} {}: clamped to {:.3e} to {:.3e}",
            kind.name(),
            kind.unit(),
            map.min,
            map.max
        ));
    }
}

/// The grids' names in quotes, for a message.
fn grid_names(volume: &Volume) -> String {
    let names = volume.grid_names().map(|name| format!("\"{name}\""));
    let names: Vec<String> = names.collect();
    if names.is_empty() {
        "no grids".into()
    } else {
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;

    use glam::{DAffine3, IVec3};

    use super::*;
    use crate::project::{Job, Project};
    use crate::volume::{Border, Grid};

    /// What a solver writes: no units anywhere.
    fn solver() -> Arc<Volume> {
        let grid = |name: &str, peak: f32| {
            let ramp = move |voxel: IVec3| peak * (voxel.x + 1) as f32 / 4.0;
            Grid::from_fn(
                name,
                IVec3::splat(4),
                DAffine3::IDENTITY,
                Border::Background,
                0.0,
                ramp,
            )
        };
        let grids = vec![
            grid("density", 0.3),
            grid("flame", 1.0),
            grid("temperature", 2.2),
            grid("heat", 3.0),
        ];
        Arc::new(Volume {
            voxel_size_is_known: false,
            ..Volume::from_grids(grids, "solver")
        })
    }

    fn job(assignments: &[&str]) -> Result<Job, ProjectError> {
        let mut project = Project::default();
        project.set_all(assignments.iter().copied()).unwrap();
        project.job(&solver())
    }

    fn says(job: &Job, words: &str) -> bool {
        job.flaws.iter().any(|flaw| flaw.contains(words))
    }

    #[test]
    fn what_a_person_sets_is_no_longer_assumed() {
        let untouched = job(&[]).unwrap();
        for words in ["solver heat", "no soot grid", "voxels of 10 mm"] {
            assert!(says(&untouched, words), "{words}");
        }
        let set = job(&[
            "volume.temperature.scale=700",
            "volume.soot.scale=3e-6",
            "volume.voxel_size_m=0.02",
        ])
        .unwrap();
        for words in ["solver heat", "no soot grid", "voxels of"] {
            assert!(!says(&set, words), "{words}");
        }
    }

    #[test]
    fn a_grid_chosen_by_hand_gets_units_that_are_told_and_is_used_once() {
        let chosen = job(&["volume.soot.grid=density", "volume.temperature.grid=heat"]).unwrap();
        let maps = &chosen.flame.maps;
        let soot = maps.soot.as_ref().unwrap();
        assert_eq!(soot.apply(f64::from(0.3_f32)), soot.max);
        assert!(soot.max < 1e-5, "{soot:?}");
        assert!(maps.smoke.is_none(), "density would count twice");
        assert!((maps.temperature.as_ref().unwrap().apply(3.0) - 2000.0).abs() < 1e-9);
        assert!(says(&chosen, "density has no units") && says(&chosen, "heat is solver heat"));
        let physical = job(&["volume.producer=physical", "volume.temperature.grid=heat"]).unwrap();
        assert_eq!(physical.flame.maps.temperature.as_ref().unwrap().scale, 1.0);
    }

    #[test]
    fn a_mapping_beyond_physics_is_refused_by_key() {
        for (assignment, key) in [
            ("volume.soot.max=inf", "volume.soot.max"),
            ("volume.soot.min=-1", "volume.soot.min"),
            ("volume.temperature.max=1e9", "volume.temperature.max"),
            ("volume.temperature.min=nan", "volume.temperature.min"),
            ("volume.flame.max=2", "volume.flame.max"),
            ("volume.soot.scale=inf", "volume.soot.scale"),
        ] {
            let error = job(&[assignment]).unwrap_err().to_string();
            assert!(error.starts_with(key), "{assignment}: {error}");
        }
        assert!(says(
            &job(&["volume.soot.scale=1e60"]).unwrap(),
            "soot would reach"
        ));
        assert!(!says(&job(&["volume.soot.scale=1e-6"]).unwrap(), "clamped"));
    }

    #[test]
    fn nothing_to_render_says_what_was_found_and_a_wrong_name_what_was_meant() {
        let grid = |name: &str| {
            Grid::from_fn(
                name,
                IVec3::ONE,
                DAffine3::IDENTITY,
                Border::Background,
                0.0,
                |_| 1.0,
            )
        };
        let volume = Arc::new(Volume::from_grids(vec![grid("velocity"), grid("flam")], ""));
        let mut project = Project::default();
        let nothing = project.job(&volume).unwrap_err();
        assert!(
            matches!(nothing, ProjectError::NothingToRender { .. }),
            "{nothing}"
        );
        assert!(
            nothing.to_string().contains("\"velocity\", \"flam\""),
            "{nothing}"
        );
        project.set("volume.soot.grid=flame").unwrap();
        let wrong = project.job(&volume).unwrap_err().to_string();
        assert!(wrong.contains("did you mean \"flam\"?"), "{wrong}");
    }

    #[test]
    fn smoke_that_is_physical_keeps_its_values() {
        let grid = |name: &str, value: f32| {
            Grid::from_fn(
                name,
                IVec3::ONE,
                DAffine3::IDENTITY,
                Border::Background,
                0.0,
                move |_| value,
            )
        };
        let grids = vec![
            grid("soot", 2e-6),
            grid("smoke", 9e-6),
            grid("temperature", 1500.0),
        ];
        let job = Project::default()
            .job(&Arc::new(Volume::from_grids(grids, "")))
            .unwrap();
        assert_eq!(job.flame.maps.smoke.unwrap().apply(9e-6), 9e-6);
    }
}
