//! The march against the plainest one: every step of every ray, in double precision.

use std::sync::Arc;

use rayon::prelude::*;
use sootlight::physics::blackbody;
use sootlight::project::{Job, Project};
use sootlight::render::difference::difference;
use sootlight::render::march::Marcher;
use sootlight::render::{Cancel, Plan, Settings, render_planned};
use sootlight::scene::Scene;
use sootlight::volume::{self, Limits, Volume};

use crate::common;

/// Side of the pictures, pixels.
pub(super) const SIDE: u32 = 32;
/// Steps at which the march is compared with the plain one, voxels.
const STEP: f64 = 0.25;
/// Steps at which both have nearly come to their limit.
const FINE_STEP: f64 = 1.0 / 64.0;
/// What nothing that makes the march quick may change, ΔE_ITP: a twentieth of what is just seen.
const MOST_DE: f64 = 0.05;

pub(super) type Picture = Vec<[f64; 3]>;

/// A picture by L += t B (1 − e^{−τ}), whose rays take the samples that are asked for: where each begins and ends, m from
/// where a ray enters the box that is so long for it.
fn plainly(
    scene: &Scene,
    plan: &Plan,
    samples: impl Fn([f64; 2], f64) -> Vec<[f64; 2]> + Sync,
) -> Picture {
    let medium = scene.flame.medium();
    let view = scene.camera.view([SIDE; 2]).unwrap();
    let wavelengths = &plan.tables.wavelengths;
    let absorption = |nm: &f64| [*nm, scene.flame.absorption_per_sample(*nm)];
    let nodes: Vec<[f64; 2]> = wavelengths.nodes_nm.iter().map(absorption).collect();
    let of_pixel = |pixel: u32| {
        let point = [pixel % SIDE, pixel / SIDE].map(|at| f64::from(at) + 0.5);
        let mut radiance = vec![0.0; nodes.len()];
        let mut column = 0.0;
        if let Some((local, [enter, exit])) = medium.enter(&view.ray(point[0], point[1])) {
            for [from, to] in samples(point, exit - enter) {
                let [soot, kelvin] = medium.sample(local.at(enter + 0.5 * (from + to)));
                if soot <= 0.0 {
                    continue;
                }
                let own = soot * (to - from);
                for (radiance, [nm, absorption]) in radiance.iter_mut().zip(&nodes) {
                    let taken = (-absorption * column).exp() * -(-absorption * own).exp_m1();
                    *radiance += taken * blackbody::spectral_radiance(*nm, kelvin);
                }
                column += own;
            }
        }
        wavelengths.xyz_of(radiance)
    };
    (0..SIDE * SIDE).into_par_iter().map(of_pixel).collect()
}

/// Even steps through the whole box: no brick is skipped, no step is cut, no ray ends before the box does.
fn evenly(scene: &Scene, plan: &Plan, step: f64) -> Picture {
    let step_m = step * scene.flame.medium().voxel_size_m();
    plainly(scene, plan, |_, length| {
        let steps = 0..(length / step_m).ceil() as u32;
        let border = |at: u32| (f64::from(at) * step_m).min(length);
        steps.map(|step| [border(step), border(step + 1)]).collect()
    })
}

pub(super) fn marched(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    step_voxels: f64,
) -> Picture {
    let settings = Settings {
        step_voxels,
        ..*settings
    };
    let frame = render_planned(scene, plan, &settings, &Cancel::never(), &|_| {}).unwrap();
    let pixels = frame.film.pixels().iter();
    pixels.map(|it| it.xyz.map(f64::from)).collect()
}

pub(super) fn job(volume: &Arc<Volume>, sets: &[&str]) -> Job {
    let mut project = Project::default();
    let always = [
        "effects.scattering=off",
        "effects.refraction=off",
        "effects.chemiluminescence=off",
        "render.samples_per_pixel=1",
        "render.wavelengths=16",
    ];
    project.set_all(always.iter().chain(sets).copied()).unwrap();
    project.render.size = [SIDE; 2];
    project.job(volume).unwrap()
}

fn compare(name: &str, job: &Job) {
    let (scene, settings) = (job.scene(None), &job.settings);
    let plan = Plan::new(&scene, settings);

    // At the same samples: what single precision, lanes, skipped bricks and rays that end early change.
    let marcher = Marcher::new(&scene, &plan, STEP).unwrap();
    let same = plainly(&scene, &plan, |point, _| marcher.samples_of(point));
    let march = marched(&scene, &plan, settings, STEP);
    let off = difference(&same, &march);
    assert!(off.lit > 50, "{name}: {off:?}");
    assert!(off.largest < MOST_DE, "{name}, same samples: {off:?}");

    // The limit of even steps, whose error is of the second order (L. F. Richardson 1911).
    let [coarse, fine] = [2.0, 1.0].map(|times| evenly(&scene, &plan, times * FINE_STEP));
    let pixels = coarse.iter().zip(&fine);
    let limit: Picture = pixels
        .map(|(coarse, fine)| std::array::from_fn(|c| (4.0 * fine[c] - coarse[c]) / 3.0))
        .collect();
    let off = difference(&limit, &marched(&scene, &plan, settings, FINE_STEP));
    // In the dimmest pixels an f32 shows: counted as errors of pictures are, at the 95th percentile.
    assert!(off.p95 < MOST_DE, "{name}, limit: {off:?}");

    // On the way there the march is nearer than even steps are.
    let even = difference(&limit, &evenly(&scene, &plan, STEP));
    let cut = difference(&limit, &march);
    assert!(
        cut.mean < even.mean && cut.p95 < even.p95,
        "{name}: {cut:?} {even:?}"
    );
}

#[test]
fn what_makes_the_march_quick_cannot_be_seen() {
    let torch = common::torch();
    // Thin, as it is, and so dense that rays end early.
    for amount in ["0.01", "1", "300"] {
        let sets = format!("soot.amount={amount}");
        compare(&sets, &job(&torch, &[&sets]));
    }
    for (name, volume) in shared_fires() {
        compare(name, &job(&volume, &[]));
    }
}

/// One of each kind of shared fire.
pub(super) fn shared_fires() -> Vec<(&'static str, Arc<Volume>)> {
    let Some(shared) = common::shared() else {
        return Vec::new();
    };
    let files = [
        "plume/plume.vdb",
        "pool/pool_0022_zip_half.vdb",
        "campfire/campfire_0022_zip_half.vdb",
        "embergen_cc0/embergen_fire_a_60.vdb",
        "panfire_seq/panfire_0006.vdb",
    ];
    let opened = files.map(|file| {
        let path = shared.join("data").join(file);
        (file, volume::open(&[path], &Limits::default()).unwrap())
    });
    opened
        .into_iter()
        .map(|(file, volume)| (file, Arc::new(volume)))
        .collect()
}
