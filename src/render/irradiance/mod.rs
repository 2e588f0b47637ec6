//! The fire as a light: what falls on the surfaces of the stage.
//!
//! # What is computed
//!
//! Irradiance, E = ∫ L(ω) max(0, cos θ) dω over what the fire sends to a point of a surface, at each node and feature of
//! the plan, past the objects of the stage, without any random number:
//!
//! ```text
//! E = ∫ j(x) max(0, cos θ)/r² T V d³x  ≈  Σ J · e(h, r, R) · T(ω) · V
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | j, J | emission coefficient, its integral over a cell | W m⁻³ sr⁻¹ nm⁻¹, W sr⁻¹ nm⁻¹ |
//! | e | irradiance of a ball of the cell's spread over its power: cos θ/r² from afar | 1/m² |
//! | T | share of the cell's light that gets through the soot | 1 |
//! | V | share of the ball that is seen past the objects | 1 |
//!
//! # How
//!
//! `cells` sums up the emission in cubes of a few voxels, `tree` gathers them in an octree; from a point, cells that look
//! small together are one light (J. Barnes and P. Hut, Nature 324 (1986) 446), a ball of the same spread (`ball`).
//!
//! Where the point lies outside of the fire, T is what gets out of the cell in that direction, which `escape` has worked
//! out beforehand for a fixed set of `directions`. Where it lies inside, with a column τ₂ of the fire behind it as seen
//! from the cell, and τ₁ between the two,
//!
//! ```text
//! T = e^{−τ₁} = e^{−τ₁−τ₂} + (1 − e^{−τ₂}) e^{−τ₁},
//! ```
//!
//! whose first part is what gets out, and only the second needs τ₁ and τ₂ of this point: those are taken along the line
//! through the cells near the point and the means of whole bricks farther off. Nodes so near that they are parts of a
//! brick take τ₁ straight away.
//!
//! **Validity.** Single scattering out of the beam counts as loss. What surfaces reflect falls on no other surface. At the
//! fine level it is what a march from the same point finds within 1.5 % from three sizes of a fire on, and 3 % beside it;
//! at the coarse level within 15 % and 25 %, by half of that in luminance.

use glam::DVec3;

use super::glow::MAX_FEATURES;
use super::level::Level;
use super::preparation::Watch;
use super::spread::Spread;
use super::tables::{MAX_NODES, Tables};
use crate::math::lanes;
use crate::scene::{Medium, Scene, Stage};

mod ball;
mod cells;
mod channels;
mod columns;
mod directions;
mod escape;
mod seen;
mod transmittance;
mod tree;

use cells::{Cells, Fineness, Rule};
use channels::{BLOCK, Block, Channels};
use columns::Columns;
use directions::Directions;
use escape::Escape;
use seen::{LuminousEscape, Seen};
use tree::{Node, Tree};

/// Most blocks of channels of any tables.
const MOST_BLOCKS: usize = (MAX_NODES + MAX_FEATURES).div_ceil(BLOCK);
/// Most nodes that wait to be looked at: seven on each of the 22 levels that a 64 bit key has, and one.
const MOST_OPEN: usize = 7 * 22 + 1;

/// By how much larger a node looks than what is one light before it is only its children: between, it is both, in shares
/// that change steadily. A node's colours do not all come from the same height, so where low light falls on the ground one
/// light and its parts differ by up to 4 % in blue, and without a change from one to the other a ring would be seen.
const BLEND: f64 = 0.2;

/// How finely the fire is cut and from how many directions it is seen, for each [`Level`].
#[derive(Debug, Clone, Copy)]
struct Effort {
    finest: Fineness,
    /// Most points at which the medium is asked.
    points: usize,
    /// Squares along the side of the set of directions.
    squares: usize,
    /// Between two parallel lines, in cells' edges.
    apart: f64,
    /// Most steps of all lines of all directions.
    steps: usize,
    /// How large a node's ball may look to be one light: radius over distance. First of cells and bricks, then of what is
    /// larger: of a dense fire only the side towards the point is seen, so its light comes from nearer than its middle.
    opening: [f64; 2],
    /// Share of a point's light below which a partly hidden part is not taken apart.
    finest_hidden: f64,
    /// Most blocks of channels that all tables of the lowest level hold at up to eight wavelengths; 32 bytes each. At
    /// sixteen, the most that there are, they hold one more for each place.
    table_blocks: usize,
}

