//! The light of one point of the picture, wavelength by wavelength.

use super::along::Along;
use super::march::{Marcher, Seen};
use super::plan::Plan;
use super::tables::Tables;
use super::{Cancel, Effects, Level};
use crate::colour::cie::MAX_LUMINOUS_EFFICACY;
use crate::physics::blackbody;
use crate::scene::camera::CameraError;
use crate::scene::{Scene, WavelengthSet};
use crate::spectral::Wavelengths;

/// How many wavelengths, evenly over the visible ones: as many as the march takes.
const WAVELENGTHS: WavelengthSet = WavelengthSet::Plain(64);
/// Width of the bands that they stand for, nm: equal parts of 380 to 780 nm.
const BAND_NM: f64 = 6.25;
/// Step of the march in voxels.
const STEP_VOXELS: f64 = 0.5;

/// What a point of the picture sends to the eye.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Wavelength (nm, the middle of its band) and mean spectral radiance (W m⁻² sr⁻¹ nm⁻¹) in it, rising from 380 to
    /// 780 nm in equal bands.
    pub spectrum: Vec<[f64; 2]>,
    /// X, Y and Z of it, W m⁻² sr⁻¹.
    pub xyz: [f64; 3],
    black_body_k: Option<f64>,
}

/// Reads points of one picture. Cheap to make; what scattered, thrown and bent light need is worked out once for all
/// points.
#[derive(Debug)]
pub struct Prober {
    scene: Scene,
    plan: Plan,
}

impl Prober {
    /// A reader of a scene's picture of `size` pixels, with these effects.
    pub fn new(scene: &Scene, size: [u32; 2], effects: Effects) -> Self {
        let wavelengths = WAVELENGTHS.wavelengths(scene.flame.soot());
        Self {
            plan: Plan::measuring(scene, size, wavelengths, effects),
            scene: scene.clone(),
        }
    }

    /// Whether [`Prober::read`] answers in less than a millisecond.
    pub fn is_ready(&self) -> bool {
        self.plan.has_fields(Level::Coarse)
    }

    /// Works out what all points need, in the calling thread's rayon pool: tenths of a second where light is scattered or
    /// falls on a stage.
    pub fn prepare(&self) {
        // Nothing cancels it: there is an answer.
        let _ = self
            .plan
            .fields(&self.scene, Level::Coarse, &Cancel::never());
    }

    /// Marches one ray through a point in pixels from the upper left corner.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn read(&self, point: [f64; 2]) -> Result<Probe, CameraError> {
        let never = Cancel::never();
        let marcher = match self.plan.fields(&self.scene, Level::Coarse, &never) {
            Some(fields) => Marcher::with_fields(&self.scene, &self.plan, fields, STEP_VOXELS)?,
            None => Marcher::new(&self.scene, &self.plan, STEP_VOXELS)?,
        };
        Ok(Probe::seen(&marcher.radiance(point), &self.plan.tables))
    }

    /// What lies along the way of the same ray.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn along(&self, point: [f64; 2]) -> Result<Along, CameraError> {
        Along::new(&self.scene, self.plan.tables.size, point)
    }
}

impl Probe {
    /// One point alone of a picture of `size` pixels with every effect that can be seen; `point` is in pixels from the
    /// upper left corner.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn new(scene: &Scene, size: [u32; 2], point: [f64; 2]) -> Result<Self, CameraError> {
        Prober::new(scene, size, Effects::AUTO).read(point)
    }

    /// The probe of what a ray has seen.
    fn seen(seen: &Seen, tables: &Tables) -> Self {
        let lines = tables.glow.xyz_of(seen.features.iter().copied());
        let beside = std::array::from_fn(|c| lines[c] + seen.backdrop[c]);
        let mut probe = Self::of(&tables.wavelengths, &seen.radiance, beside);
        // A line is narrower than any band: it shows as its mean over the one that it lies in.
        let half = 0.5 * BAND_NM;
        for [nm, radiance] in &mut probe.spectrum {
            *radiance += tables
                .glow
                .light_in([*nm - half, *nm + half], &seen.features)
                / BAND_NM;
        }
        probe
    }

    /// The probe of a radiance at these nodes, with X, Y and Z of what shines beside it.
    fn of(wavelengths: &Wavelengths, radiance: &[f64], beside: [f64; 3]) -> Self {
        let nodes = wavelengths.nodes_nm.iter();
        let smooth = wavelengths.xyz_of(radiance.iter().copied());
        let xyz = std::array::from_fn(|c| smooth[c] + beside[c]);
        Self {
            spectrum: nodes.zip(radiance).map(|(&nm, &l)| [nm, l]).collect(),
            xyz,
            black_body_k: black_body_of_colour(wavelengths, xyz),
        }
    }

    /// Luminance, cd m⁻².
    pub fn luminance(&self) -> f64 {
        MAX_LUMINOUS_EFFICACY * self.xyz[1]
    }

    /// Chromaticity x, y; `None` of what is black.
    pub fn chromaticity(&self) -> Option<[f64; 2]> {
        let sum: f64 = self.xyz.iter().sum();
        (sum > 0.0).then(|| [self.xyz[0] / sum, self.xyz[1] / sum])
    }

    /// Temperature (K) of the black body whose colour this is; `None` where it is no black body's, or black.
    pub fn black_body_k(&self) -> Option<f64> {
        self.black_body_k
    }
}

