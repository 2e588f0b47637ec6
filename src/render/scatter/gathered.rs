//! The light of all directions, one after the other, as the cells take it: each by its own phase function towards the eye.

use glam::DVec3;
use rayon::prelude::*;

use crate::math::lanes::{self, Arithmetic, Kernel};
use crate::render::cells::{Cells, Chunk, Colours, WIDE};
use crate::render::sweep::Sweep;
use crate::scene::Scene;

/// What the cells have received.
pub(super) struct Gathered<'a> {
    pub(super) cells: &'a Cells,
    /// Edge of a cell, m.
    pub(super) edge_m: f64,
    lobe: Lobe,
    /// The direction to the eye from each cell whose J can be asked for; zero for the others.
    pub(super) to_eye: Vec<[f32; 3]>,
    pub(super) light: Vec<Chunk>,
    /// The colour whose light is counted from all sides alike, and that sum over the directions.
    luminous: usize,
    sum: Vec<f32>,
}

/// Phase functions of a record's colours.
#[derive(Debug, Clone)]
struct Lobe {
    /// (1 − g)(1 + g).
    scale: Vec<Chunk>,
    /// (1 − |g|)², 2|g| and the sign of g: D of [`crate::physics::phase`] is the first and the second times 1 ∓ cos θ.
    least: Vec<Chunk>,
    growth: Vec<Chunk>,
    sign: Vec<Chunk>,
}

impl Lobe {
    fn new(asymmetry: &[Chunk]) -> Self {
        let of = |value: fn(f32) -> f32| {
            let chunks = asymmetry.iter();
            chunks.map(|chunk| chunk.map(value)).collect()
        };
        Self {
            scale: of(|g| (1.0 - g) * (1.0 + g)),
            least: of(|g| (1.0 - g.abs()) * (1.0 - g.abs())),
            growth: of(|g| 2.0 * g.abs()),
            sign: of(f32::signum),
        }
    }

    /// 4π Φ of a chunk's colours.
    #[inline(always)]
    fn value(&self, chunk: usize, cosine: f32) -> Chunk {
        let mut value = [0.0; WIDE];
        let (scale, least) = (&self.scale[chunk], &self.least[chunk]);
        let (growth, sign) = (&self.growth[chunk], &self.sign[chunk]);
        for i in 0..WIDE {
            let d = least[i] + growth[i] * (1.0 - sign[i] * cosine);
            value[i] = scale[i] / (d * d.sqrt());
        }
        value
    }
}

impl<'a> Gathered<'a> {
    pub(super) fn new(
        scene: &Scene,
        cells: &'a Cells,
        asymmetry: &[Chunk],
        luminous: usize,
    ) -> Self {
        let [x, y, z] = cells.size;
        let world_from_lattice = scene.flame.medium().lattice_from_world.inverse();
        let strides = cells.strides();
        let to_eye = |i: usize| {
            let cell = [i % x, i / x % y, i / x / y];
            // J is asked for in a cell with soot or beside one.
            let beside = (0..27).any(|i| {
                let step = [i % 3, i / 3 % 3, i / 9];
                let low = cells.at(cell) - strides.iter().sum::<usize>();
                let at = low + (0..3).map(|axis| step[axis] * strides[axis]).sum::<usize>();
                let record = cells.records[at * cells.chunks];
                record[0] + record[1] > 0.0
            });
            let towards =
                scene.camera.eye - world_from_lattice.transform_point3(cells.middle(cell));
            let towards = towards.try_normalize().unwrap_or(DVec3::Z);
            if beside {
                towards.as_vec3().to_array()
            } else {
                [0.0; 3]
            }
        };
        let count = x * y * z;
        Self {
            cells,
            edge_m: cells.edge as f64 * scene.flame.medium().voxel_size_m(),
            lobe: Lobe::new(asymmetry),
            to_eye: (0..count).into_par_iter().map(to_eye).collect(),
            light: vec![[0.0; WIDE]; count * cells.chunks],
            luminous,
            sum: vec![0.0; count],
        }
    }

