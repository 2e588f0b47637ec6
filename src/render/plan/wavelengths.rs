//! How well a set of wavelengths holds the spectra of a scene.
//!
//! Spectra that a scene may send are integrated over the whole observer, every 5 nm, with the finest set, and with the set:
//! black bodies of the fire's temperatures behind its soot, which takes light by what it absorbs, or by what it scatters as
//! well; what its soot scatters of them, and what a coloured surface sends back. The greatest difference is the bound. A
//! spectrum of several temperatures is a sum of such, and no worse.

use std::sync::LazyLock;

use super::decide::{Decider, ON_ABOVE};
use super::effect::{Decision, Effect, figures};
use crate::colour::reflectance::Reflectance;
use crate::colour::{cie, itp};
use crate::physics::blackbody;
use crate::physics::soot::SootLaw;
use crate::render::Switch;
use crate::render::difference::WHITE_CD_M2;
use crate::render::tables::COOLEST_K;
use crate::scene::{Scene, WavelengthSet};
use crate::spectral::Wavelengths;

/// The observer's range and the spacing of its sums, nm.
const RANGE_NM: [f64; 2] = [360.0, 830.0];
const STEP_NM: f64 = 5.0;
/// The finest set that a person can ask for.
static FINEST: LazyLock<Wavelengths> =
    LazyLock::new(|| WavelengthSet::Plain(64).wavelengths(SootLaw::default()));
/// Temperatures in units of the hottest soot's: what is cooler than that gives a ten-thousandth of its light.
const TEMPERATURES: [f64; 3] = [1.0, 0.85, 0.7];
/// Optical depths at 555 nm.
const DEPTHS: [f64; 3] = [0.0, 1.0, 4.0];
const DEPTH_NM: f64 = 555.0;
/// Share of light that may be scattered without a set being fitted to it.
const LITTLE: f64 = 0.03;
/// By how much more than those that are tried the spectra between them may be off.
const BETWEEN: f64 = 1.25;
/// Most colours of surfaces that a set is fitted to.
const MOST_COLOURS: usize = 4;

/// What tints some of a scene's light: what its soot scatters, and the surfaces that it falls on.
struct Tints {
    scattered: bool,
    /// Linear Rec. 709.
    colours: Vec<[f64; 3]>,
}

impl Tints {
    fn of(scene: &Scene, scattered: f64) -> Self {
        let stage = &scene.stage;
        let ground = stage.ground.iter().map(|it| it.colour);
        let spheres = stage.spheres.iter().map(|it| it.colour);
        let logs = stage.logs.iter().map(|it| it.colour);
        let mut colours: Vec<[f64; 3]> = Vec::new();
        for colour in ground.chain(spheres).chain(logs) {
            if !colours.contains(&colour) && colours.len() < MOST_COLOURS {
                colours.push(colour);
            }
        }
        Self {
            scattered: scattered > LITTLE && scene.flame.scattering_per_sample(DEPTH_NM)[0] > 0.0,
            colours,
        }
    }

    /// Each as a factor at each wavelength.
    fn each<'a>(&self, scene: &'a Scene) -> Vec<Box<dyn Fn(f64) -> f64 + 'a>> {
        let mut all: Vec<Box<dyn Fn(f64) -> f64 + 'a>> = Vec::new();
        if self.scattered {
            let flame = &scene.flame;
            let at_depth = flame.scattering_per_sample(DEPTH_NM)[0];
            all.push(Box::new(move |nm| {
                flame.scattering_per_sample(nm)[0] / at_depth
            }));
        }
        for &colour in &self.colours {
            let reflectance = Reflectance::of(colour);
            all.push(Box::new(move |nm| reflectance.at(nm)));
        }
        all
    }
}

/// Change of a picture by all of its light, ΔE_ITP: a per cent is three quarters of one.
const WHOLE_CHANGE: f64 = 75.0;

/// The share of light that may be scattered where that was decided about scattering: what changes the picture by so much is
/// so much of its light.
pub(super) fn scattered_share(scattering: &Decision) -> f64 {
    match (scattering.on, scattering.bound) {
        (false, _) => 0.0,
        (true, Some(bound)) => bound / WHOLE_CHANGE,
        (true, None) => 1.0,
    }
}

