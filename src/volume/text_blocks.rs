//! A text of any length in blocks, and blocks in pieces that are read side by side.
//!
//! Blocks and pieces begin and end where white space parts two numbers, so no number is cut. No more of the file is in
//! memory than a block, unless a single number is longer.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek};
use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::VolumeError;
use super::text::not_a_number;
use super::watch::Stretch;

/// Bytes that are read at once.
const BLOCK_BYTES: u64 = 4 << 20;
/// Bytes that one thread reads between two looks at the watch.
const PIECE_BYTES: usize = 32 << 10;

/// A text file, of which a part is in memory.
pub(super) struct Blocks<'a> {
    pub(super) path: &'a Path,
    file: File,
    /// The part that is in memory.
    bytes: Vec<u8>,
    /// Where it begins in the file.
    begin: u64,
    /// Bytes of the file, as it was announced.
    length: u64,
    is_at_end: bool,
}

impl<'a> Blocks<'a> {
    /// The text of a file of about `length` bytes, from its beginning.
    pub(super) fn new(path: &'a Path, mut file: File, length: u64) -> Result<Self, VolumeError> {
        file.rewind().map_err(|source| io_error(path, source))?;
        Ok(Self {
            path,
            file,
            bytes: Vec::new(),
            begin: 0,
            length,
            is_at_end: false,
        })
    }

    /// Bytes in memory.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Bytes of the whole file.
    pub(super) fn length(&self) -> u64 {
        self.length.max(self.begin + self.bytes.len() as u64)
    }

    /// Whether everything up to the end of the file is in memory.
    pub(super) fn is_at_end(&self) -> bool {
        self.is_at_end
    }

    /// Brings one block more into memory.
    pub(super) fn read_more(&mut self, stretch: Stretch) -> Result<(), VolumeError> {
        stretch.check()?;
        let read = (&mut self.file)
            .take(BLOCK_BYTES)
            .read_to_end(&mut self.bytes)
            .map_err(|source| io_error(self.path, source))?;
        self.is_at_end = (read as u64) < BLOCK_BYTES;
        Ok(())
    }

    /// Brings at least one whole number more into memory, and gives where the last whole one ends; at the end of the file
    /// that is the end.
    pub(super) fn read_numbers(&mut self, stretch: Stretch) -> Result<usize, VolumeError> {
        loop {
            let before = self.bytes.len();
            if !self.is_at_end {
                self.read_more(stretch)?;
            }
            if self.is_at_end {
                return Ok(self.bytes.len());
            }
            let new = &self.bytes[before..];
            if let Some(last) = new.iter().rposition(u8::is_ascii_whitespace) {
                return Ok(before + last + 1);
            }
        }
    }

    /// Forgets the first bytes in memory.
    pub(super) fn forget(&mut self, count: usize) {
        self.bytes.drain(..count);
        self.begin += count as u64;
    }

    /// The part of a stretch that the next bytes in memory are of the file.
    pub(super) fn stretch_of<'s>(&self, count: usize, stretch: Stretch<'s>) -> Stretch<'s> {
        let share = |at: u64| at as f32 / self.length() as f32;
        stretch.part(share(self.begin), share(self.begin + count as u64))
    }

    /// Where a byte in memory lies in the file.
    pub(super) fn place(&self, at: usize) -> u64 {
        self.begin + at as u64
    }

    /// An error at a place of the file. Lines are counted here, so that reading pays nothing for it.
    pub(super) fn malformed(&mut self, place: u64, message: String) -> VolumeError {
        VolumeError::Malformed {
            path: self.path.to_owned(),
            line: self.line_at(place),
            message,
        }
    }

    /// The line of a place in the file, from 1; `None` if the file cannot be read again.
    fn line_at(&mut self, place: u64) -> Option<u64> {
        self.file.rewind().ok()?;
        let mut before = BufReader::new((&mut self.file).take(place));
        let (mut line, mut after_return) = (1, false);
        loop {
            let some = before.fill_buf().ok()?;
            if some.is_empty() {
                return Some(line);
            }
            for byte in some {
                let is_second_half = *byte == b'\n' && after_return;
                line += u64::from(matches!(byte, b'\n' | b'\r') && !is_second_half);
                after_return = *byte == b'\r';
            }
            let count = some.len();
            before.consume(count);
        }
    }
}

fn io_error(path: &Path, source: std::io::Error) -> VolumeError {
    VolumeError::Io {
        path: path.to_owned(),
        source,
    }
}

/// What is wrong with a text, and where in its block.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) at: usize,
    pub(super) message: String,
}

