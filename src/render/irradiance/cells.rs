//! The medium's light in cells: what each gives off and how much stands in light's way there.
//!
//! A cell is a cube of 2, 4 or 8 voxels. Of what the interpolation makes of the samples, Planck's law included, it holds
//! the integral over its volume, as a sum over points; parts of a cell outside of the medium's domain do not count. Between
//! samples temperature is near linear and Planck's law convex, so a sum over the middles of voxels or of their halves is
//! too dark by per cents: each of the two finer rules is right to the third degree there.

use glam::{DMat3, DVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::channels::{BLOCK, Block, Channels};
use crate::math::Aabb;
use crate::math::lanes::{self, Arithmetic, Kernel, Rounded};
use crate::render::lookup::lookup;
use crate::render::preparation::Watch;
use crate::scene::medium::{BRICK, Medium};

/// How finely the medium is cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fineness {
    /// Cells along a brick's edge: 1, 2 or 4.
    pub(super) cells: usize,
    /// Where the medium is asked.
    pub(super) rule: Rule,
}

/// Points at which a medium is summed up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rule {
    /// Gauss's eight of each voxel.
    Gauss,
    /// The middle of each voxel for two thirds and the samples for a third: Simpson's rule, for the middles err by half of
    /// what the samples do, to the other side.
    Simpson,
    /// One sample of eight.
    Samples,
}

impl Rule {
    /// Points in a brick.
    pub(super) fn points(self) -> usize {
        let voxels = BRICK * BRICK * BRICK;
        match self {
            Self::Gauss => 8 * voxels,
            Self::Simpson => 2 * voxels,
            Self::Samples => voxels / 8,
        }
    }

    /// The next coarser.
    pub(super) fn coarser(self) -> Self {
        match self {
            Self::Gauss => Self::Simpson,
            Self::Simpson | Self::Samples => Self::Samples,
        }
    }

    /// What points lack of a cell's spread, in units of the square of a voxel's edge: each stands for a cube, whose spread is
    /// a quarter of the square of its edge.
    fn missing_spread(self) -> f64 {
        match self {
            Self::Gauss => 0.0,
            Self::Simpson => 0.25,
            Self::Samples => 1.0,
        }
    }
}

