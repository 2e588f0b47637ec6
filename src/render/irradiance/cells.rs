//! The medium's light in cells: what each gives off and how much stands in light's way there.
//!
//! A cell is a cube of 2, 4 or 8 voxels. Of what the interpolation makes of the samples, Planck's law included, it holds
//! the integral over its volume, by the midpoint rule over points that are at most two voxels apart; parts of a cell
//! outside of the medium's domain do not count.

use glam::{DMat3, DVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::channels::{BLOCK, Block, Channels};
use crate::math::lanes::{self, Kernel};
use crate::render::Cancel;
use crate::render::lookup::lookup;
use crate::scene::medium::{BRICK, Medium, NO_BRICK};

/// How finely the medium is cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fineness {
    /// Cells along a brick's edge: 1, 2 or 4.
    pub(super) cells: usize,
    /// Points of the midpoint rule along a brick's edge, a multiple of `cells`.
    pub(super) points: usize,
}

/// The cells of all stored bricks, brick by brick in the order of their slots, x fastest within each.
#[derive(Debug)]
pub(super) struct Cells {
    /// Cells along a brick's edge.
    pub(super) per_edge: usize,
    /// Brick of each slot.
    pub(super) bricks: Vec<UVec3>,
    /// Mean over the cell of the volume fraction, and of the part of it that is smoke.
    pub(super) dense: Vec<[f32; 2]>,
    /// Power of each cell, W sr⁻¹ (nm⁻¹ of the nodes): [`Channels::blocks`] for each.
    pub(super) power: Vec<Block>,
    /// Mean of what a metre adds to each line's depth, 1/m.
    pub(super) growth: Vec<f32>,
    /// Where the light of each cell comes from.
    pub(super) spots: Vec<Spot>,
}

/// Where light comes from: how much, its middle and how wide it is.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spot {
    /// Weight among others.
    pub(super) weight: f64,
    /// Middle, in the world, m.
    pub(super) centre: DVec3,
    /// Mean square distance from the middle, m².
    pub(super) spread_m2: f64,
}

impl Cells {
    /// Sums up a medium's bricks in the calling thread's rayon pool; `None` if cancelled.
    pub(super) fn new(
        medium: &Medium,
        channels: &Channels,
        fineness: Fineness,
        cancel: &Cancel,
    ) -> Option<Self> {
        let bricks = bricks_of_slots(medium);
        let world_from_lattice = medium.lattice_from_world.matrix3.inverse();
        let parts: Vec<Part> = bricks
            .par_iter()
            .map(|&brick| {
                if cancel.is_cancelled() {
                    return Part::default();
                }
                lanes::dispatch(Sum {
                    medium,
                    channels,
                    fineness,
                    brick,
                    world_from_lattice,
                })
            })
            .collect();
        if cancel.is_cancelled() {
            return None;
        }
        let mut cells = Self {
            per_edge: fineness.cells,
            bricks,
            dense: Vec::new(),
            power: Vec::new(),
            growth: Vec::new(),
            spots: Vec::new(),
        };
        for part in parts {
            cells.dense.extend(part.dense);
            cells.power.extend(part.power);
            cells.growth.extend(part.growth);
            cells.spots.extend(part.spots);
        }
        Some(cells)
    }

    /// Edge of a cell in voxels.
    pub(super) fn edge(&self) -> f64 {
        (BRICK / self.per_edge) as f64
    }

    /// The cell of a brick's slot that a lattice position inside that brick lies in.
    #[inline(always)]
    pub(super) fn cell_at(&self, slot: u32, position: DVec3) -> usize {
        let local = position.floor().as_ivec3() & (BRICK as i32 - 1);
        let at = local.as_usizevec3() / (BRICK / self.per_edge);
        let n = self.per_edge;
        slot as usize * n * n * n + (at.z * n + at.y) * n + at.x
    }
}

fn bricks_of_slots(medium: &Medium) -> Vec<UVec3> {
    let (width, height) = (medium.bricks.x as usize, medium.bricks.y as usize);
    let mut bricks = vec![UVec3::ZERO; medium.occupancy().0];
    for (i, &slot) in medium.table.iter().enumerate() {
        if slot != NO_BRICK {
            bricks[slot as usize] = UVec3::new(
                (i % width) as u32,
                (i / width % height) as u32,
                (i / width / height) as u32,
            );
        }
    }
    bricks
}

