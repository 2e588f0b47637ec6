//! The fire's light against the march, closed forms and quadratures.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};

use super::*;
use crate::render::march::Marcher;
use crate::render::preparation::Preparation;
use crate::render::{Cancel, Plan};
use crate::scene::{
    Air, Camera, Flame, FlameParams, Fuel, GlowParams, Interpolation, Placement, WavelengthSet,
};
use crate::volume::{
    Border, FieldMap, FieldMaps, Grid, Limits, Producer, UpAxis, Volume, preset, procedural,
};

mod far;
mod near;

/// A flame of a volume whose fields are physical and in metres.
pub(super) fn flame(volume: Volume) -> Flame {
    let map = |name: &str, max: f64| {
        volume
            .grid(name)
            .map(|_| FieldMap::new(name, 1.0, 0.0, 0.0, max))
    };
    let maps = FieldMaps {
        soot: map("soot", 1.0),
        temperature: map("temperature", 1e4),
        flame: map("flame", 1.0),
        ..FieldMaps::default()
    };
    flame_of(volume, maps, 1.0, GlowParams::default())
}

/// A flame of a volume with its maps and what glows in its gas.
pub(super) fn flame_of(
    volume: Volume,
    maps: FieldMaps,
    metres_per_unit: f64,
    glow: GlowParams,
) -> Flame {
    let params = FlameParams {
        maps,
        placement: Placement {
            up: UpAxis::Z,
            metres_per_unit,
        },
        fuel: Fuel::default(),
        soot_model: crate::physics::soot::SootModel::default(),
        soot_radius_nm: 15.0,
        soot_hold: crate::physics::soot::Hold::default(),
        soot_amount: 1.0,
        smoke_amount: 0.0,
        smoke_left_out: None,
        glow,
        air: Air::default(),
        interpolation: Interpolation::Trilinear,
        scattering: None,
        bending: None,
    };
    Flame::new(&Arc::new(volume), &params, None)
}

pub(super) fn scene(flame: Flame, stage: Stage) -> Scene {
    let camera = Camera {
        eye: DVec3::new(0.0, -3.0, 0.2),
        target: DVec3::new(0.0, 0.0, 0.2),
        up: DVec3::Z,
        fov_deg: 40.0,
        roll_deg: 0.0,
    };
    Scene {
        flame,
        camera,
        stage,
    }
}

/// The built-in torch.
pub(super) fn torch() -> Scene {
    scene(flame(procedural::torch()), Stage::default())
}

/// A shared volume as it opens, if the shared folder is there.
pub(super) fn shared(file: &str) -> Option<Scene> {
    let folder = std::env::var_os("SOOTLIGHT_SHARED")?;
    let path = std::path::Path::new(&folder).join("data").join(file);
    let volume = crate::volume::open(&[path], &Limits::default()).unwrap();
    let preset = preset(Producer::Auto, &volume);
    let flame = flame_of(volume, preset.maps, 1.0, GlowParams::default());
    Some(scene(flame, Stage::default()))
}

/// A cube of `voxels`³ that fills 0 … `edge_m` along each axis, with soot and kelvin at the middles of its voxels in units of
/// its edge; outside is nothing.
pub(super) fn cube(
    voxels: i32,
    edge_m: f64,
    soot: impl Fn(DVec3) -> f64 + Sync,
    kelvin: impl Fn(DVec3) -> f64 + Sync,
) -> Volume {
    let scale = DAffine3::from_scale(DVec3::splat(edge_m / f64::from(voxels)));
    let world = scale * DAffine3::from_translation(DVec3::splat(0.5));
    let grid = |name: &str, value: &(dyn Fn(DVec3) -> f64 + Sync)| {
        let dims = IVec3::splat(voxels);
        Grid::from_fn(name, dims, world, Border::Clamp, 0.0, |voxel| {
            value((voxel.as_dvec3() + 0.5) / f64::from(voxels)) as f32
        })
    };
    Volume::from_grids(
        vec![grid("soot", &soot), grid("temperature", &kelvin)],
        "cube",
    )
}

pub(super) fn plan(scene: &Scene) -> Plan {
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    Plan::with_wavelengths(scene, [256, 256], wavelengths)
}

pub(super) fn light(scene: &Scene, plan: &Plan, level: Level) -> FireLight {
    let work = |watch: &Watch<'_>| FireLight::new(scene, &plan.tables, level, watch);
    Preparation::default()
        .during(&Cancel::never(), work)
        .unwrap()
}

/// Irradiance at each node, then feature.
pub(super) fn irradiance(
    light: &FireLight,
    plan: &Plan,
    stage: &Stage,
    [point, normal]: [DVec3; 2],
) -> Vec<f64> {
    let mut found = vec![0.0; plan.tables.nodes.len() + plan.tables.features.len()];
    light.irradiance(stage, point, normal, &mut found);
    found.into_iter().map(f64::from).collect()
}

/// The same, by marching a ray through every pixel of a picture of 256² that looks along the normal.
pub(super) fn marched_irradiance(
    scene: &Scene,
    plan: &Plan,
    [point, normal]: [DVec3; 2],
    fov_deg: f64,
) -> Vec<f64> {
    let scene = Scene {
        camera: Camera {
            eye: point,
            target: point + normal,
            up: normal.any_orthonormal_vector(),
            fov_deg,
            roll_deg: 0.0,
        },
        ..scene.clone()
    };
    let marcher = Marcher::new(&scene, plan, 0.25).unwrap();
    let [width, height] = plan.tables.size;
    let side = 2.0 * (0.5 * fov_deg).to_radians().tan() / f64::from(height);
    let view = scene.camera.view(plan.tables.size).unwrap();
    let mut sum = vec![0.0; plan.tables.nodes.len() + plan.tables.features.len()];
    for y in 0..height {
        for x in 0..width {
            let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let cosine = view.ray(at[0], at[1]).direction.dot(normal);
            let weight = side * side * cosine.powi(4);
            let radiance = marcher.radiance(at);
            for (sum, radiance) in sum
                .iter_mut()
                .zip(radiance.radiance.iter().chain(&radiance.features))
            {
                *sum += weight * radiance;
            }
        }
    }
    sum
}

/// Largest relative difference of any node's.
pub(super) fn off(ours: &[f64], expected: &[f64]) -> f64 {
    let pairs = ours.iter().zip(expected);
    pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}
