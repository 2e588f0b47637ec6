//! Emission and absorption along rays: the inner loop.
//!
//! # What is computed
//!
//! The equation of transfer without scattering, dL/ds = −σ_a L + σ_a B(λ, T), from the eye outwards. A ray's
//! chord through the domain is cut into steps of equal length, the last one shorter; a step takes the medium at
//! its middle and adds, for each wavelength,
//!
//! ```text
//! L += t B(λ, T) (1 − e^{−τ}),   t *= e^{−τ},   τ = σ_a(λ) f_v Δs
//! ```
//!
//! which is exact for a constant step and of second order otherwise (Max 1995, with the sign that the report's
//! eq. 4.1 misprints). B / n² is what is conserved along a ray, so the medium's index drops out.
//!
//! # How
//!
//! Sixteen rays of a 4 × 4 block of pixels go side by side, each at its own sample, so a lane's arithmetic
//! depends on its ray alone. Steps are counted from where the ray enters the domain; the bricks without soot
//! are found by a walk over the table of bricks and their steps are jumped over. Sums run in blocks of
//! `FLUSH` samples that are then added to totals, and the transmittance is taken afresh from the summed
//! column at each block's end: ten thousand steps of an f32 sum then lose no more than a few of its last bits.

use crate::math::lanes::{self, Kernel, LANES, Lanes};
use crate::scene::Scene;
use crate::scene::camera::{CameraError, View};
use crate::scene::medium::{BRICK, BRICK_SAMPLES, Medium, NO_BRICK, SAMPLES};

use super::chord::Chord;
use super::film::Pixel;
use super::plan::{MAX_NODES, Node, Plan};

/// Width and height of a packet in rays.
pub const PACKET_SIDE: u32 = 4;
/// Samples between two flushes of the block sums.
const FLUSH: u32 = 16;

const _: () = assert!((PACKET_SIDE * PACKET_SIDE) as usize == LANES);

/// Marches packets of rays for one scene, plan and step.
pub struct Marcher<'a> {
    view: View,
    medium: &'a Medium,
    plan: &'a Plan,
    step_m: f64,
}

impl<'a> Marcher<'a> {
    /// Prepares a march with steps of `step_voxels`.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn new(scene: &'a Scene, plan: &'a Plan, step_voxels: f64) -> Result<Self, CameraError> {
        let medium = scene.flame.medium();
        let step_m = step_voxels * medium.voxel_size_m();
        Ok(Self {
            view: scene.camera.view(plan.size)?,
            medium,
            plan,
            step_m,
        })
    }

    /// Follows the rays through the given points of the picture (pixels from the upper left corner). Returns
    /// what they leave on the film and how many samples of the medium were taken.
    pub fn march(&self, points: &[Option<[f64; 2]>; LANES]) -> ([Pixel; LANES], u64) {
        let mut pixels = [Pixel::default(); LANES];
        let Some(light) = self.follow(points) else {
            return (pixels, 0);
        };

        // The spectrum becomes three numbers here, in f64: the fitted weights have both signs.
        let nodes = &self.plan.nodes;
        for (lane, pixel) in pixels.iter_mut().enumerate() {
            let radiance = light.radiance[..nodes.len()]
                .iter()
                .map(|node| f64::from(node[lane]));
            pixel.xyz = self.plan.wavelengths.xyz_of(radiance).map(|v| v as f32);
            let column = f64::from(light.column_m[lane]);
            let opacity = nodes
                .iter()
                .map(|node| -(-f64::from(node.absorption) * column).exp_m1());
            pixel.opacity = self.plan.wavelengths.opacity_of(opacity).map(|v| v as f32);
        }
        (pixels, light.samples)
    }

    /// Follows the ray through one point of the picture and keeps its spectrum: radiance at each of the plan's nodes,
    /// W m⁻² sr⁻¹ nm⁻¹.
    pub fn radiance(&self, point: [f64; 2]) -> Vec<f64> {
        let mut points = [None; LANES];
        points[0] = Some(point);
        let Some(light) = self.follow(&points) else {
            return vec![0.0; self.plan.nodes.len()];
        };
        let nodes = light.radiance.iter().take(self.plan.nodes.len());
        nodes.map(|node| f64::from(node[0])).collect()
    }

    /// What the rays through these points bring home; `None` if none of them meets soot.
    fn follow(&self, points: &[Option<[f64; 2]>; LANES]) -> Option<Light> {
        let chords: [Option<Chord>; LANES] = std::array::from_fn(|lane| {
            points[lane]
                .and_then(|[x, y]| Chord::new(self.medium, &self.view.ray(x, y), self.step_m))
        });
        if chords.iter().all(Option::is_none) {
            return None;
        }
        let packet = Packet::new(&chords);
        let work = March {
            medium: self.medium,
            nodes: &self.plan.nodes,
            opaque: self.plan.opaque_column_m,
            step_m: self.step_m as f32,
            packet,
        };
        Some(lanes::dispatch(work))
    }
}

