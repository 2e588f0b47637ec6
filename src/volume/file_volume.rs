//! What a reader brings home from one file, before files are put together.

use std::path::{Path, PathBuf};

use glam::IVec3;

use super::{Format, Grid, Metadata, SkippedGrid, UnreadGrid};

/// What one file holds.
#[derive(Debug)]
pub(super) struct FileVolume {
    pub path: PathBuf,
    pub format: Format,
    pub grids: Vec<Grid>,
    pub unread: Vec<UnreadGrid>,
    pub skipped: Vec<SkippedGrid>,
    pub metadata: Metadata,
    pub notes: Vec<String>,
    /// Width, height and depth, where the format states them.
    pub dims: Option<IVec3>,
}

impl FileVolume {
    pub(super) fn new(path: &Path, format: Format) -> Self {
        Self {
            path: path.to_owned(),
            format,
            grids: Vec::new(),
            unread: Vec::new(),
            skipped: Vec::new(),
            metadata: Metadata::default(),
            notes: Vec::new(),
            dims: None,
        }
    }

    pub(super) fn of_one_field(
        path: &Path,
        format: Format,
        grid: Grid,
        dims: Option<IVec3>,
        notes: Vec<String>,
    ) -> Self {
        Self {
            grids: vec![grid],
            notes,
            dims,
            ..Self::new(path, format)
        }
    }

    /// The names of all scalar grids, read or not.
    pub(super) fn grid_names(&self) -> impl Iterator<Item = &str> {
        let read = self.grids.iter().map(|grid| grid.name.as_str());
        read.chain(self.unread.iter().map(|grid| grid.name.as_str()))
    }
}
