//! A fixed set of directions, even enough over the sphere, with a smooth reading between them.
//!
//! The octahedron |x| + |y| + |z| = 1 is unfolded onto the square −1..1: its upper half lies in the middle, the lower half
//! in the four corners. Directions stand on the corners of a square grid over it, so a reading between four of them needs
//! no care at the square's edge: there the same direction stands twice.
//!
//! **Source.** Z. H. Cigolle et al., A survey of efficient representations for independent unit vectors, JCGT 3(2) (2014),
//! section 3.

use glam::DVec3;

/// Directions on the corners of a grid over the unfolded octahedron.
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions {
    /// Squares of the grid along each side; even, so that the six axes are directions.
    squares: usize,
}

/// Four directions of the set with weights that sum to 1.
pub(super) type Reading = [(usize, f32); 4];

impl Directions {
    /// A grid of so many squares along each side, even.
    pub(super) fn new(squares: usize) -> Self {
        Self { squares }
    }

    /// How many directions there are.
    pub(super) fn len(self) -> usize {
        (self.squares + 1) * (self.squares + 1)
    }

    /// One of them, of length 1.
    pub(super) fn get(self, index: usize) -> DVec3 {
        let along = |i: usize| 2.0 * i as f64 / self.squares as f64 - 1.0;
        let (row, column) = (index / (self.squares + 1), index % (self.squares + 1));
        let (x, y) = (along(column), along(row));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        DVec3::new(
            (x.abs() - fold).copysign(x),
            (y.abs() - fold).copysign(y),
            z,
        )
        .normalize()
    }

    /// How to read at a direction (any length above 0) between the four around it.
    #[inline]
    pub(super) fn read(self, direction: DVec3) -> Reading {
        let size = direction.x.abs() + direction.y.abs() + direction.z.abs();
        let (mut x, mut y) = (direction.x / size, direction.y / size);
        if direction.z < 0.0 {
            (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
        }
        let cell = |at: f64| {
            let at = 0.5 * (at + 1.0) * self.squares as f64;
            let low = at.clamp(0.0, (self.squares - 1) as f64) as usize;
            (low, (at - low as f64) as f32)
        };
        let ((column, u), (row, v)) = (cell(x), cell(y));
        let first = row * (self.squares + 1) + column;
        let above = first + self.squares + 1;
        [
            (first, (1.0 - u) * (1.0 - v)),
            (first + 1, u * (1.0 - v)),
            (above, (1.0 - u) * v),
            (above + 1, u * v),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_of_the_set_is_read_alone() {
        let set = Directions::new(8);
        for i in 0..set.len() {
            let direction = set.get(i);
            assert!((direction.length() - 1.0).abs() < 1e-12);
            for (index, weight) in set.read(direction) {
                let same = set.get(index).abs_diff_eq(direction, 1e-6);
                assert!(same || weight.abs() < 1e-6, "{i}: {index} {weight}");
            }
        }
    }

    #[test]
    fn a_smooth_function_is_read_smoothly_everywhere() {
        // Between neighbours a quarter radian apart a wave is missed by about h²/8 along each axis, 0.016.
        let set = Directions::new(16);
        let wave = |d: DVec3| 0.3 * d.x - 0.5 * d.y + 0.7 * d.z + 0.2 * d.x * d.z;
        for i in 0..4000 {
            let words = crate::math::random::philox([i, 0, 0, 0], [5, 0]);
            let number = |k: usize| f64::from(words[k]) / f64::from(u32::MAX) - 0.5;
            let direction = DVec3::new(number(0), number(1), number(2)).normalize();
            let read: f64 = set
                .read(direction)
                .into_iter()
                .map(|(index, weight)| f64::from(weight) * wave(set.get(index)))
                .sum();
            assert!((read - wave(direction)).abs() < 0.03, "{direction}: {read}");
        }
    }
}
