//! What an artist can reach: every control at both of its ends, and all pairs of ends of two controls.
//!
//! Pairs are reached many at once: some dozens of rows, each with nearly all controls at an end, hold every pair
//! (see `covering`). An ordinary run takes each end alone and all pairs on a small file, and some ends on the built-in
//! flames. Each end alone, and all pairs, on every file of the shared volumes:
//!
//! ```sh
//! cargo test --release --test main extremes:: -- --ignored --nocapture
//! ```
//!
//! With `SOOTLIGHT_ONLY=pool` only those with "pool" in their paths.
//!
//! All 7811 pairs of ends of 63 controls, in 17 pictures a volume, on the three built-in flames, a small file and the 32 files of
//! the shared volumes took half an hour: no picture had a pixel that is no number or light below nothing, nothing panicked, and
//! what was clamped was told. Refused in words were a least temperature above the greatest (of EmberGen's files, which begin at
//! 1300 K, any greatest of 300 K), and gas of 1000 Pa that must bend light. The longest time without progress was
//! 0.8 s (the pool fire of the finest grid, whose scattered light between smooth voxels is worked out for 64 wavelengths), 0.9 s on
//! EmberGen's fire and 0.5 s or less on the built-in flames, on two cores with nothing else to do. Pairs found voxels of 10 km
//! whose dense soot paths took for ever to pass by: see `DENSEST` in `render/null_collision/path.rs`.

mod covering;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use std::path::PathBuf;
use std::sync::Arc;

use sootlight::colour::display::BakedView;
use sootlight::project::set::KEYS;
use sootlight::project::{Job, Project, ProjectError};
use sootlight::render::develop::{Metering, develop, flaws_of};
use sootlight::render::{Cancel, Plan, render_planned};
use sootlight::volume::{BuiltIn, FieldKind, Limits, Volume, open};

use crate::common;

/// Both ends of a control, as `--set` writes them. What takes names has the two that differ most; what takes any number,
/// two that no fire has.
const ENDS: &[(&str, [&str; 2])] = &[
    ("volume.up", ["y", "z"]),
    ("volume.voxel_size_m", ["1e-6", "1e4"]),
    ("volume.temperature.scale", ["0", "1e5"]),
    ("volume.temperature.offset", ["-1e4", "1e4"]),
    ("volume.temperature.min", ["0", "2000"]),
    ("volume.temperature.max", ["300", "6000"]),
    ("volume.soot.scale", ["0", "1"]),
    ("volume.soot.max", ["0", "1"]),
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
    ("air.saturation", ["huang", "davis"]),
    ("air.co2_ppm", ["0", "2000"]),
    ("air.refraction_gain", ["1", "20"]),
    ("stage.backdrop", ["none", "checker"]),
    ("stage.backdrop_distance_m", ["1e-6", "1e6"]),
    ("stage.backdrop_square_m", ["1e-6", "1e6"]),
    ("stage.backdrop_luminance_cd_m2", ["0", "1e9"]),
    ("stage.ground", ["false", "true"]),
    ("stage.ground_height_m", ["-1e6", "1e6"]),
    ("stage.ground_colour", ["[0, 0, 0]", "[1, 1, 1]"]),
    ("stage.spheres", ["[[0, 0, 0.1, 1e-6]]", "[[0, 0, 0, 1e6]]"]),
    ("stage.sphere_colour", ["[0, 0, 0]", "[1, 1, 1]"]),
    (
        "stage.logs",
        [
            "[[0, 0, 0, 1e-6, 0, 0, 1e-6]]",
            "[[-1e6, 0, 0, 1e6, 0, 0, 1e6]]",
        ],
    ),
    ("stage.log_colour", ["[0, 0, 0]", "[1, 1, 1]"]),
    ("effects.lines", ["off", "on"]),
    ("effects.bands", ["off", "on"]),
    ("effects.chemiluminescence", ["off", "on"]),
    ("effects.scattering", ["off", "on"]),
    ("effects.scattering_orders", ["off", "on"]),
    ("effects.refraction", ["off", "on"]),
    ("effects.dispersion", ["off", "on"]),
    ("effects.fire_light", ["off", "on"]),
    ("effects.smoke", ["off", "on"]),
    ("camera.eye", ["[0, 0, 1e-6]", "[1e6, 1e6, 1e6]"]),
    ("camera.fov_deg", ["0.01", "179"]),
    ("camera.roll_deg", ["-180", "180"]),
    ("render.quality", ["draft", "reference"]),
    ("render.step_voxels", ["0.01", "64"]),
    ("render.target_error", ["0.01", "100"]),
    ("render.wavelengths", ["4", "64"]),
    ("render.interpolation", ["nearest", "tricubic"]),
    ("render.scattering_orders", ["1", "64"]),
    // 4096 would do no more than the same for many more rays.
    ("render.samples_per_pixel", ["1", "4"]),
    ("view.exposure_ev", ["-20", "20"]),
    ("view.display_white_cd_m2", ["1e-3", "1e15"]),
    ("view.adaptation", ["0", "1"]),
    ("view.white_k", ["1000", "20000"]),
    ("view.white_xy", ["[1e-3, 1]", "[1, 1e-3]"]),
    ("view.curve", ["linear", "eye"]),
    ("view.half_saturation_cd_m2", ["1e-3", "1e9"]),
    ("view.false_colour", ["false", "true"]),
];

