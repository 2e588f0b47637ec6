//! What the cells smear is put back as far as they can hold it, and their own glow is taken out, which the march adds
//! finer: see [`crate::render::own_light`].
//!
//! A ray finds means between four cells, and a cell means between four rays. Along an axis, means between two cells that
//! are a apart, over all places between them, spread a peak by a variance of a²/6; twice over by a²/3. A spread of
//! variance v is to first order 1 + v/2 ∇², and so undone by 1 − v/2 ∇².

use rayon::prelude::*;

use super::gathered::Gathered;
use crate::math::lanes::{self, Arithmetic, Kernel};
use crate::render::cells::{Cells, Chunk, WIDE};
use crate::render::own_light::own_light;
use crate::render::preparation::Watch;

/// Half the variance of the two means, in cells².
const HALF_SPREAD: f32 = 1.0 / 6.0;

/// Weights of a cell and of each of its neighbours along an axis in a mean that spreads a peak as the two means do.
const SPREAD: [f32; 2] = [1.0 - 2.0 * HALF_SPREAD, HALF_SPREAD];

/// The light of all cells, sharpened, less what they see of their own glow. `None` if cancelled.
pub(super) fn sharpened(
    gathered: &Gathered<'_>,
    extinction: &[Vec<Chunk>; 2],
    reach_m: f32,
    watch: &Watch<'_>,
) -> Option<Vec<Chunk>> {
    let (cells, chunks) = (gathered.cells, gathered.cells.chunks);
    let mut own = cells.records.clone();
    own.par_chunks_exact_mut(chunks)
        .zip(&cells.filled)
        .filter(|(_, filled)| **filled)
        .for_each(|(record, _)| see_own(record, extinction, reach_m));
    let mut light = vec![[0.0; WIDE]; gathered.light.len()];
    let [x, y, z] = cells.size;
    let pieces = watch.pieces(z);
    light
        .par_chunks_exact_mut((x * y * chunks).max(1))
        .enumerate()
        .try_for_each(|(layer, light)| {
            pieces.begin()?;
            lanes::dispatch(Layer {
                gathered,
                cells,
                own: &own,
                z: layer,
                light,
            });
            Some(())
        })?;
    Some(light)
}

/// Turns a record into the light that its cell has of its own glow.
fn see_own(record: &mut [Chunk], [soot, smoke]: &[Vec<Chunk>; 2], reach_m: f32) {
    let [of_soot, of_smoke] = [record[0][0], record[0][1]];
    for (chunk, own) in record.iter_mut().enumerate() {
        for (number, own) in own.iter_mut().enumerate() {
            let extinction = soot[chunk][number] * of_soot + smoke[chunk][number] * of_smoke;
            *own = own_light(*own, extinction, 1.0, reach_m);
        }
    }
}

/// One layer of cells.
struct Layer<'a, 'b> {
    gathered: &'a Gathered<'a>,
    cells: &'a Cells,
    own: &'a [Chunk],
    z: usize,
    light: &'b mut [Chunk],
}

impl Kernel for Layer<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        let (size, chunks) = (self.cells.size, self.cells.chunks);
        let (strides, to_eye) = (self.cells.strides(), &self.gathered.to_eye);
        let inner = [1, size[0], size[0] * size[1]];
        let asked = |cell: usize| to_eye[cell] != [0.0; 3];
        for i in 0..size[0] * size[1] {
            let (here, place) = (self.z * inner[2] + i, [i % size[0], i / size[0], self.z]);
            if !asked(here) {
                continue;
            }
            // Sharper along each axis on which both neighbours are known.
            let between = std::array::from_fn(|axis| {
                let inside = place[axis] > 0 && place[axis] + 1 < size[axis];
                inside && asked(here - inner[axis]) && asked(here + inner[axis])
            });
            for chunk in 0..chunks {
                let mut value = self.sharp(here, inner, between, chunk);
                let own = self.spread_own(self.cells.at(place), strides, chunk);
                for (value, own) in value.iter_mut().zip(own) {
                    *value -= own;
                }
                self.light[i * chunks + chunk] = value;
            }
        }
    }
}

impl Layer<'_, '_> {
    /// J − v/2 ∇²J.
    #[inline(always)]
    fn sharp(&self, here: usize, inner: [usize; 3], between: [bool; 3], chunk: usize) -> Chunk {
        let light = |cell: usize| &self.gathered.light[cell * self.cells.chunks + chunk];
        let middle = light(here);
        let mut value = *middle;
        for axis in 0..3 {
            if !between[axis] {
                continue;
            }
            let (low, high) = (light(here - inner[axis]), light(here + inner[axis]));
            for k in 0..WIDE {
                value[k] -= HALF_SPREAD * (low[k] + high[k] - 2.0 * middle[k]);
            }
        }
        value
    }

    /// The own light of a cell and its 26 neighbours, spread.
    #[inline(always)]
    fn spread_own(&self, at: usize, strides: [usize; 3], chunk: usize) -> Chunk {
        let lowest = at - strides.iter().sum::<usize>();
        let mut sum = [0.0; WIDE];
        for neighbour in 0..27 {
            let step = [neighbour % 3, neighbour / 3 % 3, neighbour / 9];
            let cell = lowest + (0..3).map(|axis| step[axis] * strides[axis]).sum::<usize>();
            let weight: f32 = step
                .iter()
                .map(|step| SPREAD[usize::from(*step != 1)])
                .product();
            let own = &self.own[cell * self.cells.chunks + chunk];
            for (sum, own) in sum.iter_mut().zip(own) {
                *sum += weight * own;
            }
        }
        sum
    }
}
