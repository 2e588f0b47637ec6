//! Why a picture is black, in words, and what would mend it.
//!
//! Judged by the ranges of the fields and the camera, not by pixels: a film is only asked whether it is black.

use glam::DVec3;

use super::job::Job;
use super::settings::{FieldSettings, Project};
use crate::math::Aabb;
use crate::scene::glow::VAPOUR_K;
use crate::scene::{Fuel, GlowParams, Salt, flame};
use crate::volume::{FieldKind, GLOW_K, PEAK_K, figures};

/// Why nothing is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Darkness {
    /// The reason, for a person.
    pub words: String,
    /// What would mend it, if a setting would.
    pub mend: Option<Mend>,
}

/// A change of settings that brings light.
#[derive(Debug, Clone, PartialEq)]
pub enum Mend {
    /// Take the soot as the file has it.
    SootAmount,
    /// Take the smoke as the file has it.
    SmokeAmount,
    /// Burn what makes soot.
    Fuel,
    /// Take the field as the producer's preset does.
    Field(FieldKind),
    /// Heat: these factors from the file's numbers to kelvin.
    Heat {
        /// Kelvin for one unit of the file.
        scale: f64,
        /// Kelvin at a raw zero.
        offset: f64,
    },
    /// Frame the flame.
    Camera,
}

/// Temperature of the coldest voxel of a field that is made hot, K.
const AMBIENT_K: f64 = 300.0;

impl Darkness {
    /// Why a black picture of this job is black.
    pub fn of(job: &Job) -> Self {
        no_soot(job)
            .or_else(|| too_cold(job))
            .or_else(|| out_of_sight(job))
            .unwrap_or_else(|| {
                let what = if glows_beside_soot(job) {
                    "what glows is too faint to be seen"
                } else {
                    "there is too little soot to glow"
                };
                let more = if burns_without_soot(job) {
                    Mend::Fuel
                } else {
                    Mend::SootAmount
                };
                Self {
                    words: format!(
                        "the picture is black: where the fire is above {GLOW_K} K {what}"
                    ),
                    mend: (job.flame.soot_amount < 1.0).then_some(more),
                }
            })
    }
}

/// Whether the fuel says how much soot there is, and that is none.
fn burns_without_soot(job: &Job) -> bool {
    job.soot_follows_fuel && job.flame.fuel.row().soot_yield <= 0.0
}

/// Whether a salt or radicals may glow.
fn glows_beside_soot(job: &Job) -> bool {
    let flame = &job.flame;
    let without = |glow: GlowParams| {
        let mut other = flame.clone();
        other.glow = glow;
        other
    };
    let none = without(GlowParams {
        salt: Salt::default(),
        radicals: 0.0,
        ..flame.glow
    });
    !flame.gives_same_light_as(&none)
}

fn no_soot(job: &Job) -> Option<Darkness> {
    let flame = &job.flame;
    let amounts = [flame.soot_amount, flame.smoke_amount];
    let kinds = [FieldKind::Soot, FieldKind::Smoke];
    let densest = |kind| physical_range(job, kind).map_or(0.0, |(_, high)| high);
    if glows_beside_soot(job) || (0..2).any(|i| amounts[i] * densest(kinds[i]) > 0.0) {
        return None;
    }
    Some(if burns_without_soot(job) {
        Darkness {
            words: "the picture is black: this fuel burns without soot, and nothing else glows. Add a salt, or burn another"
                .to_owned(),
            mend: Some(Mend::Fuel),
        }
    } else if densest(FieldKind::Soot) > 0.0 {
        Darkness {
            words: "the picture is black: the amount of soot is 0".to_owned(),
            mend: Some(Mend::SootAmount),
        }
    } else if densest(FieldKind::Smoke) > 0.0 {
        Darkness {
            words: "the picture is black: the amount of smoke is 0, and there is no soot"
                .to_owned(),
            mend: Some(Mend::SmokeAmount),
        }
    } else {
        Darkness {
            words: "the picture is black: no voxel holds soot. Is its scale right?".to_owned(),
            mend: as_proposed(job, FieldKind::Soot),
        }
    })
}

/// Back to the preset's mapping of a field, if it is another one.
fn as_proposed(job: &Job, kind: FieldKind) -> Option<Mend> {
    let changed = job.flame.maps.get(kind) != job.proposed.get(kind);
    let off = job.flame.maps.get(kind).is_none();
    (changed || off).then_some(Mend::Field(kind))
}

fn too_cold(job: &Job) -> Option<Darkness> {
    let least_k = match (job.flame.has_soot(), job.flame.gas_shines_by_heat()) {
        (true, _) => GLOW_K,
        (false, true) => VAPOUR_K[0],
        // Heat would show nothing.
        (false, false) => return None,
    };
    let Some((_, hottest)) = physical_range(job, FieldKind::Temperature) else {
        return (job.flame.air.temperature_k < least_k).then(|| Darkness {
            words: "the picture is black: there is no temperature field, so all gas is as cold as the air".to_owned(),
            mend: Some(Mend::Field(FieldKind::Temperature)),
        });
    };
    if hottest >= least_k {
        return None;
    }
    let map = job.flame.maps.temperature.as_ref()?;
    let (low, high) = job.volume.grid(&map.grid)?.range();
    let (low, high) = (f64::from(low).min(0.0), f64::from(high));
    let scale = (PEAK_K - AMBIENT_K) / (high - low);
    let heat = Mend::Heat {
        scale,
        offset: AMBIENT_K - scale * low,
    };
    Some(Darkness {
        words: format!(
            "the picture is black: no voxel is above {least_k} K, the hottest has {} K. Is the temperature's scale right?",
            figures(hottest.round())
        ),
        mend: scale.is_finite().then_some(heat),
    })
}

