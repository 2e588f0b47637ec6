//! Which pictures are there already: told by what they were made from, not by name or date.
//!
//! The scene file in a picture begins with a comment that holds two digests: of the bytes of all files that the picture is
//! made from, and of everything that was set, the program's version included. A picture that is whole and carries the
//! digests of the picture to be made is that picture. Where the files lie makes no difference.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use sha2::{Digest as _, Sha256};

use super::order::Order;
use super::shots::Shot;
use crate::export::{Format, scene_of};
use crate::project::BackdropKind;
use crate::volume::VolumeError;

/// Bytes of a file that are held at once.
const READ_BYTES: usize = 1 << 20;

/// The line that tells what the picture of a frame is made from.
///
/// # Errors
/// [`VolumeError::Io`]: a file cannot be read.
pub(super) fn mark(order: &Order, shot: &Shot) -> Result<String, VolumeError> {
    let stage = &order.project.stage;
    let picture = stage.backdrop_picture.iter();
    let picture = picture.filter(|_| stage.backdrop == BackdropKind::Picture);
    let mut files = Sha256::new();
    for path in shot.paths.iter().chain(picture) {
        let bytes = digest_of_file(path).map_err(|source| VolumeError::Io {
            path: path.clone(),
            source,
        })?;
        files.update(bytes);
    }
    let files = hex(&files.finalize());
    Ok(format!(
        "frame of files sha256 {files}, settings sha256 {}",
        settings(order, shot)
    ))
}

/// Whether the picture that bears this mark is there, and whole.
pub(super) fn is_there(path: &Path, format: Format, mark: &str) -> bool {
    let scene = scene_of(path, format);
    scene.is_some_and(|scene| scene.lines().next() == Some(&format!("# {mark}")))
}

fn digest_of_file(path: &Path) -> std::io::Result<impl AsRef<[u8]> + use<>> {
    let mut file = File::open(path)?;
    let mut digest = Sha256::new();
    let mut bytes = vec![0; READ_BYTES];
    loop {
        match file.read(&mut bytes)? {
            0 => return Ok(digest.finalize()),
            read => digest.update(&bytes[..read]),
        }
    }
}

/// The digest of everything that makes a picture beside its files.
fn settings(order: &Order, shot: &Shot) -> String {
    let mut project = shot.seen(&order.project);
    project.volume.path.clear();
    project.stage.backdrop_picture = None;
    let mut digest = Sha256::new();
    for text in [
        env!("CARGO_PKG_VERSION"),
        order.format.name(),
        &project.to_toml(),
        &order.assumed.join("\n"),
    ] {
        digest.update((text.len() as u64).to_le_bytes());
        digest.update(text);
    }
    hex(&digest.finalize())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
