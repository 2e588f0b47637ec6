//! What a render took and saw, as JSON. Keys are kept: scripts read them.

use serde_json::{Value, json};

use super::accuracy::Accuracy;
use super::json::finite;
use crate::colour::cie::MAX_LUMINOUS_EFFICACY;
use crate::colour::display::Curve;
use crate::project::{Job, Project};
use crate::render::costs::Cost;
use crate::render::develop::{Metering, ViewParams};
use crate::render::{Flaws, Frame};
use crate::scene::stage::Pattern;
use crate::scene::{Scene, WavelengthSet};

/// Wall-clock seconds of each step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seconds {
    pub(super) load: f64,
    pub(super) bake: f64,
    pub(super) render: f64,
    pub(super) write: f64,
}

/// Everything that a render has to tell.
pub(super) struct Stats<'a> {
    pub(super) seconds: Seconds,
    /// Processor time of planning and rendering, seconds.
    pub(super) render_cpu_s: f64,
    pub(super) accuracy: Accuracy,
    pub(super) threads: usize,
    pub(super) project: &'a Project,
    pub(super) job: &'a Job,
    pub(super) scene: &'a Scene,
    pub(super) frame: &'a Frame,
    pub(super) costs: &'a [Cost],
    pub(super) metering: &'a Metering,
    pub(super) view: &'a ViewParams,
    pub(super) flaws: &'a Flaws,
}

