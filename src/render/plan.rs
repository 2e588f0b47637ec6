//! What is computed for a scene at given settings: which effects, the laws baked into tables, and the fields that the
//! effects need.

use std::cell::OnceCell;
use std::sync::{Arc, OnceLock};

use super::clock::timed;
use super::fields::{Bent, Fields, Paths, Seconds, Wanted};
use super::level::Level;
use super::preparation::{Preparation, Watch};
use super::tables::Tables;
use super::{Cancel, Effects, Flaws, Settings, Switch};
use crate::scene::glow::Feature;
use crate::scene::{Scene, WavelengthSet};
use crate::spectral::Wavelengths;

mod bounds;
mod decide;
mod effect;
mod flaws;
mod sketch;
mod switched;
mod wavelengths;

pub use bounds::smoke as smoke_bound;
pub use decide::{OFF_BELOW, ON_ABOVE};
pub use effect::{Decision, Effect};

use decide::Decider;
pub(in crate::render) use effect::is_on;

/// What is computed for one scene at one accuracy.
#[derive(Debug)]
pub struct Plan {
    /// The laws.
    pub tables: Tables,
    /// What these settings cannot show faithfully of this scene.
    pub flaws: Flaws,
    /// Which effects are computed, and why.
    pub decisions: Vec<Decision>,
    wanted: Wanted,
    /// Whether single points are looked at, which are to be right in coarse fields as well.
    is_measuring: bool,
    /// How often light may be scattered; 1 where scattering is off.
    pub(super) orders: u32,
    /// Coarse and fine fields, as soon as they have been asked for.
    fields: [OnceLock<Fields>; 2],
    /// What bends light, and the seconds that it took to find.
    bent: OnceLock<(Option<Arc<Bent>>, f64)>,
    /// The fields of a scene that calls for none.
    without: Fields,
    /// How far the fields are that are being worked out.
    preparation: Preparation,
}

/// What was found out about a picture on the way.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Facts {
    /// How far refraction moves what lies behind the fire at most, pixels; `None` where light goes straight.
    pub largest_shift_px: Option<f64>,
    /// Estimated share of the picture's light that was scattered more often than is computed, and is left out; `None` where
    /// nothing is scattered.
    pub orders_left_out: Option<f64>,
}

