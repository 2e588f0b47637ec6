//! What is said to a person, wherever it is said.

use std::path::Path;

/// An error in one line, with what caused it.
pub(super) fn with_causes(error: &dyn std::error::Error) -> String {
    let mut words = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let said = error.to_string();
        // Some errors quote their cause: once is enough.
        if !words.ends_with(&said) {
            words = format!("{words} ({said})");
        }
        cause = error.source();
    }
    words
}

/// A path without its folders, for a person.
pub(super) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
