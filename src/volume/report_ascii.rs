//! The ASCII formats: dense (`W H D`, then every value, x fastest, then y, then z) and sparse
//! (`W H D count background`, then lines `x y z value`).
//!
//! Numbers are parted by any white space, so one to a line and many to a line are both read, and so are all
//! three line endings. Both formats carry one field and no voxel size: a voxel is 1 file unit, and the sample
//! of voxel i sits at i + ½.

use std::path::Path;

use glam::{DAffine3, DVec3, IVec3};

use super::build::{GridHead, dense_sample, is_usable};
use super::file_volume::FileVolume;
use super::grid::{Border, Grid};
use super::naming::NamedField;
use super::text::{Text, quote, voxel_count};
use super::watch::Stretch;
use super::{Format, Limits, VolumeError};

/// Fewest bytes of a value in the file: a digit and the space that parts it from the next.
const MIN_BYTES_PER_VALUE: u64 = 2;
/// How many values are read between two looks at the watch.
const VALUES_PER_CHECK: usize = 4096;
/// Shares of the time after reading that parsing takes; the rest is building bricks.
const PARSING_DENSE: f32 = 0.7;
const PARSING_SPARSE: f32 = 0.7;

/// Voxel i sits at i + ½ of the box that begins at the origin.
pub(super) fn centred_voxels() -> DAffine3 {
    DAffine3::from_translation(DVec3::splat(0.5))
}

/// Reads either ASCII format from the contents of a file.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let mut text = Text { path, bytes, at: 0 };
    let mut notes = Vec::new();
    if bytes.starts_with(b"\xef\xbb\xbf") {
        text.at = 3;
        notes.push("a byte order mark before the header was skipped".to_owned());
    }
    let header = text.header()?;
    let mut file = match header.as_slice() {
        [w, h, d] => dense(&mut text, [*w, *h, *d], limits, stretch)?,
        [w, h, d, count, background] => {
            sparse(&mut text, [*w, *h, *d, *count], background, limits, stretch)?
        }
        _ => {
            let found = header.len();
            return Err(text.malformed(
                text.at,
                format!(
                    "expected the header \"width height depth\", found {found} numbers; \
                     write three whole numbers on the first line"
                ),
            ));
        }
    };
    notes.append(&mut file.notes);
    file.notes = notes;
    Ok(file)
}

fn dense(
    text: &mut Text,
    dims: [&[u8]; 3],
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let dims = text.dims(dims, limits)?;
    let count = voxel_count(dims);
    // The announced size is compared with the bytes that are there before anything of that size is allocated.
    let left = (text.bytes.len() - text.at) as u64;
    if left.saturating_add(1) < count.saturating_mul(MIN_BYTES_PER_VALUE) {
        let most = left.div_ceil(MIN_BYTES_PER_VALUE);
        return Err(text.wrong_count(dims, &format!("at most {most}, the file ends there")));
    }
    limits.check_bytes(text.path, "the dense box", count.saturating_mul(4))?;
    let parsing = stretch.part(0.0, PARSING_DENSE);
    let mut values: Vec<f32> = Vec::with_capacity(count as usize);
    while let Some((at, token)) = text.next_token() {
        if values.len().is_multiple_of(VALUES_PER_CHECK) {
            parsing.reach(at as u64, text.bytes.len() as u64)?;
        }
        if values.len() as u64 == count {
            let rest = text.count_tokens(stretch)? + 1;
            return Err(text.wrong_count(dims, &format!("{}", count + rest)));
        }
        values.push(text.number(at, token)?);
    }
    if (values.len() as u64) < count {
        return Err(text.wrong_count(dims, &format!("{}", values.len())));
    }
    let largest = largest_usable(values.iter().copied());
    let field = NamedField::decide(text.path, largest);
    let head = GridHead {
        name: field.name.to_owned(),
        world_from_index: centred_voxels(),
        border: Border::Clamp,
        background: 0.0,
        stored_as: "ascii",
    };
    let building = stretch.part(PARSING_DENSE, 1.0);
    let (grid, tally) = Grid::from_box(head, dims, building, |voxel| {
        dense_sample(&values, dims, voxel).unwrap_or(0.0)
    });
    stretch.check()?;
    let mut notes = vec![field.reason];
    notes.extend(tally.notes(field.name, 0.0));
    Ok(FileVolume::of_one_field(
        text.path,
        Format::DenseAscii,
        grid,
        Some(dims),
        notes,
    ))
}

