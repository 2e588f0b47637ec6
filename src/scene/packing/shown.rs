//! Which packed bricks are kept, and in which order.

use glam::{IVec3, UVec3};
use rayon::prelude::*;

use super::super::interpolation::Interpolation;
use super::super::medium::{BRICK_SAMPLES, Medium, Peaks, SAMPLES};
use super::{GasFields, layout};

impl Medium {
    /// Enters the packed bricks into the table, closing the gaps of those in which nothing shows (a brick beside one
    /// with soot only in its far corner), and notes the peaks. A smooth interpolation reads from the neighbours of what
    /// shows, so it keeps them. Gas that only bends light is kept, and is no peak: nothing of it is seen.
    pub(super) fn keep_what_shows(&mut self, packed: &[UVec3], gas: GasFields) {
        let hot_above_k = gas
            .hot_above_k
            .map_or(f32::INFINITY, |kelvin| kelvin as f32);
        let bricks = self.samples.par_chunks_exact(BRICK_SAMPLES);
        let parts: Vec<(Option<Peaks>, bool)> = bricks
            .enumerate()
            .map(|(i, samples)| {
                let (mut peaks, mut is_sooty) = (None, false);
                for (at, sample) in samples.iter().enumerate() {
                    let flame = self.flame_of(i * BRICK_SAMPLES + at);
                    if sample[0] > 0.0 || flame > 0.0 || sample[1] > hot_above_k {
                        peaks
                            .get_or_insert_with(Peaks::default)
                            .note(*sample, flame);
                    }
                    is_sooty |= sample[0] > 0.0;
                }
                (peaks, is_sooty)
            })
            .collect();
        let peaks = parts.iter().filter_map(|(peaks, _)| peaks.as_ref());
        peaks.for_each(|part| self.peaks.merge(part));
        let mut shows: Vec<bool> = parts.iter().map(|(peaks, _)| peaks.is_some()).collect();
        let mut sooty: Vec<bool> = parts.iter().map(|(_, is_sooty)| *is_sooty).collect();
        if self.interpolation == Interpolation::Tricubic {
            shows = self.beside(packed, &shows);
            sooty = self.beside(packed, &sooty);
        }
        // Bricks in which only gas glows come after those with soot: a picture without that glow is marched through the
        // latter alone. Bricks that only bend light come last, and are never marched through.
        let bends = gas
            .bends_above_k
            .map(|kelvin| self.bending(packed, kelvin as f32))
            .unwrap_or_default();
        let bends_only = |i: usize| !shows[i] && bends.get(i).is_some_and(|bends| *bends);
        let all = || 0..packed.len();
        let mut order: Vec<usize> = all().filter(|&i| sooty[i]).collect();
        self.sooty = order.len() as u32;
        order.extend(all().filter(|&i| shows[i] && !sooty[i]));
        self.shown = order.len() as u32;
        order.extend(all().filter(|&i| bends_only(i)));
        for (slot, &i) in (0_u32..).zip(&order) {
            let index = self.brick_index(packed[i]);
            self.table[index] = slot;
        }
        let kept = order.len();
        put_in_order(&mut self.samples, &order);
        self.samples.truncate(kept * BRICK_SAMPLES);
        self.samples.shrink_to_fit();
        for beside in [&mut self.flame, &mut self.smoke] {
            put_in_order(beside, &order);
            beside.truncate(kept * BRICK_SAMPLES);
            beside.shrink_to_fit();
        }
    }

