//! What glows in the gas, baked for the march: its lines, bands and radicals over one step.
//!
//! A line or band in equilibrium takes from its own wavelengths what the gas behind sends through it, and gives its own
//! light. With W(y) its equivalent width, y the depth gathered so far, and t the soot's transmittance so far, all light
//! that it adds to what soot alone would give is, step by step,
//!
//! ```text
//! ΔL = B(λ, T) (W(y₂) t₂ − W(y₁) t₁)
//! ```
//!
//! for ∫ e^{−τ} (σ_line + σ_soot) B ds over its wavelengths, less the same without the line, is an integral of
//! B d(W t). So the line's own shadow on the soot behind it is in it, and an isothermal flame gives B·W exactly. Radicals
//! do not absorb: j t φ₁(τ) Δs.

use super::growth::{FIT, GrowthFit, curve_of_growth_f32};
use super::own_light::own_light;
use crate::math::lanes::{self, LANES, Lanes};
use crate::physics::blackbody;
use crate::scene::Flame;
use crate::scene::glow::{Feature, Growth, Source, Spread, VAPOUR_K};

/// Most features of any flame: the richest salt has 12, the radicals 4.
pub const MAX_FEATURES: usize = 16;

/// Features of one flame as the march takes them.
#[derive(Debug, Clone)]
pub struct GlowTable {
    thermal: Vec<Thermal>,
    radicals: Vec<Radical>,
    /// X, Y, Z of a unit of each feature's light: the thermal ones, then the radicals.
    colours: Vec<[f64; 3]>,
    /// How each lies over the wavelengths.
    spreads: Vec<Spread>,
    /// Temperature of air, and one over what undiluted gas is hotter, K and 1/K.
    dilution: [f32; 2],
    growth: GrowthFit,
}

/// What soot does to the light of a feature, for each unit of the medium's volume fraction, 1/m.
#[derive(Debug, Clone, Copy)]
struct Dimming {
    absorption: f32,
    /// Of soot and of smoke.
    scattering: [f32; 2],
}

impl Dimming {
    fn new(absorption: f64, scattering: [f64; 2]) -> Self {
        Self {
            absorption: absorption as f32,
            scattering: scattering.map(|s| s as f32),
        }
    }

    /// Optical depth of a column of soot (m), of which a part is smoke.
    #[inline(always)]
    fn depth<const SCATTER: bool>(&self, column: f32, smoke: f32) -> f32 {
        if SCATTER {
            self.absorption * column + self.scattered(column, smoke)
        } else {
            self.absorption * column
        }
    }

    /// The scattering's part of it.
    #[inline(always)]
    fn scattered(&self, column: f32, smoke: f32) -> f32 {
        let [by_soot, by_smoke] = self.scattering;
        by_soot * (column - smoke) + by_smoke * smoke
    }
}

/// A line or a band.
#[derive(Debug, Clone, Copy)]
struct Thermal {
    dimming: Dimming,
    /// Planck's radiance times the feature's width, without its exponential, W m⁻² sr⁻¹.
    planck_scale: f32,
    planck_exponent_k: f32,
    /// See [`Source::Thermal`].
    strength: f32,
    lower_k: f32,
    growth: Growth,
}

/// A part of the radicals' light.
#[derive(Debug, Clone, Copy)]
struct Radical {
    dimming: Dimming,
    /// W m⁻³ sr⁻¹ where the flame field is 1.
    emission: f32,
}

/// What a step of a packet meets.
pub(super) struct Step {
    /// ∫ f_v ds of the medium over the step, m.
    pub(super) column: Lanes,
    /// The part of it that is smoke.
    pub(super) smoke: Lanes,
    pub(super) inverse_temperature: Lanes,
    pub(super) flame: Lanes,
    /// Length, m; 0 for a ray that is through.
    pub(super) length: Lanes,
}

