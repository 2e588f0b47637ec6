//! What the medium is at a point, for each wavelength.

use crate::physics::blackbody;
use crate::physics::phase::HenyeyGreenstein;
use crate::scene::Flame;
use crate::scene::glow::Source;
use crate::spectral::Wavelengths;

use super::params::{Params, Scattering};

/// The optics of one point at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Local {
    /// Absorption coefficient, 1/m.
    pub(super) sigma_a: f64,
    /// Scattering coefficient, 1/m.
    pub(super) sigma_s: f64,
}

impl Local {
    /// Extinction, 1/m.
    pub(super) fn extinction(&self) -> f64 {
        self.sigma_a + self.sigma_s
    }
}

/// What a point of the medium holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Soot volume fraction of the medium.
    pub(super) soot: f64,
    pub(super) kelvin: f64,
    /// The flame field, 0 to 1.
    pub(super) flame: f64,
    /// Which part of the soot is smoke, where the two scatter differently.
    pub(super) smoke: f64,
}

/// The laws of one wavelength: one of the set's, or that at which a part of the radicals' light is carried.
#[derive(Debug, Clone, Copy)]
struct Node {
    lambda_nm: f64,
    /// What the radicals of this part emit where the flame field is 1, W m⁻³ sr⁻¹; `None` at the set's wavelengths.
    radicals: Option<f64>,
    /// Absorption for each unit of the medium's volume fraction, 1/m.
    absorption: f64,
    /// Scattering likewise, where it is soot and where it is smoke.
    scattering: [f64; 2],
    phase: HenyeyGreenstein,
}

impl Node {
    /// Scattering coefficient at a point, 1/m.
    fn scattering(&self, place: &Place) -> f64 {
        self.scattering[0] * (place.soot - place.smoke) + self.scattering[1] * place.smoke
    }
}

/// The laws at all wavelengths.
pub(super) struct Optics {
    nodes: Vec<Node>,
    /// X, Y, Z of a unit of the radicals' light, part by part.
    colours: Vec<[f64; 3]>,
    /// The node by which the soot's glow is compared between places: that which counts most in Y.
    brightest: usize,
}

/// Width of the spectrum for which one node stands when the soot's glow is compared with that of the radicals, nm.
const NODE_NM: f64 = 60.0;

impl Optics {
    pub(super) fn new(flame: &Flame, wavelengths: &Wavelengths, params: &Params) -> Self {
        let node = |lambda_nm: f64, radicals: Option<f64>| {
            let soot = flame.absorption_per_sample(lambda_nm);
            let phase = match params.scattering {
                Scattering::Flame => HenyeyGreenstein::new(flame.asymmetry(lambda_nm)),
                _ => None,
            };
            let (absorption, scattering) = match params.scattering {
                Scattering::Off => (soot, [0.0; 2]),
                Scattering::Flame => (soot, flame.scattering_per_sample(lambda_nm)),
                Scattering::Soot { radius_nm } => {
                    let radius_m = radius_nm * 1e-9;
                    let ratio = flame.soot().scattering_ratio(lambda_nm, radius_m);
                    (soot, [soot * ratio; 2])
                }
                Scattering::Albedo(albedo) => {
                    let albedo = albedo.clamp(0.0, 1.0);
                    (soot * (1.0 - albedo), [soot * albedo; 2])
                }
            };
            Node {
                lambda_nm,
                radicals,
                absorption,
                scattering,
                phase: phase.unwrap_or(params.phase),
            }
        };
        let luminous = wavelengths.xyz.iter().map(|weight| weight[1].abs());
        let brightest = luminous.enumerate().fold(
            (0, 0.0),
            |best, (i, y)| if y > best.1 { (i, y) } else { best },
        );
        let (mut nodes, mut colours): (Vec<Node>, _) = (
            wavelengths
                .nodes_nm
                .iter()
                .map(|&nm| node(nm, None))
                .collect(),
            Vec::new(),
        );
        for feature in flame.glow().features() {
            if let Source::Radical(emission) = feature.source {
                nodes.push(node(feature.lambda_nm, Some(emission)));
                colours.push(feature.colour);
            }
        }
        Self {
            nodes,
            colours,
            brightest: brightest.0,
        }
    }

    /// Soot that absorbs 1/m at the one wavelength there is.
    #[cfg(test)]
    pub(super) fn of_grey_soot() -> Self {
        Self {
            nodes: vec![Node {
                lambda_nm: 555.0,
                radicals: None,
                absorption: 1.0,
                scattering: [0.0; 2],
                phase: HenyeyGreenstein::ISOTROPIC,
            }],
            colours: Vec::new(),
            brightest: 0,
        }
    }

    /// The one place that says what a point of the medium does to light of a wavelength, given by its index.
    ///
    /// Whatever is added here or to [`Optics::emission`] must also show in [`Optics::extinction`] and [`Optics::glow`].
    pub(super) fn local(&self, node: usize, place: &Place) -> Local {
        let node = &self.nodes[node];
        Local {
            sigma_a: node.absorption * place.soot,
            sigma_s: node.scattering(place),
        }
    }

    /// Emission coefficient j there, W m⁻³ sr⁻¹ nm⁻¹ (of radicals W m⁻³ sr⁻¹): of the soot that absorbs, and of whatever
    /// glows without.
    pub(super) fn emission(&self, node: usize, place: &Place) -> f64 {
        let node = &self.nodes[node];
        if let Some(emission) = node.radicals {
            return emission * place.flame;
        }
        let sigma_a = node.absorption * place.soot;
        sigma_a * blackbody::spectral_radiance(node.lambda_nm, place.kelvin)
    }

    /// X, Y, Z of what came at all wavelengths, the set's and the radicals'.
    pub(super) fn xyz_of(&self, wavelengths: &Wavelengths, light: &[f64]) -> [f64; 3] {
        let (set, radicals) = light.split_at(wavelengths.len());
        let mut xyz = wavelengths.xyz_of(set.iter().copied());
        for (light, colour) in radicals.iter().zip(&self.colours) {
            xyz = std::array::from_fn(|c| xyz[c] + light * colour[c]);
        }
        xyz
    }

    /// A wavelength, nm.
    pub(super) fn lambda_nm(&self, node: usize) -> f64 {
        self.nodes[node].lambda_nm
    }

    /// How many wavelengths there are.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether any light is scattered.
    pub(super) fn scatters(&self) -> bool {
        let mut scattering = self.nodes.iter().flat_map(|node| node.scattering);
        scattering.any(|scattering| scattering > 0.0)
    }

    /// Into which directions light of a wavelength, given by its index, is scattered.
    pub(super) fn phase(&self, node: usize) -> HenyeyGreenstein {
        self.nodes[node].phase
    }

    /// The largest extinction σ_a + σ_s of any wavelength at a point, 1/m.
    pub(super) fn extinction(&self, place: &Place) -> f64 {
        self.nodes
            .iter()
            .map(|node| node.absorption * place.soot + node.scattering(place))
            .fold(0.0, f64::max)
    }

    /// How bright a point is in comparison with others, W m⁻³ sr⁻¹: the soot by its emission where the eye sees best.
    pub(super) fn glow(&self, place: &Place) -> f64 {
        let soot = match self.nodes.get(self.brightest) {
            Some(_) => NODE_NM * self.emission(self.brightest, place),
            None => 0.0,
        };
        let parts = self.nodes.iter().filter_map(|node| node.radicals);
        let radicals: f64 = parts
            .zip(&self.colours)
            .map(|(emission, colour)| emission * colour[1])
            .sum();
        soot + radicals * place.flame
    }
}
