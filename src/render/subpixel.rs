//! Where in its pixel each ray goes.
//!
//! The rays of a pixel form a lattice of rank 1, turned so that it is its own mirror image about the pixel's centre (I. H. Sloan
//! and S. Joe, *Lattice Methods for Multiple Integration* (1994), ch. 1 and 4):
//!
//! ```text
//! x_i = ½ + k/n,   y_i = ½ + k g/n mod 1,   k = i − (n−1)/2
//! ```
//!
//! So along each axis the rays are the midpoints of n equal parts, and what changes evenly across a pixel is exact for every
//! n: two rays are better than one. g is the number without a divisor in common with n that is nearest to n/φ, φ the golden
//! ratio: no two rays are close.

/// The golden ratio.
const GOLDEN: f64 = 1.618033988749895;

/// Where in its pixel, 0 to 1 along each axis, the `sample`th of so many rays goes. One ray goes through the centre; of more
/// each two that follow are each other's mirror image, those nearest to the centre's column first.
pub(super) fn place(sample: u32, of: u32) -> [f64; 2] {
    // Twice k, which is whole.
    let from_centre = if of.is_multiple_of(2) {
        let pair = i64::from(sample / 2) * 2 + 1;
        if sample.is_multiple_of(2) {
            pair
        } else {
            -pair
        }
    } else {
        let pair = i64::from(sample.div_ceil(2)) * 2;
        if sample.is_multiple_of(2) {
            -pair
        } else {
            pair
        }
    };
    let k = 0.5 * from_centre as f64 / f64::from(of);
    [
        0.5 + k,
        (0.5 + k * f64::from(generator(of))).rem_euclid(1.0),
    ]
}

/// The g of the lattice.
fn generator(count: u32) -> u32 {
    let best = f64::from(count) / GOLDEN;
    let far = |g: &u32| (f64::from(*g) - best).abs();
    let all = (1..=count).filter(|&g| greatest_common_divisor(g, count) == 1);
    all.min_by(|one, other| far(one).total_cmp(&far(other)))
        .unwrap_or(1)
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: [u32; 10] = [1, 2, 3, 4, 5, 8, 16, 17, 64, 4096];

    #[test]
    fn one_ray_goes_through_the_centre() {
        assert_eq!(place(0, 1), [0.5, 0.5]);
    }

    #[test]
    fn rays_lie_evenly_along_each_axis_and_about_the_centre() {
        for count in COUNTS {
            let places: Vec<[f64; 2]> = (0..count).map(|i| place(i, count)).collect();
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
            let places: Vec<[f64; 2]> = (0..count).map(|i| place(i, count)).collect();
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
}
