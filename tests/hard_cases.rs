//! Numerically hard cases, one test for each, numbered and held to its exact limit.
//!
//! The laws are tried in f64 where they stand, in `physics`, `colour` and `math`; what the march computes in f32 is tried
//! on small scenes through the march itself. ε is the distance of 1 to the next number, 2.2e-16 in f64 and 1.2e-7 in f32.
//!
//! The law of a slab stands in no function of its own: it is the march's, in f32, and its opacity in f64 rounded to f32.
//! Where a case asks for f64 there, the unbiased reference is tried, whose sums are f64.
//!
//! The exact angle of case 42 is held beside the code that bends paths, in `render::eikonal`, which is not public; here its
//! pictures are.

use std::sync::Arc;

use glam::DVec3;
use sootlight::physics::blackbody::{self, SECOND_RADIATION_CONSTANT_NM_K};
use sootlight::project::{Project, ProjectError};
use sootlight::render::Plan;
use sootlight::render::march::Marcher;
use sootlight::scene::{Camera, Scene};
use sootlight::volume::{FieldKind, Volume};

use super::common::{self, three};

mod air;
mod colour;
mod geometry;
mod grids;
mod lines;
mod phase;
mod planck;
mod refraction;
mod slab;
mod soot;
mod steps;

/// ε of the march.
const EPSILON_32: f64 = f32::EPSILON as f64;

/// Length of the test slabs, m.
const LENGTH_M: f64 = 0.5;

/// Red, green and blue as the report takes them, nm.
const RGB_NM: [f64; 3] = [650.0, 550.0, 450.0];

/// Photon energy over thermal energy.
fn exponent(lambda_nm: f64, kelvin: f64) -> f64 {
    SECOND_RADIATION_CONSTANT_NM_K / (lambda_nm * kelvin)
}

/// Relative error that Planck's law may have: one ε of T becomes x of B, so no constant would do (case 5).
fn planck_tolerance(lambda_nm: f64, kelvin: f64, epsilon: f64) -> f64 {
    (8.0 + 2.0 * exponent(lambda_nm, kelvin)) * epsilon
}

#[track_caller]
fn assert_close(got: f64, expected: f64, relative: f64, what: &str) {
    let error = (got - expected).abs();
    assert!(
        error <= relative * expected.abs(),
        "{what}: {got:e}, expected {expected:e}: off by {:e}, {relative:e} is allowed",
        error / expected.abs()
    );
}

/// A physical project whose fields may be anything that a gas can be.
fn unbounded(assignments: &[&str]) -> Project {
    let mut project = common::physical();
    project.volume.field_mut(FieldKind::Temperature).grid = Some("temperature".to_owned());
    project
        .set_all(["volume.soot.max=1", "volume.temperature.max=100000"])
        .unwrap();
    project.set_all(assignments.iter().copied()).unwrap();
    project
}

/// Why a project of these assignments gives no picture.
#[track_caller]
fn refusal(assignments: &[&str]) -> ProjectError {
    let volume = common::slab(1, LENGTH_M, |_| 1e-6, |_| 1500.0);
    unbounded(assignments).job(&Arc::new(volume)).unwrap_err()
}

/// Looks along the axis of `common::slab`.
const ALONG: Camera = Camera {
    eye: DVec3::NEG_Y,
    target: DVec3::ZERO,
    up: DVec3::Z,
    fov_deg: 1.0,
    roll_deg: 0.0,
};

fn scene_of(volume: Volume, assignments: &[&str]) -> Scene {
    let mut job = unbounded(assignments).job(&Arc::new(volume)).unwrap();
    job.camera = ALONG;
    job.scene(None)
}

/// A slab of even soot and temperature in one voxel.
fn even(volume_fraction: f64, kelvin: f64) -> Scene {
    even_with(volume_fraction, kelvin, &[])
}

fn even_with(volume_fraction: f64, kelvin: f64, assignments: &[&str]) -> Scene {
    let volume = common::slab(1, LENGTH_M, |_| volume_fraction, |_| kelvin);
    scene_of(volume, assignments)
}

/// Volume fraction that makes the slab so many optical depths deep, rounded as the volume stores it.
fn fraction_of_depth(depth: f64, lambda_nm: f64) -> f64 {
    let clear = even(1e-6, 300.0);
    f64::from((depth / LENGTH_M / clear.flame.absorption_per_sample(lambda_nm)) as f32)
}

/// Optical depth of the slab.
fn depth_of(scene: &Scene, volume_fraction: f64, lambda_nm: f64) -> f64 {
    scene.flame.absorption_per_sample(lambda_nm) * f64::from(volume_fraction as f32) * LENGTH_M
}

/// What the march sees along the middle of the picture at three wavelengths.
#[derive(Debug, PartialEq)]
struct Seen {
    radiance: [f64; 3],
    opacity: [f64; 3],
}

/// Marches the slab in steps of this length (m); one that is longer than the slab is one step.
fn march(scene: &Scene, step_m: f64, nodes_nm: [f64; 3]) -> Seen {
    let plan = Plan::with_wavelengths(scene, [64, 64], three(nodes_nm));
    let step_voxels = step_m / scene.flame.medium().voxel_size_m();
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    let mut points = [None; 16];
    points[5] = Some([32.0, 32.0]);
    let pixel = marcher.march(&points).0[5];
    Seen {
        radiance: pixel.xyz.map(f64::from),
        opacity: pixel.opacity.map(f64::from),
    }
}

/// The same in one step.
fn at_once(scene: &Scene, nodes_nm: [f64; 3]) -> Seen {
    march(scene, 2.0 * LENGTH_M, nodes_nm)
}

/// What the march makes of Planck's law: the light of soot through which nothing can be seen at any wavelength.
fn planck_of_the_march(kelvin: f64, nodes_nm: [f64; 3]) -> [f64; 3] {
    let opaque = even_with(
        fraction_of_depth(100.0, 550.0),
        kelvin,
        &["soot.model=grey"],
    );
    at_once(&opaque, nodes_nm).radiance
}

/// Planck's law as the laws have it.
fn planck(lambda_nm: f64, kelvin: f64) -> f64 {
    blackbody::spectral_radiance(lambda_nm, kelvin)
}
