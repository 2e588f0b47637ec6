//! Tests of the light that is scattered once.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test says how near it came, and that it was skipped"
)]

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DAffine3, IVec3};

use super::*;
use crate::math::Ray;
use crate::math::lanes::LANES;
use crate::physics::blackbody;
use crate::physics::soot::{Hold, SootModel};
use crate::render::null_collision::{NullCollision, Params, Scattering};
use crate::render::own_light::own_light;
use crate::render::{Effects, Plan, Settings, Switch};
use crate::scene::{
    Air, Camera, Flame, FlameParams, Fuel, GlowParams, Interpolation, Placement, ScatteringParams,
    Stage, WavelengthSet,
};
use crate::volume::{self, Border, Grid, Limits, Producer, Volume, procedural};

/// A volume as it opens, with particles of this radius (nm), seen from in front in a square picture.
fn scene(volume: Volume, radius_nm: f64, asymmetry: Option<f64>) -> Scene {
    let preset = volume::preset(Producer::Auto, &volume);
    let placement = Placement {
        up: preset.up,
        metres_per_unit: 1.0,
    };
    let params = FlameParams {
        maps: preset.maps,
        placement,
        fuel: Fuel::named("propane").unwrap(),
        soot_model: SootModel::DalzellSarofim,
        soot_radius_nm: radius_nm,
        soot_hold: Hold::Volume,
        soot_amount: 1.0,
        smoke_amount: 1.0,
        glow: GlowParams::default(),
        air: Air::default(),
        interpolation: Interpolation::default(),
        scattering: Some(ScatteringParams {
            asymmetry,
            smoke_albedo: 0.5,
        }),
        bending: None,
    };
    let bounds = crate::scene::flame::world_bounds(&volume, &params.maps, &placement);
    Scene {
        camera: Camera::framing(&bounds, 1.0, 32.0),
        flame: Flame::new(&Arc::new(volume), &params, None),
        stage: Stage::default(),
    }
}

/// A file among the shared volumes; `None` with a word in print if there are none.
fn shared(file: &str) -> Option<Volume> {
    let Some(folder) = std::env::var_os("SOOTLIGHT_SHARED") else {
        eprintln!("skipped: SOOTLIGHT_SHARED is not set");
        return None;
    };
    let path = PathBuf::from(folder).join("data").join(file);
    Some(volume::open(&[path], &Limits::default()).unwrap())
}

fn plan(scene: &Scene) -> Plan {
    let settings = Settings {
        size: [24, 24],
        step_voxels: 0.5,
        wavelengths: WavelengthSet::Fitted(6),
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: Effects {
            scattering: Switch::On,
            ..Effects::AUTO
        },
    };
    Plan::new(scene, &settings)
}

/// J at a position of the lattice, one number for each node, with the place's own light.
fn read(scene: &Scene, plan: &Plan, field: &InScatter, position: DVec3) -> Vec<f64> {
    let [nodes, silent, radicals] = field.counts;
    let mut light = vec![[0.0; LANES]; nodes + silent + radicals];
    field.read(position.to_array(), 3, &mut light);
    let medium = scene.flame.medium();
    let ([all, kelvin], smoke) = (medium.sample(position), medium.smoke(position));
    let nodes = plan.tables.wavelengths.nodes_nm.iter().zip(&light);
    nodes
        .map(|(&nm, light)| {
            let absorption = scene.flame.absorption_per_sample(nm) * all;
            let [by_soot, by_smoke] = scene.flame.scattering_per_sample(nm);
            let depth = absorption + by_soot * (all - smoke) + by_smoke * smoke;
            let emitted = if all > 0.0 {
                absorption * blackbody::spectral_radiance(nm, kelvin)
            } else {
                0.0
            };
            let own = own_light(emitted as f32, depth as f32, 1.0, field.reach_m());
            f64::from((light[3] + own).max(0.0))
        })
        .collect()
}

