//! What must not change the picture: the unit of a file, the way a scene is turned, how finely one field is sampled.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use proptest::prelude::*;
use sootlight::scene::{Camera, Scene};
use sootlight::volume::{Border, Grid, Volume};

use super::{NODES_NM, RAYS, Voxels, largest_difference, look, side, voxels};
use crate::common;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 48,
        ..ProptestConfig::default()
    }
}

/// The same fire a quarter turn on: x becomes y, y becomes −x.
fn turned(voxels: &Voxels) -> Voxels {
    let IVec3 { x: w, y: d, z: h } = voxels.dims;
    let from = |values: &[f32]| -> Vec<f32> {
        let places = (0..h).flat_map(|z| (0..w).flat_map(move |y| (0..d).map(move |x| (x, y, z))));
        places
            .map(|(x, y, z)| values[(y + w * ((d - 1 - x) + d * z)) as usize])
            .collect()
    };
    Voxels {
        dims: IVec3::new(d, w, h),
        voxel_m: voxels.voxel_m,
        soot: from(&voxels.soot),
        kelvin: from(&voxels.kelvin),
    }
}

/// So little soot that no step is more than some hundredths of an optical depth: what glows in thicker ones is a matter of
/// where they end.
const THIN: [&str; 1] = ["soot.amount=0.01"];
/// A step at which the march has nearly come to its limit, voxels.
const FINE_STEP: f64 = 1.0 / 128.0;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_file_in_millimetres_is_the_same_fire(voxels in voxels(), side in side(), step in 0.1..2.0_f64) {
        let metres = voxels.scene(side, &[]);
        let size = format!("volume.voxel_size_m={}", voxels.voxel_m);
        let mut project = common::physical();
        project.set_all(["volume.soot.max=1", &size]).unwrap();
        let file = voxels.volume_in(1e3 * voxels.voxel_m);
        let mut job = project.job(&Arc::new(file)).unwrap();
        job.camera = voxels.camera(side);
        let millimetres = job.scene(None);
        let off = largest_difference(&look(&metres, step, NODES_NM), &look(&millimetres, step, NODES_NM));
        // 1e-16 of a place, times what Planck's exponential makes of it, and roundings of f32.
        prop_assert!(off < 2e-6, "{off:e}");
    }

    #[test]
    fn a_scene_turned_by_a_quarter_looks_the_same(voxels in voxels(), side in side()) {
        let [around, above] = side;
        let scenes = [
            voxels.scene(side, &THIN),
            turned(&voxels).scene([around + 0.25, above], &THIN),
        ];
        let [before, after] = [0, 1].map(|i| look(&scenes[i], FINE_STEP, NODES_NM));
        let off = largest_difference(&before, &after);
        // Bricks lie elsewhere in a turned box, and so do the steps that end on their borders: each picture may be off by
        // what its steps leave, which is a third of what twice their length changes (L. F. Richardson 1911), more between
        // voxels of 300 K and 2400 K than elsewhere. Beside that, roundings of f32.
        let [of_before, of_after] = [(0, &before), (1, &after)].map(|(i, fine)| {
            largest_difference(fine, &look(&scenes[i], 2.0 * FINE_STEP, NODES_NM))
        });
        prop_assert!(off < 2e-5 + of_before + of_after, "{off:e} {of_before:e} {of_after:e}");
    }
}

/// A smooth fire: a few round clouds of soot, each with its heat, in a box of a metre.
#[derive(Debug, Clone)]
struct Clouds(Vec<Cloud>);

#[derive(Debug, Clone)]
struct Cloud {
    middle: DVec3,
    radius: f64,
    soot: f64,
    kelvin: f64,
}

fn clouds() -> impl Strategy<Value = Clouds> {
    let cloud = (
        [0.3..0.7_f64, 0.3..0.7, 0.3..0.7],
        0.2..0.4_f64,
        -7.5..-6.0_f64,
        600.0..1500.0_f64,
    );
    let cloud = cloud.prop_map(|(middle, radius, exponent, kelvin)| Cloud {
        middle: DVec3::from_array(middle),
        radius,
        soot: 10.0_f64.powf(exponent),
        kelvin,
    });
    prop::collection::vec(cloud, 1..4).prop_map(Clouds)
}

impl Clouds {
    fn at(&self, place: DVec3) -> [f64; 2] {
        self.0.iter().fold([0.0, 600.0], |[soot, kelvin], cloud| {
            let apart = (place - cloud.middle).length_squared() / (cloud.radius * cloud.radius);
            let share = (-apart).exp();
            [
                soot + cloud.soot * share,
                kelvin.max(600.0 + cloud.kelvin * share),
            ]
        })
    }

    fn scene(&self, n: i32, around: f64) -> Scene {
        let voxel = 1.0 / f64::from(n);
        let world = DAffine3::from_scale(DVec3::splat(voxel))
            * DAffine3::from_translation(DVec3::splat(0.5));
        let grid = |name: &str, field: usize| {
            Grid::from_fn(name, IVec3::splat(n), world, Border::Clamp, 0.0, |at| {
                self.at(world.transform_point3(at.as_dvec3()))[field] as f32
            })
        };
        let volume = Volume::from_grids(vec![grid("soot", 0), grid("temperature", 1)], "clouds");
        let from = DVec3::new((TAU * around).cos(), (TAU * around).sin(), 0.3);
        let middle = DVec3::splat(0.5);
        common::scene(
            volume,
            Camera {
                eye: middle + 3.0 * from,
                target: middle,
                up: DVec3::Z,
                fov_deg: 20.0,
                roll_deg: 0.0,
            },
        )
    }
}

/// How much of the brightest ray's light any ray may change, violet included, when a cloud of ten voxels across is sampled
/// twice as finely: a line between samples misses a curve by an eighth of its second derivative, and Planck's law makes up
/// to thirty times as much of a share of the temperature. Twice as finely again it must be less than half of that.
const RESOLUTION: f64 = 0.3;
/// Differences that are rounding.
const NOTHING: f64 = 1e-3;

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn twice_the_resolution_of_one_field_is_nearly_the_same_picture(clouds in clouds(), around in 0.0..1.0_f64) {
        let looks: [[_; RAYS]; 3] = [24, 48, 96].map(|n| {
            // The same steps in metres.
            look(&clouds.scene(n, around), f64::from(n) / 384.0, NODES_NM)
        });
        let coarse = largest_difference(&looks[0], &looks[1]);
        let fine = largest_difference(&looks[1], &looks[2]);
        prop_assert!(coarse < RESOLUTION, "{coarse:e}");
        prop_assert!(fine < 0.5 * coarse + NOTHING, "{coarse:e}, then {fine:e}");
    }
}
