//! Wavelength sets: at which wavelengths radiance is transported, and with what weights it becomes XYZ.
//!
//! # Plain sets
//!
//! K midpoints of equal bands on 380 to 780 nm; the weight of a node is the integral of the observer's
//! functions over its band, and the outermost two stand for what the observer sees beyond as well: even light keeps all of
//! its X, Y and Z. Always right in the limit, whatever the spectrum; the reference.
//!
//! # Fitted sets
//!
//! The spectra of sooty flames are smooth: black bodies seen through soot. K Gauss–Legendre nodes on 410 to
//! 690 nm get weights by least squares, so that the XYZ of that family — 800 to 2200 K behind soot of optical
//! depth 0 to 4 at 550 nm — is matched as well as K numbers can. With 4 nodes the error on real flames is 0.2 %,
//! with 6 0.03 %, with 8 0.001 %, where plain Gauss–Legendre weights give 8.6, 0.5 and 0.5 %. The fit depends
//! on the soot's dispersion, so it is made again whenever the soot law changes; it takes about a millisecond.
//!
//! The same nodes get weights for opacity, fitted to the XYZ of 1 − e^{−τ(λ)} under illuminant D65, so that the
//! alpha channel costs no wavelength of its own.
//!
//! Integrals are sums over the 1 nm table of the standard observer, 360 to 830 nm, every 5 nm for the fit's
//! targets.

use serde::{Deserialize, Serialize};

use super::fit::{LeastSquares, gauss_legendre};
use crate::colour::cie;
use crate::physics::blackbody;
use crate::physics::soot::SootLaw;
use crate::spectral::Wavelengths;

/// How many wavelengths, and of which kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum WavelengthSet {
    /// 4, 6 or 8 Gauss–Legendre nodes with weights fitted to the scene's soot.
    Fitted(u32),
    /// 16, 32 or 64 bands of equal width.
    Plain(u32),
}

impl WavelengthSet {
    /// Every set, cheapest first.
    pub const ALL: [Self; 6] = [
        Self::Fitted(4),
        Self::Fitted(6),
        Self::Fitted(8),
        Self::Plain(16),
        Self::Plain(32),
        Self::Plain(64),
    ];

    /// How many wavelengths it has.
    pub fn count(self) -> u32 {
        match self {
            Self::Fitted(count) | Self::Plain(count) => count,
        }
    }

    /// Nodes and weights for soot of the given law.
    pub fn wavelengths(self, soot: SootLaw) -> Wavelengths {
        self.tinted_wavelengths(soot, &[])
    }

    /// The same where some of the light is tinted on its way: each tint is a factor at each wavelength (nm), at most a few
    /// times as large at one than at another. Fitted sets hold such light as well.
    pub fn tinted_wavelengths(self, soot: SootLaw, tints: &[&dyn Fn(f64) -> f64]) -> Wavelengths {
        match self {
            Self::Fitted(count) => fitted(count, soot, tints),
            Self::Plain(count) => plain(count),
        }
    }
}

impl TryFrom<u32> for WavelengthSet {
    type Error = String;

    fn try_from(count: u32) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|set| set.count() == count)
            .ok_or_else(|| format!("there is no set of {count} wavelengths: choose 4, 6 or 8 (fitted), 16, 32 or 64 (plain)"))
    }
}

impl From<WavelengthSet> for u32 {
    fn from(set: WavelengthSet) -> Self {
        set.count()
    }
}

/// Ends of the fitted nodes' interval, nm: beyond them the eye is so dull that nodes are wasted.
const FITTED_RANGE_NM: [f64; 2] = [410.0, 690.0];
/// Ends of the plain bands, nm: the observer's functions outside carry 1e-4 of a flame's luminance, and 5e-4 of an even
/// spectrum's Z.
const PLAIN_RANGE_NM: [f64; 2] = [380.0, 780.0];
/// Ends and spacing of the integrals that the fit aims at, nm: the whole table of the observer.
const TARGET_RANGE_NM: [f64; 2] = [360.0, 830.0];
const TARGET_STEP_NM: f64 = 5.0;
/// The family that is fitted: temperatures in K (50 K apart), optical depths at 550 nm (0.25 apart).
const FIT_TEMPERATURES_K: [f64; 2] = [800.0, 2200.0];
const FIT_OPTICAL_DEPTHS: [f64; 2] = [0.0, 4.0];
const REFERENCE_NM: f64 = 550.0;

