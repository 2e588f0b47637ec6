//! Memory of processes that open one fire each.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sootlight::engine::{Engine, News, Picture};
use sootlight::project::{Job, Project};
use sootlight::render::Switch;
use sootlight::volume::{self, BRICK_LEN, Limits};

use super::Failure;
use super::fit::{exponent, short};
use super::made::{Fire, Kind};

/// First argument of a process that opens a fire and tells what it took.
const OPEN: &str = "--open-and-tell";
/// The same, with a picture.
const RENDER: &str = "--render-and-tell";
/// The same, with a picture whose light is not bent.
const RENDER_STRAIGHT: &str = "--render-straight-and-tell";
/// Sides of the fires of the table of growth, voxels, and the radius of their columns.
const SIDES: [i32; 4] = [64, 128, 256, 512];
const RADIUS: f64 = 0.2;
/// Side of the fire that each format is read of.
const KIND_SIDE: i32 = 256;
/// A fire that fills 2 % of a large box.
const LARGE: Fire = Fire {
    side: 1024,
    radius: 0.0795,
};
/// Size of its picture, pixels.
const SIZE: [u32; 2] = [1280, 720];

const MB: f64 = 1e6;

/// What a process of its own is to do.
pub(crate) struct Order {
    renders: bool,
    bends: bool,
    paths: Vec<PathBuf>,
}

impl Order {
    /// The order that this process was started with.
    pub(crate) fn of_this_process() -> Option<Self> {
        let mut arguments = std::env::args_os().skip(1);
        let first = arguments.next()?;
        let bends = first == RENDER;
        let renders = bends || first == RENDER_STRAIGHT;
        (renders || first == OPEN).then(|| Self {
            renders,
            bends,
            paths: arguments.map(PathBuf::from).collect(),
        })
    }

    /// Opens and packs, and prints what it took as numbers.
    pub(crate) fn follow(&self) -> Result<(), Failure> {
        let before = Memory::now()?;
        let begun = Instant::now();
        let volume = Arc::new(volume::open(&self.paths, &Limits::default())?);
        let read_s = begun.elapsed().as_secs_f64();
        let read = Memory::now()?;
        let mut project = Project::default();
        project.render.size = SIZE;
        if self.renders && !self.bends {
            project.effects.refraction = Switch::Off;
        }
        let job = project.job(&volume)?;
        let begun = Instant::now();
        let scene = job.scene(None);
        let pack_s = begun.elapsed().as_secs_f64();
        let packed = Memory::now()?;
        let medium = scene.flame.medium();
        let grids = volume.grids.iter();
        // A dense format has no background but 0: of kelvin every brick is stored.
        let bricks = grids.clone().map(|grid| grid.bricks().len()).min();
        let told = [
            read.resident - before.resident,
            read.peak - before.resident,
            grids.map(|grid| grid.bytes() as f64).sum(),
            (bricks.unwrap_or(0) * BRICK_LEN) as f64,
            packed.resident - before.resident,
            packed.peak - before.resident,
            medium.bytes() as f64,
            (medium.occupancy().0 * BRICK_LEN) as f64,
            read_s,
            pack_s,
        ];
        let pictured = if self.renders {
            drop(scene);
            picture(job, &before)?
        } else {
            Vec::new()
        };
        let told: Vec<String> = told.iter().chain(&pictured).map(f64::to_string).collect();
        println!("{}", told.join(" "));
        Ok(())
    }
}

