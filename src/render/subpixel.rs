//! Where in its pixel each ray goes.
//!
//! Of n rays each has a column and a row of its own among n, and goes through the middle of where they cross. So along each axis
//! the rays are the midpoints of n equal parts. Which row goes with which column tells a lattice of rank 1 that is its own mirror
//! image about the pixel's centre (I. H. Sloan and S. Joe, *Lattice Methods for Multiple Integration* (1994), ch. 1 and 4), closed
//! or, without the corner of a larger one, open (K.-T. Fang and Y. Wang, *Number-theoretic Methods in Statistics* (1994), ch. 1).
//!
//! What changes evenly across a pixel is then exact for every n. Of what bends, to the second order, x² and y² are off by
//! 1/(12 n²); what is left is x y, whose mean over the pixel is nothing about its centre. The lattice is the one whose rays hold
//! that best: for four rays exactly, where rays along a diagonal would be off by most of it.

use crate::math::are_coprime;

/// Of each kind of lattice so many are compared: every one of up to 64 rays.
const COMPARED: usize = 64;

/// The golden ratio: lattices whose generator is near this part of their size have no two rays close together.
const GOLDEN: f64 = 1.618033988749895;

/// The places of a number of rays in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lattice {
    /// Rays.
    count: u32,
    /// By how many rows each column's ray is further than that of the column before.
    generator: u32,
    /// After so many rows they begin again: as many as there are rays, or in an open lattice one more.
    modulus: u32,
}

impl Lattice {
    /// Of so many rays.
    pub(super) fn of(count: u32) -> Self {
        let count = count.max(1);
        let best = [count, count + 1].into_iter().flat_map(|modulus| {
            let golden = f64::from(modulus) / GOLDEN;
            let mut generators: Vec<u32> = (1..=modulus)
                .filter(|&generator| are_coprime(generator as usize, modulus as usize))
                .collect();
            let far = |generator: &u32| (f64::from(*generator) - golden).abs();
            generators.sort_by(|one, other| far(one).total_cmp(&far(other)));
            generators.truncate(COMPARED);
            generators.into_iter().map(move |generator| Self {
                count,
                generator,
                modulus,
            })
        });
        best.min_by_key(|it| {
            // No closer than the diagonal's half of a square lattice's cell.
            let is_close = 2 * it.nearest_squared() < u64::from(count);
            (is_close, it.twist().unsigned_abs())
        })
        .unwrap_or(Self {
            count,
            generator: 1,
            modulus: count,
        })
    }

    /// Where in its pixel, 0 to 1 along each axis, the `sample`th ray goes. One ray goes through the centre; of more each two that
    /// follow are each other's mirror image, those nearest to the centre's column first.
    pub(super) fn place(self, sample: u32) -> [f64; 2] {
        let column = column(sample, self.count);
        [column, self.row(column)].map(|place| (f64::from(place) + 0.5) / f64::from(self.count))
    }

    /// The row of a column's ray.
    fn row(self, column: u32) -> u32 {
        let [count, generator, modulus, column] =
            [self.count, self.generator, self.modulus, column].map(i64::from);
        let row = if modulus > count {
            ((column + 1) * generator).rem_euclid(modulus) - 1
        } else {
            // Twice as far from the centre, which may lie between two rows.
            let far = (2 * column - count + 1) * generator;
            ((count + far).rem_euclid(2 * count) - 1) / 2
        };
        row as u32
    }

    /// Four times the sum of x y over the rays, about the centre, in columns by rows.
    fn twist(self) -> i64 {
        let from_centre = |place: u32| 2 * i64::from(place) - i64::from(self.count) + 1;
        let columns = 0..self.count;
        columns
            .map(|column| from_centre(column) * from_centre(self.row(column)))
            .sum()
    }

    /// Squared distance of the two nearest rays, in columns and rows, where what leaves a side comes in on the other.
    fn nearest_squared(self) -> u64 {
        let modulus = u64::from(self.modulus);
        let wrapped = |far: u64| far.min(modulus - far).pow(2);
        let others = 1..modulus;
        let all =
            others.map(|far| wrapped(far) + wrapped(far * u64::from(self.generator) % modulus));
        all.min().unwrap_or(u64::MAX)
    }
}

