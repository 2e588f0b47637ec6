//! The ASCII formats: dense (`W H D`, then every value, x fastest, then y, then z) and sparse
//! (`W H D count background`, then lines `x y z value`).
//!
//! Numbers are parted by any white space, so one to a line and many to a line are both read, and so are all
//! three line endings. Both formats carry one field and no voxel size: a voxel is 1 file unit, and the sample
//! of voxel i sits at i + ½.
//!
//! A file is read block by block, and bricks are made as soon as their voxels are there: beside the grid there is
//! never more in memory than a block of text and one layer of bricks.

use std::fs::File;
use std::path::Path;

use glam::{DAffine3, DVec3, IVec3};

use super::build::{GridHead, is_usable};
use super::file_volume::FileVolume;
use super::grid::{Border, Grid};
use super::naming::NamedField;
use super::text::{Text, voxel_count};
use super::text_blocks::Blocks;
use super::watch::Stretch;
use super::{Format, Limits, VolumeError};
use super::{text_dense, text_sparse};

/// Fewest bytes of a value in the file: a digit and the space that parts it from the next.
const MIN_BYTES_PER_VALUE: u64 = 2;
/// Share of the time after which all bricks are made; the rest is putting them in order.
const BRICKS_MADE: f32 = 0.98;

/// Voxel i sits at i + ½ of the box that begins at the origin.
pub(super) fn centred_voxels() -> DAffine3 {
    DAffine3::from_translation(DVec3::splat(0.5))
}

/// What the first line says.
struct Header {
    dims: IVec3,
    /// Where the line ends.
    end: usize,
    /// How many voxels are listed, and what the others are; `None` where all are there.
    list: Option<(u64, f32)>,
}

/// Reads either ASCII format from a file of about `length` bytes.
pub(super) fn read(
    path: &Path,
    file: File,
    length: u64,
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let mut blocks = Blocks::new(path, file, length)?;
    read_first_line(&mut blocks, stretch)?;
    let mut notes = Vec::new();
    let mut text = Text {
        path,
        bytes: blocks.bytes(),
        at: 0,
    };
    if text.bytes.starts_with(b"\xef\xbb\xbf") {
        text.at = 3;
        notes.push("a byte order mark before the header was skipped".to_owned());
    }
    let header = header(&mut text, limits)?;
    blocks.forget(header.end);
    let mut file = match header.list {
        None => dense(blocks, &header, limits, stretch)?,
        Some(list) => sparse(blocks, &header, list, limits, stretch)?,
    };
    notes.append(&mut file.notes);
    file.notes = notes;
    Ok(file)
}

/// Brings the first line that is not blank into memory.
fn read_first_line(blocks: &mut Blocks<'_>, stretch: Stretch) -> Result<(), VolumeError> {
    loop {
        blocks.read_more(stretch)?;
        let mut from_it = blocks
            .bytes()
            .iter()
            .skip_while(|byte| byte.is_ascii_whitespace());
        if blocks.is_at_end() || from_it.any(|byte| matches!(byte, b'\n' | b'\r')) {
            return Ok(());
        }
    }
}

fn header(text: &mut Text<'_>, limits: &Limits) -> Result<Header, VolumeError> {
    let (dims, list) = match *text.header()? {
        [w, h, d] => (text.dims([w, h, d], limits)?, None),
        [w, h, d, count, background] => {
            let dims = text.dims([w, h, d], limits)?;
            let count = text.whole(count, "a count of voxels")?;
            (dims, Some((count, text.number(text.at, background)?)))
        }
        ref other => {
            let found = other.len();
            return Err(text.malformed(
                text.at,
                format!(
                    "expected the header \"width height depth\", found {found} numbers; \
                     write three whole numbers on the first line"
                ),
            ));
        }
    };
    Ok(Header {
        dims,
        end: text.at,
        list,
    })
}

fn dense(
    mut blocks: Blocks<'_>,
    header: &Header,
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let (path, dims) = (blocks.path, header.dims);
    let count = voxel_count(dims);
    // The announced size is compared with the bytes that are there before anything of that size is allocated.
    let left = blocks.length().saturating_sub(header.end as u64);
    if left.saturating_add(1) < count.saturating_mul(MIN_BYTES_PER_VALUE) {
        let most = left.div_ceil(MIN_BYTES_PER_VALUE);
        let found = format!("at most {most}, the file ends there");
        return Err(text_dense::wrong_count(path, dims, &found));
    }
    limits.check_bytes(path, "the dense box", count.saturating_mul(4))?;
    let mut head = head(Border::Clamp, 0.0);
    let making = stretch.part(0.0, BRICKS_MADE);
    let gathered = text_dense::read(&mut blocks, &head, dims, making)?;
    drop(blocks);
    let field = NamedField::decide(path, gathered.tally().largest());
    field.name.clone_into(&mut head.name);
    let (grid, tally) = Grid::from_gathered(head, gathered);
    stretch.reach(1, 1)?;
    let mut notes = vec![field.reason];
    notes.extend(tally.notes(field.name, 0.0));
    let dims = Some(dims);
    Ok(FileVolume::of_one_field(
        path,
        Format::DenseAscii,
        grid,
        dims,
        notes,
    ))
}

fn sparse(
    mut blocks: Blocks<'_>,
    header: &Header,
    (count, background): (u64, f32),
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let (path, dims) = (blocks.path, header.dims);
    let header_at = blocks.place(0);
    // Each record is four numbers.
    let left = blocks.length().saturating_sub(header.end as u64);
    if left.saturating_add(1) < count.saturating_mul(4 * MIN_BYTES_PER_VALUE) {
        return Err(blocks.malformed(
            header_at,
            format!("the header announces {count} voxels, but only {left} bytes follow; the file is cut or the count is wrong"),
        ));
    }
    limits.check_bytes(path, "the voxel list", count.saturating_mul(16))?;
    let listing = stretch.part(0.0, text_sparse::LISTED);
    let (found, voxels) = text_sparse::read(&mut blocks, dims, count, limits, listing)?;
    if found != count {
        let found = if found > count {
            "more".to_owned()
        } else {
            found.to_string()
        };
        return Err(blocks.malformed(
            header_at,
            format!("the header announces {count} voxels, found {found}; the file is cut or the count is wrong"),
        ));
    }
    drop(blocks);
    let background = if is_usable(background) {
        background
    } else {
        0.0
    };
    let mut head = head(Border::Background, background);
    let building = stretch.part(text_sparse::LISTED, 1.0);
    let (gathered, repeated) = voxels.into_bricks(background, path, limits, building)?;
    let field = NamedField::decide(path, gathered.tally().largest());
    field.name.clone_into(&mut head.name);
    let (grid, tally) = Grid::from_gathered(head, gathered);
    stretch.reach(1, 1)?;
    let mut notes = vec![field.reason];
    notes.extend(tally.notes(field.name, background));
    notes.extend(super::build_sparse::repeated_note(repeated));
    let dims = Some(dims);
    Ok(FileVolume::of_one_field(
        path,
        Format::SparseAscii,
        grid,
        dims,
        notes,
    ))
}

/// A head whose name is not known before all values are.
fn head(border: Border, background: f32) -> GridHead {
    GridHead {
        name: String::new(),
        world_from_index: centred_voxels(),
        border,
        background,
        stored_as: "ascii",
    }
}
