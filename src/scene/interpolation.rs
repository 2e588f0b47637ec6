//! How values between the samples of a lattice are formed.
//!
//! The cubic B-spline is smooth to its second derivative, so that no line of the lattice shows, and its weights are
//! positive, so that it never leaves the range of its samples: no soot below zero, no overshoot. It does not go through
//! the samples: detail of a voxel is softened. Along an axis, with f the fraction between samples i and i + 1,
//!
//! ```text
//! w₋₁ = (1−f)³/6,  w₀ = (4 − 6f² + 3f³)/6,  w₁ = (1 + 3f + 3f² − 3f³)/6,  w₂ = f³/6
//! ```
//!
//! Two linear fetches in the right places do for the four (C. Sigg and M. Hadwiger, *GPU Gems 2* (2005), ch. 20):
//! one between i−1 and i that weighs w₋₁ + w₀, one between i+1 and i+2 that weighs w₁ + w₂.

use glam::{DVec3, IVec3};
use serde::{Deserialize, Serialize};

/// How values between samples are formed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// The nearest sample: blocks, as the file has them.
    Nearest,
    /// Linear along each axis.
    #[default]
    Trilinear,
    /// A cubic B-spline along each axis: smooth, never negative, and eight times the fetches.
    Tricubic,
}

impl Interpolation {
    /// All ways, the quickest first.
    pub const ALL: [Self; 3] = [Self::Nearest, Self::Trilinear, Self::Tricubic];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Trilinear => "trilinear",
            Self::Tricubic => "tricubic",
        }
    }

    /// How far from a position samples still count, in voxels.
    pub(super) fn reach(self) -> i32 {
        match self {
            Self::Nearest | Self::Trilinear => 1,
            Self::Tricubic => 2,
        }
    }

    /// Visits the cells in which a linear fetch is made for a position: the voxel, the fraction within its cell, and
    /// the weight of the fetch. The weights add up to 1.
    pub(super) fn for_each_cell(self, position: DVec3, mut visit: impl FnMut(IVec3, DVec3, f64)) {
        let base = position.floor();
        let fraction = position - base;
        match self {
            Self::Nearest => visit(base.as_ivec3(), (fraction + 0.5).floor(), 1.0),
            Self::Trilinear => visit(base.as_ivec3(), fraction, 1.0),
            Self::Tricubic => {
                let [x, y, z] = fraction.to_array().map(spline_fetches);
                for (dz, wz) in z {
                    for (dy, wy) in y {
                        for (dx, wx) in x {
                            let place = base + DVec3::new(dx, dy, dz);
                            let floor = place.floor();
                            visit(floor.as_ivec3(), place - floor, wx * wy * wz);
                        }
                    }
                }
            }
        }
    }
}

/// The two linear fetches that make the spline at a fraction 0 to 1: how far from sample 0 each lies, and its weight.
fn spline_fetches(f: f64) -> [(f64, f64); 2] {
    let g = 1.0 - f;
    let inner = |f: f64| (4.0 - 3.0 * f * f * (2.0 - f)) / 6.0;
    let outer = |f: f64| f * f * f / 6.0;
    let (low, high) = (outer(g) + inner(f), inner(g) + outer(f));
    [(inner(f) / low - 1.0, low), (1.0 + outer(f) / high, high)]
}

/// [`spline_fetches`] for the march.
#[inline(always)]
pub(crate) fn spline_fetches_f32(f: f32) -> [(f32, f32); 2] {
    let g = 1.0 - f;
    let inner = |f: f32| (4.0 - 3.0 * f * f * (2.0 - f)) * (1.0 / 6.0);
    let outer = |f: f32| f * f * f * (1.0 / 6.0);
    let (low, high) = (outer(g) + inner(f), inner(g) + outer(f));
    [(inner(f) / low - 1.0, low), (1.0 + outer(f) / high, high)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weight of every voxel that counts at a position.
    fn weights(interpolation: Interpolation, position: DVec3) -> Vec<(IVec3, f64)> {
        let mut found = Vec::new();
        interpolation.for_each_cell(position, |voxel, fraction, weight| {
            for corner in 0..8 {
                let step = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
                let upper = step.as_dvec3();
                let share = upper * fraction + (1.0 - upper) * (1.0 - fraction);
                found.push((voxel + step, weight * share.element_product()));
            }
        });
        found
    }

    #[test]
    fn weights_are_positive_add_up_to_one_and_keep_straight_lines() {
        for interpolation in Interpolation::ALL {
            for i in 0..50 {
                let i = f64::from(i);
                let position = DVec3::new(3.0 + 0.02 * i, 2.7, 5.0 - 0.013 * i);
                let weights = weights(interpolation, position);
                assert!(weights.iter().all(|(_, weight)| *weight >= -1e-15));
                let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() < 1e-14);
                let middle: DVec3 = weights
                    .iter()
                    .map(|(voxel, weight)| voxel.as_dvec3() * *weight)
                    .sum();
                let slack = if interpolation == Interpolation::Nearest {
                    0.5
                } else {
                    1e-12
                };
                assert!(
                    (middle - position).abs().max_element() <= slack,
                    "{interpolation:?}"
                );
            }
        }
    }

    #[test]
    fn two_fetches_are_the_four_weights_of_the_spline() {
        for i in 0..=100 {
            let f = f64::from(i) / 100.0;
            let g = 1.0 - f;
            let expected = [
                g * g * g / 6.0,
                (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0,
                (1.0 + 3.0 * f + 3.0 * f * f - 3.0 * f * f * f) / 6.0,
                f * f * f / 6.0,
            ];
            let wide = |[(a, b), (c, d)]: [(f32, f32); 2]| {
                [(f64::from(a), f64::from(b)), (f64::from(c), f64::from(d))]
            };
            for (fetches, slack) in [
                (spline_fetches(f), 1e-15),
                (wide(spline_fetches_f32(f as f32)), 3e-7),
            ] {
                let [(low_at, low), (high_at, high)] = fetches;
                let made = [
                    -low_at * low,
                    (1.0 + low_at) * low,
                    (2.0 - high_at) * high,
                    (high_at - 1.0) * high,
                ];
                for (made, expected) in made.into_iter().zip(expected) {
                    assert!((made - expected).abs() < slack, "f = {f}");
                }
            }
        }
    }

    #[test]
    fn the_spline_has_no_kink_at_a_sample() {
        let at = |x: f64| {
            let weights = weights(Interpolation::Tricubic, DVec3::new(x, 0.3, 0.6));
            let sharp = weights.iter().filter(|(voxel, _)| voxel.x == 2);
            sharp.map(|(_, weight)| weight).sum::<f64>()
        };
        let h = 1e-3;
        let curvature = |x: f64| (at(x + h) - 2.0 * at(x) + at(x - h)) / (h * h);
        for border in [0.0, 1.0, 2.0, 3.0, 4.0] {
            let jump = curvature(border + 2.0 * h) - curvature(border - 2.0 * h);
            assert!(jump.abs() < 0.02, "{border}: {jump}");
        }
    }
}
