//! The fire's own light, scattered once towards the eye.
//!
//! ```text
//! J(x) = ∫ L(x, ω′) Φ(ω′·ω) dω′
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | J | what is scattered into the line of sight for each unit of σ_s | W m⁻² sr⁻¹ nm⁻¹ |
//! | L(x, ω′) | the fire's direct light at x that goes along ω′, dimmed by absorption and by scattering | the same |
//! | ω | the direction from x to the eye: known for each place, as the camera is a pinhole | 1 |
//! | Φ | phase function of Henyey and Greenstein, see [`crate::physics::phase`] | sr⁻¹ |
//!
//! # How
//!
//! Directions lie evenly over the sphere on Fibonacci's spiral (R. Swinbank and R. J. Purser, Q. J. R. Meteorol. Soc. 132
//! (2006) 1769), each with the same share of it. One [`Sweep`] for each finds L at the middles of all cells; each cell takes
//! it with its own Φ. The weights Φ Δω are divided by their sum, so that even light is scattered as it is whatever g. The
//! order of all sums is that of the directions: any number of threads gives the same bits.
//!
//! **Limits.** Light that comes from a lobe narrower than the directions' spacing, |g| above about 0.9, is smeared. The
//! light of a salt's lines and bands is not scattered; that of radicals is.
//!
//! # What is left out
//!
//! With p the share of all emitted light that is scattered at least once, from the balance of energy at the most luminous
//! wavelength,
//!
//! ```text
//! p = ∫ σ_s φ dV / (4π ∫ j dV),   φ = ∫ L dω
//! ```
//!
//! light scattered at least twice, where that is left out, is about p² + p³ + … = p²/(1 − p) of what is emitted, if what has been scattered once
//! meets as much soot as fresh light does. It starts deeper inside, so in a dense fire there is more of it than that, and
//! what is absorbed on the way is counted as seen.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::cells::{Cells, Chunk, Colours, WIDE};
use super::level::Level;
use super::own_light::reach_m;
use super::preparation::Watch;
use super::spread::{MOST_FEW, Spread};
use super::sweep::Sweep;
use super::tables::Tables;
use crate::math::lanes::Lanes;
use crate::scene::Scene;

mod exchange;
mod gathered;
mod orders;
mod sharpen;

use gathered::Gathered;

/// How finely J is worked out: as finely whatever the number of wavelengths, or these alone would make a difference. With the
/// most that fields are worked out at a cell has 24 numbers, and J and light between the layers take 70 MB each.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Effort {
    /// Most cells.
    cells: usize,
    /// Most cells for light that is scattered again, which is smoother, where that is little: those of twice the edge.
    cells_again: usize,
    /// Directions over the sphere for even scattering.
    directions: usize,
}

/// For the window's first passes: 5 to 20 ms on two cores. Weighted by what it adds to the picture, J is 0 to 3 % low on
/// real fires; single places are off by 5 to 13 %, root mean square.
const COARSE: Effort = Effort {
    cells: 30_000,
    cells_again: 30_000,
    directions: 16,
};

/// For a picture: 0.2 to 0.8 s on two cores. J is within 1 % on average; single places are off by 2 to 4 %, mostly for want of
/// directions, of which twice as many would halve that on smooth fires. Where cells are as small as voxels, what is left of
/// sheets thinner than them is in [`super::own_light`].
const FINE: Effort = Effort {
    cells: 700_000,
    cells_again: 110_000,
    directions: 32,
};

/// Wavelengths at whose scattering the directions are counted, nm: the ends of what is seen.
const LOBES_NM: [f64; 2] = [400.0, 700.0];

/// Most directions for a lobe, over those for even scattering: at |g| = 0.75 it is reached.
const MOST_LOBE: f64 = 8.0;

/// Share of the picture's light that is scattered again, up to which that may be worked out in larger cells. Those of twice the
/// edge lose about 1 % of it where soot ends sharply, and single places are off by as much: 0.2 % of the picture.
const LITTLE: f64 = 0.2;

/// Share of the work that is told as that of the medium's cells.
const CELLS_SHARE: f64 = 0.05;
/// Share of the work after which all light is gathered, and is sharpened.
const GATHERED_SHARE: f64 = 0.97;
/// Share of the work that is told as the first order's where there are more.
const FIRST_SHARE: f64 = 0.6;

impl Effort {
    fn of(level: Level) -> Self {
        match level {
            Level::Coarse => COARSE,
            Level::Fine => FINE,
        }
    }

    /// The same for scattering of asymmetry `g`: the solid angle of its lobe goes as (1 − |g|)^1.5 nearly.
    fn for_asymmetry(self, g: f64) -> Self {
        let lobe = (1.0 - g.abs()).powf(-1.5).min(MOST_LOBE);
        Self {
            directions: (self.directions as f64 * lobe).ceil() as usize,
            ..self
        }
    }
}