fn plain(count: u32) -> Wavelengths {
    let [low, high] = PLAIN_RANGE_NM;
    let band = (high - low) / f64::from(count);
    // 1 nm rectangles of the table that fall into a band; a rectangle cut by a band's edge is shared.
    let integrate = |from: f64, to: f64, f: &dyn Fn(f64) -> [f64; 3]| {
        let pieces = ((to - from) / 0.25).round();
        let width = (to - from) / pieces;
        (0..pieces as u32).fold([0.0; 3], |sum: [f64; 3], i| {
            let value = f(from + (f64::from(i) + 0.5) * width);
            std::array::from_fn(|c| sum[c] + width * value[c])
        })
    };
    let edge = |i: u32| low + f64::from(i) * band;
    let nodes_nm: Vec<f64> = (0..count).map(|i| edge(i) + 0.5 * band).collect();
    // What each stands for: its band, and beyond the outermost the observer's ends.
    let [first, last] = TARGET_RANGE_NM;
    let parts = (0..count).map(|i| {
        let from = if i == 0 { first } else { edge(i) };
        let to = if i + 1 == count { last } else { edge(i + 1) };
        [from, to]
    });
    let xyz = parts
        .clone()
        .map(|[from, to]| integrate(from, to, &cie::colour_matching))
        .collect();
    let opacity: Vec<[f64; 3]> = parts
        .map(|[from, to]| integrate(from, to, &under_d65))
        .collect();
    let white: f64 = opacity.iter().map(|weight| weight[1]).sum();
    let opacity = opacity
        .into_iter()
        .map(|weight| weight.map(|w| w / white))
        .collect();
    Wavelengths {
        nodes_nm,
        xyz,
        opacity,
    }
}

fn under_d65(lambda_nm: f64) -> [f64; 3] {
    cie::colour_matching(lambda_nm).map(|bar| bar * cie::d65(lambda_nm))
}

fn fitted(count: u32, soot: SootLaw, tints: &[&dyn Fn(f64) -> f64]) -> Wavelengths {
    let nodes_nm = gauss_legendre(count as usize, FITTED_RANGE_NM);
    let targets_nm: Vec<f64> = steps(TARGET_RANGE_NM, TARGET_STEP_NM).collect();
    // Trapezoid weights: half at both ends.
    let width = |i: usize| if i == 0 || i + 1 == targets_nm.len() { 0.5 } else { 1.0 } * TARGET_STEP_NM;
    let observer: Vec<[f64; 3]> = targets_nm
        .iter()
        .enumerate()
        .map(|(i, &nm)| cie::colour_matching(nm).map(|bar| bar * width(i)))
        .collect();
    let mut daylight: Vec<[f64; 3]> = targets_nm
        .iter()
        .enumerate()
        .map(|(i, &nm)| under_d65(nm).map(|bar| bar * width(i)))
        .collect();
    let white: f64 = daylight.iter().map(|weight| weight[1]).sum();
    daylight
        .iter_mut()
        .flatten()
        .for_each(|weight| *weight /= white);

    let relative_depth = |nm: f64| {
        soot.absorption_per_volume_fraction(nm) / soot.absorption_per_volume_fraction(REFERENCE_NM)
    };
    let depth_at_nodes: Vec<f64> = nodes_nm.iter().map(|&nm| relative_depth(nm)).collect();
    let depth_at_targets: Vec<f64> = targets_nm.iter().map(|&nm| relative_depth(nm)).collect();

    let tints: Vec<[Vec<f64>; 2]> = tints
        .iter()
        .map(|tint| {
            [&nodes_nm, &targets_nm].map(|places| places.iter().map(|&nm| tint(nm)).collect())
        })
        .collect();

    let mut emission = LeastSquares::new(count as usize);
    let mut opacity = LeastSquares::new(count as usize);
    for depth in steps(FIT_OPTICAL_DEPTHS, 0.25) {
        for temperature_k in steps(FIT_TEMPERATURES_K, 50.0) {
            let radiance = |nm: f64, relative: f64| {
                (-depth * relative).exp() * blackbody::spectral_radiance(nm, temperature_k)
            };
            let spectrum = |places: &[f64], depths: &[f64]| -> Vec<f64> {
                let places = places.iter().zip(depths);
                places.map(|(&nm, &depth)| radiance(nm, depth)).collect()
            };
            let at_nodes = spectrum(&nodes_nm, &depth_at_nodes);
            let at_targets = spectrum(&targets_nm, &depth_at_targets);
            emission.add(
                at_nodes.iter().copied(),
                at_targets.iter().copied(),
                &observer,
            );
            for [of_nodes, of_targets] in &tints {
                let tinted = |light: &[f64], tint: &[f64]| -> Vec<f64> {
                    light.iter().zip(tint).map(|(a, b)| a * b).collect()
                };
                emission.add(
                    tinted(&at_nodes, of_nodes).into_iter(),
                    tinted(&at_targets, of_targets).into_iter(),
                    &observer,
                );
            }
        }
        let veil = |relative: &f64| -(-(depth + 0.05) * relative).exp_m1();
        opacity.add(
            depth_at_nodes.iter().map(veil),
            depth_at_targets.iter().map(veil),
            &daylight,
        );
    }
    let mut opacity = opacity.solve();
    // An opaque ray must be exactly white: alpha 1, not nearly 1.
    for c in 0..3 {
        let white: f64 = daylight.iter().map(|weight| weight[c]).sum();
        let ours: f64 = opacity.iter().map(|weight| weight[c]).sum();
        for weight in &mut opacity {
            weight[c] *= white / ours;
        }
    }
    Wavelengths {
        xyz: emission.solve(),
        opacity,
        nodes_nm,
    }
}

