//! Which effects a scene calls for: bounds of what each could change, and what a person asked for.

use std::cell::OnceCell;
use std::fmt::Write as _;

use super::bounds;
use super::effect::{Decision, Effect, figures};
use super::sketch::Sketch;
use crate::physics::constants::METRES_PER_NM;
use crate::render::{Settings, Switch};
use crate::scene::Scene;
use crate::scene::glow::{Feature, Kind};
use crate::scene::refractivity::{COMMON_PATH_NM, PATHS_NM};

/// Change of the picture below which an effect is left out, ΔE_ITP: a tenth of what is just seen.
pub const OFF_BELOW: f64 = 0.1;
/// Change above which it is computed. Between the two it stays as it was, so that a hand that trembles at the border
/// switches nothing; in a picture that none came before it is computed.
pub const ON_ABOVE: f64 = 0.3;
/// Wavelength at which scattering is told, nm: where the eye is most sensitive.
const TOLD_NM: f64 = 555.0;

/// Why an effect is computed that a person switched on.
const ASKED_FOR: &str = "it was asked for";

/// What is decided about a scene, one effect after the other.
pub(super) struct Decider<'a> {
    pub(super) scene: &'a Scene,
    pub(super) features: &'a [Feature],
    pub(super) settings: &'a Settings,
    /// What was decided for the picture before this one; empty if there is none.
    pub(super) before: &'a [Decision],
    pub(super) sketch: OnceCell<Sketch<'a>>,
}

