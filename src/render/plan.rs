//! What is computed for a scene at given settings: laws baked into tables for the march.
//!
//! The laws are f64; the tables are f32 with the units chosen so that nothing under- or overflows (wavelengths
//! in nm, Planck's constants per nm).

use super::glow::GlowTable;
use super::{Effects, Flaws, Settings, Switch};
use crate::colour::cie;
use crate::physics::blackbody;
use crate::scene::Scene;
use crate::scene::glow::{Feature, Source};
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

/// Tables for one scene at one accuracy.
#[derive(Debug, Clone)]
pub struct Plan {
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
    /// What these settings cannot show faithfully of this scene.
    pub flaws: Flaws,
    /// Which effects are computed, and why.
    pub decisions: Vec<Decision>,
    /// Once the medium's column ∫ f_v ds (m) exceeds this, no wavelength lets anything behind be seen.
    pub opaque_column_m: f32,
}

/// Whether an effect is computed, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// Its name, as in the scene file's `[effects]` where it stands there.
    pub effect: &'static str,
    /// Whether it is computed.
    pub on: bool,
    /// Why, for a person.
    pub reason: &'static str,
}

/// Most wavelengths of any set.
pub const MAX_NODES: usize = 64;

/// Optical depth of a step from which on the picture's error is said: the midpoint rule is off by about τ²/24 of a
/// step's light, here 1 %.
const THICK_STEP: f64 = 0.5;

/// Optical depth at which a ray stops: what is behind keeps e⁻²⁴ = 4e-11 of its radiance, less than an f32's last digit
/// unless it is a thousand times as bright as what is in front.
const OPAQUE_DEPTH: f64 = 24.0;

impl Plan {
    /// Bakes the tables for the settings' own wavelengths.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let wavelengths = settings.wavelengths.wavelengths(scene.flame.soot());
        let mut features = scene.flame.glow().features();
        let decisions = decisions(scene, &features, settings.effects);
        let is_on = |effect: &str| decisions.iter().any(|it| it.effect == effect && it.on);
        let with_radicals = is_on(CHEMILUMINESCENCE);
        features.retain(|feature| with_radicals || !feature.is_radical());
        let mut plan = Self {
            decisions,
            ..Self::baked(scene, settings.size, wavelengths, features)
        };
        let medium = scene.flame.medium();
        let densest = plan
            .nodes
            .iter()
            .map(|node| f64::from(node.absorption))
            .fold(0.0, f64::max);
        let step_m = settings.step_voxels * medium.voxel_size_m();
        let thickest = densest * f64::from(medium.peak_volume_fraction()) * step_m;
        if thickest > THICK_STEP {
            plan.flaws.add(format!(
                "the soot is so dense that a step of {} × a voxel's edge is up to {thickest:.1} optical depths thick: take \
                 smaller steps, or less soot",
                settings.step_voxels
            ));
        }
        plan
    }

    /// Bakes the tables for given wavelengths, at most [`MAX_NODES`] of them: those of a measurement, say. All that
    /// glows in the gas is in it.
    pub fn with_wavelengths(scene: &Scene, size: [u32; 2], wavelengths: Wavelengths) -> Self {
        Self::baked(scene, size, wavelengths, scene.flame.glow().features())
    }

    fn baked(
        scene: &Scene,
        size: [u32; 2],
        wavelengths: Wavelengths,
        features: Vec<Feature>,
    ) -> Self {
        debug_assert!(wavelengths.len() <= MAX_NODES);
        let nodes: Vec<Node> = wavelengths
            .nodes_nm
            .iter()
            .map(|&nm| Node {
                absorption: scene.flame.absorption_per_sample(nm) as f32,
                scattering: scene.flame.scattering_per_sample(nm).map(|s| s as f32),
                asymmetry: scene.flame.asymmetry(nm) as f32,
                planck_scale: (blackbody::FIRST_RADIATION_CONSTANT / nm.powi(5)) as f32,
                planck_exponent_k: (blackbody::SECOND_RADIATION_CONSTANT_NM_K / nm) as f32,
            })
            .collect();
        let glow = GlowTable::new(&scene.flame, features.clone());
        let clearest = nodes
            .iter()
            .map(|node| node.absorption)
            .chain(glow.absorptions())
            .reduce(f32::min);
        // Where nothing is carried, nothing can be hidden.
        let opaque_column_m =
            clearest.map_or(f64::INFINITY, |clearest| OPAQUE_DEPTH / f64::from(clearest)) as f32;
        Self {
            wavelengths,
            nodes,
            glow,
            features,
            size,
            flaws: Flaws::default(),
            decisions: Vec::new(),
            opaque_column_m,
        }
    }
}

/// The name of the radicals' light among the effects.
const CHEMILUMINESCENCE: &str = "chemiluminescence";

/// Which effects a scene calls for.
fn decisions(scene: &Scene, features: &[Feature], effects: Effects) -> Vec<Decision> {
    let decision = |effect, on, reason| Decision { effect, on, reason };
    let glow = scene.flame.glow();
    vec![
        if scene.flame.medium().peak_volume_fraction() > 0.0 {
            decision("emission-absorption", true, "soot glows and absorbs")
        } else {
            decision("emission-absorption", false, "there is no soot")
        },
        match effects.lines {
            Switch::Off => decision("lines", false, "effects.lines is off"),
            _ if glow.has_metal() => decision("lines", true, "there is a salt in the gas"),
            Switch::Auto | Switch::On => decision("lines", false, "there is no salt"),
        },
        match effects.chemiluminescence {
            Switch::Off => decision(CHEMILUMINESCENCE, false, "effects.chemiluminescence is off"),
            _ if !glow.has_radicals() => decision(
                CHEMILUMINESCENCE,
                false,
                "no field says where gas burns, or nothing that glows is burnt there",
            ),
            Switch::Auto if radicals_are_outshone(scene, features) => decision(
                CHEMILUMINESCENCE,
                false,
                "soot outshines the burning gas a thousandfold wherever it burns",
            ),
            Switch::Auto => decision(
                CHEMILUMINESCENCE,
                true,
                "burning gas may be seen beside the soot",
            ),
            Switch::On => decision(CHEMILUMINESCENCE, true, "it was asked for"),
        },
    ]
}

/// Luminance of the radicals beside that of the soot at the same place (or beside a thirtieth of the brightest soot's)
/// below which they are left out: a thousandth of what is there, and less than a step of 8 bits where nothing is, at the
/// exposure that shows the brightest parts as 4 × display white.
const OUTSHONE: f64 = 1e-3;

/// Whether soot outshines the light of radicals everywhere.
fn radicals_are_outshone(scene: &Scene, features: &[Feature]) -> bool {
    let (flame, peaks) = (&scene.flame, &scene.flame.medium().peaks);
    let [soot, kelvin] = peaks.brightest.map(f64::from);
    let luminous = |nm: f64| {
        let emission =
            flame.absorption_per_sample(nm) * soot * blackbody::spectral_radiance(nm, kelvin);
        10.0 * emission * cie::colour_matching(nm)[1]
    };
    let brightest_y: f64 = (380..=780).step_by(10).map(f64::from).map(luminous).sum();
    // The measure of the soot's glow in units of its luminance.
    let y_per_glow = brightest_y / f64::from(peaks.glow);
    let radicals_y: f64 = features
        .iter()
        .map(|feature| match feature.source {
            Source::Radical(emission) => emission * feature.colour[1],
            Source::Thermal { .. } => 0.0,
        })
        .sum();
    peaks.flame <= 0.0 || radicals_y * f64::from(peaks.flame_beside_glow) < OUTSHONE * y_per_glow
}
