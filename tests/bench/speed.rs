//! How long a picture of the standard plume takes at which error, and how near the march comes to what the processor can do.
//!
//! ```text
//! SOOTLIGHT_SHARED=… cargo bench --bench speed
//! ```
//!
//! 512 × 512, one ray through the middle of each pixel, two threads, emission and absorption only. All that is compared is
//! timed by turns within one run, and medians are printed. Times of a shared machine vary: compare ratios, and of one run
//! only.
//!
//! * `march`: from a plan to a film. `all`: the plan, its tables and the march; the file is loaded and its fields are packed.
//! * `plain`: the same rule without what makes the march quick: every ray through the whole box, the same step everywhere,
//!   32 plain wavelengths, from a dense grid; the march's own exponential and lanes.
//! * `even steps`: the plain kernel's error at as many wavelengths as the march takes, on real fires.
//! * `limit`: the march's exponentials, products and fetches from one brick in the first cache, without a way to walk.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use sootlight::project::Project;
use sootlight::render::{Cancel, Effects, Frame, Plan, Settings, Switch, render_planned};
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::spectral::Wavelengths;
use sootlight::volume::{self, Limits};

mod kernels;

use kernels::{Dense, Limit};

/// Side of the picture, pixels.
const SIDE: u32 = 512;
/// Side of the picture that the page of the plume has a reference for.
const REFERENCE_SIDE: u32 = 128;
/// Worker threads.
const THREADS: usize = 2;
/// How often each is timed.
const ROUNDS: usize = 9;
/// Nominal steps, voxels.
const STEPS: [f64; 4] = [4.0, 2.0, 1.0, 0.5];
/// Step of our own reference, voxels.
const FINE_STEP: f64 = 0.125;
/// A step so long that nearly all time is spent on finding bricks.
const LONG_STEP: f64 = 64.0;
/// Real fires on which steps are compared, and the side of their pictures, pixels.
const FILES: [&str; 3] = [
    "pool/pool_0022_zip_half.vdb",
    "embergen_cc0/embergen_fire_a_60.vdb",
    "campfire/campfire_0022_zip_half.vdb",
];
const FILE_SIDE: u32 = 256;
/// Wavelengths of the plain kernel.
const PLAIN: WavelengthSet = WavelengthSet::Plain(32);

fn main() {
    let Some(shared) = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from) else {
        return println!("SOOTLIGHT_SHARED names no folder with the standard plume");
    };
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build() else {
        return println!("no threads");
    };
    let data = shared.join("data");
    let done = pool.install(|| {
        measure(&data.join("plume"))?;
        FILES
            .iter()
            .try_for_each(|file| compare_steps(&data.join(file)))
    });
    if let Err(error) = done {
        println!("{error}");
    }
}

/// Why nothing can be measured.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// X, Y, Z of all pixels.
type Picture = Vec<f64>;

/// What a reference and a picture differ by: the root of the sum of squares over that of the reference.
fn error(picture: &[f64], reference: &[f64]) -> f64 {
    let squares: f64 = picture
        .iter()
        .zip(reference)
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    (squares / reference.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

fn xyz(frame: &Frame) -> Picture {
    let pixels = frame.film.pixels().iter();
    pixels.flat_map(|pixel| pixel.xyz.map(f64::from)).collect()
}

/// Wall-clock milliseconds of every round of one candidate.
#[derive(Default)]
struct Times(Vec<f64>);

impl Times {
    fn add<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let result = std::hint::black_box(work());
        self.0.push(1e3 * begun.elapsed().as_secs_f64());
        result
    }

    fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }
}

/// One row of the table.
struct Row {
    name: String,
    settings: Settings,
    times: [Times; 2],
    samples: u64,
    error: f64,
}

impl Row {
    fn print(&self) {
        let [alone, all] = self.times.each_ref().map(Times::median);
        println!(
            "  {:<18} {:>6} {alone:>10.1} {all:>10.1} {:>9.4} {:>10} {:>12.1}",
            self.name,
            self.settings.step_voxels,
            1e2 * self.error,
            self.samples,
            1e6 * THREADS as f64 * alone / self.samples as f64
        );
    }
}

