//! The medium as the march sees it: soot volume fraction and temperature, side by side in bricks.
//!
//! A brick covers 8³ voxels and stores 9³ samples, its own and the first layer of its upper neighbours, so that
//! the eight corners of any trilinear cell lie in one brick: four loads of four floats. Only bricks with soot
//! in them exist; the table of bricks is dense, an absent brick is [`NO_BRICK`].
//!
//! Positions are in *lattice* coordinates: sample (i, j, k) of the packed box sits at (i, j, k), and the lattice
//! starts on a brick border at or below the first voxel. Values between samples are trilinear in both fields.

use glam::{DAffine3, DVec3, IVec3, UVec3};

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
    /// Bricks along each axis.
    pub(crate) bricks: UVec3,
    /// Index into `samples`, in units of bricks, for each brick, x fastest; [`NO_BRICK`] where there is no soot.
    pub(crate) table: Vec<u32>,
    /// [`BRICK_SAMPLES`] for each stored brick, x fastest.
    pub(crate) samples: Vec<Sample>,
    /// Edge of a voxel in metres: the cube root of its volume.
    pub(crate) voxel_size_m: f64,
    /// Largest soot volume fraction of any sample.
    pub(crate) peak_volume_fraction: f32,
    /// Highest temperature of any sample with soot, K; 0 without soot.
    pub(crate) peak_temperature_k: f32,
}

impl Medium {
    /// Edge of a voxel, m: the cube root of its volume where the voxel is not a cube.
    pub fn voxel_size_m(&self) -> f64 {
        self.voxel_size_m
    }

    /// Largest soot volume fraction of any sample, before the amounts of the scene file.
    pub fn peak_volume_fraction(&self) -> f32 {
        self.peak_volume_fraction
    }

    /// Highest temperature of any sample that holds soot, K; 0 if none does.
    pub fn peak_temperature_k(&self) -> f32 {
        self.peak_temperature_k
    }

    /// How many bricks hold soot, and how many the box has.
    pub fn occupancy(&self) -> (usize, usize) {
        (self.samples.len() / BRICK_SAMPLES, self.table.len())
    }

    /// Memory that the packed fields and their table take, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.samples[..]) + size_of_val(&self.table[..])
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
        let base = position.floor();
        let voxel = base.as_ivec3();
        if voxel.cmplt(IVec3::ZERO).any() {
            return [0.0; 2];
        }
        let brick = voxel.as_uvec3() / BRICK as u32;
        if brick.cmpge(self.bricks).any() {
            return [0.0; 2];
        }
        let slot = self.table[self.brick_index(brick)];
        if slot == NO_BRICK {
            return [0.0; 2];
        }
        let local = (voxel.as_uvec3() % BRICK as u32).as_usizevec3();
        let fraction = position - base;
        let first =
            slot as usize * BRICK_SAMPLES + (local.z * SAMPLES + local.y) * SAMPLES + local.x;
        let mut sum = [0.0; 2];
        for corner in 0..8 {
            let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let weight = [(dx, fraction.x), (dy, fraction.y), (dz, fraction.z)]
                .into_iter()
                .map(|(bit, f)| if bit == 1 { f } else { 1.0 - f })
                .product::<f64>();
            let sample = self.samples[first + (dz * SAMPLES + dy) * SAMPLES + dx];
            sum = [
                sum[0] + weight * f64::from(sample[0]),
                sum[1] + weight * f64::from(sample[1]),
            ];
        }
        sum
    }

    /// Position of a brick in the table.
    pub(crate) fn brick_index(&self, brick: UVec3) -> usize {
        (brick.z as usize * self.bricks.y as usize + brick.y as usize) * self.bricks.x as usize
            + brick.x as usize
    }
}
