//! A picture of means: what the bricks along a ray give on the average, for bounds and not for eyes.
//!
//! A ray of a coarse raster goes through the stored bricks front to back; each counts as even matter that holds the mean of
//! its samples and sends out the mean of their light, so that no light of the file is missed between rays or samples.
//! The same raster with another effect's matter gives the change that the effect makes, brick by brick. What an effect adds
//! is put in from above: light from all sides as if nothing dimmed it, and [`UNEVEN`] times as much of it.

use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use glam::DVec3;
use rayon::prelude::*;

use crate::colour::itp;
use crate::math::lanes;
use crate::physics::soot::SootLaw;
use crate::render::difference::{self, LIT};
use crate::scene::glow::{Feature, Source};
use crate::scene::means::{MEANS, MEANS_NM, Means, PART_EDGE, PartMean, Spectrum};
use crate::scene::{Flame, Scene, WavelengthSet};

mod passes;

use passes::{Behind, Pass, passes};

/// How much brighter than a brick's mean a place of it may be lit: light is uneven within a brick, and a block of bricks is
/// lit by its own light more than by others'. Of the fires that were tried the worst asks for 2.9.
const UNEVEN: f64 = 4.0;
/// How much more than its mean a place of a part may burn: a sheet one voxel thick that holds all of it, seen along it.
const SHEET: f64 = 6.0 * PART_EDGE as f64;

/// X, Y, Z of a spectrum at the means' wavelengths. How soot's colour differs from fuel to fuel makes no bound.
static WEIGHTS: LazyLock<[[f64; 3]; MEANS]> = LazyLock::new(|| {
    let set = WavelengthSet::Fitted(MEANS as u32).wavelengths(SootLaw::default());
    std::array::from_fn(|i| set.xyz[i])
});

/// What a brick does to light that goes through it: source for each metre, and extinction, 1/m.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Matter {
    pub(super) source: Spectrum,
    pub(super) extinction: Spectrum,
    /// X, Y, Z that gas adds for each metre, W m⁻³ sr⁻¹.
    pub(super) gas: [f64; 3],
}

/// Rays through one scene.
pub(super) struct Sketch<'a> {
    pub(super) flame: &'a Flame,
    pub(super) means: &'a Means,
    passes: Vec<Pass>,
    /// X, Y, Z of the spectrum at the means' wavelengths.
    weights: [[f64; 3]; MEANS],
    absorption: Spectrum,
    scattering: [Spectrum; 2],
    radicals: Vec<Feature>,
    /// Pictures that were asked for, with surfaces lit or dark.
    pictures: Mutex<Vec<(Shows, Picture)>>,
}

/// X, Y, Z of each ray.
type Picture = Arc<Vec<[f64; 3]>>;

/// What a picture shows: matter, whether its soot is as cool as in its cooler places, whether surfaces are lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shows {
    what: Of,
    cooler: bool,
    lit: bool,
}

/// Matter that pictures show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// Soot and smoke alone.
    Plain,
    /// With radicals.
    Radicals,
    /// And what scattering takes away.
    ScatteredAway,
    /// Or brings, once.
    ScatteredHere,
    /// Or brings as often as it likes.
    ScatteredOften,
}

impl<'a> Sketch<'a> {
    /// Sends the rays of a picture's raster. `radicals` is what glows in burning gas, where it is computed at all.
    pub(super) fn new(scene: &'a Scene, size: [u32; 2], features: &[Feature]) -> Self {
        let flame = &scene.flame;
        let scattering = MEANS_NM.map(|nm| flame.scattering_per_sample(nm));
        Self {
            flame,
            means: flame.medium().means(),
            passes: passes(scene, size),
            weights: *WEIGHTS,
            absorption: MEANS_NM.map(|nm| flame.absorption_per_sample(nm)),
            scattering: [0, 1].map(|kind| scattering.map(|at| at[kind])),
            radicals: features
                .iter()
                .filter(|it| it.is_radical())
                .cloned()
                .collect(),
            pictures: Mutex::default(),
        }
    }

    /// A picture of the bricks as they are.
    pub(super) fn of(&self, what: Of, lit: bool) -> Picture {
        let cooler = false;
        self.made(Shows { what, cooler, lit })
    }

    /// A picture of the bricks whose soot is as cool as in their cooler places.
    pub(super) fn of_cooler(&self, what: Of, lit: bool) -> Picture {
        let cooler = true;
        self.made(Shows { what, cooler, lit })
    }