impl GlowTable {
    /// Bakes features for a flame whose soot and smoke scatter so much for each unit of volume fraction, 1/m.
    pub(super) fn new(
        flame: &Flame,
        features: &[Feature],
        scattering: &impl Fn(f64) -> [f64; 2],
    ) -> Self {
        let glow = flame.glow();
        let [air, hot] = glow.dilution_k();
        let mut table = Self {
            thermal: Vec::new(),
            radicals: Vec::new(),
            colours: Vec::new(),
            spreads: Vec::new(),
            dilution: [air as f32, (1.0 / (hot - air).max(1.0)) as f32],
            growth: *FIT,
        };
        // The thermal features come first.
        for feature in features {
            let nm = feature.lambda_nm;
            let dimming = Dimming::new(flame.absorption_per_sample(nm), scattering(nm));
            match feature.source {
                Source::Thermal {
                    width_nm,
                    strength,
                    lower_k,
                    growth,
                } => table.thermal.push(Thermal {
                    dimming,
                    planck_scale: (width_nm * blackbody::FIRST_RADIATION_CONSTANT / nm.powi(5))
                        as f32,
                    planck_exponent_k: (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32,
                    strength: strength as f32,
                    lower_k: lower_k as f32,
                    growth,
                }),
                Source::Radical(emission) => table.radicals.push(Radical {
                    dimming,
                    emission: emission as f32,
                }),
            }
            table.colours.push(feature.colour);
            table.spreads.push(feature.spread.clone());
        }
        debug_assert!(table.colours.len() <= MAX_FEATURES);
        table
    }

    /// Whether soot alone glows.
    pub fn is_empty(&self) -> bool {
        self.colours.is_empty()
    }

    /// Whether radicals glow.
    pub fn has_radicals(&self) -> bool {
        !self.radicals.is_empty()
    }

    /// XYZ of the features' light, W m⁻² sr⁻¹.
    pub fn xyz_of(&self, light: impl Iterator<Item = f64>) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (light, colour) in light.zip(&self.colours) {
            sum = std::array::from_fn(|c| sum[c] + light * colour[c]);
        }
        sum
    }

    /// The part of the features' light that lies in a bin of wavelengths, W m⁻² sr⁻¹.
    pub fn light_in(&self, bin_nm: [f64; 2], light: &[f64]) -> f64 {
        let spreads = self.spreads.iter().zip(light);
        spreads
            .map(|(spread, light)| light * spread.share_in(bin_nm))
            .sum()
    }

    /// How many features there are.
    pub fn len(&self) -> usize {
        self.colours.len()
    }

    /// Soot's absorption at each feature, for each unit of the medium's volume fraction, 1/m.
    pub(super) fn absorptions(&self) -> impl Iterator<Item = f32> {
        self.dimmings().map(|dimming| dimming.absorption)
    }

    /// What of each feature's light comes through columns of soot (m), of which a part is smoke.
    pub(super) fn transmittances(&self, column: f64, smoke: f64) -> impl Iterator<Item = f64> {
        self.dimmings().map(move |dimming| {
            let [by_soot, by_smoke] = dimming.scattering.map(f64::from);
            let taken = f64::from(dimming.absorption) * column;
            (-(taken + by_soot * (column - smoke) + by_smoke * smoke)).exp()
        })
    }

    fn dimmings(&self) -> impl Iterator<Item = &Dimming> {
        let thermal = self.thermal.iter().map(|feature| &feature.dimming);
        thermal.chain(self.radicals.iter().map(|feature| &feature.dimming))
    }
}

/// The features' light along a packet of rays.
pub(super) struct GlowLight {
    /// Radiance of each feature, W m⁻² sr⁻¹.
    pub(super) total: [Lanes; MAX_FEATURES],
    block: [Lanes; MAX_FEATURES],
    transmittance: [Lanes; MAX_FEATURES],
    /// Depth y of the thermal features: whole blocks, and the block that runs.
    depth: [Lanes; MAX_FEATURES],
    block_depth: [Lanes; MAX_FEATURES],
    /// W t over the width after the last step.
    width: [Lanes; MAX_FEATURES],
}

