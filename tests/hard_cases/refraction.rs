//! Cases 41 to 43 and 50: light that is not bent, nearly not bent, or turned back, and the gradients that bend it.
//!
//! Snell's law at a face is no step of the march: paths bend along the gradient of n. They are read off a backdrop behind the
//! gas whose luminance rises evenly with height. The angle of total reflection to eight digits is held beside the code, in
//! `render::eikonal`.

use glam::{DAffine3, DVec3, IVec3};
use sootlight::math::Ray;
use sootlight::physics::moist_air::Dispersion;
use sootlight::render::{Effects, Prober, Switch};
use sootlight::scene::refractivity::{COMMON_PATH_NM, Refractivity};
use sootlight::scene::{Camera, Scene};
use sootlight::volume::{Border, Grid, Volume};

use super::super::common;
use super::{ALONG, LENGTH_M, assert_close, even_with, scene_of};

const BENT: Effects = Effects {
    refraction: Switch::On,
    scattering: Switch::Off,
    ..Effects::AUTO
};

/// X, Y, Z at a point of the picture of 64 × 64 pixels.
fn read(scene: &Scene, point: [f64; 2]) -> [f64; 3] {
    Prober::new(scene, [64, 64], BENT).read(point).unwrap().xyz
}

/// How far above the middle of the backdrop the ray through a point ends, in halves of the frame's height.
fn height(scene: &Scene, point: [f64; 2]) -> f64 {
    let backdrop = scene.stage.backdrop.as_ref().unwrap();
    let screen = backdrop.facing(&scene.camera, [64, 64]).unwrap();
    let middle = scene.camera.view([64, 64]).unwrap().ray(32.0, 32.0);
    read(scene, point)[1] / screen.xyz(&middle)[1] - 1.0
}

#[test]
fn case_41_where_n_does_not_change_every_bit_of_a_direction_stays() {
    let with = |refraction: &str, kelvin: f64| {
        let refraction = format!("effects.refraction={refraction}");
        even_with(0.0, kelvin, &[&refraction, "stage.backdrop=gradient"])
    };
    for kelvin in [300.0, 1500.0] {
        let [bent, straight] = ["on", "off"].map(|switch| with(switch, kelvin));
        // Gas like the air around bends nothing, and there is nothing to normalise.
        assert_eq!(
            Refractivity::new(&bent.flame, COMMON_PATH_NM).is_some(),
            kelvin > 300.0
        );
        for point in [[32.0, 32.0], [0.5, 0.5], [63.5, 17.25], [40.0, 32.0 + 1e-9]] {
            let [bent, straight] = [&bent, &straight].map(|scene| read(scene, point));
            assert!(
                straight[1] > 0.0 && bent == straight,
                "{kelvin} K at {point:?}"
            );
        }
    }
}

/// Length (m), and voxels, of gas in layers: cool below, hot above, smooth between.
const LAYERS_M: f64 = 8.0;
const LAYER_VOXELS: IVec3 = IVec3::new(1, 800, 64);
/// Temperatures below and above, K. The lower one is the air's.
const LAYERS_K: [f64; 2] = [300.0, 1500.0];
/// Height at which a ray enters, m; the layers are 64 mm high, and change between 24 and 40 mm.
const ENTERS_M: f64 = 0.004;

/// The layers, looked into from before them upwards at an angle (rad), with a backdrop so far behind their end.
fn layers(angle: f64, enters_m: f64, backdrop_m: f64) -> Scene {
    let voxel = DVec3::new(0.01, LAYERS_M / f64::from(LAYER_VOXELS.y), 0.001);
    let world = DAffine3::from_scale(voxel) * DAffine3::from_translation(DVec3::new(0.0, 0.5, 0.5));
    let grid = |name: &str, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(name, LAYER_VOXELS, world, Border::Clamp, 0.0, |at| {
            value(f64::from(at.z) + 0.5) as f32
        })
    };
    let kelvin = |millimetres: f64| {
        let u = ((millimetres - 24.0) / 16.0).clamp(0.0, 1.0);
        LAYERS_K[0] + (LAYERS_K[1] - LAYERS_K[0]) * u * u * (3.0 - 2.0 * u)
    };
    let grids = vec![grid("soot", &|_| 0.0), grid("temperature", &kelvin)];
    let backdrop_m = format!("stage.backdrop_distance_m={backdrop_m}");
    let asked = [
        "effects.refraction=on",
        "stage.backdrop=gradient",
        &backdrop_m,
    ];
    let mut scene = scene_of(Volume::from_grids(grids, "layers"), &asked);
    let target = DVec3::Z * enters_m;
    scene.camera = Camera {
        eye: target - 0.5 * DVec3::new(0.0, angle.cos(), angle.sin()),
        target,
        up: DVec3::Z,
        fov_deg: 20.0,
        roll_deg: 0.0,
    };
    scene
}

