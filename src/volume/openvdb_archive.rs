//! An OpenVDB file whose bytes pass under the eyes of a watch.
//!
//! The third-party reader opens grids by path alone, and would not stop within one. But it reads archives that
//! come as a stream from any source, and an archive is a header, metadata, a count, and for each grid a descriptor
//! and its data. So each grid is given to it as an archive of its own, made up on the way from the file.

use std::borrow::Cow;
use std::fs;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use openvdb_rs::grid::AnyGrid;
use openvdb_rs::io::{Compression, Error as VdbError, File, GridDescriptor, GridMetadata, Stream};
use openvdb_rs::metadata::MetaMap;

use super::openvdb_topology::{Writing, tree_bytes};
use super::watch::Stretch;

/// Bytes of the header: magic number, version, library version, whether offsets follow, identifier.
const HEADER_BYTES: usize = 57;
/// Before this version the header also says whether the file is compressed, in a byte.
const NO_COMPRESSION_BYTE_FROM: u32 = 222;

/// An OpenVDB file, open.
pub(super) enum Archive<'a> {
    /// Grids are found by their offsets.
    Seekable {
        file: File,
        path: &'a Path,
        head: &'a [u8],
    },
    /// Without offsets all grids are read at once.
    Whole(Stream),
}

impl<'a> Archive<'a> {
    /// Opens a file whose header says that offsets follow; `head` is its beginning.
    pub(super) fn open(path: &'a Path, head: &'a [u8]) -> Result<Self, VdbError> {
        let file = File::open(path)?;
        Ok(Self::Seekable { file, path, head })
    }

    /// Reads a file of `length` bytes without offsets, all of it.
    pub(super) fn open_stream(
        path: &Path,
        length: u64,
        stretch: Stretch,
    ) -> Result<Self, VdbError> {
        let bytes = stretch.reader(fs::File::open(path)?, length);
        Stream::read(BufReader::new(bytes)).map(Self::Whole)
    }

    /// What the file says about itself.
    pub(super) fn metadata(&self) -> &MetaMap {
        match self {
            Self::Seekable { file, .. } => file.metadata(),
            Self::Whole(stream) => &stream.metadata,
        }
    }

    /// The grids of the file, in its order.
    pub(super) fn descriptors(&self) -> &[GridDescriptor] {
        match self {
            Self::Seekable { file, .. } => file.descriptors(),
            Self::Whole(stream) => &stream.descriptors,
        }
    }

    /// What a grid says about itself.
    pub(super) fn grid_metadata(
        &self,
        descriptor: &GridDescriptor,
    ) -> Result<GridMetadata, VdbError> {
        match self {
            Self::Seekable { file, .. } => file.read_grid_metadata(&descriptor.unique_name),
            Self::Whole(stream) => {
                let at = position(&stream.descriptors, &descriptor.unique_name)?;
                let metadata = stream.grid_metadata.get(at).cloned();
                metadata.ok_or_else(|| VdbError::GridNotFound(descriptor.unique_name.clone()))
            }
        }
    }

    /// Bytes that the tree of a grid will take; `None` where all trees were read at once.
    pub(super) fn tree_bytes(
        &self,
        descriptor: &GridDescriptor,
        stretch: Stretch,
    ) -> Result<Option<u64>, VdbError> {
        let Self::Seekable { file, path, .. } = self else {
            return Ok(None);
        };
        let owner = owner(file.descriptors(), descriptor)?;
        let header = file.header();
        let writing = Writing {
            version: header.file_version,
            zipped: header.compression.contains(Compression::ZIP),
            value_bytes: match owner.value_type() {
                Some("double") => size_of::<f64>(),
                _ => size_of::<f32>(),
            },
            half: owner.save_float_as_half,
        };
        let (bytes, length) = grid_bytes(path, owner)?;
        // It takes no share of the time worth telling, but can be cancelled.
        let bytes = stretch.part(0.0, 0.0).reader(bytes, length);
        Ok(Some(tree_bytes(BufReader::new(bytes), writing)?))
    }