impl Decider<'_> {
    /// The set that is transported, and whether it is more than the settings ask for: where those are automatic the cheapest
    /// that is good enough from there on, else the best.
    pub(super) fn wavelengths(&self, scattering: &Decision) -> (Wavelengths, Decision) {
        let asked = self.settings.wavelengths;
        let switch = self.settings.effects.wavelengths;
        let scattered = scattered_share(scattering);
        let with = |set: WavelengthSet| {
            let nodes = of(self.scene, set, scattered);
            let bound = bound(self.scene, &nodes, scattered);
            (set, nodes, bound)
        };
        let mut best = with(asked);
        let first = best.2;
        let finer = match switch {
            Switch::On => true,
            Switch::Auto => self.is_called_for(Effect::Wavelengths, first),
            Switch::Off => false,
        };
        if finer {
            let finer = WavelengthSet::ALL
                .into_iter()
                .filter(|set| set.count() > asked.count());
            for set in finer {
                let next = with(set);
                if next.2 < best.2 {
                    best = next;
                }
                if best.2 <= ON_ABOVE {
                    break;
                }
            }
        }
        let (set, nodes, bound) = best;
        let on = set != asked;
        let known = !is_beyond(self.scene);
        let kelvin = self.scene.flame.medium().peak_temperature_k();
        let reason = if on {
            format!(
                "{} wavelengths would be off by up to {} ΔE: {} are taken",
                asked.count(),
                figures(first),
                set.count()
            )
        } else {
            format!(
                "{} wavelengths hold the colours of soot at up to {kelvin:.0} K",
                set.count()
            )
        };
        let doubt = if known {
            ""
        } else {
            "; what light a stage gets through soot as dense as this depends on more than them"
        };
        let decision = Decision {
            effect: Effect::Wavelengths,
            switch,
            on,
            bound: known.then_some(if on { first } else { bound }),
            reason: format!("{reason}{doubt}"),
        };
        (nodes, decision)
    }
}

/// Nodes and weights of a set that hold this scene's light, of which a share is scattered.
pub(super) fn of(scene: &Scene, set: WavelengthSet, scattered: f64) -> Wavelengths {
    let tints = Tints::of(scene, scattered).each(scene);
    let tints: Vec<&dyn Fn(f64) -> f64> = tints.iter().map(|tint| &**tint).collect();
    set.tinted_wavelengths(scene.flame.soot(), &tints)
}

/// Whether a stage stands in the light of soot so dense that what leaves it hangs on single voxels' faces, which shares of a
/// wavelength tip over: no bound is known for that.
pub(super) fn is_beyond(scene: &Scene) -> bool {
    let medium = scene.flame.medium();
    let densest = f64::from(medium.peak_volume_fraction()) * medium.voxel_size_m();
    scene.stage.has_surfaces() && densest * scene.flame.absorption_per_sample(DEPTH_NM) > OPAQUE
}

/// Optical depth of a voxel at 555 nm from which on it is opaque: an eighth is let through.
const OPAQUE: f64 = 2.0;

/// The greatest difference that more wavelengths would make, ΔE_ITP. Scattered light counts as the share of all light that it
/// may be.
pub(super) fn bound(scene: &Scene, set: &Wavelengths, scattered: f64) -> f64 {
    let flame = &scene.flame;
    let hottest = f64::from(flame.medium().peak_temperature_k()).max(COOLEST_K);
    let count = ((RANGE_NM[1] - RANGE_NM[0]) / STEP_NM) as u32;
    let fine: Vec<f64> = (0..=count)
        .map(|i| RANGE_NM[0] + STEP_NM * f64::from(i))
        .collect();
    let absorption = |nm: f64| flame.absorption_per_sample(nm);
    let extinction = |nm: f64| absorption(nm) + flame.scattering_per_sample(nm)[0];
    let tints = Tints::of(scene, scattered);
    let factors = tints.each(scene);
    let mut greatest = 0.0_f64;
    for kelvin in TEMPERATURES.map(|share| share * hottest) {
        for depth in DEPTHS {
            for by_extinction in [false, true] {
                if by_extinction && !(tints.scattered && depth > 0.0) {
                    continue;
                }
                let light = |nm: f64| {
                    let of_depth = if by_extinction {
                        extinction(nm) / extinction(DEPTH_NM)
                    } else {
                        absorption(nm) / absorption(DEPTH_NM)
                    };
                    (-depth * of_depth).exp() * blackbody::spectral_radiance(nm, kelvin)
                };
                greatest = greatest.max(error(set, &fine, light));
                for (i, tint) in factors.iter().enumerate() {
                    let share = if tints.scattered && i == 0 {
                        scattered.min(1.0)
                    } else {
                        1.0
                    };
                    let tinted = error(set, &fine, |nm| light(nm) * tint(nm));
                    greatest = greatest.max(share * tinted);
                }
            }
        }
    }
    BETWEEN * greatest
}

/// The difference for one spectrum, as bright as white, ΔE_ITP.
fn error(set: &Wavelengths, fine: &[f64], radiance: impl Fn(f64) -> f64) -> f64 {
    let ours = set.xyz_of(set.nodes_nm.iter().map(|&nm| radiance(nm)));
    let mut exact = [0.0; 3];
    for &nm in fine {
        let light = STEP_NM * radiance(nm);
        for (exact, bar) in exact.iter_mut().zip(cie::colour_matching(nm)) {
            *exact += light * bar;
        }
    }
    if exact[1] <= 0.0 {
        return 0.0;
    }
    let finest = FINEST.xyz_of(FINEST.nodes_nm.iter().map(|&nm| radiance(nm)));
    let shown = |xyz: [f64; 3]| xyz.map(|value| value * WHITE_CD_M2 / exact[1]);
    itp::delta_e(shown(ours), shown(exact)).max(itp::delta_e(shown(ours), shown(finest)))
}
