//! Files that are whole or absent.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Links that are followed one after the other, as many as Linux follows.
const MAX_LINKS: usize = 40;

/// Where the bytes that are written to a path go, with every link on the way followed: two spellings of one file
/// are equal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// A file, which may not be there yet; a new one takes its place.
    File(PathBuf),
    /// A device or a pipe, which no file may replace: it is written to directly.
    Device(PathBuf),
}

impl Target {
    /// Follows a path to its end, even if nothing is there yet.
    ///
    /// # Errors
    /// What the system said: its folder is missing, it is a folder itself, its links go round in a circle.
    pub fn of(path: &Path) -> io::Result<Self> {
        let mut path = path.to_owned();
        for _ in 0..MAX_LINKS {
            match fs::metadata(&path) {
                Ok(about) if about.is_dir() => {
                    return Err(io::Error::new(
                        io::ErrorKind::IsADirectory,
                        "it is a folder",
                    ));
                }
                Ok(about) if about.is_file() => return fs::canonicalize(&path).map(Self::File),
                // The end of a pipe has no path of its own: it keeps the one it was found by.
                Ok(_) => return Ok(Self::Device(path)),
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                Err(_) => {}
            }
            let Ok(link) = fs::read_link(&path) else {
                let name = path.file_name().ok_or(io::ErrorKind::NotFound)?;
                return Ok(Self::File(fs::canonicalize(folder_of(&path))?.join(name)));
            };
            // A link to where nothing is yet; one that is absolute replaces all that it is joined to.
            path = folder_of(&path).join(link);
        }
        Err(io::Error::other("too many links lead on from it"))
    }

    /// Whether [`write`](Self::write) would succeed on a disk with room.
    ///
    /// # Errors
    /// As those of a write, found without changing what is there.
    pub fn check(&self) -> io::Result<()> {
        match self {
            // Opening a pipe waits for its reader.
            Self::Device(_) => Ok(()),
            Self::File(path) => temporary_beside(path).map(drop),
        }
    }

    /// Writes a file wholly or not at all: the bytes go to a temporary file beside it, which then takes its name.
    ///
    /// # Errors
    /// What the system said. Whatever file stood there before stands there still.
    pub fn write(&self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Device(path) => fs::OpenOptions::new()
                .write(true)
                .open(path)?
                .write_all(bytes),
            Self::File(path) => {
                let mut file = temporary_beside(path)?;
                file.write_all(bytes)?;
                file.as_file().sync_all()?;
                file.persist(path).map(|_| ()).map_err(|error| error.error)
            }
        }
    }
}

/// Writes to the [`Target`] of a path: a file wholly or not at all, links followed.
///
/// # Errors
/// What the system said. Whatever file stood at `path` before stands there still.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Target::of(path)?.write(bytes)
}

/// The folder that a path's last name is in.
fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// A temporary file in the folder of a path that it may replace, removed when it is dropped.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    // Replacing asks the folder only: who made a file read-only did not mean that.
    if fs::metadata(path).is_ok_and(|about| about.permissions().readonly()) {
        return Err(io::Error::new(
            io::ErrorKind::PermissionDenied,
            "the file there is read-only",
        ));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sootlight-");
    // As for any new file the user's mask decides who may read it; a temporary one is private otherwise.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(path))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn a_file_is_replaced_wholly_and_a_failure_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        write_whole(&file, b"one").unwrap();
        write_whole(&file, b"two").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"two");
        assert!(write_whole(&file.join("below a file"), b"x").is_err());
        assert!(write_whole(folder.path(), b"x").is_err());
        assert!(write_whole(Path::new(""), b"x").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn two_spellings_of_a_file_are_one_target_whether_it_is_there_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let (plain, dotted) = (folder.path().join("a"), folder.path().join("./a"));
        for _ in 0..2 {
            assert_eq!(Target::of(&plain).unwrap(), Target::of(&dotted).unwrap());
            write_whole(&plain, b"x").unwrap();
        }
        assert_ne!(
            Target::of(&plain).unwrap(),
            Target::of(&folder.path().join("b")).unwrap()
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_to_the_file_that_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        symlink("b", path("a")).unwrap();
        symlink(path("c"), path("b")).unwrap();
        for bytes in [b"new", b"old"] {
            write_whole(&path("a"), bytes).unwrap();
            assert_eq!(fs::read(path("c")).unwrap(), bytes);
            assert!(path("a").is_symlink() && path("b").is_symlink());
        }
        symlink("ring", path("ring")).unwrap();
        assert!(Target::of(&path("ring")).is_err());
        assert!(matches!(
            Target::of(Path::new("/dev/null")),
            Ok(Target::Device(_))
        ));
    }

    #[test]
    fn what_is_read_only_fails_the_check_as_it_fails_the_write() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        write_whole(&file, b"kept").unwrap();
        let mut permissions = fs::metadata(&file).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).unwrap();
        let target = Target::of(&file).unwrap();
        for refused in [target.check(), target.write(b"lost")] {
            assert_eq!(refused.unwrap_err().kind(), io::ErrorKind::PermissionDenied);
        }
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }
}
