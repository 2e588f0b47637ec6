//! The march's own error against the same sum in double precision, over the files of real fires.

use std::sync::Arc;

use sootlight::project::{Job, Project};
use sootlight::render::march::Marcher;
use sootlight::render::{Cancel, Plan, render_still};
use sootlight::scene::WavelengthSet;
use sootlight::volume::{self, Limits};

use super::{march_f64, settings};
use crate::common;

/// Largest error that the march may have for itself, of a pixel's own light.
const MOST: f64 = 2e-5;
/// Side of the pictures, pixels.
const SIDE: u32 = 20;
/// Pixels darker than this share of the brightest are held to that share: nobody sees them.
const FLOOR: f64 = 1e-6;

/// The largest error over a picture of 32 wavelengths.
fn worst(job: &Job, step_voxels: f64) -> f64 {
    let scene = job.scene(None);
    let settings = settings(SIDE, step_voxels, WavelengthSet::Plain(32));
    let plan = Plan::new(&scene, &settings);
    let frame = render_still(&scene, &settings, &Cancel::never(), &|_| {}).unwrap();
    let view = scene.camera.view(settings.size).unwrap();
    let marcher = Marcher::new(&scene, &plan, step_voxels).unwrap();
    let pixels = frame.film.pixels();
    let peak = pixels.iter().fold(0.0, |peak, it| it.xyz[1].max(peak));
    assert!(peak > 0.0, "a black picture");
    let mut worst = 0.0_f64;
    for (i, pixel) in (0..).zip(pixels) {
        let point = [i % SIDE, i / SIDE].map(|at| f64::from(at) + 0.5);
        let ray = view.ray(point[0], point[1]);
        let samples = marcher.samples_of(point);
        let exact = march_f64(
            &scene,
            &ray,
            &samples,
            step_voxels,
            &plan.tables.wavelengths,
        );
        let scale = exact[1].max(FLOOR * f64::from(peak));
        for (ours, exact) in pixel.xyz.iter().zip(exact) {
            worst = worst.max((f64::from(*ours) - exact).abs() / scale);
        }
    }
    worst
}

#[test]
fn the_marchs_own_error_over_all_shared_fires_is_within_two_in_a_hundred_thousand() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    let mut files = Vec::new();
    for folder in std::fs::read_dir(&data).unwrap() {
        let folder = folder.unwrap().path();
        let entries = std::fs::read_dir(&folder).into_iter().flatten();
        files.extend(entries.map(|entry| entry.unwrap().path()));
    }
    files.retain(|path| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| ["vdb", "txt", "bin"].contains(&ending))
    });
    files.sort();
    assert!(files.len() > 25, "{} files", files.len());
    let mut project = Project::default();
    let sets = ["effects.chemiluminescence=off", "effects.refraction=off"];
    project.set_all(sets).unwrap();
    project.render.size = [SIDE; 2];
    let mut largest = 0.0_f64;
    for path in files {
        let volume = volume::open(std::slice::from_ref(&path), &Limits::default()).unwrap();
        let job = project.job(&Arc::new(volume)).unwrap();
        let worst = worst(&job, 0.5);
        assert!(worst < MOST, "{}: {worst:.1e}", path.display());
        largest = largest.max(worst);
    }
    println!("f32 against f64 over the shared fires: {largest:.1e}");
}