impl Effort {
    const fn of(level: Level) -> Self {
        match level {
            Level::Coarse => Self {
                finest: Fineness {
                    cells: 2,
                    rule: Rule::Simpson,
                },
                points: 500_000,
                squares: 6,
                apart: 1.0,
                steps: 1_000_000,
                opening: [0.4, 0.2],
                finest_hidden: 0.04,
                table_blocks: 200_000,
            },
            Level::Fine => Self {
                finest: Fineness {
                    cells: 4,
                    rule: Rule::Gauss,
                },
                points: 16_000_000,
                squares: 40,
                apart: 1.5,
                steps: 60_000_000,
                opening: [0.3, 0.08],
                finest_hidden: 0.003,
                table_blocks: 3_000_000,
            },
        }
    }

    /// The fineness for a medium of so many bricks: cells and points grow coarser where there are many.
    fn fineness(&self, bricks: usize, directions: usize) -> Fineness {
        let Fineness {
            mut cells,
            mut rule,
        } = self.finest;
        let steps = |cells: usize| (bricks * cells.pow(3) * directions) as f64 / self.apart.powi(2);
        while cells > 1 && steps(cells) > self.steps as f64 {
            cells /= 2;
        }
        while rule != Rule::Samples && bricks * rule.points() > self.points {
            rule = rule.coarser();
        }
        Fineness { cells, rule }
    }
}

/// Share of the work that is told as that of the cells.
const CELLS_SHARE: f64 = 0.1;

/// The fire's light, gathered so that any point of a surface can ask for it.
#[derive(Debug)]
pub(super) struct FireLight {
    opening: [f64; 2],
    finest_hidden: f64,
    channels: Channels,
    tree: Tree,
    escape: Escape,
    luminous: LuminousEscape,
    columns: Columns,
    /// What self-absorption leaves of each channel's light on the way through a part of the fire: 1 but for lines.
    alone: Vec<Block>,
    /// Where the plan has more nodes than are worked out: how many are, and how they become the plan's.
    spread: Option<(usize, Spread)>,
}

