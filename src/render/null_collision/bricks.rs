//! Where collisions may be: bounds of each brick, and a ray's way through the bricks.

use rayon::prelude::*;

use crate::math::Ray;
use crate::render::walk::{Stretch, for_each_stretch};
use crate::scene::medium::{BRICK_SAMPLES, Medium};

use super::optics::{Optics, Place};

/// What one brick is at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Largest extinction at any point and wavelength, 1/m. Values between samples are means of samples, so the
    /// samples' largest bounds them all.
    pub(super) extinction: f64,
    /// Brightest sample, in the measure of [`Optics::glow`].
    pub(super) glow: f64,
}

/// Bounds of all stored bricks, in the order of their slots.
pub(super) fn bounds(medium: &Medium, optics: &Optics) -> Vec<Bounds> {
    let of_brick = |(slot, samples): (usize, &[[f32; 2]])| {
        let start = (0.0_f64, 0.0_f64);
        let (soot, glow) = samples
            .iter()
            .enumerate()
            .fold(start, |(soot, glow), (i, sample)| {
                let [volume_fraction, kelvin] = sample.map(f64::from);
                let flame = medium.flame.get(slot * BRICK_SAMPLES + i);
                let place = Place {
                    soot: volume_fraction,
                    kelvin,
                    flame: flame.copied().unwrap_or(0.0).into(),
                };
                (soot.max(volume_fraction), glow.max(optics.glow(&place)))
            });
        Bounds {
            extinction: optics.extinction(soot),
            glow,
        }
    };
    medium
        .samples
        .par_chunks_exact(BRICK_SAMPLES)
        .enumerate()
        .map(of_brick)
        .collect()
}

/// Collects the stretches of a ray of the lattice that have a length.
pub(super) fn stretches(medium: &Medium, ray: &Ray, range: [f64; 2], found: &mut Vec<Stretch>) {
    found.clear();
    for_each_stretch(medium, ray, range, |stretch| {
        if stretch.to > stretch.from {
            found.push(stretch);
        }
    });
}