/// Evenly spaced values from one end to the other, both included.
fn steps([low, high]: [f64; 2], step: f64) -> impl Iterator<Item = f64> {
    let count = ((high - low) / step).round() as u32;
    (0..=count).map(move |i| low + f64::from(i) * step)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use crate::physics::soot::SootModel;
    use crate::physics::soot_index::SootIndex;

    const LAW: SootLaw = SootLaw {
        model: SootModel::HottelBroughton,
        fuel_index: SootIndex::Propane,
    };

    /// XYZ of a black body behind soot with a set, against the 5 nm sum over the whole observer.
    fn error(set: WavelengthSet, temperature_k: f64, depth: f64) -> f64 {
        let relative = |nm: f64| {
            LAW.absorption_per_volume_fraction(nm)
                / LAW.absorption_per_volume_fraction(REFERENCE_NM)
        };
        let radiance = |nm: f64| {
            (-depth * relative(nm)).exp() * blackbody::spectral_radiance(nm, temperature_k)
        };
        let wavelengths = set.wavelengths(LAW);
        let ours = wavelengths.xyz_of(wavelengths.nodes_nm.iter().map(|&nm| radiance(nm)));
        let mut exact = [0.0; 3];
        for nm in steps(TARGET_RANGE_NM, TARGET_STEP_NM) {
            for (exact, bar) in exact.iter_mut().zip(cie::colour_matching(nm)) {
                *exact += TARGET_STEP_NM * radiance(nm) * bar;
            }
        }
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        norm(std::array::from_fn(|c| ours[c] - exact[c])) / norm(exact)
    }

    #[test]
    fn more_fitted_wavelengths_are_nearer_the_full_observer() {
        // Over a whole picture the sets are within 0.19, 0.03 and 0.001 %; single spectra at the family's rim scatter
        // around that by up to six times.
        for (set, ceiling) in [(4, 1.2e-2), (6, 1e-3), (8, 5e-5)] {
            for temperature_k in [1100.0, 1500.0, 1925.0] {
                for depth in [0.1, 1.0, 3.0] {
                    let error = error(WavelengthSet::Fitted(set), temperature_k, depth);
                    assert!(
                        error < ceiling,
                        "{set} nodes, {temperature_k} K, depth {depth}: {error:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn plain_sets_converge() {
        let errors = [16, 32, 64].map(|count| error(WavelengthSet::Plain(count), 1700.0, 1.0));
        assert!(
            errors[0] < 2e-2 && errors[1] < 0.5 * errors[0] && errors[2] < 1e-3,
            "{errors:?}"
        );
    }

    #[test]
    fn an_opaque_ray_is_white_and_a_clear_one_is_nothing() {
        for set in WavelengthSet::ALL {
            let wavelengths = set.wavelengths(LAW);
            let opaque = wavelengths.opacity_of(wavelengths.nodes_nm.iter().map(|_| 1.0));
            // D65's white point, normalised to Y = 1 (CIE 15: x = 0.3127, y = 0.3290).
            for (value, expected) in opaque.into_iter().zip([0.95047, 1.0, 1.08883]) {
                // The tables are the 1 nm observer with D65 at 5 nm: 3e-4 from the rounded white.
                assert!((value - expected).abs() < 5e-4, "{set:?}: {opaque:?}");
            }
            assert_eq!(
                wavelengths.opacity_of(wavelengths.nodes_nm.iter().map(|_| 0.0)),
                [0.0; 3]
            );
        }
    }

    #[test]
    fn a_count_that_no_set_has_is_refused() {
        assert_eq!(WavelengthSet::try_from(6), Ok(WavelengthSet::Fitted(6)));
        assert!(
            WavelengthSet::try_from(31)
                .unwrap_err()
                .contains("16, 32 or 64")
        );
    }

    #[test]
    fn what_a_black_surface_sends_back_changes_no_weight() {
        for set in WavelengthSet::ALL {
            let plain = set.wavelengths(LAW);
            for dark in [0.0, 1e-320] {
                let tinted = set.tinted_wavelengths(LAW, &[&|_| dark]);
                assert_eq!(tinted, plain, "{set:?}, {dark:e}");
            }
        }
    }
}
