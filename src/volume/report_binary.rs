//! The sparse binary format, little-endian: an `i32` count, then for each voxel `x y z` as `i32` and
//! `r g b a` as `f64`, 44 bytes.
//!
//! A density is the red channel, a temperature the largest of red, green and blue; alpha is not used. The
//! format carries neither dimensions nor voxel size: the box is that of the voxels, absent voxels are ambient,
//! and the sample of voxel i sits at i + ½, as in the ASCII formats.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use glam::IVec3;
use rayon::prelude::*;

use super::build::{GridHead, is_usable};
use super::build_sparse::{Sorted, Voxels, repeated_note};
use super::file_volume::FileVolume;
use super::grid::{Border, Grid};
use super::lattice::MAX_COORDINATE;
use super::naming::NamedField;
use super::report_ascii::centred_voxels;
use super::watch::Stretch;
use super::{Format, Limits, VolumeError};

const RECORD_BYTES: usize = 44;
/// Bytes of the count before them.
const COUNT_BYTES: u64 = 4;
/// Bytes that one thread reads between two looks at the watch: 745 records.
const PIECE_BYTES: usize = 745 * RECORD_BYTES;
/// Bytes that are in memory at once.
const BLOCK_BYTES: u64 = 128 * PIECE_BYTES as u64;
/// Shares of the time at which the largest channel is known, and all voxels are in their bricks' places; the rest is
/// making bricks of them.
const SCANNED: f32 = 0.2;
const LISTED: f32 = 0.9;
/// Share of a block's time after which its records are read.
const RECORDS_READ: f32 = 0.5;
/// Records as other programs write them by mistake: with the mistake's name.
const WRONG_RECORDS: [(i64, &str); 3] = [
    (28, "colours as 4-byte floats"),
    (48, "4 bytes of padding before the colours"),
    (24, "three 4-byte colours"),
];

/// Length of the file that the count in its first bytes announces.
pub(super) fn announced_length(head: &[u8]) -> Option<u64> {
    let count = i32::from_le_bytes(*head.first_chunk()?);
    let count = u64::try_from(count).ok().filter(|count| *count > 0)?;
    Some(4 + count * RECORD_BYTES as u64)
}

/// Reads a file of about `length` bytes.
pub(super) fn read(
    path: &Path,
    file: File,
    length: u64,
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let mut records = Records::open(path, file, length)?;
    limits.check_bytes(path, "the voxel list", records.length)?;
    // The largest channel says what the file is; which channel is the value depends on that. So the file is read twice,
    // and no list of its voxels is kept.
    let scanning = stretch.part(0.0, SCANNED);
    let mut largest = f32::NEG_INFINITY;
    records.for_each_block(scanning, |_, block, scanning| {
        let counter = scanning.counter(block.len().div_ceil(PIECE_BYTES));
        let pieces = block.par_chunks(PIECE_BYTES).map(|piece| {
            let records = if counter.goes_on() { piece } else { &[] };
            let strongest = records.chunks_exact(RECORD_BYTES).map(strongest);
            strongest
                .filter(|value| is_usable(*value))
                .fold(f32::NEG_INFINITY, f32::max)
        });
        largest = pieces.reduce(|| f32::NEG_INFINITY, f32::max).max(largest);
        scanning.check()
    })?;
    let largest = if largest.is_finite() { largest } else { 0.0 };
    let field = NamedField::decide(path, largest);
    let is_temperature = field.name == "temperature";

    let mut voxels = Voxels::new(limits);
    let mut coloured = 0u64;
    records.for_each_block(stretch.part(SCANNED, LISTED), |first, block, listing| {
        let reading = listing.part(0.0, RECORDS_READ);
        let counter = reading.counter(block.len().div_ceil(PIECE_BYTES));
        let parts: Vec<Result<Part, VolumeError>> = block
            .par_chunks(PIECE_BYTES)
            .enumerate()
            .map(|(i, piece)| {
                let first = first + (i * (PIECE_BYTES / RECORD_BYTES)) as u64;
                let records = if counter.goes_on() { piece } else { &[] };
                read_piece(path, records, first, is_temperature)
            })
            .collect();
        reading.check()?;
        let parts = parts.into_iter().collect::<Result<Vec<Part>, _>>()?;
        coloured += parts.iter().map(|part| part.coloured).sum::<u64>();
        let sorted: Vec<Sorted> = parts.into_iter().map(|part| part.voxels).collect();
        voxels.add(&sorted, listing.part(RECORDS_READ, 1.0))
    })?;
    drop(records);

    let background = field.ambient(largest);
    let head = GridHead {
        name: field.name.to_owned(),
        world_from_index: centred_voxels(),
        border: Border::Background,
        background,
        stored_as: "double",
    };
    let building = stretch.part(LISTED, 1.0);
    let (gathered, repeated) = voxels.into_bricks(background, path, limits, building)?;
    let (grid, tally) = Grid::from_gathered(head, gathered);
    stretch.reach(1, 1)?;
    let mut notes = vec![field.reason];
    if coloured > 0 {
        let channel = if is_temperature {
            "the largest channel"
        } else {
            "red"
        };
        notes.push(format!(
            "red, green and blue differ in {coloured} voxels: {channel} was taken"
        ));
    }
    if is_temperature {
        notes.push(format!(
            "absent voxels are ambient, taken as {background} K"
        ));
    }
    notes.extend(tally.notes(field.name, background));
    notes.extend(repeated_note(repeated));
    Ok(FileVolume::of_one_field(
        path,
        Format::SparseBinary,
        grid,
        None,
        notes,
    ))
}

