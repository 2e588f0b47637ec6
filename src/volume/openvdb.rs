//! OpenVDB files, by a pinned reader that never gets further than this file.
//!
//! The reader is young, so it runs inside `catch_unwind`, and everything it is told to read is compared with
//! the length of the file first. Its trees cost at most about fifty times the bytes they were read from (an
//! empty inner node of 1 KiB becomes 49 KiB), one grid at a time. What is added here is meaning: which grids
//! are scalar fields, active masks, active tiles at every level, and what the file announces.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use openvdb_rs::grid::{AnyGrid, GridClass};
use openvdb_rs::io::{Error as VdbError, GridDescriptor, GridMetadata};
use openvdb_rs::math::Vec3d;
use openvdb_rs::metadata::MetaMap;

use super::build::GridHead;
use super::file_volume::FileVolume;
use super::grid::Border;
use super::openvdb_archive::{Archive, cost, is_scalar};
use super::openvdb_tree;
use super::watch::Stretch;
use super::{Format, Limits, Metadata, SkippedGrid, VolumeError};

/// Where the header says whether grid offsets follow. Without them the whole file is read at once.
const HAS_OFFSETS_AT: usize = 20;
/// Such a file must fit the limit even after it has grown in memory.
const STREAM_GROWTH: u64 = 64;
/// Share of the time that the third-party reader takes; the rest is building bricks.
const READING: f32 = 0.7;

/// Reads the scalar grids of a file whose length and first bytes are known.
pub(super) fn read(
    path: &Path,
    head: &[u8],
    length: u64,
    limits: &Limits,
    stretch: Stretch,
) -> Result<FileVolume, VolumeError> {
    let is_stream = head.get(HAS_OFFSETS_AT) == Some(&0);
    if is_stream {
        let grown = length.saturating_mul(STREAM_GROWTH);
        limits.check_bytes(path, "a file without grid offsets", grown)?;
    }
    let reader = Reader {
        path,
        head,
        length,
        is_stream,
        limits: *limits,
        stretch,
    };
    catch_unwind(AssertUnwindSafe(|| reader.read()))
        .unwrap_or_else(|_| Err(reader.damaged("its contents made the OpenVDB reader fail")))
}

struct Reader<'a> {
    path: &'a Path,
    head: &'a [u8],
    length: u64,
    is_stream: bool,
    limits: Limits,
    stretch: Stretch<'a>,
}