/// The mean over all directions of the fire's light at a place, each weighted by the phase function towards the eye, less
/// what the place sees of its own glow.
#[derive(Debug)]
pub(super) struct InScatter {
    /// First cell along each axis, and edge in voxels, as in [`Cells`].
    first: [f64; 3],
    per_voxel: f64,
    size: [usize; 3],
    chunks: usize,
    /// A record for each cell, x fastest: of each colour J less own light, where [`Colours::place`] says.
    light: Vec<Chunk>,
    reach_m: f32,
    /// Nodes, features that are not carried, and radicals.
    counts: [usize; 3],
    /// p of the module's page.
    share: f64,
    /// Where light that is scattered again is in it: the share of all light that still is left out.
    left_out: Option<f64>,
    /// Where the plan has more nodes than are worked out: how they become these.
    spread: Option<Spread>,
}

impl InScatter {
    /// Works it out for the plan's nodes and features, seen from the scene's camera, in the calling thread's rayon pool;
    /// `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        again: bool,
        level: Level,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        Self::with_effort(scene, tables, again, Effort::of(level), watch)
    }

    fn with_effort(
        scene: &Scene,
        tables: &Tables,
        again: bool,
        effort: Effort,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        let reduced = tables.for_fields(scene);
        let few = reduced.as_ref().map_or(tables, |(few, _)| few);
        // The medium in cells, and the directions from which their light is taken.
        let colours = Colours::new(&scene.flame, few);
        let cells = Cells::new(scene, &colours, effort.cells, &watch.part(0.0, CELLS_SHARE))?;
        let asymmetry = colours.asymmetry();
        // As many whatever the wavelengths, so that these alone make no difference.
        let strongest = LOBES_NM.map(|nm| scene.flame.asymmetry(nm).abs());
        let strongest = strongest.into_iter().fold(0.0, f64::max);
        let directions = directions(effort.for_asymmetry(strongest).directions);

        // Each direction's light goes to all cells.
        let mut gathered = Gathered::new(scene, &cells, &asymmetry, luminous(few));
        let extinction = colours.extinction();
        let mut rays = Rays {
            directions: &directions,
            extinction: &extinction,
            to_voxels: scene.flame.medium().lattice_from_world.matrix3,
            light: Vec::new(),
        };
        let first = if again { FIRST_SHARE } else { GATHERED_SHARE };
        rays.gather(&cells, &mut gathered, &watch.part(CELLS_SHARE, first))?;

        let share = gathered.share(&colours, directions.len());
        let mut left_out = None;
        let often = if again {
            let is_little = share_beyond(share, 1) < LITTLE;
            let most = [effort.cells, effort.cells_again][usize::from(is_little)];
            let coarser = exchange::larger(&cells, most);
            let coarser = Gathered::new(scene, &coarser, &asymmetry, luminous(few));
            let (fields, rest) = ([&gathered, &coarser], watch.part(first, GATHERED_SHARE));
            let (often, rest) = orders::scattered_often(&mut rays, &colours, fields, &rest)?;
            left_out = Some(rest);
            often
        } else {
            Vec::new()
        };
        let voxel_m = scene.flame.medium().voxel_size_m();
        let reach_m = reach_m(cells.edge as f64, voxel_m) as f32;
        let rest = watch.part(GATHERED_SHARE, 1.0);
        let once = sharpen::sharpened(&gathered, &extinction, reach_m, &rest)?;
        let features = tables.features.len();
        let radicals = colours.len() - colours.nodes;
        Some(Self {
            first: cells.first.map(f64::from),
            per_voxel: 1.0 / cells.edge as f64,
            size: cells.size,
            chunks: cells.chunks,
            light: with_more(once, &often),
            reach_m,
            counts: [colours.nodes, features - radicals, radicals],
            share,
            left_out,
            spread: reduced.map(|(_, spread)| spread),
        })
    }

    /// ∫ L Φ dω at a lattice position less own light: spectral radiance at each node, then radiance of each feature, into
    /// lane `lane` of `light`. It may be below zero; what [`super::own_light`] says of the place belongs to it.
    #[inline(always)]
    pub(super) fn read(&self, position: [f64; 3], lane: usize, light: &mut [Lanes]) {
        if self.light.is_empty() {
            for light in light {
                light[lane] = 0.0;
            }
            return;
        }
        // Between the middles of eight cells; beyond the outermost middles as there.
        let [x, y, _] = self.size;
        let (mut first, mut fraction) = (0, [0.0_f32; 3]);
        let mut next = [1, x, x * y].map(|stride| stride * self.chunks);
        for axis in 0..3 {
            let last = self.size[axis] - 1;
            let at = position[axis] * self.per_voxel - self.first[axis] - 0.5;
            let at = at.clamp(0.0, last as f64);
            let low = (at as usize).min(last.saturating_sub(1));
            fraction[axis] = (at - low as f64) as f32;
            first += low * next[axis];
            if last == 0 {
                next[axis] = 0;
            }
        }
        let [nodes, silent, radicals] = self.counts;
        let all = self.spread.as_ref().map_or(nodes, Spread::len);
        let mut known = [0.0; MOST_FEW];
        for chunk in 0..self.chunks {
            let tap = |corner: usize| {
                let step = |axis: usize| (corner >> axis & 1) * next[axis];
                &self.light[first + step(0) + step(1) + step(2) + chunk]
            };
            let mut found = [0.0; WIDE];
            let taps: [&Chunk; 8] = std::array::from_fn(tap);
            for (number, found) in found.iter_mut().enumerate() {
                let along_x = |i: usize| {
                    let [a, b] = [taps[i][number], taps[i + 1][number]];
                    a + fraction[0] * (b - a)
                };
                let [near, far] = [0, 4].map(|i| {
                    let (a, b) = (along_x(i), along_x(i + 2));
                    a + fraction[1] * (b - a)
                });
                *found = near + fraction[2] * (far - near);
            }
            let colours = (0..nodes + radicals).skip((chunk * WIDE).saturating_sub(2));
            for colour in colours.take(WIDE) {
                let [own, number] = Colours::place(colour);
                if own != chunk {
                    continue;
                }
                if colour >= nodes {
                    light[all + silent + colour - nodes][lane] = found[number];
                } else if self.spread.is_some() {
                    known[colour] = found[number];
                } else {
                    light[colour][lane] = found[number];
                }
            }
        }
        if let Some(spread) = &self.spread {
            for (which, light) in light.iter_mut().take(all).enumerate() {
                light[lane] = spread.at(which, |i| known[i]);
            }
        }
        for light in &mut light[all..all + silent] {
            light[lane] = 0.0;
        }
    }

    /// How far a place sees its own glow, m: see [`super::own_light`].
    #[inline(always)]
    pub(super) fn reach_m(&self) -> f32 {
        self.reach_m
    }

    /// Estimated share of the picture's light that has been scattered more often than `orders` times (at least 1).
    pub(super) fn orders_left_out(&self, orders: u32) -> f64 {
        self.left_out
            .unwrap_or_else(|| share_beyond(self.share, orders))
    }
}

