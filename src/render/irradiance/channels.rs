//! What a fire gives off at a point, channel by channel: the plan's nodes, then its features.

use crate::math::lanes;
use crate::physics::blackbody;
use crate::render::lookup::Found;
use crate::render::tables::Tables;
use crate::scene::glow::{Growth, Source};
use crate::scene::{Flame, Glow, Scene};

/// Channels are worked on in blocks of this many: one AVX2 register.
pub(super) const BLOCK: usize = 8;
/// One block of channels.
pub(super) type Block = [f32; BLOCK];

/// The laws of each channel, padded with channels in which nothing happens.
#[derive(Debug)]
pub(super) struct Channels {
    /// How many channels are nodes; the features follow, then the padding.
    nodes: usize,
    /// Planck's radiance without its exponential times the absorption for each unit of volume fraction.
    scale: Vec<Block>,
    exponent_k: Vec<Block>,
    /// Extinction for each unit of the medium's volume fraction, and what it is more where that is smoke, 1/m.
    pub(super) extinction: Vec<[Block; 2]>,
    /// By how much a unit of each channel counts where places are compared: its luminance.
    luminous: Vec<Block>,
    /// Lines and bands, in the order of the features, which they lead.
    pub(super) thermal: Vec<Thermal>,
    /// W m⁻³ sr⁻¹ where the flame field is 1.
    radicals: Vec<f32>,
    glow: Glow,
}

/// A line or band.
#[derive(Debug, Clone, Copy)]
pub(super) struct Thermal {
    /// Its channel.
    pub(super) channel: usize,
    planck_scale: f32,
    planck_exponent_k: f32,
    strength: f32,
    lower_k: f32,
    pub(super) growth: Growth,
}

impl Channels {
    /// The channels of a tables.
    pub(super) fn new(scene: &Scene, tables: &Tables) -> Self {
        let nodes = tables.nodes.len();
        let count = nodes + tables.features.len();
        let blocks = count.div_ceil(BLOCK).max(1);
        let mut channels = Self {
            nodes,
            scale: vec![[0.0; BLOCK]; blocks],
            // Planck's exponential of the padding is nothing, not one over nothing.
            exponent_k: vec![[1e9; BLOCK]; blocks],
            extinction: vec![[[0.0; BLOCK]; 2]; blocks],
            luminous: vec![[0.0; BLOCK]; blocks],
            thermal: Vec::new(),
            radicals: Vec::new(),
            glow: scene.flame.glow().clone(),
        };
        for (i, (node, weight)) in tables.nodes.iter().zip(&tables.wavelengths.xyz).enumerate() {
            let (block, k) = (i / BLOCK, i % BLOCK);
            channels.scale[block][k] = node.planck_scale * node.absorption;
            channels.exponent_k[block][k] = node.planck_exponent_k;
            channels.luminous[block][k] = weight[1].abs() as f32;
            let [soot, smoke] = node.scattering;
            channels.extinction[block][0][k] = node.absorption + soot;
            channels.extinction[block][1][k] = smoke - soot;
        }
        for (i, feature) in (nodes..).zip(&tables.features) {
            let (block, k) = (i / BLOCK, i % BLOCK);
            let nm = feature.lambda_nm;
            let (absorption, [soot, smoke]) = extinction_at(&scene.flame, nm);
            channels.extinction[block][0][k] = absorption + soot;
            channels.extinction[block][1][k] = smoke - soot;
            channels.luminous[block][k] = feature.colour[1].abs() as f32;
            match feature.source {
                Source::Thermal {
                    width_nm,
                    strength,
                    lower_k,
                    growth,
                } => channels.thermal.push(Thermal {
                    channel: i,
                    planck_scale: (width_nm * blackbody::FIRST_RADIATION_CONSTANT / nm.powi(5))
                        as f32,
                    planck_exponent_k: (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32,
                    strength: strength as f32,
                    lower_k: lower_k as f32,
                    growth,
                }),
                Source::Radical(emission) => channels.radicals.push(emission as f32),
            }
        }
        channels
    }

    /// Blocks of channels.
    pub(super) fn blocks(&self) -> usize {
        self.scale.len()
    }

    /// Emission coefficient of each channel at a point, W m⁻³ sr⁻¹ (nm⁻¹ of the nodes), and what a metre adds to the depth
    /// y of each line or band, 1/m.
    #[inline(always)]
    pub(super) fn emission(
        &self,
        [soot, kelvin, burning, _]: Found,
        emission: &mut [Block],
        growth: &mut [f32],
    ) {
        let inverse = 1.0 / kelvin;
        for (b, emission) in emission.iter_mut().enumerate() {
            for (k, emission) in emission.iter_mut().enumerate() {
                let planck =
                    self.scale[b][k] * lanes::inverse_exp_m1(self.exponent_k[b][k] * inverse);
                *emission = soot * planck;
            }
        }
        if !self.thermal.is_empty() {
            let vapour = self.glow.vapour_share(f64::from(kelvin)) as f32;
            for (thermal, growth) in self.thermal.iter().zip(growth) {
                let photons = lanes::inverse_exp_m1(thermal.planck_exponent_k * inverse);
                let lower = lanes::exp(-thermal.lower_k * inverse);
                // Less what is emitted because it is shone on: 1 − e^{−x}.
                *growth = thermal.strength * lower / (1.0 + photons) * vapour * inverse;
                emission[thermal.channel / BLOCK][thermal.channel % BLOCK] =
                    thermal.planck_scale * photons * *growth;
            }
        }
        for (i, radical) in (self.nodes + self.thermal.len()..).zip(&self.radicals) {
            emission[i / BLOCK][i % BLOCK] = radical * burning;
        }
    }

    /// By how much emission counts where places are compared, in W and lm alike.
    #[inline(always)]
    pub(super) fn luminous(&self, emission: &[Block]) -> f32 {
        let mut sum = [0.0; BLOCK];
        for (emission, weight) in emission.iter().zip(&self.luminous) {
            for k in 0..BLOCK {
                sum[k] += emission[k] * weight[k];
            }
        }
        sum.iter().sum()
    }
}

/// Absorption for each unit of volume fraction, and scattering of soot and smoke, 1/m.
fn extinction_at(flame: &Flame, lambda_nm: f64) -> (f32, [f32; 2]) {
    (
        flame.absorption_per_sample(lambda_nm) as f32,
        flame.scattering_per_sample(lambda_nm).map(|s| s as f32),
    )
}
