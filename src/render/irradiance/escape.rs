//! How much of each light gets out of the fire, direction by direction.
//!
//! For a direction ω the medium is cut by parallel lines, a cell's edge or two apart. Each is followed from outside into the
//! fire, against ω, in steps of a cell's edge; a step in a cell of power J and column Δu, behind a column u, sends out
//!
//! ```text
//! J e^{−κu} (1 − e^{−κΔu'})/(κΔu')       soot, radicals
//! J (W(y₂) t₂ − W(y₁) t₁)/Δy             a line or band: what it adds, its shadow on the soot behind included
//! ```
//!
//! and its share of the table's light is the sum of that over the sum of J. Δu' is the column where the cell is bright: of
//! thin sheets the light comes from where the soot is dense, and meets more of it than the cell's mean. With lines a cell's
//! edge apart every place is met about once for each direction, so a table says what a march along them would, to the
//! accuracy of cells as steps; with fewer lines and more directions the noise of the single table grows, but a point
//! sees many tables.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | κ | extinction for each unit of volume fraction | 1/m |
//! | u | ∫ f_v ds from outside | m |
//! | y, W, t | depth and growth of a line, transmittance of soot at its wavelength: see `render/glow.rs` | 1 |

use glam::DVec3;
use rayon::prelude::*;

use super::cells::Cells;
use super::channels::{BLOCK, Block, Channels};
use super::directions::Directions;
use super::transmittance::{Way, mean_over_step};
use super::tree::Tree;
use crate::math::lanes::{self, Arithmetic, Kernel};
use crate::math::{Aabb, Ray};
use crate::render::growth::{FIT, curve_of_growth_f32};
use crate::render::preparation::Watch;
use crate::render::walk::for_each_stretch;
use crate::scene::glow::Growth;
use crate::scene::medium::{BRICK, Medium};

/// By how much the lattice of lines is turned about its direction, rad: so that it is at no angle with a simple ratio to
/// the cells', and lines along an axis that are two cells apart do not all miss the same ones.
const TURN: f64 = 0.553_574_358_897_045_2;

/// What gets out of each node that has a table.
#[derive(Debug)]
pub(super) struct Escape {
    pub(super) directions: Directions,
    /// Share that gets out, for each node with a table, direction and channel.
    share: Vec<Block>,
    blocks: usize,
    first_table: usize,
    /// What self-absorption leaves of each line's or band's light, a mean over all directions: for light that does not
    /// get out of the fire first.
    pub(super) thermal_share: Vec<f32>,
}

impl Escape {
    /// Follows light out in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(
        medium: &Medium,
        channels: &Channels,
        cells: &Cells,
        tree: &Tree,
        directions: Directions,
        apart: f64,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        let blocks = channels.blocks();
        let pieces = watch.pieces(directions.len());
        let followed: Option<Vec<Sums>> = (0..directions.len())
            .into_par_iter()
            .map(|i| {
                pieces.begin()?;
                Some(lanes::dispatch(Follow {
                    medium,
                    channels,
                    cells,
                    tree,
                    outwards: directions.get(i),
                    apart,
                }))
            })
            .collect();
        let followed = followed?;
        let mut escape = Self {
            directions,
            share: Vec::new(),
            blocks,
            first_table: tree.first_table,
            thermal_share: thermal_shares(channels, &followed),
        };
        // A node's light is its children's: its share is the mean of theirs, each for what it gives.
        let tables = tree.nodes.len() - tree.first_table;
        let row = directions.len() * blocks;
        escape.share = vec![[1.0; BLOCK]; tables * row];
        for table in 0..tables {
            let node = tree.first_table + table;
            for (direction, sums) in followed.iter().enumerate() {
                for block in 0..blocks {
                    let share = if table < tree.tables {
                        sums.share(table * blocks + block)
                    } else {
                        escape.mean_of_children(tree, node, direction, block)
                    };
                    escape.share[table * row + direction * blocks + block] = share;
                }
            }
        }
        Some(escape)
    }

    /// The share of one block of channels of a node for one direction.
    #[inline(always)]
    pub(super) fn share(&self, node: usize, direction: usize, block: usize) -> &Block {
        let table = node - self.first_table;
        &self.share[(table * self.directions.len() + direction) * self.blocks + block]
    }

    fn mean_of_children(&self, tree: &Tree, node: usize, direction: usize, block: usize) -> Block {
        let [first, count] = tree.nodes[node].children.map(|i| i as usize);
        let (mut light, mut all) = ([0.0; BLOCK], [0.0; BLOCK]);
        for child in first..first + count {
            let power = &tree.power[child * self.blocks + block];
            let share = self.share(child, direction, block);
            for k in 0..BLOCK {
                light[k] += power[k] * share[k];
                all[k] += power[k];
            }
        }
        std::array::from_fn(|k| if all[k] > 0.0 { light[k] / all[k] } else { 1.0 })
    }
}

