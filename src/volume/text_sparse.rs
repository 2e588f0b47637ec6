//! The records of a sparse ASCII volume, `x y z value`, read side by side.

use std::ops::Range;
use std::path::Path;

use glam::IVec3;
use rayon::prelude::*;

use super::build_sparse::{Sorted, Voxels};
use super::text::{Text, not_a_number, quote};
use super::text_blocks::{Blocks, Fault, Piece, pieces};
use super::watch::Stretch;
use super::{Limits, VolumeError};

/// Share of the time after which all voxels are in their bricks' places; the rest is making bricks of them.
pub(super) const LISTED: f32 = 0.9;
/// Share of a block's time after which its records are read.
const RECORDS_READ: f32 = 0.7;
/// Numbers of a record.
const NUMBERS: usize = 4;

/// Reads records until one more than `count`, or the end of the file, and gives how many there were.
pub(super) fn read(
    blocks: &mut Blocks<'_>,
    dims: IVec3,
    count: u64,
    limits: &Limits,
    stretch: Stretch,
) -> Result<(u64, Voxels), VolumeError> {
    let mut voxels = Voxels::new(limits);
    let mut found = 0u64;
    loop {
        let end = blocks.read_numbers(stretch)?;
        let block = &blocks.bytes()[..end];
        let pieces = pieces(block);
        let numbers = pieces.iter().map(|piece| piece.count).sum::<usize>();
        // A record that goes on in the next block waits for it.
        let cut = begin_of_last(block, numbers % NUMBERS);
        let most = usize::try_from(count + 1 - found).unwrap_or(usize::MAX);
        let records = (numbers / NUMBERS).min(most);
        let of_block = blocks.stretch_of(cut, stretch);
        let reading = of_block.part(0.0, RECORDS_READ);
        let sorted = read_records(blocks.path, block, &pieces, records, dims, reading);
        reading.check()?;
        match sorted {
            Ok(sorted) => voxels.add(&sorted, of_block.part(RECORDS_READ, 1.0))?,
            Err(fault) => return Err(blocks.malformed(blocks.place(fault.at), fault.message)),
        }
        found += records as u64;
        if found > count {
            return Ok((found, voxels));
        }
        if blocks.is_at_end() {
            if let Some(fault) = cut_record(blocks.path, block, cut, dims) {
                return Err(blocks.malformed(blocks.place(fault.at), fault.message));
            }
            return Ok((found, voxels));
        }
        blocks.forget(cut);
    }
}

/// Where the last `count` numbers of a block begin; its end where that is none.
fn begin_of_last(block: &[u8], count: usize) -> usize {
    let mut begin = block.len();
    for _ in 0..count {
        let is_number = |byte: &u8| !byte.is_ascii_whitespace();
        let end = block[..begin].iter().rposition(is_number);
        let end = end.map_or(0, |last| last + 1);
        let space = block[..end].iter().rposition(u8::is_ascii_whitespace);
        begin = space.map_or(0, |space| space + 1);
    }
    begin
}

/// The first records of a block, by piece, or the first fault among them.
fn read_records(
    path: &Path,
    block: &[u8],
    pieces: &[Piece],
    records: usize,
    dims: IVec3,
    stretch: Stretch,
) -> Result<Vec<Sorted>, Fault> {
    let counter = stretch.counter(pieces.len());
    let parts: Vec<Result<Sorted, Fault>> = pieces
        .par_iter()
        .map(|piece| {
            // A record belongs to the piece in which it begins, and may end in the next.
            let own = piece.before.div_ceil(NUMBERS)
                ..(piece.before + piece.count).div_ceil(NUMBERS).min(records);
            if own.is_empty() || !counter.goes_on() {
                return Ok(Sorted::default());
            }
            let text = Text {
                path,
                bytes: block,
                at: piece.bytes.start,
            };
            read_piece(text, NUMBERS * own.start - piece.before, &own, dims)
        })
        .collect();
    parts.into_iter().collect()
}

/// Reads some records after a number of numbers that are passed over.
fn read_piece(
    mut text: Text<'_>,
    passed_over: usize,
    records: &Range<usize>,
    dims: IVec3,
) -> Result<Sorted, Fault> {
    for _ in 0..passed_over {
        text.next_token();
    }
    let mut sorted = Sorted::default();
    for _ in records.clone() {
        let mut voxel = [0; 3];
        for (axis, c) in voxel.iter_mut().enumerate() {
            let (at, digits) = text.next_token().unwrap_or_default();
            *c = coordinate(at, digits, axis, dims)?;
        }
        let (at, token) = text.next_token().unwrap_or_default();
        // Overflow parses as infinity, which is counted and told with the other values that are not finite.
        let value = fast_float2::parse(token).map_err(|_| Fault {
            at,
            message: not_a_number(token),
        })?;
        sorted.push(IVec3::from_array(voxel), value);
    }
    Ok(sorted)
}

/// What is wrong with the numbers from `begin` to the end of the file, which are too few for a record.
fn cut_record(path: &Path, block: &[u8], begin: usize, dims: IVec3) -> Option<Fault> {
    let mut text = Text {
        path,
        bytes: block,
        at: begin,
    };
    let mut axis = 0;
    let mut first = None;
    while let Some((at, digits)) = text.next_token() {
        first.get_or_insert(at);
        if let Err(fault) = coordinate(at, digits, axis, dims) {
            return Some(fault);
        }
        axis += 1;
    }
    first.map(|at| Fault {
        at,
        message: "expected \"x y z value\", the file ends within a voxel".to_owned(),
    })
}

/// A coordinate of a sparse record along an axis.
fn coordinate(at: usize, digits: &[u8], axis: usize, dims: IVec3) -> Result<i32, Fault> {
    let plain = digits.len() <= 9 && !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    let parsed = if plain {
        let value = |sum: i32, digit: &u8| 10 * sum + i32::from(digit - b'0');
        Some(digits.iter().fold(0, value))
    } else {
        std::str::from_utf8(digits)
            .ok()
            .and_then(|it| it.parse().ok())
    };
    let inside = parsed.filter(|c| (0..dims[axis]).contains(c));
    inside.ok_or_else(|| {
        let (name, last) = (["x", "y", "z"][axis], dims[axis] - 1);
        let found = quote(digits);
        Fault {
            at,
            message: format!("expected {name} from 0 to {last}, found {found}"),
        }
    })
}