fn sparse(
    text: &mut Text,
    [w, h, d, count]: [&[u8]; 4],
    background: &[u8],
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let header_at = text.at;
    let dims = text.dims([w, h, d], limits)?;
    let count = text.whole(count, "a count of voxels")?;
    let background = text.number(header_at, background)?;
    // Each record is four numbers.
    let left = (text.bytes.len() - text.at) as u64;
    if left.saturating_add(1) < count.saturating_mul(4 * MIN_BYTES_PER_VALUE) {
        return Err(text.malformed(
            header_at,
            format!("the header announces {count} voxels, but only {left} bytes follow; the file is cut or the count is wrong"),
        ));
    }
    limits.check_bytes(text.path, "the voxel list", count.saturating_mul(16))?;
    let parsing = stretch.part(0.0, PARSING_SPARSE);
    let mut voxels = Vec::with_capacity(count as usize);
    while let Some((at, first)) = text.next_token() {
        if voxels.len().is_multiple_of(VALUES_PER_CHECK) {
            parsing.reach(at as u64, text.bytes.len() as u64)?;
        }
        let mut coordinate = [0i32; 3];
        let mut token = Some((at, first));
        for (axis, c) in coordinate.iter_mut().enumerate() {
            let (at, digits) = token.ok_or_else(|| text.cut_record(at))?;
            *c = std::str::from_utf8(digits)
                .ok()
                .and_then(|digits| digits.parse().ok())
                .filter(|c| (0..dims[axis]).contains(c))
                .ok_or_else(|| {
                    let axis_name = ["x", "y", "z"][axis];
                    let last = dims[axis] - 1;
                    let found = quote(digits);
                    text.malformed(
                        at,
                        format!("expected {axis_name} from 0 to {last}, found {found}"),
                    )
                })?;
            token = text.next_token();
        }
        let (at, digits) = token.ok_or_else(|| text.cut_record(at))?;
        voxels.push((IVec3::from_array(coordinate), text.number(at, digits)?));
        if voxels.len() as u64 > count {
            break;
        }
    }
    if voxels.len() as u64 != count {
        let found = voxels.len() as u64;
        let found = if found > count {
            "more".to_owned()
        } else {
            found.to_string()
        };
        return Err(text.malformed(
            header_at,
            format!("the header announces {count} voxels, found {found}; the file is cut or the count is wrong"),
        ));
    }
    let largest = largest_usable(voxels.iter().map(|(_, value)| *value));
    let field = NamedField::decide(text.path, largest);
    let background = if is_usable(background) {
        background
    } else {
        0.0
    };
    let head = GridHead {
        name: field.name.to_owned(),
        world_from_index: centred_voxels(),
        border: Border::Background,
        background,
        stored_as: "ascii",
    };
    let building = stretch.part(PARSING_SPARSE, 1.0);
    let (grid, tally, repeated) = Grid::from_voxels(head, voxels, text.path, limits, building)?;
    let mut notes = vec![field.reason];
    notes.extend(tally.notes(field.name, background));
    notes.extend(super::build_sparse::repeated_note(repeated));
    Ok(FileVolume::of_one_field(
        text.path,
        Format::SparseAscii,
        grid,
        Some(dims),
        notes,
    ))
}

/// The largest usable value, 0 when there is none.
pub(super) fn largest_usable(values: impl Iterator<Item = f32>) -> f32 {
    let largest = values
        .filter(|value| is_usable(*value))
        .fold(f32::NEG_INFINITY, f32::max);
    if largest.is_finite() { largest } else { 0.0 }
}
