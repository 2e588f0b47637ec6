//! Unbiased path tracing by null collisions: the slow reference that the fast methods are held to.
//!
//! # What is computed
//!
//! The whole equation of transfer, dL/ds = −σ_t L + j + σ_s ∫ L Φ dω, with emission, absorption and scattering of any
//! order, for the same flame, camera and wavelengths as the march. There is no step: the only error is noise, whose
//! variance comes with every estimate. Of what glows in the gas beside soot, the radicals are in it; a salt's lines and
//! bands are not: those are held to sums over their profiles. Ground, spheres and logs of the stage stop light and send it
//! back evenly, each wavelength by its reflectance; the backdrop is not in it.
//!
//! # How
//!
//! *Null collisions.* In each brick the path meets tentative collisions at a constant rate μ, at least the largest
//! extinction there (Woodcock et al. 1965). At each it takes a share of the local emission, j/μ times the weight that
//! is left, so that emission is integrated along all of the flight and not only where light happens to be absorbed;
//! then the weight loses the share σ_a/μ, and a random number decides whether the path scatters or goes on as if
//! nothing had been there. Any rate gives the right mean (Novák et al. 2014), so it is raised where the brick may glow:
//! a flight whose light counts spends [`Params::emission_points`] collisions more in proportion to the glow of what it
//! crosses, and one that may scatter no fewer than [`Params::scattering_points`] in proportion to its extinction. Bricks in
//! which nothing shows are jumped over. Soot of which a voxel's edge is more than a hundred optical depths deep counts as that
//! deep: it is opaque either way, a hundredth of a voxel below its surface.
//!
//! *Wavelengths.* All of them travel on one path. The decisions are made with the optics of one, chosen evenly, and
//! each wavelength's light is divided by the mean over all choices of the probability of what happened: the balance
//! heuristic over path densities (Wilkie et al. 2014; Miller, Georgiev and Jarosz 2019). No wavelength's weight ever
//! exceeds their number, however much σ_s differs between them.
//!
//! *Roulette.* A path whose heaviest weight falls below a thousandth ends with the odds that keep the mean.
//!
//! Where absorption and emission balance (everything at one temperature, with surroundings that glow alike) the shares
//! of a path telescope to Planck's radiance without any noise, as long as one law serves all wavelengths or nothing
//! scatters.
//!
//! # Reading
//!
//! [`Params`] say what is simulated, `optics` what the medium is at a point, `bricks` where collisions may be, `surfaces`
//! what a path does at the stage, `path` follows one path, `light` is what it carries, `weights` what that weighs,
//! [`Estimate`] is the mean of many.

use rayon::prelude::*;

use super::Cancel;
use crate::math::Ray;
use crate::math::random::Stream;
use crate::scene::Scene;
use crate::scene::camera::{CameraError, View};
use crate::spectral::Wavelengths;

mod bricks;
mod estimate;
mod light;
mod optics;
mod params;
mod path;
mod surfaces;
mod weights;

pub use estimate::Estimate;
pub use params::{Environment, Params, Scattering};

use estimate::Tally;
use path::Tracer;

/// The reference for one scene and one set of wavelengths.
pub struct NullCollision<'a> {
    scene: &'a Scene,
    wavelengths: &'a Wavelengths,
    tracer: Tracer<'a>,
}

impl<'a> NullCollision<'a> {
    /// Bakes the laws at the wavelengths and finds each brick's bounds.
    pub fn new(scene: &'a Scene, wavelengths: &'a Wavelengths, params: &Params) -> Self {
        Self {
            scene,
            wavelengths,
            tracer: Tracer::new(scene, wavelengths, params),
        }
    }

    /// XYZ (W m⁻² sr⁻¹) of the light through a point of a picture of `size`, in pixels from its upper left corner, as
    /// the mean of `samples` independent paths.
    ///
    /// The same point, number and seed give the same bits; other seeds give independent estimates.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn estimate(
        &self,
        size: [u32; 2],
        point: [f64; 2],
        samples: u32,
        seed: u64,
    ) -> Result<Estimate, CameraError> {
        let view = self.scene.camera.view(size)?;
        Ok(self.through(&view, point, samples, seed, &Cancel::never()))
    }

    /// The mean alone, with a cancel that is asked before each path. Zero if the camera cannot see; nonsense if cancelled.
    pub(super) fn mean(
        &self,
        size: [u32; 2],
        point: [f64; 2],
        samples: u32,
        seed: u64,
        cancel: &Cancel,
    ) -> [f64; 3] {
        let Ok(view) = self.scene.camera.view(size) else {
            return [0.0; 3];
        };
        self.through(&view, point, samples, seed, cancel).mean
    }

    /// [`NullCollision::estimate`] through the centres of all pixels, row by row, in the calling thread's rayon pool.
    ///
    /// # Errors
    /// The camera cannot see.
    pub fn render(
        &self,
        size: [u32; 2],
        samples: u32,
        seed: u64,
    ) -> Result<Vec<Estimate>, CameraError> {
        let view = self.scene.camera.view(size)?;
        let centre = |pixel: u64| {
            [pixel % u64::from(size[0]), pixel / u64::from(size[0])].map(|side| side as f64 + 0.5)
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        Ok((0..pixels)
            .into_par_iter()
            .map(|pixel| self.through(&view, centre(pixel), samples, seed, &Cancel::never()))
            .collect())
    }

    fn through(
        &self,
        view: &View,
        point: [f64; 2],
        samples: u32,
        seed: u64,
        cancel: &Cancel,
    ) -> Estimate {
        let ray: Ray = view.ray(point[0], point[1]);
        let place = point.map(|side| (side as f32).to_bits());
        let mut tally = Tally::default();
        let mut stretches = Vec::new();
        let mut radiance = vec![0.0; self.tracer.len()];
        for sample in 0..samples {
            if cancel.is_cancelled() {
                break;
            }
            radiance.fill(0.0);
            let mut random = Stream::new(seed, place, sample);
            self.tracer
                .trace(&ray, &mut random, &mut stretches, &mut radiance);
            tally.add(self.tracer.xyz_of(self.wavelengths, &radiance));
        }
        tally.estimate()
    }
}
