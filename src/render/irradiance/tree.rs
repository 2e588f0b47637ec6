//! The cells' light, gathered in an octree: from afar many cells are one light.
//!
//! Cells that give light are put in the order of their place in the tree (G. M. Morton, 1966), so that a node's children
//! lie side by side, level by level from the cells to the root.

use glam::UVec3;

use super::cells::{Cells, Spot};
use super::channels::{BLOCK, Block};

/// One light: a cell, or all cells of a cube.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Where the light comes from.
    pub(super) spot: Spot,
    /// Radius of the ball with the same spread, m.
    pub(super) radius_m: f64,
    /// No light of it comes from farther off its middle, m.
    pub(super) reach_m: f64,
    /// First child and their number; 0 for a cell.
    pub(super) children: [u32; 2],
    /// The node whose table says what of its light gets out: itself, or the one above that has one.
    pub(super) table: u32,
}

/// All lights of a fire.
#[derive(Debug)]
pub(super) struct Tree {
    /// Children before parents, the root last.
    pub(super) nodes: Vec<Node>,
    /// Power of each node, W sr⁻¹ (nm⁻¹).
    pub(super) power: Vec<Block>,
    /// The first node that has a table of its own; so have all after it.
    pub(super) first_table: usize,
    /// Nodes of the lowest level with tables.
    pub(super) tables: usize,
    /// Table (from 0) in which each cell of [`Cells`] is summed up; `u32::MAX` for dark ones.
    pub(super) table_of_cell: Vec<u32>,
}

/// Share of all light that the dimmest cells give together and that is left out with them: a tenth of the error that all
/// else makes at best, 0.1 %.
const DIM: f64 = 1e-4;

/// A ball's mean square distance from its middle is 3/5 of its radius squared.
const RADIUS2_OF_SPREAD: f64 = 5.0 / 3.0;

impl Tree {
    /// Gathers cells; on the lowest level with tables there are at most `most_tables` and none is smaller than a brick.
    pub(super) fn new(cells: &Cells, blocks: usize, most_tables: usize) -> Self {
        let n = cells.per_edge;
        let dimmest = dimmest_that_counts(cells);
        let mut leaves: Vec<(u64, usize)> = (0..cells.spots.len())
            .filter(|&cell| cells.spots[cell].weight > dimmest)
            .map(|cell| {
                let local = cell % (n * n * n);
                let at = UVec3::new(
                    (local % n) as u32,
                    (local / n % n) as u32,
                    (local / n / n) as u32,
                );
                let brick = cells.bricks[cell / (n * n * n)];
                (morton(brick * n as u32 + at), cell)
            })
            .collect();
        leaves.sort_unstable();

        let mut tree = Self {
            nodes: Vec::new(),
            power: Vec::new(),
            first_table: 0,
            tables: 0,
            table_of_cell: vec![u32::MAX; cells.spots.len()],
        };
        for &(_, cell) in &leaves {
            let spot = cells.spots[cell];
            let radius_m = (RADIUS2_OF_SPREAD * spot.spread_m2).sqrt();
            tree.nodes.push(Node {
                spot,
                radius_m,
                // The corner of a cube lies √(9/5) of that ball's radius from the middle, more where light is off it.
                reach_m: 2.0 * radius_m,
                children: [0, 0],
                table: 0,
            });
            tree.power
                .extend_from_slice(&cells.power[cell * blocks..(cell + 1) * blocks]);
        }

        // Level by level, until one is left.
        let mut keys: Vec<u64> = leaves.iter().map(|&(key, _)| key).collect();
        let mut first = 0;
        let mut voxels = 8 / n;
        let mut table_level = None;
        loop {
            if table_level.is_none()
                && (keys.len() <= 1 || voxels >= 8 && keys.len() <= most_tables)
            {
                table_level = Some([first, keys.len()]);
            }
            if keys.len() <= 1 {
                break;
            }
            let start = tree.nodes.len();
            keys = tree.parents(first, &keys, blocks);
            first = start;
            voxels *= 2;
        }
        let [first_table, tables] = table_level.unwrap_or_default();
        (tree.first_table, tree.tables) = (first_table, tables);
        tree.hand_tables_down();
        for (leaf, &(_, cell)) in leaves.iter().enumerate() {
            tree.table_of_cell[cell] = tree.nodes[leaf].table - first_table as u32;
        }
        tree
    }