/// Rays side by side, with where each is on its way.
struct Packet<'a> {
    start: [[f64; 3]; LANES],
    delta: [[f64; 3]; LANES],
    last: [u32; LANES],
    last_share: Lanes,
    runs: [&'a [[u32; 2]]; LANES],
}

impl<'a> Packet<'a> {
    fn new(chords: &'a [Option<Chord>; LANES]) -> Self {
        let mut packet = Self {
            start: [[0.0; 3]; LANES],
            delta: [[0.0; 3]; LANES],
            last: [0; LANES],
            last_share: [1.0; LANES],
            runs: [&[]; LANES],
        };
        for (lane, chord) in chords.iter().enumerate() {
            let Some(chord) = chord else { continue };
            packet.start[lane] = chord.start;
            packet.delta[lane] = chord.delta;
            packet.last[lane] = chord.last;
            packet.last_share[lane] = chord.last_share;
            packet.runs[lane] = &chord.runs;
        }
        packet
    }
}

/// The work of one packet.
struct March<'a> {
    medium: &'a Medium,
    nodes: &'a [Node],
    opaque: f32,
    step_m: f32,
    packet: Packet<'a>,
}

/// What a packet of rays brings home.
struct Light {
    /// Spectral radiance at each node, W m⁻² sr⁻¹ nm⁻¹.
    radiance: [Lanes; MAX_NODES],
    /// ∫ f_v ds of the medium, m.
    column_m: Lanes,
    samples: u64,
}

impl Kernel for March<'_> {
    type Output = Light;

    #[inline(always)]
    fn run(self) -> Light {
        let nodes = self.nodes;
        let mut light = Light {
            radiance: [[0.0; LANES]; MAX_NODES],
            column_m: [0.0; LANES],
            samples: 0,
        };
        let mut transmittance = [[1.0_f32; LANES]; MAX_NODES];
        let mut block_radiance = [[0.0_f32; LANES]; MAX_NODES];
        let mut block_column = [0.0_f32; LANES];
        let mut run = [0_usize; LANES];
        let mut step: [u32; LANES] =
            std::array::from_fn(|lane| self.packet.runs[lane].first().map_or(0, |first| first[0]));
        let mut done: [bool; LANES] = std::array::from_fn(|lane| self.packet.runs[lane].is_empty());
        let mut since_flush = 0;
        loop {
            // Each ray takes its next sample; those that are through take an empty one.
            let mut column = [0.0_f32; LANES];
            let mut inverse_temperature = [1.0_f32; LANES];
            let mut active = 0;
            for lane in 0..LANES {
                if done[lane] {
                    continue;
                }
                active += 1;
                let share = if step[lane] == self.packet.last[lane] {
                    self.packet.last_share[lane]
                } else {
                    1.0
                };
                let middle = f64::from(step[lane]) + 0.5 * f64::from(share);
                let position: [f64; 3] = std::array::from_fn(|axis| {
                    self.packet.start[lane][axis] + middle * self.packet.delta[lane][axis]
                });
                let [soot, temperature] = lookup(self.medium, position);
                column[lane] = soot * (self.step_m * share);
                inverse_temperature[lane] = 1.0 / temperature;
                (step[lane], run[lane], done[lane]) =
                    advance(self.packet.runs[lane], step[lane], run[lane]);
            }
            if active == 0 {
                break;
            }
            light.samples += active;

            // Each wavelength emits, and is absorbed, over the step.
            for (n, node) in nodes.iter().enumerate() {
                let (transmittance, radiance) = (&mut transmittance[n], &mut block_radiance[n]);
                for lane in 0..LANES {
                    let wien = lanes::exp(-node.planck_exponent_k * inverse_temperature[lane]);
                    let planck = node.planck_scale * wien / (1.0 - wien);
                    let absorbed = -lanes::exp_m1(-node.absorption * column[lane]);
                    let emitted = transmittance[lane] * absorbed;
                    radiance[lane] += planck * emitted;
                    transmittance[lane] -= emitted;
                }
            }
            for lane in 0..LANES {
                block_column[lane] += column[lane];
            }

            since_flush += 1;
            if since_flush == FLUSH {
                since_flush = 0;
                for lane in 0..LANES {
                    light.column_m[lane] += block_column[lane];
                    block_column[lane] = 0.0;
                    done[lane] |= light.column_m[lane] > self.opaque;
                }
                for (n, node) in nodes.iter().enumerate() {
                    for lane in 0..LANES {
                        light.radiance[n][lane] += block_radiance[n][lane];
                        block_radiance[n][lane] = 0.0;
                        transmittance[n][lane] =
                            lanes::exp(-node.absorption * light.column_m[lane]);
                    }
                }
            }
        }
        for lane in 0..LANES {
            light.column_m[lane] += block_column[lane];
            for (total, block) in light.radiance.iter_mut().zip(&block_radiance) {
                total[lane] += block[lane];
            }
        }
        light
    }
}

