//! What is to be written, as plain data.

use std::path::PathBuf;

use super::shots::Shots;
use crate::export::Format;
use crate::project::Project;

/// Pictures to be written.
#[derive(Debug, Clone)]
pub struct Order {
    /// What is set, held over the range as [`lock()`](super::lock()) does.
    pub project: Project,
    /// Of what they are.
    pub shots: Shots,
    /// Where to; see [`super::target()`].
    pub output: PathBuf,
    /// As what.
    pub format: Format,
    /// What was assumed of the files where it is set now, told in each picture.
    pub assumed: Vec<String>,
}
