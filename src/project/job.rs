//! From what a person set to what the renderer takes: every check that can fail is made here.

use std::sync::Arc;

use glam::DVec3;

use super::error::ProjectError;
use super::fields::field_maps;
use super::ranges;
use super::settings::{Project, Up};
use crate::render::develop::ViewParams;
use crate::render::{Effects, Flaws, Settings, SettingsError, Switch};
use crate::scene::camera::FRAMING_FOV_DEG;
use crate::scene::{
    Air, Camera, Flame, FlameParams, GlowParams, Placement, Salt, Scene, Stage, flame,
};
use crate::volume::{
    self, About, Assumption, FieldKind, FieldMaps, Preset, Producer, UpAxis, Volume,
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
    /// How accurate.
    pub settings: Settings,
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
}

impl PartialEq for Job {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.volume, &other.volume)
            && self.flame.gives_same_light_as(&other.flame)
            && self.camera == other.camera
            && self.stage == other.stage
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
        self.check_ranges()?;
        let producer = match self.volume.producer {
            Producer::Auto => volume::recognise(volume).producer,
            chosen => chosen,
        };
        let preset = volume::preset(producer, volume);
        let mut flaws = Flaws::default();
        let fields = &self.volume;
        let (maps, proposed) = field_maps(fields, volume, producer, &preset, &mut flaws)?;
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
        let camera = self.camera(volume, &maps, &placement, settings.size);
        camera.view(settings.size)?;
        let glow = self.glow(volume, &maps, &mut flaws);
        let soot_follows_fuel = self.soot_follows_fuel(volume, &preset);
        let soot_yield = if soot_follows_fuel {
            self.fuel.name.row().soot_yield
        } else {
            1.0
        };
        let flame = FlameParams {
            maps,
            placement,
            fuel: self.fuel.name,
            soot_model: self.soot.model,
            soot_radius_nm: self.soot.radius_nm,
            soot_hold: self.soot.hold,
            soot_amount: self.soot.amount * soot_yield,
            smoke_amount: self.smoke.amount,
            glow,
            interpolation: self.render.interpolation,
            air: Air {
                temperature_k: self.air.temperature_k,
                humidity: self.air.humidity,
                co2_ppm: self.air.co2_ppm,
                ..Air::default()
            },
            scattering: None,
            bending: None,
        };
        flame.check(volume)?;
        Ok(Job {
            volume: Arc::clone(volume),
            flame,
            camera,
            stage: Stage::default(),
            settings,
            flaws,
            producer,
            proposed,
            proposed_voxel_m,
            soot_follows_fuel,
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
        let salt_ppm = match self.effects.lines {
            Switch::Off => 0.0,
            Switch::Auto | Switch::On if self.fuel.salt.is_none() => 0.0,
            Switch::Auto | Switch::On => self.fuel.salt_ppm,
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
            radicals,
            by_heat,
            clear_k: clear_k.unwrap_or(0.0),
        }
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
            effects: Effects {
                lines: self.effects.lines,
                chemiluminescence: self.effects.chemiluminescence,
                ..Effects::default()
            },
        }
        .validated()
    }

    /// The view section.
    pub fn view(&self) -> ViewParams {
        ViewParams {
            exposure_ev: self.view.exposure_ev,
            adaptation: self.view.adaptation,
            white_k: self.view.white_k,
            curve: self.view.curve,
            half_saturation_cd_m2: self.view.half_saturation_cd_m2,
            false_colour: self.view.false_colour,
        }
    }

    /// The camera set, with what is not set taken from one that frames the flame.
    fn camera(
        &self,
        volume: &Volume,
        maps: &FieldMaps,
        placement: &Placement,
        size: [u32; 2],
    ) -> Camera {
        let bounds = flame::world_bounds(volume, maps, placement);
        let set = &self.camera;
        let fov_deg = set.fov_deg.unwrap_or(FRAMING_FOV_DEG);
        let framing = Camera::framing(&bounds, f64::from(size[0]) / f64::from(size[1]), fov_deg);
        Camera {
            eye: set.eye.unwrap_or(framing.eye),
            target: set.target.unwrap_or(framing.target),
            up: set.up.unwrap_or(DVec3::Z),
            fov_deg,
        }
    }

    /// Checks every number that can be judged without a volume.
    ///
    /// # Errors
    /// [`ProjectError`] names the key, its value and its range.
    pub fn check(&self) -> Result<(), ProjectError> {
        self.check_ranges()?;
        self.settings(self.render.size)?;
        Ok(())
    }

    fn check_ranges(&self) -> Result<(), ProjectError> {
        let numbers = [
            (
                "soot.radius_nm",
                self.soot.radius_nm,
                ranges::SOOT_RADIUS_NM,
            ),
            ("soot.amount", self.soot.amount, ranges::AMOUNT),
            ("smoke.amount", self.smoke.amount, ranges::AMOUNT),
            ("fuel.salt_ppm", self.fuel.salt_ppm, ranges::SALT_PPM),
            ("fuel.blue_glow", self.fuel.blue_glow, ranges::AMOUNT),
            (
                "air.temperature_k",
                self.air.temperature_k,
                ranges::AIR_TEMPERATURE_K,
            ),
            ("air.humidity", self.air.humidity, ranges::HUMIDITY),
            ("air.co2_ppm", self.air.co2_ppm, ranges::CO2_PPM),
            (
                "camera.fov_deg",
                self.camera.fov_deg.unwrap_or(FRAMING_FOV_DEG),
                ranges::FOV_DEG,
            ),
            (
                "view.exposure_ev",
                self.view.exposure_ev,
                ranges::EXPOSURE_EV,
            ),
            ("view.adaptation", self.view.adaptation, ranges::ADAPTATION),
            (
                "view.white_k",
                self.view.white_k.unwrap_or(ranges::WHITE_K[0]),
                ranges::WHITE_K,
            ),
            (
                "view.half_saturation_cd_m2",
                self.view.half_saturation_cd_m2.unwrap_or(1.0),
                ranges::HALF_SATURATION_CD_M2,
            ),
            (
                "volume.voxel_size_m",
                self.volume.voxel_size_m.unwrap_or(1.0),
                ranges::VOXEL_SIZE_M,
            ),
        ];
        match numbers
            .into_iter()
            .find(|(_, value, [min, max])| !(*min..=*max).contains(value))
        {
            Some((key, value, [min, max])) => Err(ProjectError::Range {
                key,
                value,
                min,
                max,
            }),
            None => Ok(()),
        }
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
