#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use std::sync::atomic::AtomicBool;

use super::*;
use crate::export::Format;
use crate::project::Project;
use crate::render::develop::Metering;
use crate::render::{Effects, Switch};
use crate::volume::procedural;

fn order(path: PathBuf, side: u32) -> Order {
    let mut project = Project::default();
    project.render.size = [side, side];
    Order {
        project,
        volume: Arc::new(procedural::torch()),
        metering: Some(Metering {
            exposure: 1.0,
            white_xyz: [1.0; 3],
            bright_y: 1.0,
        }),
        effects: None,
        path,
        format: Format::Exr,
    }
}

fn outcome(exporter: &mut Exporter) -> Outcome {
    while exporter.running().is_some() {
        exporter.poll();
        std::thread::sleep(Duration::from_millis(5));
    }
    exporter.last().unwrap().clone()
}

fn is_empty(folder: &tempfile::TempDir) -> bool {
    std::fs::read_dir(folder).unwrap().count() == 0
}

#[test]
fn one_export_runs_at_a_time_and_ends_with_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut exporter = Exporter::new(Arc::new(|| {}));
    exporter.begin(order(folder.path().join("a.exr"), 32));
    exporter.begin(order(folder.path().join("b.exr"), 32));
    assert!(matches!(
        outcome(&mut exporter),
        Outcome::Done { size: [32, 32], .. }
    ));
    assert!(folder.path().join("a.exr").is_file() && !folder.path().join("b.exr").exists());
}

#[test]
fn what_the_window_shows_is_exported_and_told_where_the_still_would_decide_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, effects: Option<Effects>| {
        let mut exporter = Exporter::new(Arc::new(|| {}));
        let mut order = order(folder.path().join(name), 32);
        order.effects = effects;
        exporter.begin(order);
        assert!(matches!(outcome(&mut exporter), Outcome::Done { .. }));
        std::fs::read(folder.path().join(name)).unwrap()
    };
    let by_itself = written("a.exr", None);
    let shown = Effects {
        lines: Switch::Off,
        chemiluminescence: Switch::Off,
        scattering: Switch::Off,
        scattering_orders: Switch::Off,
        refraction: Switch::Off,
        dispersion: Switch::Off,
        fire_light: Switch::Off,
        ..Effects::AUTO
    };
    let as_shown = written("b.exr", Some(shown));
    assert!(
        by_itself != as_shown,
        "the window's effects were passed over"
    );
    let text = String::from_utf8_lossy(&as_shown);
    // What the still would have left out by itself is not told as if somebody had switched it.
    for told in [
        "refraction = \"off\"",
        "fire_light = \"auto\"",
        "lines = \"auto\"",
    ] {
        assert!(text.contains(told), "{told}");
    }
}

#[test]
fn what_is_cancelled_or_dropped_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let endless = || {
        let mut order = order(folder.path().join("a.exr"), 256);
        order.project.render.samples_per_pixel = Some(4096);
        order
    };
    let mut exporter = Exporter::new(Arc::new(|| {}));
    // At once, and in the midst of it.
    for share in [-1.0, 0.0] {
        exporter.begin(endless());
        while exporter.running().unwrap().1.share <= share {
            std::thread::sleep(Duration::from_millis(1));
        }
        exporter.cancel();
        assert_eq!(outcome(&mut exporter), Outcome::Cancelled);
    }
    exporter.begin(endless());
    drop(exporter);
    assert!(is_empty(&folder));
}

#[test]
fn a_file_of_the_volume_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fire.png");
    std::fs::write(&path, "a volume").unwrap();
    let mut own = order(
        folder
            .path()
            .join("../")
            .join(folder.path())
            .join("fire.png"),
        8,
    );
    Arc::make_mut(&mut own.volume).sources = vec![path.clone()];
    let mut exporter = Exporter::new(Arc::new(|| {}));
    exporter.begin(own);
    let Outcome::Failed(words) = outcome(&mut exporter) else {
        unreachable!()
    };
    assert!(words.contains("that the picture is made from"), "{words}");
    assert_eq!(std::fs::read(path).unwrap(), b"a volume");
}

#[test]
fn the_window_is_woken_now_and_then_and_at_the_end() {
    let count = Arc::new(AtomicU64::new(0));
    let wake = Arc::clone(&count);
    let folder = tempfile::tempdir().unwrap();
    let begun = Instant::now();
    let mut exporter = Exporter::new(Arc::new(move || {
        wake.fetch_add(1, Ordering::SeqCst);
    }));
    exporter.begin(order(folder.path().join("a.exr"), 512));
    outcome(&mut exporter);
    let most = begun.elapsed().as_millis() as u64 / WAKE_MS + 1;
    let woken = count.load(Ordering::SeqCst);
    assert!((1..=most).contains(&woken), "{woken} of at most {most}");
}

#[test]
fn a_worker_that_panics_fails_the_export_in_words_and_the_next_one_runs() {
    let folder = tempfile::tempdir().unwrap();
    // The fault is planted in what workers call to wake the window.
    let armed = Arc::new(AtomicBool::new(true));
    let fuse = Arc::clone(&armed);
    let wake = move || assert!(!fuse.swap(false, Ordering::SeqCst), "planted fault");
    let mut exporter = Exporter::new(Arc::new(wake));
    exporter.begin(order(folder.path().join("a.exr"), 512));
    let Outcome::Failed(words) = outcome(&mut exporter) else {
        panic!("the fault was not met");
    };
    assert!(words.contains("planted fault"), "{words}");
    assert!(words.contains("Nothing was written"), "{words}");
    assert!(is_empty(&folder));
    exporter.begin(order(folder.path().join("a.exr"), 16));
    assert!(matches!(outcome(&mut exporter), Outcome::Done { .. }));
}
