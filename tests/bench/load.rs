//! How soon a file is a picture, and how many bytes a second each reader takes.
//!
//! ```text
//! SOOTLIGHT_SHARED=… cargo bench --bench load
//! ```
//!
//! Files lie in the system's memory (each was just written or read). All that is compared is timed by turns within one
//! run, and medians are printed. Times of a shared machine vary: compare ratios, and of one run only.
//!
//! * first picture: from a path to the first whole pass of a window of 1280 × 720, as a person sees it; and to the last.
//! * readers: bytes of the file over the time to have its grids, with one thread and with two.
//! * `numbers alone`: what fast-float2 takes for the same numbers, found already, with one thread: a bound for any reader
//!   of text.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use sootlight::engine::{Engine, News, Picture};
use sootlight::project::Project;
use sootlight::volume::{self, Limits};

mod made;

use made::{Field, Fire, Kind};

/// Why nothing can be measured.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// How often each is timed.
const ROUNDS: usize = 9;
/// Size of the window's picture, pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Voxels along an axis of the files that are made.
const SIDE: i32 = 160;
/// Radius of the column in files that are mostly air.
const RADIUS: f64 = 0.2;

fn main() {
    let shared = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from);
    let pool_fire = shared.map(|shared| shared.join("data/pool/pool_0022_zip_half.vdb"));
    if pool_fire.is_none() {
        println!(
            "SOOTLIGHT_SHARED names no folder with a pool fire: only files that are made here are read"
        );
    }
    let first = pool_fire.as_deref().map_or(Ok(()), time_first_picture);
    if let Err(error) = first.and_then(|()| time_readers(pool_fire.as_deref())) {
        println!("{error}");
    }
}

/// Milliseconds since a moment.
fn ms_since(begun: Instant) -> f64 {
    1e3 * begun.elapsed().as_secs_f64()
}

fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The moments on the way from a path to the last pass of its picture.
fn time_first_picture(file: &Path) -> Result<(), Failure> {
    let mut moments: [Vec<f64>; 5] = Default::default();
    for _ in 0..ROUNDS {
        let begun = Instant::now();
        let mut reached = [f64::NAN; 5];
        let volume = Arc::new(volume::open(&[file.to_path_buf()], &Limits::default())?);
        reached[0] = ms_since(begun);
        let mut project = Project::default();
        project.render.size = SIZE;
        let job = project.job(&volume)?;
        reached[1] = ms_since(begun);
        let engine = Engine::new(Engine::threads_beside_a_window(), Box::new(|| {}))?;
        let mut picture = Picture::new(SIZE);
        engine.submit(job);
        while reached[4].is_nan() {
            for update in engine.drain() {
                match &update.news {
                    News::Started { .. } => reached[2] = ms_since(begun),
                    News::PassDone { index: 0, .. } => reached[3] = ms_since(begun),
                    News::Finished => reached[4] = ms_since(begun),
                    News::Failed(words) => return Err(words.clone().into()),
                    _ => {}
                }
                picture.take(update);
            }
            std::thread::sleep(Duration::from_micros(200));
        }
        for (all, one) in moments.iter_mut().zip(reached) {
            all.push(one);
        }
    }
    let name = file.file_name().unwrap_or_default().display();
    println!(
        "{name} at {} × {}, milliseconds after its path was given:",
        SIZE[0], SIZE[1]
    );
    let names = ["read", "checked", "packed", "first pass", "whole picture"];
    for (name, times) in names.into_iter().zip(&moments) {
        let longest = times.iter().copied().fold(0.0, f64::max);
        println!("  {name:<16} {:>8.1}   longest {longest:.1}", median(times));
    }
    Ok(())
}

/// A case of the table of readers.
struct Case {
    name: String,
    paths: Vec<PathBuf>,
    /// With one thread, and with two.
    times: [Vec<f64>; 2],
    /// Text alone: what its numbers take.
    numbers: Vec<f64>,
}

