//! The medium in cubes of a few voxels: means of what it holds and of what it emits, for light that is gathered from all
//! sides.
//!
//! A cube keeps the mean of its emission, not the emission of its means: Planck's law bends so sharply that those differ
//! severalfold at a flame's edge. The means are taken by Gauss's points, so all light that the fire emits is kept, however
//! large the cubes.

use glam::{DVec3, IVec3, UVec3};
use rayon::prelude::*;

use super::lookup::lookup;
use super::preparation::Watch;
use super::tables::Tables;
use crate::math::lanes::{self, Arithmetic, Kernel};
use crate::scene::glow::Source;
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK};
use crate::scene::{Flame, Scene};

/// Floats that are worked on together: one AVX2 register.
pub(super) const WIDE: usize = 8;

/// A part of a cell's record, or what belongs to each number of it.
pub(super) type Chunk = [f32; WIDE];

/// Numbers of a record before those of the colours: the volume fractions of soot and of smoke.
const HEAD: usize = 2;

/// Most panels of two Gauss's points along a cell's edge: one for each voxel of a small cell.
const MOST_PANELS: usize = 2;

/// Light dimmer than this, W m⁻³ sr⁻¹ nm⁻¹, is none: 1e-30 of a flame's, and no product of it is denormal.
const DARK: f32 = 1e-30;

/// What the light of one colour meets: a wavelength of the set, or a part of the radicals' light.
#[derive(Debug, Clone, Copy)]
struct Colour {
    absorption: f32,
    /// Of soot and of smoke, as [`super::tables::Node::scattering`].
    scattering: [f32; 2],
    asymmetry: f32,
    emits: Emits,
}

#[derive(Debug, Clone, Copy)]
enum Emits {
    /// Soot by its heat: Planck's radiance without its exponential, and the exponent times temperature.
    Soot { scale: f32, exponent_k: f32 },
    /// Radicals: W m⁻³ sr⁻¹ where the flame field is 1.
    Radicals(f32),
}

/// The colours of a plan that are carried, in the records' order.
#[derive(Debug, Clone)]
pub(super) struct Colours {
    all: Vec<Colour>,
    /// How many of them are the plan's nodes; the others are radicals.
    pub(super) nodes: usize,
}