    /// Made when it is asked for first: several bounds look at the same.
    fn made(&self, shows: Shows) -> Picture {
        let mut shows = shows;
        if shows.what == Of::Radicals && self.radicals.is_empty() {
            shows.what = Of::Plain;
        }
        shows.lit &= self.sees_surfaces();
        let mut pictures = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, picture)) = pictures.iter().find(|(known, _)| *known == shows) {
            return Arc::clone(picture);
        }
        let matter = |part: &PartMean| {
            let matter = match shows.what {
                Of::Plain => self.plain(part),
                Of::Radicals => self.with_radicals(part),
                Of::ScatteredAway => self.scattered_away(part),
                Of::ScatteredHere => self.scattered_here(part),
                Of::ScatteredOften => self.scattered_often(part),
            };
            if shows.cooler {
                self.cooler(part, matter)
            } else {
                matter
            }
        };
        let picture = Arc::new(self.picture(matter, shows.lit));
        pictures.push((shows, Arc::clone(&picture)));
        picture
    }

    /// Soot and smoke that glow and absorb.
    pub(super) fn plain(&self, brick: &PartMean) -> Matter {
        Matter {
            source: std::array::from_fn(|i| self.absorption[i] * brick.glow[i]),
            extinction: self.absorption.map(|absorption| absorption * brick.soot),
            gas: [0.0; 3],
        }
    }

    /// What radicals add to a brick.
    fn with_radicals(&self, brick: &PartMean) -> Matter {
        let mut matter = self.plain(brick);
        for feature in &self.radicals {
            if let Source::Radical(emission) = feature.source {
                let light = SHEET * emission * brick.burning;
                matter.gas = std::array::from_fn(|c| matter.gas[c] + light * feature.colour[c]);
            }
        }
        matter
    }

    /// What scattering takes from light.
    fn scattered_away(&self, brick: &PartMean) -> Matter {
        let mut matter = self.with_radicals(brick);
        let scattering = self.coefficient(brick);
        matter.extinction = std::array::from_fn(|i| matter.extinction[i] + scattering[i]);
        matter
    }

    /// What it sends towards the eye at most, once.
    fn scattered_here(&self, brick: &PartMean) -> Matter {
        let mut matter = self.with_radicals(brick);
        let (scattering, around) = (self.coefficient(brick), self.around(brick));
        matter.source = std::array::from_fn(|i| matter.source[i] + scattering[i] * around[i]);
        matter
    }

    /// The same with all orders: a geometric series of what bricks send each other.
    fn scattered_often(&self, brick: &PartMean) -> Matter {
        let mut matter = self.scattered_here(brick);
        let (scattering, around) = (self.coefficient(brick), self.around(brick));
        for i in 0..MEANS {
            let [soot, smoke] = [0, 1].map(|kind| {
                let light = brick.scattered_around[kind][i] * self.absorption[i];
                self.scattering[kind][i] * light
            });
            let second = UNEVEN * (soot + smoke);
            let ratio = second / around[i];
            // Energy is not made: what is sent often is at most a tenfold of what is sent once.
            let all = second / (1.0 - ratio.min(MOST_AGAIN));
            if all.is_finite() {
                matter.source[i] += scattering[i] * all;
            }
        }
        matter
    }

    /// The same matter where its own soot is as cool as in its cooler places.
    fn cooler(&self, part: &PartMean, matter: Matter) -> Matter {
        let less = |i: usize| self.absorption[i] * (part.glow[i] - part.dim[i]).max(0.0);
        Matter {
            source: std::array::from_fn(|i| matter.source[i] - less(i)),
            ..matter
        }
    }

    /// Scattering coefficient of a brick, 1/m.
    fn coefficient(&self, brick: &PartMean) -> Spectrum {
        let soot = (brick.soot - brick.smoke).max(0.0);
        std::array::from_fn(|i| self.scattering[0][i] * soot + self.scattering[1][i] * brick.smoke)
    }

    /// Mean over all directions of the light that arrives in a brick, from above.
    fn around(&self, brick: &PartMean) -> Spectrum {
        let mut around = std::array::from_fn(|i| self.absorption[i] * brick.glow_around[i]);
        for feature in &self.radicals {
            if let Source::Radical(emission) = feature.source {
                // Put where the observer sees it, at the wavelength next to its own.
                let near = nearest(feature.lambda_nm);
                let c = if near == 0 { 2 } else { 1 };
                let light = emission * feature.colour[c] / self.weights[near][c];
                around[near] += light * brick.burning_around;
            }
        }
        around.map(|light: f64| UNEVEN * light)
    }

    /// The picture with this matter, X, Y, Z for each ray, and with surfaces lit or dark.
    pub(super) fn picture(
        &self,
        matter: impl Fn(&PartMean) -> Matter + Sync,
        lit: bool,
    ) -> Vec<[f64; 3]> {
        let of_bricks: Vec<Matter> = self.means.parts.iter().map(matter).collect();
        self.passes
            .par_iter()
            .map(|pass| self.seen(pass, &of_bricks, lit))
            .collect()
    }

    fn seen(&self, pass: &Pass, of_bricks: &[Matter], lit: bool) -> [f64; 3] {
        let (mut light, mut through, mut gas) = ([0.0; MEANS], [1.0; MEANS], [0.0; 3]);
        for &(slot, metres) in &pass.parts {
            let matter = &of_bricks[slot as usize];
            for c in 0..3 {
                gas[c] += matter.gas[c] * metres * through[at_colour(c)];
            }
            for i in 0..MEANS {
                let depth = matter.extinction[i] * metres;
                // In single precision, which bounds do not feel.
                let taken = f64::from(-lanes::exp_m1(-depth as f32));
                let phi = if depth > CLEAR { taken / depth } else { 1.0 };
                light[i] += through[i] * matter.source[i] * metres * phi;
                through[i] -= through[i] * taken;
            }
        }
        let mut behind = [0.0; 3];
        match pass.behind {
            Behind::Dark => {}
            Behind::Screen(xyz) => {
                behind = std::array::from_fn(|c| xyz[c] * through[at_colour(c)]);
            }
            Behind::Surface(place, normal, albedo) => {
                if lit {
                    let falls = self.irradiance(place, normal);
                    for i in 0..MEANS {
                        light[i] += through[i] * albedo / std::f64::consts::PI * falls[i];
                    }
                }
            }
        }
        std::array::from_fn(|c| {
            let soot: f64 = (0..MEANS).map(|i| light[i] * self.weights[i][c]).sum();
            soot.max(0.0) + gas[c] + behind[c]
        })
    }

    /// What falls on a surface if nothing stands in the way, W m⁻² nm⁻¹.
    fn irradiance(&self, place: DVec3, normal: DVec3) -> Spectrum {
        let mut falls = [0.0; MEANS];
        for lamp in &self.means.lamps {
            let to = lamp.middle - place;
            let apart = to.length().max(lamp.radius_m);
            // A lamp that is as near as it is wide is on all sides.
            let cosine = (to.dot(normal) / apart)
                .max(lamp.radius_m / apart)
                .clamp(0.0, 1.0);
            let geometry = NEARER * cosine / (apart * apart);
            for (i, falls) in falls.iter_mut().enumerate() {
                *falls += geometry * self.absorption[i] * lamp.glow[i];
            }
            for feature in &self.radicals {
                if let Source::Radical(emission) = feature.source {
                    let near = nearest(feature.lambda_nm);
                    let c = if near == 0 { 2 } else { 1 };
                    let light = emission * feature.colour[c] / self.weights[near][c];
                    falls[near] += geometry * light * lamp.burning;
                }
            }
        }
        falls
    }

    /// Whether any ray meets a surface.
    pub(super) fn sees_surfaces(&self) -> bool {
        let is_surface = |pass: &Pass| matches!(pass.behind, Behind::Surface(..));
        self.passes.iter().any(is_surface)
    }

    /// The greatest sum along a ray of what a brick has for each metre.
    pub(super) fn most_along(&self, of: impl Fn(&PartMean) -> f64) -> f64 {
        let along = |pass: &Pass| -> f64 {
            let parts = pass.parts.iter();
            parts
                .map(|&(slot, metres)| metres * of(&self.means.parts[slot as usize]))
                .sum()
        };
        self.passes.iter().map(along).fold(0.0, f64::max)
    }

    /// The longest way through bricks, m.
    pub(super) fn longest_m(&self) -> f64 {
        self.most_along(|_| 1.0)
    }
}

