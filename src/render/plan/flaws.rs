//! What a plan cannot show faithfully.

use super::Plan;
use crate::render::Settings;
use crate::render::orders::scattering_depth;
use crate::render::tables::Tables;
use crate::scene::Scene;

/// Scattering depth from which on it is said that path-traced light is noisy: few paths come to where it is bright.
const DEEP_SMOKE: f64 = 20.0;

/// Mean free paths in a voxel from which on it is said that light from all sides is known too coarsely: half of it is
/// scattered within.
const DEEP_VOXEL: f64 = 0.7;

/// Optical depth of a step from which on the picture's error is said: the midpoint rule is off by about τ²/24 of a
/// step's light, here 1 %.
const THICK_STEP: f64 = 0.5;

/// Adds the flaws of a scene at its settings to its plan's.
pub(super) fn add(plan: &mut Plan, scene: &Scene, settings: &Settings) {
    if plan.wanted.scatter {
        let depth = scattering_depth(scene, &plan.tables);
        if plan.orders > 1 && depth > DEEP_SMOKE {
            plan.flaws.add(format!(
                "a straight way through the fire is up to {depth:.0} mean free paths between scatterings long: what is \
                 scattered more than once is noisy here. More rays for each pixel make it smoother"
            ));
        }
        let of_voxel = voxel_depth(scene, &plan.tables);
        if of_voxel > DEEP_VOXEL {
            plan.flaws.add(format!(
                "a voxel is up to {of_voxel:.1} mean free paths deep: scattered light is known for whole voxels, and gets too \
                 far there"
            ));
        }
    }
    let medium = scene.flame.medium();
    let densest = plan
        .tables
        .nodes
        .iter()
        .map(|node| f64::from(node.absorption))
        .fold(0.0, f64::max);
    let step_m = settings.step_voxels * medium.voxel_size_m();
    let thickest = densest * f64::from(medium.peak_volume_fraction()) * step_m;
    if thickest > THICK_STEP {
        plan.flaws.add(format!(
            "the soot is so dense that a step of {} × a voxel's edge is up to {thickest:.1} optical depths thick: take \
             smaller steps, or less soot",
            settings.step_voxels
        ));
    }
    if plan.wanted.scatter && plan.tables.features.iter().any(|it| !it.is_radical()) {
        plan.flaws
            .add("the light of the salt is dimmed by scattering, but is not seen scattered");
    }
}

/// Mean free paths between scatterings across a voxel of the densest sample.
fn voxel_depth(scene: &Scene, tables: &Tables) -> f64 {
    let medium = scene.flame.medium();
    let most = tables.nodes.iter().flat_map(|node| node.scattering);
    let most = f64::from(most.fold(0.0, f32::max));
    most * f64::from(medium.peak_volume_fraction()) * medium.voxel_size_m()
}
