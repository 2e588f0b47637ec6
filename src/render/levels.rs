//! How often a picture shows each level of a display, and what of it is lost at the ends.

use super::film::Film;
use crate::colour::display::{BakedView, View};
use crate::math::coprime_from;

/// Levels of a channel of 8 bits.
pub const LEVELS: usize = 256;
/// Levels below this one are hardly told from black.
const DARK: usize = 12;
/// Highest of them.
const MOST: f32 = 255.0;

/// A histogram of the red, green and blue that a view shows of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// Share of the lit pixels at each level of red, green and blue, 0 to 1.
    pub shares: [[f32; LEVELS]; 3],
    /// Share of all pixels that are black: level 0 in every channel.
    pub black: f64,
    /// Share of the lit pixels at the highest level of red, green and blue: what is brighter cannot be told from it.
    pub clipped: [f64; 3],
}

impl Levels {
    /// Counts a film as a view develops it; of a large film about `most` pixels, evenly spread. All zeros for a film without
    /// light. False colour is no level of light: the picture itself is counted.
    pub fn of(film: &Film, view: &View, most: usize) -> Self {
        let view = View {
            false_colour: false,
            ..*view
        };
        let baked = BakedView::new(&view);
        let pixels = film.pixels();
        // Without a common divisor with the width every column is hit.
        let width = film.size()[0] as usize;
        let stride = coprime_from(pixels.len() / most.max(1), width);
        let mut counts = [[0_u32; LEVELS]; 3];
        let (mut all, mut black) = (0_u32, 0_u32);
        for pixel in pixels.iter().step_by(stride) {
            let levels = baked.apply(pixel.xyz).map(|v| (MOST * v).round() as usize);
            all += 1;
            if levels == [0; 3] {
                black += 1;
                continue;
            }
            for (counts, level) in counts.iter_mut().zip(levels) {
                counts[level.min(LEVELS - 1)] += 1;
            }
        }
        let lit = (all - black).max(1) as f32;
        let shares = counts.map(|counts| counts.map(|count| count as f32 / lit));
        Self {
            clipped: shares.map(|shares| f64::from(shares[LEVELS - 1])),
            shares,
            black: f64::from(black) / f64::from(all.max(1)),
        }
    }

    /// The highest share between the ends: the glow that fades around a fire and what is clipped would hide what is between
    /// them.
    pub fn peak(&self) -> f32 {
        let shares = self.shares.iter();
        let between = shares.flat_map(|shares| &shares[DARK..LEVELS - 1]);
        between.copied().fold(0.0, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::display::Curve;
    use crate::colour::xyz::srgb_decode;
    use crate::render::{Pixel, Tile};

    fn view() -> View {
        View {
            exposure: 1.0,
            adaptation: 0.0,
            white_xyz: [0.0; 3],
            curve: Curve::Linear,
            half_saturation: 0.5,
            false_colour: true,
        }
    }

    /// Light of D65, so that the three channels are the same.
    fn grey(y: f32) -> Pixel {
        Pixel {
            xyz: [0.95047 * y, y, 1.08883 * y],
            ..Pixel::default()
        }
    }

    #[test]
    fn each_level_is_counted_where_it_is_shown() {
        let mut film = Film::new([40, 5]);
        // A hundred black pixels, fifty of level 100, thirty of level 200, and twenty far above white.
        let level = |level: f32| srgb_decode(level / MOST);
        film.merge(&Tile {
            stride: 1,
            sample: 0,
            origin: [0, 0],
            size: [40, 5],
            pixels: (0..200)
                .map(|i| match i {
                    0..100 => grey(0.0),
                    100..150 => grey(level(100.0)),
                    150..180 => grey(level(200.0)),
                    _ => grey(9.0),
                })
                .collect(),
            taken: Vec::new(),
        });
        let levels = Levels::of(&film, &view(), usize::MAX);
        assert!((levels.black - 0.5).abs() < 1e-6);
        for c in 0..3 {
            assert!(
                (levels.clipped[c] - 0.2).abs() < 1e-6,
                "{:?}",
                levels.clipped
            );
            assert_eq!(levels.shares[c][0], 0.0);
            let near = |at: usize| levels.shares[c][at - 1..=at + 1].iter().sum::<f32>();
            assert!((near(100) - 0.5).abs() < 1e-6 && (near(200) - 0.3).abs() < 1e-6);
            let sum: f32 = levels.shares[c].iter().sum();
            assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        }
        assert_eq!(levels.peak(), 0.5);
        // A few pixels tell nearly the same.
        let few = Levels::of(&film, &view(), 60);
        assert!((few.black - 0.5).abs() < 0.05 && (few.clipped[0] - 0.2).abs() < 0.05);
        let none = Levels::of(&Film::new([3, 3]), &view(), 100);
        assert_eq!(
            (none.black, none.clipped, none.peak()),
            (1.0, [0.0; 3], 0.0)
        );
    }
}
