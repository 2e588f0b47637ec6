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
use crate::math::lanes::{self, Kernel};

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
    /// The first ray along each, in cells at the first layer, and their count.
    lowest: [i64; 2],
    rays: [usize; 2],
    /// Length of a ray between two layers, m.
    step_m: f32,
}

/// Where a layer's cells lie between the rays: cell p between rays p + base and the next, that share further.
#[derive(Debug, Clone, Copy)]
struct Shift {
    base: i64,
    share: f32,
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
        let way = slope.map(|slope| -slope * (cells.size[across].max(1) - 1) as f64);
        let lowest = way.map(|way| way.min(0.0).floor() as i64);
        let rays = [0, 1].map(|i| {
            let highest = cells.size[along[i]] as i64 + way[i].max(0.0).floor() as i64;
            (highest - lowest[i] + 1) as usize
        });
        Self {
            cells,
            extinction,
            axes,
            reversed: direction[across] < 0.0,
            slope,
            lowest,
            rays,
            step_m: (1.0 / speed[across]) as f32,
        }
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

    /// Follows all rays. `light` becomes their radiance at each layer: row after row of rays, in each layer after layer.
    pub(super) fn follow(&self, light: &mut Vec<Chunk>) {
        let row = self.layers() * self.rays[0] * self.cells.chunks;
        // What stays of another direction is never read: a ray writes every layer between the cells.
        light.resize((row * self.rays[1]).max(light.len()), [0.0; WIDE]);
        light[..row * self.rays[1]]
            .par_chunks_exact_mut(row.max(1))
            .enumerate()
            .for_each(|(number, light)| {
                lanes::dispatch(Row {
                    sweep: self,
                    number: number as i64 + self.lowest[1],
                    light,
                });
            });
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
        let i = (cell[b] as i64 + sideways.base - self.lowest[0]) as usize;
        let j = (cell[c] as i64 + upwards.base - self.lowest[1]) as usize;
        let chunks = self.cells.chunks;
        let row = self.layers() * self.rays[0] * chunks;
        let first = j * row + (layer * self.rays[0] + i) * chunks;
        let [x, y] = [sideways.share, upwards.share];
        (
            [first, first + chunks, first + row, first + row + chunks],
            [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y],
        )
    }
}

/// One row of rays.
struct Row<'a, 'b> {
    sweep: &'a Sweep<'a>,
    number: i64,
    light: &'b mut [Chunk],
}

impl Kernel for Row<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let sweep = self.sweep;
        let (cells, chunks) = (sweep.cells, sweep.cells.chunks);
        let strides = cells.strides();
        let [across, b, c] = sweep.axes;
        let [width, height] = [b, c].map(|axis| cells.size[axis] as i64);
        // What each ray carries, what it met last, and whether that was anything.
        let mut carried = vec![[0.0; WIDE]; sweep.rays[0] * chunks];
        let mut met = carried.clone();
        let mut was_filled = vec![false; sweep.rays[0]];
        for layer in 0..sweep.layers() {
            let (sideways, upwards) = (sweep.shift(layer, 0), sweep.shift(layer, 1));
            if self.number < upwards.base || self.number > upwards.base + height {
                continue;
            }
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
            for i in 0..=width {
                let low = row + i as usize * strides[b];
                let four = [
                    low,
                    low + strides[b],
                    low + strides[c],
                    low + strides[b] + strides[c],
                ];
                let ray = (i + sideways.base - sweep.lowest[0]) as usize;
                let own = ray * chunks..(ray + 1) * chunks;
                let filled = four.iter().any(|&cell| cells.filled[cell]);
                if filled || was_filled[ray] {
                    step(
                        sweep,
                        four.map(|cell| cell * chunks),
                        weights,
                        &mut met[own.clone()],
                        &mut carried[own.clone()],
                    );
                }
                was_filled[ray] = filled;
                let kept = (layer * sweep.rays[0] + ray) * chunks;
                self.light[kept..kept + chunks].copy_from_slice(&carried[own]);
            }
        }
    }
}

/// Takes a ray from one layer to the next, where it finds the weighted mean of four records.
#[inline(always)]
fn step(
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
            let lost = -lanes::exp_m1(-depth);
            let phi = if depth > CLEAR_DEPTH {
                lost / depth
            } else {
                1.0
            };
            light[lane] += between[lane] * length * phi - light[lane] * lost;
        }
    }
}