/// The cells of all bricks in which something shows, brick by brick in the order of their slots, x fastest within each.
#[derive(Debug)]
pub(super) struct Cells {
    /// Cells along a brick's edge.
    pub(super) per_edge: usize,
    /// Brick of each slot.
    pub(super) bricks: Vec<UVec3>,
    /// Mean over the cell of the volume fraction, and of the part of it that is smoke.
    pub(super) dense: Vec<[f32; 2]>,
    /// The same where the cell's light comes from: its mean weighted with the luminous emission.
    pub(super) dense_where_bright: Vec<[f32; 2]>,
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
        watch: &Watch<'_>,
    ) -> Option<Self> {
        let bricks = bricks_of_slots(medium);
        let world_from_lattice = medium.lattice_from_world.matrix3.inverse();
        let pieces = watch.pieces(bricks.len());
        let parts: Option<Vec<Part>> = bricks
            .par_iter()
            .map(|&brick| {
                pieces.begin()?;
                Some(lanes::dispatch(Sum {
                    medium,
                    channels,
                    fineness,
                    brick,
                    world_from_lattice,
                }))
            })
            .collect();
        let mut cells = Self {
            per_edge: fineness.cells,
            bricks,
            dense: Vec::new(),
            dense_where_bright: Vec::new(),
            power: Vec::new(),
            growth: Vec::new(),
            spots: Vec::new(),
        };
        for part in parts? {
            cells.dense.extend(part.dense);
            cells.dense_where_bright.extend(part.dense_where_bright);
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
    let mut bricks = vec![UVec3::ZERO; medium.shown as usize];
    for (i, &slot) in medium.table.iter().enumerate() {
        if medium.shows(slot) {
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
    dense_where_bright: Vec<[f32; 2]>,
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
    fn run<A: Arithmetic>(self) -> Part {
        let cells = self.fineness.cells;
        let mut part = Part::default();
        for cell in 0..cells * cells * cells {
            let at = [cell % cells, cell / cells % cells, cell / cells / cells];
            self.cell(at, &mut part);
        }
        part
    }
}

/// Where Gauss's two points lie, from the middle in lengths of the interval: 1/√12.
const GAUSS: f64 = 0.288_675_134_594_812_9;

/// Adds the points of one rule in a cube of the lattice, each with its share of the cube's volume: of `intervals`³ equal
/// cubes those at `offsets` along each edge, from the middle of what of the cube lies in the domain.
fn add_points(
    points: &mut Vec<(DVec3, f32)>,
    cube: Aabb,
    domain: &Aabb,
    intervals: usize,
    offsets: &[f64],
    weight: f64,
) {
    let n = intervals * offsets.len();
    let edge = (cube.max.x - cube.min.x) / intervals as f64;
    let along = |axis: usize, i: usize| {
        let low = cube.min[axis] + (i / offsets.len()) as f64 * edge;
        let (from, to) = (
            low.max(domain.min[axis]),
            (low + edge).min(domain.max[axis]),
        );
        let inside = (to - from).max(0.0);
        let at = 0.5 * (from + to) + offsets[i % offsets.len()] * inside;
        (at, inside / edge / n as f64)
    };
    for i in 0..n * n * n {
        let [x, y, z] = [i % n, i / n % n, i / n / n];
        let [(x, share_x), (y, share_y), (z, share_z)] = [along(0, x), along(1, y), along(2, z)];
        let share = weight * share_x * share_y * share_z;
        if share > 0.0 {
            points.push((DVec3::new(x, y, z), share as f32));
        }
    }
}

impl Sum<'_> {
    /// Adds one cell of the brick, given by its number along each axis.
    #[inline(always)]
    fn cell(&self, at: [usize; 3], part: &mut Part) {
        let (medium, channels) = (self.medium, self.channels);
        let edge = BRICK as f64 / self.fineness.cells as f64;
        let low = self.brick.as_dvec3() * BRICK as f64 + DVec3::from(at.map(|at| at as f64)) * edge;
        let middle = low + 0.5 * edge;
        let cube = Aabb {
            min: low,
            max: low + edge,
        };
        let voxels = edge as usize;
        let mut points = Vec::with_capacity(8 * voxels * voxels * voxels);
        let mut add = |cube, intervals, offsets: &[f64], weight| {
            add_points(
                &mut points,
                cube,
                &medium.domain,
                intervals,
                offsets,
                weight,
            );
        };
        match self.fineness.rule {
            Rule::Gauss => add(cube, voxels, &[-GAUSS, GAUSS], 1.0),
            Rule::Simpson => {
                // A sample is the middle of the cube around it.
                let around = Aabb {
                    min: low - 0.5,
                    max: low + edge - 0.5,
                };
                add(cube, voxels, &[0.0], 2.0 / 3.0);
                add(around, voxels, &[0.0], 1.0 / 3.0);
            }
            Rule::Samples => add(cube, voxels / 2, &[0.0], 1.0),
        }
        let turn = self.world_from_lattice.as_mat3();
        let blocks = channels.blocks();
        let mut emission = vec![[0.0; BLOCK]; blocks];
        let mut growth = vec![0.0; channels.thermal.len()];
        let mut power = vec![[0.0_f32; BLOCK]; blocks];
        let mut grown = vec![0.0_f32; channels.thermal.len()];
        let (mut dense, mut dense_where_bright) = ([0.0_f32; 2], [0.0_f32; 2]);
        let (mut weight, mut moment, mut square) = (0.0_f32, Vec3::ZERO, 0.0_f32);
        for (position, share) in points {
            let found = lookup::<Rounded, true, true>(medium, position.to_array());
            if found[0] <= 0.0 && found[2] <= 0.0 && channels.thermal.is_empty() {
                continue;
            }
            let smoke = if medium.smoke.is_empty() {
                0.0
            } else {
                found[3]
            };
            let here = [found[0], smoke];
            for (sum, here) in dense.iter_mut().zip(here) {
                *sum += share * here;
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
            for (sum, here) in dense_where_bright.iter_mut().zip(here) {
                *sum += luminous * here;
            }
            weight += luminous;
            moment += luminous * offset;
            square += luminous * offset.length_squared();
        }

        // From means to the power of the whole cell.
        let volume_m3 = edge.powi(3) * self.world_from_lattice.determinant().abs();
        part.dense.push(dense);
        part.dense_where_bright.push(if weight > 0.0 {
            dense_where_bright.map(|sum| sum / weight)
        } else {
            dense
        });
        part.growth.extend(grown);
        let scaled = |power: &Block| power.map(|power| power * volume_m3 as f32);
        part.power.extend(power.iter().map(scaled));
        let mut spot = Spot::default();
        if weight > 0.0 {
            let offset = moment / weight;
            let lattice = medium.lattice_from_world.inverse();
            let voxel_m2 = medium.voxel_size_m * medium.voxel_size_m;
            let own = self.fineness.rule.missing_spread() * voxel_m2;
            spot = Spot {
                weight: f64::from(weight) * volume_m3,
                centre: lattice.transform_point3(middle) + offset.as_dvec3(),
                spread_m2: f64::from((square / weight - offset.length_squared()).max(0.0)) + own,
            };
        }
        part.spots.push(spot);
    }
}
