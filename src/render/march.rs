//! From points of a picture to light on the film.
//!
//! # What is computed
//!
//! The equation of transfer, dL/ds = −σ_t L + σ_a B(λ, T) + σ_s J, from the eye outwards. A ray's chord through the
//! domain is cut into steps of equal length, the last one shorter; a step takes the medium at its middle and adds, for
//! each wavelength,
//!
//! ```text
//! L += t (σ_a B(λ, T) + σ_s J) Δs φ₁(τ),   t *= e^{−τ},   τ = σ_t Δs,   φ₁(τ) = (1 − e^{−τ})/τ
//! ```
//!
//! which is exact for a constant step and of second order otherwise (Max 1995, with the sign that the report's
//! eq. 4.1 misprints). B / n² is what is conserved along a ray, so the medium's index drops out. What gas adds beside
//! soot is in `glow`; J, the light that comes from all sides and is scattered towards the eye, in `scatter`. A surface
//! that the ray ends at sends back what `irradiance` says falls on it; a backdrop shines by itself. Both are seen
//! through what is in front of them.
//!
//! How sixteen rays go side by side is in `kernel`, where they go in `way`.

use crate::colour::reflectance::Reflectance;
use crate::math::lanes::{LANES, Lanes};
use crate::scene::Scene;
use crate::scene::camera::{CameraError, View};

use super::chord::{Bricks, Chord};
use super::cover::Cover;
use super::fields::Fields;
use super::film::Pixel;
use super::kernel::{Light, March};
use super::plan::Plan;
use super::spans::Packet;
use super::tables::Tables;
use super::way::{End, Way, Ways};
use crate::scene::stage::Hit;

/// Where a ray may meet something of which nothing is known.
const EVERYWHERE: Option<[f64; 2]> = Some([0.0, f64::INFINITY]);

/// Marches packets of rays for one scene, plan and step.
pub struct Marcher<'a> {
    view: View,
    scene: &'a Scene,
    tables: &'a Tables,
    fields: &'a Fields,
    ways: Ways<'a>,
    /// Where rays may meet anything, where that is worth knowing.
    cover: Option<Cover>,
}

/// The light of one ray.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Spectral radiance at each of the plan's nodes, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: Vec<f64>,
    /// Radiance of each feature of the gas, W m⁻² sr⁻¹.
    pub features: Vec<f64>,
    /// X, Y, Z of the backdrop behind, W m⁻² sr⁻¹, whose spectrum is not kept.
    pub backdrop: [f64; 3],
}

