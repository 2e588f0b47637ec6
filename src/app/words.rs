//! What is said of an error.

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
