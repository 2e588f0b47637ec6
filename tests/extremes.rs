//! What an artist can reach: every control at both of its ends, and all pairs of ends.
//!
//! An ordinary run takes each end alone and some pairs on a small file, and some ends on the built-in flames. All pairs on
//! every file of the shared volumes, which takes hours:
//!
//! ```sh
//! cargo test --release --test main extremes:: -- --ignored --nocapture
//! ```

use std::path::PathBuf;
use std::sync::Arc;

use sootlight::colour::display::BakedView;
use sootlight::project::set::KEYS;
use sootlight::project::{Project, ProjectError};
use sootlight::render::develop::{Metering, develop, flaws_of};
use sootlight::render::{Cancel, render_still};
use sootlight::volume::{BuiltIn, Limits, Volume, open};

use crate::common;

/// Both ends of a control, as `--set` writes them. What takes names has the two that differ most.
const ENDS: &[(&str, [&str; 2])] = &[
    ("volume.voxel_size_m", ["1e-6", "1e4"]),
    ("volume.temperature.max", ["300", "6000"]),
    ("volume.soot.scale", ["0", "1"]),
    ("fuel.name", ["methanol", "acetylene"]),
    ("fuel.salt", ["none", "copper-chloride"]),
    ("fuel.salt_ppm", ["0", "1e5"]),
    ("fuel.blue_glow", ["0", "1e4"]),
    ("soot.radius_nm", ["1", "100"]),
    ("soot.amount", ["0", "1e4"]),
    ("soot.model", ["chang", "grey"]),
    ("soot.hold", ["number", "volume"]),
    ("soot.asymmetry", ["-0.99", "0.99"]),
    ("smoke.amount", ["0", "1e4"]),
    ("smoke.albedo", ["0", "0.99"]),
    ("air.temperature_k", ["200", "400"]),
    ("air.pressure_pa", ["1000", "1e6"]),
    ("air.humidity", ["0", "1"]),
    ("air.co2_ppm", ["0", "2000"]),
    ("air.refraction_gain", ["1", "20"]),
    ("stage.backdrop", ["none", "checker"]),
    ("stage.backdrop_luminance_cd_m2", ["0", "1e9"]),
    ("stage.ground", ["false", "true"]),
    ("camera.fov_deg", ["0.01", "179"]),
    ("render.step_voxels", ["0.01", "64"]),
    ("render.target_error", ["0.01", "100"]),
    ("render.wavelengths", ["4", "64"]),
    ("render.interpolation", ["nearest", "tricubic"]),
    ("view.exposure_ev", ["-20", "20"]),
    ("view.adaptation", ["0", "1"]),
    ("view.white_k", ["1000", "20000"]),
    ("view.curve", ["linear", "eye"]),
    ("view.half_saturation_cd_m2", ["1e-3", "1e9"]),
];

/// Each end in words of `--set`.
fn ends() -> Vec<String> {
    let both = |(key, ends): &(&str, [&str; 2])| ends.map(|end| format!("{key}={end}"));
    ENDS.iter().flat_map(both).collect()
}

/// Renders and develops with these ends. What cannot be is refused at the door, in words.
fn reach(volume: &Arc<Volume>, name: &str, sets: &[&String]) -> Result<(), ProjectError> {
    let mut project = Project::default();
    project.render.size = [16, 9];
    project.set("render.samples_per_pixel=1").unwrap();
    // A hundredth of a voxel is a limit of its own; here it would be most of the time.
    project.set("render.step_voxels=4").unwrap();
    project
        .set_all(sets.iter().map(|set| set.as_str()))
        .unwrap();
    let job = project.job(volume)?;
    let scene = job.scene(None);
    let frame = render_still(&scene, &job.settings, &Cancel::never(), &|_| {}).unwrap();
    let told: String = flaws_of(&frame.film).iter().collect();
    assert_eq!(told, "", "{name}, {sets:?}");
    for pixel in frame.film.pixels() {
        let lowest = pixel.xyz.iter().chain(&pixel.opacity).copied();
        let lowest = lowest.fold(0.0, f32::min);
        // Of colours whose light is no more than a line's, X or Z may round below nothing.
        assert!(
            lowest >= -1e-3 * pixel.xyz[1].abs().max(1e-3),
            "{name}, {sets:?}: {pixel:?}"
        );
    }
    let metering = Metering::of(&frame.film);
    let view = BakedView::new(&metering.view(&project.view()));
    for colour in develop(&frame.film, &view) {
        let shown = colour.iter().all(|value| (0.0..=1.0).contains(value));
        assert!(shown, "{name}, {sets:?}: {colour:?}");
    }
    Ok(())
}

