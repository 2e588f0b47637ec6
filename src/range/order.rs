//! What is to be written, as plain data.

use std::path::PathBuf;

use crate::export::Format;
use crate::project::Project;
use crate::sequence::Sequence;

/// Pictures to be written.
#[derive(Debug, Clone)]
pub struct Order {
    /// What is set, held over the range as [`lock()`](super::lock()) does.
    pub project: Project,
    /// Whose frames they are.
    pub sequence: Sequence,
    /// Which of them, in the order in which they are made.
    pub numbers: Vec<u64>,
    /// Where to; see [`super::target()`].
    pub output: PathBuf,
    /// As what.
    pub format: Format,
    /// What was assumed of the files where it is set now, told in each picture.
    pub assumed: Vec<String>,
}