    /// A grid with its tree: for one that borrows its tree, the grid that it borrows from.
    pub(super) fn grid(
        &self,
        descriptor: &GridDescriptor,
        stretch: Stretch,
    ) -> Result<Cow<'_, AnyGrid>, VdbError> {
        match self {
            Self::Seekable { file, path, head } => {
                let owner = owner(file.descriptors(), descriptor)?;
                let alone = grid_as_archive(path, head, file.header().file_version, owner, stretch);
                let mut grids = Stream::read(BufReader::new(alone?))?.into_grids();
                grids
                    .pop()
                    .map(Cow::Owned)
                    .ok_or_else(|| VdbError::UnsupportedGridType(owner.grid_type.clone()))
            }
            Self::Whole(stream) => {
                let at = position(&stream.descriptors, &descriptor.unique_name)?;
                let grid = stream.grids.get(at).and_then(Option::as_ref);
                grid.map(Cow::Borrowed)
                    .ok_or_else(|| VdbError::UnsupportedGridType(descriptor.grid_type.clone()))
            }
        }
    }
}

/// Whether grids of this type can be fields.
pub(super) fn is_scalar(value_type: &str) -> bool {
    matches!(value_type, "float" | "double")
}

/// What reading a grid costs against the others of its file: its bytes, or 1 for each where the file does not tell.
pub(super) fn cost(descriptor: &GridDescriptor) -> u64 {
    if descriptor.value_type().is_some_and(is_scalar) {
        descriptor.end_pos.abs_diff(descriptor.grid_pos).max(1)
    } else {
        0
    }
}

fn position(descriptors: &[GridDescriptor], unique_name: &str) -> Result<usize, VdbError> {
    let mut names = descriptors.iter().map(|other| &other.unique_name);
    names
        .position(|other| other == unique_name)
        .ok_or_else(|| VdbError::GridNotFound(unique_name.to_owned()))
}

/// Whose tree a grid has.
fn owner<'d>(
    descriptors: &'d [GridDescriptor],
    descriptor: &'d GridDescriptor,
) -> Result<&'d GridDescriptor, VdbError> {
    if !descriptor.is_instance() {
        return Ok(descriptor);
    }
    let owner = &descriptors[position(descriptors, &descriptor.instance_parent)?];
    if owner.grid_type == descriptor.grid_type {
        Ok(owner)
    } else {
        Err(VdbError::Corrupt(
            "a grid and the one that it borrows from have different types".to_owned(),
        ))
    }
}

/// The archive that a file would be if it held only this grid.
fn grid_as_archive<'a>(
    path: &Path,
    head: &[u8],
    version: u32,
    grid: &GridDescriptor,
    stretch: Stretch<'a>,
) -> Result<impl Read + use<'a>, VdbError> {
    let header = HEADER_BYTES + usize::from(version < NO_COMPRESSION_BYTE_FROM);
    let mut before = head.get(..header).unwrap_or(head).to_vec();
    let no_metadata = 0u32;
    before.extend(no_metadata.to_le_bytes());
    let one_grid = 1i32;
    before.extend(one_grid.to_le_bytes());
    let half = if grid.save_float_as_half {
        "_HalfFloat"
    } else {
        ""
    };
    let no_parent = "";
    for text in [
        &grid.unique_name,
        &format!("{}{half}", grid.grid_type),
        no_parent,
    ] {
        before.extend((text.len() as u32).to_le_bytes());
        before.extend(text.as_bytes());
    }
    for offset in [grid.grid_pos, grid.block_pos, grid.end_pos] {
        before.extend(offset.to_le_bytes());
    }
    let (file, length) = grid_bytes(path, grid)?;
    Ok(Cursor::new(before).chain(stretch.reader(file, length)))
}

/// The file from where a grid begins, and how many bytes are the grid's.
fn grid_bytes(path: &Path, grid: &GridDescriptor) -> Result<(fs::File, u64), VdbError> {
    let mut file = fs::File::open(path)?;
    file.seek(SeekFrom::Start(grid.grid_pos.unsigned_abs()))?;
    Ok((file, grid.end_pos.abs_diff(grid.grid_pos)))
}
