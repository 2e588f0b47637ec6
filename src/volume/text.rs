//! A cursor over the first lines of an ASCII volume: numbers, whole numbers, and errors that name their line.

use std::path::Path;

use glam::IVec3;

use super::lattice::{IndexBox, MAX_COORDINATE};
use super::{Limits, VolumeError};

/// Voxels of a box.
pub(super) fn voxel_count(dims: IVec3) -> u64 {
    // Each axis is below 2³¹, so only the last product can overflow.
    (u64::from(dims.x.unsigned_abs()) * u64::from(dims.y.unsigned_abs()))
        .saturating_mul(dims.z.unsigned_abs().into())
}

/// A piece of the file for a message: short, and without control characters.
pub(super) fn quote(token: &[u8]) -> String {
    let text = String::from_utf8_lossy(&token[..token.len().min(40)]);
    let more = if token.len() > 40 { "…" } else { "" };
    format!("\"{}{more}\"", text.escape_debug())
}

/// Says that a number should stand where something else does.
pub(super) fn not_a_number(token: &[u8]) -> String {
    let advice = if token.contains(&b',') {
        "; write decimals with a point and part values by spaces"
    } else {
        ""
    };
    format!("expected a number, found {}{advice}", quote(token))
}

fn is_line_break(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// A cursor over the beginning of a file, or over a part of which no error names a line.
pub(super) struct Text<'a> {
    pub path: &'a Path,
    pub bytes: &'a [u8],
    pub at: usize,
}

impl<'a> Text<'a> {
    /// The next number's position and bytes.
    pub(super) fn next_token(&mut self) -> Option<(usize, &'a [u8])> {
        let bytes = self.bytes;
        let start = self.at
            + bytes[self.at..]
                .iter()
                .position(|b| !b.is_ascii_whitespace())?;
        let length = bytes[start..].iter().position(u8::is_ascii_whitespace);
        let end = length.map_or(bytes.len(), |length| start + length);
        self.at = end;
        Some((start, &bytes[start..end]))
    }

    /// The tokens of the first line that is not blank; the cursor stays at its end.
    pub(super) fn header(&mut self) -> Result<Vec<&'a [u8]>, VolumeError> {
        let Some((start, _)) = self.next_token() else {
            return Err(self.malformed(
                self.bytes.len(),
                "the file holds only white space; expected the header \"width height depth\""
                    .to_owned(),
            ));
        };
        let length = self.bytes[start..].iter().position(|b| is_line_break(*b));
        let end = length.map_or(self.bytes.len(), |length| start + length);
        let line = &self.bytes[start..end];
        self.at = start;
        let tokens: Vec<&[u8]> = line
            .split(u8::is_ascii_whitespace)
            .filter(|token| !token.is_empty())
            .take(7)
            .collect();
        if line.contains(&b',') || !tokens[0][0].is_ascii_digit() && tokens[0][0] != b'-' {
            return Err(self.malformed(
                start,
                format!(
                    "expected the header \"width height depth\" in whole numbers parted by spaces, found {}",
                    quote(line)
                ),
            ));
        }
        self.at = end;
        Ok(tokens)
    }

    pub(super) fn whole(&self, token: &[u8], what: &str) -> Result<u64, VolumeError> {
        std::str::from_utf8(token)
            .ok()
            .and_then(|digits| digits.parse().ok())
            .ok_or_else(|| {
                self.malformed(
                    self.at,
                    format!(
                        "expected {what} as a whole number below 2^64 in the header, found {}",
                        quote(token)
                    ),
                )
            })
    }

    pub(super) fn dims(&self, tokens: [&[u8]; 3], limits: &Limits) -> Result<IVec3, VolumeError> {
        let mut dims = [0i32; 3];
        for ((dim, token), name) in dims
            .iter_mut()
            .zip(tokens)
            .zip(["width", "height", "depth"])
        {
            let value = self.whole(token, &format!("a {name}"))?;
            if value == 0 || value > MAX_COORDINATE as u64 {
                return Err(self.malformed(
                    self.at,
                    format!(
                        "expected a {name} from 1 to {MAX_COORDINATE} in the header, found {value}"
                    ),
                ));
            }
            *dim = value as i32;
        }
        let dims = IVec3::from_array(dims);
        let bounds = IndexBox {
            min: IVec3::ZERO,
            max: dims,
        };
        limits.check_extent(self.path, "the announced box", bounds)?;
        Ok(dims)
    }

    pub(super) fn number(&self, at: usize, token: &[u8]) -> Result<f32, VolumeError> {
        // Overflow parses as infinity, which is counted and told with the other values that are not finite.
        fast_float2::parse(token).map_err(|_| self.malformed(at, not_a_number(token)))
    }

    /// An error at a byte of the beginning of a file.
    pub(super) fn malformed(&self, at: usize, message: String) -> VolumeError {
        let before = &self.bytes[..at.min(self.bytes.len())];
        let breaks = before
            .iter()
            .enumerate()
            .filter(|(i, byte)| match byte {
                b'\n' => true,
                b'\r' => self.bytes.get(i + 1) != Some(&b'\n'),
                _ => false,
            })
            .count();
        VolumeError::Malformed {
            path: self.path.to_owned(),
            line: Some(breaks as u64 + 1),
            message,
        }
    }
}