    /// The same before any light came, for other cells of the same size.
    pub(super) fn emptied<'b>(&self, cells: &'b Cells) -> Gathered<'b> {
        Gathered {
            cells,
            edge_m: self.edge_m,
            lobe: self.lobe.clone(),
            to_eye: self.to_eye.clone(),
            light: vec![[0.0; WIDE]; self.light.len()],
            luminous: self.luminous,
            sum: vec![0.0; self.sum.len()],
        }
    }

    /// The colour by which light is counted.
    pub(super) fn luminous(&self) -> usize {
        self.luminous
    }

    /// Adds the light of one direction.
    pub(super) fn take(&mut self, sweep: &Sweep<'_>, light: &[Chunk], direction: DVec3) {
        let [x, y, _] = self.cells.size;
        let layer = (x * y).max(1);
        self.light
            .par_chunks_exact_mut(layer * self.cells.chunks)
            .zip(self.sum.par_chunks_exact_mut(layer))
            .zip(self.to_eye.par_chunks_exact(layer))
            .enumerate()
            .for_each(|(z, ((own, sum), to_eye))| {
                lanes::dispatch(Take {
                    sweep,
                    light,
                    direction: direction.as_vec3().to_array(),
                    lobe: &self.lobe,
                    luminous: Colours::place(self.luminous),
                    z,
                    row: x,
                    own,
                    sum,
                    to_eye,
                });
            });
    }

    /// Divides by the sums of the weights.
    pub(super) fn normalise(&mut self, directions: &[DVec3]) {
        let directions: Vec<[f32; 3]> = directions.iter().map(|d| d.as_vec3().to_array()).collect();
        let lobe = &self.lobe;
        self.light
            .par_chunks_exact_mut(self.cells.chunks)
            .zip(&self.to_eye)
            .filter(|(_, to_eye)| **to_eye != [0.0; 3])
            .for_each(|(light, &to_eye)| {
                lanes::dispatch(Normalise {
                    lobe,
                    directions: &directions,
                    to_eye,
                    light,
                });
            });
    }

    /// p of the module's page.
    pub(super) fn share(&self, colours: &Colours, directions: usize) -> f64 {
        if colours.len() == 0 {
            return 0.0;
        }
        let [x, y, _] = self.cells.size;
        let [chunk, number] = Colours::place(self.luminous);
        let (mut scattered, mut emitted) = (0.0, 0.0);
        for (i, sum) in self.sum.iter().enumerate() {
            let at = self.cells.at([i % x, i / x % y, i / x / y]) * self.cells.chunks;
            let record = &self.cells.records[at..at + self.cells.chunks];
            // φ over 4π: the mean over the directions.
            let mean = f64::from(*sum) / directions as f64;
            scattered += f64::from(colours.scattering(self.luminous, record)) * mean;
            emitted += f64::from(record[chunk][number]);
        }
        if emitted > 0.0 {
            scattered / emitted
        } else {
            0.0
        }
    }
}

#[inline(always)]
fn cosine(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// One direction's light for one layer of cells.
struct Take<'a, 'b> {
    sweep: &'a Sweep<'a>,
    light: &'a [Chunk],
    direction: [f32; 3],
    lobe: &'a Lobe,
    luminous: [usize; 2],
    z: usize,
    row: usize,
    own: &'b mut [Chunk],
    sum: &'b mut [f32],
    to_eye: &'a [[f32; 3]],
}

impl Kernel for Take<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        let chunks = self.own.len() / self.sum.len().max(1);
        for (i, &to_eye) in self.to_eye.iter().enumerate() {
            if to_eye == [0.0; 3] {
                continue;
            }
            let cell = [i % self.row, i / self.row, self.z];
            let (four, weights) = self.sweep.rays_at(cell);
            let cosine = cosine(self.direction, to_eye);
            for chunk in 0..chunks {
                let phase = self.lobe.value(chunk, cosine);
                let taps = four.map(|first| &self.light[first + chunk]);
                let mut found = [0.0; WIDE];
                let own = &mut self.own[i * chunks + chunk];
                for k in 0..WIDE {
                    found[k] = (weights[0] * taps[0][k] + weights[1] * taps[1][k])
                        + (weights[2] * taps[2][k] + weights[3] * taps[3][k]);
                    own[k] += phase[k] * found[k];
                }
                if chunk == self.luminous[0] {
                    self.sum[i] += found[self.luminous[1]];
                }
            }
        }
    }
}

/// The division for one cell.
struct Normalise<'a, 'b> {
    lobe: &'a Lobe,
    directions: &'a [[f32; 3]],
    to_eye: [f32; 3],
    light: &'b mut [Chunk],
}

impl Kernel for Normalise<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        for (chunk, light) in self.light.iter_mut().enumerate() {
            let mut sum = [0.0; WIDE];
            for &direction in self.directions {
                let value = self.lobe.value(chunk, cosine(direction, self.to_eye));
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += value;
                }
            }
            for (light, sum) in light.iter_mut().zip(sum) {
                *light /= sum;
            }
        }
    }
}
