//! What the tree of an OpenVDB grid will take in memory, counted before the third-party reader builds any of it.
//!
//! A tree is written twice over: its nodes with their masks and the values of tiles, then the voxels of its leaves. The
//! reader makes room for all voxels of a leaf as soon as it meets the leaf's mask, so the first part alone says what
//! the tree will take. It is small, and most of it is passed over without a look.
//!
//! What is not as it should be ends the count: there the reader ends too, with words of its own.

use std::io::{Error, ErrorKind, Read, Result as IoResult};

use openvdb_rs::math::maps::MapBase;

/// Slots of an inner node, in each of which is a child or a tile: 32³ of the upper, 16³ of the lower.
const UPPER_SLOTS: usize = 1 << 15;
const LOWER_SLOTS: usize = 1 << 12;
/// Voxels of a leaf.
const LEAF_SLOTS: usize = 1 << 9;
/// Of a node: its origin, two boxes, and what an allocator puts around each of its allocations.
const NODE_BYTES: usize = 128;
/// Of an entry of the root's table: a coordinate, a value or a node's address, and up to half of a B-tree's node that is
/// not filled.
const ROOT_ENTRY_BYTES: u64 = 64;

/// Bits of what a grid says about how its values are written.
const ZIPPED: u32 = 0x1;
const ACTIVE_ONLY: u32 = 0x2;
const BLOSC: u32 = 0x4;
/// Before this version the file says once for all grids whether they are zipped, and values of inner nodes are those of
/// tiles alone.
const MASKS_FROM: u32 = 222;
/// How the values of a node are written, in a byte before them: all of them.
const ALL_VALUES: u8 = 6;

/// How a file writes its trees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Writing {
    /// Version of the file's format.
    pub version: u32,
    /// Whether a file older than [`MASKS_FROM`] is zipped.
    pub zipped: bool,
    /// Bytes of a value in memory, 4 or 8.
    pub value_bytes: usize,
    /// Whether values are written as half floats.
    pub half: bool,
}

/// Bytes that the reader's tree of a grid takes, from where the grid begins.
///
/// # Errors
/// What `source` says. That it is too short, or not a tree, is no error: see above.
pub(super) fn tree_bytes(source: impl Read, writing: Writing) -> IoResult<u64> {
    let mut count = Count {
        source,
        writing,
        compression: if writing.zipped { ZIPPED } else { 0 },
        bytes: 0,
    };
    match count.grid() {
        Err(error) if !is_of_the_contents(&error) => Err(error),
        _ => Ok(count.bytes),
    }
}

fn is_of_the_contents(error: &Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::UnexpectedEof | ErrorKind::InvalidData | ErrorKind::Unsupported
    )
}

struct Count<R> {
    source: R,
    writing: Writing,
    compression: u32,
    bytes: u64,
}

impl<R: Read> Count<R> {
    fn grid(&mut self) -> IoResult<()> {
        if self.writing.version >= MASKS_FROM {
            self.compression = self.number()?;
        }
        for _ in 0..self.number()? {
            self.skip_text()?;
            self.skip_text()?;
            self.skip_text()?;
        }
        let length = self.number()?;
        let mut map = Vec::new();
        let source = &mut self.source;
        source.take(u64::from(length)).read_to_end(&mut map)?;
        MapBase::read_typed(&String::from_utf8_lossy(&map), &mut self.source)?;

        let buffers_and_background = 4 + self.writing.value_bytes as u64;
        self.skip(buffers_and_background)?;
        let (tiles, children) = (self.number()?, self.number()?);
        let coordinate = 12;
        let tile = coordinate + self.writing.value_bytes as u64 + 1;
        for _ in 0..tiles {
            self.skip(tile)?;
            self.bytes += ROOT_ENTRY_BYTES;
        }
        for _ in 0..children {
            self.skip(coordinate)?;
            self.bytes += ROOT_ENTRY_BYTES;
            self.upper()?;
        }
        Ok(())
    }

    fn upper(&mut self) -> IoResult<()> {
        for _ in 0..self.inner(UPPER_SLOTS)? {
            for _ in 0..self.inner(LOWER_SLOTS)? {
                self.skip(LEAF_SLOTS as u64 / 8)?;
                let values = LEAF_SLOTS * self.writing.value_bytes;
                self.bytes += (values + LEAF_SLOTS / 8 + NODE_BYTES) as u64;
            }
        }
        Ok(())
    }

    /// Passes over an inner node, and says how many children follow.
    fn inner(&mut self, slots: usize) -> IoResult<u32> {
        let children = self.mask(slots)?;
        let values = self.mask(slots)?;
        let pointer = size_of::<usize>();
        let of_slot = self.writing.value_bytes + pointer;
        self.bytes += (slots * of_slot + 2 * slots / 8 + NODE_BYTES) as u64;
        self.values(slots, children, values)?;
        Ok(children)
    }

