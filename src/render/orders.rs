//! Light that has been scattered more than once: left out unless it is asked for, and then followed by path tracing.
//!
//! The picture stays the march's: emission, absorption and the first order of scattering come without noise. Only what is
//! scattered at least twice is estimated, by [`super::null_collision`], and added, right in the mean however thick the smoke
//! is. The noise falls as rays are added to the pixels.

use super::Cancel;
use super::film::Pixel;
use super::null_collision::{NullCollision, Params, Scattering};
use super::tables::{Node, Tables};
use crate::scene::Scene;

/// Paths for each ray of a pixel. In thick smoke they take longer than the march, and still fewer of them would not give
/// less noise in the same time.
const PATHS: u32 = 64;
/// Collisions in proportion to extinction that each flight spends, so that rarely scattered light is seen often enough.
const SCATTERING_POINTS: f64 = 8.0;

/// Light scattered at least twice, in one scene.
pub(super) struct HigherOrders<'a> {
    paths: NullCollision<'a>,
    size: [u32; 2],
}

impl<'a> HigherOrders<'a> {
    /// Prepares to follow light that is scattered 2 to `orders` times, at the tables' wavelengths.
    pub(super) fn new(scene: &'a Scene, tables: &'a Tables, orders: u32) -> Self {
        let params = Params {
            scattering: Scattering::Flame,
            min_bounces: 2,
            max_bounces: orders,
            // What surfaces send into the fire is not scattered in the march either.
            max_reflections: 0,
            scattering_points: SCATTERING_POINTS,
            ..Params::default()
        };
        Self {
            paths: NullCollision::new(scene, &tables.wavelengths, &params),
            size: tables.size,
        }
    }

    /// Adds that light to what the march found through a point of the picture. The paths of a sample are its own, whatever
    /// threads there are. Nothing of use if it is cancelled, which is asked before each path.
    pub(super) fn add(&self, point: [f64; 2], sample: u32, pixel: &mut Pixel, cancel: &Cancel) {
        let seed = u64::from(sample);
        let found = self.paths.mean(self.size, point, PATHS, seed, cancel);
        for (xyz, found) in pixel.xyz.iter_mut().zip(found) {
            *xyz += found as f32;
        }
    }
}

/// Depth by scattering alone of the densest columns of the scene, at the wavelength that scatters most.
pub(super) fn scattering_depth(scene: &Scene, tables: &Tables) -> f64 {
    let [all, smoke] = scene.flame.medium().densest_columns();
    let depth = |node: &Node| {
        let [by_soot, by_smoke] = node.scattering.map(f64::from);
        by_soot * (all - smoke).max(0.0) + by_smoke * smoke
    };
    tables.nodes.iter().map(depth).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::render::scatter::tests::{plan, scene};
    use crate::volume::procedural;

    #[test]
    fn cancelled_paths_are_not_followed() {
        let scene = scene(procedural::torch(), 100.0, None);
        let plan = plan(&scene);
        let higher = HigherOrders::new(&scene, &plan.tables, 4);
        let found = |cancel: &Cancel| {
            let mut pixel = Pixel::default();
            higher.add([12.0, 12.0], 0, &mut pixel, cancel);
            pixel.xyz
        };
        assert!(found(&Cancel::never())[1] > 0.0);
        let passed = Cancel::when_passed(Arc::new(1.into()), 0);
        assert_eq!(found(&passed), [0.0; 3]);
    }
}
