//! Files of one folder whose names differ in their number alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::SequenceError;
use super::numbered::Numbered;

/// Files whose names differ in their number alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Family {
    folder: PathBuf,
    before: String,
    after: String,
    /// Fewest digits.
    padding: usize,
    /// The digits of each number, as the file's name has them.
    digits: BTreeMap<u64, String>,
    /// What was chosen among files of the same number.
    notes: Vec<String>,
}

impl Family {
    /// The family of a file, which need not be there.
    pub(super) fn of(path: &Path) -> Result<Self, SequenceError> {
        let name = path.file_name().and_then(|name| name.to_str());
        let parts = name.and_then(Numbered::of);
        let parts = parts.ok_or_else(|| SequenceError::NoNumber {
            path: path.to_owned(),
        })?;
        let mut family = Self::empty(path.parent().unwrap_or(Path::new("")), &parts);
        let listed = names_in(&family.folder)?;
        for name in &listed {
            family.take(name);
        }
        family.padding = family
            .digits
            .values()
            .map(String::len)
            .min()
            .unwrap_or(parts.digits.len());
        Ok(family)
    }

    /// Every family of a folder, by name.
    pub(super) fn all_in(folder: &Path) -> Result<Vec<Self>, SequenceError> {
        let names = names_in(folder)?;
        let mut families: BTreeMap<(&str, &str), Self> = BTreeMap::new();
        for name in &names {
            if let Some(parts) = Numbered::of(name) {
                families
                    .entry((parts.before, parts.after))
                    .or_insert_with(|| Self::empty(folder, &parts))
                    .take(name);
            }
        }
        Ok(families
            .into_values()
            .map(|mut family| {
                let lengths = family.digits.values().map(String::len);
                family.padding = lengths.min().unwrap_or(1);
                family
            })
            .collect())
    }

    fn empty(folder: &Path, parts: &Numbered<'_>) -> Self {
        Self {
            folder: folder.to_owned(),
            before: parts.before.to_owned(),
            after: parts.after.to_owned(),
            padding: 1,
            digits: BTreeMap::new(),
            notes: Vec::new(),
        }
    }

    /// Takes in a file, if it is one of the family. Of two with one number the one with fewer digits stays.
    fn take(&mut self, name: &str) {
        let Some(parts) = Numbered::of(name) else {
            return;
        };
        if parts.before != self.before || parts.after != self.after {
            return;
        }
        let digits = parts.digits.to_owned();
        let Some(known) = self.digits.remove(&parts.number) else {
            self.digits.insert(parts.number, digits);
            return;
        };
        let [kept, left] = if known.len() <= digits.len() {
            [known, digits]
        } else {
            [digits, known]
        };
        let named = |digits: &str| format!("{}{digits}{}", self.before, self.after);
        self.notes.push(format!(
            "frame {}: {} is taken, and {} of the same number is not",
            parts.number,
            named(&kept),
            named(&left)
        ));
        self.digits.insert(parts.number, kept);
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = u64> + '_ {
        self.digits.keys().copied()
    }

    /// The file of a number, or the one that would be.
    pub(super) fn path(&self, number: u64) -> PathBuf {
        let made = || format!("{number:0width$}", width = self.padding);
        let digits = self.digits.get(&number).cloned().unwrap_or_else(made);
        self.folder
            .join(format!("{}{digits}{}", self.before, self.after))
    }

    pub(super) fn padding(&self) -> usize {
        self.padding
    }

    /// What its files are called, with `#` for each digit of the padding.
    pub(super) fn pattern(&self) -> String {
        format!("{}{}{}", self.before, "#".repeat(self.padding), self.after)
    }

    /// What follows the last dot of its names.
    pub(super) fn ending(&self) -> Option<&str> {
        self.after.rsplit_once('.').map(|(_, ending)| ending)
    }

    pub(super) fn notes(&self) -> impl Iterator<Item = &str> {
        self.notes.iter().map(String::as_str)
    }
}

/// The names of a folder's files, sorted; hidden ones and those that are no text are nobody's frames.
fn names_in(folder: &Path) -> Result<Vec<String>, SequenceError> {
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let refused = |source| SequenceError::Folder {
        folder: folder.to_owned(),
        source,
    };
    let mut names = Vec::new();
    for entry in fs::read_dir(here).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        if let Ok(name) = entry.file_name().into_string()
            && !name.starts_with('.')
            && !entry.path().is_dir()
        {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}