/// Each end in words of `--set`.
fn ends() -> Vec<String> {
    let both = |(key, ends): &(&str, [&str; 2])| ends.map(|end| format!("{key}={end}"));
    ENDS.iter().flat_map(both).collect()
}

/// A number that has nothing to do with its neighbours (the finaliser of splitmix64).
fn mixed(number: u64) -> u64 {
    let mixed = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

/// What was seen on the way: the longest time without a word of progress and what was rendered then, the time of all, and what
/// went wrong.
#[derive(Default)]
struct Seen {
    silence: Duration,
    with: String,
    all: Duration,
    wrong: Vec<String>,
    /// Least and greatest opacity, of that of what lets nothing through.
    opacity: [f32; 2],
}

/// No picture of so few pixels takes so long, on any machine.
const PATIENCE: Duration = Duration::from_mins(3);

/// Ends the process if what `now` names does not come to its end: nothing else can stop what never asks whether it shall.
fn watch(now: &Arc<Mutex<String>>) {
    let now = Arc::downgrade(now);
    let begun = Instant::now();
    std::thread::spawn(move || {
        while let Some(now) = now.upgrade() {
            if begun.elapsed() > PATIENCE {
                eprintln!("never ends: {}", now.lock().unwrap());
                std::process::exit(3);
            }
            drop(now);
            std::thread::sleep(Duration::from_secs(1));
        }
    });
}

/// Least and greatest share of white light that a pixel takes: nothing and all, and on either side the thousandth within which
/// fitted wavelengths are as good as all.
const OPACITY: std::ops::RangeInclusive<f32> = -1e-3..=1.001;

fn project(sets: &[&String]) -> Project {
    let mut project = Project::default();
    project.render.size = [16, 9];
    project.set("render.samples_per_pixel=1").unwrap();
    // A hundredth of a voxel is a limit of its own; here it would be most of the time.
    project.set("render.step_voxels=4").unwrap();
    let sets = sets.iter().map(|set| set.as_str());
    project.set_all(sets).unwrap();
    project
}

impl Seen {
    /// Renders and develops with these ends, and keeps in mind what goes wrong. What cannot be is refused at the door, in words.
    fn reach(&mut self, volume: &Arc<Volume>, sets: &[&String]) -> Result<(), ProjectError> {
        let reached = catch_unwind(AssertUnwindSafe(|| reach(volume, sets, self)));
        reached.unwrap_or_else(|panic| {
            let words = panic.downcast_ref::<String>().cloned();
            self.wrong
                .push(words.unwrap_or_else(|| format!("panicked: {sets:?}")));
            Ok(())
        })
    }

    fn told(&self) -> String {
        format!(
            "{:.1} s, opacities {:?}, at most {:.2} s without progress: {}",
            self.all.as_secs_f64(),
            self.opacity,
            self.silence.as_secs_f64(),
            self.with
        )
    }
}

/// Asserts that a field which numbers of these ends carry beyond its bounds is told to be clamped, and no other is.
fn assert_clamps_are_told(job: &Job, sets: &[&String]) {
    for kind in FieldKind::ALL {
        let Some(map) = job.flame.maps.get(kind) else {
            continue;
        };
        let is_set = sets
            .iter()
            .any(|set| set.starts_with(&format!("volume.{}.", kind.name())));
        let range = job.volume.grid(&map.grid).unwrap().range();
        let reaches = [range.0, range.1].map(|raw| map.scale * f64::from(raw) + map.offset);
        let slack = 1e-6 * (map.max - map.min);
        let beyond = reaches
            .iter()
            .any(|reached| !(map.min - slack..=map.max + slack).contains(reached));
        let begins = format!("{} would reach", kind.name());
        let is_told = job.flaws.iter().any(|flaw| flaw.starts_with(&begins));
        assert_eq!(is_told, is_set && beyond, "{sets:?}: {kind:?} {reaches:?}");
    }
}

/// Does `work`, and hears meanwhile of the light that is worked out before the first rays.
fn hearing_of_light<T>(plan: &Plan, hear: &(dyn Fn(&str) + Sync), work: impl FnOnce() -> T) -> T {
    let ended = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut last = None;
            while !ended.load(Ordering::Relaxed) {
                let share = plan.preparation().share();
                if share != last {
                    hear(&format!("the light from {last:?} to {share:?}"));
                    last = share;
                }
                std::thread::sleep(Duration::from_millis(1));
            }
        });
        let made = work();
        ended.store(true, Ordering::Relaxed);
        made
    })
}