/// An even ball of soot of this radius in voxels of 1 cm, at one temperature.
fn ball(radius: f64, volume_fraction: f32, kelvin: f32) -> Volume {
    let edge = 2 * radius.ceil() as i32 + 7;
    let middle = DVec3::splat(0.5 * f64::from(edge - 1));
    let grid = |name: &str, inside: f32, outside: f32| {
        Grid::from_fn(
            name,
            IVec3::splat(edge),
            DAffine3::from_scale(DVec3::splat(0.01)),
            Border::Background,
            outside,
            |voxel| {
                let within = (voxel.as_dvec3() - middle).length() < radius;
                if within { inside } else { outside }
            },
        )
    };
    // Hot air around keeps the edge's soot at the ball's temperature.
    Volume::from_grids(
        vec![
            grid("soot", volume_fraction, 0.0),
            grid("temperature", kelvin, kelvin),
        ],
        "ball",
    )
}

/// Middle of the domain in lattice coordinates.
fn middle(scene: &Scene) -> DVec3 {
    scene.flame.medium().domain.centre()
}

#[test]
fn the_middle_of_an_even_ball_sees_its_closed_form_from_all_sides() {
    for asymmetry in [0.0, -0.6, 0.7] {
        let radius = 20.0;
        let scene = scene(ball(radius, 2e-6, 1700.0), 60.0, Some(asymmetry));
        let plan = plan(&scene);
        let field = InScatter::new(&scene, &plan.tables, Level::Fine, &Cancel::never()).unwrap();
        let found = read(&scene, &plan, &field, middle(&scene));
        for (i, &nm) in plan.tables.wavelengths.nodes_nm.iter().enumerate() {
            let absorbed = scene.flame.absorption_per_sample(nm) * 2e-6;
            let all = absorbed + scene.flame.scattering_per_sample(nm)[0] * 2e-6;
            let reach = -(-all * 0.01 * radius).exp_m1();
            let expected = blackbody::spectral_radiance(nm, 1700.0) * absorbed / all * reach;
            // A ball of voxels is as large as a ball to a hundredth of its radius.
            let error = found[i] / expected - 1.0;
            assert!(error.abs() < 0.01, "g {asymmetry}, {nm} nm: {error}");
        }
    }
}

#[test]
fn a_deep_ball_is_a_furnace_whatever_the_asymmetry() {
    // Everything is opaque within three voxels: L = B σ_a/σ_t from everywhere, to the rounding of the weights.
    for asymmetry in [-0.9, 0.0, 0.9] {
        let scene = scene(ball(20.0, 1e-4, 1700.0), 60.0, Some(asymmetry));
        let plan = plan(&scene);
        let field = InScatter::new(&scene, &plan.tables, Level::Coarse, &Cancel::never()).unwrap();
        let found = read(&scene, &plan, &field, middle(&scene));
        for (i, &nm) in plan.tables.wavelengths.nodes_nm.iter().enumerate() {
            let absorbed = scene.flame.absorption_per_sample(nm);
            let all = absorbed + scene.flame.scattering_per_sample(nm)[0];
            let expected = blackbody::spectral_radiance(nm, 1700.0) * absorbed / all;
            let error = found[i] / expected - 1.0;
            assert!(error.abs() < 2e-5, "g {asymmetry}, {nm} nm: {error}");
        }
    }
}

/// The light at a position of the lattice from where a unit vector of the world comes, by small steps in f64.
fn direct(scene: &Scene, nm: f64, position: DVec3, direction: DVec3, step_voxels: f64) -> f64 {
    let medium = scene.flame.medium();
    let origin = medium
        .lattice_from_world
        .inverse()
        .transform_point3(position);
    let ray = Ray::new(origin, -direction).unwrap();
    let Some((local, [enter, exit])) = medium.enter(&ray) else {
        return 0.0;
    };
    let (from, step) = (enter.max(0.0), step_voxels * medium.voxel_size_m());
    let absorption = scene.flame.absorption_per_sample(nm);
    let [soot, smoke] = scene.flame.scattering_per_sample(nm);
    let (mut light, mut depth, mut t) = (0.0, 0.0, from);
    while t < exit {
        let length = step.min(exit - t);
        let at = local.at(t + 0.5 * length);
        let ([all, kelvin], of_smoke) = (medium.sample(at), medium.smoke(at));
        t += length;
        if all <= 0.0 {
            continue;
        }
        let extinction = absorption * all + soot * (all - of_smoke) + smoke * of_smoke;
        let source = absorption * all / extinction * blackbody::spectral_radiance(nm, kelvin);
        light += source * f64::exp(-depth) * -(-extinction * length).exp_m1();
        depth += extinction * length;
    }
    light
}

