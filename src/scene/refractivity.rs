//! The refractive index of a flame's gas, place by place.
//!
//! ```text
//! n − 1 = N(T′, λ),   ∇(n − 1) by central differences between samples
//! T′ = T_air                                                        for T ≤ T_clear
//! T′ = T_air + (T − T_clear)(T_peak − T_air)/(T_peak − T_clear)     above, where T_clear > T_air + 1 K
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | N | index less 1 of the fire's gas, see [`crate::physics::hot_gas`] | 1 |
//! | T | temperature in the file, after its mapping | K |
//! | T_air | temperature of the air around | K |
//! | T_clear | what the file's mapping makes of gas of which the file says nothing | K |
//! | T_peak | hottest gas of the file | K |
//!
//! Some producers give heat without its zero: EmberGen's preset makes 1300 K of a raw 0, in all of its box. Such a box
//! would be a lens. So gas as cool as T_clear counts as air, and what is hotter is stretched to reach from the air's
//! temperature to the file's peak. Other files' T′ is T.
//!
//! What is kept is n − 1 less that of the air around, never n: in f32 an n of 1.0002 has three digits. Gradients are
//! trilinear between samples, so they are continuous and a bent picture is smooth; the faces of voxels are no mirrors.
//! Where a neighbour lies outside of the data the difference is taken to one side: where a file's box cuts hot gas off
//! there is no lens, only no more gas. Where no brick is there is air.
//!
//! **Validity.** That of the law; see [`crate::scene::Air::products_share`] for what the gas is made of.

use glam::{DVec3, UVec3};
use rayon::prelude::*;

use super::air::Air;
use super::flame::{BentAir, Flame};
use super::fuel::Fuel;
use super::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};
use crate::physics::hot_gas::FireGas;
use crate::physics::moist_air::{AirError, Dispersion};

/// Vacuum wavelengths whose paths the light of X, Y and Z takes where colours are bent differently, nm: the means over
/// the observer's x̄, ȳ, z̄ in daylight, Σ λ x̄ S / Σ x̄ S with S of illuminant D65. Over the eye's range n − 1 is
/// nearly straight in λ, so each lands where the middle of its own light does. x̄ has a second lobe in the blue: its mean
/// is no red.
pub const PATHS_NM: [f64; 3] = [566.8, 556.8, 455.6];

/// Vacuum wavelength of the path where all colours take the same, nm: that of Y.
pub const COMMON_PATH_NM: f64 = PATHS_NM[1];

/// By how much T_clear must exceed the air's temperature to say that a file's heat has no zero, K: less is a background
/// that was set by hand to much the same.
const STRETCHED_ABOVE_K: f64 = 1.0;

/// n − 1 and its gradient in the bricks of a medium: for one flame, at one wavelength.
#[derive(Debug)]
pub struct Refractivity {
    /// n − 1 of the air around.
    ambient: f64,
    /// For each sample of the medium: n less that of the air around, and ∇n in the frame of the world, 1/m; both times
    /// the gain.
    samples: Vec<[f32; 4]>,
}

impl Refractivity {
    /// The gas of a flame for light of a vacuum wavelength (nm), in the calling thread's rayon pool. `None` where the
    /// flame bends no light: it is not to be computed, no law says how, or no gas differs from the air.
    pub fn new(flame: &Flame, lambda_nm: f64) -> Option<Self> {
        let medium = flame.medium();
        let bent = flame.bending()?;
        let law = Law::new(bent, peak_k(medium), lambda_nm).ok()?;
        let gain = bent.bending.gain;
        let excess: Vec<f64> = medium
            .samples
            .par_iter()
            .map(|sample| gain * law.excess(f64::from(sample[1])))
            .collect();
        if excess.iter().all(|excess| *excess == 0.0) {
            return None;
        }
        let mut samples = vec![[0.0; 4]; excess.len()];
        samples
            .par_chunks_exact_mut(BRICK_SAMPLES)
            .zip(places(medium))
            .for_each(|(samples, brick)| Stencil::new(medium, &excess, brick).fill(samples));
        Some(Self {
            ambient: law.ambient,
            samples,
        })
    }

