//! Wavelengths with weights: the containers in which a spectrum travels. No law of nature is here.

/// A set of wavelengths at which radiance is transported, and what turns the radiances into three numbers.
///
/// With L_i the spectral radiance at node i (W m⁻² sr⁻¹ nm⁻¹), `XYZ = Σ_i L_i · xyz_i` in W m⁻² sr⁻¹, unnormalised:
/// luminance is 683 Y cd m⁻². With α_i = 1 − e^{−τ_i} the opacity at node i, `Σ_i α_i · opacity_i` is the XYZ of
/// the opacity under illuminant D65, normalised to Y = 1 for an opaque ray.
#[derive(Debug, Clone, PartialEq)]
pub struct Wavelengths {
    /// Vacuum wavelengths in nm, rising.
    pub nodes_nm: Vec<f64>,
    /// Weight of each node in X, Y and Z, in nm.
    pub xyz: Vec<[f64; 3]>,
    /// Weight of each node's opacity in X, Y and Z of D65, dimensionless.
    pub opacity: Vec<[f64; 3]>,
}

impl Wavelengths {
    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.nodes_nm.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.nodes_nm.is_empty()
    }

    /// XYZ of a spectral radiance given at the nodes, W m⁻² sr⁻¹.
    pub fn xyz_of(&self, radiance: impl IntoIterator<Item = f64>) -> [f64; 3] {
        weighted_sum(radiance, &self.xyz)
    }

    /// XYZ under D65 of an opacity given at the nodes, Y = 1 for an opaque ray.
    pub fn opacity_of(&self, opacity: impl IntoIterator<Item = f64>) -> [f64; 3] {
        weighted_sum(opacity, &self.opacity)
    }
}

fn weighted_sum(values: impl IntoIterator<Item = f64>, weights: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (value, weight) in values.into_iter().zip(weights) {
        for (sum, weight) in sum.iter_mut().zip(weight) {
            *sum += value * weight;
        }
    }
    sum
}
