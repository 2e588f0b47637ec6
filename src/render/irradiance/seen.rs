//! Which share of a node's light is seen past the objects of the stage.
//!
//! A ball's shadow is that of even light. A large node is uneven, and where an object stands in the fire a part of the node
//! is before it and a part behind: taken as one ball, its shadow is another than that of its parts, and where a node is
//! taken in parts instead, a step would be seen. So a node that is partly hidden is asked part by part, down to what gives
//! too little of the point's light to be seen:
//!
//! ```text
//! V = Σ wᵢ eᵢ Tᵢ Vᵢ / Σ wᵢ eᵢ Tᵢ
//! ```
//!
//! with the luminous power w of each part, its irradiance e over power and the share T of its light that gets out. The
//! spectrum is not asked for, which costs most.

use glam::DVec3;

use super::ball;
use super::channels::{BLOCK, Block, Channels};
use super::directions::{Directions, Reading};
use super::escape::Escape;
use super::tree::{Node, Tree};
use crate::scene::Stage;
use crate::scene::stage::Shadows;

/// Least light that a point is taken to get from all of the fire, over what it would get if it faced the fire: what is seen
/// under a low angle is not asked in ever smaller parts.
const LEAST_COSINE: f64 = 0.01;
/// Least share of a part's light that is taken to get out: where all is too dense for any, parts count by their power.
const LEAST_OUT: f64 = 1e-3;

/// Share of the luminous light that gets out of each node with a table, direction by direction.
#[derive(Debug)]
pub(super) struct LuminousEscape {
    directions: Directions,
    first_table: usize,
    share: Vec<f32>,
}

impl LuminousEscape {
    pub(super) fn new(channels: &Channels, tree: &Tree, escape: &Escape) -> Self {
        let (blocks, directions) = (channels.blocks(), escape.directions);
        let mut share = Vec::new();
        let mut out = vec![Block::default(); blocks];
        for node in tree.first_table..tree.nodes.len() {
            let power = tree.power_of(node as u32, blocks);
            let all = channels.luminous(power);
            for direction in 0..directions.len() {
                for block in 0..blocks {
                    let share = escape.share(node, direction, block);
                    for k in 0..BLOCK {
                        out[block][k] = power[block][k] * share[k];
                    }
                }
                share.push(if all > 0.0 {
                    channels.luminous(&out) / all
                } else {
                    1.0
                });
            }
        }
        Self {
            directions,
            first_table: tree.first_table,
            share,
        }
    }

    /// Of a node with a table in a direction.
    fn of(&self, node: usize, reading: &Reading) -> f64 {
        let row = (node - self.first_table) * self.directions.len();
        let share = |&(direction, weight): &(usize, f32)| weight * self.share[row + direction];
        f64::from(reading.iter().map(share).sum::<f32>())
    }
}

/// The fire as one point of a surface sees it past the stage.
pub(super) struct Seen<'a> {
    tree: &'a Tree,
    escape: &'a LuminousEscape,
    point: DVec3,
    normal: DVec3,
    shadows: Shadows,
    /// Numbers of the objects, then those before the nodes that are being asked.
    list: Vec<u32>,
    /// Light, as luminous power over m², below which a node is one ball.
    least: f64,
}

impl<'a> Seen<'a> {
    /// Of a stage from a point with a unit normal. Nodes that give a smaller share than `finest` of the point's light are not
    /// asked in parts.
    pub(super) fn new(
        (tree, escape): (&'a Tree, &'a LuminousEscape),
        root: &Node,
        stage: &Stage,
        [point, normal]: [DVec3; 2],
        finest: f64,
    ) -> Self {
        let to_light = root.spot.centre - point;
        let distance = to_light.length();
        let facing = LEAST_COSINE / distance.max(root.radius_m).powi(2);
        let per_power =
            ball::irradiance_per_power(to_light.dot(normal), distance, root.radius_m).max(facing);
        let shadows = stage.shadows_at(point, normal, (root.spot.centre, root.reach_m));
        Self {
            tree,
            escape,
            point,
            normal,
            list: (0..shadows.count() as u32).collect(),
            shadows,
            least: finest * root.spot.weight * per_power,
        }
    }

    /// The share of a node's light that is seen, of a node with that irradiance over power, 1/m².
    pub(super) fn share(&mut self, node: &Node, per_power: f64) -> f64 {
        let all = self.list.len();
        if all == 0 {
            return 1.0;
        }
        let share = self.share_past(0, node, per_power * node.spot.weight);
        self.list.truncate(all);
        share
    }

    /// The share past the objects of the list from a place on, of a node with that light.
    fn share_past(&mut self, from: usize, node: &Node, light: f64) -> f64 {
        let [first, children] = node.children;
        let centre = node.spot.centre;
        if children == 0 || light < self.least {
            // No light comes from beyond the reach, so nothing there hides any.
            let radius_m = node.radius_m.min(node.reach_m);
            return self
                .shadows
                .visibility_past(&self.list[from..], centre, radius_m);
        }
        let to = self.list.len();
        let shadows = &self.shadows;
        if !shadows.list_those_before(&mut self.list, from..to, centre, node.reach_m) {
            self.list.truncate(to);
            return 0.0;
        }
        if self.list.len() == to {
            return 1.0;
        }
        let (mut seen, mut all) = (0.0, 0.0);
        let tree = self.tree;
        let mut reading = None;
        for child in &tree.nodes[first as usize..(first + children) as usize] {
            let to_light = child.spot.centre - self.point;
            let per_power = ball::irradiance_per_power(
                to_light.dot(self.normal),
                to_light.length(),
                child.radius_m,
            );
            let light = per_power * child.spot.weight;
            // Not so for a NaN, as of a point in the one spot of a cell that glows.
            if light > 0.0 {
                // Children that have no table of their own share one: what gets out is the same share of each.
                let gets_out = if child.table == node.table {
                    1.0
                } else {
                    let outwards = self.point - centre;
                    let read = || self.escape.directions.read(outwards);
                    let reading = reading.get_or_insert_with(read);
                    let share = self.escape.of(child.table as usize, reading);
                    share.max(LEAST_OUT)
                };
                all += light * gets_out;
                seen += light * gets_out * self.share_past(to, child, light);
            }
        }
        self.list.truncate(to);
        if all > 0.0 { seen / all } else { 1.0 }
    }
}