/// What some records hold.
struct Part {
    voxels: Sorted,
    /// Voxels whose channels differ.
    coloured: u64,
}

/// Reads records, of which the first is the `first` of the file.
fn read_piece(
    path: &Path,
    records: &[u8],
    first: u64,
    is_temperature: bool,
) -> Result<Part, VolumeError> {
    let mut part = Part {
        voxels: Sorted::default(),
        coloured: 0,
    };
    for (index, record) in (first..).zip(records.chunks_exact(RECORD_BYTES)) {
        let voxel = [0, 4, 8].map(|at| i32_at(record, at));
        if voxel.iter().any(|c| i64::from(*c).abs() > MAX_COORDINATE) {
            let [x, y, z] = voxel;
            return Err(malformed(
                path,
                format!(
                    "record {index}: expected coordinates within ±{MAX_COORDINATE}, found {x} {y} {z}; \
                     the records are not 44 bytes of x y z (i32) r g b a (f64), or the file is damaged"
                ),
            ));
        }
        let [red, green, blue] = rgb(record);
        part.coloured += u64::from(red != green || green != blue);
        let value = if is_temperature {
            strongest(record)
        } else {
            red as f32
        };
        part.voxels.push(IVec3::from_array(voxel), value);
    }
    Ok(part)
}

fn rgb(record: &[u8]) -> [f64; 3] {
    [12, 20, 28].map(|at| f64_at(record, at))
}

fn strongest(record: &[u8]) -> f32 {
    rgb(record).into_iter().fold(f64::NEG_INFINITY, f64::max) as f32
}

/// The records of a file whose count was compared with its length.
struct Records<'a> {
    path: &'a Path,
    file: File,
    /// Bytes of all records.
    length: u64,
}

impl<'a> Records<'a> {
    fn open(path: &'a Path, mut file: File, length: u64) -> Result<Self, VolumeError> {
        let io = |source| VolumeError::Io {
            path: path.to_owned(),
            source,
        };
        file.rewind().map_err(io)?;
        let mut count = Vec::new();
        (&mut file)
            .take(COUNT_BYTES)
            .read_to_end(&mut count)
            .map_err(io)?;
        let length = check_count(path, &count, length)?;
        Ok(Self { path, file, length })
    }

    /// Visits all records block by block, with the number of the block's first.
    fn for_each_block<'s>(
        &mut self,
        stretch: Stretch<'s>,
        mut visit: impl FnMut(u64, &[u8], Stretch<'s>) -> Result<(), VolumeError>,
    ) -> Result<(), VolumeError> {
        let io = |source| VolumeError::Io {
            path: self.path.to_owned(),
            source,
        };
        self.file.seek(SeekFrom::Start(COUNT_BYTES)).map_err(io)?;
        let share = |at: u64| at as f32 / self.length as f32;
        let mut block = Vec::new();
        let mut begin = 0;
        while begin < self.length {
            stretch.check()?;
            let end = self.length.min(begin + BLOCK_BYTES);
            block.resize((end - begin) as usize, 0);
            self.file.read_exact(&mut block).map_err(io)?;
            let of_block = stretch.part(share(begin), share(end));
            visit(begin / RECORD_BYTES as u64, &block, of_block)?;
            begin = end;
        }
        Ok(())
    }
}

/// The bytes of all records, after the count in the first bytes was compared with the length of the file.
fn check_count(path: &Path, count: &[u8], length: u64) -> Result<u64, VolumeError> {
    let count_bytes = count.first_chunk::<4>().ok_or_else(|| {
        let found = count.len();
        malformed(
            path,
            format!("expected a count of 4 bytes, the file has {found}; it is cut"),
        )
    })?;
    let count = i64::from(i32::from_le_bytes(*count_bytes));
    let swapped = i64::from(i32::from_be_bytes(*count_bytes));
    let length = length.saturating_sub(COUNT_BYTES) as i64;
    if count > 0 && count * RECORD_BYTES as i64 == length {
        return Ok(length as u64);
    }
    let guess = if swapped > 0 && swapped * RECORD_BYTES as i64 == length {
        "it looks big-endian: write it little-endian".to_owned()
    } else if let Some((size, mistake)) = WRONG_RECORDS
        .iter()
        .find(|(size, _)| count > 0 && count * size == length)
    {
        format!(
            "its records look {size} bytes long ({mistake}): write x y z as i32 and r g b a as f64, packed"
        )
    } else if count <= 0 {
        "it is damaged, or not a volume".to_owned()
    } else {
        "it is cut, damaged, or not a volume".to_owned()
    };
    Err(malformed(
        path,
        format!(
            "expected a sparse binary volume: the count {count} announces {} bytes of records, {length} follow; {guess}",
            count.max(0) * RECORD_BYTES as i64
        ),
    ))
}

fn malformed(path: &Path, message: String) -> VolumeError {
    VolumeError::Malformed {
        path: path.to_owned(),
        line: None,
        message,
    }
}

/// Callers pass offsets within a record of `RECORD_BYTES`.
fn i32_at(record: &[u8], at: usize) -> i32 {
    record[at..]
        .first_chunk()
        .map_or(0, |bytes| i32::from_le_bytes(*bytes))
}

fn f64_at(record: &[u8], at: usize) -> f64 {
    record[at..]
        .first_chunk()
        .map_or(0.0, |bytes| f64::from_le_bytes(*bytes))
}
