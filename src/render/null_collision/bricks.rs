//! Where collisions may be: bounds of each brick, and a ray's way through the bricks.

use glam::IVec3;
use rayon::prelude::*;

use crate::math::Ray;
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK};

use super::optics::Optics;

/// What one brick is at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Largest extinction at any point and wavelength, 1/m. Values between samples are means of samples, so the
    /// samples' largest bounds them all.
    pub(super) extinction: f64,
    /// Brightest sample, in the measure of [`Optics::glow`].
    pub(super) glow: f64,
}

/// Part of a ray inside one stored brick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// Which brick.
    pub(super) slot: u32,
    /// Where it begins and ends, metres along the ray.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Bounds of all stored bricks, in the order of their slots.
pub(super) fn bounds(medium: &Medium, optics: &Optics) -> Vec<Bounds> {
    let of_brick = |samples: &[[f32; 2]]| {
        let start = (0.0_f64, 0.0_f64);
        let (soot, glow) = samples.iter().fold(start, |(soot, glow), sample| {
            let sample = sample.map(f64::from);
            (soot.max(sample[0]), glow.max(optics.glow(sample)))
        });
        Bounds {
            extinction: optics.extinction(soot),
            glow,
        }
    };
    medium
        .samples
        .par_chunks_exact(BRICK_SAMPLES)
        .map(of_brick)
        .collect()
}

/// Collects the stretches of a ray of the lattice in stored bricks, nearest first, between two parameters that lie in
/// the domain (Amanatides & Woo 1987).
pub(super) fn stretches(
    medium: &Medium,
    ray: &Ray,
    [enter, exit]: [f64; 2],
    found: &mut Vec<Stretch>,
) {
    found.clear();
    let limit = medium.bricks.as_ivec3();
    if limit.min_element() == 0 {
        return;
    }
    let edge = BRICK as f64;
    let mut brick = (ray.at(enter) / edge)
        .floor()
        .as_ivec3()
        .clamp(IVec3::ZERO, limit - 1);
    let step = ray.direction.to_array().map(|d| if d < 0.0 { -1 } else { 1 });
    let border = |axis: usize, brick: i32| {
        let plane = f64::from(brick + i32::from(step[axis] > 0)) * edge;
        if ray.direction[axis] == 0.0 {
            f64::INFINITY
        } else {
            (plane - ray.origin[axis]) / ray.direction[axis]
        }
    };
    let mut next: [f64; 3] = std::array::from_fn(|axis| border(axis, brick[axis]));
    let mut from = enter;
    loop {
        let axis = (1..3).fold(0, |best, axis| if next[axis] < next[best] { axis } else { best });
        let to = next[axis].min(exit);
        let slot = medium.table[medium.brick_index(brick.as_uvec3())];
        if slot != NO_BRICK && to > from {
            found.push(Stretch { slot, from, to });
        }
        brick[axis] += step[axis];
        if next[axis] >= exit || brick[axis] < 0 || brick[axis] >= limit[axis] {
            return;
        }
        from = from.max(to);
        next[axis] = border(axis, brick[axis]);
    }
}