impl Reader<'_> {
    fn read(&self) -> Result<FileVolume, VolumeError> {
        let (file, grids) = if self.is_stream {
            let whole = self.stretch.part(0.0, READING);
            let file = Archive::open_stream(self.path, self.length, whole);
            (file, self.stretch.part(READING, 1.0))
        } else {
            (Archive::open(self.path, self.head), self.stretch)
        };
        let file = file.map_err(|error| self.vdb_error(&error))?;
        let mut volume = FileVolume::new(self.path, Format::OpenVdb);
        volume.metadata = metadata(file.metadata());
        self.check_offsets(file.descriptors(), &mut volume.notes)?;

        let mut left = self.limits;
        let mut taken = HashSet::new();
        // In a file without offsets nothing has checked what they seem to say.
        let costs = file.descriptors().iter().map(cost);
        let all = costs.fold(0, u64::saturating_add).max(1) as f32;
        let mut after_it: u64 = 0;
        for descriptor in file.descriptors() {
            let before_it = after_it;
            after_it = after_it.saturating_add(cost(descriptor));
            let stretch = grids.part(before_it as f32 / all, after_it as f32 / all);
            stretch.check()?;
            let name = printable(&descriptor.grid_name);
            let read = self.usable(&file, descriptor, &taken, &mut volume.metadata)?;
            let (transform, announced) = match read {
                Ok(usable) => usable,
                Err(reason) => {
                    volume.skipped.push(SkippedGrid { name, reason });
                    continue;
                }
            };
            left.check_bytes(self.path, &format!("grid {name}"), announced)?;
            let built_from = if self.is_stream { 0.0 } else { READING };
            let building = stretch.part(built_from, 1.0);
            let any = file
                .grid(descriptor, stretch.part(0.0, built_from))
                .map_err(|error| self.vdb_error(&error))?;
            let head = GridHead {
                name,
                world_from_index: transform,
                border: Border::Background,
                background: 0.0,
                stored_as: stored_as(descriptor),
            };
            let (grid, tally) = match any.as_ref() {
                AnyGrid::Float(g) => {
                    openvdb_tree::bricks(self.path, head, g.tree(), |value| value, &left, building)?
                }
                AnyGrid::Double(g) => openvdb_tree::bricks(
                    self.path,
                    head,
                    g.tree(),
                    |value| value as f32,
                    &left,
                    building,
                )?,
                _ => return Err(self.damaged(&format!("grid {} changed its type", head.name))),
            };
            left.max_bytes = left.max_bytes.saturating_sub(grid.bytes());
            volume
                .notes
                .extend(tally.notes(&grid.name, grid.background()));
            taken.insert(descriptor.grid_name.clone());
            volume.grids.push(grid);
        }
        tell_duplicates(&mut volume);
        if volume.grids.is_empty() {
            return Err(VolumeError::NoGrids {
                path: self.path.to_owned(),
                reasons: reasons(&volume.skipped),
            });
        }
        Ok(volume)
    }

    /// Every offset must point into the file.
    fn check_offsets(
        &self,
        descriptors: &[GridDescriptor],
        notes: &mut Vec<String>,
    ) -> Result<(), VolumeError> {
        if self.is_stream {
            return Ok(());
        }
        let mut end = 0;
        for descriptor in descriptors {
            let name = printable(&descriptor.grid_name);
            let offsets = [
                descriptor.grid_pos,
                descriptor.block_pos,
                descriptor.end_pos,
            ];
            let [grid, block, last] = offsets.map(|at| u64::try_from(at).unwrap_or(u64::MAX));
            if last > self.length {
                return Err(self.damaged(&format!(
                    "grid {name} is announced to end at byte {last}, the file has {}; it was cut",
                    self.length
                )));
            }
            if grid > block || block > last {
                return Err(self.damaged(&format!(
                    "the offsets of grid {name} are out of order ({grid}, {block}, {last})"
                )));
            }
            end = end.max(last);
        }
        if end > 0 && end < self.length {
            notes.push(format!(
                "{} bytes after the last grid were not read",
                self.length - end
            ));
        }
        Ok(())
    }

    /// The transform and announced size of a scalar grid, or the reason to pass it over.
    fn usable(
        &self,
        file: &Archive,
        descriptor: &GridDescriptor,
        taken: &HashSet<String>,
        metadata: &mut Metadata,
    ) -> Result<Result<(DAffine3, u64), String>, VolumeError> {
        let kind = match descriptor.value_type() {
            Some(kind) if descriptor.is_supported() => kind,
            _ => {
                return Err(self.damaged(&format!(
                    "grid {} has the unknown type \"{}\"",
                    printable(&descriptor.grid_name),
                    printable(&descriptor.grid_type)
                )));
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
            .map_err(|error| self.vdb_error(&error))?;
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
        Ok(affine(&grid).map(|transform| (transform, announced)))
    }

    fn damaged(&self, message: &str) -> VolumeError {
        VolumeError::Malformed {
            path: self.path.to_owned(),
            line: None,
            message: format!("damaged OpenVDB file: {message}; write the file again"),
        }
    }

    fn vdb_error(&self, error: &VdbError) -> VolumeError {
        match error {
            VdbError::UnsupportedVersion(version) => VolumeError::Malformed {
                path: self.path.to_owned(),
                line: None,
                message: format!(
                    "expected OpenVDB file version 220 to 225, found {version}; write the file with a current OpenVDB"
                ),
            },
            other => self.damaged(&other.to_string()),
        }
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

fn stored_as(descriptor: &GridDescriptor) -> &'static str {
    match descriptor.value_type() {
        _ if descriptor.save_float_as_half => "half",
        Some("double") => "double",
        _ => "float",
    }
}

fn metadata(map: &MetaMap) -> Metadata {
    Metadata {
        creator: map.get_str("creator").map(printable),
        entries: map
            .iter()
            .map(|(name, value)| (printable(name), printable(&value.to_string())))
            .collect(),
    }
}

/// Text of the file for a message or a list: short and without control characters; never empty.
fn printable(text: &str) -> String {
    if text.is_empty() {
        return "(unnamed)".to_owned();
    }
    text.chars()
        .take(200)
        .map(|c| if c.is_control() { '�' } else { c })
        .collect()
}

fn tell_duplicates(volume: &mut FileVolume) {
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

fn reasons(skipped: &[SkippedGrid]) -> String {
    if skipped.is_empty() {
        return "the file has no grids".to_owned();
    }
    let list: Vec<String> = skipped
        .iter()
        .map(|grid| format!("{} ({})", grid.name, grid.reason))
        .collect();
    list.join(", ")
}