impl FireLight {
    /// Works it out for the plan's nodes and features in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        tables: &Tables,
        level: Level,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        Self::with(scene, tables, &Effort::of(level), watch)
    }

    fn with(scene: &Scene, tables: &Tables, effort: &Effort, watch: &Watch<'_>) -> Option<Self> {
        let medium: &Medium = scene.flame.medium();
        let directions = Directions::new(effort.squares);
        let bricks = medium.shown as usize;
        let reduced = tables.for_fields(scene);
        let channels = Channels::new(scene, reduced.as_ref().map_or(tables, |(few, _)| few));
        let fineness = effort.fineness(bricks, directions.len());
        let of_cells = watch.part(0.0, CELLS_SHARE);
        let cells = Cells::new(medium, &channels, fineness, &of_cells)?;
        let blocks = channels.blocks();
        // As many whatever the wavelengths, so that these alone make no difference.
        let most_tables = effort.table_blocks
            / (directions.len() * (BLOCK + tables.features.len()).div_ceil(BLOCK));
        let tree = Tree::new(&cells, blocks, most_tables);
        let escape = Escape::new(
            medium,
            &channels,
            &cells,
            &tree,
            directions,
            effort.apart,
            &watch.part(CELLS_SHARE, 1.0),
        )?;
        let mut alone = vec![[1.0; BLOCK]; blocks];
        for (thermal, share) in channels.thermal.iter().zip(&escape.thermal_share) {
            alone[thermal.channel / BLOCK][thermal.channel % BLOCK] = *share;
        }
        Some(Self {
            opening: effort.opening,
            finest_hidden: effort.finest_hidden,
            alone,
            luminous: LuminousEscape::new(&channels, &tree, &escape),
            channels,
            tree,
            escape,
            columns: Columns::new(&scene.flame, cells),
            spread: reduced.map(|(few, spread)| (few.nodes.len(), spread)),
        })
    }

    /// Irradiance of a surface at a point of the world with a unit normal: spectral, W m⁻² nm⁻¹, at each node, then W m⁻²
    /// of each feature. What stands on the stage casts shadows.
    pub(super) fn irradiance(&self, stage: &Stage, point: DVec3, normal: DVec3, found: &mut [f32]) {
        let mut sums = [[0.0; BLOCK]; MOST_BLOCKS];
        let sums = &mut sums[..self.channels.blocks()];
        let inside = self.columns.hold(point);
        let Some(root) = self.tree.root() else {
            return found.fill(0.0);
        };
        let place = [point, normal];
        let whole = &self.tree.nodes[root as usize];
        let mut seen = Seen::new(
            (&self.tree, &self.luminous),
            whole,
            stage,
            place,
            self.finest_hidden,
        );
        // Nodes with the share of their light that is still to come.
        let mut open = [(root, 1.0); MOST_OPEN];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (index, mut part) = open[count];
            let node = &self.tree.nodes[index as usize];
            let to_light = node.spot.centre - point;
            let height = to_light.dot(normal);
            if height <= -node.reach_m {
                continue;
            }
            let distance = to_light.length();
            let [first, children] = node.children;
            let size = node.radius_m / (self.opening_of(index) * distance);
            if children > 0 && size > 1.0 {
                let apart = ((size - 1.0) / BLEND).min(1.0);
                for child in first..first + children {
                    open[count] = (child, part * apart);
                    count += 1;
                }
                if apart >= 1.0 {
                    continue;
                }
                part *= 1.0 - apart;
            }
            let per_power = ball::irradiance_per_power(height, distance, node.radius_m);
            // A point in the one spot of a cell that glows has no irradiance from it.
            if per_power.is_nan() || per_power <= 0.0 {
                continue;
            }
            let seen = seen.share(node, per_power);
            if seen > 0.0 {
                let strength = (part * per_power * seen) as f32;
                let light = Light {
                    node,
                    power: self.tree.power_of(index, self.channels.blocks()),
                    strength,
                    outwards: if distance > 0.0 { -to_light } else { normal },
                };
                if (index as usize) < self.tree.first_table {
                    self.add_from_beside(&light, point, sums);
                    continue;
                }
                self.add_what_gets_out(&light, sums);
                if inside {
                    self.add_what_would_not(&light, point, sums);
                }
            }
        }
        let sums = sums.as_flattened();
        let mut features = sums;
        let mut rest = found;
        if let Some((few, spread)) = &self.spread {
            let (nodes, others) = rest.split_at_mut(spread.len());
            for (which, found) in nodes.iter_mut().enumerate() {
                *found = spread.at(which, |i| sums[i]);
            }
            (features, rest) = (&sums[*few..], others);
        }
        for (found, sum) in rest.iter_mut().zip(features) {
            *found = *sum;
        }
    }

    /// How large a node may look to be one light, radius over distance.
    #[inline]
    fn opening_of(&self, node: u32) -> f64 {
        let is_large = node as usize >= self.tree.first_table + self.tree.tables;
        self.opening[usize::from(is_large)]
    }

    /// Adds the light of a node that is so near that it is a part of a table's.
    fn add_from_beside(&self, light: &Light<'_>, point: DVec3, sums: &mut [Block]) {
        let between = self.columns.between(point, light.node.spot.centre);
        for (block, (sum, power)) in sums.iter_mut().zip(light.power).enumerate() {
            let [all, smoke] = &self.channels.extinction[block];
            for k in 0..BLOCK {
                let arrives = lanes::exp(-(all[k] * between[0] + smoke[k] * between[1]));
                sum[k] += light.strength * power[k] * self.alone[block][k] * arrives;
            }
        }
    }

    /// Adds the part of a node's light that gets out of the fire in the point's direction.
    #[inline]
    fn add_what_gets_out(&self, light: &Light<'_>, sums: &mut [Block]) {
        let reading = self.escape.directions.read(light.outwards);
        let table = light.node.table as usize;
        for (block, (sum, power)) in sums.iter_mut().zip(light.power).enumerate() {
            let mut share = [0.0; BLOCK];
            for (direction, weight) in reading {
                let row = self.escape.share(table, direction, block);
                for k in 0..BLOCK {
                    share[k] += weight * row[k];
                }
            }
            for k in 0..BLOCK {
                sum[k] += light.strength * power[k] * share[k];
            }
        }
    }

    /// Adds the part that reaches the point but would be lost behind it.
    fn add_what_would_not(&self, light: &Light<'_>, point: DVec3, sums: &mut [Block]) {
        let behind = self.columns.behind(point, light.outwards);
        if behind == [0.0; 2] {
            return;
        }
        let between = self.columns.between(point, light.node.spot.centre);
        for (block, (sum, power)) in sums.iter_mut().zip(light.power).enumerate() {
            let [all, smoke] = &self.channels.extinction[block];
            for k in 0..BLOCK {
                let depth = |column: [f32; 2]| all[k] * column[0] + smoke[k] * column[1];
                let lost = -lanes::exp_m1(-depth(behind));
                let arrives = lanes::exp(-depth(between));
                sum[k] += light.strength * power[k] * self.alone[block][k] * lost * arrives;
            }
        }
    }
}

/// One node as a light for one point.
struct Light<'a> {
    node: &'a Node,
    power: &'a [Block],
    /// Irradiance for each unit of its power, seen share included, 1/m².
    strength: f32,
    /// From it to the point.
    outwards: DVec3,
}

#[cfg(test)]
mod tests;
