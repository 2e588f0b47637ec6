//! What the medium is at a point, for each wavelength.

use crate::physics::blackbody;
use crate::scene::Flame;
use crate::spectral::Wavelengths;

use super::params::{Params, Scattering};

/// The optics of one point at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Local {
    /// Absorption coefficient, 1/m.
    pub(super) sigma_a: f64,
    /// Scattering coefficient, 1/m.
    pub(super) sigma_s: f64,
    /// Emission coefficient j, W m⁻³ sr⁻¹ nm⁻¹: of the soot that absorbs, and of whatever glows without.
    pub(super) emission: f64,
}

/// The laws of one wavelength.
#[derive(Debug, Clone, Copy)]
struct Node {
    lambda_nm: f64,
    /// Absorption for each unit of the medium's volume fraction, 1/m.
    absorption: f64,
    /// Scattering likewise.
    scattering: f64,
}

/// The laws at all wavelengths.
pub(super) struct Optics {
    nodes: Vec<Node>,
    /// The node by which glow is compared between places: that which counts most in Y.
    brightest: usize,
}

impl Optics {
    pub(super) fn new(flame: &Flame, wavelengths: &Wavelengths, params: &Params) -> Self {
        let node = |&lambda_nm: &f64| {
            let soot = flame.absorption_per_sample(lambda_nm);
            let [absorption, scattering] = match params.scattering {
                Scattering::Off => [soot, 0.0],
                Scattering::Soot { radius_nm } => {
                    let radius_m = radius_nm * 1e-9;
                    let ratio = flame.soot().scattering_ratio(lambda_nm, radius_m);
                    [soot, soot * ratio]
                }
                Scattering::Albedo(albedo) => {
                    let albedo = albedo.clamp(0.0, 1.0);
                    [soot * (1.0 - albedo), soot * albedo]
                }
            };
            Node {
                lambda_nm,
                absorption,
                scattering,
            }
        };
        let luminous = wavelengths.xyz.iter().map(|weight| weight[1].abs());
        let brightest = luminous.enumerate().fold(
            (0, 0.0),
            |best, (i, y)| if y > best.1 { (i, y) } else { best },
        );
        Self {
            nodes: wavelengths.nodes_nm.iter().map(node).collect(),
            brightest: brightest.0,
        }
    }

    /// The one place that says what a point of the medium does to light of a wavelength, given by its index. `sample`
    /// is the medium's value there: soot volume fraction and temperature (K).
    ///
    /// Whatever is added here must also show in [`Optics::extinction`] and [`Optics::glow`].
    pub(super) fn local(&self, node: usize, [soot, kelvin]: [f64; 2]) -> Local {
        let node = &self.nodes[node];
        let sigma_a = node.absorption * soot;
        Local {
            sigma_a,
            sigma_s: node.scattering * soot,
            emission: sigma_a * blackbody::spectral_radiance(node.lambda_nm, kelvin),
        }
    }

    /// How many wavelengths there are.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether any light is scattered.
    pub(super) fn scatters(&self) -> bool {
        self.nodes.iter().any(|node| node.scattering > 0.0)
    }

    /// The largest extinction σ_a + σ_s of any wavelength for a volume fraction, 1/m.
    pub(super) fn extinction(&self, soot: f64) -> f64 {
        let strongest = self
            .nodes
            .iter()
            .map(|node| node.absorption + node.scattering)
            .fold(0.0, f64::max);
        strongest * soot
    }

    /// How bright a point is in comparison with others: its emission where the eye sees best, W m⁻³ sr⁻¹ nm⁻¹.
    pub(super) fn glow(&self, sample: [f64; 2]) -> f64 {
        self.local(self.brightest, sample).emission
    }
}
