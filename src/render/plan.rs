//! What is computed for a scene at given settings: which effects, the laws baked into tables, and the fields that the
//! effects need.

use std::sync::{Arc, OnceLock};

use super::fields::{Bent, Fields, Paths, Wanted};
use super::level::Level;
use super::orders::scattering_depth;
use super::tables::Tables;
use super::{Cancel, Effects, Flaws, Settings, Switch};
use crate::colour::cie;
use crate::physics::blackbody;
use crate::scene::Scene;
use crate::scene::glow::{Feature, Source};
use crate::spectral::Wavelengths;

mod scattering;

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
    /// How often light may be scattered; 1 where scattering is off.
    pub(super) orders: u32,
    /// Coarse and fine fields, as soon as they have been asked for.
    fields: [OnceLock<Fields>; 2],
    bent: OnceLock<Option<Arc<Bent>>>,
    /// The fields of a scene that calls for none.
    without: Fields,
}

/// Whether an effect is computed, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// Its name, as in the scene file's `[effects]` where it stands there.
    pub effect: &'static str,
    /// Whether it is computed.
    pub on: bool,
    /// Why, for a person.
    pub reason: String,
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

/// Scattering depth from which on it is said that path-traced light is noisy: few paths come to where it is bright.
const DEEP_SMOKE: f64 = 20.0;

/// Optical depth of a step from which on the picture's error is said: the midpoint rule is off by about τ²/24 of a
/// step's light, here 1 %.
const THICK_STEP: f64 = 0.5;

