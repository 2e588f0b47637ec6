//! From what a person set to what the renderer takes: every check that can fail is made here.

use std::sync::Arc;

use glam::DVec3;

use super::accuracy::Accuracy;
use super::backdrops::Backdrops;
use super::error::ProjectError;
use super::fields::field_maps;
use super::settings::{Project, SmokeSettings, Up};
use super::stage::StageDefaults;
use crate::math::Aabb;
use crate::render::develop::ViewParams;
use crate::render::plan::{OFF_BELOW, smoke_bound};
use crate::render::{Effects, Flaws, Settings, SettingsError, Switch};
use crate::scene::camera::FRAMING_FOV_DEG;
use crate::scene::stage::Pattern;
use crate::scene::{
    Air, Bending, Camera, Flame, FlameParams, GlowParams, Placement, Salt, ScatteringParams, Scene,
    Stage, flame,
};
use crate::volume::{
    self, About, Assumption, FieldKind, FieldMap, FieldMaps, Preset, Producer, UpAxis, Volume,
};

/// A picture to be made, cheap to clone. Jobs are equal if they give the same picture, bit for bit: so the window
/// renders only what changed, and a parameter that no computed effect looks at makes no difference.
#[derive(Debug, Clone)]
pub struct Job {
    /// The open volume.
    pub volume: Arc<Volume>,
    /// What its fields mean and how its soot behaves.
    pub flame: FlameParams,
    /// The eye.
    pub camera: Camera,
    /// What stands around.
    pub stage: Stage,
    /// How accurate: what is not set by hand is as for a scene that nobody has looked at.
    pub settings: Settings,
    /// How accurate it is wished, and which of the numbers are to be chosen for that.
    pub accuracy: Accuracy,
    /// What is assumed or cannot be faithful, known before a ray is marched.
    pub flaws: Flaws,
    /// Whose conventions the fields follow here.
    pub producer: Producer,
    /// How the fields would be made with the same grids, had no number been set by hand.
    pub proposed: FieldMaps,
    /// Edge of a voxel that was not set by hand, m.
    pub proposed_voxel_m: f64,
    /// Whether the amount of soot is the fuel's, because the volume does not say it.
    pub soot_follows_fuel: bool,
    /// What the stage takes where nothing is set.
    pub stage_defaults: StageDefaults,
}

impl PartialEq for Job {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.volume, &other.volume)
            && self.flame.gives_same_light_as(&other.flame)
            && self.camera == other.camera
            && is_same_stage(&self.stage, &other.stage)
            && self.settings == other.settings
    }
}

impl Job {
    /// Packs the medium and bakes the laws; takes over from `before` what is the same.
    pub fn scene(&self, before: Option<&Scene>) -> Scene {
        let flame = Flame::new(
            &self.volume,
            &self.flame,
            before.map(|before| &before.flame),
        );
        Scene {
            flame,
            camera: self.camera,
            stage: self.stage.clone(),
        }
    }
}

impl Project {
    /// The picture that this project asks for, of the given volume.
    ///
    /// # Errors
    /// [`ProjectError`] names the key, its value and what would be right.
    pub fn job(&self, volume: &Arc<Volume>) -> Result<Job, ProjectError> {
        self.job_keeping(volume, &mut Backdrops::default())
    }

