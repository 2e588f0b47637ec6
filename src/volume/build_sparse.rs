//! Sparse grids from lists of voxels in any order.

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::IVec3;
use rayon::prelude::*;

use super::build::{Gathered, NewBrick};
use super::lattice::{BRICK_LEN, IndexBox, brick_of, offset_in_brick};
use super::new_brick::Known;
use super::watch::Stretch;
use super::{Limits, VolumeError};

/// Heaps into which bricks are parted, each filled by one thread at a time.
const HEAPS: usize = 16;

/// A voxel and its value.
type Voxel = (IVec3, f32);

/// Voxels of a part of a file in its order, parted by the heaps of their bricks.
#[derive(Default)]
pub(super) struct Sorted {
    heaps: [Vec<Voxel>; HEAPS],
    bounds: Option<IndexBox>,
}

impl Sorted {
    /// Adds a voxel.
    pub(super) fn push(&mut self, voxel: IVec3, value: f32) {
        let own = IndexBox {
            min: voxel,
            max: voxel + IVec3::ONE,
        };
        self.bounds = Some(self.bounds.map_or(own, |bounds| bounds.union(own)));
        self.heaps[heap_of(brick_of(voxel))].push((voxel, value));
    }
}

/// Neighbours lie in different heaps, so that each has a share of any part of a file.
fn heap_of(brick: IVec3) -> usize {
    let mixed = brick.x ^ brick.y.wrapping_mul(5) ^ brick.z.wrapping_mul(11);
    mixed as usize % HEAPS
}

/// Voxels on their way into bricks.
pub(super) struct Voxels {
    limits: Limits,
    heaps: Vec<Heap>,
    bounds: IndexBox,
    /// Bricks that are stored.
    stored: AtomicU64,
}

/// Some of the bricks.
#[derive(Default)]
struct Heap {
    places: HashMap<IVec3, usize>,
    bricks: Vec<Loose>,
    repeated: u64,
}

/// A brick that is not whole yet.
struct Loose {
    coordinate: IVec3,
    /// None where there are too many bricks: they are counted, to be told.
    values: Option<Box<[f32; BRICK_LEN]>>,
    known: Known,
}

impl Voxels {
    /// None yet.
    pub(super) fn new(limits: &Limits) -> Self {
        Self {
            limits: *limits,
            heaps: (0..HEAPS).map(|_| Heap::default()).collect(),
            bounds: IndexBox::EMPTY,
            stored: AtomicU64::new(0),
        }
    }

    /// Adds parts of a file, which come in its order: the last value of a voxel is kept.
    ///
    /// # Errors
    /// [`VolumeError::Cancelled`].
    pub(super) fn add(&mut self, parts: &[Sorted], stretch: Stretch) -> Result<(), VolumeError> {
        let bounds = parts.iter().filter_map(|part| part.bounds);
        self.bounds = bounds.fold(self.bounds, IndexBox::union);
        if self.bounds.brick_count() > self.limits.max_extent_bricks {
            // They will be refused once the file is known to be sound.
            self.heaps
                .iter_mut()
                .for_each(|heap| *heap = Heap::default());
            return Ok(());
        }
        let most = self.limits.most_bricks();
        let (stored, counter) = (&self.stored, stretch.counter(HEAPS));
        self.heaps.par_iter_mut().enumerate().for_each(|(i, heap)| {
            if counter.goes_on() {
                let may_store = || stored.fetch_add(1, Ordering::Relaxed) < most;
                for part in parts {
                    heap.add(&part.heaps[i], may_store);
                }
            }
        });
        stretch.check()
    }

    /// The bricks, with the number of voxels that came more than once.
    ///
    /// # Errors
    /// [`VolumeError::TooLarge`]; [`VolumeError::Cancelled`].
    pub(super) fn into_bricks(
        self,
        background: f32,
        path: &Path,
        limits: &Limits,
        stretch: Stretch,
    ) -> Result<(Gathered, u64), VolumeError> {
        limits.check_extent(path, "the box of its voxels", self.bounds)?;
        let count = self.heaps.iter().map(|heap| heap.bricks.len()).sum();
        limits.check_bricks(path, "the grid", count as u64)?;
        let repeated = self.heaps.iter().map(|heap| heap.repeated).sum();
        let counter = stretch.counter(count);
        let gathered = self
            .heaps
            .into_par_iter()
            .flat_map(|heap| heap.bricks)
            .filter_map(|loose| {
                let values = counter.goes_on().then_some(loose.values).flatten()?;
                let Loose {
                    coordinate, known, ..
                } = loose;
                Some(NewBrick::from_values(
                    coordinate, background, values, &known,
                ))
            })
            .fold(Gathered::default, Gathered::with)
            .reduce(Gathered::default, Gathered::and);
        stretch.check()?;
        Ok((gathered, repeated))
    }
}

impl Heap {
    /// Puts voxels into their bricks; a new one is stored if `may_store` says so.
    fn add(&mut self, voxels: &[Voxel], may_store: impl Fn() -> bool) {
        for run in voxels.chunk_by(|a, b| brick_of(a.0) == brick_of(b.0)) {
            let coordinate = brick_of(run[0].0);
            let bricks = &mut self.bricks;
            let place = *self.places.entry(coordinate).or_insert_with(|| {
                bricks.push(Loose {
                    coordinate,
                    values: may_store().then(|| Box::new([0.0; BRICK_LEN])),
                    known: Known::default(),
                });
                bricks.len() - 1
            });
            let Loose { values, known, .. } = &mut self.bricks[place];
            let Some(values) = values else {
                continue;
            };
            for (voxel, value) in run {
                let offset = offset_in_brick(*voxel);
                self.repeated += u64::from(!known.mark(offset));
                values[offset] = *value;
            }
        }
    }
}

/// Says how often a voxel came again.
pub(super) fn repeated_note(repeated: u64) -> Option<String> {
    (repeated > 0)
        .then(|| format!("{repeated} voxels came more than once: the last value was kept"))
}
