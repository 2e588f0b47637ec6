//! The scene file: TOML, whose unknown keys are refused by name and whose paths are relative to it.

use std::fs;
use std::io::{self, Read as _};
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::Project;
use super::set::{self, SetError};

mod whole;

pub use whole::{Target, write_whole};

/// Largest scene file that is read, bytes: a hand-written one has a few thousand.
const MAX_BYTES: u64 = 1 << 20;

/// Why a scene file could not be read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The system refused to read it.
    #[error("the scene file {path} cannot be read", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It is not text, or far too long for a scene.
    #[error("{path} is not a scene file: expected at most {MAX_BYTES} bytes of UTF-8 text", path = path.display())]
    NotText {
        /// The file.
        path: PathBuf,
    },
    /// It breaks the rules of TOML.
    #[error("{file}line {line}: this is not TOML: {message}", file = prefix(file.as_deref()))]
    Syntax {
        /// The file, if it is one.
        file: Option<PathBuf>,
        /// Counted from 1.
        line: usize,
        /// What the parser expected.
        message: String,
    },
    /// A key or its value is wrong.
    #[error("{file}line {line}: {source}", file = prefix(file.as_deref()))]
    Key {
        /// The file, if it is one.
        file: Option<PathBuf>,
        /// Counted from 1.
        line: usize,
        /// Which key, what was found and what is expected.
        source: SetError,
    },
    /// The system refused to write it.
    #[error("the scene file {path} cannot be written: choose a folder that exists and can be written", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A path in it is not text, which TOML must be.
    #[error("the path {path} cannot stand in a scene file, because it is not UTF-8: rename it", path = path.display())]
    NotUnicode {
        /// The path.
        path: PathBuf,
    },
}

fn prefix(file: Option<&Path>) -> String {
    file.map_or_else(String::new, |file| format!("{}, ", file.display()))
}

impl Project {
    /// Reads a scene file's text; its relative paths start at `base_dir` (empty for the working directory).
    ///
    /// # Errors
    /// [`SceneFileError`] names the line and the key, what was found and what was expected.
    pub fn from_toml(text: &str, base_dir: &Path) -> Result<Self, SceneFileError> {
        let syntax = |error: &toml::de::Error| SceneFileError::Syntax {
            file: None,
            line: line_of(text, &error.span().unwrap_or_default()),
            message: error.message().to_owned(),
        };
        let spans = DeTable::parse(text).map_err(|error| syntax(&error))?;
        let values: Table = toml::from_str(text).map_err(|error| syntax(&error))?;
        check_keys(text, spans.get_ref(), &values, "")?;
        // Every key was checked alone, so what is left can only be the file as a whole.
        let mut project = Self::deserialize(values).map_err(|error| syntax(&error))?;
        for path in project.paths_mut() {
            *path = base_dir.join(&path);
        }
        Ok(project)
    }

    /// The scene file's text, with paths as they stand: relative to the working directory.
    pub fn to_toml(&self) -> String {
        self.to_table().to_string()
    }

    /// Reads a scene file. Its paths become relative to the working directory.
    ///
    /// # Errors
    /// [`SceneFileError`] names the file, the line and the key, what was found and what was expected.
    pub fn read(path: &Path) -> Result<Self, SceneFileError> {
        let read = |source| SceneFileError::Read {
            path: path.to_owned(),
            source,
        };
        let mut bytes = Vec::new();
        fs::File::open(path)
            .and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes))
            .map_err(read)?;
        let text = String::from_utf8(bytes)
            .ok()
            .filter(|text| text.len() as u64 <= MAX_BYTES);
        let text = text.ok_or_else(|| SceneFileError::NotText {
            path: path.to_owned(),
        })?;
        let base = path.parent().unwrap_or(Path::new(""));
        // A byte order mark is no part of the text.
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        Self::from_toml(text, base).map_err(|error| error.in_file(path))
    }

    /// Writes a scene file, wholly or not at all. Paths below its folder become relative to it, others absolute.
    ///
    /// # Errors
    /// [`SceneFileError`] names the file and what stood in the way.
    pub fn write(&self, path: &Path) -> Result<(), SceneFileError> {
        let failed = |source| SceneFileError::Write {
            path: path.to_owned(),
            source,
        };
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let base = std::path::absolute(folder).map_err(failed)?;
        let mut portable = self.clone();
        for path in portable.paths_mut() {
            if path.to_str().is_none() {
                return Err(SceneFileError::NotUnicode { path: path.clone() });
            }
            let absolute = std::path::absolute(&path).map_err(failed)?;
            *path = absolute
                .strip_prefix(&base)
                .map_or(absolute.clone(), Path::to_owned);
        }
        write_whole(path, portable.to_toml().as_bytes()).map_err(failed)
    }

    /// The files that it is made from: the volume's, and the backdrop's picture.
    pub fn sources(&self) -> Vec<PathBuf> {
        let picture = self.stage.backdrop_picture.iter();
        self.volume.path.iter().chain(picture).cloned().collect()
    }

    pub(super) fn paths_mut(&mut self) -> impl Iterator<Item = &mut PathBuf> {
        let picture = self.stage.backdrop_picture.iter_mut();
        self.volume.path.iter_mut().chain(picture)
    }

    /// The project as TOML.
    #[allow(
        clippy::expect_used,
        reason = "sections hold numbers, names and lists only, all of which TOML has"
    )]
    pub(super) fn to_table(&self) -> Table {
        Table::try_from(self).expect("a project is TOML")
    }
}