/// What self-absorption leaves of each line: what got out of it over what would have without.
fn thermal_shares(channels: &Channels, followed: &[Sums]) -> Vec<f32> {
    let share = |i: usize| {
        let sum = |of: fn(&Sums) -> &[[f64; 2]]| {
            followed
                .iter()
                .filter_map(|sums| of(sums).get(i))
                .fold([0.0; 2], |sum, lines| {
                    [sum[0] + lines[0], sum[1] + lines[1]]
                })
        };
        let [grown, thin] = sum(|sums| &sums.lines);
        if thin > 0.0 {
            (grown / thin).max(0.0) as f32
        } else {
            1.0
        }
    };
    (0..channels.thermal.len()).map(share).collect()
}

/// What one direction's lines gathered.
#[derive(Default)]
struct Sums {
    /// Light that got out and all light, for each table of the lowest level and block.
    out: Vec<Block>,
    all: Vec<Block>,
    /// Of each line or band of the gas: what got out, and what would without self-absorption.
    lines: Vec<[f64; 2]>,
}

impl Sums {
    /// The share that gets out; all of it where no line went.
    fn share(&self, at: usize) -> Block {
        let (out, all) = (&self.out[at], &self.all[at]);
        std::array::from_fn(|k| if all[k] > 0.0 { out[k] / all[k] } else { 1.0 })
    }
}

/// Follows all lines of one direction.
struct Follow<'a> {
    medium: &'a Medium,
    channels: &'a Channels,
    cells: &'a Cells,
    tree: &'a Tree,
    outwards: DVec3,
    /// Between two lines, in cells' edges.
    apart: f64,
}

impl Kernel for Follow<'_> {
    type Output = Sums;

    #[inline(always)]
    fn run<A: Arithmetic>(self) -> Sums {
        let blocks = self.channels.blocks();
        let mut sums = Sums {
            out: vec![[0.0; BLOCK]; self.tree.tables * blocks],
            all: vec![[0.0; BLOCK]; self.tree.tables * blocks],
            lines: vec![[0.0; 2]; self.channels.thermal.len()],
        };
        // Around nothing there is no box to be cut by lines.
        if self.cells.bricks.is_empty() {
            return sums;
        }
        // The lattice's own inwards direction, with the length of one of its units along it.
        let inwards = -self
            .medium
            .lattice_from_world
            .transform_vector3(self.outwards);
        let metres = 1.0 / inwards.length();
        let inwards = inwards * metres;
        let hull = self.hull();
        let (u, v) = inwards.any_orthonormal_pair();
        let (u, v) = (
            TURN.cos() * u + TURN.sin() * v,
            TURN.cos() * v - TURN.sin() * u,
        );
        let edge = self.cells.edge();
        let range = |axis: DVec3, apart: f64| {
            let along = hull
                .corners()
                .map(|corner| corner.dot(axis) / (edge * apart));
            let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                [low.min(at), high.max(at)]
            });
            (low.floor() as i64, high.ceil() as i64)
        };
        let ((u0, u1), (v0, v1), (w0, _)) = (
            range(u, self.apart),
            range(v, self.apart),
            range(inwards, 1.0),
        );
        for i in u0..u1 {
            for j in v0..v1 {
                let aside = (i as f64 + 0.5) * u + (j as f64 + 0.5) * v;
                let ray = Ray {
                    origin: edge * (self.apart * aside + w0 as f64 * inwards),
                    direction: inwards,
                };
                self.follow(&ray, &hull, edge * metres, &mut sums);
            }
        }
        sums
    }
}

