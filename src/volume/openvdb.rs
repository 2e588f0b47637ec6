//! OpenVDB files, by a pinned reader that never gets further than the files named after them.
//!
//! The reader is young, so it runs inside `catch_unwind`, and everything it is told to read is compared with
//! the length of the file first. Its trees, one at a time, cost up to about fifty times the bytes they were read
//! from (an empty inner node of 1 KiB becomes 49 KiB), so what a tree will cost is counted before it is built. What
//! is added here is meaning: which grids are scalar fields, active masks, active tiles at every level, and what the
//! file announces.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use openvdb_rs::grid::AnyGrid;
use openvdb_rs::io::GridDescriptor;

use super::build::GridHead;
use super::file_volume::FileVolume;
use super::grid::{Border, Grid};
use super::openvdb_archive::{Archive, cost};
use super::openvdb_heads::{
    ScalarGrid, damaged, metadata, printable, scalar_grids, stored_as, tell_duplicates, vdb_error,
};
use super::openvdb_tree;
use super::watch::Stretch;
use super::{Format, Limits, SkippedGrid, UnreadGrid, VolumeError, Wanted};

/// Where the header says whether grid offsets follow. Without them the whole file is read at once.
const HAS_OFFSETS_AT: usize = 20;
/// Such a file must fit the limit even after it has grown in memory.
const STREAM_GROWTH: u64 = 64;
/// Share of the time that the third-party reader takes; the rest is building bricks.
const READING: f32 = 0.7;

/// Reads the wanted grids of a file whose length and first bytes are known.
pub(super) fn read(
    path: &Path,
    head: &[u8],
    length: u64,
    wanted: &Wanted,
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
        wanted,
        limits: *limits,
        stretch,
    };
    contained(path, || reader.read())
}

/// What a reader gives; its panic becomes an error like any other.
fn contained<T>(
    path: &Path,
    read: impl FnOnce() -> Result<T, VolumeError>,
) -> Result<T, VolumeError> {
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(damaged(path, "its contents made the OpenVDB reader fail")))
}

struct Reader<'a> {
    path: &'a Path,
    head: &'a [u8],
    length: u64,
    is_stream: bool,
    wanted: &'a Wanted,
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
        let file = file.map_err(|error| vdb_error(self.path, &error))?;
        let mut volume = FileVolume::new(self.path, Format::OpenVdb);
        volume.metadata = metadata(file.metadata());
        self.check_offsets(file.descriptors(), &mut volume.notes)?;

        let found = scalar_grids(self.path, &file, self.stretch, &mut volume)?;
        self.read_wanted(&file, &found, grids, &mut volume)?;
        tell_duplicates(&mut volume);
        if volume.grids.is_empty() {
            return Err(VolumeError::NoGrids {
                path: self.path.to_owned(),
                reasons: reasons(&volume.skipped),
            });
        }
        Ok(volume)
    }

    /// Reads what is wanted, one after the other: what a grid holds may say whether another is needed.
    fn read_wanted(
        &self,
        file: &Archive,
        found: &[ScalarGrid],
        stretch: Stretch,
        volume: &mut FileVolume,
    ) -> Result<(), VolumeError> {
        let mut left = self.limits;
        let mut grids: Vec<Option<Grid>> = found.iter().map(|_| None).collect();
        // In a file without offsets nothing has checked what they seem to say.
        let costs = found.iter().map(|grid| cost(grid.descriptor));
        let all = costs.fold(0, u64::saturating_add).max(1) as f32;
        let mut after_it: u64 = 0;
        loop {
            let names = found.iter().map(|grid| grid.name.as_str());
            let known: Vec<_> = names.zip(grids.iter().map(Option::as_ref)).collect();
            let Some(next) = self.wanted.next(&known) else {
                break;
            };
            let Some(at) = grids
                .iter()
                .zip(found)
                .position(|(read, it)| read.is_none() && it.name == next)
            else {
                break;
            };
            let before_it = after_it;
            after_it = after_it.saturating_add(cost(found[at].descriptor));
            let stretch = stretch.part(before_it as f32 / all, after_it as f32 / all);
            stretch.check()?;
            let grid = self
                .read_grid(file, &found[at], &left, stretch, &mut volume.notes)
                .map_err(|error| error.beside(self.limits.max_bytes - left.max_bytes))?;
            left.max_bytes = left.max_bytes.saturating_sub(grid.bytes());
            grids[at] = Some(grid);
        }
        for (found, grid) in found.iter().zip(grids) {
            match grid {
                Some(grid) => volume.grids.push(grid),
                None => volume.unread.push(UnreadGrid {
                    name: found.name.clone(),
                    stored_as: stored_as(found.descriptor),
                }),
            }
        }
        Ok(())
    }

    fn read_grid(
        &self,
        file: &Archive,
        found: &ScalarGrid,
        left: &Limits,
        stretch: Stretch,
        notes: &mut Vec<String>,
    ) -> Result<Grid, VolumeError> {
        left.check_bytes(self.path, &format!("grid {}", found.name), found.announced)?;
        let tree = file
            .tree_bytes(found.descriptor, stretch)
            .map_err(|error| vdb_error(self.path, &error))?;
        self.limits.check_bytes(
            self.path,
            &format!("the tree of grid {}", found.name),
            tree.unwrap_or(0),
        )?;
        let built_from = if self.is_stream { 0.0 } else { READING };
        let building = stretch.part(built_from, 1.0);
        let any = file
            .grid(found.descriptor, stretch.part(0.0, built_from))
            .map_err(|error| vdb_error(self.path, &error))?;
        let head = GridHead {
            name: found.name.clone(),
            world_from_index: found.world_from_index,
            border: Border::Background,
            background: 0.0,
            stored_as: stored_as(found.descriptor),
        };
        let (grid, tally) = match any.as_ref() {
            AnyGrid::Float(g) => {
                openvdb_tree::bricks(self.path, head, g.tree(), |value| value, left, building)?
            }
            AnyGrid::Double(g) => openvdb_tree::bricks(
                self.path,
                head,
                g.tree(),
                |value| value as f32,
                left,
                building,
            )?,
            _ => {
                return Err(damaged(
                    self.path,
                    &format!("grid {} changed its type", head.name),
                ));
            }
        };
        notes.extend(tally.notes(&grid.name, grid.background()));
        Ok(grid)
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
                return Err(damaged(
                    self.path,
                    &format!(
                        "grid {name} is announced to end at byte {last}, the file has {}; it was cut",
                        self.length
                    ),
                ));
            }
            if grid > block || block > last {
                return Err(damaged(
                    self.path,
                    &format!(
                        "the offsets of grid {name} are out of order ({grid}, {block}, {last})"
                    ),
                ));
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn a_panic_of_the_reader_is_an_error_that_names_the_file_and_what_to_do() {
        let path = Path::new("fire.vdb");
        let numbers: Vec<i32> = Vec::new();
        let error = contained(path, || Ok(numbers[path.as_os_str().len()])).unwrap_err();
        let words = error.to_string();
        assert!(
            words.starts_with("fire.vdb: damaged OpenVDB file")
                && words.ends_with("write the file again"),
            "{words}"
        );
        assert_eq!(contained(path, || Ok(1)).unwrap(), 1);
    }
}
