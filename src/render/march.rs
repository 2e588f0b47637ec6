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
//! eq. 4.1 misprints). B / n² is what is conserved along a ray, so the medium's index drops out. What gas adds beside
//! soot is in `glow`.
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
use crate::scene::medium::Medium;

use super::chord::Chord;
use super::film::Pixel;
use super::glow::{GlowLight, GlowTable, MAX_FEATURES, Step};
use super::lookup::lookup;
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
        let (nodes, glow) = (&self.plan.nodes, &self.plan.glow);
        for (lane, pixel) in pixels.iter_mut().enumerate() {
            let lane_of = |light: &Lanes| f64::from(light[lane]);
            let soot = self
                .plan
                .wavelengths
                .xyz_of(light.radiance[..nodes.len()].iter().map(lane_of));
            let gas = glow.xyz_of(light.glow.iter().map(lane_of));
            pixel.xyz = std::array::from_fn(|c| (soot[c] + gas[c]) as f32);
            let column = f64::from(light.column_m[lane]);
            let opacity = nodes
                .iter()
                .map(|node| -(-f64::from(node.absorption) * column).exp_m1());
            pixel.opacity = self.plan.wavelengths.opacity_of(opacity).map(|v| v as f32);
        }
        (pixels, light.samples)
    }

    /// Follows the ray through one point of the picture and keeps its spectrum: radiance at each of the plan's nodes,
    /// W m⁻² sr⁻¹ nm⁻¹, and what each feature of its gas adds, W m⁻² sr⁻¹.
    pub fn radiance(&self, point: [f64; 2]) -> [Vec<f64>; 2] {
        let mut points = [None; LANES];
        points[0] = Some(point);
        let counts = [self.plan.nodes.len(), self.plan.glow.len()];
        let Some(light) = self.follow(&points) else {
            return counts.map(|count| vec![0.0; count]);
        };
        let first = |lanes: &[Lanes], count: usize| {
            let lanes = lanes.iter().take(count);
            lanes.map(|lane| f64::from(lane[0])).collect()
        };
        [
            first(&light.radiance, counts[0]),
            first(&light.glow, counts[1]),
        ]
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
        // What does not glow must not cost.
        Some(if self.plan.glow.is_empty() {
            lanes::dispatch(self.work::<false>(packet))
        } else {
            lanes::dispatch(self.work::<true>(packet))
        })
    }

    fn work<'b, const GAS: bool>(&'b self, packet: Packet<'b>) -> March<'b, GAS> {
        March {
            medium: self.medium,
            nodes: &self.plan.nodes,
            glow: &self.plan.glow,
            opaque: self.plan.opaque_column_m,
            step_m: self.step_m as f32,
            packet,
        }
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

/// The work of one packet, with gas that glows beside soot or without.
struct March<'a, const GAS: bool> {
    medium: &'a Medium,
    nodes: &'a [Node],
    glow: &'a GlowTable,
    opaque: f32,
    step_m: f32,
    packet: Packet<'a>,
}

/// What a packet of rays brings home.
struct Light {
    /// Spectral radiance at each node, W m⁻² sr⁻¹ nm⁻¹.
    radiance: [Lanes; MAX_NODES],
    /// Radiance of each feature of the gas, W m⁻² sr⁻¹.
    glow: [Lanes; MAX_FEATURES],
    /// ∫ f_v ds of the medium, m.
    column_m: Lanes,
    samples: u64,
}