impl SceneFileError {
    fn in_file(self, path: &Path) -> Self {
        let file = Some(path.to_owned());
        match self {
            Self::Syntax { line, message, .. } => Self::Syntax {
                file,
                line,
                message,
            },
            Self::Key { line, source, .. } => Self::Key { file, line, source },
            other => other,
        }
    }
}

/// Refuses the first key that is unknown or whose value is not of its kind.
fn check_keys(
    text: &str,
    spans: &DeTable<'_>,
    values: &Table,
    section: &str,
) -> Result<(), SceneFileError> {
    for (name, below) in spans {
        let dotted = format!("{section}{}", name.get_ref());
        let at = |span: Range<usize>| {
            let line = line_of(text, &span);
            move |source| SceneFileError::Key {
                file: None,
                line,
                source,
            }
        };
        let value = values.get(name.get_ref().as_ref());
        match (below.get_ref(), value) {
            (DeValue::Table(below), Some(Value::Table(values))) if set::is_section(&dotted) => {
                check_keys(text, below, values, &format!("{dotted}."))?;
            }
            (_, Some(value)) => {
                let key = set::find(&dotted).map_err(at(name.span()))?;
                key.check(value).map_err(at(below.span()))?;
            }
            // Both were parsed from the same text.
            (_, None) => {}
        }
    }
    Ok(())
}

/// The line, counted from 1, in which a span begins.
fn line_of(text: &str, span: &Range<usize>) -> usize {
    1 + text
        .bytes()
        .take(span.start)
        .filter(|&byte| byte == b'\n')
        .count()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use proptest::prelude::*;

    use super::super::settings::everything_set;
    use super::*;

    fn parse(text: &str) -> Result<Project, SceneFileError> {
        Project::from_toml(text, Path::new(""))
    }

    #[test]
    fn what_is_written_reads_back_equal() {
        for project in [Project::default(), everything_set()] {
            assert_eq!(parse(&project.to_toml()).unwrap(), project);
        }
        assert_eq!(parse("").unwrap(), Project::default());
    }

    proptest! {
        #[test]
        fn numbers_keep_every_bit(bits in any::<u64>(), whole in any::<u32>()) {
            let number = f64::from_bits(bits);
            prop_assume!(!number.is_nan());
            let mut project = Project::default();
            project.soot.amount = number;
            project.camera.eye = Some(glam::DVec3::new(number, f64::from(whole), -number));
            project.render.size = [whole, 1];
            let back = parse(&project.to_toml()).unwrap();
            prop_assert_eq!(back.soot.amount.to_bits(), number.to_bits());
            prop_assert_eq!(back, project);
        }
    }

    #[test]
    fn an_error_names_the_line_the_key_and_what_is_right() {
        let error = |text: &str| parse(text).unwrap_err().to_string();
        let wrong = error("[soot]\namount = 2\nradius = 3\n");
        assert_eq!(
            wrong,
            "line 3: there is no key soot.radius; did you mean soot.radius_nm?"
        );
        let wrong = error("[soot]\n\namount = \"two\"\n");
        assert_eq!(
            wrong,
            "line 3: soot.amount is \"two\": expected a number, 0 to 10000"
        );
        assert!(
            error("[volume.sot]\nscale = 1\n")
                .starts_with("line 1: there is no key volume.sot; did you mean")
        );
        assert!(error("volume = 3\n").contains("no key volume"));
        assert!(error("soot.amount = 1\n[soot\n").starts_with("line 2: this is not TOML"));
        assert!(error("a = 1\na = 2\n").starts_with("line 2: this is not TOML"));
        assert!(error("camera.eye = [1, 2]").contains("three numbers"));
    }

    #[test]
    fn paths_start_at_the_scene_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deep/fire.toml");
        fs::create_dir(folder.path().join("deep")).unwrap();
        let mut project = Project::default();
        project.volume.path = vec![
            folder.path().join("deep/a.vdb"),
            folder.path().join("b.vdb"),
        ];
        project.stage.backdrop_picture = Some(folder.path().join("deep/behind.png"));
        project.write(&file).unwrap();
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains("backdrop_picture = \"behind.png\""), "{text}");
        assert!(text.contains("[\"a.vdb\", "), "{text}");
        assert_eq!(Project::read(&file).unwrap(), project);
        let text = "volume.path = \"a.vdb\"";
        let read = Project::from_toml(text, Path::new("scenes")).unwrap();
        assert_eq!(read.volume.path, [Path::new("scenes/a.vdb")]);
        let text = "stage.backdrop_picture = \"a.png\"";
        let read = Project::from_toml(text, Path::new("scenes")).unwrap();
        assert_eq!(read.sources(), [Path::new("scenes/a.png")]);
    }

    #[test]
    fn a_file_that_cannot_be_read_or_written_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("no/such.toml");
        assert!(
            Project::read(&missing)
                .unwrap_err()
                .to_string()
                .contains("such.toml")
        );
        assert!(
            Project::default()
                .write(&missing)
                .unwrap_err()
                .to_string()
                .contains("such.toml")
        );
        let binary = folder.path().join("binary.toml");
        fs::write(&binary, [0xff, 0xfe, 0]).unwrap();
        assert!(
            Project::read(&binary)
                .unwrap_err()
                .to_string()
                .contains("binary.toml is not a scene file")
        );
        fs::write(&binary, "[soot]\namout = 1").unwrap();
        assert!(
            Project::read(&binary)
                .unwrap_err()
                .to_string()
                .contains("binary.toml, line 2: there is no key soot.amout")
        );
    }
}
