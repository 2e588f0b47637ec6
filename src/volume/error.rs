//! What can go wrong between a path and a volume, in words for the person who gave the path.

use std::path::PathBuf;

use glam::IVec3;

/// Why files could not become a volume. Each message names the file, what was expected and found, and what to
/// do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// No path was given.
    #[error("no file was given: name one volume file, or several that belong together")]
    NoFiles,
    /// A [`Watch`](super::Watch) was told to stop.
    #[error("opening was cancelled before the volume was complete: open it again to have it")]
    Cancelled,
    /// The operating system refused.
    #[error("{path}: cannot be read: {source}", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file has no contents.
    #[error("{path}: the file is empty: expected an OpenVDB, dense ASCII or sparse binary volume", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is something else, which is known by its first bytes.
    #[error("{path}: this is {found}, which cannot be read as a volume: {advice}", path = path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What it is.
        found: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The contents break the rules of their format.
    #[error("{path}: {line}{message}", path = path.display(), line = line_prefix(*line))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1, where the format has lines.
        line: Option<u64>,
        /// What was expected, what was found, and what to do.
        message: String,
    },
    /// The volume would need more than the limits allow.
    #[error("{path}: {what} needs {needed} {unit}, the limit is {limit}: crop or resample the volume{or}", path = path.display(), or = or_raise(*raise_to_mb))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The part that is too large.
        what: String,
        /// How much it needs, in `unit`.
        needed: u64,
        /// How much is allowed, in `unit`.
        limit: u64,
        /// "bytes" or "bricks of 8³ voxels".
        unit: &'static str,
        /// The limit under which it fits, in megabytes of 10⁶ bytes, if there is one.
        raise_to_mb: Option<u64>,
    },
    /// The file is well-formed but none of its grids can be used.
    #[error("{path}: no scalar grid can be used: {reasons}; expected a float, half or double fog volume such as density, flame or temperature", path = path.display())]
    NoGrids {
        /// The file.
        path: PathBuf,
        /// Each grid with the reason why not.
        reasons: String,
    },
    /// Two files that were given together do not fit.
    #[error("{first} is {first_dims} voxels but {second} is {second_dims}: fields that are given together need equal dimensions",
        first = first.display(), second = second.display(), first_dims = dims(*first_dims), second_dims = dims(*second_dims))]
    DimensionsDiffer {
        /// One file.
        first: PathBuf,
        /// Its width, height and depth.
        first_dims: IVec3,
        /// The other file.
        second: PathBuf,
        /// Its width, height and depth.
        second_dims: IVec3,
    },
    /// Two files that were given together carry the same field.
    #[error("{first} and {second} both hold {field}: open one of them (frames of a sequence come with it), or, for two fields of one fire, put \"density\" and \"temperature\" into the file names",
        first = first.display(), second = second.display())]
    SameField {
        /// One file.
        first: PathBuf,
        /// The other file.
        second: PathBuf,
        /// The field's name.
        field: String,
    },
    /// Two files that were given together place their voxels in different ways.
    #[error("{first} and {second} cannot be one volume: an OpenVDB file says where its voxels are, the other format does not; convert one of them",
        first = first.display(), second = second.display())]
    FormatsDoNotMix {
        /// One file.
        first: PathBuf,
        /// The other file.
        second: PathBuf,
    },
}

fn line_prefix(line: Option<u64>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

fn or_raise(megabytes: Option<u64>) -> String {
    megabytes.map_or_else(String::new, |mb| {
        format!(", or raise volume.memory_limit_mb to {mb}")
    })
}

fn dims(dims: IVec3) -> String {
    format!("{} × {} × {}", dims.x, dims.y, dims.z)
}