impl Stats<'_> {
    /// The document.
    pub(super) fn to_json(&self) -> Value {
        let Seconds {
            load,
            bake,
            render,
            write,
        } = self.seconds;
        let medium = self.scene.flame.medium();
        let (bricks, _) = medium.occupancy();
        json!({
            "seconds": { "load": load, "bake": bake, "render": render, "write": write },
            "cpu_seconds": { "render": finite(self.render_cpu_s) },
            "accuracy": self.accuracy.to_json(),
            "threads": self.threads,
            "rays": self.frame.rays,
            "samples": self.frame.samples,
            "plan": self.plan(),
            "facts": {
                "largest_shift_px": self.frame.facts.largest_shift_px.map(finite),
                "orders_left_out": self.frame.facts.orders_left_out.map(finite),
            },
            "flaws": self.flaws.iter().collect::<Vec<_>>(),
            "settings": self.settings(),
            "fire": self.fire(),
            "air": self.air(),
            "stage": self.stage(),
            // What --scene would read, were it TOML: the same picture again.
            "scene": json!(self.project),
            "exposure": self.exposure(),
            "peak": {
                "luminance_cd_m2": self.peak_luminance(),
                "volume_fraction": finite(f64::from(medium.peak_volume_fraction())),
                "temperature_k": finite(f64::from(medium.peak_temperature_k())),
            },
            "medium": {
                "bricks": bricks,
                "bytes": medium.bytes(),
                "voxel_size_m": finite(medium.voxel_size_m()),
            },
        })
    }

    fn plan(&self) -> Value {
        let decisions = self.frame.decisions.iter().map(|decision| {
            let cost = self.costs.iter().find(|it| it.effect == decision.effect);
            json!({
                "effect": decision.effect.name(),
                "switch": decision.switch,
                "state": if decision.on { "on" } else { "off" },
                "bound_de": decision.bound.map(finite),
                // What it takes of the picture's time, or would take; null where that was not measured to the end.
                "cost_seconds": cost.filter(|it| !it.at_least).map(|it| finite(it.seconds)),
                "reason": decision.reason,
            })
        });
        decisions.collect()
    }

    /// What burns, as it was rendered.
    fn fire(&self) -> Value {
        let flame = &self.job.flame;
        json!({
            "fuel": flame.fuel.name(),
            "soot_follows_fuel": self.job.soot_follows_fuel,
            "soot_times_field": finite(flame.soot_amount),
            "smoke_times_field": finite(flame.smoke_amount),
            "soot_model": flame.soot_model.name(),
            "soot_radius_nm": finite(flame.soot_radius_nm),
            "salt": flame.glow.salt.name(),
            "salt_ppm": finite(flame.glow.salt_ppm),
            "blue_glow": finite(flame.glow.radicals),
            // Null where it is that of spheres of the radius, or nothing is to scatter.
            "asymmetry": flame.scattering.and_then(|it| it.asymmetry).map(finite),
            "smoke_albedo": flame.scattering.map(|it| finite(it.smoke_albedo)),
        })
    }

    /// The air around, and how it is asked to bend light.
    fn air(&self) -> Value {
        let flame = &self.job.flame;
        json!({
            "temperature_k": finite(flame.air.temperature_k),
            "pressure_pa": finite(flame.air.pressure_pa),
            "humidity": finite(flame.air.humidity),
            "saturation": self.project.air.saturation,
            "co2_ppm": finite(flame.air.co2_ppm),
            "refraction_gain": flame.bending.map(|it| finite(it.gain)),
        })
    }

    /// What stands around, with what was not set.
    fn stage(&self) -> Value {
        let stage = &self.job.stage;
        let backdrop = stage.backdrop.as_ref().map(|backdrop| {
            json!({
                "pattern": self.project.stage.backdrop,
                "distance_m": finite(backdrop.distance_m),
                "square_m": match backdrop.pattern {
                    Pattern::Checker { square_m } => finite(square_m),
                    Pattern::Gradient | Pattern::Picture(_) => Value::Null,
                },
                "luminance_cd_m2": finite(backdrop.luminance_cd_m2),
            })
        });
        json!({
            "ground_height_m": stage.ground.map(|ground| finite(ground.height_m)),
            "spheres": stage.spheres.len(),
            "logs": stage.logs.len(),
            "backdrop": backdrop,
        })
    }

    fn settings(&self) -> Value {
        let settings = &self.job.settings;
        json!({
            "size": settings.size,
            "step_voxels": settings.step_voxels,
            "wavelengths": settings.wavelengths.count(),
            "wavelength_set": match settings.wavelengths {
                WavelengthSet::Fitted(_) => "fitted",
                WavelengthSet::Plain(_) => "plain",
            },
            "samples_per_pixel": settings.samples_per_pixel,
            "scattering_orders": settings.scattering_orders,
            "interpolation": self.job.flame.interpolation.name(),
        })
    }

    fn exposure(&self) -> Value {
        let view = self.metering.view(self.view);
        let multiplier = view.exposure;
        json!({
            "relative_ev": self.view.exposure_ev,
            "adaptation": self.view.adaptation,
            "curve": self.view.curve,
            "false_colour": self.view.false_colour,
            "multiplier": finite(multiplier),
            "white_xyz": view.white_xyz.map(finite),
            "white": match (self.view.white_k, self.view.white_xy) {
                (Some(kelvin), _) => json!({ "set_k": kelvin }),
                (None, Some(xy)) => json!({ "set_xy": xy }),
                (None, None) => json!("from the scene"),
            },
            "half_saturation_cd_m2": match self.view.curve {
                Curve::Eye => finite(self.half_saturation_cd_m2()),
                _ => Value::Null,
            },
            "display_white_cd_m2": finite(MAX_LUMINOUS_EFFICACY / multiplier),
            "bright_cd_m2": finite(MAX_LUMINOUS_EFFICACY * self.metering.bright_y),
        })
    }

    fn half_saturation_cd_m2(&self) -> f64 {
        let automatic = self
            .metering
            .with_set(self.view)
            .automatic_half_saturation_cd_m2();
        self.view.half_saturation_cd_m2.unwrap_or(automatic)
    }

    fn peak_luminance(&self) -> Value {
        let luminance = self.frame.film.pixels().iter().map(|pixel| pixel.xyz[1]);
        let peak = luminance.filter(|y| y.is_finite()).fold(0.0, f32::max);
        finite(MAX_LUMINOUS_EFFICACY * f64::from(peak))
    }
}
