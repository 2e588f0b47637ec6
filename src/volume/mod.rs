//! Grids in memory and on disk, and what their numbers mean.
//!
//! [`open`] recognises a file by its bytes and gives a [`Volume`] of named [`Grid`]s in the units of the
//! file. [`recognise()`] guesses who wrote it and [`preset()`] proposes the mapping to soot volume fraction,
//! flame and kelvin, with everything it had to assume in words. [`summarise`] says all of it as data. A
//! [`Watch`] shows how far [`open_watched`] is, and cancels it.

mod build;
mod build_sparse;
mod error;
mod field;
mod file_volume;
mod grid;
mod lattice;
mod limits;
mod load;
mod naming;
mod new_brick;
mod openvdb;
mod openvdb_archive;
mod openvdb_heads;
mod openvdb_topology;
mod openvdb_tree;
mod preset;
pub mod procedural;
mod recognise;
mod report_ascii;
mod report_binary;
mod sniff;
mod summary;
mod text;
mod text_blocks;
mod text_dense;
mod text_sparse;
mod wanted;
mod watch;

use std::path::PathBuf;

pub use error::VolumeError;
pub use field::{
    About, Assumption, FieldKind, FieldMap, FieldMaps, Preset, Producer, Recognised, UpAxis,
};
pub use grid::{Border, BrickRef, Grid};
pub use lattice::{BRICK_EDGE, BRICK_LEN, IndexBox, brick_of};
pub use limits::{Limits, MEMORY_LIMIT_MB};
pub use load::{open, open_or_built_in, open_wanted, open_watched};
pub use naming::figures;
pub use preset::{GLOW_K, PEAK_K, mapping, preset};
pub use procedural::BuiltIn;
pub use recognise::recognise;
pub use summary::{GridSummary, MappedField, Summary, summarise};
pub use wanted::{UnreadGrid, Wanted};
pub use watch::Watch;

/// A file format, told by the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Header `W H D`, then every value, x fastest.
    DenseAscii,
    /// Header `W H D count background`, then `x y z value` lines.
    SparseAscii,
    /// A count, then records of 44 bytes.
    SparseBinary,
    /// OpenVDB.
    OpenVdb,
    /// Files of several formats together.
    Mixed,
    /// Not read from a file.
    Computed,
}

impl Format {
    /// The format's name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::DenseAscii => "dense ASCII",
            Self::SparseAscii => "sparse ASCII",
            Self::SparseBinary => "sparse binary",
            Self::OpenVdb => "OpenVDB",
            Self::Mixed => "several formats",
            Self::Computed => "computed",
        }
    }
}

/// A grid of the file that is not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkippedGrid {
    /// The grid's name.
    pub name: String,
    /// Why it is not used.
    pub reason: String,
}

/// What a file says about itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata {
    /// The program that wrote the file, where it says so.
    pub creator: Option<String>,
    /// File-level entries as name and text.
    pub entries: Vec<(String, String)>,
}

/// The fields of one moment of a fire, as they stand in their files.
#[derive(Clone, Debug)]
pub struct Volume {
    /// The scalar grids that were read, at most one of a name, in file order.
    pub grids: Vec<Grid>,
    /// Scalar grids of the files that nobody has needed so far.
    pub unread: Vec<UnreadGrid>,
    /// What was wanted of the files.
    pub read_for: Wanted,
    /// What it may cost, as a file and packed for rendering.
    pub limits: Limits,
    /// Grids of the files that are not used.
    pub skipped: Vec<SkippedGrid>,
    /// The files, in the order they were given.
    pub sources: Vec<PathBuf>,
    /// How the files are written.
    pub format: Format,
    /// What the first file with metadata says about itself.
    pub metadata: Metadata,
    /// True where the files give voxels a size. Otherwise a voxel is 1 file unit and its size is a guess.
    pub voxel_size_is_known: bool,
    /// What was repaired, chosen or assumed while reading, in words.
    pub notes: Vec<String>,
    /// Which of the program's own flames it is: one that was thought up, not given.
    pub built_in: Option<BuiltIn>,
}

impl Volume {
    /// A volume that comes from no file. `note` says what it is.
    pub fn from_grids(grids: Vec<Grid>, note: &str) -> Self {
        Self {
            grids,
            unread: Vec::new(),
            read_for: Wanted::everything(),
            limits: Limits::default(),
            skipped: Vec::new(),
            sources: Vec::new(),
            format: Format::Computed,
            metadata: Metadata::default(),
            voxel_size_is_known: true,
            notes: vec![note.to_owned()],
            built_in: None,
        }
    }

    /// The grid of exactly this name.
    pub fn grid(&self, name: &str) -> Option<&Grid> {
        self.grids.iter().find(|grid| grid.name == name)
    }
}
