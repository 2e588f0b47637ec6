//! From a project to its open volume.

use std::sync::Arc;

use super::error::CliError;
use crate::project::Project;
use crate::volume::{self, Volume, Wanted};

/// Opens what the project needs of its files, or makes the built-in flame if there are none.
pub(super) fn volume(project: &Project) -> Result<Arc<Volume>, CliError> {
    open(project, &project.wanted())
}

/// Opens the project's files with every grid.
pub(super) fn whole_volume(project: &Project) -> Result<Arc<Volume>, CliError> {
    open(project, &Wanted::everything())
}

fn open(project: &Project, wanted: &Wanted) -> Result<Arc<Volume>, CliError> {
    let volume = &project.volume;
    volume::open_or_built_in(&volume.path, volume.built_in, wanted, &volume.limits())
        .map(Arc::new)
        .map_err(|error| CliError::failed("the volume cannot be opened", error))
}