    /// [`Project::job`], whose backdrop's picture is kept for the next one.
    ///
    /// # Errors
    /// As [`Project::job`].
    pub fn job_keeping(
        &self,
        volume: &Arc<Volume>,
        backdrops: &mut Backdrops,
    ) -> Result<Job, ProjectError> {
        self.check_ranges()?;
        let producer = match self.volume.producer {
            Producer::Auto => volume::recognise(volume).producer,
            chosen => chosen,
        };
        let preset = volume::preset(producer, volume);
        let mut flaws = Flaws::default();
        let fields = &self.volume;
        let (maps, proposed) = field_maps(fields, volume, producer, &preset, &mut flaws)?;
        if let Some(name) = volume.lacks(&self.wanted()) {
            flaws.add(format!(
                "{name} was not read from the file: the picture is without it"
            ));
        }
        let up = match fields.up {
            Up::Auto => preset.up,
            Up::Y => UpAxis::Y,
            Up::Z => UpAxis::Z,
        };
        let file_voxel = file_voxel_size(volume, &maps);
        let proposed_voxel_m = preset.voxel_size_m.unwrap_or(file_voxel);
        let metres_per_unit = fields
            .voxel_size_m
            .or(preset.voxel_size_m)
            .map_or(1.0, |wanted| wanted / file_voxel);
        let placement = Placement {
            up,
            metres_per_unit,
        };
        let settings = self.settings(self.render.size)?;
        let bounds = flame::world_bounds(volume, &maps, &placement);
        let camera = self.camera(&bounds, settings.size);
        camera.view(settings.size)?;
        let stage_defaults = self.stage.defaults(&bounds, &camera);
        let stage = self.stage.stage(&stage_defaults, backdrops)?;
        let glow = self.glow(volume, &maps, &mut flaws);
        let soot_follows_fuel = self.soot_follows_fuel(volume, &preset);
        let soot_yield = if soot_follows_fuel {
            self.fuel.name.row().soot_yield
        } else {
            1.0
        };
        let air = Air::from(&self.air);
        let mut bending = self.bending(&mut flaws);
        // Where nothing but the fire itself shows it, bent light is not worth an error.
        let is_needed = self.effects.refraction == Switch::On || stage.shows_behind();
        if bending.is_some()
            && let Err(error) = air.gas(self.fuel.name)
        {
            if is_needed {
                return Err(error.into());
            }
            flaws.add(format!("light is not bent: {error}"));
            bending = None;
        }
        let mut flame = FlameParams {
            scattering: self.scattering(&maps),
            bending,
            maps,
            placement,
            fuel: self.fuel.name,
            soot_model: self.soot.model,
            soot_radius_nm: self.soot.radius_nm,
            soot_hold: self.soot.hold,
            soot_amount: self.soot.amount * soot_yield,
            smoke_amount: self.smoke.amount,
            smoke_left_out: None,
            glow,
            interpolation: self.render.interpolation,
            air,
        };
        flame.smoke_left_out = self.smoke_left_out(volume, &flame);
        if let Err(error) = flame.check(volume) {
            if is_needed || flame.bending.is_none() {
                return Err(error.into());
            }
            flame.bending = None;
            flame.check(volume)?;
            flaws.add(format!("light is not bent: {error}"));
        }
        Ok(Job {
            volume: Arc::clone(volume),
            flame,
            camera,
            stage,
            settings,
            accuracy: self.accuracy(),
            flaws,
            producer,
            proposed,
            proposed_voxel_m,
            soot_follows_fuel,
            stage_defaults,
        })
    }

    /// What is to glow in the gas beside soot.
    fn glow(&self, volume: &Volume, maps: &FieldMaps, flaws: &mut Flaws) -> GlowParams {
        // Where nothing says what burns, nothing is made up unless it is asked for.
        let by_heat = self.effects.chemiluminescence == Switch::On;
        let radicals = match self.effects.chemiluminescence {
            Switch::Off => 0.0,
            Switch::Auto | Switch::On => self.fuel.blue_glow,
        };
        if by_heat && radicals > 0.0 && maps.flame.is_none() {
            flaws.add(
                "no flame field: the blue glow is put where the gas is hotter than 1600 K, as if it burnt there",
            );
        }
        let [lines, bands] =
            [self.effects.lines, self.effects.bands].map(|switch| switch != Switch::Off);
        let salt_ppm = if self.fuel.salt.is_none() || !(lines || bands) {
            0.0
        } else {
            self.fuel.salt_ppm
        };
        let clear_k = maps.temperature.as_ref().and_then(|map| {
            let grid = volume.grid(&map.grid)?;
            Some(map.apply(f64::from(grid.background())))
        });
        GlowParams {
            salt: if salt_ppm > 0.0 {
                self.fuel.salt
            } else {
                Salt::default()
            },
            salt_ppm,
            lines,
            bands,
            radicals,
            by_heat,
            clear_k: clear_k.unwrap_or(0.0),
        }
    }

    /// How soot and smoke are to scatter.
    fn scattering(&self, maps: &FieldMaps) -> Option<ScatteringParams> {
        (self.effects.scattering != Switch::Off).then(|| ScatteringParams {
            asymmetry: self.soot.asymmetry,
            // Of smoke that is not there nothing makes a difference.
            smoke_albedo: if maps.smoke.is_some() && self.smoke.amount > 0.0 {
                self.smoke.albedo
            } else {
                SmokeSettings::default().albedo
            },
        })
    }

