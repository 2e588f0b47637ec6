//! The sparse binary format, little-endian: an `i32` count, then for each voxel `x y z` as `i32` and
//! `r g b a` as `f64`, 44 bytes.
//!
//! A density is the red channel, a temperature the largest of red, green and blue; alpha is not used. The
//! format carries neither dimensions nor voxel size: the box is that of the voxels, absent voxels are ambient,
//! and the sample of voxel i sits at i + ½, as in the ASCII formats.

use std::path::Path;

use glam::IVec3;

use super::build::GridHead;
use super::build_sparse::repeated_note;
use super::file_volume::FileVolume;
use super::grid::{Border, Grid};
use super::lattice::MAX_COORDINATE;
use super::naming::NamedField;
use super::report_ascii::{centred_voxels, largest_usable};
use super::watch::Stretch;
use super::{Format, Limits, VolumeError};

const RECORD_BYTES: usize = 44;
/// How many records are read between two looks at the watch.
const RECORDS_PER_CHECK: usize = 4096;
/// Shares of the time after reading at which the largest channel is known, and all voxels are in a list; the rest
/// is building bricks.
const SCANNED: f32 = 0.1;
const LISTED: f32 = 0.3;
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

/// Reads the contents of a file.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let records = records(path, bytes)?;
    limits.check_bytes(path, "the voxel list", records.len() as u64)?;
    // The largest channel says what the file is; which channel is the value depends on that.
    let rgb = |record: &[u8]| [f64_at(record, 12), f64_at(record, 20), f64_at(record, 28)];
    let strongest =
        |record: &[u8]| rgb(record).into_iter().fold(f64::NEG_INFINITY, f64::max) as f32;
    let (scanning, listing) = (stretch.part(0.0, SCANNED), stretch.part(SCANNED, LISTED));
    let reach = |stretch: Stretch, index: usize| {
        if index.is_multiple_of(RECORDS_PER_CHECK) {
            stretch.reach((index * RECORD_BYTES) as u64, records.len() as u64)
        } else {
            Ok(())
        }
    };
    let scanned = records.chunks_exact(RECORD_BYTES).enumerate();
    let scanned = scanned.map_while(|(index, record)| {
        let goes_on = reach(scanning, index).is_ok();
        goes_on.then(|| strongest(record))
    });
    let largest = largest_usable(scanned);
    stretch.check()?;
    let field = NamedField::decide(path, largest);
    let is_temperature = field.name == "temperature";

    let mut voxels = Vec::with_capacity(records.len() / RECORD_BYTES);
    let mut coloured = 0u64;
    for (index, record) in records.chunks_exact(RECORD_BYTES).enumerate() {
        reach(listing, index)?;
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
        coloured += u64::from(red != green || green != blue);
        let value = if is_temperature {
            strongest(record)
        } else {
            red as f32
        };
        voxels.push((IVec3::from_array(voxel), value));
    }

    let background = field.ambient(largest);
    let head = GridHead {
        name: field.name.to_owned(),
        world_from_index: centred_voxels(),
        border: Border::Background,
        background,
        stored_as: "double",
    };
    let building = stretch.part(LISTED, 1.0);
    let (grid, tally, repeated) = Grid::from_voxels(head, voxels, path, limits, building)?;
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

/// The records, after the count was compared with the length of the file.
fn records<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a [u8], VolumeError> {
    let (count_bytes, records) = bytes.split_first_chunk::<4>().ok_or_else(|| {
        malformed(
            path,
            format!(
                "expected a count of 4 bytes, the file has {}; it is cut",
                bytes.len()
            ),
        )
    })?;
    let count = i64::from(i32::from_le_bytes(*count_bytes));
    let swapped = i64::from(i32::from_be_bytes(*count_bytes));
    let length = records.len() as i64;
    if count > 0 && count * RECORD_BYTES as i64 == length {
        return Ok(records);
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