/// Coldest and hottest black body that is compared with, K.
const BLACK_BODIES_K: [f64; 2] = [700.0, 20_000.0];
/// How far from the black bodies' line, in u′v′, a colour may lie to be called one of theirs: the eye sees 0.004 side by
/// side, and a lamp is called white up to about twice that.
const NEAR: f64 = 0.008;

/// The black body whose u′v′ is nearest, if it is near: by halving the golden way, for along the line the distance has
/// one minimum wherever it is small.
fn black_body_of_colour(wavelengths: &Wavelengths, xyz: [f64; 3]) -> Option<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let seen = uv(xyz)?;
    let distance = |log_k: f64| {
        let planck = |&nm: &f64| blackbody::spectral_radiance(nm, log_k.exp());
        let line = uv(wavelengths.xyz_of(wavelengths.nodes_nm.iter().map(planck)));
        line.map_or(f64::INFINITY, |[u, v]| (u - seen[0]).hypot(v - seen[1]))
    };
    let [mut low, mut high] = BLACK_BODIES_K.map(f64::ln);
    for _ in 0..32 {
        let width = GOLDEN * (high - low);
        if distance(high - width) < distance(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    let middle = 0.5 * (low + high);
    (distance(middle) < NEAR).then(|| middle.exp())
}

/// CIE 1976 u′v′; `None` of what is black.
fn uv([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    let sum = x + 15.0 * y + 3.0 * z;
    (sum > 0.0).then(|| [4.0 * x / sum, 9.0 * y / sum])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use crate::physics::soot::SootLaw;

    fn probe_of(light: impl Fn(f64) -> f64) -> Probe {
        let wavelengths = WAVELENGTHS.wavelengths(SootLaw::default());
        let radiance: Vec<f64> = wavelengths.nodes_nm.iter().map(|&nm| light(nm)).collect();
        Probe::of(&wavelengths, &radiance, [0.0; 3])
    }

    #[test]
    fn a_black_body_has_its_own_temperature() {
        for kelvin in [900.0, 1500.0, 1800.0, 2400.0, 6500.0] {
            let probe = probe_of(|nm| blackbody::spectral_radiance(nm, kelvin));
            let found = probe.black_body_k().unwrap();
            assert!((found / kelvin - 1.0).abs() < 1e-3, "{kelvin} K: {found}");
        }
        // CIE 15: a black body of 2856 K, illuminant A, at x = 0.44757, y = 0.40745.
        let lamp = probe_of(|nm| blackbody::spectral_radiance(nm, 2855.5));
        let [x, y] = lamp.chromaticity().unwrap();
        assert!(
            (x - 0.44757).abs() < 3e-4 && (y - 0.40745).abs() < 3e-4,
            "{x}, {y}"
        );
    }

    #[test]
    fn thin_soot_looks_hotter_than_it_is() {
        let probe = probe_of(|nm| blackbody::spectral_radiance(nm, 1800.0) / nm);
        assert!((1820.0..2100.0).contains(&probe.black_body_k().unwrap()));
    }

    #[test]
    fn other_colours_are_no_black_bodys() {
        let green = probe_of(|nm| f64::from(u8::from((500.0..560.0).contains(&nm))));
        let violet = probe_of(|nm| f64::from(u8::from(nm < 450.0)));
        assert_eq!((green.black_body_k(), violet.black_body_k()), (None, None));
        let black = probe_of(|_| 0.0);
        assert_eq!(
            (
                black.luminance(),
                black.chromaticity(),
                black.black_body_k()
            ),
            (0.0, None, None)
        );
    }
}
