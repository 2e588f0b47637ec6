//! A brick on its way into a grid, with the statistics of its values.

use glam::IVec3;

use super::grid::Brick;
use super::lattice::{BRICK_EDGE, BRICK_LEN, IndexBox, offset_in_brick};

/// Beyond this a value has no meaning in any unit, and one such voxel would spoil the range of its field.
const LARGEST: f32 = 1e20;

/// False for NaN, infinities and absurdly large values.
pub(super) fn is_usable(raw: f32) -> bool {
    raw.abs() <= LARGEST
}

/// Counts of what is worth telling about the values, taken over active voxels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tally {
    pub(super) bounds: IndexBox,
    /// Lowest and highest usable value; the other way round where there is none.
    pub(super) range: (f32, f32),
    pub(super) active: u64,
    /// NaN, infinities and absurdly large values, read as the background.
    unusable: u64,
    negative: u64,
}

impl Default for Tally {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Tally {
    pub(super) const EMPTY: Self = Self {
        bounds: IndexBox::EMPTY,
        range: (f32::INFINITY, f32::NEG_INFINITY),
        active: 0,
        unusable: 0,
        negative: 0,
    };

    /// The counts of many bricks together.
    pub(super) fn of(bricks: &[NewBrick]) -> Self {
        bricks
            .iter()
            .fold(Self::EMPTY, |sum, brick| sum.merge(brick.tally))
    }

    pub(super) fn merge(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            range: (
                self.range.0.min(other.range.0),
                self.range.1.max(other.range.1),
            ),
            active: self.active + other.active,
            unusable: self.unusable + other.unusable,
            negative: self.negative + other.negative,
        }
    }

    /// The largest usable value, 0 where there is none.
    pub(super) fn largest(&self) -> f32 {
        if self.range.1.is_finite() {
            self.range.1
        } else {
            0.0
        }
    }

    /// Records one active sample and returns the value to store. Without jumps, so that many are looked at at once.
    fn take(&mut self, raw: f32, background: f32) -> f32 {
        let usable = is_usable(raw);
        let or = |other: f32| if usable { raw } else { other };
        self.unusable += u64::from(!usable);
        self.negative += u64::from(or(0.0) < 0.0);
        self.range = (
            self.range.0.min(or(f32::INFINITY)),
            self.range.1.max(or(f32::NEG_INFINITY)),
        );
        or(background)
    }

    /// The flaws of a grid's values, in words.
    pub(super) fn notes(&self, grid: &str, background: f32) -> Vec<String> {
        let mut notes = Vec::new();
        if self.unusable > 0 {
            notes.push(format!(
                "{grid}: NaN, infinity or values beyond 1e20 in {} voxels read as {background}",
                self.unusable
            ));
        }
        if self.negative > 0 {
            notes.push(format!(
                "{grid}: negative values in {} voxels",
                self.negative
            ));
        }
        notes
    }
}

/// Which of a brick's voxels hold data: a bit for each, a word for each layer of z, a byte for each row of x.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Known([u64; BRICK_EDGE as usize]);

impl Known {
    /// Marks a voxel by its offset in the brick; false if it was marked before.
    pub(super) fn mark(&mut self, offset: usize) -> bool {
        let (word, bit) = (&mut self.0[offset >> 6], 1 << (offset & 63));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }

    /// Marks some voxels of a row, from an offset on.
    fn mark_row(&mut self, offset: usize, width: usize) {
        let row = (1u64 << width) - 1;
        self.0[offset >> 6] |= row << (offset & 63);
    }

    /// Whether every voxel is marked.
    fn is_full(&self) -> bool {
        self.0 == [u64::MAX; BRICK_EDGE as usize]
    }

    fn has(&self, offset: usize) -> bool {
        self.0[offset >> 6] >> (offset & 63) & 1 == 1
    }

    fn count(&self) -> u64 {
        self.0.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// The box of the marked voxels, from the brick's first voxel.
    fn bounds(&self) -> IndexBox {
        let layer = self.0.iter().fold(0, |layer, word| layer | word);
        let row = layer
            .to_le_bytes()
            .into_iter()
            .fold(0, |row, byte| row | byte);
        if row == 0 {
            return IndexBox::EMPTY;
        }
        let edge = BRICK_EDGE;
        let layers = |word: &u64| *word != 0;
        let first_z = self.0.iter().position(layers).map_or(0, |z| z as i32);
        let last_z = self.0.iter().rposition(layers).map_or(0, |z| z as i32);
        IndexBox {
            min: IVec3::new(
                row.trailing_zeros() as i32,
                layer.trailing_zeros() as i32 / edge,
                first_z,
            ),
            max: IVec3::new(
                edge - row.leading_zeros() as i32,
                edge - layer.leading_zeros() as i32 / edge,
                last_z + 1,
            ),
        }
    }
}

/// A brick on its way into a grid.
pub(super) struct NewBrick {
    pub(super) coordinate: IVec3,
    /// None where every sample is the background.
    pub(super) brick: Option<Brick>,
    pub(super) tally: Tally,
}

impl NewBrick {
    /// A brick from the values of its voxels, x fastest, of which those that hold data are marked; the rest becomes the
    /// background.
    pub(super) fn from_values(
        coordinate: IVec3,
        background: f32,
        mut values: Box<[f32; BRICK_LEN]>,
        known: &Known,
    ) -> Self {
        let origin = coordinate * BRICK_EDGE;
        let inner = known.bounds();
        let mut tally = Tally {
            active: known.count(),
            ..Tally::EMPTY
        };
        if !inner.is_empty() {
            tally.bounds = IndexBox {
                min: origin + inner.min,
                max: origin + inner.max,
            };
        }
        if known.is_full() {
            for value in values.iter_mut() {
                *value = tally.take(*value, background);
            }
        } else {
            for (offset, value) in values.iter_mut().enumerate() {
                *value = if known.has(offset) {
                    tally.take(*value, background)
                } else {
                    background
                };
            }
        }
        Self {
            coordinate,
            brick: compact(values, background),
            tally,
        }
    }

