//! Mutated files never panic, never hang, and never take more memory than the limit allows.
//!
//! Each format is tried in a process of its own, so that its memory can be told, and that a failure to allocate, which
//! no one can catch, is a failed test. 2000 mutations of each are tried at every run; all 100 000 of each by
//!
//! ```sh
//! SOOTLIGHT_MUTATIONS=100000 cargo test --release --test main hostile::mutations -- --nocapture
//! ```
//!
//! | 100 000 of | read | refused | rendered | memory beyond that of the good files |
//! |---|---|---|---|---|
//! | dense ASCII | 13 755 | 86 245 | 1052 | 2 MB |
//! | sparse ASCII | 8366 | 91 634 | 679 | 2 MB |
//! | sparse binary | 18 628 | 81 372 | 1387 | 3 MB |
//! | OpenVDB | 23 689 | 76 311 | 1737 | 120 MB |

use std::fs;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use sootlight::volume::{Limits, Producer, Volume, VolumeError, open, summarise};

use super::mutate::{Format, mutation};
use crate::loading::survives_a_render;

/// Mutations of each format if nothing else is said.
const COUNT: usize = 2000;
/// Of how many one is rendered, if it was read.
const RENDERED: usize = 13;
/// What a mutated file and its grids may cost, MB each.
const LIMIT_MB: f64 = 64.0;
/// What all that was tried may have asked of the system, MB: grids while they are made (up to 1.8 times of what is kept),
/// the reader's trees, and room that the allocator keeps. It counts what is asked for, not what is touched: a terabyte
/// that is never written to is seen.
const MOST_MB: f64 = 3.0 * LIMIT_MB;
/// The same of a file of our own readers, of which none may make more than a block and some bricks: only a tile of an
/// OpenVDB file stands for more voxels than it has bytes.
const MOST_MB_BY_BYTES: f64 = 16.0;
/// No sane machine reads so long at files of some kilobytes.
const PATIENCE: Duration = Duration::from_mins(1);

/// What a process of its own is told by.
const FORMAT: &str = "SOOTLIGHT_MUTATIONS_OF";
const NUMBER: &str = "SOOTLIGHT_MUTATIONS";

fn count() -> usize {
    let number = std::env::var(NUMBER).ok();
    number.and_then(|it| it.parse().ok()).unwrap_or(COUNT)
}

/// Tries a format in a process of its own, and says what it said.
fn try_all(format: Format) {
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "hostile::mutations::in_a_process_of_its_own"])
        .args(["--ignored", "--nocapture"])
        .env(FORMAT, format.name())
        .env(NUMBER, count().to_string())
        // What threads and arenas reserve is not what files ask for.
        .env("RAYON_NUM_THREADS", "2")
        .env("MALLOC_ARENA_MAX", "1")
        .output()
        .unwrap();
    let [said, errors] =
        [output.stdout, output.stderr].map(|it| String::from_utf8_lossy(&it).into_owned());
    let last: Vec<&str> = errors.lines().rev().take(12).collect();
    assert!(
        output.status.success(),
        "{}: {}\n{said}\n{last:#?}",
        format.name(),
        output.status
    );
    let told = said.lines().find(|line| line.contains(" mutations: "));
    let contained = errors.matches("panicked at").count();
    println!(
        "{}, {contained} panics contained",
        told.expect("the process tells what it did")
    );
}

#[test]
fn dense_ascii_is_read_or_refused() {
    try_all(Format::DenseAscii);
}

#[test]
fn sparse_ascii_is_read_or_refused() {
    try_all(Format::SparseAscii);
}

#[test]
fn sparse_binary_is_read_or_refused() {
    try_all(Format::SparseBinary);
}

#[test]
fn openvdb_is_read_or_refused() {
    try_all(Format::OpenVdb);
}

#[test]
#[ignore = "the tests above start it, each for its format"]
fn in_a_process_of_its_own() {
    let Ok(name) = std::env::var(FORMAT) else {
        return;
    };
    let format = Format::ALL.into_iter().find(|format| format.name() == name);
    let format = format.expect("a format");
    let (seeds, folder) = (format.seeds(), tempfile::tempdir().unwrap());
    let path = folder.path().join("mutated");
    let limits = Limits::of_memory_mb(LIMIT_MB);
    let try_one = |bytes: &[u8]| -> Result<Volume, VolumeError> {
        fs::write(&path, bytes).unwrap();
        open(std::slice::from_ref(&path), &limits)
    };
    for seed in &seeds {
        try_one(seed).unwrap_or_else(|error| panic!("a good file is refused: {error}"));
    }
    let before = asked_for_mb();

    let (count, now) = (count(), Arc::new(AtomicUsize::new(0)));
    watch(Arc::clone(&now));
    let mut read = Vec::new();
    for number in 0..count {
        now.store(number, Ordering::Relaxed);
        match try_one(&mutation(format, &seeds, number)) {
            Ok(volume) => {
                let _ = summarise(&volume, Producer::Auto);
                read.push(number);
            }
            Err(error) => {
                let words = error.to_string();
                assert!(words.contains("mutated"), "{number}: no file in {words}");
            }
        }
    }
    let grown = before
        .zip(asked_for_mb())
        .map(|(before, after)| after - before);

    let chosen: Vec<usize> = read.iter().copied().filter(|n| n % RENDERED == 0).collect();
    let mut rendered = 0;
    for &number in &chosen {
        now.store(number, Ordering::Relaxed);
        let volume = try_one(&mutation(format, &seeds, number)).expect("it was read before");
        rendered += usize::from(survives_a_render(volume, &format!("mutation {number}")));
    }
    let most = if format == Format::OpenVdb {
        MOST_MB
    } else {
        MOST_MB_BY_BYTES
    };
    let memory = grown.map_or("not told".to_owned(), |mb| {
        format!("at most {mb:.0} MB more")
    });
    println!(
        "\n{name}, {count} mutations: {} read, {} refused, {rendered} rendered, memory {memory}",
        read.len(),
        count - read.len(),
    );
    assert!(
        grown.is_none_or(|mb| mb <= most),
        "{memory} than before, of {most} MB"
    );
    assert!(
        read.len() < count,
        "every mutation was read as if nothing had happened"
    );
    assert!(
        count < COUNT || (!read.is_empty() && rendered > 0),
        "nothing was read"
    );
}

/// Ends the process if a mutation never comes to an end.
fn watch(now: Arc<AtomicUsize>) {
    std::thread::spawn(move || {
        loop {
            let before = now.load(Ordering::Relaxed);
            std::thread::sleep(PATIENCE);
            if now.load(Ordering::Relaxed) == before {
                eprintln!("mutation {before} hangs");
                std::process::exit(3);
            }
        }
    });
}

/// The most address space that the process has had, MB; `None` where the system does not tell.
fn asked_for_mb() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmPeak:"))?;
    let kib: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib * 1024.0 / 1e6)
}
