//! A file name and the number in it.

use std::ops::Range;
use std::path::Path;

/// A name with a number in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Numbered<'a> {
    pub(super) before: &'a str,
    pub(super) digits: &'a str,
    pub(super) after: &'a str,
    pub(super) number: u64,
}

impl<'a> Numbered<'a> {
    /// The parts of a name. `None` where no number counts it, or one that is larger than any count.
    pub(super) fn of(name: &'a str) -> Option<Self> {
        let stem = Path::new(name).file_stem()?.to_str()?;
        // An ending is not counted, `.mp4` for one, unless the name has no other number.
        let digits = last_digits(stem).or_else(|| last_digits(name))?;
        Some(Self {
            before: &name[..digits.start],
            digits: &name[digits.clone()],
            after: &name[digits.end..],
            number: name[digits].parse().ok()?,
        })
    }
}

fn last_digits(text: &str) -> Option<Range<usize>> {
    let end = text.rfind(|c: char| c.is_ascii_digit())? + 1;
    let before = text[..end].trim_end_matches(|c: char| c.is_ascii_digit());
    Some(before.len()..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_number_before_the_ending_counts() {
        let parts = |name| Numbered::of(name).map(|it| (it.before, it.digits, it.after));
        for (name, expected) in [
            ("fire_0001.vdb", ("fire_", "0001", ".vdb")),
            ("7.vdb", ("", "7", ".vdb")),
            ("shot2_fire.0100.vdb", ("shot2_fire.", "0100", ".vdb")),
            ("fire-12b.mp4", ("fire-", "12", "b.mp4")),
            ("fire.0022", ("fire.", "0022", "")),
            ("fire.mp4", ("fire.mp", "4", "")),
            ("fé１_3.vdb", ("fé１_", "3", ".vdb")),
        ] {
            assert_eq!(parts(name), Some(expected), "{name}");
        }
        for name in ["fire.vdb", "", "fire_99999999999999999999.vdb"] {
            assert_eq!(parts(name), None, "{name}");
        }
    }
}
