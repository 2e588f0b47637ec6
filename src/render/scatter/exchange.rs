//! Coarser cells made of finer ones, and light from these to those and back.

use rayon::prelude::*;

use super::gathered::Gathered;
use crate::render::cells::{Cells, Chunk, Colours, WIDE};

/// The smallest larger cells of which there are no more than `most`: the means of those in each.
pub(super) fn larger(cells: &Cells, most: usize) -> Cells {
    let mut edge = cells.edge;
    let sides = |edge: usize| {
        let ratio = (edge / cells.edge) as i32;
        let first = cells.first.map(|first| first.div_euclid(ratio));
        let size = [0, 1, 2].map(|axis: usize| {
            let end = cells.first[axis] + cells.size[axis] as i32;
            ((end + ratio - 1).div_euclid(ratio) - first[axis]) as usize
        });
        (first, size)
    };
    while sides(edge).1.iter().product::<usize>() > most.max(1) {
        edge *= 2;
    }
    let (first, size) = sides(edge);
    let mut larger = Cells {
        edge,
        first,
        size,
        chunks: cells.chunks,
        records: Vec::new(),
        filled: Vec::new(),
    };
    let padded = larger.strides()[2] * (size[2] + 2);
    larger.records = vec![[0.0; WIDE]; padded * cells.chunks];
    larger.filled = vec![false; padded];
    let ratio = edge / cells.edge;
    let weight = 1.0 / (ratio * ratio * ratio) as f32;
    let [x, y, z] = cells.size;
    for (k, j, i) in (0..z).flat_map(|k| (0..y).flat_map(move |j| (0..x).map(move |i| (k, j, i)))) {
        let from = cells.at([i, j, k]);
        if !cells.filled[from] {
            continue;
        }
        let inside = |axis: usize, at: usize| {
            let at = (cells.first[axis] + at as i32).div_euclid(ratio as i32);
            (at - first[axis]) as usize
        };
        let to = larger.at([inside(0, i), inside(1, j), inside(2, k)]);
        larger.filled[to] = true;
        for chunk in 0..cells.chunks {
            let record = &cells.records[from * cells.chunks + chunk];
            let sum = &mut larger.records[to * cells.chunks + chunk];
            for (sum, number) in sum.iter_mut().zip(record) {
                *sum += weight * number;
            }
        }
    }
    larger
}

/// The light of all cells as coarser ones have it: means in which each counts by what it scatters, so that what is scattered
/// is kept.
pub(super) fn in_coarser(from: &Gathered<'_>, to: &Cells, colours: &Colours) -> Vec<Chunk> {
    let fine = from.cells;
    let places: Vec<[usize; 2]> = (0..colours.len()).map(Colours::place).collect();
    let mut light = vec![[0.0; WIDE]; to.size.iter().product::<usize>() * to.chunks];
    light
        .par_chunks_exact_mut(to.chunks)
        .enumerate()
        .for_each(|(i, light)| {
            let mut scattering = vec![0.0; colours.len()];
            for child in children(fine, to, place_of(i, to.size)) {
                let at = fine.at(child) * fine.chunks;
                let record = &fine.records[at..at + fine.chunks];
                let own = &from.light[index_of(child, fine.size) * fine.chunks..];
                for (colour, &[chunk, number]) in places.iter().enumerate() {
                    let scatters = colours.scattering(colour, record);
                    light[chunk][number] += scatters * own[chunk][number];
                    scattering[colour] += scatters;
                }
            }
            for (scattering, &[chunk, number]) in scattering.iter().zip(&places) {
                if *scattering > 0.0 {
                    light[chunk][number] /= scattering;
                }
            }
        });
    light
}

/// The light of coarse cells between their middles, as finer ones have it. What lies between cells of which some were never
/// asked is a mean of the others.
pub(super) fn in_finer(light: &[Chunk], from: &Gathered<'_>, to: &Gathered<'_>) -> Vec<Chunk> {
    let (coarse, fine) = (from.cells, to.cells);
    let ratio = coarse.edge as f64 / fine.edge as f64;
    let mut found = vec![[0.0; WIDE]; to.light.len()];
    found
        .par_chunks_exact_mut(fine.chunks)
        .enumerate()
        .filter(|(i, _)| to.to_eye[*i] != [0.0; 3])
        .for_each(|(i, found)| {
            let place = place_of(i, fine.size);
            let (mut low, mut share) = ([0; 3], [0.0; 3]);
            for axis in 0..3 {
                let middle = (f64::from(fine.first[axis]) + place[axis] as f64 + 0.5) / ratio;
                let last = coarse.size[axis] as f64 - 1.0;
                let at = (middle - f64::from(coarse.first[axis]) - 0.5).clamp(0.0, last);
                low[axis] = at as usize;
                share[axis] = (at - at.floor()) as f32;
            }
            let mut all = 0.0;
            for corner in 0..8 {
                let upper = [0, 1, 2].map(|axis: usize| corner >> axis & 1);
                let place = [0, 1, 2].map(|axis| low[axis] + upper[axis]);
                let weight: f32 = (0..3)
                    .map(|axis| [1.0 - share[axis], share[axis]][upper[axis]])
                    .product();
                if weight <= 0.0 || (0..3).any(|axis| place[axis] >= coarse.size[axis]) {
                    continue;
                }
                let index = index_of(place, coarse.size);
                if from.to_eye[index] == [0.0; 3] {
                    continue;
                }
                all += weight;
                let own = &light[index * coarse.chunks..];
                for (found, own) in found.iter_mut().zip(own) {
                    for (found, own) in found.iter_mut().zip(own) {
                        *found += weight * own;
                    }
                }
            }
            if all > 0.0 {
                for found in found.iter_mut().flatten() {
                    *found /= all;
                }
            }
        });
    found
}

/// The cells of a fine lattice that lie in a cell of a coarser one.
fn children(fine: &Cells, coarse: &Cells, place: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let ratio = (coarse.edge / fine.edge) as i32;
    let range = |axis: usize| {
        let first = (coarse.first[axis] + place[axis] as i32) * ratio - fine.first[axis];
        let inside = |at: i32| at.clamp(0, fine.size[axis] as i32) as usize;
        inside(first)..inside(first + ratio)
    };
    let [xs, ys, zs] = [0, 1, 2].map(range);
    zs.flat_map(move |z| {
        let xs = xs.clone();
        ys.clone()
            .flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
    })
}

fn place_of(index: usize, [x, y, _]: [usize; 3]) -> [usize; 3] {
    [index % x, index / x % y, index / x / y]
}

fn index_of([x, y, z]: [usize; 3], [width, height, _]: [usize; 3]) -> usize {
    (z * height + y) * width + x
}