    /// Adds the parents of a level whose nodes begin at `first` and have these keys; returns theirs.
    fn parents(&mut self, first: usize, keys: &[u64], blocks: usize) -> Vec<u64> {
        let mut above = Vec::new();
        let mut from = 0;
        for group in keys.chunk_by(|a, b| a >> 3 == b >> 3) {
            let children = first + from..first + from + group.len();
            let mut power = vec![[0.0; BLOCK]; blocks];
            for child in children.clone() {
                let own = &self.power[child * blocks..(child + 1) * blocks];
                for (sum, own) in power.iter_mut().zip(own) {
                    for k in 0..BLOCK {
                        sum[k] += own[k];
                    }
                }
            }
            let spot = gathered(self.nodes[children.clone()].iter().map(|node| node.spot));
            let reach = |node: &Node| node.spot.centre.distance(spot.centre) + node.reach_m;
            self.nodes.push(Node {
                spot,
                radius_m: (RADIUS2_OF_SPREAD * spot.spread_m2).sqrt(),
                reach_m: self.nodes[children.clone()]
                    .iter()
                    .map(reach)
                    .fold(0.0, f64::max),
                children: [children.start as u32, group.len() as u32],
                table: 0,
            });
            self.power.extend(power);
            above.push(group[0] >> 3);
            from += group.len();
        }
        above
    }

    /// Tells each node its table.
    fn hand_tables_down(&mut self) {
        for i in (0..self.nodes.len()).rev() {
            if i >= self.first_table {
                self.nodes[i].table = i as u32;
            }
            let Node {
                children: [first, count],
                table,
                ..
            } = self.nodes[i];
            for child in first..first + count {
                self.nodes[child as usize].table = table;
            }
        }
    }

    /// Power of a node, W sr⁻¹ (nm⁻¹ of the nodes).
    pub(super) fn power_of(&self, node: u32, blocks: usize) -> &[Block] {
        &self.power[node as usize * blocks..(node as usize + 1) * blocks]
    }

    /// The root, unless all is dark.
    pub(super) fn root(&self) -> Option<u32> {
        self.nodes.len().checked_sub(1).map(|root| root as u32)
    }
}

/// The weight above which cells are gathered: those below give [`DIM`] of all light together.
fn dimmest_that_counts(cells: &Cells) -> f64 {
    let mut weights: Vec<f64> = cells.spots.iter().map(|spot| spot.weight).collect();
    weights.sort_unstable_by(f64::total_cmp);
    let left_out = DIM * weights.iter().sum::<f64>();
    let mut sum = 0.0;
    let below = weights.iter().take_while(|&&weight| {
        sum += weight;
        sum <= left_out
    });
    below.last().copied().unwrap_or(0.0)
}

/// Several spots as one.
fn gathered(spots: impl Iterator<Item = Spot> + Clone) -> Spot {
    let weight: f64 = spots.clone().map(|spot| spot.weight).sum();
    let centre = spots
        .clone()
        .map(|spot| spot.centre * (spot.weight / weight))
        .sum();
    let spread = |spot: Spot| {
        (spot.spread_m2 + spot.centre.distance_squared(centre)) * (spot.weight / weight)
    };
    Spot {
        weight,
        centre,
        spread_m2: spots.map(spread).sum(),
    }
}

/// The bits of three numbers below 2²¹ in turn.
fn morton(at: UVec3) -> u64 {
    let spread = |number: u32| {
        (0..21).fold(0_u64, |key, bit| {
            key | (u64::from(number >> bit & 1) << (3 * bit))
        })
    };
    spread(at.x) | spread(at.y) << 1 | spread(at.z) << 2
}