    /// A brick from its samples; `None` is a voxel without data.
    pub(super) fn from_samples(
        coordinate: IVec3,
        background: f32,
        sample: impl Fn(IVec3) -> Option<f32>,
    ) -> Self {
        let mut known = Known::default();
        let mut values = Box::new([background; BRICK_LEN]);
        let origin = coordinate * BRICK_EDGE;
        for (offset, value) in values.iter_mut().enumerate() {
            if let Some(raw) = sample(origin + voxel_at(offset)) {
                *value = raw;
                known.mark(offset);
            }
        }
        Self::from_values(coordinate, background, values, &known)
    }

    /// A brick from the rows of a dense box of voxels: `row(y, z)` gives the values of one, from x = 0 to the end of the
    /// box, `dims` of them in every direction.
    pub(super) fn from_rows<'a>(
        coordinate: IVec3,
        background: f32,
        dims: IVec3,
        row: impl Fn(i32, i32) -> &'a [f32],
    ) -> Self {
        let mut known = Known::default();
        let mut values = Box::new([background; BRICK_LEN]);
        let origin = coordinate * BRICK_EDGE;
        let within = (dims - origin).clamp(IVec3::ZERO, IVec3::splat(BRICK_EDGE));
        let width = within.x as usize;
        for z in 0..within.z {
            for y in 0..within.y {
                let all = row(origin.y + y, origin.z + z);
                let begin = offset_in_brick(IVec3::new(0, y, z));
                let first = origin.x as usize;
                let own = all.get(first..first + width).unwrap_or_default();
                values[begin..begin + own.len()].copy_from_slice(own);
                known.mark_row(begin, own.len());
            }
        }
        Self::from_values(coordinate, background, values, &known)
    }

    /// A brick whose 512 voxels all hold data of one value.
    pub(super) fn constant(coordinate: IVec3, raw: f32, background: f32) -> Self {
        let origin = coordinate * BRICK_EDGE;
        let mut tally = Tally::EMPTY;
        let value = tally.take(raw, background);
        let count = BRICK_LEN as u64;
        tally = Tally {
            bounds: IndexBox {
                min: origin,
                max: origin + IVec3::splat(BRICK_EDGE),
            },
            active: count,
            unusable: tally.unusable * count,
            negative: tally.negative * count,
            ..tally
        };
        Self {
            coordinate,
            brick: (value != background).then_some(Brick::Constant(value)),
            tally,
        }
    }

    /// Fills the samples of an edge brick that lie beyond `last` with the nearest sample inside.
    pub(super) fn repeat_edge(&mut self, last: IVec3, background: f32) {
        let origin = self.coordinate * BRICK_EDGE;
        if (origin + IVec3::splat(BRICK_EDGE - 1)).cmple(last).all() {
            return;
        }
        // A constant brick stays constant, and a background brick is background to its edge.
        if !matches!(self.brick, Some(Brick::Dense(_))) {
            return;
        }
        if let Some(Brick::Dense(mut values)) = self.brick.take() {
            for offset in 0..BRICK_LEN {
                let inside = (origin + voxel_at(offset)).min(last);
                values[offset] = values[offset_in_brick(inside)];
            }
            self.brick = compact(values, background);
        }
    }
}

/// The voxel at an offset, from the brick's first voxel.
fn voxel_at(offset: usize) -> IVec3 {
    IVec3::new(
        (offset & 7) as i32,
        (offset >> 3 & 7) as i32,
        (offset >> 6) as i32,
    )
}

/// The cheapest form of a brick.
fn compact(values: Box<[f32; BRICK_LEN]>, background: f32) -> Option<Brick> {
    let first = values[0];
    if values.iter().any(|value| *value != first) {
        Some(Brick::Dense(values))
    } else {
        (first != background).then_some(Brick::Constant(first))
    }
}

#[cfg(test)]
mod tests;