/// By which angle (rad) a ray that enters the layers at an angle is turned upwards, by where it ends on two backdrops.
fn turned(angle: f64, enters_m: f64) -> f64 {
    let [near, far] = [10.0, 30.0].map(|backdrop_m| {
        let half = (0.5_f64 * 20.0).to_radians().tan() * (0.5 + backdrop_m);
        half * height(&layers(angle, enters_m, backdrop_m), [32.0, 32.0])
    });
    ((far - near) / 20.0).atan()
}

#[test]
fn case_42_beyond_the_critical_angle_light_is_turned_back() {
    // 1.00027 → 1.00005 is n of air and of a flame; the angle of total reflection is that of the ratio.
    let critical_of = |n: [f64; 2]| (n[1] / n[0]).acos();
    assert_close(
        90.0 - critical_of([1.00027, 1.00005]).to_degrees(),
        88.798294,
        1e-8,
        "as stated",
    );
    let scene = layers(0.0, ENTERS_M, 10.0);
    let bent = *scene.flame.bending().unwrap();
    let gas = bent.air.gas(bent.fuel).unwrap();
    let path = Dispersion::at(COMMON_PATH_NM).unwrap();
    let n = LAYERS_K.map(|kelvin| {
        1.0 + gas.refractivity(path, kelvin, bent.air.products_share(bent.fuel, kelvin))
    });
    let critical = critical_of(n);
    assert!(
        (1.1..1.3).contains(&critical.to_degrees()),
        "{}",
        critical.to_degrees()
    );
    for share in [0.5, 0.9, 0.95] {
        // Grazing more than that it comes back at its own angle.
        let angle = share * critical;
        assert_close(
            turned(angle, ENTERS_M),
            -2.0 * angle,
            1e-3,
            &format!("at {share} of it"),
        );
    }
    for share in [1.1, 1.5, 3.0] {
        // Less, and it goes through with n cos φ unchanged.
        let angle = share * critical;
        let behind = (n[0] / n[1] * angle.cos()).acos();
        assert_close(
            turned(angle, ENTERS_M),
            behind - angle,
            1e-3,
            &format!("at {share} of it"),
        );
    }
    // At 90° in even gas nothing happens; in the layer light bends to where n is greater, and comes out of it.
    assert_eq!(turned(0.0, ENTERS_M), 0.0);
    let inside = turned(0.0, 0.032);
    assert!(inside < -0.5 * critical && inside > -critical, "{inside}");
}

/// A column of cubic voxels along y whose gas gets hotter on the way, with even ends.
fn column() -> Volume {
    let voxels = 128;
    let scale = DAffine3::from_scale(DVec3::splat(LENGTH_M / f64::from(voxels)));
    let world = scale * DAffine3::from_translation(DVec3::new(0.0, 0.5, 0.0));
    let grid = |name: &str, value: &(dyn Fn(f64) -> f64 + Sync)| {
        let dims = IVec3::new(1, voxels, 1);
        Grid::from_fn(name, dims, world, Border::Clamp, 0.0, |at| {
            value((f64::from(at.y) + 0.5) / f64::from(voxels)) as f32
        })
    };
    let kelvin = |depth: f64| {
        let u = ((depth - 0.2) / 0.6).clamp(0.0, 1.0);
        450.0 + 1050.0 * u * u * (3.0 - 2.0 * u)
    };
    let grids = vec![grid("soot", &|_| 0.0), grid("temperature", &kelvin)];
    Volume::from_grids(grids, "column")
}

