//! Random numbers by counting: the n-th number of a stream is a function of the stream's name and n, nothing else.
//!
//! Philox 4×32 with ten rounds (J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, *Parallel random numbers: as easy
//! as 1, 2, 3*, SC 2011): a keyed mixing of a 128-bit counter that passes BigCrush. There is no state to share, so what
//! a pixel's sample draws depends neither on threads nor on order.

/// Multipliers of the two halves of the counter.
const MULTIPLIERS: [u32; 2] = [0xd251_1f53, 0xcd9e_8d57];
/// What is added to the key between rounds: the golden ratio and √3 − 1.
const WEYL: [u32; 2] = [0x9e37_79b9, 0xbb67_ae85];
/// Rounds of mixing.
const ROUNDS: u32 = 10;

/// The 128 random bits of a counter under a key.
pub fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..ROUNDS {
        let [a, b] = [(0, counter[0]), (1, counter[2])]
            .map(|(half, word)| u64::from(MULTIPLIERS[half]) * u64::from(word));
        let (high, low) = (
            |product: u64| (product >> 32) as u32,
            |product: u64| product as u32,
        );
        counter = [
            high(b) ^ counter[1] ^ key[0],
            low(b),
            high(a) ^ counter[3] ^ key[1],
            low(a),
        ];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// The numbers of one sample at one place: dimension after dimension, each drawn once.
#[derive(Debug, Clone)]
pub struct Stream {
    key: [u32; 2],
    place: [u32; 2],
    sample: u32,
    /// Index of the next block of two numbers.
    block: u32,
    /// The second number of the last block, if it is still to be drawn.
    spare: Option<f64>,
}

impl Stream {
    /// The stream of a sample at a place (a pixel's column and row, say), under a seed. Streams that differ in any of
    /// these are independent.
    pub fn new(seed: u64, place: [u32; 2], sample: u32) -> Self {
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            place,
            sample,
            block: 0,
            spare: None,
        }
    }

    /// A number in 0 ≤ u < 1, evenly distributed in steps of 2⁻⁵³. A stream has 2³³ of them before it repeats.
    pub fn uniform(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let counter = [self.block, self.sample, self.place[0], self.place[1]];
        let [a, b, c, d] = philox(counter, self.key);
        self.block = self.block.wrapping_add(1);
        self.spare = Some(unit(c, d));
        unit(a, b)
    }

    /// A number above 0 with density e⁻ˣ: the distance to the next event in units of the mean distance.
    pub fn exponential(&mut self) -> f64 {
        -(-self.uniform()).ln_1p()
    }
}

/// The upper 53 of 64 bits as a number in 0 ≤ u < 1.
fn unit(high: u32, low: u32) -> f64 {
    let bits = u64::from(high) << 32 | u64::from(low);
    (bits >> 11) as f64 * (0.5 / (1_u64 << 52) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn philox_gives_its_published_answers() {
        // kat_vectors of the authors' Random123, philox4x32 with 10 rounds; the last are digits of π.
        let known = [
            (
                [0; 4],
                [0; 2],
                [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8],
            ),
            (
                [u32::MAX; 4],
                [u32::MAX; 2],
                [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd],
            ),
            (
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0],
                [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1],
            ),
        ];
        for (counter, key, answer) in known {
            assert_eq!(philox(counter, key), answer);
        }
    }

    #[test]
    fn uniform_numbers_reach_down_to_zero_and_never_to_one() {
        assert_eq!(unit(0, 0), 0.0);
        assert_eq!(unit(u32::MAX, u32::MAX), 1.0 - f64::EPSILON / 2.0);
        assert_eq!(unit(1 << 31, 0), 0.5);
    }

    #[test]
    fn streams_are_even_and_strangers_to_each_other() {
        let count = 40_000;
        let mut streams: Vec<Stream> = [
            (1, [2, 3], 4),
            (2, [2, 3], 4),
            (1 << 32, [2, 3], 4),
            (1, [3, 2], 4),
            (1, [2, 3], 5),
        ]
        .into_iter()
        .map(|(seed, place, sample)| Stream::new(seed, place, sample))
        .collect();
        let drawn: Vec<Vec<f64>> = streams
            .iter_mut()
            .map(|stream| (0..count).map(|_| stream.uniform() - 0.5).collect())
            .collect();
        let mean_product = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / f64::from(count)
        };
        let ones = vec![1.0; count as usize];
        // Five standard errors: 1/√12 for a mean, 1/12 for a covariance, 1/√180 for a variance.
        let error = 5.0 / f64::from(count).sqrt();
        for (i, a) in drawn.iter().enumerate() {
            assert!(mean_product(a, &ones).abs() < error * 0.2887);
            assert!((mean_product(a, a) - 1.0 / 12.0).abs() < error * 0.0746);
            assert!(mean_product(&a[1..], a).abs() < error / 12.0, "neighbours");
            for b in &drawn[..i] {
                assert!(mean_product(a, b).abs() < error / 12.0, "streams");
            }
        }
    }

    #[test]
    fn exponential_numbers_have_mean_one_and_variance_one() {
        let mut stream = Stream::new(7, [0, 0], 0);
        let count = 40_000;
        let drawn: Vec<f64> = (0..count).map(|_| stream.exponential()).collect();
        let mean = drawn.iter().sum::<f64>() / f64::from(count);
        let square = drawn.iter().map(|x| x * x).sum::<f64>() / f64::from(count);
        assert!(drawn.iter().all(|&x| (0.0..40.0).contains(&x)));
        // Standard errors 1/200 and √20/200.
        assert!(
            (mean - 1.0).abs() < 0.025 && (square - 2.0).abs() < 0.11,
            "{mean} {square}"
        );
    }
}
