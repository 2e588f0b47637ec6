//! The inner loop: sixteen rays side by side through the medium.
//!
//! Each ray is at its own sample, so a lane's arithmetic depends on its ray alone. The bricks without soot are found by
//! [`super::chord`] and their steps are jumped over. Sums run in blocks of `FLUSH` samples that are then added to totals,
//! and the transmittance is taken afresh from the summed column at each block's end: ten thousand steps of an f32 sum
//! then lose no more than a few of its last bits.
//!
//! The loop is compiled for each of what a scene may call for: gas that glows beside soot (`GAS`), light scattered by it
//! (`SCATTER`), rays that are bent (`BEND`). What is off is not in the loop.

use super::chord::Chord;
use super::glow::{GlowLight, MAX_FEATURES, Step};
use super::lookup::lookup;
use super::own_light::own_light;
use super::scatter::InScatter;
use super::tables::{MAX_NODES, Node, Tables};
use crate::math::lanes::{self, Kernel, LANES, Lanes};
use crate::scene::medium::Medium;

/// Samples between two flushes of the block sums.
const FLUSH: u32 = 16;

/// What a packet of rays brings home.
pub(super) struct Light {
    /// Spectral radiance at each node, W m⁻² sr⁻¹ nm⁻¹.
    pub(super) radiance: [Lanes; MAX_NODES],
    /// Radiance of each feature of the gas, W m⁻² sr⁻¹.
    pub(super) glow: [Lanes; MAX_FEATURES],
    /// ∫ f_v ds of the medium, m.
    pub(super) column_m: Lanes,
    /// The part of it that is smoke and scatters as such.
    pub(super) smoke_m: Lanes,
    pub(super) samples: u64,
}

impl Light {
    /// Nothing, through clear air.
    pub(super) fn none() -> Self {
        Self {
            radiance: [[0.0; LANES]; MAX_NODES],
            glow: [[0.0; LANES]; MAX_FEATURES],
            column_m: [0.0; LANES],
            smoke_m: [0.0; LANES],
            samples: 0,
        }
    }
}

/// The work of one packet.
pub(super) struct March<'a> {
    pub(super) medium: &'a Medium,
    pub(super) tables: &'a Tables,
    pub(super) scatter: Option<&'a InScatter>,
    pub(super) step_m: f32,
    pub(super) packet: Packet<'a>,
}

impl March<'_> {
    /// Does it.
    pub(super) fn run(self) -> Light {
        let glows = !self.tables.glow.is_empty();
        match (glows, self.scatter.is_some(), self.packet.is_bent) {
            (false, false, false) => lanes::dispatch(Loop::<false, false, false>(self)),
            (true, false, false) => lanes::dispatch(Loop::<true, false, false>(self)),
            (false, true, false) => lanes::dispatch(Loop::<false, true, false>(self)),
            (true, true, false) => lanes::dispatch(Loop::<true, true, false>(self)),
            (false, false, true) => lanes::dispatch(Loop::<false, false, true>(self)),
            (true, false, true) => lanes::dispatch(Loop::<true, false, true>(self)),
            (false, true, true) => lanes::dispatch(Loop::<false, true, true>(self)),
            (true, true, true) => lanes::dispatch(Loop::<true, true, true>(self)),
        }
    }
}

