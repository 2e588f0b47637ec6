//! Seeded mutations of small good files. `SOOTLIGHT_FUZZ` sets their number per format.

use std::fs;
use std::time::Instant;

use sootlight::volume::{Limits, Producer, open, summarise};

use super::{hostile, survives_a_render, write};

/// A small random number generator with a fixed sequence (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

#[test]
fn mutated_files_never_panic_and_never_hang() {
    let count = std::env::var("SOOTLIGHT_FUZZ")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(300);
    // Tight limits: what a mutation announces must be refused, not tried.
    let limits = Limits {
        max_bytes: 64 << 20,
        max_extent_bricks: 1 << 16,
    };
    let folder = tempfile::tempdir().unwrap();
    let sparse_ascii = write(
        folder.path(),
        "sparse.txt",
        "9 9 9 3 0\n1 2 3 .5\n4 5 6 7\n8 8 8 1e-3\n",
    );
    let formats = [
        vec![hostile("ascii_good_no_final_newline.txt"), sparse_ascii],
        vec![hostile("sparse_good_27.bin")],
        [
            "good",
            "bgnonzero_blosc",
            "tiles_zip",
            "double",
            "nonuniform",
        ]
        .map(|name| hostile(&format!("vdb_{name}.vdb")))
        .to_vec(),
    ];
    let mut random = Random(0x5007_1197);
    for seeds in &formats {
        let contents: Vec<Vec<u8>> = seeds.iter().map(|path| fs::read(path).unwrap()).collect();
        let mut opened = 0;
        for round in 0..count {
            let mut bytes = contents[round % contents.len()].clone();
            match random.below(4) {
                0 => bytes.truncate(random.below(bytes.len())),
                1 => {
                    let (at, from) = (random.below(bytes.len()), random.below(bytes.len()));
                    let length = random.below(64).min(bytes.len() - at.max(from));
                    bytes.copy_within(from..from + length, at);
                }
                2 => {
                    let (at, length) = (random.below(bytes.len()), random.below(32));
                    let inserted: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
                    bytes.splice(at..at, inserted);
                }
                _ => {
                    // Most flips near the front, where the announcements are.
                    for _ in 0..=random.below(6) {
                        let reach = [64, 700, bytes.len()][random.below(3)].min(bytes.len());
                        let at = random.below(reach);
                        bytes[at] ^= 1 << random.below(8);
                    }
                }
            }
            let path = write(folder.path(), "mutated", &bytes);
            let start = Instant::now();
            let result = open(&[path], &limits);
            assert!(
                start.elapsed().as_secs() < 10,
                "round {round} took {:?}",
                start.elapsed()
            );
            if let Ok(volume) = result {
                opened += 1;
                let _ = summarise(&volume, Producer::Auto);
                survives_a_render(volume, &format!("round {round}"));
            }
        }
        assert!(
            opened < count,
            "every mutation was read as if nothing had happened"
        );
    }
}
