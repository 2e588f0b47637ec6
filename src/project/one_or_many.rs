//! `volume.path`: one path or a list of them.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Deserialize)]
#[serde(untagged)]
enum OneOrMany {
    One(PathBuf),
    Many(Vec<PathBuf>),
}

/// A single path as a string, several as a list. What is not UTF-8 is written with replacement characters.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    let texts: Vec<_> = paths.iter().map(|path| path.to_string_lossy()).collect();
    match &texts[..] {
        [one] => one.serialize(serializer),
        many => many.serialize(serializer),
    }
}

/// A string or a list of strings.
///
/// # Errors
/// The value is neither.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<PathBuf>, D::Error> {
    OneOrMany::deserialize(deserializer).map(|paths| match paths {
        // A set but empty path means the built-in flame, as does no path.
        OneOrMany::One(path) if path.as_os_str().is_empty() => Vec::new(),
        OneOrMany::One(path) => vec![path],
        OneOrMany::Many(paths) => paths,
    })
}