/// Errors of a field against rays in 300 directions from 400 single places in the soot, at one node: their mean and root
/// mean square, each place weighted by what it sends to the eye, σ_s J. Of a ragged fire the brightest sixty places make
/// up all of the sum.
fn errors(scene: &Scene, plan: &Plan, fields: &[InScatter], asymmetry: f64) -> Vec<[f64; 2]> {
    const PLACES: usize = 400;
    let medium = scene.flame.medium();
    let phase = crate::physics::phase::HenyeyGreenstein::new(asymmetry).unwrap();
    let node = 3;
    let nm = plan.tables.wavelengths.nodes_nm[node];
    let places = (0_u32..).map(|i| {
        let place = crate::math::random::philox([i, 0, 0, 0], [5, 0]);
        let place = [0, 1, 2].map(|axis: usize| f64::from(place[axis]) / f64::from(u32::MAX));
        medium.domain.min + DVec3::from(place) * medium.domain.size()
    });
    let sooty = 0.02 * f64::from(medium.peak_volume_fraction());
    let places: Vec<DVec3> = places
        .take(10_000_000)
        .filter(|place| medium.sample(*place)[0] > sooty)
        .take(PLACES)
        .collect();
    let all = directions(300);
    let expected: Vec<f64> = places
        .par_iter()
        .map(|&position| {
            let world = medium
                .lattice_from_world
                .inverse()
                .transform_point3(position);
            let to_eye = (scene.camera.eye - world).normalize();
            let light = all
                .iter()
                .map(|&way| phase.value(way.dot(to_eye)) * direct(scene, nm, position, way, 0.25));
            let weights = all.iter().map(|way| phase.value(way.dot(to_eye)));
            light.sum::<f64>() / weights.sum::<f64>()
        })
        .collect();
    let of_field = |field: &InScatter| {
        let (mut sum, mut error, mut square) = (0.0, 0.0, 0.0);
        for (&place, expected) in places.iter().zip(&expected) {
            let weight = medium.sample(place)[0] * expected;
            let off = read(scene, plan, field, place)[node] / expected - 1.0;
            sum += weight;
            error += weight * off;
            square += weight * off * off;
        }
        [error / sum, (square / sum).sqrt()]
    };
    fields.iter().map(of_field).collect()
}

#[test]
fn the_field_agrees_with_rays_in_all_directions_from_single_places() {
    for asymmetry in [0.0, 0.5] {
        let scene = scene(procedural::torch(), 60.0, Some(asymmetry));
        let plan = plan(&scene);
        let fields = [Level::Fine, Level::Coarse]
            .map(|level| InScatter::new(&scene, &plan.tables, level, &Cancel::never()).unwrap());
        let [fine, coarse] = errors(&scene, &plan, &fields, asymmetry)[..] else {
            panic!("two fields")
        };
        println!("g {asymmetry}: mean and rms {fine:.4?}, coarse {coarse:.4?}");
        // What 32 and 16 directions leave at single places; their mean is what a picture shows.
        assert!(fine[0].abs() < 0.01 && fine[1] < 0.05, "{fine:?}");
        assert!(coarse[0].abs() < 0.03 && coarse[1] < 0.1, "{coarse:?}");
    }
}

