//! Light that is scattered more than once: each order's light becomes the next one's source.
//!
//! ```text
//! J_{n+1}(x) = 1/(4π) ∫ L_n(x, ω′) dω′,   dL_n/ds = −(σ_a + σ_s) L_n + σ_s J_n
//! ```
//!
//! J_1 is that of [`super`]. Each order costs what the first did, or an eighth of it where larger
//! cells do. Once the orders fall off by the same factor r, what is missing is J_n r/(1 − r), place by place in the shape of the last.
//!
//! **Validity.** Light that was scattered counts as even where it is scattered on: J_n towards the eye stands for that in
//! other directions, which is exact for g = 0, and for soot of up to 40 nm (g < 0.1) within some per cent of the second
//! order. A cell's light is one number: in smoke of which a cell is more than a mean free path deep, light gets too far.
//!
//! **Source.** Λ-iteration: D. Mihalas, Stellar Atmospheres, 2nd ed. (1978), ch. 6.

use crate::render::cells::{Cells, Chunk, Colours, WIDE};
use crate::render::preparation::Watch;

use super::gathered::Gathered;
use super::{Rays, exchange};

/// Most orders that are worked out.
const MOST_ORDERS: u32 = 12;
/// Share of all scattered light that an order may be to be the last, with what follows it.
const NEGLIGIBLE: f64 = 2e-3;
/// Orders that must have been worked out before the rest is taken from their ratio.
const STEADY: u32 = 4;
/// Share by which what the ratio says may be off: from the fourth order on it changes by less.
const UNSURE: f64 = 0.1;
/// Greatest ratio that is trusted: of a thousand scatterings one is lost.
const MOST_RATIO: f64 = 0.999;

/// Depth of a cell's edge from which coarser cells would let light too far.
const DEEPEST: f64 = 0.5;

/// The sum of all orders after the first, for each cell as [`Gathered::light`], and the share of all scattered light that is
/// still left out; `None` if cancelled. It is worked out in coarser cells, which have received nothing yet, where light finds
/// its way through these.
pub(super) fn scattered_often(
    rays: &mut Rays<'_>,
    colours: &Colours,
    [first, coarser]: [&Gathered<'_>; 2],
    watch: &Watch<'_>,
) -> Option<(Vec<Chunk>, f64)> {
    if coarser.cells.edge <= first.cells.edge
        || depth_of_cells(coarser, colours, rays.extinction) > DEEPEST
    {
        return orders(rays, colours, first, first.light.clone(), watch);
    }
    let light = exchange::in_coarser(first, coarser.cells, colours);
    let (often, rest) = orders(rays, colours, coarser, light, watch)?;
    Some((exchange::in_finer(&often, coarser, first), rest))
}

/// The same in the cells of `like`, where the light that is scattered for the second time is that of `first`.
fn orders(
    rays: &mut Rays<'_>,
    colours: &Colours,
    like: &Gathered<'_>,
    first: Vec<Chunk>,
    watch: &Watch<'_>,
) -> Option<(Vec<Chunk>, f64)> {
    let cells = like.cells;
    let mut all = vec![[0.0; WIDE]; first.len()];
    let mut source = Cells {
        records: cells.records.clone(),
        filled: cells.filled.clone(),
        ..*cells
    };
    let mut last = first;
    let mut last_sum = scattered(cells, colours, like, &last);
    let mut sum = last_sum;
    let mut rest = if last_sum > 0.0 { 1.0 } else { 0.0 };
    // How many orders there will be nobody knows: each is told as one of the most, so that every one is seen to go on.
    let told = |order: u32| f64::from(order - 2) / f64::from(MOST_ORDERS - 1);
    for order in 2..=MOST_ORDERS {
        if sum <= 0.0 {
            break;
        }
        shine_again(&mut source, colours, &last);
        let mut next = like.emptied(&source);
        rays.gather(
            &source,
            &mut next,
            &watch.part(told(order), told(order + 1)),
        )?;
        let next_sum = scattered(cells, colours, like, &next.light);
        let ratio = (next_sum / last_sum).clamp(0.0, MOST_RATIO);
        (last, last_sum) = (next.light, next_sum);
        sum += next_sum;
        let missing = ratio / (1.0 - ratio);
        // The last order stands for those after it as well.
        let ends = next_sum * (1.0 + missing) < NEGLIGIBLE * sum;
        let is_last = ends || order == MOST_ORDERS || order >= STEADY && missing < 1.0 / 3.0;
        let weight = if is_last { 1.0 + missing } else { 1.0 };
        for (all, last) in all.iter_mut().zip(&last) {
            for (all, last) in all.iter_mut().zip(last) {
                *all += weight as f32 * last;
            }
        }
        rest = if ends {
            NEGLIGIBLE
        } else {
            UNSURE * next_sum * missing / sum
        };
        if is_last {
            break;
        }
    }
    Some((all, rest.min(1.0)))
}

/// Mean optical depth of a cell's edge where light is scattered, in the most luminous colour.
fn depth_of_cells(like: &Gathered<'_>, colours: &Colours, extinction: &[Vec<Chunk>; 2]) -> f64 {
    let (cells, luminous) = (like.cells, like.luminous());
    if luminous >= colours.len() {
        return 0.0;
    }
    let [chunk, number] = Colours::place(luminous);
    let [soot, smoke] = [0, 1].map(|kind: usize| extinction[kind][chunk][number]);
    let (mut depth, mut all) = (0.0, 0.0);
    for record in cells.records.chunks_exact(cells.chunks) {
        let scattering = f64::from(colours.scattering(luminous, record));
        depth += scattering * f64::from(soot * record[0][0] + smoke * record[0][1]);
        all += scattering;
    }
    if all > 0.0 {
        like.edge_m * depth / all
    } else {
        0.0
    }
}

/// Makes what the cells scatter of light their emission.
fn shine_again(source: &mut Cells, colours: &Colours, light: &[Chunk]) {
    let [x, y, z] = source.size;
    let chunks = source.chunks;
    for i in 0..x * y * z {
        let at = source.at([i % x, i / x % y, i / x / y]) * chunks;
        let (record, light) = (&mut source.records[at..at + chunks], &light[i * chunks..]);
        for colour in 0..colours.len() {
            let scattering = colours.scattering(colour, record);
            let [chunk, number] = Colours::place(colour);
            record[chunk][number] = scattering * light[chunk][number].max(0.0);
        }
    }
}

/// What all cells scatter of light, in the most luminous colour.
fn scattered(cells: &Cells, colours: &Colours, like: &Gathered<'_>, light: &[Chunk]) -> f64 {
    let [x, y, z] = cells.size;
    let luminous = like.luminous();
    if luminous >= colours.len() {
        return 0.0;
    }
    let [chunk, number] = Colours::place(luminous);
    (0..x * y * z)
        .map(|i| {
            let at = cells.at([i % x, i / x % y, i / x / y]) * cells.chunks;
            let record = &cells.records[at..at + cells.chunks];
            let light = light[i * cells.chunks + chunk][number];
            f64::from(colours.scattering(luminous, record) * light)
        })
        .sum()
}
