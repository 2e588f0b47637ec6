//! Bounds of what lies along a line of sight, from each brick's densest sample.

use rayon::prelude::*;

use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK};

impl Medium {
    /// Columns ∫ f_v ds (m) of the densest lines of bricks along the lattice's axes, each brick filled with its densest
    /// sample: of all soot, and of what of it is smoke. A slanted line of sight may hold up to √3 times as much.
    pub fn densest_columns(&self) -> [f64; 2] {
        let densest: Vec<[f32; 2]> = self
            .samples
            .par_chunks_exact(BRICK_SAMPLES)
            .enumerate()
            .map(|(slot, samples)| {
                let soot = samples.iter().fold(0.0, |most: f32, it| most.max(it[0]));
                let own = slot * BRICK_SAMPLES..(slot + 1) * BRICK_SAMPLES;
                let smoke = self.smoke.get(own).unwrap_or_default();
                [soot, smoke.iter().fold(0.0, |most: f32, it| most.max(*it))]
            })
            .collect();
        let size = self.bricks.to_array().map(|side| side as usize);
        let edges = self.lattice_from_world.matrix3.inverse();
        let edges = edges.to_cols_array_2d().map(|axis| {
            let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
            length * BRICK as f64
        });
        let mut most = [0.0_f64; 2];
        for (axis, edge) in edges.into_iter().enumerate() {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let mut columns = vec![[0.0_f64; 2]; size[u] * size[v]];
            for (i, &slot) in self.table.iter().enumerate() {
                if slot == NO_BRICK {
                    continue;
                }
                let place = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
                let column = &mut columns[place[v] * size[u] + place[u]];
                for (sum, densest) in column.iter_mut().zip(densest[slot as usize]) {
                    *sum += edge * f64::from(densest);
                }
            }
            for column in columns {
                most = std::array::from_fn(|c| most[c].max(column[c]));
            }
        }
        most
    }
}
