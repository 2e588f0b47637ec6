//! What holds for any fire: properties of the march on random volumes, by proptest.
//!
//! Scenes are so small that the whole module takes some seconds; the number of cases is bounded for that.

mod bounds;
mod invariance;
mod sameness;

use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use proptest::prelude::*;
use sootlight::project::Job;
use sootlight::render::march::Marcher;
use sootlight::render::{Pixel, Plan};
use sootlight::scene::{Camera, Scene};
use sootlight::volume::{Border, Grid, Volume};

use crate::common::{self, three};

/// Wavelengths that are looked at, nm: the ends of what is seen, and the middle.
const NODES_NM: [f64; 3] = [700.0, 550.0, 400.0];
/// Rays of a look.
const RAYS: usize = 16;

/// Small boxes of soot and heat.
#[derive(Debug, Clone)]
struct Voxels {
    dims: IVec3,
    voxel_m: f64,
    /// Volume fractions, x fastest.
    soot: Vec<f32>,
    /// Temperatures, K.
    kelvin: Vec<f32>,
}

/// Volume fractions from clear to what a voxel of is opaque.
fn soot() -> impl Strategy<Value = f32> {
    prop_oneof![
        1 => Just(0.0_f32),
        4 => (-10.0_f32..-3.5).prop_map(|exponent| 10.0_f32.powf(exponent)),
    ]
}

fn voxels() -> impl Strategy<Value = Voxels> {
    ([1..6_i32, 1..6, 1..6], 0.005..0.2_f64).prop_flat_map(|(sides, voxel_m)| {
        let dims = IVec3::from_array(sides);
        let count = dims.element_product() as usize;
        let fields = (
            prop::collection::vec(soot(), count),
            prop::collection::vec(300.0_f32..2400.0, count),
        );
        fields.prop_map(move |(soot, kelvin)| Voxels {
            dims,
            voxel_m,
            soot,
            kelvin,
        })
    })
}

impl Voxels {
    /// With this temperature everywhere.
    fn isothermal(mut self, kelvin: f32) -> Self {
        self.kelvin.fill(kelvin);
        self
    }

    fn hottest_k(&self) -> f64 {
        f64::from(self.kelvin.iter().fold(0.0_f32, |most, &it| most.max(it)))
    }

    /// The box around its own middle, in file units of which a voxel has so many.
    fn volume_in(&self, units_of_voxel: f64) -> Volume {
        let middle = 0.5 * (self.dims.as_dvec3() - 1.0);
        let world = DAffine3::from_scale(DVec3::splat(units_of_voxel))
            * DAffine3::from_translation(-middle);
        let grid = |name: &str, values: &[f32]| {
            Grid::from_dense(name, self.dims, values, world, Border::Clamp, 0.0)
        };
        let grids = vec![grid("soot", &self.soot), grid("temperature", &self.kelvin)];
        Volume::from_grids(grids, "random")
    }

    fn job(&self, sets: &[&str]) -> Job {
        let mut project = common::physical();
        project
            .set_all(["volume.soot.max=1", "volume.temperature.grid=temperature"])
            .unwrap();
        project.set_all(sets.iter().copied()).unwrap();
        project
            .job(&Arc::new(self.volume_in(self.voxel_m)))
            .unwrap()
    }

    /// A camera that sees all of it from a side, angles in turns.
    fn camera(&self, [around, above]: [f64; 2]) -> Camera {
        let size = self.dims.as_dvec3().length() * self.voxel_m;
        let (around, above) = (
            std::f64::consts::TAU * around,
            std::f64::consts::TAU * above,
        );
        let from = DVec3::new(
            around.cos() * above.cos(),
            around.sin() * above.cos(),
            above.sin(),
        );
        Camera {
            eye: 2.0 * size * from,
            target: DVec3::ZERO,
            up: DVec3::Z,
            fov_deg: 30.0,
            roll_deg: 0.0,
        }
    }

    fn scene(&self, side: [f64; 2], sets: &[&str]) -> Scene {
        let mut job = self.job(sets);
        job.camera = self.camera(side);
        job.scene(None)
    }
}

/// Sides from which a box is looked at: around in turns, and above, short of straight from above.
fn side() -> impl Strategy<Value = [f64; 2]> {
    [0.0..1.0, -0.2..0.2]
}

/// What sixteen rays over the picture see at three wavelengths.
fn look(scene: &Scene, step_voxels: f64, nodes_nm: [f64; 3]) -> [Pixel; RAYS] {
    let plan = Plan::with_wavelengths(scene, [64, 64], three(nodes_nm));
    let marcher = Marcher::new(scene, &plan, step_voxels).unwrap();
    // Off the lines of symmetry, on which a ray may run along a border of voxels.
    let points = std::array::from_fn(|ray| {
        Some([(ray % 4) as f64, (ray / 4) as f64].map(|at| 9.3 + 15.1 * at))
    });
    marcher.march(&points).0
}

/// The largest difference of two looks, as a share of the brightest of both.
fn largest_difference(a: &[Pixel; RAYS], b: &[Pixel; RAYS]) -> f64 {
    let lights = |pixels: &[Pixel; RAYS]| -> Vec<f64> {
        pixels
            .iter()
            .flat_map(|pixel| pixel.xyz.map(f64::from))
            .collect()
    };
    let (a, b) = (lights(a), lights(b));
    // Channel by channel: violet is a thousandth of red.
    let mut largest: f64 = 0.0;
    for channel in 0..3 {
        let of = |all: &[f64]| {
            all.iter()
                .skip(channel)
                .step_by(3)
                .copied()
                .collect::<Vec<f64>>()
        };
        let (a, b) = (of(&a), of(&b));
        let brightest = a.iter().chain(&b).fold(0.0_f64, |most, &it| most.max(it));
        for (a, b) in a.iter().zip(&b) {
            largest = largest.max((a - b).abs() / brightest.max(f64::MIN_POSITIVE));
        }
    }
    largest
}