impl Case {
    fn new(name: &str, paths: Vec<PathBuf>) -> Self {
        Self {
            name: name.to_owned(),
            paths,
            times: Default::default(),
            numbers: Vec::new(),
        }
    }

    fn megabytes(&self) -> f64 {
        let length = |path: &PathBuf| std::fs::metadata(path).map_or(0, |about| about.len());
        1e-6 * self.paths.iter().map(length).sum::<u64>() as f64
    }

    fn add(&mut self, pools: &[ThreadPool; 2]) -> Result<(), Failure> {
        for (pool, times) in pools.iter().zip(&mut self.times) {
            let begun = Instant::now();
            let volume = pool.install(|| volume::open(&self.paths, &Limits::default()))?;
            times.push(ms_since(begun));
            drop(black_box(volume));
        }
        Ok(())
    }

    /// Times the numbers of a text alone.
    fn add_numbers(&mut self) -> Result<(), Failure> {
        let mut took = 0.0;
        for path in &self.paths {
            let bytes = std::fs::read(path)?;
            let tokens: Vec<&[u8]> = bytes
                .split(u8::is_ascii_whitespace)
                .filter(|token| !token.is_empty())
                .collect();
            let begun = Instant::now();
            let mut sum = 0.0;
            for token in tokens {
                sum += fast_float2::parse::<f32, _>(token)?;
            }
            black_box(sum);
            took += ms_since(begun);
        }
        self.numbers.push(took);
        Ok(())
    }

    fn print(&self) {
        let size = self.megabytes();
        let [one, two] = self.times.each_ref().map(|times| median(times));
        let rate = |ms: f64| 1e3 * size / ms;
        let bound = if self.numbers.is_empty() {
            String::new()
        } else {
            format!("{:.0}", rate(median(&self.numbers)))
        };
        println!(
            "  {:<28} {size:>8.1} {one:>10.1} {two:>10.1} {:>8.0} {:>8.0} {bound:>10}",
            self.name,
            rate(one),
            rate(two),
        );
    }
}

/// The table of readers.
fn time_readers(pool_fire: Option<&Path>) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let (full, column) = (
        Fire::full(SIDE),
        Fire {
            side: SIDE,
            radius: RADIUS,
        },
    );
    let make = |name: &str, fire: &Fire, kind: Kind, fields: &[Field]| {
        let paths = fields.iter().enumerate().map(|(i, &field)| {
            let path = folder.path().join(format!("{name} {i} {}", field.name()));
            fire.write(kind, field, &path)?;
            Ok(path)
        });
        Ok::<_, Failure>(Case::new(name, paths.collect::<Result<_, Failure>>()?))
    };
    let (soot, both) = (&Field::BOTH[..1], &Field::BOTH[..]);
    let mut cases = vec![
        make("dense ASCII", &full, Kind::DenseAscii, soot)?,
        make("dense ASCII, mostly air", &column, Kind::DenseAscii, soot)?,
        make("two of dense ASCII", &full, Kind::DenseAscii, both)?,
        make("sparse ASCII", &column, Kind::SparseAscii, soot)?,
    ];
    let of_text = cases.len();
    cases.push(make("sparse binary", &column, Kind::SparseBinary, soot)?);
    cases.push(make("OpenVDB, two fields", &column, Kind::OpenVdb, soot)?);
    cases.extend(pool_fire.map(|file| Case::new("OpenVDB, pool fire", vec![file.to_owned()])));

    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [pool(1)?, pool(2)?];
    for _ in 0..ROUNDS {
        for (i, case) in cases.iter_mut().enumerate() {
            case.add(&pools)?;
            if i < of_text {
                case.add_numbers()?;
            }
        }
    }
    println!("readers, {SIDE}³ voxels where not from a real fire:");
    println!(
        "  {:<28} {:>8} {:>10} {:>10} {:>8} {:>8} {:>10}",
        "", "MB", "ms, 1", "ms, 2", "MB/s, 1", "MB/s, 2", "numbers"
    );
    cases.iter().for_each(Case::print);
    Ok(())
}