    /// Passes over the values of an inner node.
    fn values(&mut self, slots: usize, children: u32, active: u32) -> IoResult<()> {
        let value = self.writing.value_bytes as u64;
        let mut written = slots as u64;
        if self.writing.version < MASKS_FROM {
            written -= u64::from(children);
        } else {
            let [how] = self.read()?;
            // What inactive values there are beside the background and its negative, and which of two each is.
            let inactive = match how {
                0 | 1 | 3 | ALL_VALUES => 0,
                2 | 4 => 1,
                5 => 2,
                _ => return Err(ErrorKind::InvalidData.into()),
            };
            self.skip(inactive * value)?;
            if (3..ALL_VALUES).contains(&how) {
                self.skip(slots as u64 / 8)?;
            }
            if self.compression & ACTIVE_ONLY != 0 && how != ALL_VALUES {
                written = u64::from(active);
            }
        }
        if self.writing.half && written == 0 {
            return Ok(());
        }
        let plain = written * if self.writing.half { 2 } else { value };
        if self.compression & (ZIPPED | BLOSC) == 0 {
            return self.skip(plain);
        }
        // What did not get smaller is written as it was, under a length below zero.
        let length = i64::from_le_bytes(self.read()?);
        self.skip(length.unsigned_abs())
    }

    /// How many bits of a mask are set.
    fn mask(&mut self, slots: usize) -> IoResult<u32> {
        let mut set = 0;
        for _ in 0..slots / 64 {
            set += u64::from_le_bytes(self.read()?).count_ones();
        }
        Ok(set)
    }

    fn number(&mut self) -> IoResult<u32> {
        self.read().map(u32::from_le_bytes)
    }

    fn skip_text(&mut self) -> IoResult<()> {
        let length = self.number()?;
        self.skip(u64::from(length))
    }

    fn read<const N: usize>(&mut self) -> IoResult<[u8; N]> {
        let mut bytes = [0; N];
        self.source.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn skip(&mut self, count: u64) -> IoResult<()> {
        let mut passed = (&mut self.source).take(count);
        let got = std::io::copy(&mut passed, &mut std::io::sink())?;
        if got == count {
            Ok(())
        } else {
            Err(ErrorKind::UnexpectedEof.into())
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use openvdb_rs::grid::{AnyGrid, Grid};
    use openvdb_rs::io::{Compression, File, WriteOptions, write_file_with_options};
    use openvdb_rs::math::{Coord, CoordBBox};
    use openvdb_rs::metadata::MetaMap;

    use super::*;

    /// What a tree with these nodes and entries of the root takes, with values of so many bytes: numbers as they stand
    /// in the format, not as they are written above.
    fn expected([entries, upper, lower, leaves]: [u64; 4], value_bytes: u64) -> u64 {
        64 * entries
            + upper * (32 * 32 * 32 * (value_bytes + 8) + 2 * 4096 + 128)
            + lower * (16 * 16 * 16 * (value_bytes + 8) + 2 * 512 + 128)
            + leaves * (8 * 8 * 8 * value_bytes + 64 + 128)
    }

    #[test]
    fn nodes_are_counted_however_they_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tree.vdb");
        let mut grid = Grid::<f32>::new(0.5).with_name("density");
        // Two leaves in one inner node, one in another, one in a branch of its own; tiles of two levels.
        for voxel in [[0, 0, 0], [9, 0, 0], [300, 0, 0], [-5000, 1, 1]] {
            grid.set_value(&Coord::new(voxel[0], voxel[1], voxel[2]), 0.25);
        }
        let tiles = CoordBBox::from_coords(1024, 0, 0, 1024 + 8 * 16 - 1, 7, 7);
        grid.tree_mut().fill(&tiles, 2.0, true);
        grid.tree_mut()
            .root_mut()
            .add_root_tile(&Coord::new(8192, 0, 0), 3.0, true);
        let nodes = [3, 2, 4, 4];
        let grids = [AnyGrid::from(grid)];
        for compression in [
            Compression::NONE,
            Compression::ZIP,
            Compression::ACTIVE_MASK,
            Compression::ZIP | Compression::ACTIVE_MASK,
            Compression::BLOSC | Compression::ACTIVE_MASK,
        ] {
            let options = WriteOptions {
                compression,
                ..WriteOptions::default()
            };
            write_file_with_options(&path, &grids, &MetaMap::default(), &options).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let file = File::open(&path).unwrap();
            let descriptor = &file.descriptors()[0];
            let writing = Writing {
                version: file.header().file_version,
                zipped: false,
                value_bytes: 4,
                half: false,
            };
            let of_grid = &bytes[descriptor.grid_pos as usize..];
            let counted = |bytes: &[u8]| tree_bytes(bytes, writing).unwrap();
            assert_eq!(counted(of_grid), expected(nodes, 4), "{compression}");
            // The voxels themselves are not needed; of half of the nodes not all is counted.
            let topology = (descriptor.block_pos - descriptor.grid_pos) as usize;
            assert_eq!(counted(&of_grid[..topology]), expected(nodes, 4));
            assert!(counted(&of_grid[..topology / 2]) < expected(nodes, 4));
            for length in 0..topology.min(4000) {
                assert!(counted(&of_grid[..length]) <= expected(nodes, 4));
            }
        }
    }
}