impl GlowLight {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let zero = [[0.0; LANES]; MAX_FEATURES];
        Self {
            total: zero,
            block: zero,
            transmittance: [[1.0; LANES]; MAX_FEATURES],
            depth: zero,
            block_depth: zero,
            width: zero,
        }
    }

    /// Adds what a step gives. `around` is the fire's light of each feature from all sides, as it is scattered towards the
    /// eye, less that of the place itself, which [`own_light`] finds for a reach of `reach_m`; both are read where
    /// `SCATTER` is.
    #[inline(always)]
    pub(super) fn step<const SCATTER: bool>(
        &mut self,
        table: &GlowTable,
        step: &Step,
        reach_m: f32,
        around: &[Lanes],
    ) {
        let vapour = vapour(table.dilution, &step.inverse_temperature);
        for (i, feature) in table.thermal.iter().enumerate() {
            let (light, transmittance) = (&mut self.block[i], &mut self.transmittance[i]);
            let (gathered, width) = (&mut self.block_depth[i], &mut self.width[i]);
            for lane in 0..LANES {
                let inverse = step.inverse_temperature[lane];
                let photons = lanes::inverse_exp_m1(feature.planck_exponent_k * inverse);
                let planck = feature.planck_scale * photons;
                let lower = if feature.lower_k > 0.0 {
                    lanes::exp(-feature.lower_k * inverse)
                } else {
                    1.0
                };
                let gas = vapour[lane] * inverse * step.length[lane];
                // Less what is emitted because it is shone on: 1 − e^{−x}.
                gathered[lane] += feature.strength * lower / (1.0 + photons) * gas;
                let y = self.depth[i][lane] + gathered[lane];
                let depth = feature
                    .dimming
                    .depth::<SCATTER>(step.column[lane], step.smoke[lane]);
                let absorbed = -lanes::exp_m1(-depth);
                transmittance[lane] -= transmittance[lane] * absorbed;
                let grown = match feature.growth {
                    Growth::Line => curve_of_growth_f32(&table.growth, y),
                    Growth::Box => -lanes::exp_m1(-y),
                } * transmittance[lane];
                light[lane] += planck * (grown - width[lane]);
                width[lane] = grown;
            }
        }
        for (i, feature) in (table.thermal.len()..).zip(&table.radicals) {
            let (light, transmittance) = (&mut self.block[i], &mut self.transmittance[i]);
            for lane in 0..LANES {
                let (column, smoke) = (step.column[lane], step.smoke[lane]);
                let tau = feature.dimming.depth::<SCATTER>(column, smoke);
                let absorbed = -lanes::exp_m1(-tau);
                // φ₁ → 1 where there is no soot.
                let phi = if tau > 1e-12 { absorbed / tau } else { 1.0 };
                let mut emitted = feature.emission * step.flame[lane] * step.length[lane];
                if SCATTER {
                    let own = own_light(emitted, tau, step.length[lane], reach_m);
                    let around = (around[i][lane] + own).max(0.0);
                    emitted += feature.dimming.scattered(column, smoke) * around;
                }
                light[lane] += transmittance[lane] * emitted * phi;
                transmittance[lane] -= transmittance[lane] * absorbed;
            }
        }
    }

    /// Ends a block of steps: sums go to the totals, transmittances are taken afresh from the soot's column.
    #[inline(always)]
    pub(super) fn flush<const SCATTER: bool>(
        &mut self,
        table: &GlowTable,
        [column_m, smoke_m]: [&Lanes; 2],
    ) {
        for (i, dimming) in table.dimmings().enumerate() {
            for lane in 0..LANES {
                lanes::flush(&mut self.total[i][lane], &mut self.block[i][lane]);
                lanes::flush(&mut self.depth[i][lane], &mut self.block_depth[i][lane]);
                let depth = dimming.depth::<SCATTER>(column_m[lane], smoke_m[lane]);
                self.transmittance[i][lane] = lanes::exp(-depth);
            }
        }
    }
}

/// Share of the salt's mole fraction that the gas holds as vapour: [`crate::scene::Glow::vapour_share`].
#[inline(always)]
fn vapour([air_k, per_k]: [f32; 2], inverse_temperature: &Lanes) -> Lanes {
    let [solid, gas] = VAPOUR_K.map(|kelvin| kelvin as f32);
    std::array::from_fn(|lane| {
        let kelvin = 1.0 / inverse_temperature[lane];
        let mixed = ((kelvin - air_k) * per_k).clamp(0.0, 1.0);
        let t = ((kelvin - solid) / (gas - solid)).clamp(0.0, 1.0);
        mixed * t * t * (3.0 - 2.0 * t)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Air, Fuel, Glow, GlowParams, Salt};

    #[test]
    fn the_richest_flame_has_room() {
        for salt in Salt::all() {
            for fuel in Fuel::all() {
                let params = GlowParams {
                    salt,
                    salt_ppm: 1.0,
                    radicals: 1.0,
                    ..GlowParams::default()
                };
                let features = Glow::new(&params, fuel, &Air::default()).features().len();
                assert!(features <= MAX_FEATURES, "{salt:?} in {fuel:?}: {features}");
            }
        }
    }
}