#[test]
fn case_43_at_right_angles_nothing_turns_and_next_to_it_by_its_own_little() {
    let asked = [
        "stage.backdrop=gradient",
        "air.refraction_gain=20",
        "effects.refraction=on",
    ];
    let scene = scene_of(column(), &asked);
    let straight = scene_of(column(), &["stage.backdrop=gradient"]);
    assert_eq!(read(&scene, [32.0, 32.0]), read(&straight, [32.0, 32.0]));
    assert_eq!(height(&scene, [32.0, 32.0]), 0.0);

    // 1e-8 rad: what a cosine cannot tell from none.
    let angle = 1e-8;
    assert_eq!(f64::cos(angle), 1.0);
    let half = (0.5_f64 * ALONG.fov_deg).to_radians().tan();
    let point = [32.0, 32.0 - 32.0 * angle / half];
    // n sin θ stays: θ(s) = θ n₁/n(s), on to the backdrop as it comes out.
    let gas = Refractivity::new(&scene.flame, COMMON_PATH_NM).unwrap();
    let medium = scene.flame.medium();
    let (local, [enter, exit]) = medium
        .enter(&Ray {
            origin: ALONG.eye,
            direction: DVec3::Y,
        })
        .unwrap();
    let n = |at_m: f64| {
        let at = local.at(at_m.clamp(enter + 1e-9, exit - 1e-9)).to_array();
        1.0 + gas.ambient() + f64::from(gas.at(medium, at)[0])
    };
    let backdrop_m = 1.0 + scene.stage.backdrop.as_ref().unwrap().distance_m;
    let steps = 10_000;
    let inside: f64 = (0..steps)
        .map(|i| enter + (exit - enter) * (f64::from(i) + 0.5) / f64::from(steps))
        .map(|at| (exit - enter) / f64::from(steps) * n(enter) / n(at))
        .sum();
    let reach = enter + inside + (backdrop_m - exit) * n(enter) / n(exit);
    let got = height(&scene, point) * half * backdrop_m / angle;
    assert!((reach / backdrop_m - 1.0) > 1e-3, "it is bent at all");
    // 1e-6 of the frame has 1e-10 of itself in f64's last digits; gradients between samples are smoothed.
    assert_close(got, reach, 2e-6, "θ₂/θ₁");
}

#[test]
fn case_50_gradients_of_the_refractivity_keep_their_digits_in_single_precision() {
    // A kelvin for each voxel at 1500 K changes n by 3.5e-8, less than a third of an f32's last digit at 1.
    let voxels = 64;
    let kelvin = |at: f64| 1500.0 + at;
    let volume = common::slab(
        voxels,
        LENGTH_M,
        |_| 0.0,
        |depth| kelvin(depth * f64::from(voxels) - 0.5),
    );
    let scene = scene_of(
        volume,
        &["effects.refraction=on", "stage.backdrop=gradient"],
    );
    let bent = *scene.flame.bending().unwrap();
    let law = bent.air.gas(bent.fuel).unwrap();
    let path = Dispersion::at(COMMON_PATH_NM).unwrap();
    let n_less_one = |at: f64| {
        let kelvin = kelvin(at);
        law.refractivity(path, kelvin, bent.air.products_share(bent.fuel, kelvin))
    };
    let gas = Refractivity::new(&scene.flame, COMMON_PATH_NM).unwrap();
    let medium = scene.flame.medium();
    let along = Ray {
        origin: ALONG.eye,
        direction: DVec3::Y,
    };
    let (local, [enter, _]) = medium.enter(&along).unwrap();
    let voxel_m = LENGTH_M / f64::from(voxels);
    let (mut worst, mut worst_of_n) = (0.0_f64, 0.0_f64);
    for i in 1..voxels - 1 {
        let at = f64::from(i);
        let exact = (n_less_one(at + 1.0) - n_less_one(at - 1.0)) / (2.0 * voxel_m);
        let position = local.at(enter + (at + 0.5) * voxel_m).to_array();
        let [excess, _, slope, _] = gas.at(medium, position).map(f64::from);
        assert_close(gas.ambient() + excess, n_less_one(at), 1e-6, "n − 1");
        worst = worst.max((slope / exact - 1.0).abs());
        // What n itself would have kept.
        let n = |at: f64| f64::from((1.0 + n_less_one(at)) as f32);
        let of_n = (n(at + 1.0) - n(at - 1.0)) / (2.0 * voxel_m);
        worst_of_n = worst_of_n.max((of_n / exact - 1.0).abs());
    }
    assert!(worst < 1e-6, "off by {worst:e}");
    assert!(worst_of_n > 0.5, "n in f32 would be off by {worst_of_n:e}");
}