/// Optical depth below which nothing is taken from light: single precision has no such numbers.
const CLEAR: f64 = 1e-30;
/// By how much more light may fall on a place than from the middles of lamps: part of each is nearer.
const NEARER: f64 = 2.0;
/// Most of what is scattered that is scattered again.
const MOST_AGAIN: f64 = 0.9;

/// The greatest difference between two pictures of means, ΔE_ITP: over rays that are lit in one of them, at the exposure of
/// either.
pub(super) fn greatest(one: &[[f64; 3]], other: &[[f64; 3]]) -> f64 {
    let there = difference::difference(one, other).largest;
    let back = difference::difference(other, one).largest;
    there.max(back)
}

/// The same at the exposure of a third, of which both are darker places.
pub(super) fn greatest_seen(exposed: &[[f64; 3]], one: &[[f64; 3]], other: &[[f64; 3]]) -> f64 {
    difference::difference_seen(exposed, one, other).largest
}

/// Changing a colour of the brightness of a picture's bright parts by this share of it, ΔE_ITP.
pub(super) fn of_share(share: f64) -> f64 {
    let white = [0.95, 1.0, 1.09].map(|v| difference::WHITE_CD_M2 * v);
    itp::delta_e(white, white.map(|v| v * (1.0 + share)))
}

/// Adding this share of the peak to what is just lit, ΔE_ITP.
pub(super) fn in_the_dark(share: f64) -> f64 {
    let dark = [0.95, 1.0, 1.09].map(|v| difference::WHITE_CD_M2 * LIT * v);
    itp::delta_e(dark, dark.map(|v| v * (1.0 + share / LIT)))
}

/// The wavelength that says how much of X, Y or Z comes through.
fn at_colour(c: usize) -> usize {
    [2, 1, 0][c]
}

fn nearest(nm: f64) -> usize {
    let apart = |i: &usize| (MEANS_NM[*i] - nm).abs();
    (0..MEANS)
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .unwrap_or(0)
}
