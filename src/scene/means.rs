//! Means of what a medium holds and sends out, part by part of its bricks: what bounds are made of. How they are taken is in
//! [`super::brick_means`].

use std::sync::LazyLock;

use glam::DVec3;

use super::fit::gauss_legendre;

/// Wavelengths at which bricks are summed up: as many as show a colour.
pub(crate) const MEANS: usize = 4;
/// Ends of their interval, nm: that of the fitted sets.
const RANGE_NM: [f64; 2] = [410.0, 690.0];

/// Parts of a brick: its eighths; and their edge in voxels.
pub(crate) const PARTS: usize = 8;
pub(crate) const PART_EDGE: usize = 4;

/// One number for each of these wavelengths.
pub(crate) type Spectrum = [f64; MEANS];

/// Those wavelengths, vacuum, nm: Gauss and Legendre's.
pub(crate) static MEANS_NM: LazyLock<Spectrum> = LazyLock::new(|| {
    let nodes = gauss_legendre(MEANS, RANGE_NM);
    std::array::from_fn(|i| nodes[i])
});

/// Means of one part.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PartMean {
    /// Volume fraction of all soot, and of what of it is smoke.
    pub(crate) soot: f64,
    pub(crate) smoke: f64,
    /// f_v B at each wavelength, W m⁻² sr⁻¹ nm⁻¹.
    pub(crate) glow: Spectrum,
    /// f_v B at the soot's mean temperature less its standard deviation: what its cooler places give.
    pub(crate) dim: Spectrum,
    /// Flame field.
    pub(crate) burning: f64,
    /// Temperature of the hottest sample, K.
    pub(crate) hottest_k: f64,
    /// G of [`super::brick_means`] of all soot's light, and of the flame field.
    pub(crate) glow_around: Spectrum,
    pub(crate) burning_around: f64,
    /// The same of f_v G and of the smoke's part of it: what has been scattered once, for a unit of each coefficient.
    pub(crate) scattered_around: [Spectrum; 2],
    /// Steepest |∇T|/T² between samples, 1/(K m): how much gas bends light there, for a refractivity that goes as 1/T.
    pub(crate) steepest: f64,
}

/// Parts taken together as one light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lamp {
    /// Middle of its parts, m.
    pub(crate) middle: DVec3,
    /// Radius of the ball of their volume, m.
    pub(crate) radius_m: f64,
    /// ∫ f_v B dV at each wavelength, W sr⁻¹ nm⁻¹ m, and ∫ of the flame field, m³.
    pub(crate) glow: Spectrum,
    pub(crate) burning: f64,
}

/// Means of a medium.
#[derive(Debug, Clone, Default)]
pub(crate) struct Means {
    /// Of the [`PARTS`] parts of all stored bricks, in the order of their slots, x fastest.
    pub(crate) parts: Vec<PartMean>,
    /// The same light from afar.
    pub(crate) lamps: Vec<Lamp>,
}
