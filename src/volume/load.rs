//! From paths to one volume: read each file once, then put the fields together.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::IVec3;

use super::file_volume::FileVolume;
use super::procedural::BuiltIn;
use super::sniff::{Sniffed, sniff};
use super::watch::{Stretch, Watch};
use super::{Format, Grid, Limits, Metadata, Volume, VolumeError, Wanted};
use super::{openvdb, report_ascii, report_binary};

/// Enough of a file to tell what it is.
const HEAD_BYTES: u64 = 256;

/// Opens one file, or several that belong together, as one volume. What a file is, is told by its bytes.
///
/// Grids keep the units of their files; [`preset`](super::preset()) says what they mean. Where files of one
/// field come together, dense boxes must be equal; the box of a sparse file is only where its voxels are and
/// may differ.
///
/// # Errors
/// Any [`VolumeError`]: each names the file, what was expected and found, and what to do. Nothing is allocated
/// by the word of a header alone.
pub fn open(paths: &[PathBuf], limits: &Limits) -> Result<Volume, VolumeError> {
    open_watched(paths, limits, &Watch::default())
}

/// Opens files as [`open`] does, under the eyes of a watch. The share is over all files, by their bytes.
///
/// # Errors
/// As [`open`]; and [`VolumeError::Cancelled`], whatever else is wrong, once the watch was cancelled.
pub fn open_watched(
    paths: &[PathBuf],
    limits: &Limits,
    watch: &Watch,
) -> Result<Volume, VolumeError> {
    open_wanted(paths, &Wanted::everything(), limits, watch)
}

/// Opens files as [`open_watched`] does, and reads of them only what is wanted; a grid that is not is named in
/// [`Volume::unread`]. Formats of one field are read whole.
///
/// # Errors
/// As [`open_watched`]. Damage within a grid that is not read is not found.
pub fn open_wanted(
    paths: &[PathBuf],
    wanted: &Wanted,
    limits: &Limits,
    watch: &Watch,
) -> Result<Volume, VolumeError> {
    let opened = open_together(paths, wanted, limits, watch);
    // A reader that was stopped may have said so in words of its own.
    watch.whole().check()?;
    let volume = opened?;
    watch.whole().reach(1, 1)?;
    Ok(volume)
}

fn open_together(
    paths: &[PathBuf],
    wanted: &Wanted,
    limits: &Limits,
    watch: &Watch,
) -> Result<Volume, VolumeError> {
    if paths.is_empty() {
        return Err(VolumeError::NoFiles);
    }
    // What is wrong with a file is said when its turn comes.
    let length = |path: &PathBuf| fs::metadata(path).map_or(0, |about| about.len());
    let lengths: Vec<u64> = paths.iter().map(length).collect();
    let all = lengths.iter().sum::<u64>().max(1) as f32;
    let mut before_it = 0;
    let mut parts: Vec<FileVolume> = Vec::with_capacity(paths.len());
    for (path, length) in paths.iter().zip(lengths) {
        let after_it = before_it + length;
        let stretch = watch
            .whole()
            .part(before_it as f32 / all, after_it as f32 / all);
        let part = read_file(path, wanted, limits, stretch)?;
        for before in &parts {
            check_together(before, &part)?;
        }
        parts.push(part);
        before_it = after_it;
    }
    Ok(merge(parts, wanted, limits))
}

/// Opens what is wanted of files, or makes the given built-in flame if there are none.
///
/// # Errors
/// As [`open_wanted`].
pub fn open_or_built_in(
    paths: &[PathBuf],
    built_in: BuiltIn,
    wanted: &Wanted,
    limits: &Limits,
) -> Result<Volume, VolumeError> {
    if paths.is_empty() {
        Ok(built_in.volume())
    } else {
        open_wanted(paths, wanted, limits, &Watch::default())
    }
}

impl Volume {
    /// This volume with the fields of one more file: a temperature that was dropped after its density.
    ///
    /// # Errors
    /// As [`open`] with all the files.
    pub fn with_file(&self, path: &Path, limits: &Limits) -> Result<Self, VolumeError> {
        self.with_file_watched(path, limits, &Watch::default())
    }

    /// As [`Volume::with_file`], under the eyes of a watch. Of the file is read what was read of the others.
    ///
    /// # Errors
    /// As [`open_wanted`] with all the files.
    pub fn with_file_watched(
        &self,
        path: &Path,
        limits: &Limits,
        watch: &Watch,
    ) -> Result<Self, VolumeError> {
        let mut paths = self.sources.clone();
        paths.push(path.to_owned());
        open_wanted(&paths, &self.read_for, limits, watch)
    }
}

