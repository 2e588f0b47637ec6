//! What an OpenVDB file says of its grids before their voxels are read: which of them can be fields.

use std::collections::HashSet;
use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use openvdb_rs::grid::GridClass;
use openvdb_rs::io::{Error as VdbError, GridDescriptor, GridMetadata};
use openvdb_rs::math::Vec3d;
use openvdb_rs::metadata::MetaMap;

use super::file_volume::FileVolume;
use super::openvdb_archive::{Archive, is_scalar};
use super::watch::Stretch;
use super::{Metadata, SkippedGrid, VolumeError};

/// A grid that can be a field, before it is read.
pub(super) struct ScalarGrid<'f> {
    pub descriptor: &'f GridDescriptor,
    pub name: String,
    pub world_from_index: DAffine3,
    /// Bytes in memory, as the file has it; 0 where it does not say.
    pub announced: u64,
}

/// The grids that can be fields; the others are told as skipped.
pub(super) fn scalar_grids<'f>(
    path: &Path,
    file: &'f Archive,
    stretch: Stretch,
    volume: &mut FileVolume,
) -> Result<Vec<ScalarGrid<'f>>, VolumeError> {
    let mut taken = HashSet::new();
    let mut found = Vec::new();
    for descriptor in file.descriptors() {
        stretch.check()?;
        match usable(path, file, descriptor, &taken, &mut volume.metadata)? {
            Ok(grid) => {
                taken.insert(&descriptor.grid_name);
                found.push(grid);
            }
            Err(reason) => volume.skipped.push(SkippedGrid {
                name: printable(&descriptor.grid_name),
                reason,
            }),
        }
    }
    Ok(found)
}

/// What the file says of a scalar grid, or the reason to pass it over.
fn usable<'f>(
    path: &Path,
    file: &Archive,
    descriptor: &'f GridDescriptor,
    taken: &HashSet<&String>,
    metadata: &mut Metadata,
) -> Result<Result<ScalarGrid<'f>, String>, VolumeError> {
    let kind = match descriptor.value_type() {
        Some(kind) if descriptor.is_supported() => kind,
        _ => {
            return Err(damaged(
                path,
                &format!(
                    "grid {} has the unknown type \"{}\"",
                    printable(&descriptor.grid_name),
                    printable(&descriptor.grid_type)
                ),
            ));
        }
    };
    if !is_scalar(kind) {
        return Ok(Err(format!("values are {kind}, not scalar floats")));
    }
    if taken.contains(&descriptor.grid_name) {
        return Ok(Err(DUPLICATE.to_owned()));
    }
    if let Some(reason) = bad_instance(file, descriptor) {
        return Ok(Err(reason));
    }
    let grid = file
        .grid_metadata(descriptor)
        .map_err(|error| vdb_error(path, &error))?;
    if metadata.creator.is_none() {
        metadata.creator = grid.metadata.get_str("creator").map(printable);
    }
    let class = grid.metadata.get_str("class").map(GridClass::from_str);
    if class == Some(GridClass::LevelSet) {
        return Ok(Err("a level set, not a fog volume".to_owned()));
    }
    let announced = grid
        .metadata
        .get("file_mem_bytes")
        .and_then(openvdb_rs::metadata::MetaValue::as_i64)
        .map_or(0, |bytes| u64::try_from(bytes).unwrap_or(0));
    Ok(affine(&grid).map(|world_from_index| ScalarGrid {
        descriptor,
        name: printable(&descriptor.grid_name),
        world_from_index,
        announced,
    }))
}

/// The file is an OpenVDB file that is not whole.
pub(super) fn damaged(path: &Path, message: &str) -> VolumeError {
    VolumeError::Malformed {
        path: path.to_owned(),
        line: None,
        message: format!("damaged OpenVDB file: {message}; write the file again"),
    }
}

/// What the third-party reader found, as an error of ours.
pub(super) fn vdb_error(path: &Path, error: &VdbError) -> VolumeError {
    match error {
        VdbError::UnsupportedVersion(version) => VolumeError::Malformed {
            path: path.to_owned(),
            line: None,
            message: format!(
                "expected OpenVDB file version 220 to 225, found {version}; write the file with a current OpenVDB"
            ),
        },
        other => damaged(path, &other.to_string()),
    }
}

const DUPLICATE: &str = "a grid of the same name came before it";

/// Why a grid that borrows the tree of another cannot be read. A chain of borrowers could be a circle.
fn bad_instance(file: &Archive, descriptor: &GridDescriptor) -> Option<String> {
    if !descriptor.is_instance() {
        return None;
    }
    let parent = file
        .descriptors()
        .iter()
        .find(|d| d.unique_name == descriptor.instance_parent);
    match parent {
        Some(parent) if !parent.is_instance() => None,
        Some(_) => Some("it borrows from a grid that borrows itself".to_owned()),
        None => Some("the grid it borrows from is missing".to_owned()),
    }
}

/// The transform as an affine map, or why there is none.
fn affine(grid: &GridMetadata) -> Result<DAffine3, String> {
    let transform = grid
        .transform
        .as_ref()
        .filter(|transform| transform.is_linear())
        .ok_or_else(|| {
            format!(
                "its transform {} is not linear (a frustum): resample it",
                printable(&grid.map_type)
            )
        })?;
    let at = |x: f64, y: f64, z: f64| {
        let world = transform.index_to_world(Vec3d::new(x, y, z));
        DVec3::new(world[0], world[1], world[2])
    };
    let origin = at(0.0, 0.0, 0.0);
    let matrix = DMat3::from_cols(
        at(1.0, 0.0, 0.0) - origin,
        at(0.0, 1.0, 0.0) - origin,
        at(0.0, 0.0, 1.0) - origin,
    );
    let affine = DAffine3 {
        matrix3: matrix,
        translation: origin,
    };
    let inverse_is_finite = affine.is_finite() && affine.inverse().is_finite();
    if matrix.determinant() == 0.0 || !inverse_is_finite {
        return Err("its transform cannot be inverted".to_owned());
    }
    Ok(affine)
}

/// How a grid's values are written.
pub(super) fn stored_as(descriptor: &GridDescriptor) -> &'static str {
    match descriptor.value_type() {
        _ if descriptor.save_float_as_half => "half",
        Some("double") => "double",
        _ => "float",
    }
}

/// What the file says of itself.
pub(super) fn metadata(map: &MetaMap) -> Metadata {
    Metadata {
        creator: map.get_str("creator").map(printable),
        entries: map
            .iter()
            .map(|(name, value)| (printable(name), printable(&value.to_string())))
            .collect(),
    }
}

/// Text of the file for a message or a list: short and without control characters; never empty.
pub(super) fn printable(text: &str) -> String {
    if text.is_empty() {
        return "(unnamed)".to_owned();
    }
    text.chars()
        .take(200)
        .map(|c| if c.is_control() { '�' } else { c })
        .collect()
}

/// Notes which names came more than once.
pub(super) fn tell_duplicates(volume: &mut FileVolume) {
    let mut told = HashSet::new();
    for skipped in volume
        .skipped
        .iter()
        .filter(|grid| grid.reason == DUPLICATE)
    {
        if told.insert(skipped.name.as_str()) {
            let doubles = volume
                .skipped
                .iter()
                .filter(|grid| grid.reason == DUPLICATE && grid.name == skipped.name);
            let count = 1 + doubles.count();
            volume.notes.push(format!(
                "{count} grids named {}: the first was used",
                skipped.name
            ));
        }
    }
}
