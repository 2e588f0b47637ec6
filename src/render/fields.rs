//! What is worked out of a scene before its rays are marched: the light that is scattered towards the eye, the fire as a
//! light for the stage, the gas that bends rays. Each only where the plan says that it is computed.

use std::sync::Arc;

use super::Cancel;
use super::irradiance::FireLight;
use super::level::Level;
use super::scatter::InScatter;
use super::shift::largest_shift_px;
use super::tables::Tables;
use crate::scene::Scene;
use crate::scene::refractivity::{PATHS_NM, Refractivity};

/// Which fields a scene calls for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Wanted {
    /// The fire's light scattered towards the eye.
    pub scatter: bool,
    /// The fire as a light for the stage.
    pub fire_light: bool,
    /// The gas that bends rays.
    pub bent: Option<Paths>,
}

/// Which light goes which way through gas that bends it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paths {
    /// All along that of Y.
    Common,
    /// X, Y and Z each along a path of its own.
    Apart,
}

/// The fields of one scene.
#[derive(Debug, Default)]
pub struct Fields {
    pub(super) scatter: Option<InScatter>,
    pub(super) fire_light: Option<FireLight>,
    pub(super) bent: Option<Arc<Bent>>,
}

/// The gas at the wavelength of each group of colours that has a path of its own.
#[derive(Debug)]
pub struct Bent {
    /// For Y, by which the fire itself is seen.
    pub(super) main: Refractivity,
    /// For X and Z, if they have paths of their own.
    pub(super) others: Option<[Refractivity; 2]>,
    /// How far what lies behind is moved at most, pixels.
    pub(super) largest_shift_px: f64,
}

impl Fields {
    /// Works them out in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        wanted: Wanted,
        bent: Option<Arc<Bent>>,
        level: Level,
        cancel: &Cancel,
    ) -> Option<Self> {
        let scatter = if wanted.scatter {
            Some(InScatter::new(scene, tables, level, cancel)?)
        } else {
            None
        };
        let fire_light = if wanted.fire_light {
            Some(FireLight::new(scene, tables, level, cancel)?)
        } else {
            None
        };
        Some(Self {
            scatter,
            fire_light,
            bent,
        })
    }
}

impl Bent {
    /// The gas of a scene that bends light, seen in a picture of `size` pixels; `None` where none does.
    pub(super) fn new(scene: &Scene, size: [u32; 2], paths: Paths) -> Option<Self> {
        let [x_nm, y_nm, z_nm] = PATHS_NM;
        let at = |nm| Refractivity::new(&scene.flame, nm);
        let main = at(y_nm)?;
        let others = if paths == Paths::Apart {
            Some([at(x_nm)?, at(z_nm)?])
        } else {
            None
        };
        Some(Self {
            largest_shift_px: largest_shift_px(scene, &main, size).ok()?,
            main,
            others,
        })
    }
}
