//! The laws of one scene at one set of wavelengths, baked into tables for the march.
//!
//! The laws are f64; the tables are f32 with the units chosen so that nothing under- or overflows (wavelengths
//! in nm, Planck's constants per nm).

use super::glow::GlowTable;
use super::spread::Spread;
use crate::physics::blackbody;
use crate::scene::glow::Feature;
use crate::scene::{Scene, WavelengthSet};
use crate::spectral::Wavelengths;

/// One wavelength of the march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Absorption coefficient for each unit of the medium's volume fraction, 1/m.
    pub absorption: f32,
    /// Scattering coefficient for each unit of it that is soot, and that is smoke, 1/m; zero where scattering is off.
    pub scattering: [f32; 2],
    /// Mean cosine of the scattering.
    pub asymmetry: f32,
    /// 2hc²/λ⁵, W m⁻² sr⁻¹ nm⁻¹: Planck's radiance without its exponential.
    pub planck_scale: f32,
    /// hc/(λk), K: Planck's exponent times temperature.
    pub planck_exponent_k: f32,
}

impl Node {
    /// What is taken from light for each unit of the volume fraction, 1/m: by all of it, and by how much more by smoke.
    #[inline(always)]
    pub(super) fn extinction(&self) -> [f32; 2] {
        let [soot, smoke] = self.scattering;
        [self.absorption + soot, smoke - soot]
    }
}

/// The laws of one scene at given wavelengths.
#[derive(Debug, Clone)]
pub struct Tables {
    /// Nodes and what they weigh in XYZ.
    pub wavelengths: Wavelengths,
    /// The march's view of the same nodes.
    pub nodes: Vec<Node>,
    /// What glows in the gas beside soot.
    pub glow: GlowTable,
    /// The same as features, thermal ones first, in the order in which the march carries them.
    pub features: Vec<Feature>,
    /// Picture size in pixels.
    pub size: [u32; 2],
    /// Once the medium's column ∫ f_v ds (m) exceeds this, no wavelength lets anything behind be seen.
    pub opaque_column_m: f32,
    /// Whether any light is scattered.
    pub scatters: bool,
    /// X, Y, Z of the opacity of what lets nothing through.
    pub opaque: [f64; 3],
}

/// Most wavelengths of any set.
pub const MAX_NODES: usize = 64;

/// Most wavelengths at which light from all sides is worked out by itself.
const FIELD_NODES: usize = 16;
/// Temperature of what gives most light, over the hottest soot's.
const LUMINOUS: f64 = 0.9;
/// Coolest peak of a fire that is looked at, K: what is cooler is not seen.
pub(super) const COOLEST_K: f64 = 800.0;
/// The plain set at which it is where there are more.
const FIELD_SET: u32 = 16;

/// Optical depth at which a ray stops: what is behind keeps e⁻²⁴ = 4e-11 of its radiance, less than an f32's last digit
/// unless it is a thousand times as bright as what is in front.
const OPAQUE_DEPTH: f64 = 24.0;

/// Optical depth of a whole fire below which it counts as clear: at 5000 K, 4e9 cd/m², it would shine with 4e-15 cd/m², where
/// an eye sees 1e-6 at the best. The depths of its steps would be denormal numbers, which many processors are slow at.
const LEAST_DEPTH: f64 = 1e-24;

impl Tables {
    /// Bakes the laws for given wavelengths, at most [`MAX_NODES`] of them, with these features of the gas, and with or
    /// without scattering.
    pub(super) fn new(
        scene: &Scene,
        size: [u32; 2],
        wavelengths: Wavelengths,
        features: Vec<Feature>,
        scatters: bool,
    ) -> Self {
        debug_assert!(wavelengths.len() <= MAX_NODES);
        let flame = &scene.flame;
        let scattering = |nm: f64| {
            if scatters {
                flame.scattering_per_sample(nm)
            } else {
                [0.0; 2]
            }
        };
        let medium = flame.medium();
        let diagonal_m = medium.domain.size().length() * medium.voxel_size_m();
        let thickest_m = f64::from(medium.peak_volume_fraction()) * diagonal_m;
        let told = |for_each_unit: f64| {
            if for_each_unit * thickest_m < LEAST_DEPTH {
                0.0
            } else {
                for_each_unit as f32
            }
        };
        let nodes: Vec<Node> = wavelengths
            .nodes_nm
            .iter()
            .map(|&nm| Node {
                absorption: told(flame.absorption_per_sample(nm)),
                scattering: scattering(nm).map(told),
                asymmetry: flame.asymmetry(nm) as f32,
                planck_scale: (blackbody::FIRST_RADIATION_CONSTANT / nm.powi(5)) as f32,
                planck_exponent_k: (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32,
            })
            .collect();
        let glow = GlowTable::new(flame, &features, &scattering);
        let clearest = nodes
            .iter()
            .map(|node| node.absorption)
            .chain(glow.absorptions())
            .reduce(f32::min);
        // Where nothing is carried, nothing can be hidden.
        let opaque_column_m =
            clearest.map_or(f64::INFINITY, |clearest| OPAQUE_DEPTH / f64::from(clearest)) as f32;
        Self {
            scatters: nodes.iter().any(|node| node.scattering != [0.0; 2]),
            opaque: wavelengths.opacity_of(nodes.iter().map(|_| 1.0)),
            wavelengths,
            nodes,
            glow,
            features,
            size,
            opaque_column_m,
        }
    }

    /// Which share of white light of X, Y and Z an opacity lets through. The weights of fitted sets have both signs: what
    /// that puts beyond 0 or 1 counts as these.
    pub(super) fn through(&self, opacity: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|c| (1.0 - opacity[c] / self.opaque[c]).clamp(0.0, 1.0))
    }

    /// The same laws at few enough wavelengths for fields of light from all sides, and how these become this one's; `None`
    /// where these are few enough.
    pub(super) fn for_fields(&self, scene: &Scene) -> Option<(Self, Spread)> {
        if self.nodes.len() <= FIELD_NODES {
            return None;
        }
        let kelvin = LUMINOUS * f64::from(scene.flame.medium().peak_temperature_k()).max(COOLEST_K);
        let few = WavelengthSet::Plain(FIELD_SET).wavelengths(scene.flame.soot());
        let spread = Spread::new(&few.nodes_nm, &self.wavelengths.nodes_nm, kelvin)?;
        let features = self.features.clone();
        let few = Self::new(scene, self.size, few, features, self.scatters);
        Some((few, spread))
    }

    /// How many numbers light is carried in: nodes, then features.
    pub fn channels(&self) -> usize {
        self.nodes.len() + self.features.len()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::sync::Arc;

    use crate::project::Project;
    use crate::render::Plan;
    use crate::volume::procedural;

    #[test]
    fn so_little_soot_that_no_eye_sees_it_is_none() {
        let torch = Arc::new(procedural::torch());
        // The torch's depth is of the order of 1.
        for (amount, is_told) in [
            ("1", true),
            ("1e-20", true),
            ("1e-30", false),
            ("1e-36", false),
        ] {
            let mut project = Project::default();
            project
                .set_all([
                    format!("soot.amount={amount}").as_str(),
                    "effects.scattering=on",
                ])
                .unwrap();
            let job = project.job(&torch).unwrap();
            let plan = Plan::new(&job.scene(None), &job.settings);
            for node in &plan.tables.nodes {
                assert_eq!(node.absorption > 0.0, is_told, "{amount}: {node:?}");
                assert!(node.scattering[0] == 0.0 || is_told, "{amount}: {node:?}");
            }
        }
    }
}
