//! How soon a picture answers a slider: from `submit` to the first whole coarse pass, drained, while the picture
//! before it is still being rendered.
//!
//! ```text
//! cargo bench --bench restart
//! ```
//!
//! With `SOOTLIGHT_SHARED` on the standard plume and a pool fire as well. Times of a shared machine vary: compare
//! only what one run printed.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sootlight::engine::{Engine, News, Picture};
use sootlight::project::{Job, Project};
use sootlight::volume::{self, BuiltIn, Limits, Volume, Wanted};

/// How many times the slider moves.
const MOVES: u32 = 60;
/// What the scenes call for beside emission and absorption.
const SCENES: [(&str, &[&str]); 4] = [
    ("", &["effects.scattering=off"]),
    (", scattering", &["effects.scattering=on"]),
    (
        ", backdrop",
        &["effects.scattering=off", "stage.backdrop=checker"],
    ),
    (", ground", &["effects.scattering=off", "stage.ground=true"]),
];
/// Size of the picture.
const SIZE: [u32; 2] = [1280, 720];

fn main() {
    let flame = [("built-in flame", Vec::new())];
    let shared = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from);
    let shared = shared.iter().flat_map(|shared| {
        [
            ("plume", "data/plume/plume.vdb"),
            ("pool fire", "data/pool/pool_0022_zip_half.vdb"),
        ]
        .map(|(name, file)| (name, vec![shared.join(file)]))
    });
    println!(
        "{MOVES} moves of a slider at {} × {}, from submit to the first whole pass:",
        SIZE[0], SIZE[1]
    );
    for (name, files) in flame.into_iter().chain(shared) {
        match volume::open_or_built_in(
            &files,
            BuiltIn::default(),
            &Wanted::default(),
            &Limits::default(),
        ) {
            Ok(volume) => {
                let volume = Arc::new(volume);
                for (what, sets) in SCENES {
                    measure(&format!("{name}{what}"), &volume, sets);
                }
            }
            Err(error) => println!("  {name}: {error}"),
        }
    }
}

fn measure(name: &str, volume: &Arc<Volume>, sets: &[&str]) {
    let mut project = Project::default();
    if let Err(error) = project.set_all(sets.iter().copied()) {
        return println!("  {name}: {error}");
    }
    project.render.size = SIZE;
    let (engine, mut picture) =
        match Engine::new(Engine::threads_beside_a_window(), Box::new(|| {})) {
            Ok(engine) => (engine, Picture::new(SIZE)),
            Err(error) => return println!("  {name}: {error}"),
        };
    let mut times: Vec<f64> = Vec::new();
    for i in 0..MOVES {
        project.soot.amount = 1.0 + 0.01 * f64::from(i);
        let Ok(job) = project.job(volume) else {
            return println!("  {name}: cannot be rendered");
        };
        times.push(first_pass(&engine, &mut picture, job));
        // The next move comes while finer passes run.
        std::thread::sleep(Duration::from_millis(u64::from(i % 5) * 20));
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize];
    println!(
        "  {name:<26} median {:5.1} ms, 90 % {:5.1} ms, 99 % {:5.1} ms, longest {:5.1} ms",
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
}

/// Milliseconds until the picture shows the first pass of this job.
fn first_pass(engine: &Engine, picture: &mut Picture, job: Job) -> f64 {
    let begun = Instant::now();
    engine.submit(job);
    loop {
        let mut whole = false;
        for update in engine.drain() {
            whole |= matches!(update.news, News::PassDone { index: 0, .. });
            picture.take(update);
        }
        if whole {
            return 1e3 * begun.elapsed().as_secs_f64();
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}
