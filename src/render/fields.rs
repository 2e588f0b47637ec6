//! What is worked out of a scene before its rays are marched: the light that is scattered towards the eye, the fire as a
//! light for the stage, the gas that bends rays. Each only where the plan says that it is computed.

use std::sync::Arc;

use super::clock::timed;
use super::irradiance::FireLight;
use super::level::Level;
use super::preparation::Watch;
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
    /// The same more than once.
    pub again: bool,
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
#[derive(Debug, Clone, Default)]
pub struct Fields {
    pub(super) scatter: Option<Arc<InScatter>>,
    pub(super) fire_light: Option<Arc<FireLight>>,
    pub(super) bent: Option<Arc<Bent>>,
    pub(super) seconds: Seconds,
}

/// What it took to work each of them out, wall-clock seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Seconds {
    pub(super) scatter: f64,
    pub(super) fire_light: f64,
    pub(super) bent: f64,
}

impl Seconds {
    pub(super) fn all(self) -> f64 {
        self.scatter + self.fire_light + self.bent
    }
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
    /// Whether the light that is scattered in both was worked out once, and so is of one scene.
    pub fn shares_scattered_light(&self, other: &Self) -> bool {
        let pair = self.scatter.as_ref().zip(other.scatter.as_ref());
        pair.is_some_and(|(one, other)| Arc::ptr_eq(one, other))
    }

    /// Works out in the calling thread's rayon pool what is not `known`; `None` if cancelled. Bent light is known.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        wanted: Wanted,
        known: Self,
        level: Level,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        let mut fields = known;
        let both = wanted.scatter && wanted.fire_light;
        let [first, second] = if both {
            [watch.part(0.0, 0.5), watch.part(0.5, 1.0)]
        } else {
            [watch.part(0.0, 1.0), watch.part(0.0, 1.0)]
        };
        if wanted.scatter && fields.scatter.is_none() {
            // A coarse picture is not worth more than what is scattered once.
            let again = wanted.again && level == Level::Fine;
            let work = || InScatter::new(scene, tables, again, level, &first);
            let (made, seconds) = timed(work);
            fields.scatter = Some(Arc::new(made?));
            fields.seconds.scatter = seconds;
        }
        if wanted.fire_light && fields.fire_light.is_none() {
            let (made, seconds) = timed(|| FireLight::new(scene, tables, level, &second));
            fields.fire_light = Some(Arc::new(made?));
            fields.seconds.fire_light = seconds;
        }
        Some(fields)
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