/// The cells of one brick.
#[derive(Default)]
struct Part {
    dense: Vec<[f32; 2]>,
    power: Vec<Block>,
    growth: Vec<f32>,
    spots: Vec<Spot>,
}

struct Sum<'a> {
    medium: &'a Medium,
    channels: &'a Channels,
    fineness: Fineness,
    brick: UVec3,
    world_from_lattice: DMat3,
}

impl Kernel for Sum<'_> {
    type Output = Part;

    #[inline(always)]
    fn run(self) -> Part {
        let Fineness { cells, points } = self.fineness;
        let mut part = Part::default();
        for cell in 0..cells * cells * cells {
            let at = [cell % cells, cell / cells % cells, cell / cells / cells];
            self.cell(
                at.map(|at| at * (points / cells)),
                points / cells,
                &mut part,
            );
        }
        part
    }
}

impl Sum<'_> {
    /// Adds the cell whose points begin at `first`, `count` along each edge.
    #[inline(always)]
    fn cell(&self, first: [usize; 3], count: usize, part: &mut Part) {
        let (medium, channels) = (self.medium, self.channels);
        let apart = BRICK as f64 / self.fineness.points as f64;
        let origin = self.brick.as_dvec3() * BRICK as f64;
        let middle =
            origin + apart * DVec3::from(first.map(|first| first as f64 + 0.5 * count as f64));
        let turn = self.world_from_lattice.as_mat3();
        let blocks = channels.blocks();
        let mut emission = vec![[0.0; BLOCK]; blocks];
        let mut growth = vec![0.0; channels.thermal.len()];
        let mut power = vec![[0.0_f32; BLOCK]; blocks];
        let mut grown = vec![0.0_f32; channels.thermal.len()];
        let mut dense = [0.0_f32; 2];
        let (mut weight, mut moment, mut square) = (0.0_f32, Vec3::ZERO, 0.0_f32);
        for i in 0..count * count * count {
            let at = [i % count, i / count % count, i / count / count];
            let step: [f64; 3] =
                std::array::from_fn(|axis| (first[axis] + at[axis]) as f64 * apart);
            let low = origin + DVec3::from(step);
            let inside = (low + apart).min(medium.domain.max) - low.max(medium.domain.min);
            let share = (inside.max(DVec3::ZERO) / apart).element_product() as f32;
            if share <= 0.0 {
                continue;
            }
            let position = low + 0.5 * apart;
            let found = lookup::<true>(medium, position.to_array());
            if found[0] <= 0.0 && found[2] <= 0.0 && channels.thermal.is_empty() {
                continue;
            }
            dense[0] += share * found[0];
            if !medium.smoke.is_empty() {
                dense[1] += share * medium.smoke(position) as f32;
            }
            channels.emission(found, &mut emission, &mut growth);
            for (power, emission) in power.iter_mut().zip(&emission) {
                for k in 0..BLOCK {
                    power[k] += share * emission[k];
                }
            }
            for (grown, growth) in grown.iter_mut().zip(&growth) {
                *grown += share * growth;
            }
            let luminous = share * channels.luminous(&emission);
            let offset = turn * (position - middle).as_vec3();
            weight += luminous;
            moment += luminous * offset;
            square += luminous * offset.length_squared();
        }

        // From sums to means, and to the power of the whole cell.
        let points = (count * count * count) as f32;
        let volume_m3 = apart.powi(3) * self.world_from_lattice.determinant().abs();
        part.dense.push(dense.map(|dense| dense / points));
        part.growth.extend(grown.iter().map(|grown| grown / points));
        let scaled = |power: &Block| power.map(|power| power * volume_m3 as f32);
        part.power.extend(power.iter().map(scaled));
        let mut spot = Spot::default();
        if weight > 0.0 {
            let offset = moment / weight;
            let lattice = medium.lattice_from_world.inverse();
            // Points stand for small cubes, whose own spread is a quarter of the square of their edge.
            let own = 0.25 * apart * apart * medium.voxel_size_m * medium.voxel_size_m;
            spot = Spot {
                weight: f64::from(weight) * volume_m3,
                centre: lattice.transform_point3(middle) + offset.as_dvec3(),
                spread_m2: f64::from((square / weight - offset.length_squared()).max(0.0)) + own,
            };
        }
        part.spots.push(spot);
    }
}