/// Estimated share of all light that has been scattered more often than `orders` times, where `once` is p of the module's page.
fn share_beyond(once: f64, orders: u32) -> f64 {
    if once >= 1.0 {
        return 1.0;
    }
    // More scatterings than light: of what is scattered often, each counts, so that their share stays one of all.
    let more = once.powi(orders as i32 + 1) / (1.0 - once);
    more / (1.0 + more)
}

/// Rays in all directions through cells.
struct Rays<'a> {
    directions: &'a [DVec3],
    extinction: &'a [Vec<Chunk>; 2],
    to_voxels: DMat3,
    /// Those of one direction; kept, for it is large.
    light: Vec<Chunk>,
}

impl Rays<'_> {
    /// Each direction's light goes to all cells; `None` if cancelled.
    fn gather(
        &mut self,
        cells: &Cells,
        gathered: &mut Gathered<'_>,
        watch: &Watch<'_>,
    ) -> Option<()> {
        let to_cells = self.to_voxels * (1.0 / cells.edge as f64);
        for (done, &direction) in self.directions.iter().enumerate() {
            if watch.is_cancelled() {
                return None;
            }
            watch.tell(done as f64 / self.directions.len() as f64);
            let sweep = Sweep::new(cells, self.extinction, to_cells * direction);
            sweep.follow(&mut self.light);
            gathered.take(&sweep, &self.light, direction);
        }
        watch.tell(1.0);
        gathered.normalise(self.directions);
        Some(())
    }
}

/// The sum of two fields, of which the second may be none.
fn with_more(mut light: Vec<Chunk>, more: &[Chunk]) -> Vec<Chunk> {
    for (light, more) in light.iter_mut().zip(more) {
        for (light, more) in light.iter_mut().zip(more) {
            *light += more;
        }
    }
    light
}

/// `count` directions, evenly over the sphere.
fn directions(count: usize) -> Vec<DVec3> {
    let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (sin, cos) = (golden_angle * i as f64).sin_cos();
            let across = ((1.0 - z) * (1.0 + z)).sqrt();
            DVec3::new(across * cos, across * sin, z)
        })
        .collect()
}

/// The plan's node that counts most in Y.
fn luminous(tables: &Tables) -> usize {
    let weights = tables.wavelengths.xyz.iter().map(|weight| weight[1].abs());
    let best = weights.enumerate().fold(
        (0, 0.0),
        |best, (i, y)| if y > best.1 { (i, y) } else { best },
    );
    best.0
}

#[cfg(test)]
pub(super) mod tests;