/// Renders and develops with these ends.
fn reach(volume: &Arc<Volume>, sets: &[&String], seen: &mut Seen) -> Result<(), ProjectError> {
    let project = project(sets);
    let now = Arc::new(Mutex::new(format!("{sets:?}")));
    watch(&now);
    let start = Instant::now();
    let heard = Mutex::new((start, Duration::ZERO, String::new()));
    let hear = |of: &str| {
        let mut heard = heard.lock().unwrap();
        let silence = heard.0.elapsed();
        if silence > heard.1 {
            (heard.1, heard.2) = (silence, of.to_owned());
        }
        heard.0 = Instant::now();
    };
    let job = project.job(volume)?;
    assert_clamps_are_told(&job, sets);
    let scene = job.scene(None);
    hear("the scene");
    let plan = Plan::new(&scene, &job.settings);
    hear("the plan");
    let opaque = plan.tables.opaque;
    let never = Cancel::never();
    let frame = hearing_of_light(&plan, &hear, || {
        render_planned(&scene, &plan, &job.settings, &never, &|_| hear("a tile")).unwrap()
    });
    hear("the end");
    let told: String = flaws_of(&frame.film).iter().collect();
    assert_eq!(told, "", "{sets:?}");
    for pixel in frame.film.pixels() {
        let lowest = pixel.xyz.iter().copied().fold(0.0, f32::min);
        // Of colours whose light is no more than a line's, X or Z may round below nothing.
        assert!(
            lowest >= -1e-3 * pixel.xyz[1].abs().max(1e-3),
            "{sets:?}: {pixel:?}"
        );
        for (opacity, opaque) in pixel.opacity.iter().zip(opaque) {
            let share = opacity / opaque as f32;
            assert!(OPACITY.contains(&share), "{sets:?}: {pixel:?}");
            seen.opacity = [seen.opacity[0].min(share), seen.opacity[1].max(share)];
        }
    }
    let metering = Metering::of(&frame.film);
    let view = BakedView::new(&metering.view(&project.view()));
    for colour in develop(&frame.film, &view) {
        let shown = colour.iter().all(|value| (0.0..=1.0).contains(value));
        assert!(shown, "{sets:?}: {colour:?}");
    }
    hear("the view");
    let (_, longest, of) = heard.into_inner().unwrap();
    seen.all += start.elapsed();
    if longest > seen.silence {
        seen.silence = longest;
        seen.with = format!("{of} of {sets:?}");
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
    let mut seen = Seen::default();
    let refused = sets.iter().filter(|sets| {
        let refused = seen.reach(volume, sets).err();
        refused.is_some_and(|error| is_told(name, sets, &error))
    });
    let refused = refused.count();
    println!(
        "{name}: {} pictures, {refused} refused, {}",
        sets.len() - refused,
        seen.told()
    );
    assert!(seen.wrong.is_empty(), "{name}: {:#?}", seen.wrong);
    refused
}

/// A refusal says what to do.
fn is_told(name: &str, sets: &[&String], error: &ProjectError) -> bool {
    let words = error.to_string();
    assert!(words.len() > 20, "{name}, {sets:?}: {words}");
    true
}

/// Reaches all pairs of ends with one of `alone_of` controls left alone, and tells in words what it took; what may not be is
/// given in words of `--set`.
fn reach_pairs(name: &str, volume: &Arc<Volume>, alone_of: u64) -> BTreeSet<String> {
    let ends = ends();
    let sets = |row: &covering::Row| -> Vec<&String> {
        let set = |(at, end): (usize, &Option<usize>)| end.map(|end| &ends[2 * at + end]);
        row.iter().enumerate().filter_map(set).collect()
    };
    let mut seen = Seen::default();
    let covered = covering::cover(
        ENDS.len(),
        alone_of,
        |row| {
            let sets = sets(row);
            match seen.reach(volume, &sets) {
                Ok(()) => true,
                Err(error) => !is_told(name, &sets, &error),
            }
        },
        |row| project(&sets(row)).job(volume).is_err(),
    );
    let words = |ends_to_blame: &Vec<(usize, usize)>| {
        let sets = ends_to_blame
            .iter()
            .map(|&(at, end)| ends[2 * at + end].as_str());
        sets.collect::<Vec<_>>().join(" with ")
    };
    let refused: BTreeSet<String> = covered.refused.iter().map(words).collect();
    let mut told = format!(
        "{name}: {} pairs in {} pictures, {} barred, {}",
        covered.pairs,
        covered.rows,
        covered.barred,
        seen.told()
    );
    for refused in &refused {
        write!(told, "\n  refused: {refused}").unwrap();
    }
    println!("{told}");
    assert!(seen.wrong.is_empty(), "{name}: {:#?}", seen.wrong);
    assert!(
        covered.pairs > 9 * covered.barred,
        "{name}: most is refused: {refused:#?}"
    );
    refused
}

#[test]
fn every_number_that_can_be_set_has_its_ends_here() {
    for key in KEYS {
        let is_range = key.expects.contains("number") && key.expects.contains(" to ");
        // How much memory a file may take does not act on a picture.
        let is_told =
            key.name == "volume.memory_limit_mb" || ENDS.iter().any(|(name, _)| *name == key.name);
        let is_choice = ["true or false", "auto, on or off"].contains(&key.expects);
        assert!(
            !(is_range || is_choice) || is_told,
            "{} is not tried",
            key.name
        );
    }
}

#[test]
fn each_end_alone_and_all_pairs_give_a_picture() {
    let ends = ends();
    let alone: Vec<Vec<&String>> = ends.iter().map(|end| vec![end]).collect();
    let volumes = small();
    let (built_in, [(name, file)]) = volumes.split_at(volumes.len() - 1) else {
        panic!("a file comes last");
    };
    let refused = reach_all(name, file, &alone);
    assert!(refused < alone.len() / 4, "{name}: {refused} refused");
    for alone_of in [2, 8] {
        reach_pairs(name, file, alone_of);
    }
    for (i, (name, volume)) in built_in.iter().enumerate() {
        let some: Vec<_> = alone.iter().skip(i).step_by(11).cloned().collect();
        reach_all(name, volume, &some);
    }
}

/// Every file of the shared volumes, after the small ones.
fn all() -> Vec<(String, Arc<Volume>)> {
    let mut volumes = small();
    let only = std::env::var("SOOTLIGHT_ONLY").unwrap_or_default();
    if let Some(shared) = common::shared() {
        let folders = std::fs::read_dir(shared.join("data")).unwrap();
        let folders = folders.map(|entry| entry.unwrap().path());
        let files = folders.flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten());
        let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.retain(|path| path.to_string_lossy().contains(&only));
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
#[ignore = "takes minutes: every end alone on every file"]
fn each_end_alone_on_every_file_gives_a_picture() {
    let ends = ends();
    let alone: Vec<Vec<&String>> = ends.iter().map(|end| vec![end]).collect();
    for (name, volume) in all() {
        reach_all(&name, &volume, &alone);
    }
}

#[test]
#[ignore = "takes minutes: all pairs of ends on every file"]
fn all_pairs_of_ends_on_every_file_give_a_picture() {
    for (name, volume) in all() {
        reach_pairs(&name, &volume, 8);
    }
}