/// Rays side by side, with where each is on its way.
pub(super) struct Packet<'a> {
    start: [[f64; 3]; LANES],
    delta: [[f64; 3]; LANES],
    last: [u32; LANES],
    last_share: Lanes,
    runs: [&'a [[u32; 2]]; LANES],
    middles: [&'a [[f64; 3]]; LANES],
    is_bent: bool,
}

impl<'a> Packet<'a> {
    pub(super) fn new(chords: [Option<&'a Chord>; LANES]) -> Self {
        let mut packet = Self {
            start: [[0.0; 3]; LANES],
            delta: [[0.0; 3]; LANES],
            last: [0; LANES],
            last_share: [1.0; LANES],
            runs: [&[]; LANES],
            middles: [&[]; LANES],
            is_bent: false,
        };
        for (lane, chord) in chords.into_iter().enumerate() {
            let Some(chord) = chord else { continue };
            packet.start[lane] = chord.start;
            packet.delta[lane] = chord.delta;
            packet.last[lane] = chord.last;
            packet.last_share[lane] = chord.last_share;
            packet.runs[lane] = &chord.runs;
            packet.middles[lane] = &chord.middles;
            packet.is_bent |= !chord.middles.is_empty();
        }
        packet
    }
}

/// The loop, compiled for what is in it.
struct Loop<'a, const GAS: bool, const SCATTER: bool, const BEND: bool>(March<'a>);

/// Light from all sides at the samples of a packet.
type Around = [Lanes; MAX_NODES + MAX_FEATURES];

impl<const GAS: bool, const SCATTER: bool, const BEND: bool> Kernel
    for Loop<'_, GAS, SCATTER, BEND>
{
    type Output = Light;

    #[inline(always)]
    fn run(self) -> Light {
        let Self(march) = self;
        let (nodes, glow_table) = (&march.tables.nodes[..], &march.tables.glow);
        let opaque = march.tables.opaque_column_m;
        let reach_m = march.scatter.map_or(0.0, InScatter::reach_m);
        let mut light = Light::none();
        let mut glow = GlowLight::new();
        let mut around: Around = [[0.0; LANES]; MAX_NODES + MAX_FEATURES];
        let mut transmittance = [[1.0_f32; LANES]; MAX_NODES];
        let mut block_radiance = [[0.0_f32; LANES]; MAX_NODES];
        let mut block_column = [0.0_f32; LANES];
        let mut block_smoke = [0.0_f32; LANES];
        let mut walk = Walk::new(&march.packet);
        let mut since_flush = 0;
        loop {
            let (step, active) = walk.next::<GAS, SCATTER, BEND>(&march, &mut around);
            if active == 0 {
                break;
            }
            light.samples += active;

            // Each wavelength emits, is absorbed and is scattered over the step.
            for (n, node) in nodes.iter().enumerate() {
                let (transmittance, radiance) = (&mut transmittance[n], &mut block_radiance[n]);
                if SCATTER {
                    scattering_step(node, &step, reach_m, &around[n], transmittance, radiance);
                } else {
                    step_of(node, &step, transmittance, radiance);
                }
            }
            for (block, column) in block_column.iter_mut().zip(&step.column) {
                *block += column;
            }
            if SCATTER {
                for (block, smoke) in block_smoke.iter_mut().zip(&step.smoke) {
                    *block += smoke;
                }
            }
            if GAS {
                glow.step::<SCATTER>(glow_table, &step, reach_m, &around[nodes.len()..]);
            }

            since_flush += 1;
            if since_flush == FLUSH {
                since_flush = 0;
                for (lane, block) in block_column.iter_mut().enumerate() {
                    light.column_m[lane] += std::mem::take(block);
                    walk.done[lane] |= light.column_m[lane] > opaque;
                }
                if SCATTER {
                    for (total, block) in light.smoke_m.iter_mut().zip(&mut block_smoke) {
                        *total += std::mem::take(block);
                    }
                }
                for (n, node) in nodes.iter().enumerate() {
                    for lane in 0..LANES {
                        light.radiance[n][lane] += block_radiance[n][lane];
                        block_radiance[n][lane] = 0.0;
                        let depth = if SCATTER {
                            let [all, smoke] = node.extinction();
                            all * light.column_m[lane] + smoke * light.smoke_m[lane]
                        } else {
                            node.absorption * light.column_m[lane]
                        };
                        transmittance[n][lane] = lanes::exp(-depth);
                    }
                }
                if GAS {
                    glow.flush::<SCATTER>(glow_table, [&light.column_m, &light.smoke_m]);
                }
            }
        }
        for lane in 0..LANES {
            light.column_m[lane] += block_column[lane];
            light.smoke_m[lane] += block_smoke[lane];
            for (total, block) in light.radiance.iter_mut().zip(&block_radiance) {
                total[lane] += block[lane];
            }
        }
        if GAS {
            glow.flush::<SCATTER>(glow_table, [&light.column_m, &light.smoke_m]);
            light.glow = glow.total;
        }
        light
    }
}

/// A step of one wavelength without scattering: L += t B (1 − e^{−τ}).
#[inline(always)]
fn step_of(node: &Node, step: &Step, transmittance: &mut Lanes, radiance: &mut Lanes) {
    for lane in 0..LANES {
        let wien = lanes::exp(-node.planck_exponent_k * step.inverse_temperature[lane]);
        let planck = node.planck_scale * wien / (1.0 - wien);
        let absorbed = -lanes::exp_m1(-node.absorption * step.column[lane]);
        let emitted = transmittance[lane] * absorbed;
        radiance[lane] += planck * emitted;
        transmittance[lane] -= emitted;
    }
}

/// The same with scattering: L += t (σ_a B + σ_s J) Δs φ₁(τ), where τ is that of all extinction.
#[inline(always)]
fn scattering_step(
    node: &Node,
    step: &Step,
    reach_m: f32,
    around: &Lanes,
    transmittance: &mut Lanes,
    radiance: &mut Lanes,
) {
    let [by_soot, by_smoke] = node.scattering;
    for lane in 0..LANES {
        let wien = lanes::exp(-node.planck_exponent_k * step.inverse_temperature[lane]);
        let planck = node.planck_scale * wien / (1.0 - wien);
        let (column, smoke) = (step.column[lane], step.smoke[lane]);
        let absorbing = node.absorption * column;
        let scattering = by_soot * (column - smoke) + by_smoke * smoke;
        let tau = absorbing + scattering;
        let taken = -lanes::exp_m1(-tau);
        let phi = if tau > 1e-12 { taken / tau } else { 1.0 };
        let emitted = absorbing * planck;
        let own = own_light(emitted, tau, step.length[lane], reach_m);
        let source = emitted + scattering * (around[lane] + own).max(0.0);
        radiance[lane] += transmittance[lane] * source * phi;
        transmittance[lane] -= transmittance[lane] * taken;
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
    fn next<const GAS: bool, const SCATTER: bool, const BEND: bool>(
        &mut self,
        march: &March<'_>,
        around: &mut Around,
    ) -> (Step, u64) {
        let packet = &march.packet;
        let mut taken = Step {
            column: [0.0; LANES],
            smoke: [0.0; LANES],
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
            let position: [f64; 3] = if BEND && !packet.middles[lane].is_empty() {
                packet.middles[lane][self.step[lane] as usize]
            } else {
                let middle = f64::from(self.step[lane]) + 0.5 * f64::from(share);
                std::array::from_fn(|axis| {
                    packet.start[lane][axis] + middle * packet.delta[lane][axis]
                })
            };
            let [soot, temperature, burning, smoke] =
                lookup::<GAS, SCATTER>(march.medium, position);
            let length = march.step_m * share;
            taken.column[lane] = soot * length;
            taken.inverse_temperature[lane] = 1.0 / temperature;
            taken.length[lane] = length;
            if GAS {
                taken.flame[lane] = burning;
            }
            if SCATTER {
                taken.smoke[lane] = smoke * length;
                if let Some(scatter) = march.scatter {
                    scatter.read(position, lane, &mut around[..march.tables.channels()]);
                }
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