fn out_of_sight(job: &Job) -> Option<Darkness> {
    let flame = &job.flame;
    let bounds = flame::world_bounds(&job.volume, &flame.maps, &flame.placement);
    (!bounds.is_empty() && !may_be_seen(job, &bounds)).then(|| Darkness {
        words: "the picture is black: the camera looks elsewhere".to_owned(),
        mend: Some(Mend::Camera),
    })
}

/// Whether a box may reach into the picture: no plane through the eye and an edge of the picture has all of it outside.
fn may_be_seen(job: &Job, bounds: &Aabb) -> bool {
    let [width, height] = job.settings.size;
    let (w, h) = (f64::from(width), f64::from(height));
    let Ok(view) = job.camera.view([width, height]) else {
        return false;
    };
    let around = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]].map(|[x, y]| view.ray(x, y).direction);
    let middle = view.ray(0.5 * w, 0.5 * h).direction;
    let sides = (0..4).map(|i| around[i].cross(around[(i + 1) % 4]));
    let inwards = sides.map(|normal| normal * normal.dot(middle).signum());
    let corners: Vec<DVec3> = bounds.corners().collect();
    let outside = |normal: DVec3| {
        corners
            .iter()
            .all(|&corner| normal.dot(corner - job.camera.eye) < 0.0)
    };
    !inwards.chain([middle]).any(outside)
}

/// The physical range of a field as it is mapped; `None` if the field is absent.
fn physical_range(job: &Job, kind: FieldKind) -> Option<(f64, f64)> {
    let map = job.flame.maps.get(kind)?;
    let (low, high) = job.volume.grid(&map.grid)?.range();
    Some(map.mapped_range((f64::from(low), f64::from(high))))
}

impl Mend {
    /// What it does, as a button says it.
    pub fn label(&self) -> String {
        match self {
            Self::SootAmount => "Set the soot amount to 1".to_owned(),
            Self::SmokeAmount => "Set the smoke amount to 1".to_owned(),
            Self::Fuel => format!("Burn {}", Fuel::default().name()),
            Self::Field(kind) => format!("Read the {} as the preset does", kind.name()),
            Self::Heat { .. } => format!("Make the hottest voxel {PEAK_K} K"),
            Self::Camera => "Look at the fire".to_owned(),
        }
    }

    /// Changes the settings.
    pub fn apply(&self, project: &mut Project) {
        match *self {
            Self::SootAmount => project.soot.amount = 1.0,
            Self::SmokeAmount => project.smoke.amount = 1.0,
            Self::Fuel => project.fuel.name = Fuel::default(),
            Self::Field(kind) => *project.volume.field_mut(kind) = FieldSettings::default(),
            Self::Heat { scale, offset } => {
                let grid = project.volume.temperature.grid.take();
                project.volume.temperature = FieldSettings {
                    grid,
                    scale: Some(scale),
                    offset: Some(offset),
                    min: Some(AMBIENT_K),
                    max: Some(PEAK_K),
                };
            }
            Self::Camera => {
                project.camera.frame_the_flame();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;

    use super::*;
    use crate::render::develop::Metering;
    use crate::render::{Cancel, render_still};
    use crate::volume::procedural;

    fn is_black(project: &Project) -> (bool, Darkness) {
        let job = project.job(&Arc::new(procedural::torch())).unwrap();
        let still =
            render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap();
        (Metering::of(&still.film).is_black(), Darkness::of(&job))
    }

    #[test]
    fn every_black_picture_is_mended_by_its_button() {
        for (assignments, reason) in [
            (&["soot.amount=0"][..], "amount of soot is 0"),
            (
                &[
                    "soot.amount=0",
                    "fuel.salt=sodium",
                    "camera.eye=[0, -3, 0]",
                    "camera.target=[0, -4, 0]",
                ],
                "looks elsewhere",
            ),
            (&["fuel.name=methanol"], "burns without soot"),
            (
                &[
                    "fuel.name=methanol",
                    "fuel.salt=copper",
                    "fuel.salt_ppm=1e-30",
                ],
                "too faint",
            ),
            (
                &[
                    "soot.amount=0",
                    "fuel.salt=sodium",
                    "volume.temperature.scale=0.4",
                    "volume.temperature.min=0",
                ],
                "no voxel is above 900 K",
            ),
            (&["volume.soot.scale=0"], "no voxel holds soot"),
            (
                &["volume.temperature.scale=0.2", "volume.temperature.min=0"],
                "no voxel is above 700 K",
            ),
            (&["volume.temperature.grid="], "no temperature field"),
            (
                &["camera.eye=[0, -3, 0]", "camera.target=[0, -4, 0]"],
                "looks elsewhere",
            ),
            (&["soot.amount=1e-30"], "too little soot"),
            (
                &[
                    "volume.soot.grid=",
                    "volume.smoke.grid=soot",
                    "smoke.amount=0",
                ],
                "amount of smoke is 0",
            ),
        ] {
            let mut project = Project::default();
            project.render.size = [32, 48];
            project.set_all(assignments.iter().copied()).unwrap();
            let (black, darkness) = is_black(&project);
            assert!(black, "{reason}");
            assert!(darkness.words.contains(reason), "{}", darkness.words);
            darkness.mend.unwrap().apply(&mut project);
            assert!(!is_black(&project).0, "{reason} is not mended");
        }
    }
}
