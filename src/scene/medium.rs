//! The medium as the march sees it: soot volume fraction and temperature, side by side in bricks, and beside them,
//! where burning gas glows by itself, the flame field.
//!
//! A brick covers 8³ voxels and stores 9³ samples, its own and the first layer of its upper neighbours, so that
//! the eight corners of any trilinear cell lie in one brick: four loads of four floats. Only bricks with something
//! that glows or absorbs in them exist (and, for [`Interpolation::Tricubic`], their neighbours); the table of bricks is
//! dense, an absent brick is [`NO_BRICK`].
//!
//! Positions are in *lattice* coordinates: sample (i, j, k) of the packed box sits at (i, j, k), and the lattice
//! starts on a brick border below the first voxel. Values between samples follow [`Interpolation`], all fields alike.

use std::sync::OnceLock;

use glam::{DAffine3, DVec3, IVec3, UVec3};

use super::interpolation::Interpolation;
use super::means::Means;
use crate::math::{Aabb, Ray};

/// Voxels along a brick's edge.
pub const BRICK: usize = 8;
/// Samples along a brick's edge: one layer more, shared with the neighbour.
pub const SAMPLES: usize = BRICK + 1;
/// Samples in a brick.
pub const BRICK_SAMPLES: usize = SAMPLES * SAMPLES * SAMPLES;
/// Table entry of a brick without soot.
pub const NO_BRICK: u32 = u32::MAX;

/// Soot volume fraction (dimensionless) and temperature (K, at least 1) of one sample.
pub type Sample = [f32; 2];

/// A volume packed for the march. See the module's page.
#[derive(Debug, Clone)]
pub struct Medium {
    /// From metres in the world to lattice coordinates.
    pub(crate) lattice_from_world: DAffine3,
    /// Where the field is defined, in lattice coordinates; outside is air.
    pub(crate) domain: Aabb,
    /// From the first to the last sample of the file, in lattice coordinates: what lies beyond is not in the data.
    pub(crate) data: Aabb,
    /// Bricks along each axis.
    pub(crate) bricks: UVec3,
    /// Index into `samples`, in units of bricks, for each brick, x fastest; [`NO_BRICK`] where there is no soot.
    pub(crate) table: Vec<u32>,
    /// [`BRICK_SAMPLES`] for each stored brick, x fastest.
    pub(crate) samples: Vec<Sample>,
    /// The flame field 0 to 1 of the same samples; empty where no burning gas glows.
    pub(crate) flame: Vec<f32>,
    /// Which part of the soot volume fraction of the same samples is smoke; empty where smoke scatters as soot does, or
    /// nothing scatters.
    pub(crate) smoke: Vec<f32>,
    /// How values between samples are formed.
    pub(crate) interpolation: Interpolation,
    /// Edge of a voxel in metres: the cube root of its volume.
    pub(crate) voxel_size_m: f64,
    pub(crate) peaks: Peaks,
    /// Stored bricks before this one hold soot or smoke.
    pub(crate) sooty: u32,
    /// Stored bricks before this one show something; those from it on only bend light.
    pub(crate) shown: u32,
    /// Worked out when they are asked for first.
    pub(crate) means: OnceLock<Means>,
    /// The same.
    pub(crate) cuts: OnceLock<Vec<u8>>,
}

/// The greatest of what a medium holds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Peaks {
    /// Soot volume fraction.
    pub(crate) volume_fraction: f32,
    /// Temperature of what glows or absorbs, K.
    pub(crate) temperature_k: f32,
    /// Flame field.
    pub(crate) flame: f32,
}

impl Peaks {
    /// Notes a sample, and 0 to 1 of its flame field.
    pub(super) fn note(&mut self, sample: Sample, flame: f32) {
        self.volume_fraction = self.volume_fraction.max(sample[0]);
        self.temperature_k = self.temperature_k.max(sample[1]);
        self.flame = self.flame.max(flame);
    }

    /// Notes the peaks of another part.
    pub(super) fn merge(&mut self, other: &Self) {
        self.volume_fraction = self.volume_fraction.max(other.volume_fraction);
        self.temperature_k = self.temperature_k.max(other.temperature_k);
        self.flame = self.flame.max(other.flame);
    }
}

impl Medium {
    /// Edge of a voxel, m: the cube root of its volume where the voxel is not a cube.
    pub fn voxel_size_m(&self) -> f64 {
        self.voxel_size_m
    }

