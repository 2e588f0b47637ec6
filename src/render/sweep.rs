//! The fire's light in one direction, everywhere at once.
//!
//! # What is computed
//!
//! Parallel rays go through the [`Cells`] from one side to the other, dL/ds = −(σ_a + σ_s) L + j, and the radiance of each
//! is kept wherever it crosses a layer of cells. Between two layers it meets the mean of what it finds on both:
//!
//! ```text
//! L ← L e^{−τ} + j Δs φ₁(τ),   τ = (σ_a + σ_s) Δs,   φ₁(τ) = (1 − e^{−τ})/τ
//! ```
//!
//! # How
//!
//! Layers stand across the axis along which the direction goes fastest. Rays cross each layer at the same square lattice
//! as its cells' middles, shifted by a slope times the layer's number. So what a ray meets is a mean of four cells, and what
//! a cell's middle receives a mean of four rays, with weights that are the same for the whole layer; along the ray nothing
//! is interpolated, and light is not smeared however far it goes.

use glam::DVec3;
use rayon::prelude::*;

use super::cells::{Cells, Chunk, WIDE};
use crate::math::lanes::{self, Arithmetic, Kernel};

/// Depth below which φ₁ is 1 to the last bit of an f32.
const CLEAR_DEPTH: f32 = 1e-12;

/// Rays in one direction through cells.
pub(super) struct Sweep<'a> {
    cells: &'a Cells,
    extinction: &'a [Vec<Chunk>; 2],
    /// The axis across the layers, and the two along them.
    axes: [usize; 3],
    /// Whether rays go towards lower layers.
    reversed: bool,
    /// Cells along each of the two axes for each layer on the way.
    slope: [f64; 2],
    /// The first row of rays along the second of them, in cells at the first layer, and all rows from it on.
    lowest: i64,
    rows: Vec<Visit>,
    /// Length of a ray between two layers, m.
    step_m: f32,
}

/// Where a layer's cells lie between the rays: cell p between rays p + base and the next, that share further.
#[derive(Debug, Clone, Copy)]
struct Shift {
    base: i64,
    share: f32,
}

/// The layers in which a row of rays passes the cells, and where its rays there are kept, in rays.
#[derive(Debug, Clone, Copy, Default)]
struct Visit {
    first: usize,
    layers: usize,
    kept: usize,
}

impl<'a> Sweep<'a> {
    /// Rays that go by `direction` cells in a metre.
    pub(super) fn new(cells: &'a Cells, extinction: &'a [Vec<Chunk>; 2], direction: DVec3) -> Self {
        let speed = direction.abs().to_array();
        let across = (1..3).fold(0, |best, axis| {
            if speed[axis] > speed[best] {
                axis
            } else {
                best
            }
        });
        let axes = [[0, 1, 2], [1, 0, 2], [2, 0, 1]][across];
        let along = [axes[1], axes[2]];
        let slope = along.map(|axis| direction[axis] / speed[across]);
        let mut sweep = Self {
            cells,
            extinction,
            axes,
            reversed: direction[across] < 0.0,
            slope,
            lowest: 0,
            rows: Vec::new(),
            step_m: (1.0 / speed[across]) as f32,
        };
        sweep.lay_rows();
        sweep
    }

    /// Finds which rows pass the cells in which layers. No more is kept than those: of a slender fire nearly all rays miss
    /// nearly all layers.
    fn lay_rows(&mut self) {
        let (layers, height) = (self.layers(), self.cells.size[self.axes[2]]);
        let Some(last) = layers.checked_sub(1) else {
            return;
        };
        let ends = [self.shift(0, 1).base, self.shift(last, 1).base];
        self.lowest = ends[0].min(ends[1]);
        let count = ends[0].abs_diff(ends[1]) as usize + height + 1;
        self.rows = vec![Visit::default(); count];
        for layer in 0..layers {
            let first = (self.shift(layer, 1).base - self.lowest) as usize;
            for row in &mut self.rows[first..=first + height] {
                if row.layers == 0 {
                    row.first = layer;
                }
                row.layers += 1;
            }
        }
        let width = self.width();
        let mut kept = 0;
        for row in &mut self.rows {
            row.kept = kept;
            kept += row.layers * width;
        }
    }

    /// Rays of a row in a layer: one on either side of each cell.
    #[inline(always)]
    fn width(&self) -> usize {
        self.cells.size[self.axes[1]] + 1
    }

    fn layers(&self) -> usize {
        self.cells.size[self.axes[0]]
    }

    /// How a layer lies to the rays along one of its axes.
    #[inline(always)]
    fn shift(&self, layer: usize, along: usize) -> Shift {
        let way = -self.slope[along] * layer as f64;
        let base = way.floor();
        Shift {
            base: base as i64,
            share: (way - base) as f32,
        }
    }

    /// Follows all rays. `light` becomes their radiance beside the cells: row after row, in each layer after layer that the
    /// row passes.
    pub(super) fn follow(&self, light: &mut Vec<Chunk>) {
        let per_layer = self.width() * self.cells.chunks;
        let all: usize = self.rows.iter().map(|row| row.layers * per_layer).sum();
        // What stays of another direction is never read: a ray writes every layer beside the cells.
        light.resize(all.max(light.len()), [0.0; WIDE]);
        let mut rest = &mut light[..all];
        let mut rows = Vec::with_capacity(self.rows.len());
        for (number, row) in (self.lowest..).zip(&self.rows) {
            let (own, others) = rest.split_at_mut(row.layers * per_layer);
            rest = others;
            rows.push(Row {
                sweep: self,
                number,
                visit: *row,
                light: own,
            });
        }
        rows.into_par_iter().for_each(lanes::dispatch);
    }

