//! Small pictures that must not change unless someone means it.
//!
//! A picture may differ by 1/255 on one pixel in a thousand: rounding at the edge between two 8-bit values. On
//! failure the new picture and the difference (times 32) are written to tests/golden/failed. To accept what the
//! program makes now:
//!
//! ```text
//! SOOTLIGHT_UPDATE_GOLDEN=1 cargo test --release --test main golden::
//! ```

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use image::RgbImage;
use sootlight::colour::display::BakedView;
use sootlight::project::Project;
use sootlight::render::develop::{Metering, develop};
use sootlight::render::{Cancel, render_still};
use sootlight::volume::Volume;

use super::common;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

/// What the command line would write for a project, as 8-bit pixels.
fn picture(project: &Project, volume: &Arc<Volume>) -> RgbImage {
    let job = project.job(volume).unwrap();
    let flaws: Vec<&str> = job.flaws.iter().collect();
    assert!(
        flaws.is_empty(),
        "a golden picture must be faithful, but: {flaws:?}"
    );
    let frame = render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap();
    let view = Metering::of(&frame.film).view(&project.view());
    let pixels = develop(&frame.film, &BakedView::new(&view));
    let bytes = pixels
        .iter()
        .flatten()
        .map(|value| (value * 255.0).round() as u8)
        .collect();
    let [width, height] = job.settings.size;
    RgbImage::from_raw(width, height, bytes).unwrap()
}

fn compare(name: &str, ours: &RgbImage) {
    let path = folder().join(format!("{name}.png"));
    if std::env::var_os("SOOTLIGHT_UPDATE_GOLDEN").is_some() {
        ours.save(&path).unwrap();
        return;
    }
    let golden = image::open(&path).unwrap().to_rgb8();
    assert_eq!(golden.dimensions(), ours.dimensions(), "{name}");
    let furthest = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| {
        a.0.iter()
            .zip(&b.0)
            .map(|(a, b)| a.abs_diff(*b))
            .max()
            .unwrap()
    };
    let differences: Vec<u8> = golden
        .pixels()
        .zip(ours.pixels())
        .map(|(a, b)| furthest(a, b))
        .collect();
    let worst = differences.iter().max().unwrap();
    let changed = differences
        .iter()
        .filter(|&&difference| difference > 0)
        .count();
    if *worst > 1 || changed * 1000 > differences.len() {
        let failed = folder().join("failed");
        std::fs::create_dir_all(&failed).unwrap();
        ours.save(failed.join(format!("{name}.png"))).unwrap();
        let amplified = differences
            .iter()
            .map(|difference| difference.saturating_mul(32))
            .collect();
        let (width, height) = ours.dimensions();
        let map = image::GrayImage::from_raw(width, height, amplified).unwrap();
        map.save(failed.join(format!("{name}_difference.png")))
            .unwrap();
        panic!("{name}: {changed} pixels differ, by up to {worst}/255; see tests/golden/failed");
    }
}

#[test]
fn the_built_in_flame() {
    let mut project = Project::default();
    project.render.size = [96, 128];
    compare("torch", &picture(&project, &common::torch()));
}

#[test]
fn the_built_in_flame_from_above_with_much_soot_through_a_clipping_display() {
    let mut project = Project::default();
    project.render.size = [96, 96];
    project.soot.amount = 8.0;
    project.camera.eye = Some(DVec3::new(0.35, -0.3, 0.5));
    project.camera.target = Some(DVec3::new(0.0, 0.0, 0.15));
    project.view.curve = sootlight::colour::display::Curve::Linear;
    project.view.adaptation = 1.0;
    project.view.exposure_ev = -1.0;
    compare("torch_above", &picture(&project, &common::torch()));
}
