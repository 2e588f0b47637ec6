//! What lies along the way of one ray: temperature, soot and optical depth, for whoever asks why a pixel looks as it does.
//!
//! ```text
//! τ(s) = ∫₀ˢ σ_t(λ) ds′,   σ_t = σ_a + σ_s,   λ = 555 nm
//! ```
//!
//! at the wavelength where the eye sees most by day. By the midpoint rule on straight rays: a bent one strays from it by less
//! than a pixel or two.
//!
//! **Source.** Optical depth: S. Chandrasekhar, *Radiative Transfer* (1960), ch. I.

use crate::scene::Scene;
use crate::scene::camera::CameraError;

/// Wavelength of the optical depth, nm.
pub const DEPTH_NM: f64 = 555.0;
/// Step in voxels.
const STEP_VOXELS: f64 = 0.5;
/// Most steps: a longer way has longer ones.
const MOST_STEPS: f64 = 4096.0;

/// A place on the way of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// From the eye, m.
    pub distance_m: f64,
    /// Temperature, K; 0 where nothing is known of the gas because nothing glows, absorbs or bends light there.
    pub temperature_k: f64,
    /// Soot volume fraction with the scene's amount, smoke within.
    pub soot: f64,
    /// Optical depth at [`DEPTH_NM`] from the eye to the end of the step around this place.
    pub depth: f64,
}

/// The places that a ray passes, nearest first; none where it misses the fire's box.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Along {
    /// Evenly spaced.
    pub places: Vec<Place>,
}

impl Along {
    /// What the ray through a point of a picture of `size` pixels passes; `point` is in pixels from the upper left corner.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn new(scene: &Scene, size: [u32; 2], point: [f64; 2]) -> Result<Self, CameraError> {
        let ray = scene.camera.view(size)?.ray(point[0], point[1]);
        let (flame, medium) = (&scene.flame, scene.flame.medium());
        let Some((local, [enter, exit])) = medium.enter(&ray) else {
            return Ok(Self::default());
        };
        // What is behind a surface is not passed.
        let end = scene
            .stage
            .hit(&ray, exit)
            .map_or(exit, |hit| hit.distance_m);
        let length_m = (end - enter.max(0.0)).max(0.0);
        let steps = (length_m / (STEP_VOXELS * medium.voxel_size_m())).ceil();
        let steps = steps.min(MOST_STEPS);
        let step_m = length_m / steps.max(1.0);
        let absorption = flame.absorption_per_sample(DEPTH_NM);
        let [of_soot, of_smoke] = flame.scattering_per_sample(DEPTH_NM);
        let mut depth = 0.0;
        let place = |i: u32| {
            let distance_m = enter.max(0.0) + (f64::from(i) + 0.5) * step_m;
            let at = local.at(distance_m);
            let [soot, temperature_k] = medium.sample(at);
            let smoke = medium.smoke(at);
            let scattering = of_soot * (soot - smoke) + of_smoke * smoke;
            depth += (absorption * soot + scattering) * step_m;
            Place {
                distance_m,
                temperature_k,
                soot: soot * flame.volume_fraction_factor(),
                depth,
            }
        };
        Ok(Self {
            places: (0..steps as u32).map(place).collect(),
        })
    }

    /// Optical depth of the whole way.
    pub fn depth(&self) -> f64 {
        self.places.last().map_or(0.0, |place| place.depth)
    }

    /// The hottest place at which there is soot; `None` if there is none.
    pub fn hottest(&self) -> Option<Place> {
        let with_soot = self.places.iter().filter(|place| place.soot > 0.0);
        with_soot
            .max_by(|one, other| one.temperature_k.total_cmp(&other.temperature_k))
            .copied()
    }
}