    /// Which rays pass a cell's middle: where the first of the four is kept in `light`, in chunks, how far off its
    /// neighbours along both axes are, and the four weights.
    #[inline(always)]
    pub(super) fn rays_at(&self, cell: [usize; 3]) -> ([usize; 4], [f32; 4]) {
        let [across, b, c] = self.axes;
        let layer = if self.reversed {
            self.layers() - 1 - cell[across]
        } else {
            cell[across]
        };
        let (sideways, upwards) = (self.shift(layer, 0), self.shift(layer, 1));
        let row = (cell[c] as i64 + upwards.base - self.lowest) as usize;
        let chunks = self.cells.chunks;
        let kept = |row: &Visit| {
            let ray = row.kept + (layer - row.first) * self.width() + cell[b];
            ray * chunks
        };
        let [near, far] = [kept(&self.rows[row]), kept(&self.rows[row + 1])];
        let [x, y] = [sideways.share, upwards.share];
        (
            [near, near + chunks, far, far + chunks],
            [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y],
        )
    }
}

/// One row of rays.
struct Row<'a, 'b> {
    sweep: &'a Sweep<'a>,
    number: i64,
    visit: Visit,
    light: &'b mut [Chunk],
}

impl Kernel for Row<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        let sweep = self.sweep;
        let (cells, chunks) = (sweep.cells, sweep.cells.chunks);
        let strides = cells.strides();
        let [across, b, c] = sweep.axes;
        let width = sweep.width();
        // What each ray beside a cell carries, what it met last, and whether that was anything.
        let mut carried = vec![[0.0; WIDE]; width * chunks];
        let mut met = carried.clone();
        let mut was_filled = vec![false; width];
        let Visit { first, layers, .. } = self.visit;
        let mut base = sweep.shift(first, 0).base;
        for layer in first..first + layers {
            let (sideways, upwards) = (sweep.shift(layer, 0), sweep.shift(layer, 1));
            // The same rays lie beside other cells now; others come in, with nothing.
            let moved = sideways.base - base;
            base = sideways.base;
            shifted(&mut carried, moved * chunks as i64, [0.0; WIDE]);
            shifted(&mut met, moved * chunks as i64, [0.0; WIDE]);
            shifted(&mut was_filled, moved, false);
            let depth = if sweep.reversed {
                sweep.layers() - 1 - layer
            } else {
                layer
            };
            // The empty cells around all others let each of the rays between them have four.
            let row =
                (depth + 1) * strides[across] + (self.number - upwards.base) as usize * strides[c];
            let [x, y] = [sideways.share, upwards.share];
            let weights = [x * y, (1.0 - x) * y, x * (1.0 - y), (1.0 - x) * (1.0 - y)];
            for (ray, was_filled) in was_filled.iter_mut().enumerate() {
                let low = row + ray * strides[b];
                let four = [
                    low,
                    low + strides[b],
                    low + strides[c],
                    low + strides[b] + strides[c],
                ];
                let own = ray * chunks..(ray + 1) * chunks;
                let filled = four.iter().any(|&cell| cells.filled[cell]);
                if filled || *was_filled {
                    step::<A>(
                        sweep,
                        four.map(|cell| cell * chunks),
                        weights,
                        &mut met[own.clone()],
                        &mut carried[own.clone()],
                    );
                }
                *was_filled = filled;
                let kept = ((layer - first) * width + ray) * chunks;
                self.light[kept..kept + chunks].copy_from_slice(&carried[own]);
            }
        }
    }
}

/// Moves what stands at `by` to the front, or the front to `-by`; what comes in is new.
fn shifted<T: Copy>(values: &mut [T], by: i64, new: T) {
    let moved = (by.unsigned_abs() as usize).min(values.len());
    let stays = values.len() - moved;
    if by > 0 {
        values.copy_within(moved.., 0);
        values[stays..].fill(new);
    } else {
        values.copy_within(..stays, moved);
        values[..moved].fill(new);
    }
}

/// Takes a ray from one layer to the next, where it finds the weighted mean of four records.
#[inline(always)]
fn step<A: Arithmetic>(
    sweep: &Sweep<'_>,
    four: [usize; 4],
    weights: [f32; 4],
    met: &mut [Chunk],
    carried: &mut [Chunk],
) {
    let (records, length) = (&sweep.cells.records, sweep.step_m);
    let mut amounts = [0.0; 2];
    for chunk in 0..carried.len() {
        let taps = four.map(|record| &records[record + chunk]);
        let mut between = [0.0; WIDE];
        for lane in 0..WIDE {
            let found = (weights[0] * taps[0][lane] + weights[1] * taps[1][lane])
                + (weights[2] * taps[2][lane] + weights[3] * taps[3][lane]);
            between[lane] = 0.5 * (met[chunk][lane] + found);
            met[chunk][lane] = found;
        }
        if chunk == 0 {
            amounts = [between[0] * length, between[1] * length];
        }
        let [soot, smoke] = [0, 1].map(|kind: usize| &sweep.extinction[kind][chunk]);
        let light = &mut carried[chunk];
        for lane in 0..WIDE {
            let depth = soot[lane] * amounts[0] + smoke[lane] * amounts[1];
            let lost = -lanes::exp_m1_by::<A>(-depth);
            let phi = if depth > CLEAR_DEPTH {
                lost / depth
            } else {
                1.0
            };
            light[lane] += between[lane] * length * phi - light[lane] * lost;
        }
    }
}
