//! The shortcut that renderers of three colours take, to be compared with: coefficients are summed over the observer before
//! the march, and X, Y and Z are marched as if each were a wavelength.
//!
//! ```text
//! σ_c = ∫ σ_a(λ) c̄(λ) dλ / ∫ c̄(λ) dλ,   S_c(T) = ∫ σ_a(λ) B(λ, T) c̄(λ) dλ / σ_c,   c̄ = x̄, ȳ, z̄
//! ```
//!
//! Nothing is wrong with it where nothing is absorbed. Behind soot it is, by ∫ e^{−τ(λ)} … ≠ e^{−τ_c} ∫ …
//!
//! The march knows Planck's law alone. S_c(T) is very nearly one: of the wavelength and the scale that make it right at the
//! scene's hottest soot and at three quarters of its temperature.

use super::tables::{COOLEST_K, Node, Tables};
use crate::colour::cie;
use crate::physics::blackbody;
use crate::scene::Scene;
use crate::spectral::Wavelengths;

/// The observer's range and the spacing of the sums, nm.
const RANGE_NM: [f64; 2] = [360.0, 830.0];
const STEP_NM: f64 = 5.0;
/// The cooler of the two temperatures, over the hotter.
const COOLER: f64 = 0.75;
/// Where a channel of a scene without soot is thought to be, nm.
const MIDDLE_NM: f64 = 555.0;
/// X, Y and Z of D65, Y = 1 (CIE 15).
const WHITE: [f64; 3] = [0.95047, 1.0, 1.08883];

/// Three channels in the place of wavelengths, each its own weight.
pub(super) fn wavelengths(scene: &Scene) -> Wavelengths {
    let apart = |weights: [f64; 3]| -> Vec<[f64; 3]> {
        (0..3)
            .map(|c| std::array::from_fn(|other| if other == c { weights[c] } else { 0.0 }))
            .collect()
    };
    let channels = channels(scene);
    Wavelengths {
        nodes_nm: channels
            .iter()
            .map(|channel| blackbody::SECOND_RADIATION_CONSTANT_NM_K / channel.exponent_k)
            .collect(),
        xyz: apart([1.0; 3]),
        opacity: apart(WHITE),
    }
}

/// Puts the summed coefficients where tables of [`wavelengths`] have those of single ones.
pub(super) fn bake(tables: &mut Tables, scene: &Scene) {
    for (node, channel) in tables.nodes.iter_mut().zip(channels(scene)) {
        *node = Node {
            absorption: channel.absorption as f32,
            planck_scale: channel.scale as f32,
            planck_exponent_k: channel.exponent_k as f32,
            ..*node
        };
    }
}

/// One of X, Y and Z.
struct Channel {
    /// For each unit of the medium's volume fraction, 1/m.
    absorption: f64,
    /// Source function: scale / (e^{exponent/T} − 1), W m⁻² sr⁻¹.
    scale: f64,
    exponent_k: f64,
}

fn channels(scene: &Scene) -> [Channel; 3] {
    let flame = &scene.flame;
    let hottest = f64::from(flame.medium().peak_temperature_k()).max(COOLEST_K);
    let cooler = COOLER * hottest;
    std::array::from_fn(|c| {
        let sum = |f: &dyn Fn(f64) -> f64| {
            let count = ((RANGE_NM[1] - RANGE_NM[0]) / STEP_NM) as u32;
            let places = (0..=count).map(|i| RANGE_NM[0] + STEP_NM * f64::from(i));
            places
                .map(|nm| STEP_NM * cie::colour_matching(nm)[c] * f(nm))
                .sum::<f64>()
        };
        let absorbed = |nm: f64| flame.absorption_per_sample(nm);
        let absorption = sum(&absorbed) / sum(&|_| 1.0);
        let source = |kelvin: f64| {
            sum(&|nm| absorbed(nm) * blackbody::spectral_radiance(nm, kelvin)) / absorption
        };
        if absorption <= 0.0 {
            return Channel {
                absorption: 0.0,
                scale: 0.0,
                exponent_k: blackbody::SECOND_RADIATION_CONSTANT_NM_K / MIDDLE_NM,
            };
        }
        let (hot, cool) = (source(hottest), source(cooler));
        // By Wien's law, which the visible light of fire follows within 1e-4.
        let exponent_k = (hot / cool).ln() / (1.0 / cooler - 1.0 / hottest);
        Channel {
            absorption,
            scale: hot * (exponent_k / hottest).exp_m1(),
            exponent_k,
        }
    })
}