impl Decider<'_> {
    /// All decisions but that on the wavelengths.
    pub(super) fn decide(&self) -> Vec<Decision> {
        let scattering = self.scattering();
        let orders = self.orders(scattering.on);
        let refraction = self.refraction();
        let dispersion = self.dispersion(refraction.on);
        vec![
            self.soot(),
            self.smoke(),
            self.of_metal(
                Kind::Line,
                "the gas holds a metal's atoms, which glow by its heat",
            ),
            self.of_metal(
                Kind::Band,
                "the gas holds a metal's molecules, which glow by its heat",
            ),
            self.radicals(),
            scattering,
            orders,
            refraction,
            dispersion,
            self.fire_light(),
        ]
    }

    fn sketch(&self) -> &Sketch<'_> {
        self.sketch
            .get_or_init(|| Sketch::new(self.scene, self.settings.size, self.features))
    }

    /// Left out for a reason that nothing can change, or because it was asked for.
    fn without(&self, effect: Effect, reason: impl Into<String>) -> Decision {
        let switch = effect.switch(&self.settings.effects);
        Decision {
            effect,
            switch,
            on: false,
            bound: (switch != Switch::Off).then_some(0.0),
            reason: reason.into(),
        }
    }

    fn switched_off(&self, effect: Effect) -> Option<Decision> {
        let off = effect.switch(&self.settings.effects) == Switch::Off;
        off.then(|| self.without(effect, format!("effects.{} is off", effect.name())))
    }

    /// By its bound and its switch.
    fn by_bound(&self, effect: Effect, bound: f64, reason: &str) -> Decision {
        let switch = effect.switch(&self.settings.effects);
        let on = switch == Switch::On || self.is_called_for(effect, bound);
        let seen = if switch == Switch::On {
            format!("; {ASKED_FOR}")
        } else if on {
            String::new()
        } else {
            ", too little to see".to_owned()
        };
        Decision {
            effect,
            switch,
            on,
            bound: Some(bound),
            reason: format!("{reason}{seen}"),
        }
    }

    pub(super) fn is_called_for(&self, effect: Effect, bound: f64) -> bool {
        let before = self.before.iter().find(|it| it.effect == effect);
        if bound < OFF_BELOW {
            false
        } else if bound > ON_ABOVE {
            true
        } else {
            // More wavelengths are no effect of its own: a picture that none came before has those of its quality.
            before.map_or(effect != Effect::Wavelengths, |it| it.on)
        }
    }

    fn soot(&self) -> Decision {
        let on = self.scene.flame.medium().peak_volume_fraction() > 0.0;
        Decision {
            effect: Effect::Soot,
            switch: Switch::Auto,
            on,
            bound: None,
            reason: if on {
                "soot glows and absorbs"
            } else {
                "there is no soot"
            }
            .to_owned(),
        }
    }

    fn smoke(&self) -> Decision {
        if let Some(off) = self.switched_off(Effect::Smoke) {
            return off;
        }
        let flame = &self.scene.flame;
        match flame.smoke_left_out() {
            Some(bound) => self.by_bound(Effect::Smoke, bound, "there is next to none"),
            None if flame.has_smoke() => Decision {
                effect: Effect::Smoke,
                switch: self.settings.effects.smoke,
                on: true,
                bound: None,
                reason: "it takes light from what is behind".to_owned(),
            },
            None => self.without(Effect::Smoke, "the volume has none, or its amount is 0"),
        }
    }

    /// Lines or bands of a salt's metal.
    fn of_metal(&self, kind: Kind, reason: &str) -> Decision {
        let effect = Effect::of_glow(kind);
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        let glow = self.scene.flame.glow();
        if !glow.has_metal() {
            return self.without(effect, "there is no salt");
        }
        if !glow.has(kind) {
            return self.without(effect, "this salt has none");
        }
        self.by_bound(effect, bounds::of_metal(self.sketch(), kind), reason)
    }

    fn radicals(&self) -> Decision {
        let effect = Effect::Chemiluminescence;
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        if !self.scene.flame.glow().has_radicals() {
            return self.without(
                effect,
                "no field says where gas burns, or nothing that glows is burnt there",
            );
        }
        let bound = bounds::radicals(self.sketch());
        self.by_bound(effect, bound, "burning gas glows blue beside the soot")
    }

    pub(super) fn scattering(&self) -> Decision {
        let effect = Effect::Scattering;
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        let flame = &self.scene.flame;
        let Some(scattering) = flame.scattering() else {
            return self.without(effect, "there is no soot and no smoke");
        };
        let absorption = flame.absorption_per_sample(TOLD_NM);
        let [by_soot, by_smoke] = flame
            .scattering_per_sample(TOLD_NM)
            .map(|scattering| 100.0 * scattering / absorption);
        let radius_nm = scattering.radius_m / METRES_PER_NM;
        let mut words = format!(
            "soot of {radius_nm:.0} nm scatters {} % of what it absorbs",
            figures(by_soot)
        );
        if flame.has_smoke() {
            let _ = write!(words, ", smoke {} %", figures(by_smoke));
        }
        self.by_bound(effect, bounds::scattering(self.sketch()), &words)
    }

    fn orders(&self, scatters: bool) -> Decision {
        let effect = Effect::ScatteringOrders;
        let orders = self.settings.scattering_orders;
        if scatters && orders > 1 {
            return Decision {
                effect,
                switch: Switch::On,
                on: true,
                bound: None,
                reason: format!("{orders} orders by path tracing were asked for"),
            };
        }
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        if !scatters {
            return self.without(effect, "nothing is scattered");
        }
        let bound = bounds::orders(self.sketch());
        self.by_bound(effect, bound, "light that was scattered is scattered again")
    }

    fn refraction(&self) -> Decision {
        let effect = Effect::Refraction;
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        let Some(bend) = bounds::bend(self.scene, self.sketch(), COMMON_PATH_NM) else {
            return self.without(
                effect,
                "no field says how hot the gas is, or it bends nothing",
            );
        };
        let words = format!(
            "hot gas bends rays by up to {} mrad: the fire's far side moves by up to {} of a voxel",
            figures(1e3 * bend.angle_rad),
            figures(bend.voxels)
        );
        let bound = bounds::refraction(self.scene, bend, self.settings.size);
        self.by_bound(effect, bound, &words)
    }

    fn dispersion(&self, bends: bool) -> Decision {
        let effect = Effect::Dispersion;
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        if !bends {
            return self.without(effect, "no light is bent");
        }
        if self.scene.stage.backdrop.is_none() {
            return self.without(effect, "only a backdrop shows it");
        }
        let [red, _, blue] =
            PATHS_NM.map(|nm| bounds::bend(self.scene, self.sketch(), nm).map(|it| it.angle_rad));
        let apart_rad = (blue.unwrap_or(0.0) - red.unwrap_or(0.0)).abs();
        let words = format!(
            "blue is bent by up to {} mrad more than red",
            figures(1e3 * apart_rad)
        );
        let bound = bounds::dispersion(self.scene, apart_rad, self.settings.size);
        self.by_bound(effect, bound, &words)
    }

    fn fire_light(&self) -> Decision {
        let effect = Effect::FireLight;
        if let Some(off) = self.switched_off(effect) {
            return off;
        }
        let stage = &self.scene.stage;
        if !stage.has_surfaces() {
            return self.without(effect, "there is nothing that it could fall on");
        }
        if !self.sketch().sees_surfaces() && stage.spheres.is_empty() && stage.logs.is_empty() {
            return self.without(effect, "no ground is in the picture");
        }
        let bound = bounds::fire_light(self.sketch());
        // A log or a sphere may be narrower than what lies between the rays of a sketch.
        let small = !(stage.spheres.is_empty() && stage.logs.is_empty());
        let decision = self.by_bound(effect, bound, "it falls on what stands around");
        if small && decision.switch == Switch::Auto && bound > 0.0 {
            return Decision {
                on: true,
                reason: "it falls on what stands around".to_owned(),
                ..decision
            };
        }
        decision
    }
}