    /// n − 1 of the air around.
    pub fn ambient(&self) -> f64 {
        self.ambient
    }

    /// Memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.samples[..])
    }

    /// At a lattice position of the medium that it was made of, in its domain: n less that of the air around, and ∇n in the frame of the
    /// world, 1/m; both times the gain. Trilinear; zero where no brick is.
    #[inline(always)]
    pub fn at(&self, medium: &Medium, position: [f64; 3]) -> [f32; 4] {
        let voxel: [i32; 3] = position.map(|p| p as i32);
        let Some(slot) = stored(medium, voxel) else {
            return [0.0; 4];
        };
        let [x, y, z] = voxel.map(|v| v as usize % BRICK);
        let first = slot as usize * BRICK_SAMPLES + (z * SAMPLES + y) * SAMPLES + x;
        // One border of the array for all eight corners.
        let cell = &self.samples[first..=first + LAST_CORNER];
        let f: [f32; 3] =
            std::array::from_fn(|axis| (position[axis] - f64::from(voxel[axis])) as f32);
        let edge = |at: usize| between(cell[at], cell[at + 1], f[0]);
        let near = between(edge(0), edge(SAMPLES), f[1]);
        let far = between(edge(LAYER), edge(LAYER + SAMPLES), f[1]);
        between(near, far, f[2])
    }
}

/// Samples from one layer of a brick to the next, and to the last corner of a cell.
const LAYER: usize = SAMPLES * SAMPLES;
const LAST_CORNER: usize = LAYER + SAMPLES + 1;

#[inline(always)]
fn between(a: [f32; 4], b: [f32; 4], f: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + f * (b[i] - a[i]))
}

/// The slot of the brick that a voxel lies in, if it is stored.
#[inline(always)]
pub(crate) fn stored(medium: &Medium, voxel: [i32; 3]) -> Option<u32> {
    // Below the lattice the index wraps to a brick that no table has.
    let brick: [u32; 3] = voxel.map(|v| v as u32 / BRICK as u32);
    if brick[0] >= medium.bricks.x || brick[1] >= medium.bricks.y || brick[2] >= medium.bricks.z {
        return None;
    }
    let slot = medium.table[medium.brick_index(brick.into())];
    (slot != NO_BRICK).then_some(slot)
}

/// How n depends on temperature in one flame.
struct Law {
    gas: FireGas,
    dispersion: Dispersion,
    air: Air,
    fuel: Fuel,
    /// T_clear and T_peak, where the file's heat is stretched.
    stretched: Option<[f64; 2]>,
    /// n − 1 of the air around.
    ambient: f64,
}

impl Law {
    fn new(bent: &BentAir, peak_k: f64, lambda_nm: f64) -> Result<Self, AirError> {
        let BentAir {
            air, fuel, clear_k, ..
        } = *bent;
        let gas = air.gas(fuel)?;
        let dispersion = Dispersion::at(lambda_nm)?;
        Ok(Self {
            gas,
            dispersion,
            air,
            fuel,
            stretched: (clear_k > air.temperature_k + STRETCHED_ABOVE_K)
                .then_some([clear_k, peak_k]),
            ambient: gas.refractivity(dispersion, air.temperature_k, 0.0),
        })
    }

    /// n at a temperature of the file, less that of the air around.
    fn excess(&self, file_k: f64) -> f64 {
        let air_k = self.air.temperature_k;
        let kelvin = match self.stretched {
            None => file_k,
            Some([clear_k, _]) if file_k <= clear_k => air_k,
            Some([clear_k, peak_k]) => {
                air_k + (file_k - clear_k) * (peak_k - air_k) / (peak_k - clear_k)
            }
        };
        // Most gas of a box is air, exactly.
        if kelvin == air_k {
            return 0.0;
        }
        let products = self.air.products_share(self.fuel, kelvin);
        self.gas.refractivity(self.dispersion, kelvin, products) - self.ambient
    }
}