/// Small files of every format, and the built-in flames.
fn small() -> Vec<(String, Arc<Volume>)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fire.vdb");
    let grids = [("density", 0.4), ("flame", 0.9), ("temperature", 2.0)];
    common::write_vdb(&path, &grids);
    let file = open(&[path], &Limits::default()).unwrap();
    let built_in = BuiltIn::ALL.map(|it| (it.name().to_owned(), Arc::new(it.volume())));
    let mut volumes = built_in.to_vec();
    volumes.push(("a small file".to_owned(), Arc::new(file)));
    volumes
}

/// Tries the ends, and tells how many were refused.
fn reach_all(name: &str, volume: &Arc<Volume>, sets: &[Vec<&String>]) -> usize {
    let refused = |sets: &&Vec<&String>| match reach(volume, name, sets) {
        Ok(()) => false,
        Err(error) => {
            let words = error.to_string();
            assert!(words.len() > 20, "{name}, {sets:?}: {words}");
            true
        }
    };
    sets.iter().filter(refused).count()
}

#[test]
fn every_number_that_can_be_set_has_its_ends_here() {
    for key in KEYS {
        let is_range = key.expects.starts_with("a number") && key.expects.contains(" to ");
        // How much memory a file may take does not act on a picture.
        let is_told = key.name == "volume.memory_limit_mb"
            || ENDS.iter().any(|(name, _)| *name == key.name)
            // Where things stand is a matter of the stage's tests.
            || key.name.starts_with("stage.");
        assert!(!is_range || is_told, "{} is not tried", key.name);
    }
}

#[test]
fn each_end_alone_and_some_pairs_give_a_picture() {
    let ends = ends();
    let alone: Vec<Vec<&String>> = ends.iter().map(|end| vec![end]).collect();
    let volumes = small();
    let (built_in, [(name, file)]) = volumes.split_at(volumes.len() - 1) else {
        panic!("a file comes last");
    };
    let some: Vec<_> = pairs(&ends).into_iter().step_by(61).collect();
    for sets in [&alone, &some] {
        let refused = reach_all(name, file, sets);
        assert!(refused < sets.len() / 4, "{name}: {refused} refused");
    }
    for (i, (name, volume)) in built_in.iter().enumerate() {
        let some: Vec<_> = alone.iter().skip(i).step_by(11).cloned().collect();
        reach_all(name, volume, &some);
    }
}

/// All pairs of ends of two controls.
fn pairs(ends: &[String]) -> Vec<Vec<&String>> {
    let key = |set: &String| set.split('=').next().map(str::to_owned);
    let mut pairs = Vec::new();
    for (i, first) in ends.iter().enumerate() {
        let others = ends[i + 1..]
            .iter()
            .filter(|other| key(other) != key(first));
        pairs.extend(others.map(|second| vec![first, second]));
    }
    pairs
}

/// Every file of the shared volumes, after the small ones.
fn all() -> Vec<(String, Arc<Volume>)> {
    let mut volumes = small();
    if let Some(shared) = common::shared() {
        let folders = std::fs::read_dir(shared.join("data")).unwrap();
        let folders = folders.map(|entry| entry.unwrap().path());
        let files = folders.flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten());
        let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
        files.sort();
        let opened = files.iter().filter_map(|path| {
            let volume = open(std::slice::from_ref(path), &Limits::default()).ok()?;
            let name = path.file_name()?.to_string_lossy().into_owned();
            Some((name, Arc::new(volume)))
        });
        volumes.extend(opened);
    }
    volumes
}

#[test]
#[ignore = "takes long: every end alone on every file"]
fn each_end_alone_on_every_file_gives_a_picture() {
    let ends = ends();
    let alone: Vec<Vec<&String>> = ends.iter().map(|end| vec![end]).collect();
    for (name, volume) in all() {
        let refused = reach_all(&name, &volume, &alone);
        println!("{name}: {} pictures, {refused} refused", alone.len());
    }
}

#[test]
#[ignore = "takes very long: all pairs of ends on every file"]
fn all_pairs_of_ends_on_every_file_give_a_picture() {
    let ends = ends();
    let pairs = pairs(&ends);
    for (name, volume) in all() {
        let refused = reach_all(&name, &volume, &pairs);
        println!("{name}: {} pictures, {refused} refused", pairs.len());
    }
}