impl Colours {
    /// The plan's nodes, then its radicals. The light of a salt's lines and bands is not carried.
    pub(super) fn new(flame: &Flame, tables: &Tables) -> Self {
        let nodes = tables.nodes.iter().map(|node| Colour {
            absorption: node.absorption,
            scattering: node.scattering,
            asymmetry: node.asymmetry,
            emits: Emits::Soot {
                scale: node.planck_scale,
                exponent_k: node.planck_exponent_k,
            },
        });
        let radicals = tables.features.iter().filter_map(|feature| {
            let Source::Radical(emission) = feature.source else {
                return None;
            };
            let nm = feature.lambda_nm;
            Some(Colour {
                absorption: flame.absorption_per_sample(nm) as f32,
                scattering: flame.scattering_per_sample(nm).map(|s| s as f32),
                asymmetry: flame.asymmetry(nm) as f32,
                emits: Emits::Radicals(emission as f32),
            })
        });
        Self {
            all: nodes.chain(radicals).collect(),
            nodes: tables.nodes.len(),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// Chunks of a record.
    pub(super) fn chunks(&self) -> usize {
        (HEAD + self.len()).div_ceil(WIDE)
    }

    /// Where a colour's number stands in a record: chunk, and number in it.
    pub(super) fn place(colour: usize) -> [usize; 2] {
        [(HEAD + colour) / WIDE, (HEAD + colour) % WIDE]
    }

    /// A number for each place of a record; 0 for places that are no colour's.
    fn laid_out(&self, of: impl Fn(&Colour) -> f32) -> Vec<Chunk> {
        let mut laid = vec![[0.0; WIDE]; self.chunks()];
        for (i, colour) in self.all.iter().enumerate() {
            let [chunk, number] = Self::place(i);
            laid[chunk][number] = of(colour);
        }
        laid
    }

    /// Extinction for each unit of soot and of smoke, 1/m.
    pub(super) fn extinction(&self) -> [Vec<Chunk>; 2] {
        [0, 1].map(|kind| self.laid_out(|colour| colour.absorption + colour.scattering[kind]))
    }

    /// Mean cosines of the scattering.
    pub(super) fn asymmetry(&self) -> Vec<Chunk> {
        self.laid_out(|colour| colour.asymmetry)
    }

    /// Scattering coefficient of a colour in a cell, 1/m.
    pub(super) fn scattering(&self, colour: usize, record: &[Chunk]) -> f32 {
        let [soot, smoke] = self.all[colour].scattering;
        soot * record[0][0] + smoke * record[0][1]
    }
}

/// The medium in cells.
#[derive(Debug)]
pub(super) struct Cells {
    /// Edge of a cell, voxels.
    pub(super) edge: usize,
    /// The first cell along each axis; cell c reaches from lattice position c·edge to (c + 1)·edge.
    pub(super) first: [i32; 3],
    /// How many there are along each axis.
    pub(super) size: [usize; 3],
    pub(super) chunks: usize,
    /// A record for each cell, and for a layer of empty ones around them, x fastest: volume fractions of soot and of
    /// smoke, emission coefficient of each colour.
    pub(super) records: Vec<Chunk>,
    /// Whether anything is in it, likewise.
    pub(super) filled: Vec<bool>,
}

impl Cells {
    /// The smallest cells of which there are no more than `most`, a power of two voxels wide. `None` if cancelled.
    pub(super) fn new(
        scene: &Scene,
        colours: &Colours,
        most: usize,
        watch: &Watch<'_>,
    ) -> Option<Self> {
        let medium = scene.flame.medium();
        let [low, high] = hull(medium);
        let mut edge = 1;
        let sides = |edge: i32| {
            let first = low.div_euclid(IVec3::splat(edge));
            let last = (high - 1).div_euclid(IVec3::splat(edge));
            [first, last - first + 1]
        };
        while sides(edge)[1].as_u64vec3().element_product() > most.max(1) as u64 {
            edge *= 2;
        }
        let [first, size] = sides(edge);
        let size = if high.cmpgt(low).all() {
            size.to_array().map(|side| side as usize)
        } else {
            [0; 3]
        };
        let mut cells = Self {
            edge: edge as usize,
            first: first.to_array(),
            size,
            chunks: colours.chunks(),
            records: Vec::new(),
            filled: Vec::new(),
        };
        let padded = cells.strides()[2] * (size[2] + 2);
        cells.records = vec![[0.0; WIDE]; padded * cells.chunks];
        cells.filled = vec![false; padded];
        cells.fill(medium, colours, watch)?;
        Some(cells)
    }

    /// How far apart cells that follow along each axis are stored, in records.
    pub(super) fn strides(&self) -> [usize; 3] {
        let [x, y, _] = self.size;
        [1, x + 2, (x + 2) * (y + 2)]
    }

    /// Where a cell is stored, in records.
    pub(super) fn at(&self, cell: [usize; 3]) -> usize {
        let strides = self.strides();
        (0..3).map(|axis| (cell[axis] + 1) * strides[axis]).sum()
    }

    /// The lattice position of a cell's middle.
    pub(super) fn middle(&self, cell: [usize; 3]) -> DVec3 {
        let middle = |axis: usize| f64::from(self.first[axis]) + cell[axis] as f64 + 0.5;
        self.edge as f64 * DVec3::new(middle(0), middle(1), middle(2))
    }

    /// Takes the means, one layer of cells after another. `None` if cancelled.
    fn fill(&mut self, medium: &Medium, colours: &Colours, watch: &Watch<'_>) -> Option<()> {
        let pieces = watch.pieces(self.size[2]);
        let layer = self.strides()[2];
        let ([x, y, z], chunks, row) = (self.size, self.chunks, self.strides()[1]);
        let (first, edge) = (IVec3::from(self.first), self.edge as i32);
        let layers = self.records.par_chunks_exact_mut((layer * chunks).max(1));
        layers
            .zip(self.filled.par_chunks_exact_mut(layer.max(1)))
            .skip(1)
            .take(z)
            .enumerate()
            .try_for_each(|(k, (records, filled))| {
                pieces.begin()?;
                for (j, i) in (0..y).flat_map(|j| (0..x).map(move |i| (j, i))) {
                    let cell = first + IVec3::new(i as i32, j as i32, k as i32);
                    let at = (j + 1) * row + i + 1;
                    let record = &mut records[at * chunks..(at + 1) * chunks];
                    let mean = Mean {
                        medium,
                        colours,
                        corner: (cell * edge).as_dvec3(),
                        edge: f64::from(edge),
                        record,
                    };
                    filled[at] = mean.may_be_filled() && lanes::dispatch(mean);
                }
                Some(())
            })
    }
}

/// The box of all bricks that hold soot or burning gas, in voxels, min inside, max outside.
fn hull(medium: &Medium) -> [IVec3; 2] {
    let shows = |slot: usize| {
        let own = slot * BRICK_SAMPLES..(slot + 1) * BRICK_SAMPLES;
        let soot = medium.samples[own.clone()]
            .iter()
            .any(|sample| sample[0] > 0.0);
        let flame = medium.flame.get(own);
        soot || flame.is_some_and(|flame| flame.iter().any(|flame| *flame > 0.0))
    };
    let bricks: Vec<bool> = (0..medium.occupancy().0)
        .into_par_iter()
        .map(shows)
        .collect();
    let (mut low, mut high) = (IVec3::MAX, IVec3::MIN);
    for z in 0..medium.bricks.z {
        for y in 0..medium.bricks.y {
            for x in 0..medium.bricks.x {
                let brick = UVec3::new(x, y, z);
                let slot = medium.table[medium.brick_index(brick)];
                if slot != NO_BRICK && bricks[slot as usize] {
                    low = low.min(brick.as_ivec3());
                    high = high.max(brick.as_ivec3() + 1);
                }
            }
        }
    }
    if high.cmple(low).any() {
        return [IVec3::ZERO; 2];
    }
    [low, high].map(|brick| brick * BRICK as i32)
}

/// The mean over one cell.
struct Mean<'a> {
    medium: &'a Medium,
    colours: &'a Colours,
    /// Lattice position of its lowest corner, and its edge in voxels.
    corner: DVec3,
    edge: f64,
    record: &'a mut [Chunk],
}

impl Mean<'_> {
    /// Whether any brick is stored here.
    fn may_be_filled(&self) -> bool {
        let brick = self.corner.as_uvec3() / BRICK as u32;
        self.edge > BRICK as f64
            || (brick.cmplt(self.medium.bricks).all()
                && self.medium.table[self.medium.brick_index(brick)] != NO_BRICK)
    }