impl Follow<'_> {
    /// The box of all stored bricks, in the lattice.
    fn hull(&self) -> Aabb {
        let edge = BRICK as f64;
        self.cells.bricks.iter().fold(Aabb::EMPTY, |hull, brick| {
            let min = brick.as_dvec3() * edge;
            hull.union(&Aabb {
                min,
                max: min + edge,
            })
        })
    }

    /// Follows one line into the fire; a step is `step_m` long.
    #[inline(always)]
    fn follow(&self, ray: &Ray, hull: &Aabb, step_m: f64, sums: &mut Sums) {
        let Some((enter, exit)) = hull.intersect(ray) else {
            return;
        };
        let blocks = self.channels.blocks();
        let edge = self.cells.edge();
        let mut column = [0.0_f32; 2];
        let mut way = Way::new(blocks);
        let mut lines = Lines::new(self.channels.thermal.len());
        for_each_stretch(self.medium, ray, [enter, exit], |stretch| {
            let first = (stretch.from / edge - 0.5).ceil();
            let end = (stretch.to / edge - 0.5).ceil();
            let mut step = first;
            while step < end {
                let position = ray.at((step + 0.5) * edge);
                step += 1.0;
                let cell = self.cells.cell_at(stretch.slot, position);
                let added = self.cells.dense[cell].map(|dense| dense * step_m as f32);
                let table = self.tree.table_of_cell[cell];
                if table == u32::MAX {
                    way.wait(added);
                } else {
                    let own =
                        self.cells.dense_where_bright[cell].map(|dense| dense * step_m as f32);
                    for block in 0..blocks {
                        let at = table as usize * blocks + block;
                        let power = &self.cells.power[cell * blocks + block];
                        let share = way.step(block, &self.channels.extinction[block], added, own);
                        let (out, all) = (&mut sums.out[at], &mut sums.all[at]);
                        for k in 0..BLOCK {
                            all[k] += power[k];
                            out[k] += power[k] * share[k];
                        }
                    }
                    way.arrive();
                    if !self.channels.thermal.is_empty() {
                        self.grow(
                            cell,
                            table as usize,
                            column,
                            added,
                            step_m as f32,
                            &mut lines,
                            sums,
                        );
                    }
                }
                column = [column[0] + added[0], column[1] + added[1]];
            }
        });
    }

    /// Puts what lines and bands add in a step in the place of what they would without self-absorption.
    #[allow(clippy::too_many_arguments, reason = "one step of one line")]
    fn grow(
        &self,
        cell: usize,
        table: usize,
        column: [f32; 2],
        added: [f32; 2],
        step_m: f32,
        lines: &mut Lines,
        sums: &mut Sums,
    ) {
        let (blocks, count) = (self.channels.blocks(), self.channels.thermal.len());
        for (i, thermal) in self.channels.thermal.iter().enumerate() {
            let (block, k) = (thermal.channel / BLOCK, thermal.channel % BLOCK);
            let depth = self.cells.growth[cell * count + i] * step_m;
            let extinction = &self.channels.extinction[block];
            let behind = [column[0] + added[0], column[1] + added[1]];
            let tau = extinction[0][k] * behind[0] + extinction[1][k] * behind[1];
            lines.depth[i] += depth;
            let width = match thermal.growth {
                Growth::Line => curve_of_growth_f32(&FIT, lines.depth[i]),
                Growth::Box => -lanes::exp_m1(-lines.depth[i]),
            } * lanes::exp(-tau);
            if depth > 0.0 {
                let power = self.cells.power[cell * blocks + block][k];
                // What the step without lines has added already.
                let own = self.cells.dense_where_bright[cell].map(|dense| dense * step_m);
                let before = extinction[0][k] * column[0] + extinction[1][k] * column[1];
                let inside = extinction[0][k] * own[0] + extinction[1][k] * own[1];
                let thin = power * lanes::exp(-before) * mean_over_step(inside);
                let grown = power * (width - lines.width[i]) / depth;
                sums.out[table * blocks + block][k] += grown - thin;
                let line = &mut sums.lines[i];
                *line = [line[0] + f64::from(grown), line[1] + f64::from(thin)];
            }
            lines.width[i] = width;
        }
    }
}

/// How far the gas's lines have grown along a line of sight.
struct Lines {
    depth: Vec<f32>,
    width: Vec<f32>,
}

impl Lines {
    fn new(count: usize) -> Self {
        Self {
            depth: vec![0.0; count],
            width: vec![0.0; count],
        }
    }
}
