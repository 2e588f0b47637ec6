//! How right the time is that a picture says it has to go, measured on shared fires, in a window and for a file:
//!
//! ```sh
//! SOOTLIGHT_SHARED=… cargo test --release --test main -- --ignored --nocapture time_left
//! ```

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use sootlight::engine::{Engine, Picture};
use sootlight::project::{Job, Project};
use sootlight::render::{Cancel, Plan, render_planned};
use sootlight::volume::{self, BuiltIn, Limits, Wanted};

use super::common;

/// So near the end, or the beginning, seconds are no help.
const TOLD: Duration = Duration::from_millis(500);

fn job(file: &str, keys: &[&str]) -> Job {
    let shared = common::shared().expect("SOOTLIGHT_SHARED names the shared folder");
    let mut project = Project::default();
    project.render.size = [640, 360];
    project.set_all(keys.iter().copied()).unwrap();
    let volume = volume::open_or_built_in(
        &[shared.join("data").join(file)],
        BuiltIn::default(),
        &Wanted::default(),
        &Limits::default(),
    );
    project.job(&Arc::new(volume.unwrap())).unwrap()
}

/// What was told over what it then took, least and most, and the share of it within a quarter.
fn judge(words: &str, told: &[(Duration, Duration)], end: Duration) {
    let ratios: Vec<f64> = told
        .iter()
        .map(|&(at, left)| (end.saturating_sub(at), left))
        .filter(|(took, _)| *took > TOLD)
        .map(|(took, left)| left.as_secs_f64() / took.as_secs_f64())
        .collect();
    let within = ratios
        .iter()
        .filter(|it| (0.75..=1.25).contains(*it))
        .count();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    println!(
        "{words}: {:.1} s, told {least:.2} to {most:.2} times what it took, {within} of {} within a quarter",
        end.as_secs_f64(),
        ratios.len()
    );
}

#[test]
#[ignore = "minutes: see the head of this file"]
fn of_windows_and_files() {
    for (file, keys) in [
        (
            "pool/pool_0022_zip_half.vdb",
            &["render.samples_per_pixel=1"][..],
        ),
        (
            "pool/pool_0022_zip_half.vdb",
            &["render.samples_per_pixel=8"],
        ),
        (
            "embergen_cc0/embergen_fire_a_60.vdb",
            &["render.samples_per_pixel=1"],
        ),
        (
            "embergen_cc0/embergen_fire_a_60.vdb",
            &["render.samples_per_pixel=8"],
        ),
        ("plume/plume.vdb", &["render.samples_per_pixel=8"]),
        (
            "panfire_seq/panfire_0006.vdb",
            &["render.samples_per_pixel=4"],
        ),
    ] {
        let keys = [keys, &["render.step_voxels=0.25", "render.wavelengths=6"]].concat();
        let job = job(file, &keys);
        let rays = job.settings.samples_per_pixel;

        let engine = Engine::new(Engine::threads_beside_a_window(), Box::new(|| {})).unwrap();
        let mut picture = Picture::new(job.settings.size);
        let begun = Instant::now();
        engine.submit(job.clone());
        let mut told = Vec::new();
        while !picture.progress.finished {
            for update in engine.drain() {
                picture.take(update);
            }
            let at = begun.elapsed();
            told.extend(picture.progress.left(at).map(|left| (at, left)));
            std::thread::sleep(Duration::from_millis(30));
        }
        judge(
            &format!("{file}, {rays} rays, window"),
            &told,
            begun.elapsed(),
        );

        let scene = job.scene(None);
        let plan = Plan::new(&scene, &job.settings);
        plan.fields(&scene, sootlight::render::Level::Fine, &Cancel::never());
        let begun = Instant::now();
        let told = Mutex::new(Vec::new());
        render_planned(&scene, &plan, &job.settings, &Cancel::never(), &|share| {
            let at = begun.elapsed();
            // From a fiftieth on, as the window's export tells it.
            if share > 0.02 {
                let left = at.mul_f64((1.0 - share) / share);
                told.lock().unwrap().push((at, left));
            }
        });
        let told = told.into_inner().unwrap();
        judge(
            &format!("{file}, {rays} rays, file"),
            &told,
            begun.elapsed(),
        );
    }
}
