//! What each effect costs when it is on, and that it costs nothing when it is off.
//!
//! ```text
//! cargo bench --bench effects
//! ```
//!
//! Each scene is rendered in turn with one effect on, with it off, and as a scene that never heard of it: emission and
//! absorption alone. Ratios are of wall-clock time of one thread, medians of pairs that follow each other; the last
//! column shows by how much two equal runs differ, which is the noise. With `SOOTLIGHT_SHARED` on a pool fire as well.
//!
//! A last line compares the picture whose effects are decided automatically with the same picture where each was switched by
//! hand to what was decided: what deciding costs.
//!
//! The first lines are what soot costs of which there is so little that squares of its depths are below what f32 holds in full
//! (1.2e-38), or the depths themselves, over soot that is as clear but told in full: denormal numbers take a hundred times as
//! long on some processors. The voxels of a file are never denormal when they are packed, but an amount can make them so.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use sootlight::project::Project;
use sootlight::render::{Cancel, Plan, render_still};
use sootlight::scene::Scene;
use sootlight::volume::{self, BuiltIn, Limits, Volume, Wanted};

/// Pairs of runs.
const PAIRS: usize = 9;

/// An effect: what makes a scene call for it, and the switch.
const EFFECTS: &[(&str, &[&str], &str)] = &[
    (
        "scattering",
        &["soot.radius_nm=60", "soot.hold=volume"],
        "effects.scattering",
    ),
    (
        "refraction",
        &["stage.backdrop=checker"],
        "effects.refraction",
    ),
    ("fire light", &["stage.ground=true"], "effects.fire_light"),
    (
        "chemiluminescence",
        &["fuel.blue_glow=1"],
        "effects.chemiluminescence",
    ),
    ("lines", &["fuel.salt=sodium"], "effects.lines"),
    ("bands", &["fuel.salt=copper"], "effects.bands"),
];

fn main() {
    let flame = [("built-in flame", Vec::new())];
    let shared = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from);
    let pool = shared.map(|shared| {
        let file = shared.join("data/pool/pool_0022_zip_half.vdb");
        ("pool fire", vec![file])
    });
    for (name, files) in flame.into_iter().chain(pool) {
        let volume = match volume::open_or_built_in(
            &files,
            BuiltIn::default(),
            &Wanted::default(),
            &Limits::default(),
        ) {
            Ok(volume) => Arc::new(volume),
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        println!("{name}, 512 × 512, one thread; time over that of emission and absorption alone:");
        println!("  {:<18} {:>8} {:>8} {:>8}", "effect", "on", "off", "noise");
        for amount in THIN {
            measure_thin(&volume, amount);
        }
        for (effect, calls, switch) in EFFECTS {
            measure(&volume, effect, calls, switch);
        }
        measure_deciding(&volume);
    }
}

/// Amounts of soot for which, in a flame with a peak of about 1e-6, the squares of depths are denormal; for which they are
/// nothing; for which the depths themselves are denormal.
const THIN: [f64; 3] = [1e-15, 1e-24, 1e-36];
/// An amount through which everything is seen as well, with the same sums, but whose light is told in full.
const CLEAR: f64 = 1e-9;

/// Time of so little soot over that of a clear fire.
fn measure_thin(volume: &Arc<Volume>, amount: f64) {
    let alone = [
        "render.size=[512, 512]",
        "effects.scattering=off",
        "effects.refraction=off",
        "effects.chemiluminescence=off",
    ];
    let job = |amount: f64| {
        let mut project = Project::default();
        project.set_all(alone).ok()?;
        project.soot.amount = amount;
        project.smoke.amount = amount;
        project.job(volume).ok()
    };
    let (Some(thin), Some(clear)) = (job(amount), job(CLEAR)) else {
        return println!("  thin: cannot be rendered");
    };
    let jobs = [thin, clear];
    // One packed medium, so that neither finds the caches emptied by the other.
    let first = jobs[0].scene(None);
    let scenes = [first.clone(), jobs[1].scene(Some(&first))];
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else {
        return println!("  thin: no thread");
    };
    let seconds = |i: usize| {
        let begun = Instant::now();
        let render = || render_still(&scenes[i], &jobs[i].settings, &Cancel::never(), &|_| {});
        std::hint::black_box(pool.install(render));
        begun.elapsed().as_secs_f64()
    };
    let pair = |_| [seconds(0) / seconds(1), seconds(1) / seconds(1)];
    let pairs: Vec<[f64; 2]> = (0..PAIRS).map(pair).collect();
    let [thin, noise] = [0, 1].map(|which: usize| {
        let mut ratios: Vec<f64> = pairs.iter().map(|pair| pair[which]).collect();
        ratios.sort_by(f64::total_cmp);
        ratios[PAIRS / 2]
    });
    println!(
        "  thin, soot × {amount:<8e} {thin:>8.2} {:>8} {noise:>8.3}",
        ""
    );
}