    /// Which bricks bend light: those that hold gas hotter than this, and those at whose border the difference between
    /// neighbours reaches such gas. Without the latter the gradient would end in a step at a brick's face.
    fn bending(&self, packed: &[UVec3], above_k: f32) -> Vec<bool> {
        let bricks = self.samples.par_chunks_exact(BRICK_SAMPLES);
        // The bricks that each one makes bend: itself, and those beside a face whose next layer is hot.
        let reached: Vec<Vec<IVec3>> = bricks
            .map(|samples| {
                if samples.iter().all(|sample| sample[1] <= above_k) {
                    return Vec::new();
                }
                let mut reached = vec![IVec3::ZERO];
                let strides = [1, SAMPLES, SAMPLES * SAMPLES];
                for (along, axis) in IVec3::AXES.into_iter().enumerate() {
                    let [a, b] = [strides[(along + 1) % 3], strides[(along + 2) % 3]];
                    for (layer, step) in [(1, -axis), (SAMPLES - 2, axis)] {
                        let is_hot = |i: usize| {
                            let at = layer * strides[along] + i % SAMPLES * a + i / SAMPLES * b;
                            samples[at][1] > above_k
                        };
                        if (0..SAMPLES * SAMPLES).any(is_hot) {
                            reached.push(step);
                        }
                    }
                }
                reached
            })
            .collect();
        let mut marks = vec![false; self.table.len()];
        for (brick, steps) in packed.iter().zip(&reached) {
            for step in steps {
                let beside = brick.as_ivec3() + step;
                if beside.cmpge(IVec3::ZERO).all() && beside.cmplt(self.bricks.as_ivec3()).all() {
                    marks[self.brick_index(beside.as_uvec3())] = true;
                }
            }
        }
        packed
            .iter()
            .map(|&brick| marks[self.brick_index(brick)])
            .collect()
    }

    /// The flame field of a sample; 0 where none is stored.
    fn flame_of(&self, sample: usize) -> f32 {
        self.flame.get(sample).copied().unwrap_or(0.0)
    }

    /// Which bricks show something or touch one that does.
    fn beside(&self, packed: &[UVec3], shows: &[bool]) -> Vec<bool> {
        let mut marks = vec![false; self.table.len()];
        let limit = self.bricks.as_ivec3() - 1;
        for (brick, _) in packed.iter().zip(shows).filter(|(_, shows)| **shows) {
            let brick = brick.as_ivec3();
            let range = [(brick - 1).max(IVec3::ZERO), (brick + 1).min(limit)];
            layout::for_each_in(range, |beside| {
                marks[self.brick_index(beside.as_uvec3())] = true;
            });
        }
        packed
            .iter()
            .map(|&brick| marks[self.brick_index(brick)])
            .collect()
    }
}

/// Moves the bricks of a field so that those of `order` come first, in place: a copy would double what packing needs. Nothing
/// where there is no field.
fn put_in_order<T: Copy>(field: &mut [T], order: &[usize]) {
    let mut bricks: Vec<&mut [T]> = field.chunks_exact_mut(BRICK_SAMPLES).collect();
    // Where the bricks went that had to give way.
    let mut moved: Vec<usize> = (0..bricks.len()).collect();
    for (slot, &wanted) in order.iter().enumerate().take(bricks.len()) {
        // What was swapped away from its place is found by following where it went.
        let mut from = wanted;
        while from < slot {
            from = moved[from];
        }
        if from != slot {
            let (before, rest) = bricks.split_at_mut(from);
            before[slot].swap_with_slice(rest[0]);
        }
        moved[slot] = from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bricks_come_in_any_order_without_a_copy() {
        let orders: [&[usize]; 6] = [
            &[0, 1, 2, 3, 4, 5],
            &[1, 3, 4],
            &[2, 5, 0, 1, 4],
            &[5, 4, 3, 2, 1, 0],
            &[3, 0, 1, 2],
            &[],
        ];
        for order in orders {
            let mut field: Vec<usize> = (0..6 * BRICK_SAMPLES).collect();
            let wanted: Vec<usize> = order
                .iter()
                .flat_map(|i| i * BRICK_SAMPLES..(i + 1) * BRICK_SAMPLES)
                .collect();
            put_in_order(&mut field, order);
            assert_eq!(field[..wanted.len()], wanted, "{order:?}");
        }
        put_in_order::<f32>(&mut [], &[1, 0]);
    }
}