/// The column of a ray: outwards from the centre, by turns to the right and to the left.
fn column(sample: u32, count: u32) -> u32 {
    let centre = count / 2;
    if count.is_multiple_of(2) {
        let out = sample / 2;
        let is_right = sample.is_multiple_of(2);
        if is_right {
            centre + out
        } else {
            centre - 1 - out
        }
    } else {
        let out = sample.div_ceil(2);
        let is_right = !sample.is_multiple_of(2);
        if is_right { centre + out } else { centre - out }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: [u32; 12] = [1, 2, 3, 4, 5, 7, 8, 16, 17, 32, 64, 4096];

    fn places(count: u32) -> Vec<[f64; 2]> {
        let lattice = Lattice::of(count);
        (0..count).map(|i| lattice.place(i)).collect()
    }

    #[test]
    fn one_ray_goes_through_the_centre() {
        assert_eq!(places(1), [[0.5, 0.5]]);
    }

    #[test]
    fn rays_lie_evenly_along_each_axis_and_about_the_centre() {
        for count in COUNTS {
            let places = places(count);
            for axis in 0..2 {
                let mut along: Vec<f64> = places.iter().map(|it| it[axis]).collect();
                along.sort_by(f64::total_cmp);
                for (i, found) in along.iter().enumerate() {
                    let middle = (i as f64 + 0.5) / f64::from(count);
                    assert!(
                        (found - middle).abs() < 1e-9,
                        "{count} {axis}: {found} {middle}"
                    );
                }
            }
            for pair in places[(count % 2) as usize..].chunks(2) {
                let [one, other] = [pair[0], pair[1]];
                assert!((0..2).all(|axis| (one[axis] + other[axis] - 1.0).abs() < 1e-9));
            }
        }
    }

    #[test]
    fn no_two_rays_are_close() {
        for count in [4_u32, 8, 16, 64] {
            let places = places(count);
            let apart = |one: &[f64; 2], other: &[f64; 2]| {
                let wrapped = |axis: usize| {
                    let d = (one[axis] - other[axis]).abs();
                    d.min(1.0 - d)
                };
                wrapped(0).hypot(wrapped(1))
            };
            let mut nearest = f64::INFINITY;
            for (i, one) in places.iter().enumerate() {
                for other in &places[..i] {
                    nearest = nearest.min(apart(one, other));
                }
            }
            // A square lattice of as many has neighbours n^−½ apart.
            assert!(
                nearest * f64::from(count).sqrt() > 0.6,
                "{count}: {nearest}"
            );
        }
    }

    #[test]
    fn four_rays_are_a_turned_square() {
        let mut found = places(4);
        found.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let rows: Vec<f64> = found.iter().map(|place| 4.0 * place[1] - 0.5).collect();
        assert!(
            [[1.0, 3.0, 0.0, 2.0], [2.0, 0.0, 3.0, 1.0]]
                .iter()
                .any(|turned| rows == turned),
            "{rows:?}"
        );
    }

    /// Light that falls off across an edge which lies anyhow in the pixel: the mean of many rays on a square lattice is true.
    #[test]
    fn edges_are_smoother_with_more_rays() {
        let edges: Vec<[f64; 3]> = (0..64)
            .map(|i| [0.618, 0.755, 0.570].map(|step| (0.5 + step * f64::from(i)).fract()))
            .collect();
        let light = |[turn, x0, y0]: [f64; 3], [x, y]: [f64; 2]| {
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            (((x - x0) * cos + (y - y0) * sin) / 0.3).tanh()
        };
        let mean = |edge: [f64; 3], places: &[[f64; 2]]| {
            let all: f64 = places.iter().map(|place| light(edge, *place)).sum();
            all / places.len() as f64
        };
        let square: Vec<[f64; 2]> = (0..128 * 128)
            .map(|i| [i % 128, i / 128].map(|at| (f64::from(at) + 0.5) / 128.0))
            .collect();
        let truth: Vec<f64> = edges.iter().map(|edge| mean(*edge, &square)).collect();
        let off_by = |places: &[[f64; 2]]| {
            let each = edges.iter().zip(&truth);
            let each = each.map(|(edge, truth)| (mean(*edge, places) - truth).powi(2));
            (each.sum::<f64>() / edges.len() as f64).sqrt()
        };
        let off = |count: u32| off_by(&places(count));
        let found: Vec<f64> = [1, 2, 4, 9, 12, 28, 64].map(off).to_vec();
        for (few, many) in found.iter().zip(&found[1..]) {
            assert!(*many < 0.75 * few, "{found:?}");
        }
        // Along a diagonal, as the lattice nearest to the golden ratio has them, four rays are far worse.
        let along = Lattice {
            count: 4,
            generator: 3,
            modulus: 4,
        };
        let along: Vec<[f64; 2]> = (0..4).map(|i| along.place(i)).collect();
        assert!(off_by(&along) > 3.0 * found[2], "{found:?}");
        // Of some counts no lattice holds x y well, as of ten or 23; they are at most so much worse than fewer.
        let all: Vec<f64> = (1..=32).map(off).collect();
        for (i, many) in all.iter().enumerate() {
            let fewer = all[..i].iter().copied().fold(f64::INFINITY, f64::min);
            assert!(*many < 3.0 * fewer, "{}: {all:?}", i + 1);
        }
    }
}