    /// What smoke that is not worth packing would change at most, ΔE_ITP; `None` where it is to be packed, or there is none.
    fn smoke_left_out(&self, volume: &Volume, flame: &FlameParams) -> Option<f64> {
        let smoke = flame.maps.smoke.as_ref()?;
        if flame.smoke_amount <= 0.0 {
            return None;
        }
        match self.effects.smoke {
            Switch::Off => return Some(0.0),
            Switch::On => return None,
            Switch::Auto => {}
        }
        let most = |map: &FieldMap, amount: f64| {
            let grid = volume.grid(&map.grid)?;
            let (low, high) = grid.range();
            let (low, high) = map.mapped_range((f64::from(low), f64::from(high)));
            Some(amount * low.abs().max(high.abs()))
        };
        let smoke = most(smoke, flame.smoke_amount)?;
        let soot = flame.maps.soot.as_ref();
        let soot = soot.and_then(|map| most(map, flame.soot_amount))?;
        let bounds = flame::world_bounds(volume, &flame.maps, &flame.placement);
        let bound = smoke_bound(smoke, soot, flame, bounds.size().length());
        (bound < OFF_BELOW).then_some(bound)
    }

    /// How hot gas is to bend light, unless that is switched off.
    fn bending(&self, flaws: &mut Flaws) -> Option<Bending> {
        let computed = self.effects.refraction != Switch::Off;
        let gain = self.air.refraction_gain;
        if computed && gain > 1.0 {
            flaws.add(format!("refraction is exaggerated {gain} times"));
        }
        computed.then_some(Bending {
            gain,
            dispersion: self.effects.dispersion == Switch::On,
        })
    }

    /// Whether the fuel says how much soot there is: the volume does not, and nobody else did.
    fn soot_follows_fuel(&self, volume: &Volume, preset: &Preset) -> bool {
        let is_about_soot =
            |assumption: &Assumption| assumption.about == About::Field(FieldKind::Soot);
        let assumed = preset.assumptions.iter().any(is_about_soot);
        (assumed || volume.built_in.is_some()) && self.volume.soot.is_unset()
    }

    /// The render section as concrete numbers, for a picture of the given size.
    ///
    /// # Errors
    /// A number is outside its range.
    pub fn settings(&self, size: [u32; 2]) -> Result<Settings, SettingsError> {
        let (step_voxels, wavelengths, samples_per_pixel) = self.render.quality.numbers();
        Settings {
            size,
            step_voxels: self.render.step_voxels.unwrap_or(step_voxels),
            wavelengths: self.render.wavelengths.unwrap_or(wavelengths),
            samples_per_pixel: self.render.samples_per_pixel.unwrap_or(samples_per_pixel),
            scattering_orders: self.render.scattering_orders,
            effects: Effects {
                // A number that was set by hand stays.
                wavelengths: if self.render.wavelengths.is_some() {
                    Switch::Off
                } else {
                    self.effects.wavelengths
                },
                ..self.effects
            },
        }
        .validated()
    }

    /// The view section.
    pub fn view(&self) -> ViewParams {
        self.view.params()
    }

    /// The camera set, with what is not set taken from one that frames a flame's box in a picture of this size.
    pub fn camera(&self, bounds: &Aabb, size: [u32; 2]) -> Camera {
        let set = &self.camera;
        let fov_deg = set.fov_deg.unwrap_or(FRAMING_FOV_DEG);
        let framing = Camera::framing(bounds, f64::from(size[0]) / f64::from(size[1]), fov_deg);
        Camera {
            eye: set.eye.unwrap_or(framing.eye),
            target: set.target.unwrap_or(framing.target),
            up: set.up.unwrap_or(DVec3::Z),
            fov_deg,
            roll_deg: set.roll_deg.unwrap_or(0.0),
        }
    }
}

/// Whether two stages look alike. A picture that is the same one is not compared pixel by pixel.
fn is_same_stage(one: &Stage, other: &Stage) -> bool {
    let picture = |stage: &Stage| match &stage.backdrop.as_ref()?.pattern {
        Pattern::Picture(picture) => Some(Arc::clone(picture)),
        Pattern::Checker { .. } | Pattern::Gradient => None,
    };
    match (picture(one), picture(other)) {
        (Some(a), Some(b)) if Arc::ptr_eq(&a, &b) => {
            let without = |stage: &Stage| {
                let mut stage = stage.clone();
                if let Some(backdrop) = &mut stage.backdrop {
                    backdrop.pattern = Pattern::Gradient;
                }
                stage
            };
            without(one) == without(other)
        }
        _ => one == other,
    }
}

/// Edge of a voxel in the file's own units: the soot's, or the smoke's where there is no soot.
fn file_voxel_size(volume: &Volume, maps: &FieldMaps) -> f64 {
    [&maps.soot, &maps.smoke]
        .into_iter()
        .flatten()
        .find_map(|map| volume.grid(&map.grid))
        .map_or(1.0, |grid| {
            grid.world_from_index().matrix3.determinant().abs().cbrt()
        })
}

#[cfg(test)]
mod tests;