/// The step after this one, its run, and whether there is none.
#[inline(always)]
fn advance(runs: &[[u32; 2]], step: u32, run: usize) -> (u32, usize, bool) {
    if step + 1 < runs[run][1] {
        (step + 1, run, false)
    } else if let Some(next) = runs.get(run + 1) {
        (next[0], run + 1, false)
    } else {
        (step, run, true)
    }
}

/// Soot volume fraction and temperature at a lattice position, trilinear; clear air where no brick is.
///
/// The position comes in f64: where the temperature changes by hundreds of kelvin in a voxel, the last bit of an
/// f32 coordinate would show in Planck's exponential.
#[inline(always)]
fn lookup(medium: &Medium, position: [f64; 3]) -> [f32; 2] {
    const CLEAR: [f32; 2] = [0.0, 300.0];
    let voxel: [i32; 3] = position.map(|p| p as i32);
    let brick: [u32; 3] = voxel.map(|v| (v as u32) / BRICK as u32);
    if brick[0] >= medium.bricks.x || brick[1] >= medium.bricks.y || brick[2] >= medium.bricks.z {
        return CLEAR;
    }
    let slot = medium.table[medium.brick_index(brick.into())];
    if slot == NO_BRICK {
        return CLEAR;
    }
    let local: [usize; 3] = voxel.map(|v| v as usize % BRICK);
    let fraction: [f32; 3] =
        std::array::from_fn(|axis| (position[axis] - f64::from(voxel[axis])) as f32);
    let first =
        slot as usize * BRICK_SAMPLES + (local[2] * SAMPLES + local[1]) * SAMPLES + local[0];
    // Two neighbours in x, both fields: four floats that lie together.
    let pair = |dy: usize, dz: usize| -> [f32; 4] {
        let at = first + (dz * SAMPLES + dy) * SAMPLES;
        let [a, b] = [medium.samples[at], medium.samples[at + 1]];
        [a[0], a[1], b[0], b[1]]
    };
    let between = |a: [f32; 4], b: [f32; 4], f: f32| -> [f32; 4] {
        std::array::from_fn(|i| a[i] + f * (b[i] - a[i]))
    };
    let near = between(pair(0, 0), pair(1, 0), fraction[1]);
    let far = between(pair(0, 1), pair(1, 1), fraction[1]);
    let [soot_low, hot_low, soot_high, hot_high] = between(near, far, fraction[2]);
    [
        soot_low + fraction[0] * (soot_high - soot_low),
        hot_low + fraction[0] * (hot_high - hot_low),
    ]
}