impl<'a> Marcher<'a> {
    /// Prepares a march with steps of `step_voxels`, with the plan's fields worked out finely.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn new(scene: &'a Scene, plan: &'a Plan, step_voxels: f64) -> Result<Self, CameraError> {
        Self::with_fields(scene, plan, plan.fine_fields(scene), step_voxels)
    }

    /// Prepares a march with fields that were worked out for the same scene and plan.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn with_fields(
        scene: &'a Scene,
        plan: &'a Plan,
        fields: &'a Fields,
        step_voxels: f64,
    ) -> Result<Self, CameraError> {
        let medium = scene.flame.medium();
        let size = plan.tables.size;
        let backdrop = scene.stage.backdrop.as_ref();
        Ok(Self {
            view: scene.camera.view(size)?,
            scene,
            tables: &plan.tables,
            fields,
            ways: Ways {
                bricks: Bricks::new(medium, !plan.tables.features.is_empty()),
                stage: &scene.stage,
                screen: backdrop
                    .map(|backdrop| backdrop.facing(&scene.camera, size))
                    .transpose()?,
                bent: fields.bent.as_deref(),
                step_m: step_voxels * medium.voxel_size_m(),
            },
            cover: None,
        })
    }

    /// The same for a whole picture: works out in the calling thread's rayon pool which of its rays meet anything, a tenth
    /// of a millisecond for a thousand bricks. The light of a ray stays the same to the last bit.
    #[must_use]
    pub fn for_a_picture(mut self) -> Self {
        // Bent rays leave the lines along which bricks are seen.
        self.cover = self
            .ways
            .bent
            .is_none()
            .then(|| Cover::new(self.ways.bricks, &self.view, self.tables.size));
        self
    }

    /// Follows the rays through the given points of the picture (pixels from the upper left corner). Returns
    /// what they leave on the film and how many samples of the medium were taken.
    pub fn march(&self, points: &[Option<[f64; 2]>; LANES]) -> ([Pixel; LANES], u64) {
        let mut pixels = [Pixel::default(); LANES];
        let ranges = points.map(|point| {
            self.cover
                .as_ref()
                .map_or(EVERYWHERE, |cover| cover.range(point?))
        });
        if ranges.iter().all(Option::is_none) && self.ways.is_dark_behind() {
            return (pixels, 0);
        }
        let ways: [Option<Way>; LANES] = std::array::from_fn(|lane| {
            points[lane].map(|[x, y]| self.ways.of(&self.view.ray(x, y), ranges[lane]))
        });
        let Some(light) = self.follow(&ways) else {
            return (pixels, 0);
        };
        for (lane, (pixel, way)) in pixels.iter_mut().zip(&ways).enumerate() {
            if let Some(way) = way {
                *pixel = self.pixel(&light, lane, &way.end);
            }
        }
        (pixels, light.samples)
    }

    /// The spectrum becomes three numbers here, in f64: the fitted weights have both signs.
    fn pixel(&self, light: &Light, lane: usize, end: &End) -> Pixel {
        let Tables {
            nodes,
            glow,
            wavelengths,
            ..
        } = self.tables;
        let lane_of = |light: &Lanes| f64::from(light[lane]);
        let soot = wavelengths.xyz_of(light.radiance[..nodes.len()].iter().map(lane_of));
        let gas = glow.xyz_of(light.glow.iter().map(lane_of));
        let mut xyz: [f64; 3] = std::array::from_fn(|c| soot[c] + gas[c]);
        let [column, smoke] = [&light.column_m, &light.smoke_m].map(lane_of);
        let mut opacity = wavelengths.opacity_of(nodes.iter().map(|node| {
            let [all, more] = node.extinction().map(f64::from);
            -(-(all * column + more * smoke)).exp_m1()
        }));
        match end {
            End::Dark => {}
            End::Surface(hit) => {
                let [radiance, features] = self.surface(hit, [column, smoke]);
                let [soot, gas] = [
                    wavelengths.xyz_of(radiance),
                    glow.xyz_of(features.into_iter()),
                ];
                xyz = std::array::from_fn(|c| xyz[c] + soot[c] + gas[c]);
                opacity = self.tables.opaque;
            }
            End::Screen(screen) => {
                let through = self.tables.through(opacity);
                xyz = std::array::from_fn(|c| xyz[c] + screen[c] * through[c]);
                opacity = self.tables.opaque;
            }
        }
        Pixel {
            xyz: xyz.map(|v| v as f32),
            opacity: opacity.map(|v| v as f32),
        }
    }

    /// What a surface sends through columns of soot and smoke (m): at each node, and of each feature.
    fn surface(&self, hit: &Hit, [column, smoke]: [f64; 2]) -> [Vec<f64>; 2] {
        let tables = self.tables;
        let mut falls = vec![0.0; tables.channels()];
        if let Some(fire) = &self.fields.fire_light {
            fire.irradiance(&self.scene.stage, hit.point, hit.normal, &mut falls);
        }
        let (at_nodes, of_features) = falls.split_at(tables.nodes.len());
        // A matt surface sends what falls on it evenly into the half space: L = ρ E/π.
        let reflectance = Reflectance::of(hit.colour);
        let sent =
            |falls: f32, nm: f64| reflectance.at(nm) * f64::from(falls) / std::f64::consts::PI;
        let nodes = tables.nodes.iter().zip(&tables.wavelengths.nodes_nm);
        let radiance = nodes.zip(at_nodes).map(|((node, &nm), &falls)| {
            let [all, more] = node.extinction().map(f64::from);
            sent(falls, nm) * (-(all * column + more * smoke)).exp()
        });
        let through = tables.glow.transmittances(column, smoke);
        let features = tables.features.iter().zip(of_features).zip(through);
        let features =
            features.map(|((feature, &falls), through)| sent(falls, feature.lambda_nm) * through);
        [radiance.collect(), features.collect()]
    }

    /// The samples that the ray through a point of the picture takes of the medium: where the part of its way that each stands
    /// for begins and ends, m from where it enters the medium's box. Between them there is nothing.
    pub fn samples_of(&self, point: [f64; 2]) -> Vec<[f64; 2]> {
        let way = self.ways.of(&self.view.ray(point[0], point[1]), EVERYWHERE);
        let whole_m = self.ways.step_m;
        let samples = way.chord.iter().flat_map(Chord::samples);
        samples.map(|part| part.map(|at| at * whole_m)).collect()
    }

    /// Follows the ray through one point of the picture and keeps its spectrum.
    pub fn radiance(&self, point: [f64; 2]) -> Seen {
        let counts = [self.tables.nodes.len(), self.tables.features.len()];
        let [mut radiance, mut features] = counts.map(|count| vec![0.0; count]);
        let mut backdrop = [0.0; 3];
        let mut ways: [Option<Way>; LANES] = std::array::from_fn(|_| None);
        ways[0] = Some(self.ways.of(&self.view.ray(point[0], point[1]), EVERYWHERE));
        if let (Some(light), Some(way)) = (self.follow(&ways), &ways[0]) {
            let lane = |light: &Lanes| f64::from(light[0]);
            radiance = light.radiance.iter().take(counts[0]).map(lane).collect();
            features = light.glow.iter().take(counts[1]).map(lane).collect();
            match way.end {
                End::Dark => {}
                End::Surface(hit) => {
                    let columns = [&light.column_m, &light.smoke_m].map(lane);
                    let sent = self.surface(&hit, columns);
                    for (seen, sent) in [&mut radiance, &mut features].into_iter().zip(sent) {
                        seen.iter_mut()
                            .zip(sent)
                            .for_each(|(seen, sent)| *seen += sent);
                    }
                }
                // The soot's own light is no part of what is behind it.
                End::Screen(screen) => {
                    let Pixel { opacity, .. } = self.pixel(&light, 0, &End::Dark);
                    let through = self.tables.through(opacity.map(f64::from));
                    backdrop = std::array::from_fn(|c| screen[c] * through[c]);
                }
            }
        }
        Seen {
            radiance,
            features,
            backdrop,
        }
    }

    /// What the rays of these ways bring home; `None` if none of them meets anything.
    fn follow(&self, ways: &[Option<Way>; LANES]) -> Option<Light> {
        let chords = std::array::from_fn(|lane| ways[lane].as_ref()?.chord.as_ref());
        if chords.iter().all(Option::is_none) {
            let is_dark = |way: &Way| matches!(way.end, End::Dark);
            let is_nothing = ways.iter().flatten().all(is_dark);
            return (!is_nothing).then(|| Light::none(self.tables.nodes.len()));
        }
        Some(self.loop_over(chords).run())
    }

    fn loop_over<'c>(&'c self, chords: [Option<&'c Chord>; LANES]) -> March<'c> {
        March {
            medium: self.ways.bricks.medium,
            tables: self.tables,
            scatter: self.fields.scatter.as_deref(),
            step_m: self.ways.step_m as f32,
            packet: Packet::new(chords),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;

    use super::*;
    use crate::project::Project;
    use crate::volume::procedural;

    #[test]
    fn every_processor_renders_the_same_picture() {
        let volume = Arc::new(procedural::torch());
        let mut compared = 0;
        for effects in [
            &["effects.scattering=off", "effects.refraction=off"][..],
            &[
                "effects.scattering=on",
                "fuel.salt=copper-chloride",
                "effects.lines=on",
            ],
            &[
                "effects.refraction=on",
                "effects.chemiluminescence=on",
                "volume.flame.grid=soot",
            ],
        ] {
            let mut project = Project::default();
            project.set("render.size=[24, 24]").unwrap();
            project.set_all(effects.iter().copied()).unwrap();
            let job = project.job(&volume).unwrap();
            let scene = job.scene(None);
            let plan = Plan::new(&scene, &job.settings);
            let marcher = Marcher::new(&scene, &plan, 1.0).unwrap();
            let mut pairs = Vec::new();
            for row in 0..24 {
                // Of sixteen rays in a row, on both sides of the flame's middle.
                let ways: [Option<Way>; LANES] = std::array::from_fn(|lane| {
                    let point = [4.0 + lane as f64, f64::from(row) + 0.5];
                    let ray = marcher.view.ray(point[0], point[1]);
                    Some(marcher.ways.of(&ray, EVERYWHERE))
                });
                let chords = std::array::from_fn(|lane| ways[lane].as_ref()?.chord.as_ref());
                let here = marcher.loop_over(chords).run();
                let anywhere = marcher.loop_over(chords).run_anywhere();
                assert_eq!(here.samples, anywhere.samples);
                let soot = here.radiance.iter().zip(&anywhere.radiance);
                let lights = soot.chain(here.glow.iter().zip(&anywhere.glow));
                pairs.extend(lights.map(|(here, anywhere)| (*here, *anywhere)));
            }
            let channels = pairs.len() / 24;
            for channel in 0..channels {
                let pairs = pairs.iter().skip(channel).step_by(channels);
                let pairs = pairs.flat_map(|(here, anywhere)| here.iter().zip(anywhere));
                let brightest = pairs.clone().fold(0.0_f32, |most, (_, it)| most.max(*it));
                // Of what is nearly dark, Planck's exponential makes much of the last bit of a temperature.
                for (here, anywhere) in pairs.filter(|(_, it)| **it > 0.0) {
                    let off = (here - anywhere).abs();
                    let few = 1e-5 * anywhere + 2e-8 * brightest;
                    assert!(off <= few, "{here} {anywhere} of {brightest}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 1000, "{compared}");
    }
}