/// A part of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Piece {
    /// Its bytes in the block.
    pub(super) bytes: Range<usize>,
    /// How many numbers of the block come before it.
    pub(super) before: usize,
    /// How many numbers begin in it.
    pub(super) count: usize,
}

/// A block in pieces, with their numbers counted side by side.
pub(super) fn pieces(block: &[u8]) -> Vec<Piece> {
    pieces_of(block, PIECE_BYTES)
}

fn pieces_of(block: &[u8], length: usize) -> Vec<Piece> {
    let mut ranges = Vec::with_capacity(block.len() / length + 1);
    let mut begin = 0;
    while begin < block.len() {
        let least = (begin + length).min(block.len());
        let space = block[least..].iter().position(u8::is_ascii_whitespace);
        let end = space.map_or(block.len(), |space| least + space);
        ranges.push(begin..end);
        begin = end;
    }
    let counts: Vec<usize> = ranges
        .par_iter()
        .map(|range| count_numbers(&block[range.clone()]))
        .collect();
    let mut before = 0;
    let all = ranges.into_iter().zip(counts).map(|(bytes, count)| {
        before += count;
        Piece {
            bytes,
            before: before - count,
            count,
        }
    });
    all.collect()
}

/// The numbers of a text that begins where white space ends or begins.
fn count_numbers(bytes: &[u8]) -> usize {
    /// So many ones fit into a byte, which is as narrow as what is counted.
    const RUN: usize = 255;
    // Without jumps, for which a whole register of bytes is looked at at once.
    let is_space = |byte: u8| {
        u8::from(byte == b' ')
            | u8::from(byte == b'\n')
            | u8::from(byte == b'\r')
            | u8::from(byte == b'\t')
            | u8::from(byte == b'\x0c')
    };
    let Some((first, rest)) = bytes.split_first() else {
        return 0;
    };
    let runs = bytes.chunks(RUN).zip(rest.chunks(RUN));
    let begins = runs.map(|(before, after)| {
        let pairs = before.iter().zip(after);
        let begins = pairs.fold(0u8, |sum, (a, b)| {
            sum.wrapping_add(is_space(*a) & (1 - is_space(*b)))
        });
        usize::from(begins)
    });
    usize::from(1 - is_space(*first)) + begins.sum::<usize>()
}

/// Reads as many numbers as there are places for, from a piece of a block.
pub(super) fn read_numbers(
    block: &[u8],
    piece: &Range<usize>,
    places: &mut [f32],
) -> Result<(), Fault> {
    let mut at = piece.start;
    for place in places {
        while block.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
        let rest = &block[at..piece.end];
        // Most of a fire is air, written as a single digit.
        if let [digit @ b'0'..=b'9', space, ..] = rest
            && space.is_ascii_whitespace()
        {
            *place = f32::from(digit - b'0');
            at += 1;
            continue;
        }
        // Overflow parses as infinity, which is counted and told with the other values that are not finite.
        match fast_float2::parse_partial(rest) {
            Ok((value, used)) if rest.get(used).is_none_or(u8::is_ascii_whitespace) => {
                *place = value;
                at += used;
            }
            _ => {
                let token = rest.split(u8::is_ascii_whitespace).next();
                let message = not_a_number(token.unwrap_or_default());
                return Err(Fault { at, message });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cut_no_number_and_miss_none() {
        let text = " 1 22\t333\r\n4444\n\n  55555 6\u{c}7 ".repeat(40);
        for length in 1..90 {
            for text in [text.as_str(), text.trim()] {
                let pieces = pieces_of(text.as_bytes(), length);
                let mut count = 0;
                for piece in &pieces {
                    let own = &text[piece.bytes.clone()];
                    assert_eq!(piece.before, count);
                    assert_eq!(piece.count, own.split_ascii_whitespace().count(), "{own:?}");
                    count += piece.count;
                }
                assert_eq!(count, 280, "{length}");
                let ends = pieces.last().map(|piece| piece.bytes.end);
                assert_eq!(ends, Some(text.len()));
            }
        }
    }

    #[test]
    fn a_number_is_all_that_stands_between_white_space() {
        let read = |text: &str| {
            let mut place = [0.0];
            let result = read_numbers(text.as_bytes(), &(0..text.len()), &mut place);
            result.map(|()| place[0]).map_err(|fault| fault.at)
        };
        assert_eq!(read(" 1.5e3"), Ok(1500.0));
        assert_eq!(read("inf 2"), Ok(f32::INFINITY));
        assert_eq!(read("1e99\n"), Ok(f32::INFINITY));
        for wrong in ["1.5x", "1,5", "1e", "nanx 1", "", "--1", "1\u{a0}2"] {
            assert_eq!(read(&format!(" {wrong}")), Err(1), "{wrong}");
        }
    }
}