impl Plan {
    /// Bakes the tables for the settings' own wavelengths.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        Self::after(scene, settings, &[])
    }

    /// The same for a picture that comes after another, of which this was decided: what is at the border stays as it was.
    pub fn after(scene: &Scene, settings: &Settings, before: &[Decision]) -> Self {
        let features = scene.flame.glow().features();
        let decider = Decider {
            scene,
            features: &features,
            settings,
            before,
            sketch: OnceCell::new(),
        };
        let mut decisions = decider.decide();
        let scattering = decisions.iter().find(|it| it.effect == Effect::Scattering);
        let scattering = scattering.cloned().unwrap_or_else(|| decider.scattering());
        let (wavelengths, decision) = decider.wavelengths(&scattering);
        decisions.push(decision);
        drop(decider);
        let mut plan = Self::deciding(scene, settings, wavelengths, features, decisions);
        flaws::add(&mut plan, scene, settings);
        plan
    }

    /// As decided, with those of all the gas's features that are.
    fn deciding(
        scene: &Scene,
        settings: &Settings,
        wavelengths: Wavelengths,
        mut features: Vec<Feature>,
        decisions: Vec<Decision>,
    ) -> Self {
        features.retain(|feature| is_on(&decisions, Effect::of_glow(feature.kind())));
        let mut plan = Self::of(scene, settings.size, wavelengths, features, decisions);
        let again = is_on(&plan.decisions, Effect::ScatteringOrders);
        if plan.wanted.scatter && again {
            plan.orders = settings.scattering_orders;
        }
        plan.wanted.again = plan.wanted.scatter && again && plan.orders == 1;
        plan
    }

    /// Bakes the tables for given wavelengths, at most [`MAX_NODES`](super::tables::MAX_NODES) of them: those of a
    /// measurement, say. All that glows in the gas is in it; light is not scattered and goes straight.
    pub fn with_wavelengths(scene: &Scene, size: [u32; 2], wavelengths: Wavelengths) -> Self {
        let effects = Effects {
            scattering: Switch::Off,
            refraction: Switch::Off,
            ..Effects::AUTO
        };
        Self::measuring(scene, size, wavelengths, effects)
    }

    /// The same with effects switched as a person has them.
    pub(super) fn measuring(
        scene: &Scene,
        size: [u32; 2],
        wavelengths: Wavelengths,
        effects: Effects,
    ) -> Self {
        let features = scene.flame.glow().features();
        let settings = Settings {
            size,
            step_voxels: 1.0,
            wavelengths: WavelengthSet::Fitted(6),
            samples_per_pixel: 1,
            scattering_orders: 1,
            effects,
        };
        let decider = Decider {
            scene,
            features: &features,
            settings: &settings,
            before: &[],
            sketch: OnceCell::new(),
        };
        let decisions = decider.decide();
        drop(decider);
        let mut plan = Self::of(scene, size, wavelengths, features, decisions);
        plan.is_measuring = true;
        plan
    }

    /// How many wavelengths are carried.
    pub fn wavelengths(&self) -> u32 {
        self.tables.nodes.len() as u32
    }

    /// What all effects that are left out change together at most, ΔE_ITP; those that a person left out do not count.
    pub fn left_out_de(&self) -> f64 {
        let out = self
            .decisions
            .iter()
            .filter(|it| !it.on && it.switch != Switch::Off && it.effect != Effect::Wavelengths);
        out.filter_map(|it| it.bound).sum()
    }

    /// Whether light is gathered from all sides: what is scattered, or falls on the stage.
    pub fn gathers(&self) -> bool {
        self.wanted.scatter || self.wanted.fire_light
    }

    /// Whether rays are bent.
    pub fn bends(&self) -> bool {
        self.wanted.bent.is_some()
    }

    /// Whether the fields of a level are worked out, or there are none to work out.
    pub(super) fn has_fields(&self, level: Level) -> bool {
        self.wanted == Wanted::default() || self.fields[level as usize].get().is_some()
    }

    fn of(
        scene: &Scene,
        size: [u32; 2],
        wavelengths: Wavelengths,
        features: Vec<Feature>,
        decisions: Vec<Decision>,
    ) -> Self {
        let wanted = Wanted {
            scatter: is_on(&decisions, Effect::Scattering),
            again: is_on(&decisions, Effect::ScatteringOrders),
            fire_light: is_on(&decisions, Effect::FireLight),
            bent: is_on(&decisions, Effect::Refraction).then(|| {
                if is_on(&decisions, Effect::Dispersion) {
                    Paths::Apart
                } else {
                    Paths::Common
                }
            }),
        };
        Self {
            tables: Tables::new(scene, size, wavelengths, features, wanted.scatter),
            flaws: Flaws::default(),
            decisions,
            wanted,
            orders: 1,
            is_measuring: false,
            fields: [OnceLock::new(), OnceLock::new()],
            bent: OnceLock::new(),
            without: Fields::default(),
            preparation: Preparation::default(),
        }
    }

    /// The fields of a level, worked out in the calling thread's rayon pool when they are asked for first; `None` if that
    /// was cancelled. The scene is the plan's own.
    pub fn fields(&self, scene: &Scene, level: Level, cancel: &Cancel) -> Option<&Fields> {
        if self.wanted == Wanted::default() {
            return Some(&self.without);
        }
        let cell = &self.fields[level as usize];
        if let Some(ready) = cell.get() {
            return Some(ready);
        }
        // Where only the fire itself is seen through bent light, a coarse picture does not show it.
        let shows_bent = level == Level::Fine || self.is_measuring || scene.stage.shows_behind();
        let known = if shows_bent {
            self.bent(scene)
        } else {
            Fields::default()
        };
        let (tables, wanted) = (&self.tables, self.wanted);
        let work = |watch: &Watch<'_>| Fields::new(scene, tables, wanted, known, level, watch);
        let fields = self.preparation.during(cancel, work)?;
        Some(cell.get_or_init(|| fields))
    }

    /// How far the fields are that are being worked out, for whoever waits for them.
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// The same plan, whose preparation is told where somebody listens already.
    #[must_use]
    pub fn told_by(mut self, preparation: &Preparation) -> Self {
        self.preparation = preparation.clone();
        self
    }

    /// Works out how light is bent, in the calling thread's rayon pool, if that is asked for and nobody has.
    pub fn bend(&self, scene: &Scene) {
        self.bent(scene);
    }

    /// The fields, as far as they are what bends light.
    fn bent(&self, scene: &Scene) -> Fields {
        let Some(paths) = self.wanted.bent else {
            return Fields::default();
        };
        let find = || timed(|| Bent::new(scene, self.tables.size, paths).map(Arc::new));
        let (bent, seconds) = self.bent.get_or_init(find);
        Fields {
            bent: bent.clone(),
            seconds: Seconds {
                bent: *seconds,
                ..Seconds::default()
            },
            ..Fields::default()
        }
    }

    /// The fine fields.
    pub(super) fn fine_fields(&self, scene: &Scene) -> &Fields {
        // What nothing cancels is there.
        self.fields(scene, Level::Fine, &Cancel::never())
            .unwrap_or(&self.without)
    }

    /// What has been found out so far.
    pub fn facts(&self) -> Facts {
        let [coarse, fine] = &self.fields;
        let fields = fine.get().or_else(|| coarse.get());
        let bent = fields.and_then(|fields| fields.bent.as_ref());
        let scatter = fields.and_then(|fields| fields.scatter.as_ref());
        Facts {
            largest_shift_px: bent.map(|bent| bent.largest_shift_px),
            orders_left_out: scatter.map(|scatter| scatter.orders_left_out(self.orders)),
        }
    }
}