    /// The longest side of the box that is marched through, voxels.
    pub fn longest_side_voxels(&self) -> f64 {
        (self.domain.max - self.domain.min).max_element()
    }

    /// Largest soot volume fraction of any sample, before the amounts of the scene file.
    pub fn peak_volume_fraction(&self) -> f32 {
        self.peaks.volume_fraction
    }

    /// Highest temperature of any sample that glows or absorbs, K; 0 if none does.
    pub fn peak_temperature_k(&self) -> f32 {
        self.peaks.temperature_k
    }

    /// How values between samples are formed.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// Whether anything in a stored brick glows or absorbs, or lies beside such for a smooth interpolation.
    #[inline(always)]
    pub(crate) fn shows(&self, slot: u32) -> bool {
        slot < self.shown
    }

    /// How many bricks are stored, and how many the box has.
    pub fn occupancy(&self) -> (usize, usize) {
        (self.samples.len() / BRICK_SAMPLES, self.table.len())
    }

    /// Memory that the packed fields and their table take, bytes.
    pub fn bytes(&self) -> usize {
        let beside = size_of_val(&self.flame[..]) + size_of_val(&self.smoke[..]);
        size_of_val(&self.samples[..]) + beside + size_of_val(&self.table[..])
    }

    /// A ray of the world in lattice coordinates, with the part of it inside the domain, in metres along it.
    /// `None` if it misses or only touches.
    pub fn enter(&self, ray: &Ray) -> Option<(Ray, [f64; 2])> {
        let local = ray.transformed(&self.lattice_from_world);
        let (enter, exit) = self.domain.intersect(&local)?;
        (exit > enter).then_some((local, [enter, exit]))
    }

    /// Soot volume fraction and temperature (K) at a point of the lattice; zero soot where no brick is.
    ///
    /// The f64 twin of the march's own f32 lookup, for references and probes.
    pub fn sample(&self, position: DVec3) -> [f64; 2] {
        self.interpolated(position, |i| self.samples[i].map(f64::from))
    }

    /// The flame field at a point of the lattice, 0 to 1; 0 where no brick is or no burning gas glows.
    pub fn flame(&self, position: DVec3) -> f64 {
        if self.flame.is_empty() {
            return 0.0;
        }
        self.interpolated(position, |i| [f64::from(self.flame[i])])[0]
    }

    /// Which part of the soot volume fraction at a point of the lattice is smoke; 0 where no brick is or smoke is packed
    /// as soot.
    pub fn smoke(&self, position: DVec3) -> f64 {
        if self.smoke.is_empty() {
            return 0.0;
        }
        self.interpolated(position, |i| [f64::from(self.smoke[i])])[0]
    }

    /// The interpolated value of what `read` reads of a stored sample; zero where no brick is.
    fn interpolated<const N: usize>(
        &self,
        position: DVec3,
        read: impl Fn(usize) -> [f64; N],
    ) -> [f64; N] {
        let mut sum = [0.0; N];
        self.interpolation
            .for_each_cell(position, |voxel, fraction, weight| {
                let Some(first) = self.cell(voxel) else {
                    return;
                };
                for corner in 0..8 {
                    let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
                    let share = [(dx, fraction.x), (dy, fraction.y), (dz, fraction.z)]
                        .into_iter()
                        .map(|(bit, f)| if bit == 1 { f } else { 1.0 - f })
                        .product::<f64>();
                    let value = read(first + (dz * SAMPLES + dy) * SAMPLES + dx);
                    sum = std::array::from_fn(|c| sum[c] + weight * share * value[c]);
                }
            });
        sum
    }

    /// Where the lowest corner of a voxel's cell is stored, if it is.
    fn cell(&self, voxel: IVec3) -> Option<usize> {
        let brick = voxel.as_uvec3() / BRICK as u32;
        let inside = voxel.cmpge(IVec3::ZERO).all() && brick.cmplt(self.bricks).all();
        let slot = if inside {
            self.table[self.brick_index(brick)]
        } else {
            NO_BRICK
        };
        let local = (voxel.as_uvec3() % BRICK as u32).as_usizevec3();
        (slot != NO_BRICK).then(|| {
            slot as usize * BRICK_SAMPLES + (local.z * SAMPLES + local.y) * SAMPLES + local.x
        })
    }

    /// Position of a brick in the table.
    pub(crate) fn brick_index(&self, brick: UVec3) -> usize {
        (brick.z as usize * self.bricks.y as usize + brick.y as usize) * self.bricks.x as usize
            + brick.x as usize
    }
}