impl Plan {
    /// Bakes the tables for the settings' own wavelengths.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let wavelengths = settings.wavelengths.wavelengths(scene.flame.soot());
        let mut features = scene.flame.glow().features();
        let decisions = decisions(scene, &features, settings.effects);
        let with_radicals = is_on(&decisions, CHEMILUMINESCENCE);
        features.retain(|feature| with_radicals || !feature.is_radical());
        let mut plan = Self::of(scene, settings.size, wavelengths, features, decisions);
        if plan.wanted.scatter {
            plan.orders = settings.scattering_orders;
            let depth = scattering_depth(scene, &plan.tables);
            if plan.orders > 1 && depth > DEEP_SMOKE {
                plan.flaws.add(format!(
                    "a straight way through the fire is up to {depth:.0} mean free paths between scatterings long: what is \
                     scattered more than once is noisy here. More rays for each pixel make it smoother"
                ));
            }
        }
        let medium = scene.flame.medium();
        let densest = plan
            .tables
            .nodes
            .iter()
            .map(|node| f64::from(node.absorption))
            .fold(0.0, f64::max);
        let step_m = settings.step_voxels * medium.voxel_size_m();
        let thickest = densest * f64::from(medium.peak_volume_fraction()) * step_m;
        if thickest > THICK_STEP {
            plan.flaws.add(format!(
                "the soot is so dense that a step of {} × a voxel's edge is up to {thickest:.1} optical depths thick: take \
                 smaller steps, or less soot",
                settings.step_voxels
            ));
        }
        if plan.wanted.scatter && plan.tables.features.iter().any(|it| !it.is_radical()) {
            plan.flaws
                .add("the light of the salt is dimmed by scattering, but is not seen scattered");
        }
        plan
    }

    /// Bakes the tables for given wavelengths, at most [`MAX_NODES`](super::tables::MAX_NODES) of them: those of a
    /// measurement, say. All that glows in the gas is in it.
    pub fn with_wavelengths(scene: &Scene, size: [u32; 2], wavelengths: Wavelengths) -> Self {
        Self::measuring(scene, size, wavelengths, Effects::AUTO)
    }

    /// The same with effects switched as a person has them.
    pub(super) fn measuring(
        scene: &Scene,
        size: [u32; 2],
        wavelengths: Wavelengths,
        effects: Effects,
    ) -> Self {
        let features = scene.flame.glow().features();
        let decisions = decisions(scene, &features, effects);
        Self::of(scene, size, wavelengths, features, decisions)
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
            scatter: is_on(&decisions, SCATTERING),
            fire_light: is_on(&decisions, FIRE_LIGHT),
            bent: is_on(&decisions, REFRACTION).then(|| {
                if is_on(&decisions, DISPERSION) {
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
            fields: [OnceLock::new(), OnceLock::new()],
            bent: OnceLock::new(),
            without: Fields::default(),
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
        let bent = self.wanted.bent.and_then(|paths| {
            let bent = || Bent::new(scene, self.tables.size, paths).map(Arc::new);
            self.bent.get_or_init(bent).clone()
        });
        let fields = Fields::new(scene, &self.tables, self.wanted, bent, level, cancel)?;
        Some(cell.get_or_init(|| fields))
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

/// Names among the effects.
const SCATTERING: &str = "scattering";
const REFRACTION: &str = "refraction";
const DISPERSION: &str = "dispersion";
const FIRE_LIGHT: &str = "fire_light";

fn is_on(decisions: &[Decision], effect: &str) -> bool {
    decisions.iter().any(|it| it.effect == effect && it.on)
}

/// The name of the radicals' light among the effects.
const CHEMILUMINESCENCE: &str = "chemiluminescence";

/// Which effects a scene calls for.
fn decisions(scene: &Scene, features: &[Feature], effects: Effects) -> Vec<Decision> {
    let decision = |effect, on, reason: &str| Decision {
        effect,
        on,
        reason: reason.to_owned(),
    };
    let glow = scene.flame.glow();
    vec![
        if scene.flame.medium().peak_volume_fraction() > 0.0 {
            decision("emission-absorption", true, "soot glows and absorbs")
        } else {
            decision("emission-absorption", false, "there is no soot")
        },
        match effects.lines {
            Switch::Off => decision("lines", false, "effects.lines is off"),
            _ if glow.has_metal() => decision("lines", true, "there is a salt in the gas"),
            Switch::Auto | Switch::On => decision("lines", false, "there is no salt"),
        },
        match effects.chemiluminescence {
            Switch::Off => decision(CHEMILUMINESCENCE, false, "effects.chemiluminescence is off"),
            _ if !glow.has_radicals() => decision(
                CHEMILUMINESCENCE,
                false,
                "no field says where gas burns, or nothing that glows is burnt there",
            ),
            Switch::Auto if radicals_are_outshone(scene, features) => decision(
                CHEMILUMINESCENCE,
                false,
                "soot outshines the burning gas a thousandfold wherever it burns",
            ),
            Switch::Auto => decision(
                CHEMILUMINESCENCE,
                true,
                "burning gas may be seen beside the soot",
            ),
            Switch::On => decision(CHEMILUMINESCENCE, true, ASKED_FOR),
        },
        scattering::decide(scene, effects.scattering),
        match effects.refraction {
            Switch::Off => decision(REFRACTION, false, "effects.refraction is off"),
            _ if scene.flame.bending().is_none() => {
                decision(REFRACTION, false, "nothing behind the fire shows it")
            }
            Switch::Auto => decision(REFRACTION, true, "what is behind the fire shows it"),
            Switch::On => decision(REFRACTION, true, ASKED_FOR),
        },
        match scene.flame.bending() {
            _ if effects.dispersion == Switch::Off => {
                decision(DISPERSION, false, "effects.dispersion is off")
            }
            Some(bending) if bending.bending.dispersion => decision(DISPERSION, true, ASKED_FOR),
            _ => decision(
                DISPERSION,
                false,
                "it is a fiftieth of the bending, and was not asked for",
            ),
        },
        match effects.fire_light {
            Switch::Off => decision(FIRE_LIGHT, false, "effects.fire_light is off"),
            _ if !scene.stage.has_surfaces() => {
                decision(FIRE_LIGHT, false, "there is nothing that it could fall on")
            }
            Switch::Auto => decision(FIRE_LIGHT, true, "it falls on the stage"),
            Switch::On => decision(FIRE_LIGHT, true, ASKED_FOR),
        },
    ]
}

/// Why an effect is computed that a person switched on.
const ASKED_FOR: &str = "it was asked for";

/// Luminance of the radicals beside that of the soot at the same place (or beside a thirtieth of the brightest soot's)
/// below which they are left out: a thousandth of what is there, and less than a step of 8 bits where nothing is, at the
/// exposure that shows the brightest parts as 4 × display white.
const OUTSHONE: f64 = 1e-3;

/// Whether soot outshines the light of radicals everywhere.
fn radicals_are_outshone(scene: &Scene, features: &[Feature]) -> bool {
    let (flame, peaks) = (&scene.flame, &scene.flame.medium().peaks);
    let [soot, kelvin] = peaks.brightest.map(f64::from);
    let luminous = |nm: f64| {
        let emission =
            flame.absorption_per_sample(nm) * soot * blackbody::spectral_radiance(nm, kelvin);
        10.0 * emission * cie::colour_matching(nm)[1]
    };
    let brightest_y: f64 = (380..=780).step_by(10).map(f64::from).map(luminous).sum();
    // The measure of the soot's glow in units of its luminance.
    let y_per_glow = brightest_y / f64::from(peaks.glow);
    let radicals_y: f64 = features
        .iter()
        .map(|feature| match feature.source {
            Source::Radical(emission) => emission * feature.colour[1],
            Source::Thermal { .. } => 0.0,
        })
        .sum();
    peaks.flame <= 0.0 || radicals_y * f64::from(peaks.flame_beside_glow) < OUTSHONE * y_per_glow
}
