//! A picture of means: what the bricks along a ray give on the average, for bounds and not for eyes.
//!
//! A ray of a coarse raster goes through the stored bricks front to back; each counts as even matter that holds the mean of
//! its samples and sends out the mean of their light, so that no light of the file is missed between rays or samples.
//! The same raster with another effect's matter gives the change that the effect makes, brick by brick. What an effect adds
//! is put in from above: light from all sides as if nothing dimmed it, and [`UNEVEN`] times as much of it.

use std::sync::LazyLock;

use glam::DVec3;
use rayon::prelude::*;

use crate::colour::itp;
use crate::math::Ray;
use crate::physics::soot::SootLaw;
use crate::render::difference::{self, LIT};
use crate::render::walk::{Stretch, for_each_stored};
use crate::scene::glow::{Feature, Source};
use crate::scene::means::{MEANS, MEANS_NM, Means, PART_EDGE, PARTS, PartMean, Spectrum};
use crate::scene::medium::BRICK;
use crate::scene::{Flame, Scene, WavelengthSet};

/// Rays along the longer side of the raster.
const RAYS: u32 = 40;
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

/// What a sketched ray ends at.
#[derive(Debug, Clone, Copy)]
enum Behind {
    Dark,
    Screen([f64; 3]),
    /// A surface: place, normal, mean albedo.
    Surface(DVec3, DVec3, f64),
}

/// The parts of bricks that a ray passes, front to back, with metres in each, and what is behind.
struct Pass {
    parts: Vec<(u32, f64)>,
    behind: Behind,
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
        }
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
    pub(super) fn with_radicals(&self, brick: &PartMean) -> Matter {
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
    pub(super) fn scattered_away(&self, brick: &PartMean) -> Matter {
        let mut matter = self.with_radicals(brick);
        let scattering = self.coefficient(brick);
        matter.extinction = std::array::from_fn(|i| matter.extinction[i] + scattering[i]);
        matter
    }

    /// What it sends towards the eye at most, once.
    pub(super) fn scattered_here(&self, brick: &PartMean) -> Matter {
        let mut matter = self.with_radicals(brick);
        let (scattering, around) = (self.coefficient(brick), self.around(brick));
        matter.source = std::array::from_fn(|i| matter.source[i] + scattering[i] * around[i]);
        matter
    }

    /// The same with all orders: a geometric series of what bricks send each other.
    pub(super) fn scattered_often(&self, brick: &PartMean) -> Matter {
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
    pub(super) fn cooler(&self, part: &PartMean, matter: Matter) -> Matter {
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
                let taken = -(-depth).exp_m1();
                let phi = if depth > 0.0 { taken / depth } else { 1.0 };
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

fn passes(scene: &Scene, size: [u32; 2]) -> Vec<Pass> {
    let Ok(view) = scene.camera.view(size) else {
        return Vec::new();
    };
    let medium = scene.flame.medium();
    let backdrop = scene.stage.backdrop.as_ref();
    let screen = backdrop.and_then(|it| it.facing(&scene.camera, size).ok());
    let longer = f64::from(size[0].max(size[1]));
    let counts = size.map(|side| {
        ((f64::from(side) / longer * f64::from(RAYS)).ceil() as u32)
            .min(side)
            .max(1)
    });
    let pass = |i: u32| {
        let cell = [i % counts[0], i / counts[0]];
        let [x, y] = [0, 1].map(|axis| {
            // From border to border: what is just in the picture is seen.
            let along = f64::from(cell[axis]) / f64::from((counts[axis] - 1).max(1));
            along * f64::from(size[axis])
        });
        let ray: Ray = view.ray(x, y);
        let hit = scene.stage.hit(&ray, f64::INFINITY);
        let limit = hit.map_or(f64::INFINITY, |hit| hit.distance_m);
        let mut parts = Vec::new();
        if let Some((local, [enter, exit])) = medium.enter(&ray)
            && enter < limit
        {
            for_each_stored(medium, &local, [enter, exit.min(limit)], |stretch| {
                in_parts(&local, stretch, &mut parts);
            });
        }
        let behind = match (hit, &screen) {
            (Some(hit), _) => {
                let albedo = hit.colour.into_iter().fold(0.0, f64::max);
                Behind::Surface(hit.point, hit.normal, albedo)
            }
            (None, Some(screen)) => Behind::Screen(screen.xyz(&ray)),
            (None, None) => Behind::Dark,
        };
        Pass { parts, behind }
    };
    (0..counts[0] * counts[1])
        .into_par_iter()
        .map(pass)
        .collect()
}

/// Cuts a ray's stretch in a brick where it goes from one part of it to another.
fn in_parts(local: &Ray, stretch: Stretch, parts: &mut Vec<(u32, f64)>) {
    let Stretch { slot, from, to } = stretch;
    let middle = local.at(0.5 * (from + to));
    let brick = (middle / BRICK as f64).floor() * BRICK as f64;
    let mut cuts = [to; 4];
    for axis in 0..3 {
        let t = (brick[axis] + PART_EDGE as f64 - local.origin[axis]) / local.direction[axis];
        if t > from && t < to {
            cuts[axis] = t;
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut begin = from;
    for cut in cuts {
        if cut > begin {
            let within = local.at(0.5 * (begin + cut)) - brick;
            let half = within.cmpge(DVec3::splat(PART_EDGE as f64)).bitmask();
            parts.push((slot * PARTS as u32 + half, cut - begin));
            begin = cut;
        }
    }
}
