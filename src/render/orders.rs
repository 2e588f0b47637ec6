//! Light that has been scattered more than once: left out unless it is asked for, and then followed by path tracing.
//!
//! The picture stays the march's: emission, absorption and the first order of scattering come without noise. Only what is
//! scattered at least twice is estimated, by [`super::null_collision`], and added. It is a small part of the light, so
//! its noise is a small part of the picture, and falls as rays are added to the pixels.

use super::film::Pixel;
use super::null_collision::{NullCollision, Params, Scattering};
use super::tables::Tables;
use crate::scene::Scene;

/// Paths for each ray of a pixel: the light of higher orders, a hundredth of the whole where it is worth asking for, then
/// has a noise of about a tenth of itself. In thick white smoke it is most of the light, and far noisier.
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
    /// threads there are.
    pub(super) fn add(&self, point: [f64; 2], sample: u32, pixel: &mut Pixel) {
        // A camera that cannot see has no march either.
        let Ok(found) = self
            .paths
            .estimate(self.size, point, PATHS, u64::from(sample))
        else {
            return;
        };
        for (xyz, found) in pixel.xyz.iter_mut().zip(found.mean) {
            *xyz += found as f32;
        }
    }
}
