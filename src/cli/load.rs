//! From a project to its open volume.

use std::sync::Arc;

use super::error::CliError;
use crate::project::Project;
use crate::volume::{self, Limits, Volume};

/// Opens the project's files, or makes the built-in flame if there are none.
pub(super) fn volume(project: &Project) -> Result<Arc<Volume>, CliError> {
    let paths = &project.volume.path;
    if paths.is_empty() {
        return Ok(Arc::new(volume::procedural::torch()));
    }
    let opened = volume::open(paths, &Limits::default());
    opened
        .map(Arc::new)
        .map_err(|error| CliError::failed("the volume cannot be opened", error))
}
