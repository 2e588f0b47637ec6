//! Numbered files on disk and the frames that they are.
//!
//! The frames of a sequence are files of one folder whose names differ in one number alone: the last that stands before the
//! ending, or, where none does, the last of all (`fire.0022`). It may start anywhere, have any padding, none, or one that
//! overflows (`999`, `1000`), and leave gaps. A fire in several files, one field each, is several such families that count
//! together.
//!
//! Only names are looked at here: whether a frame can be read is found out when its turn comes.

mod error;
mod family;
mod frames;
mod numbered;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub use error::SequenceError;
pub use frames::Frames;

use family::Family;

/// Endings of what this program writes itself: pictures beside their volumes are no other sequence.
const OWN_ENDINGS: [&str; 5] = ["png", "exr", "toml", "json", "csv"];

/// A sequence of frames, at least two.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sequence {
    /// One for each file of a frame, in the order in which they are given.
    families: Vec<Family>,
    numbers: BTreeSet<u64>,
}

impl Sequence {
    /// The sequence that a file is a frame of, whether that file is there or not; or the only sequence in a folder.
    ///
    /// # Errors
    /// [`SequenceError`] names the path, what was expected and found, and what to do.
    pub fn of(path: &Path) -> Result<Self, SequenceError> {
        if path.is_dir() {
            Self::in_folder(path)
        } else {
            Self::of_files(&[path.to_owned()])
        }
    }

    /// The sequence of files that are one frame together: each counts its own family, and the frames are all numbers that any
    /// of them has. A single path may be a folder.
    ///
    /// # Errors
    /// As [`Sequence::of`].
    pub fn of_all(paths: &[PathBuf]) -> Result<Self, SequenceError> {
        match paths {
            [] => Err(SequenceError::NoFiles),
            [path] => Self::of(path),
            paths => Self::of_files(paths),
        }
    }

    fn of_files(paths: &[PathBuf]) -> Result<Self, SequenceError> {
        let families = paths
            .iter()
            .map(|path| Family::of(path))
            .collect::<Result<Vec<_>, _>>()?;
        let numbers: BTreeSet<u64> = families.iter().flat_map(Family::numbers).collect();
        if numbers.len() < 2 {
            return Err(SequenceError::Alone {
                path: paths[0].clone(),
                pattern: families[0].pattern(),
            });
        }
        Ok(Self { families, numbers })
    }

    fn in_folder(folder: &Path) -> Result<Self, SequenceError> {
        let is_own = |family: &Family| {
            let ending = family.ending().map(str::to_ascii_lowercase);
            ending.is_some_and(|ending| OWN_ENDINGS.contains(&ending.as_str()))
        };
        let mut found = Family::all_in(folder)?;
        found.retain(|family| family.numbers().count() > 1 && !is_own(family));
        match found.as_slice() {
            [family] => Ok(Self {
                numbers: family.numbers().collect(),
                families: found,
            }),
            [] => Err(SequenceError::NoneInFolder {
                folder: folder.to_owned(),
            }),
            several => Err(SequenceError::SeveralInFolder {
                folder: folder.to_owned(),
                found: several.iter().map(Family::pattern).collect(),
            }),
        }
    }

    /// The numbers of all frames, lowest first.
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = u64> + '_ {
        self.numbers.iter().copied()
    }

    /// First and last number.
    pub fn ends(&self) -> [u64; 2] {
        // There are at least two.
        [self.numbers.first(), self.numbers.last()].map(|end| end.copied().unwrap_or(0))
    }

    /// Whether there is such a frame.
    pub fn has(&self, number: u64) -> bool {
        self.numbers.contains(&number)
    }

    /// The files of a frame, one for each family. A file that is not there bears the name that it would have.
    pub fn paths(&self, number: u64) -> Vec<PathBuf> {
        let path = |family: &Family| family.path(number);
        self.families.iter().map(path).collect()
    }

    /// The number of the frame that these files are, if they are one.
    pub fn number_of(&self, paths: &[PathBuf]) -> Option<u64> {
        self.numbers().find(|&number| self.paths(number) == paths)
    }

    /// So many digits its numbers have at least.
    pub fn padding(&self) -> usize {
        self.families.first().map_or(1, Family::padding)
    }

    /// A number with the sequence's padding.
    pub fn padded(&self, number: u64) -> String {
        format!("{number:0width$}", width = self.padding())
    }

    /// What the files are called, with `#` for each digit of the padding: `fire_####.vdb`.
    pub fn pattern(&self) -> String {
        let patterns: Vec<String> = self.families.iter().map(Family::pattern).collect();
        patterns.join(" + ")
    }

    /// What was chosen among files that would be the same frame, in words.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        self.families.iter().flat_map(Family::notes)
    }
}

#[cfg(test)]
mod tests;