fn read_file(
    path: &Path,
    wanted: &Wanted,
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    stretch.check()?;
    let io = |source| VolumeError::Io {
        path: path.to_owned(),
        source,
    };
    let about = fs::metadata(path).map_err(io)?;
    if !about.is_file() {
        return Err(VolumeError::Unsupported {
            path: path.to_owned(),
            found: if about.is_dir() {
                "a folder"
            } else {
                "not a regular file"
            },
            advice: "give the volume files themselves",
        });
    }
    limits.check_bytes(path, "the file", about.len())?;
    let mut file = fs::File::open(path).map_err(io)?;
    let mut bytes = Vec::new();
    (&mut file)
        .take(HEAD_BYTES)
        .read_to_end(&mut bytes)
        .map_err(io)?;
    match sniff(&bytes, about.len()) {
        Sniffed::Empty => Err(VolumeError::Empty {
            path: path.to_owned(),
        }),
        Sniffed::Foreign { found, advice } => Err(VolumeError::Unsupported {
            path: path.to_owned(),
            found,
            advice,
        }),
        Sniffed::OpenVdb => openvdb::read(path, &bytes, about.len(), wanted, limits, stretch),
        Sniffed::Text => report_ascii::read(path, file, about.len(), limits, stretch),
        Sniffed::SparseBinary => report_binary::read(path, file, about.len(), limits, stretch),
    }
}

/// Whether two files can be one volume.
fn check_together(a: &FileVolume, b: &FileVolume) -> Result<(), VolumeError> {
    let (first, second) = (a.path.clone(), b.path.clone());
    if (a.format == Format::OpenVdb) != (b.format == Format::OpenVdb) {
        return Err(VolumeError::FormatsDoNotMix { first, second });
    }
    if let (Some(first_dims), Some(second_dims)) = (a.dims, b.dims)
        && first_dims != second_dims
    {
        return Err(VolumeError::DimensionsDiffer {
            first,
            first_dims,
            second,
            second_dims,
        });
    }
    // A box without voxels outside it is all that a sparse file promises about a dense partner.
    for (stated, sparse) in [(a, b), (b, a)] {
        if let (Some(dims), None) = (stated.dims, sparse.dims)
            && a.format != Format::OpenVdb
        {
            let reach = sparse
                .grids
                .iter()
                .fold(super::IndexBox::EMPTY, |sum, grid| sum.union(grid.bounds()));
            if !reach.is_empty() && (reach.min.min_element() < 0 || reach.max.cmpgt(dims).any()) {
                return Err(VolumeError::DimensionsDiffer {
                    first: stated.path.clone(),
                    first_dims: dims,
                    second: sparse.path.clone(),
                    second_dims: reach.max - reach.min.min(IVec3::ZERO),
                });
            }
        }
    }
    // Either name stands for the glowing part of a one-field file.
    let role = |name: &str| match name {
        "soot" if a.format != Format::OpenVdb => "density".to_owned(),
        name => name.to_owned(),
    };
    let common = a
        .grid_names()
        .find(|name| b.grid_names().any(|other| role(other) == role(name)));
    match common {
        Some(field) => Err(VolumeError::SameField {
            first,
            second,
            field: field.to_owned(),
        }),
        None => Ok(()),
    }
}

fn merge(parts: Vec<FileVolume>, wanted: &Wanted, limits: &Limits) -> Volume {
    let format = parts
        .iter()
        .map(|part| part.format)
        .reduce(|a, b| if a == b { a } else { Format::Mixed })
        .unwrap_or(Format::Computed);
    let mut volume = Volume {
        voxel_size_is_known: format == Format::OpenVdb,
        format,
        grids: Vec::new(),
        unread: Vec::new(),
        read_for: wanted.clone(),
        limits: *limits,
        skipped: Vec::new(),
        sources: Vec::new(),
        metadata: Metadata::default(),
        notes: Vec::new(),
        built_in: None,
    };
    for part in parts {
        volume.grids.extend(part.grids);
        volume.unread.extend(part.unread);
        volume.skipped.extend(part.skipped);
        volume.sources.push(part.path);
        volume.notes.extend(part.notes);
        if volume.metadata == Metadata::default() {
            volume.metadata = part.metadata;
        }
    }
    let first = volume.grids.first().map(Grid::world_from_index);
    let differs = |grid: &&Grid| Some(grid.world_from_index()) != first;
    if let (Some(first), Some(other)) = (volume.grids.first(), volume.grids.iter().find(differs)) {
        let note = format!(
            "{} and {} have different voxel sizes or origins: each is placed by its own transform",
            first.name, other.name
        );
        volume.notes.push(note);
    }
    for grid in volume.grids.iter().filter(|grid| grid.bounds().is_empty()) {
        volume
            .notes
            .push(format!("{}: no voxel holds data", grid.name));
    }
    volume
}
