//! The march against the unbiased reference, on whole pictures.

use sootlight::render::march::Marcher;
use sootlight::render::null_collision::{NullCollision, Params};
use sootlight::render::Plan;
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;

use super::super::common;
use super::z_test::Comparison;

/// Width and height of the pictures.
const SIZE: [u32; 2] = [24, 24];
/// Paths for each pixel.
const SAMPLES: u32 = 1024;

/// XYZ of the march through all pixel centres.
fn marched(scene: &Scene, wavelengths: &Wavelengths, step_voxels: f64) -> Vec<[f64; 3]> {
    let plan = Plan::with_wavelengths(scene, SIZE, wavelengths.clone());
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    let pixels: Vec<[u32; 2]> = (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
        .collect();
    let packets = pixels.chunks(16).flat_map(|packet| {
        let point = |lane: usize| packet.get(lane).map(|p| p.map(|side| f64::from(side) + 0.5));
        let (light, _) = marcher.march(&std::array::from_fn(point));
        light.into_iter().take(packet.len()).collect::<Vec<_>>()
    });
    packets.map(|pixel| pixel.xyz.map(f64::from)).collect()
}

fn agree(name: &str, scene: &Scene) {
    let wavelengths = WavelengthSet::Fitted(8).wavelengths(scene.flame.soot());
    let start = std::time::Instant::now();
    let reference = NullCollision::new(scene, &wavelengths, &Params::default());
    let estimates = reference.render(SIZE, SAMPLES, 1).unwrap();
    println!("{name}: {:?}", start.elapsed());
    for step in [1.0, 0.5, 0.25, 0.125, 0.0625] {
        let c = Comparison::new(&estimates, &marched(scene, &wavelengths, step));
        println!("{name} {step}: {c:?}");
        if step == 0.0625 {
            let m = marched(scene, &wavelengths, step);
            let peak = m.iter().map(|m| m[1]).fold(0.0, f64::max);
            let mut rows: Vec<_> = estimates.iter().zip(&m).enumerate().filter(|(_, (_, m))| m[1] != 0.0).map(|(i, (e, m))| {
                let z = |c: usize| (e.mean[c] - m[c]) / e.variance_of_mean[c].sqrt();
                (z(0), z(1), z(2), i, e.mean, e.variance_of_mean.map(f64::sqrt), m, m[1] / peak)
            }).collect();
            rows.sort_by(|a, b| b.1.abs().max(b.2.abs()).total_cmp(&a.1.abs().max(a.2.abs())));
            for r in rows.iter().take(14) { println!("   {r:?}"); }
        }
    }
}

#[test]
fn the_march_agrees_on_the_torch() {
    agree("torch", &common::torch_scene(1.0));
}

#[test]
fn the_march_agrees_on_the_standard_plume() {
    let Some(shared) = common::shared() else { return };
    let file = shared.join("data/plume/plume.vdb");
    agree("plume", &common::scene_file("plume.toml", &file, SIZE).0);
}
#[test]
fn the_march_agrees_on_a_real_fire() {
    let Some(shared) = common::shared() else { return };
    for f in ["data/campfire/campfire_0022_zip_half.vdb", "data/pool/pool_0022_zip_half.vdb"] {
    let file = shared.join(f);
    let volume = sootlight::volume::open(&[file], &sootlight::volume::Limits::default()).unwrap();
    let mut project = sootlight::project::Project::default();
    project.render.size = SIZE;
    let scene = project.job(&std::sync::Arc::new(volume)).unwrap().scene(None);
    agree(f, &scene);
    }
}
