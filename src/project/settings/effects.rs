//! Settings of the effects: what a person may switch.

use serde::{Deserialize, Serialize};

use crate::render::{Effects, Switch};

/// `[effects]`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EffectSettings {
    /// Lines of a salt's atoms.
    pub lines: Switch,
    /// Bands of a salt's molecules.
    pub bands: Switch,
    /// Light of radicals in the reaction zone.
    pub chemiluminescence: Switch,
    /// The fire's own light, scattered once by soot and smoke.
    pub scattering: Switch,
    /// Light bent by hot gas.
    pub refraction: Switch,
    /// Colours bent differently.
    pub dispersion: Switch,
    /// The fire as a light for the stage.
    pub fire_light: Switch,
    /// Smoke beside the soot.
    pub smoke: Switch,
    /// Light scattered more than once.
    pub scattering_orders: Switch,
}

impl From<EffectSettings> for Effects {
    fn from(set: EffectSettings) -> Self {
        Self {
            lines: set.lines,
            bands: set.bands,
            chemiluminescence: set.chemiluminescence,
            scattering: set.scattering,
            refraction: set.refraction,
            dispersion: set.dispersion,
            fire_light: set.fire_light,
            smoke: set.smoke,
            scattering_orders: set.scattering_orders,
            wavelengths: Switch::Auto,
        }
    }
}

impl From<Effects> for EffectSettings {
    /// What a person can set: all but the wavelengths, which she sets by their number.
    fn from(effects: Effects) -> Self {
        Self {
            lines: effects.lines,
            bands: effects.bands,
            chemiluminescence: effects.chemiluminescence,
            scattering: effects.scattering,
            refraction: effects.refraction,
            dispersion: effects.dispersion,
            fire_light: effects.fire_light,
            smoke: effects.smoke,
            scattering_orders: effects.scattering_orders,
        }
    }
}
