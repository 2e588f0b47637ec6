//! Light that has been scattered more than once: left out unless it is asked for, and then followed by path tracing.
//!
//! The picture stays the march's: emission, absorption and the first order of scattering come without noise. Only what is
//! scattered at least twice is estimated, by [`super::null_collision`], and added. The paths do not have to find the fire:
//! wherever they scatter they take up the light that [`super::scatter`] knows to be scattered there for the first time. So
//! what is scattered n times is a path of n − 1 scatterings that ends in that field, and as right as the field is.

use super::Cancel;
use super::film::Pixel;
use super::null_collision::{NullCollision, Params, Scattering};
use super::scatter::AllAround;
use super::tables::{Node, Tables};
use crate::scene::Scene;

/// Paths for each ray of a pixel where light is scattered about twice on its way or less; each is then cheap.
const PATHS: u32 = 64;
/// Least of them: in thick smoke a path scatters dozens of times, and there are no fewer rays for it.
const LEAST_PATHS: u32 = 16;
/// Scattering depth up to which there are all.
const CLEAR_DEPTH: f64 = 2.0;
/// Collisions in proportion to extinction that each flight spends, so that rarely scattered light is seen often enough.
const SCATTERING_POINTS: f64 = 8.0;

/// Light scattered at least twice, in one scene.
pub(super) struct HigherOrders<'a> {
    paths: NullCollision<'a>,
    /// For each ray.
    count: u32,
    size: [u32; 2],
}

impl<'a> HigherOrders<'a> {
    /// Prepares to follow light that is scattered 2 to `orders` times, at the tables' wavelengths.
    pub(super) fn new(
        scene: &'a Scene,
        tables: &'a Tables,
        orders: u32,
        around: &'a AllAround,
    ) -> Self {
        let params = Params {
            scattering: Scattering::Flame,
            // The last scattering is that of the field.
            min_bounces: 1,
            max_bounces: orders - 1,
            // What surfaces send into the fire is not scattered in the march either.
            max_reflections: 0,
            scattering_points: SCATTERING_POINTS,
            ..Params::default()
        };
        Self {
            paths: NullCollision::in_known_light(scene, &tables.wavelengths, &params, around),
            count: paths(scattering_depth(scene, tables)),
            size: tables.size,
        }
    }

    /// Adds that light to what the march found through a point of the picture. The paths of a sample are its own, whatever
    /// threads there are. Nothing of use if it is cancelled, which is asked before each path.
    pub(super) fn add(&self, point: [f64; 2], sample: u32, pixel: &mut Pixel, cancel: &Cancel) {
        let seed = u64::from(sample);
        let found = self.paths.mean(self.size, point, self.count, seed, cancel);
        for (xyz, found) in pixel.xyz.iter_mut().zip(found) {
            *xyz += found as f32;
        }
    }
}

/// How many paths a ray is given through a scene so deep.
fn paths(depth: f64) -> u32 {
    let affordable = f64::from(PATHS) * CLEAR_DEPTH / depth.max(CLEAR_DEPTH);
    (affordable as u32).clamp(LEAST_PATHS, PATHS)
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
    use super::*;

    #[test]
    fn deep_smoke_has_fewer_paths_but_never_too_few() {
        assert_eq!(
            [0.0, 2.0, 4.0, 8.0, 1e6].map(paths),
            [PATHS, PATHS, PATHS / 2, LEAST_PATHS, LEAST_PATHS]
        );
    }
}