#[test]
#[ignore = "a number for people: half a minute on two cores"]
fn what_is_left_out_is_about_what_the_reference_adds() {
    for radius_nm in [60.0, 80.0] {
        let scene = scene(procedural::torch(), radius_nm, None);
        let field =
            InScatter::new(&scene, &plan(&scene).tables, Level::Fine, &Cancel::never()).unwrap();
        let [once, all] = [1, u32::MAX].map(|bounces| compare(&scene, 8192, bounces).2);
        println!(
            "{radius_nm} nm: {:.5} added, {:.5} estimated",
            all - once,
            field.orders_left_out(1)
        );
    }
}

#[test]
#[ignore = "a table for people: a minute on two cores"]
fn what_accuracy_costs() {
    let files = [
        "pool/pool_0022_zip_half.vdb",
        "plume/plume.vdb",
        "campfire/campfire_0022_zip_half.vdb",
    ];
    let volumes = [("torch", Some(procedural::torch()))].into_iter();
    for (name, volume) in volumes.chain(files.map(|file| (file, shared(file)))) {
        let Some(volume) = volume else { continue };
        let scene = scene(volume, 60.0, None);
        let plan = plan(&scene);
        println!("{name}: {:?} voxels", scene.flame.medium().domain.size());
        let efforts = [
            (8_000, 16),
            (30_000, 16),
            (30_000, 32),
            (250_000, 32),
            (400_000, 32),
            (400_000, 64),
            (700_000, 32),
        ];
        let mut fields = Vec::new();
        for (cells, directions) in efforts {
            let begin = std::time::Instant::now();
            let effort = Effort { cells, directions };
            let field =
                InScatter::with_effort(&scene, &plan.tables, effort, &Cancel::never()).unwrap();
            println!(
                "  {cells} {directions}: {:?} cells of {} voxels, {:.3} s, left out {:.5}",
                field.size,
                1.0 / field.per_voxel,
                begin.elapsed().as_secs_f64(),
                field.orders_left_out(1)
            );
            fields.push(field);
        }
        let asymmetry = scene.flame.asymmetry(plan.tables.wavelengths.nodes_nm[3]);
        for (effort, error) in efforts
            .iter()
            .zip(errors(&scene, &plan, &fields, asymmetry))
        {
            println!("  {effort:?}: mean {:.4}, rms {:.4}", error[0], error[1]);
        }
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads_and_a_passed_render_stops() {
    let scene = scene(procedural::torch(), 40.0, None);
    let plan = plan(&scene);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            InScatter::new(&scene, &plan.tables, Level::Coarse, &Cancel::never()).unwrap()
        })
    };
    let (one, two) = (with(1), with(2));
    let bits = |field: &InScatter| -> Vec<u32> {
        field
            .light
            .iter()
            .flatten()
            .map(|light| light.to_bits())
            .collect()
    };
    assert_eq!(bits(&one), bits(&two));
    assert!(one.light.iter().flatten().all(|light| light.is_finite()));
    assert_eq!(
        one.orders_left_out(1).to_bits(),
        two.orders_left_out(1).to_bits()
    );

    let passed = Cancel::when_passed(Arc::new(1.into()), 0);
    assert!(InScatter::new(&scene, &plan.tables, Level::Coarse, &passed).is_none());
}

#[test]
fn no_fire_scatters_nothing() {
    let empty = Grid::from_fn(
        "soot",
        IVec3::splat(4),
        DAffine3::IDENTITY,
        Border::Background,
        0.0,
        |_| 0.0,
    );
    let scene = scene(Volume::from_grids(vec![empty], "empty"), 40.0, None);
    let plan = plan(&scene);
    let field = InScatter::new(&scene, &plan.tables, Level::Fine, &Cancel::never()).unwrap();
    let found = read(&scene, &plan, &field, DVec3::ONE);
    assert!(found.iter().all(|light| *light == 0.0));
    assert_eq!(field.orders_left_out(1), 0.0);
}