    /// Adds what a point holds and emits, with the weight of a point.
    #[inline(always)]
    fn add<A: Arithmetic>(&mut self, position: [f64; 3], weight: f32) -> bool {
        let [all, kelvin, flame, smoke] = lookup::<A, true, true>(self.medium, position);
        if all <= 0.0 && flame <= 0.0 {
            return false;
        }
        self.record[0][0] += weight * (all - smoke);
        self.record[0][1] += weight * smoke;
        let inverse = 1.0 / kelvin;
        for (i, colour) in self.colours.all.iter().enumerate() {
            let emission = match colour.emits {
                Emits::Soot { scale, exponent_k } => {
                    let planck = scale * lanes::inverse_exp_m1_by::<A>(exponent_k * inverse);
                    colour.absorption * all * planck
                }
                Emits::Radicals(emission) => emission * flame,
            };
            let [chunk, number] = Colours::place(i);
            self.record[chunk][number] += if emission > DARK {
                weight * emission
            } else {
                0.0
            };
        }
        true
    }
}

impl Kernel for Mean<'_> {
    /// Whether anything is in it.
    type Output = bool;

    #[inline(always)]
    fn run<A: Arithmetic>(mut self) -> bool {
        let panels = (self.edge as usize).min(MOST_PANELS);
        let (count, panel) = (2 * panels, self.edge / panels as f64);
        let reach = 0.5 * panel / 3.0_f64.sqrt();
        let along = |corner: f64| -> [f64; 2 * MOST_PANELS] {
            std::array::from_fn(|i| {
                let side = if i % 2 == 0 { -reach } else { reach };
                corner + panel * ((i / 2) as f64 + 0.5) + side
            })
        };
        let weight = 1.0 / (count * count * count) as f32;
        let domain = self.medium.domain;
        let [xs, ys, zs] = self.corner.to_array().map(along);
        let mut filled = false;
        for &z in &zs[..count] {
            for &y in &ys[..count] {
                for &x in &xs[..count] {
                    let position = DVec3::new(x, y, z);
                    if position.cmpge(domain.min).all() && position.cmple(domain.max).all() {
                        filled |= self.add::<A>([x, y, z], weight);
                    }
                }
            }
        }
        filled
    }
}