/// Automatic against switched by hand to the same, in seconds of one thread.
fn measure_deciding(volume: &Arc<Volume>) {
    let mut project = Project::default();
    let Ok(mut job) = project
        .set("render.size=[512, 512]")
        .map_err(|error| error.to_string())
        .and_then(|()| project.job(volume).map_err(|error| error.to_string()))
    else {
        return println!("  cannot be rendered");
    };
    let scene = job.scene(None);
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else {
        return println!("  no thread");
    };
    let seconds = |job: &sootlight::project::Job| {
        let begun = Instant::now();
        let still = || {
            render_still(&scene, &job.settings, &Cancel::never(), &|_| {}).map(|it| it.decisions)
        };
        let decisions = pool.install(still);
        (begun.elapsed().as_secs_f64(), decisions)
    };
    let automatic = job.clone();
    let (_, decisions) = seconds(&automatic);
    job.settings.effects = job
        .settings
        .effects
        .as_decided(&decisions.unwrap_or_default());
    let mut ratios: Vec<f64> = (0..PAIRS)
        .map(|_| {
            let by_hand = seconds(&job).0;
            seconds(&automatic).0 / by_hand
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let deciding = Instant::now();
    std::hint::black_box(Plan::new(&scene, &automatic.settings));
    println!(
        "  automatic over by hand: {:.3} ({:.3} to {:.3}); deciding takes {:.1} ms",
        ratios[PAIRS / 2],
        ratios[0],
        ratios[PAIRS - 1],
        1e3 * deciding.elapsed().as_secs_f64()
    );
}

fn measure(volume: &Arc<Volume>, effect: &str, calls: &[&str], switch: &str) {
    // What stands on a stage is there either way: it is seen, dark, where the fire's light is off.
    let alone = [
        "effects.scattering=off",
        "effects.refraction=off",
        "effects.fire_light=off",
        "effects.chemiluminescence=off",
        "effects.lines=off",
        "effects.bands=off",
    ];
    let job = |state: Option<&str>| {
        let mut project = Project::default();
        let settings = ["render.size=[512, 512]"];
        let mut all: Vec<String> = settings
            .iter()
            .chain(&alone)
            .map(|it| (*it).to_owned())
            .collect();
        if let Some(state) = state {
            all.extend(calls.iter().map(|it| (*it).to_owned()));
            all.push(format!("{switch}={state}"));
        } else {
            // The same soot, so that only the effect differs.
            all.extend(
                calls
                    .iter()
                    .filter(|it| it.starts_with("soot."))
                    .map(|it| (*it).to_owned()),
            );
        }
        project.set_all(all.iter().map(String::as_str)).ok()?;
        project.job(volume).ok()
    };
    let (Some(plain), Some(off), Some(on)) = (job(None), job(Some("off")), job(Some("on"))) else {
        return println!("  {effect}: cannot be rendered");
    };
    let jobs = [plain, off, on];
    let scenes: Vec<Scene> = jobs.iter().map(|job| job.scene(None)).collect();
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else {
        return println!("  {effect}: no thread");
    };
    let seconds = |i: usize| {
        let begun = Instant::now();
        let frame =
            pool.install(|| render_still(&scenes[i], &jobs[i].settings, &Cancel::never(), &|_| {}));
        std::hint::black_box(frame);
        begun.elapsed().as_secs_f64()
    };
    let mut ratios = [const { Vec::new() }; 3];
    for _ in 0..PAIRS {
        let plain = seconds(0);
        ratios[0].push(seconds(2) / plain);
        let plain = seconds(0);
        ratios[1].push(seconds(1) / plain);
        let plain = seconds(0);
        ratios[2].push(seconds(0) / plain);
    }
    let [on, off, noise] = ratios.map(|mut ratios| {
        ratios.sort_by(f64::total_cmp);
        ratios[PAIRS / 2]
    });
    println!("  {effect:<18} {on:>8.2} {off:>8.3} {noise:>8.3}");
}
