//! The inner loop: sixteen rays side by side through the medium.
//!
//! Each ray is at its own sample, so a lane's arithmetic depends on its ray alone. The bricks without soot are found by
//! [`super::chord`] and their steps are jumped over. Sums run in blocks of `FLUSH` samples that are then added to totals,
//! where what a total cannot hold goes into the next block, and the transmittance is taken afresh from the summed column
//! at each block's end: a million steps of an f32 sum then lose no more than a few of its last bits.
//!
//! The loop is compiled for each of what a scene may call for: gas that glows beside soot (`GAS`), light scattered by it
//! (`SCATTER`), rays that are bent (`BEND`). What is off is not in the loop.

use super::glow::{GlowLight, MAX_FEATURES, Step};
use super::own_light::own_light;
use super::scatter::InScatter;
use super::spans::{Packet, Walk};
use super::tables::{Node, Tables};
use crate::math::lanes::{self, Kernel, LANES, Lanes};
use crate::scene::medium::Medium;

/// Samples between two flushes of the block sums.
const FLUSH: u32 = 16;

/// What a packet of rays brings home.
pub(super) struct Light {
    /// Spectral radiance at each node, W m⁻² sr⁻¹ nm⁻¹; as many as are carried, for of those that might be most are not.
    pub(super) radiance: Vec<Lanes>,
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
    pub(super) fn none(nodes: usize) -> Self {
        Self {
            radiance: vec![[0.0; LANES]; nodes],
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
    /// Length of a step that is not cut, m.
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

/// The loop, compiled for what is in it.
struct Loop<'a, const GAS: bool, const SCATTER: bool, const BEND: bool>(March<'a>);

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
        let mut light = Light::none(nodes.len());
        let mut glow = GlowLight::new();
        let mut around = vec![[0.0; LANES]; if SCATTER { march.tables.channels() } else { 0 }];
        let mut transmittance = vec![[1.0_f32; LANES]; nodes.len()];
        let mut block_radiance = vec![[0.0_f32; LANES]; nodes.len()];
        let mut block_column = [0.0_f32; LANES];
        let mut block_smoke = [0.0_f32; LANES];
        let mut walk = Walk::new(&march.packet, march.step_m);
        let mut since_flush = 0;
        loop {
            let (step, active) =
                walk.next::<GAS, SCATTER, BEND>(march.medium, march.scatter, &mut around);
            if active == 0 {
                break;
            }
            light.samples += active;

            // Each wavelength emits, is absorbed and is scattered over the step.
            let carried = transmittance.iter_mut().zip(&mut block_radiance);
            for (n, (node, (transmittance, radiance))) in nodes.iter().zip(carried).enumerate() {
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
                let of_features = if SCATTER { &around[nodes.len()..] } else { &[] };
                glow.step::<SCATTER>(glow_table, &step, reach_m, of_features);
            }

            since_flush += 1;
            if since_flush == FLUSH {
                since_flush = 0;
                for (lane, block) in block_column.iter_mut().enumerate() {
                    lanes::flush(&mut light.column_m[lane], block);
                    if light.column_m[lane] > opaque {
                        walk.stop(lane);
                    }
                }
                if SCATTER {
                    for (total, block) in light.smoke_m.iter_mut().zip(&mut block_smoke) {
                        lanes::flush(total, block);
                    }
                }
                for (n, node) in nodes.iter().enumerate() {
                    for lane in 0..LANES {
                        lanes::flush(&mut light.radiance[n][lane], &mut block_radiance[n][lane]);
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
        let x = node.planck_exponent_k * step.inverse_temperature[lane];
        let planck = node.planck_scale * lanes::inverse_exp_m1(x);
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
        let x = node.planck_exponent_k * step.inverse_temperature[lane];
        let planck = node.planck_scale * lanes::inverse_exp_m1(x);
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