impl<const GAS: bool> Kernel for March<'_, GAS> {
    type Output = Light;

    #[inline(always)]
    fn run(self) -> Light {
        let nodes = self.nodes;
        let mut light = Light {
            radiance: [[0.0; LANES]; MAX_NODES],
            glow: [[0.0; LANES]; MAX_FEATURES],
            column_m: [0.0; LANES],
            samples: 0,
        };
        let mut glow = GlowLight::new();
        let mut transmittance = [[1.0_f32; LANES]; MAX_NODES];
        let mut block_radiance = [[0.0_f32; LANES]; MAX_NODES];
        let mut block_column = [0.0_f32; LANES];
        let mut walk = Walk::new(&self.packet);
        let mut since_flush = 0;
        loop {
            let (step, active) = walk.next::<GAS>(&self);
            if active == 0 {
                break;
            }
            light.samples += active;

            // Each wavelength emits, and is absorbed, over the step.
            for (n, node) in nodes.iter().enumerate() {
                let (transmittance, radiance) = (&mut transmittance[n], &mut block_radiance[n]);
                for lane in 0..LANES {
                    let wien = lanes::exp(-node.planck_exponent_k * step.inverse_temperature[lane]);
                    let planck = node.planck_scale * wien / (1.0 - wien);
                    let absorbed = -lanes::exp_m1(-node.absorption * step.column[lane]);
                    let emitted = transmittance[lane] * absorbed;
                    radiance[lane] += planck * emitted;
                    transmittance[lane] -= emitted;
                }
            }
            for (block, column) in block_column.iter_mut().zip(&step.column) {
                *block += column;
            }
            if GAS {
                glow.step(self.glow, &step);
            }

            since_flush += 1;
            if since_flush == FLUSH {
                since_flush = 0;
                for (lane, block) in block_column.iter_mut().enumerate() {
                    light.column_m[lane] += std::mem::take(block);
                    walk.done[lane] |= light.column_m[lane] > self.opaque;
                }
                for (n, node) in nodes.iter().enumerate() {
                    for lane in 0..LANES {
                        light.radiance[n][lane] += block_radiance[n][lane];
                        block_radiance[n][lane] = 0.0;
                        transmittance[n][lane] =
                            lanes::exp(-node.absorption * light.column_m[lane]);
                    }
                }
                if GAS {
                    glow.flush(self.glow, &light.column_m);
                }
            }
        }
        for lane in 0..LANES {
            light.column_m[lane] += block_column[lane];
            for (total, block) in light.radiance.iter_mut().zip(&block_radiance) {
                total[lane] += block[lane];
            }
        }
        if GAS {
            glow.flush(self.glow, &light.column_m);
            light.glow = glow.total;
        }
        light
    }
}

/// Where each ray of a packet is on its way.
struct Walk {
    /// Which of its runs, and which step.
    run: [usize; LANES],
    step: [u32; LANES],
    done: [bool; LANES],
}

impl Walk {
    #[inline(always)]
    fn new(packet: &Packet<'_>) -> Self {
        Self {
            run: [0; LANES],
            step: std::array::from_fn(|lane| packet.runs[lane].first().map_or(0, |first| first[0])),
            done: std::array::from_fn(|lane| packet.runs[lane].is_empty()),
        }
    }

    /// Each ray takes its next sample; those that are through take an empty one. Also how many took one.
    #[inline(always)]
    fn next<const GAS: bool>(&mut self, march: &March<'_, GAS>) -> (Step, u64) {
        let packet = &march.packet;
        let mut taken = Step {
            column: [0.0; LANES],
            inverse_temperature: [1.0; LANES],
            flame: [0.0; LANES],
            length: [0.0; LANES],
        };
        let mut active = 0;
        for lane in 0..LANES {
            if self.done[lane] {
                continue;
            }
            active += 1;
            let share = if self.step[lane] == packet.last[lane] {
                packet.last_share[lane]
            } else {
                1.0
            };
            let middle = f64::from(self.step[lane]) + 0.5 * f64::from(share);
            let position: [f64; 3] = std::array::from_fn(|axis| {
                packet.start[lane][axis] + middle * packet.delta[lane][axis]
            });
            let [soot, temperature, burning, _] = lookup::<GAS, false>(march.medium, position);
            taken.column[lane] = soot * (march.step_m * share);
            taken.inverse_temperature[lane] = 1.0 / temperature;
            if GAS {
                (taken.flame[lane], taken.length[lane]) = (burning, march.step_m * share);
            }
            (self.step[lane], self.run[lane], self.done[lane]) =
                advance(packet.runs[lane], self.step[lane], self.run[lane]);
        }
        (taken, active)
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
