//! Numbers without a common divisor, by whose steps every place of a ring is hit once.

/// The smallest number from `least` (at least 1) on that has no common divisor with `of` but 1.
pub fn coprime_from(least: usize, of: usize) -> usize {
    let least = least.max(1);
    // One of so many in a row has none.
    (least..=least + of)
        .find(|&number| are_coprime(number, of))
        .unwrap_or(1)
}

/// Whether two numbers have no common divisor but 1.
pub fn are_coprime(one: usize, other: usize) -> bool {
    divisor(one, other) == 1
}

/// The greatest common divisor (Euclid, *Elements* VII.2).
fn divisor(one: usize, other: usize) -> usize {
    if other == 0 {
        one
    } else {
        divisor(other, one % other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_steps_hit_every_place() {
        for (least, of, expected) in [(4, 12, 5), (12, 12, 13), (0, 7, 1), (6, 1, 6), (3, 0, 1)] {
            assert_eq!(coprime_from(least, of), expected, "{least} {of}");
        }
        for of in 1..60 {
            let stride = coprime_from(of / 3, of);
            let mut hit: Vec<usize> = (0..of).map(|i| i * stride % of).collect();
            hit.sort_unstable();
            assert!(hit.into_iter().eq(0..of), "{of}");
        }
    }
}
