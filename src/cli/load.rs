//! From a project to its open volume.

use std::sync::Arc;

use super::error::CliError;
use crate::project::Project;
use crate::volume::{self, Limits, Volume};

/// Opens the project's files, or makes the built-in flame if there are none.
pub(super) fn volume(project: &Project) -> Result<Arc<Volume>, CliError> {
    volume::open_or_built_in(
        &project.volume.path,
        project.volume.built_in,
        &Limits::default(),
    )
    .map(Arc::new)
    .map_err(|error| CliError::failed("the volume cannot be opened", error))
}