/// Renders as a window does. For the moment when the fields are packed and for every pass: seconds from the submit, and what
/// is resident then and was at most.
fn picture(job: Job, before: &Memory) -> Result<Vec<f64>, Failure> {
    let engine = Engine::new(Engine::threads_beside_a_window(), Box::new(|| {}))?;
    let mut picture = Picture::new(SIZE);
    let begun = Instant::now();
    let mut told = Vec::new();
    engine.submit(job);
    loop {
        for update in engine.drain() {
            match &update.news {
                News::Started { .. } | News::PassDone { .. } => {
                    let now = Memory::now()?;
                    told.extend([
                        begun.elapsed().as_secs_f64(),
                        now.resident - before.resident,
                        now.peak - before.resident,
                    ]);
                }
                News::Finished => return Ok(told),
                News::Failed(words) => return Err(words.clone().into()),
                _ => {}
            }
            picture.take(update);
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// Memory of this process, bytes.
struct Memory {
    resident: f64,
    peak: f64,
}

impl Memory {
    fn now() -> Result<Self, Failure> {
        let status = fs::read_to_string("/proc/self/status")?;
        let of = |name: &str| {
            let line = status.lines().find(|line| line.starts_with(name));
            let number = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
            number
                .map(|kib| 1024.0 * kib)
                .ok_or_else(|| format!("the system does not tell {name}"))
        };
        Ok(Self {
            resident: of("VmRSS")?,
            peak: of("VmHWM")?,
        })
    }
}

/// What a process told.
struct Told {
    numbers: Vec<f64>,
}

impl Told {
    fn of(order: &str, paths: &[PathBuf]) -> Result<Self, Failure> {
        let output = Command::new(std::env::current_exe()?)
            .arg(order)
            .args(paths)
            .output()?;
        let text = String::from_utf8(output.stdout)?;
        if !output.status.success() {
            return Err(text.into());
        }
        let numbers = text
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<_, _>>()?;
        Ok(Self { numbers })
    }

    fn at(&self, index: usize) -> f64 {
        self.numbers.get(index).copied().unwrap_or(f64::NAN)
    }

    /// Voxels of occupied bricks.
    fn voxels(&self) -> f64 {
        self.at(3)
    }

    fn print(&self, name: &str) {
        let voxels = self.voxels();
        let [read, read_peak, grids, packed, packed_peak, medium] =
            [0, 1, 2, 4, 5, 6].map(|i| self.at(i));
        println!(
            "  {name:<14} {:>8.2} | {:>8.1} {:>8.1} {:>8.1} {:>6.2} {:>6.1} | {:>8.1} {:>8.1} {:>8.1} {:>6.2} {:>6.1}",
            voxels / MB,
            grids / MB,
            read / MB,
            read_peak / MB,
            read_peak / grids,
            grids / voxels,
            medium / MB,
            packed / MB,
            packed_peak / MB,
            packed_peak / (grids + medium),
            medium / voxels,
        );
    }
}

impl Told {
    fn print_passes(&self) {
        let moments = self.numbers.get(10..).unwrap_or_default();
        let names = [
            "packed",
            "pass 1/8",
            "pass 1/4",
            "pass 1/2",
            "whole picture",
        ];
        for (name, moment) in names.iter().zip(moments.chunks_exact(3)) {
            let [seconds, resident, peak] = [0, 1, 2].map(|i| moment[i]);
            println!(
                "    {name:<14} after {seconds:>6.2} s, {:>6.0} MB resident, at most {:>6.0} MB",
                resident / MB,
                peak / MB
            );
        }
    }
}

/// The tables of memory.
pub(crate) fn measure() -> Result<(), Failure> {
    if let Err(error) = Memory::now() {
        println!("no memory: {error}");
        return Ok(());
    }
    println!(
        "memory of two fields, MB: what the program counts, what is resident, and the peak, as such and over what is counted;\n  \
         after reading, and after packing; bytes are those counted, a voxel of occupied bricks"
    );
    println!(
        "  {:<14} {:>8} | {:>8} {:>8} {:>8} {:>6} {:>6} | {:>8} {:>8} {:>8} {:>6} {:>6}",
        "",
        "Mvoxels",
        "grids",
        "resident",
        "peak",
        "",
        "bytes",
        "packed",
        "resident",
        "peak",
        "",
        "bytes"
    );
    for kind in Kind::ALL {
        let fire = Fire {
            side: KIND_SIDE,
            radius: RADIUS,
        };
        told_of(&fire, kind, OPEN)?.print(kind.name());
    }
    let mut grown = Vec::new();
    for side in SIDES {
        let fire = Fire {
            side,
            radius: RADIUS,
        };
        let told = told_of(&fire, Kind::OpenVdb, OPEN)?;
        told.print(&format!("{side}³"));
        grown.push(told);
    }
    let against = |index: usize| {
        let points = grown.iter().map(|told| [told.voxels(), told.at(index)]);
        exponent(points)
    };
    println!(
        "  against voxels of occupied bricks: grids ^ {:.2}, packed ^ {:.2}, resident ^ {:.2}, peak ^ {:.2}, reading ^ {:.2}, packing ^ {:.2}",
        against(2),
        against(6),
        against(4),
        against(5),
        against(8),
        against(9)
    );
    let folder = tempfile::tempdir()?;
    let paths = LARGE.write_both(Kind::OpenVdb, folder.path())?;
    let told = Told::of(RENDER, &paths)?;
    told.print(&format!("{}³", LARGE.side));
    let share = 100.0 * told.voxels() / f64::from(LARGE.side).powi(3);
    println!(
        "  {}³, {} % occupied, read in {:.2} s; then at {} × {}, packing included:",
        LARGE.side,
        short(share),
        told.at(8),
        SIZE[0],
        SIZE[1]
    );
    told.print_passes();
    println!("  the same with light that is not bent:");
    Told::of(RENDER_STRAIGHT, &paths)?.print_passes();
    Ok(())
}

/// What a process tells of a fire in one format.
fn told_of(fire: &Fire, kind: Kind, order: &str) -> Result<Told, Failure> {
    let folder = tempfile::tempdir()?;
    let paths = fire.write_both(kind, folder.path() as &Path)?;
    Told::of(order, &paths)
}
