//! The effects that a scene may call for, and what was decided about each.

use crate::render::{Effects, Switch};
use crate::scene::glow::Kind;

/// Something that a picture may show or leave out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Soot that glows and absorbs.
    Soot,
    /// Smoke beside the soot, which mostly absorbs.
    Smoke,
    /// Lines of a salt's atoms.
    Lines,
    /// Bands of a salt's molecules.
    Bands,
    /// Light of radicals where gas burns.
    Chemiluminescence,
    /// The fire's own light, scattered once.
    Scattering,
    /// Light scattered more than once.
    ScatteringOrders,
    /// Light bent by hot gas.
    Refraction,
    /// Colours bent differently.
    Dispersion,
    /// The fire as a light for the stage.
    FireLight,
    /// More wavelengths than the quality asks for.
    Wavelengths,
}

impl Effect {
    /// Every effect, in the order in which they are told.
    pub const ALL: [Self; 11] = [
        Self::Soot,
        Self::Smoke,
        Self::Lines,
        Self::Bands,
        Self::Chemiluminescence,
        Self::Scattering,
        Self::ScatteringOrders,
        Self::Refraction,
        Self::Dispersion,
        Self::FireLight,
        Self::Wavelengths,
    ];

    /// Its name in statistics and, where a person can switch it, in the scene file's `[effects]`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Soot => "emission-absorption",
            Self::Smoke => "smoke",
            Self::Lines => "lines",
            Self::Bands => "bands",
            Self::Chemiluminescence => "chemiluminescence",
            Self::Scattering => "scattering",
            Self::ScatteringOrders => "scattering_orders",
            Self::Refraction => "refraction",
            Self::Dispersion => "dispersion",
            Self::FireLight => "fire_light",
            Self::Wavelengths => "wavelengths",
        }
    }

    /// The one that light of the gas belongs to.
    pub(super) fn of_glow(kind: Kind) -> Self {
        match kind {
            Kind::Line => Self::Lines,
            Kind::Band => Self::Bands,
            Kind::Radical => Self::Chemiluminescence,
        }
    }

    /// What a person asked for. Wavelengths are asked for by their number, soot by its amount.
    pub fn switch(self, effects: &Effects) -> Switch {
        match self {
            Self::Lines => effects.lines,
            Self::Bands => effects.bands,
            Self::Chemiluminescence => effects.chemiluminescence,
            Self::Scattering => effects.scattering,
            Self::Refraction => effects.refraction,
            Self::Dispersion => effects.dispersion,
            Self::FireLight => effects.fire_light,
            Self::Smoke => effects.smoke,
            Self::Wavelengths => effects.wavelengths,
            Self::ScatteringOrders => effects.scattering_orders,
            Self::Soot => Switch::Auto,
        }
    }
}

/// Whether an effect is computed, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// Which.
    pub effect: Effect,
    /// What a person asked for.
    pub switch: Switch,
    /// Whether it is computed.
    pub on: bool,
    /// What leaving it out changes in the picture at most, ΔE_ITP; `None` where that is not known.
    pub bound: Option<f64>,
    /// Why, for a person.
    pub reason: String,
}

impl Decision {
    /// Whether it is computed, in words.
    pub fn state(&self) -> &'static str {
        if self.on { "computed" } else { "left out" }
    }

    /// What leaving it out changes in words: "at most 12 ΔE", "under 0.01 ΔE"; `None` where that is not known, or nothing.
    pub fn change(&self) -> Option<String> {
        let bound = self.bound.filter(|bound| self.on || *bound > 0.0)?;
        Some(if bound < LEAST_TOLD {
            format!("under {LEAST_TOLD} ΔE")
        } else {
            format!("at most {} ΔE", figures(bound))
        })
    }
}

/// The least change that is told as a number, ΔE_ITP.
const LEAST_TOLD: f64 = 0.01;

/// A number with two digits that count.
pub(super) fn figures(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (1 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.digits$}")
}

impl Effects {
    /// The same, with what was automatic as it was decided: for the next frames of a sequence, in which nothing may come and
    /// go, and for whoever looks closer at a picture. Which smoke is packed is decided before a scene is made: a sequence
    /// sets these in its project, before it asks for a job.
    #[must_use]
    pub fn as_decided(self, decisions: &[Decision]) -> Self {
        let locked = |effect: Effect| {
            let decided = decisions.iter().find(|it| it.effect == effect);
            match (effect.switch(&self), decided) {
                (Switch::Auto, Some(decision)) if decision.on => Switch::On,
                (Switch::Auto, Some(_)) => Switch::Off,
                (switch, _) => switch,
            }
        };
        Self {
            lines: locked(Effect::Lines),
            bands: locked(Effect::Bands),
            chemiluminescence: locked(Effect::Chemiluminescence),
            scattering: locked(Effect::Scattering),
            scattering_orders: locked(Effect::ScatteringOrders),
            refraction: locked(Effect::Refraction),
            dispersion: locked(Effect::Dispersion),
            fire_light: locked(Effect::FireLight),
            smoke: locked(Effect::Smoke),
            wavelengths: locked(Effect::Wavelengths),
        }
    }

    /// The same, with what was automatic computed where it is on in a picture that was shown: another frame may call for more,
    /// but what was there does not go.
    #[must_use]
    pub fn computing(mut self, shown: Self) -> Self {
        for effect in Effect::ALL {
            if let Some(switch) = self.switch_mut(effect)
                && *switch == Switch::Auto
                && effect.switch(&shown) == Switch::On
            {
                *switch = Switch::On;
            }
        }
        self
    }

    /// The switch of an effect; `None` where it has none.
    pub fn switch_mut(&mut self, effect: Effect) -> Option<&mut Switch> {
        match effect {
            Effect::Soot => None,
            Effect::Lines => Some(&mut self.lines),
            Effect::Bands => Some(&mut self.bands),
            Effect::Chemiluminescence => Some(&mut self.chemiluminescence),
            Effect::Scattering => Some(&mut self.scattering),
            Effect::ScatteringOrders => Some(&mut self.scattering_orders),
            Effect::Refraction => Some(&mut self.refraction),
            Effect::Dispersion => Some(&mut self.dispersion),
            Effect::FireLight => Some(&mut self.fire_light),
            Effect::Smoke => Some(&mut self.smoke),
            Effect::Wavelengths => Some(&mut self.wavelengths),
        }
    }
}

/// Whether an effect is computed.
pub(in crate::render) fn is_on(decisions: &[Decision], effect: Effect) -> bool {
    decisions.iter().any(|it| it.effect == effect && it.on)
}
