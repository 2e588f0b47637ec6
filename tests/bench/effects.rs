//! What each effect costs when it is on, and that it costs nothing when it is off.
//!
//! ```text
//! cargo bench --bench effects
//! ```
//!
//! Each scene is rendered in turn with one effect on, with it off, and as a scene that never heard of it: emission and
//! absorption alone. Ratios are of wall-clock time of one thread, medians of pairs that follow each other; the last
//! column shows by how much two equal runs differ, which is the noise. With `SOOTLIGHT_SHARED` on a pool fire as well.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use sootlight::project::Project;
use sootlight::render::{Cancel, render_still};
use sootlight::scene::Scene;
use sootlight::volume::{self, BuiltIn, Limits, Volume};

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
];

fn main() {
    let flame = [("built-in flame", Vec::new())];
    let shared = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from);
    let pool = shared.map(|shared| {
        let file = shared.join("data/pool/pool_0022_zip_half.vdb");
        ("pool fire", vec![file])
    });
    for (name, files) in flame.into_iter().chain(pool) {
        let volume = match volume::open_or_built_in(&files, BuiltIn::default(), &Limits::default())
        {
            Ok(volume) => Arc::new(volume),
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        println!("{name}, 512 × 512, one thread; time over that of emission and absorption alone:");
        println!("  {:<18} {:>8} {:>8} {:>8}", "effect", "on", "off", "noise");
        for (effect, calls, switch) in EFFECTS {
            measure(&volume, effect, calls, switch);
        }
    }
}

fn measure(volume: &Arc<Volume>, effect: &str, calls: &[&str], switch: &str) {
    // What stands on a stage is there either way: it is seen, dark, where the fire's light is off.
    let alone = [
        "effects.scattering=off",
        "effects.refraction=off",
        "effects.fire_light=off",
        "effects.chemiluminescence=off",
        "effects.lines=off",
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