fn march(scene: &Scene, plan: &Plan, settings: &Settings) -> Option<Frame> {
    render_planned(scene, plan, settings, &Cancel::never(), &|_| {})
}

/// What of a scene is computed: what soot itself gives, at one sample a pixel.
fn settings(of: Settings, step_voxels: f64, wavelengths: WavelengthSet) -> Settings {
    Settings {
        step_voxels,
        wavelengths,
        samples_per_pixel: 1,
        effects: Effects {
            scattering: Switch::Off,
            refraction: Switch::Off,
            wavelengths: Switch::Off,
            ..Effects::AUTO
        },
        ..of
    }
}

fn picture(scene: &Scene, settings: &Settings) -> Picture {
    let plan = Plan::new(scene, settings);
    march(scene, &plan, settings).map_or(Vec::new(), |frame| xyz(&frame))
}

/// A file's scene with a square picture, and its settings.
fn open(file: &Path, mut project: Project, side: u32) -> Result<(Scene, Settings), Failure> {
    project.render.size = [side; 2];
    let volume = volume::open(&[file.to_path_buf()], &Limits::default())?;
    let job = project.job(&Arc::new(volume))?;
    Ok((job.scene(None), job.settings))
}

/// The table of the plume.
fn measure(folder: &Path) -> Result<(), Failure> {
    let scene_file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/plume.toml");
    let project = Project::read(&scene_file)?;
    let (scene, base) = open(&folder.join("plume.vdb"), project, SIDE)?;

    // The references, and how far apart they are.
    let fine = settings(base, FINE_STEP, WavelengthSet::Plain(64));
    let reference = picture(&scene, &fine);
    let theirs: Picture = std::fs::read(folder.join("reference_128_xyz.f32"))?
        .chunks_exact(4)
        .filter_map(|bytes| bytes.try_into().ok())
        .map(|bytes| f64::from(f32::from_le_bytes(bytes)))
        .collect();
    let small = picture(
        &scene,
        &Settings {
            size: [REFERENCE_SIDE; 2],
            ..fine
        },
    );
    println!(
        "standard plume, {SIDE} × {SIDE}, {THREADS} threads; our reference at {REFERENCE_SIDE}² is within {:.4} % of the file's",
        1e2 * error(&small, &theirs)
    );

    // The march, the plain kernel and the limit, by turns.
    let mut rows: Vec<Row> = [4, 6, 8]
        .into_iter()
        .flat_map(|count| STEPS.map(|step| (count, step)))
        .map(|(count, step)| Row {
            name: format!("march, {count} fitted"),
            settings: settings(base, step, WavelengthSet::Fitted(count)),
            times: Default::default(),
            samples: 0,
            error: 0.0,
        })
        .collect();
    let dense = Dense::new(&scene);
    let plain_tables = Plan::new(&scene, &settings(base, 1.0, PLAIN)).tables;
    let mut plain = STEPS.map(|step| (step, Times::default(), 0.0));
    let mut parts = Parts::new(&scene, settings(base, 2.0, WavelengthSet::Fitted(6)));
    for round in 0..ROUNDS {
        for row in &mut rows {
            let settings = &row.settings;
            let plan = Plan::new(&scene, settings);
            let [alone, all] = &mut row.times;
            let frame = alone.add(|| march(&scene, &plan, settings));
            if let Some(frame) = frame {
                row.samples = frame.samples;
                row.error = error(&xyz(&frame), &reference);
            }
            all.add(|| march(&scene, &Plan::new(&scene, settings), settings));
        }
        parts.add(&scene);
        // Slow: less often.
        if round % 3 == 1 {
            for (step, times, off) in &mut plain {
                let film = times.add(|| dense.march(&scene, &plain_tables, SIDE, *step));
                *off = error(&film, &reference);
            }
        }
    }

    println!(
        "  {:<18} {:>6} {:>10} {:>10} {:>9} {:>10} {:>12}",
        "", "step", "march ms", "all ms", "error %", "samples", "ns a sample"
    );
    for row in &rows {
        row.print();
    }
    for (step, times, off) in &plain {
        println!(
            "  {:<18} {step:>6} {:>10.1} {:>10} {:>9.4}",
            "plain, 32",
            times.median(),
            "",
            1e2 * off
        );
    }
    parts.print();
    Ok(())
}

