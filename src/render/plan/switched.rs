//! A plan beside a plan: the same picture with one effect switched the other way or at other wavelengths, to measure what
//! that changes and takes.

use super::effect::{Effect, is_on};
use super::{Plan, flaws, wavelengths};
use crate::render::baked;
use crate::render::fields::Fields;
use crate::render::preparation::Watch;
use crate::render::{Cancel, Level, Settings};
use crate::scene::Scene;
use crate::scene::glow::Kind;

impl Plan {
    /// The same effects at the wavelengths and steps of other settings, whatever their number of wavelengths is worth. What
    /// bends light is taken over.
    #[must_use]
    pub fn at(&self, scene: &Scene, settings: &Settings) -> Self {
        self.beside(scene, settings, |_| true)
    }

    /// The same without light that comes from all sides: nothing is scattered, and nothing falls on the stage. It needs no
    /// fields but of what bends light.
    #[must_use]
    pub fn direct(&self, scene: &Scene, settings: &Settings) -> Self {
        self.beside(scene, settings, |effect| {
            !matches!(
                effect,
                Effect::Scattering | Effect::ScatteringOrders | Effect::FireLight
            )
        })
    }

    /// The same with coefficients that are summed over X, Y and Z before the march, as renderers of three colours do: to be
    /// compared with.
    #[must_use]
    pub fn baked(&self, scene: &Scene, settings: &Settings) -> Self {
        let features = scene.flame.glow().features();
        let three = baked::wavelengths(scene);
        let mut plan = Self::deciding(scene, settings, three, features, self.decisions.clone());
        baked::bake(&mut plan.tables, scene);
        plan.bend_as(self);
        flaws::add(&mut plan, scene, settings);
        plan
    }

    /// Takes over what bends light, if it is wanted in the same way.
    fn bend_as(&mut self, other: &Self) {
        if self.wanted.bent == other.wanted.bent && self.bent.get().is_none() {
            self.bent.clone_from(&other.bent);
        }
    }

    fn beside(&self, scene: &Scene, settings: &Settings, keeps: impl Fn(Effect) -> bool) -> Self {
        let mut decisions = self.decisions.clone();
        for decision in &mut decisions {
            decision.on &= keeps(decision.effect);
        }
        let scattering = decisions.iter().find(|it| it.effect == Effect::Scattering);
        let scattered = scattering.map_or(0.0, wavelengths::scattered_share);
        let nodes = wavelengths::of(scene, settings.wavelengths, scattered);
        let features = scene.flame.glow().features();
        let mut plan = Self::deciding(scene, settings, nodes, features, decisions);
        plan.bend_as(self);
        flaws::add(&mut plan, scene, settings);
        plan
    }

    /// The plan with one effect switched the other way, and what cannot be without it left out as well. `None` where that
    /// makes no picture of this scene: the effect has nothing to act on, or the scene was packed with it or without.
    pub fn switched(&self, scene: &Scene, settings: &Settings, effect: Effect) -> Option<Self> {
        let was_on = is_on(&self.decisions, effect);
        let here = self.decisions.iter().find(|it| it.effect == effect)?;
        let changes_nothing = !was_on && here.bound == Some(0.0);
        if changes_nothing || !self.acts_on_something(scene, effect) {
            return None;
        }
        let mut decisions = self.decisions.clone();
        for decision in &mut decisions {
            let needs_it = matches!(
                (effect, decision.effect),
                (Effect::Scattering, Effect::ScatteringOrders)
                    | (Effect::Refraction, Effect::Dispersion)
            );
            if decision.effect == effect {
                decision.on = !was_on;
            } else if needs_it && was_on {
                decision.on = false;
            }
        }
        let nodes = if effect == Effect::Wavelengths {
            let scattering = decisions.iter().find(|it| it.effect == Effect::Scattering);
            let scattered = scattering.map_or(0.0, wavelengths::scattered_share);
            wavelengths::of(scene, settings.wavelengths, scattered)
        } else {
            self.tables.wavelengths.clone()
        };
        let features = scene.flame.glow().features();
        let mut plan = Self::deciding(scene, settings, nodes, features, decisions);
        plan.bend_as(self);
        Some(plan)
    }

    /// Whether this scene, as it is packed, can show the effect.
    fn acts_on_something(&self, scene: &Scene, effect: Effect) -> bool {
        let (flame, stage) = (&scene.flame, &scene.stage);
        match effect {
            // Soot and smoke are packed or not.
            Effect::Soot | Effect::Smoke => false,
            Effect::Lines => flame.glow().has(Kind::Line),
            Effect::Bands => flame.glow().has(Kind::Band),
            Effect::Chemiluminescence => flame.glow().has(Kind::Radical),
            Effect::Scattering => flame.scattering().is_some(),
            Effect::ScatteringOrders => self.wanted.scatter,
            Effect::Refraction => flame.bending().is_some(),
            Effect::Dispersion => self.wanted.bent.is_some() && stage.backdrop.is_some(),
            Effect::FireLight => stage.has_surfaces(),
            // What more of them would be is only known where more are taken.
            Effect::Wavelengths => is_on(&self.decisions, effect),
        }
    }

    /// Takes from another plan of the same scene what it has worked out and this one needs.
    pub fn take_over(&mut self, other: &Self) {
        self.bend_as(other);
        let same = self.wanted == other.wanted
            && self.tables.wavelengths.nodes_nm == other.tables.wavelengths.nodes_nm
            && self.tables.features == other.tables.features
            && self.orders == other.orders;
        if !same {
            return;
        }
        for (mine, theirs) in self.fields.iter_mut().zip(&other.fields) {
            if mine.get().is_none() {
                mine.clone_from(theirs);
            }
        }
    }

    fn is_as_large_as(&self, other: &Self) -> bool {
        let sizes = |plan: &Self| [plan.tables.nodes.len(), plan.tables.features.len()];
        sizes(self) == sizes(other)
    }

    /// Whether another plan's fields hold all that this one wants.
    pub(in crate::render) fn takes_fields_over(&self, other: &Self) -> bool {
        let (mine, theirs) = (self.wanted, other.wanted);
        let has_none = !mine.scatter && !mine.fire_light;
        let has_its = (!mine.scatter || (theirs.scatter && mine.again == theirs.again))
            && (!mine.fire_light || theirs.fire_light);
        has_none || (has_its && self.is_as_large_as(other))
    }

    /// This plan's fine fields, where those of another that are of the same kind and size stand in for its own: a march
    /// through them takes the same time. `None` if cancelled.
    pub(in crate::render) fn fields_beside(
        &self,
        scene: &Scene,
        other: &Self,
        theirs: &Fields,
        cancel: &Cancel,
    ) -> Option<Fields> {
        let alike = self.is_as_large_as(other);
        let mut known = if self.wanted.bent == other.wanted.bent {
            let mut known = Fields::default();
            known.bent.clone_from(&theirs.bent);
            known.seconds.bent = theirs.seconds.bent;
            known
        } else {
            self.bent(scene)
        };
        if alike && self.wanted.scatter && self.wanted.again == other.wanted.again {
            known.scatter.clone_from(&theirs.scatter);
            known.seconds.scatter = theirs.seconds.scatter;
        }
        if alike && self.wanted.fire_light {
            known.fire_light.clone_from(&theirs.fire_light);
            known.seconds.fire_light = theirs.seconds.fire_light;
        }
        let (tables, wanted) = (&self.tables, self.wanted);
        let work =
            |watch: &Watch<'_>| Fields::new(scene, tables, wanted, known, Level::Fine, watch);
        self.preparation().during(cancel, work)
    }
}