/// XYZ of the ray through a point, with light scattered once, by midpoint steps in f64.
fn marched(scene: &Scene, plan: &Plan, field: &InScatter, ray: &Ray, step_voxels: f64) -> [f64; 3] {
    let medium = scene.flame.medium();
    let Some((local, [enter, exit])) = medium.enter(ray) else {
        return [0.0; 3];
    };
    let nodes = &plan.tables.wavelengths.nodes_nm;
    let laws: Vec<(f64, [f64; 2])> = nodes
        .iter()
        .map(|&nm| {
            (
                scene.flame.absorption_per_sample(nm),
                scene.flame.scattering_per_sample(nm),
            )
        })
        .collect();
    let step = step_voxels * medium.voxel_size_m();
    let (mut light, mut depth) = (vec![0.0; nodes.len()], vec![0.0_f64; nodes.len()]);
    let mut t = enter;
    while t < exit {
        let length = step.min(exit - t);
        let at = local.at(t + 0.5 * length);
        t += length;
        let ([all, kelvin], of_smoke) = (medium.sample(at), medium.smoke(at));
        if all <= 0.0 {
            continue;
        }
        let scattered = read(scene, plan, field, at);
        for (n, &(absorption, [soot, smoke])) in laws.iter().enumerate() {
            let sigma_a = absorption * all;
            let sigma_s = soot * (all - of_smoke) + smoke * of_smoke;
            let emitted = sigma_a * blackbody::spectral_radiance(nodes[n], kelvin);
            let source = (emitted + sigma_s * scattered[n]) / (sigma_a + sigma_s);
            light[n] += source * (-depth[n]).exp() * -(-(sigma_a + sigma_s) * length).exp_m1();
            depth[n] += (sigma_a + sigma_s) * length;
        }
    }
    plan.tables.wavelengths.xyz_of(light)
}

/// Largest |z| of any pixel, mean of z times the root of their number, and the single light's share.
fn compare(scene: &Scene, paths: u32, bounces: u32) -> (f64, [f64; 3], f64) {
    let plan = plan(scene);
    let field = InScatter::new(scene, &plan.tables, Level::Fine, &Cancel::never()).unwrap();
    let params = Params {
        scattering: Scattering::Flame,
        max_bounces: bounces,
        scattering_points: 8.0,
        ..Params::default()
    };
    let reference = NullCollision::new(scene, &plan.tables.wavelengths, &params);
    let size = [12, 12];
    let estimates = reference.render(size, paths, 7).unwrap();
    let view = scene.camera.view(size).unwrap();
    let ours: Vec<[f64; 3]> = (0..size[0] * size[1])
        .into_par_iter()
        .map(|pixel| {
            let [x, y] = [pixel % size[0], pixel / size[0]].map(|side| f64::from(side) + 0.5);
            marched(scene, &plan, &field, &view.ray(x, y), 0.1)
        })
        .collect();
    let peak = ours.iter().map(|xyz| xyz[1]).fold(0.0, f64::max);
    let (mut worst, mut together, mut count) = (0.0_f64, [0.0; 3], 0.0);
    let (mut theirs_y, mut ours_y) = (0.0, 0.0);
    for (estimate, ours) in estimates.iter().zip(&ours) {
        theirs_y += estimate.mean[1];
        ours_y += ours[1];
        if ours[1] < 1e-4 * peak {
            continue;
        }
        count += 1.0;
        for c in 0..3 {
            let z = (estimate.mean[c] - ours[c]) / estimate.variance_of_mean[c].sqrt();
            worst = worst.max(z.abs());
            together[c] += z;
        }
    }
    (
        worst,
        together.map(|z| z / f64::sqrt(count)),
        theirs_y / ours_y - 1.0,
    )
}

#[test]
fn a_ray_with_light_scattered_once_agrees_with_the_reference() {
    let plume = shared("plume/plume.vdb").map(|volume| ("plume", volume));
    let scenes = [("torch", procedural::torch())].into_iter().chain(plume);
    for (name, volume) in scenes {
        let scene = scene(volume, 60.0, None);
        let (worst, together, off) = compare(&scene, 4096, 1);
        println!("{name}: worst {worst:.2}, together {together:.2?}, Y off {off:.5}");
        // One false alarm in a thousand of 432 and of 3 comparisons (Šidák).
        assert!(
            worst < 4.75 && together.iter().all(|z| z.abs() < 3.6),
            "{name}"
        );
    }
}
