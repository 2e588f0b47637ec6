//! Small good files of every format, and what becomes of them: cut, flipped, spliced, and with headers that promise
//! more than any machine holds. A mutation follows from its format and number alone, so that any can be made again.

use std::fs;

use crate::loading::hostile;

/// A format as it stands on disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    DenseAscii,
    SparseAscii,
    SparseBinary,
    OpenVdb,
}

impl Format {
    pub(super) const ALL: [Self; 4] = [
        Self::DenseAscii,
        Self::SparseAscii,
        Self::SparseBinary,
        Self::OpenVdb,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::DenseAscii => "dense ASCII",
            Self::SparseAscii => "sparse ASCII",
            Self::SparseBinary => "sparse binary",
            Self::OpenVdb => "OpenVDB",
        }
    }

    /// Good files.
    pub(super) fn seeds(self) -> Vec<Vec<u8>> {
        let read = |name: &str| fs::read(hostile(name)).unwrap();
        match self {
            Self::DenseAscii => vec![
                read("ascii_good_no_final_newline.txt"),
                read("ascii_good_constant.txt"),
                b"3 2 2\r\n1e-6 2e-6 0\r\n0 0 .5e-6\r\n1 2 3 4 5 6\r\n".to_vec(),
            ],
            Self::SparseAscii => vec![
                b"9 9 9 3 0\n1 2 3 .5\n4 5 6 7\n8 8 8 1e-3\n".to_vec(),
                b"40 40 40 4 300\n0 0 0 1500\n39 39 39 900\n5 5 5 1200\n5 6 5 2000\n".to_vec(),
            ],
            Self::SparseBinary => vec![
                read("sparse_good_27.bin"),
                read("sparse_negative_coords.bin"),
            ],
            Self::OpenVdb => [
                "good",
                "bgnonzero_blosc",
                "tiles_zip",
                "double",
                "nonuniform",
                "dupnames",
            ]
            .map(|name| read(&format!("vdb_{name}.vdb")))
            .to_vec(),
        }
    }

    /// Writes a number that promises too much, or nothing, where the format says how much there is.
    fn promise(self, bytes: &mut Vec<u8>, random: &mut Random) {
        match self {
            Self::DenseAscii | Self::SparseAscii => promise_in_text(bytes, random),
            Self::SparseBinary => {
                let at = random.pick(&[0, 0, 4, 8, 12]) + 44 * random.below(bytes.len() / 44 + 1);
                let at = if random.below(2) == 0 { 0 } else { at };
                overwrite(bytes, at, &random.pick(&WHOLE).to_le_bytes()[..4]);
            }
            Self::OpenVdb => {
                let reach = random
                    .pick(&[64, 256, 700, 4000, usize::MAX])
                    .min(bytes.len());
                let at = random.below(reach);
                let number = random.pick(&WHOLE).to_le_bytes();
                let length = random.pick(&[4, 8]);
                overwrite(bytes, at, &number[..length]);
            }
        }
    }
}

/// Whole numbers at the ends of what 32 and 64 bits hold, and terabytes.
const WHOLE: [i64; 12] = [
    0,
    -1,
    1,
    i32::MAX as i64,
    i32::MIN as i64,
    u32::MAX as i64,
    1 << 24,
    1 << 31,
    1 << 40,
    1 << 62,
    i64::MAX,
    i64::MIN,
];

/// Words in the place of a number of a header.
const WORDS: [&str; 14] = [
    "0",
    "-1",
    "2147483647",
    "2147483648",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999999",
    "1000000",
    "65536",
    "1e9",
    "1e30",
    "inf",
    "nan",
    "0x10",
];

fn overwrite(bytes: &mut [u8], at: usize, new: &[u8]) {
    for (old, new) in bytes.iter_mut().skip(at).zip(new) {
        *old = *new;
    }
}

/// Puts another word in the place of a number, most often of the header.
fn promise_in_text(bytes: &mut Vec<u8>, random: &mut Random) {
    let numbers: Vec<(usize, usize)> = bytes
        .split(u8::is_ascii_whitespace)
        .scan(0, |at, word| {
            let begin = *at;
            *at += word.len() + 1;
            Some((begin, begin + word.len()))
        })
        .filter(|(begin, end)| begin < end)
        .collect();
    let reach = random.pick(&[3, 5, usize::MAX]).min(numbers.len());
    if let Some(&(begin, end)) = numbers.get(random.below(reach)) {
        bytes.splice(begin..end, random.pick(&WORDS).bytes());
    }
}

/// The mutation of a number.
pub(super) fn mutation(format: Format, seeds: &[Vec<u8>], number: usize) -> Vec<u8> {
    let mut random = Random::new(number as u64 * 4 + format as u64);
    let mut bytes = seeds[random.below(seeds.len())].clone();
    // Two at once come to places that none reaches alone.
    for _ in 0..random.pick(&[1, 1, 1, 2]) {
        mutate(format, seeds, &mut bytes, &mut random);
    }
    bytes
}

fn mutate(format: Format, seeds: &[Vec<u8>], bytes: &mut Vec<u8>, random: &mut Random) {
    let length = bytes.len();
    match random.below(8) {
        0 => bytes.truncate(random.below(length)),
        1 | 2 => format.promise(bytes, random),
        3 => {
            let (at, from) = (random.below(length), random.below(length));
            let count = random.below(64).min(length - at.max(from));
            bytes.copy_within(from..from + count, at);
        }
        4 => {
            let at = random.below(length);
            let inserted: Vec<u8> = (0..random.below(32))
                .map(|_| random.below(256) as u8)
                .collect();
            bytes.splice(at..at, inserted);
        }
        5 => {
            // The beginning of one file and the end of another.
            let other = &seeds[random.below(seeds.len())];
            bytes.truncate(random.below(length));
            bytes.extend(&other[random.below(other.len())..]);
        }
        6 => {
            let at = random.below(length);
            let end = (at + random.below(64)).min(length);
            bytes.drain(at..end);
        }
        _ => {
            // Most flips near the front, where the announcements are.
            for _ in 0..=random.below(6) {
                let reach = random.pick(&[64, 700, usize::MAX]).min(length);
                if reach > 0 {
                    bytes[random.below(reach)] ^= 1 << random.below(8);
                }
            }
        }
    }
}

/// Random numbers of a fixed sequence (xorshift).
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        // Neighbouring seeds are made unlike (the finaliser of splitmix64).
        let mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self((mixed ^ (mixed >> 31)) | 1)
    }

    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 11) % limit.max(1) as u64) as usize
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}
