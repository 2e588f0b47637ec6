//! The numbers of a dense ASCII volume, read side by side and made into bricks layer by layer.

use std::path::Path;

use glam::IVec3;
use rayon::prelude::*;

use super::VolumeError;
use super::build::{Gathered, GridHead, NewBrick, bricks_of, dense_bricks};
use super::lattice::BRICK_EDGE;
use super::text::voxel_count;
use super::text_blocks::{Blocks, pieces, read_numbers};
use super::watch::Stretch;

/// Share of a block's time after which its numbers are read; the rest is making bricks.
const NUMBERS_READ: f32 = 0.7;

/// Reads all values of a box that is known to fit.
pub(super) fn read(
    blocks: &mut Blocks<'_>,
    head: &GridHead,
    dims: IVec3,
    stretch: Stretch,
) -> Result<Gathered, VolumeError> {
    let count = voxel_count(dims);
    let mut layers = Layers {
        head,
        dims,
        values: Vec::new(),
        made: 0,
        gathered: Gathered::default(),
    };
    let mut found = 0u64;
    loop {
        let end = blocks.read_numbers(stretch)?;
        if end == 0 {
            break;
        }
        let of_block = blocks.stretch_of(end, stretch);
        let missing = count.saturating_sub(found);
        found += layers.add_numbers(blocks, end, missing, of_block.part(0.0, NUMBERS_READ))?;
        layers.make(of_block.part(NUMBERS_READ, 1.0))?;
        blocks.forget(end);
    }
    if found == count {
        Ok(layers.gathered)
    } else {
        Err(wrong_count(blocks.path, dims, &found.to_string()))
    }
}

/// Values of whole layers become bricks; the others wait.
struct Layers<'a> {
    head: &'a GridHead,
    dims: IVec3,
    /// Values of which no brick is made yet.
    values: Vec<f32>,
    /// Layers of bricks that are made.
    made: i32,
    gathered: Gathered,
}

impl Layers<'_> {
    /// Reads the numbers before `end`, `most` of them at most, and gives how many there are.
    fn add_numbers(
        &mut self,
        blocks: &mut Blocks<'_>,
        end: usize,
        most: u64,
        stretch: Stretch,
    ) -> Result<u64, VolumeError> {
        let block = &blocks.bytes()[..end];
        let pieces = pieces(block);
        let found = pieces.iter().map(|piece| piece.count).sum::<usize>();
        let wanted = usize::try_from(most).map_or(found, |most| found.min(most));
        let waiting = self.values.len();
        self.values.resize(waiting + wanted, 0.0);

        let mut places = &mut self.values[waiting..];
        let tasks: Vec<_> = pieces
            .into_iter()
            .map(|piece| {
                let count = piece.count.min(places.len());
                (
                    piece.bytes,
                    places.split_off_mut(..count).unwrap_or_default(),
                )
            })
            .collect();
        let counter = stretch.counter(tasks.len());
        // The first fault of the file, whichever thread is quicker.
        let fault = tasks.into_par_iter().find_map_first(|(bytes, places)| {
            let goes_on = counter.goes_on();
            let read = goes_on.then(|| read_numbers(block, &bytes, places));
            read.and_then(Result::err)
        });
        stretch.check()?;
        match fault {
            Some(fault) => Err(blocks.malformed(blocks.place(fault.at), fault.message)),
            None => Ok(found as u64),
        }
    }

    /// Makes the bricks of all layers whose values are there.
    fn make(&mut self, stretch: Stretch) -> Result<(), VolumeError> {
        let dims = self.dims;
        let [width, height] = [dims.x as usize, dims.y as usize];
        let slice = width * height;
        let first = self.made * BRICK_EDGE;
        let slices = self.values.len() / slice;
        let end = first + slices as i32;
        let table = bricks_of(dims);
        let last = if end == dims.z {
            table.z
        } else {
            end / BRICK_EDGE
        };
        if last == self.made {
            return Ok(());
        }
        let layers = self.made..last;
        let counter = stretch.counter(layers.len() * table.y as usize);
        let values = &self.values;
        let row = |y: i32, z: i32| {
            let begin = width * (y as usize + height * (z - first) as usize);
            &values[begin..begin + width]
        };
        let made = dense_bricks(self.head, dims, layers, &counter, |coordinate| {
            NewBrick::from_rows(coordinate, self.head.background, dims, row)
        });
        stretch.check()?;
        self.gathered = std::mem::take(&mut self.gathered).and(made);
        let used = slice * (last * BRICK_EDGE).min(dims.z).abs_diff(first) as usize;
        self.values.drain(..used);
        self.made = last;
        Ok(())
    }
}

/// Says that a file holds other than the announced values.
pub(super) fn wrong_count(path: &Path, dims: IVec3, found: &str) -> VolumeError {
    let count = voxel_count(dims);
    VolumeError::Malformed {
        path: path.to_owned(),
        line: None,
        message: format!(
            "the header {} {} {} announces {count} values, found {found}; the file is cut or the header is wrong",
            dims.x, dims.y, dims.z
        ),
    }
}
