//! Files that are whole or absent.

use std::io::{Error, ErrorKind};
use std::path::Path;

use super::ExportError;
use crate::project::file::{Target, write_whole};

/// Writes a file wholly or not at all.
///
/// # Errors
/// [`ExportError::Write`] names the file and says what to do; whatever stood there before stands there still.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    write_whole(path, bytes).map_err(|source| refused(path, source))
}

/// Whether a file could be written here, asked before the hours of work that it is to hold.
///
/// # Errors
/// As [`write()`] would.
pub fn check_writable(path: &Path) -> Result<(), ExportError> {
    Target::of(path)
        .and_then(|target| target.check())
        .map_err(|source| refused(path, source))
}

/// Whether two paths are one file, by whatever spelling or link, there or not yet. Paths that cannot be followed
/// are compared as they stand.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (Target::of(a), Target::of(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

fn refused(path: &Path, source: Error) -> ExportError {
    let advice = match source.kind() {
        ErrorKind::NotFound => "its folder does not exist; create it or choose another",
        ErrorKind::NotADirectory => {
            "a part of its path is a file, not a folder; choose another path"
        }
        ErrorKind::IsADirectory => "it is a folder; add a file name",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "it is not allowed; choose a place that you may write to"
        }
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "the disk is full; free some space or choose another disk"
        }
        _ => "choose another place",
    };
    ExportError::Write {
        path: path.to_owned(),
        advice,
        source,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::fs;

    use super::*;

    #[test]
    fn what_stands_in_the_way_is_said_and_nothing_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a file");
        fs::write(&file, "x").unwrap();
        for (path, advice) in [
            (folder.path().join("missing/a.png"), "folder does not exist"),
            (file.join("a.png"), "is a file, not a folder"),
            (folder.path().to_owned(), "it is a folder"),
        ] {
            for error in [
                write(&path, b"x").unwrap_err(),
                check_writable(&path).unwrap_err(),
            ] {
                assert!(error.to_string().contains(advice), "{error}");
            }
        }
        check_writable(&folder.path().join("new.png")).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert_eq!(fs::read(&file).unwrap(), b"x");
    }
}
