//! Whole stills: in time, and with a number of the packed medium that is none.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::Arc;
use std::time::Instant;

use super::develop::flaws_of;
use super::still::render_until;
use super::{Cancel, Plan, render_planned};
use crate::project::{Job, Project};
use crate::volume::procedural;

/// A small picture of the torch, of direct light along straight rays.
fn torch() -> Job {
    let mut project = Project::default();
    project
        .set_all([
            "render.size=[48, 64]",
            "render.samples_per_pixel=1",
            "effects.scattering=off",
            "effects.refraction=off",
        ])
        .unwrap();
    project.job(&Arc::new(procedural::torch())).unwrap()
}

#[test]
fn what_is_no_number_spoils_the_rays_that_come_to_it_and_no_other() {
    let job = torch();
    let scene = job.scene(None);
    let plan = Plan::new(&scene, &job.settings);
    let render = |scene: &crate::scene::Scene| {
        let never = Cancel::never();
        render_planned(scene, &plan, &job.settings, &never, &|_| {})
            .unwrap()
            .film
    };
    let good = render(&scene);
    let samples = scene.flame.medium().samples.iter();
    let (densest, _) = samples
        .enumerate()
        .max_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]))
        .unwrap();
    for field in [0, 1] {
        let mut spoilt = scene.clone();
        spoilt.flame = scene.flame.with_spoilt_sample(densest, field);
        let film = render(&spoilt);
        let pairs = film.pixels().iter().zip(good.pixels());
        let changed: Vec<_> = pairs.filter(|(spoilt, good)| spoilt != good).collect();
        assert!(
            (1..60).contains(&changed.len()),
            "{field}: {}",
            changed.len()
        );
        for (pixel, _) in &changed {
            let mut numbers = pixel.xyz.iter().chain(&pixel.opacity);
            assert!(
                numbers.any(|it| !it.is_finite()),
                "{field}: {pixel:?} passes for good"
            );
        }
        let words = flaws_of(&film).iter().collect::<String>();
        let count = format!("{} pixels are no numbers", changed.len());
        assert!(words.starts_with(&count), "{words}");
    }
}

#[test]
fn a_picture_whose_time_is_up_at_once_is_whole_and_says_so() {
    let job = torch();
    let scene = job.scene(None);
    let plan = Plan::new(&scene, &job.settings);
    let now = Instant::now();
    let render = |cancel| render_until(&scene, &plan, &job.settings, now, cancel, &|_| {});
    let frame = render(&Cancel::never()).unwrap();
    assert!(!frame.finished);
    assert!(
        frame
            .flaws
            .iter()
            .any(|flaw| flaw.contains("the time was up"))
    );
    // A ray for each block of eight by eight pixels, and none more.
    assert_eq!(frame.rays, 6 * 8);
    let lit = frame
        .film
        .pixels()
        .iter()
        .filter(|pixel| pixel.xyz[1] > 0.0);
    assert!(lit.count() > 64);
}