/// Temperature of the hottest sample that is stored, K. Not that of the medium's peaks: they pass clear gas over.
fn peak_k(medium: &Medium) -> f64 {
    let hottest = medium.samples.par_iter().map(|sample| sample[1]);
    f64::from(hottest.reduce(|| 0.0, f32::max))
}

/// Where the stored bricks lie, in the order in which they are stored.
fn places(medium: &Medium) -> Vec<UVec3> {
    let mut places = vec![UVec3::ZERO; medium.occupancy().0];
    let [width, height, _] = medium.bricks.to_array();
    for (i, &slot) in (0_u32..).zip(&medium.table) {
        if slot != NO_BRICK {
            places[slot as usize] = UVec3::new(i % width, i / width % height, i / width / height);
        }
    }
    places
}

/// A brick's samples of n with those around, and how differences between them become gradients.
struct Stencil<'a> {
    medium: &'a Medium,
    excess: &'a [f64],
    /// First sample of the brick in the lattice.
    origin: [i32; 3],
    /// First sample of the brick, and of those below and above along each axis, if they are stored.
    own: usize,
    beside: [[Option<usize>; 2]; 3],
}

impl<'a> Stencil<'a> {
    fn new(medium: &'a Medium, excess: &'a [f64], brick: UVec3) -> Self {
        let origin = (brick.as_ivec3() * BRICK as i32).to_array();
        let first = |step: i32, axis: usize| {
            let mut voxel = origin;
            voxel[axis] += step * BRICK as i32;
            stored(medium, voxel).map(|slot| slot as usize * BRICK_SAMPLES)
        };
        Self {
            medium,
            excess,
            origin,
            own: first(0, 0).unwrap_or(0),
            beside: std::array::from_fn(|axis| [first(-1, axis), first(1, axis)]),
        }
    }

    fn fill(&self, samples: &mut [[f32; 4]]) {
        // World gradients are those of the lattice through the transposed map.
        let world_from_lattice = self.medium.lattice_from_world.matrix3.transpose();
        for (i, sample) in samples.iter_mut().enumerate() {
            let place = [i % SAMPLES, i / SAMPLES % SAMPLES, i / LAYER];
            let slopes = std::array::from_fn(|axis| self.slope(i, place[axis], axis));
            let gradient = world_from_lattice * DVec3::from_array(slopes);
            *sample = [
                self.excess[self.own + i],
                gradient.x,
                gradient.y,
                gradient.z,
            ]
            .map(|value| value as f32);
        }
    }

    /// Change of n for a voxel along an axis at sample `i` of the brick, whose place along the axis is `at`. Where the
    /// file's box cuts through hot gas, the cut is in the data and not in the gas: it bends nothing.
    fn slope(&self, i: usize, at: usize, axis: usize) -> f64 {
        const STRIDES: [usize; 3] = [1, SAMPLES, LAYER];
        let stride = STRIDES[axis];
        let air = 0.0;
        let (min, max) = (self.medium.data.min[axis], self.medium.data.max[axis]);
        let coordinate = f64::from(self.origin[axis]) + at as f64;
        if coordinate < min || coordinate > max {
            return 0.0;
        }
        let below = if coordinate - 1.0 < min {
            None
        } else if at > 0 {
            Some(self.excess[self.own + i - stride])
        } else {
            // The layer before a brick's first is the last but one of the brick below.
            let read = |first: usize| self.excess[first + i + (BRICK - 1) * stride];
            Some(self.beside[axis][0].map_or(air, read))
        };
        let above = if coordinate + 1.0 > max {
            None
        } else if at < BRICK {
            Some(self.excess[self.own + i + stride])
        } else {
            let read = |first: usize| self.excess[first + i - (BRICK - 1) * stride];
            Some(self.beside[axis][1].map_or(air, read))
        };
        let here = self.excess[self.own + i];
        match (below, above) {
            (Some(below), Some(above)) => 0.5 * (above - below),
            (Some(below), None) => here - below,
            (None, Some(above)) => above - here,
            (None, None) => 0.0,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