/// The same step everywhere against steps that follow the fire, on a file: errors of the steps alone.
fn compare_steps(file: &Path) -> Result<(), Failure> {
    let (scene, base) = open(file, Project::default(), FILE_SIDE)?;
    let set = WavelengthSet::Fitted(6);
    let reference = picture(&scene, &settings(base, FINE_STEP, set));
    let dense = Dense::new(&scene);
    println!(
        "{}, {FILE_SIDE} × {FILE_SIDE}:",
        file.file_name().unwrap_or_default().display()
    );
    println!(
        "  {:>6} {:>10} {:>10} {:>14}",
        "step", "samples", "error %", "even steps, %"
    );
    for step in STEPS {
        let settings = settings(base, step, set);
        let plan = Plan::new(&scene, &settings);
        let Some(frame) = march(&scene, &plan, &settings) else {
            continue;
        };
        let even = dense.march(&scene, &plan.tables, FILE_SIDE, step);
        println!(
            "  {step:>6} {:>10} {:>10.4} {:>14.4}",
            frame.samples,
            1e2 * error(&xyz(&frame), &reference),
            1e2 * error(&even, &reference)
        );
    }
    Ok(())
}

/// What the parts of a march take.
struct Parts {
    settings: Settings,
    plans: [Plan; 2],
    limit: Limit,
    samples: [u64; 2],
    /// Of all, without light, without light and nearly without samples, of the limit.
    times: [Times; 4],
}

impl Parts {
    fn new(scene: &Scene, settings: Settings) -> Self {
        let plan = Plan::new(scene, &settings);
        Self {
            limit: Limit::new(&plan.tables),
            plans: [
                plan,
                Plan::with_wavelengths(scene, settings.size, no_wavelengths()),
            ],
            settings,
            samples: [0; 2],
            times: Default::default(),
        }
    }

    fn add(&mut self, scene: &Scene) {
        let long = Settings {
            step_voxels: LONG_STEP,
            ..self.settings
        };
        let [plan, nothing] = &self.plans;
        let frame = self.times[0].add(|| march(scene, plan, &self.settings));
        self.samples[0] = frame.map_or(0, |frame| frame.samples);
        self.times[1].add(|| march(scene, nothing, &self.settings));
        self.times[2].add(|| march(scene, nothing, &long));
        self.samples[1] = self.times[3].add(|| self.limit.run());
    }

    fn print(&self) {
        let [all, no_light, ways, alone] = self.times.each_ref().map(Times::median);
        // Millions a second.
        let rate = |samples: u64, ms: f64| samples as f64 / ms / 1e3;
        let [march, limit] = [rate(self.samples[0], all), rate(self.samples[1], alone)];
        println!(
            "  where it goes at a step of 2, 6 wavelengths: ways {:.1} ms, fetching {:.1} ms, spectrum {:.1} ms of {all:.1} ms",
            ways,
            no_light - ways,
            all - no_light
        );
        println!(
            "  limit {limit:.1} million samples a second, march {march:.1} ({:.2} of it; {:.2} without the ways)",
            march / limit,
            rate(self.samples[0], all - ways) / limit
        );
    }
}

/// No wavelength at all: what is left of a march is finding its way and fetching.
fn no_wavelengths() -> Wavelengths {
    Wavelengths {
        nodes_nm: Vec::new(),
        xyz: Vec::new(),
        opacity: Vec::new(),
    }
}
