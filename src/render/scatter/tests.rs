//! Tests of the light that is scattered once.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test says how near it came, and that it was skipped"
)]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DAffine3, IVec3};
use rayon::prelude::*;

use super::*;
use crate::math::Ray;
use crate::math::lanes::LANES;
use crate::physics::blackbody;
use crate::physics::soot::{Hold, SootModel};
use crate::render::own_light::own_light;
use crate::render::preparation::Preparation;
use crate::render::{Cancel, Effects, Plan, Settings, Switch};
use crate::scene::{
    Air, Camera, Flame, FlameParams, Fuel, GlowParams, Interpolation, Placement, ScatteringParams,
    Stage, WavelengthSet,
};
use crate::volume::{self, Border, Grid, Producer, Volume, procedural};

/// A volume as it opens, with particles of this radius (nm), seen from in front in a square picture.
pub(in crate::render) fn scene(volume: Volume, radius_nm: f64, asymmetry: Option<f64>) -> Scene {
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
        smoke_left_out: None,
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

pub(in crate::render) fn plan(scene: &Scene) -> Plan {
    let settings = Settings {
        size: [24, 24],
        step_voxels: 0.5,
        wavelengths: WavelengthSet::Fitted(6),
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: Effects {
            scattering: Switch::On,
            wavelengths: Switch::Off,
            scattering_orders: Switch::Off,
            ..Effects::AUTO
        },
    };
    Plan::new(scene, &settings)
}

fn with(
    scene: &Scene,
    plan: &Plan,
    again: bool,
    effort: Effort,
    cancel: &Cancel,
) -> Option<InScatter> {
    Preparation::default().during(cancel, |watch| {
        InScatter::with_effort(scene, &plan.tables, again, effort, watch)
    })
}

/// What is scattered once.
fn field(scene: &Scene, plan: &Plan, level: Level) -> InScatter {
    with(scene, plan, false, Effort::of(level), &Cancel::never()).unwrap()
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
    ball_with_smoke(radius, [volume_fraction, 0.0], kelvin)
}

/// The same with smoke in it.
fn ball_with_smoke(radius: f64, [soot, smoke]: [f32; 2], kelvin: f32) -> Volume {
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
            grid("soot", soot, 0.0),
            grid("smoke", smoke, 0.0),
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
        let field = field(&scene, &plan, Level::Fine);
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
        let field = field(&scene, &plan, Level::Coarse);
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
        let fields = [Level::Fine, Level::Coarse].map(|level| field(&scene, &plan, level));
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
fn the_bits_do_not_depend_on_the_number_of_threads_and_a_passed_render_stops() {
    let scene = scene(procedural::torch(), 40.0, None);
    let plan = plan(&scene);
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| field(&scene, &plan, Level::Coarse))
    };
    let (one, two) = (by(1), by(2));
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
    assert!(with(&scene, &plan, false, COARSE, &passed).is_none());
}

#[test]
fn who_waits_is_told_how_far_the_light_is() {
    let scene = scene(procedural::torch(), 60.0, None);
    let plan = plan(&scene);
    let told = Preparation::default();
    let ended = AtomicBool::new(false);
    let shares = std::thread::scope(|scope| {
        let asks = scope.spawn(|| {
            let mut shares = Vec::new();
            while !ended.load(Ordering::Relaxed) {
                shares.extend(told.share());
                shares.dedup();
                std::thread::yield_now();
            }
            shares
        });
        let made = told.during(&Cancel::never(), |watch| {
            InScatter::with_effort(&scene, &plan.tables, true, FINE, watch)
        });
        assert!(made.is_some());
        ended.store(true, Ordering::Relaxed);
        asks.join().unwrap()
    });
    println!("{shares:.2?}");
    assert!(shares.is_sorted(), "{shares:?}");
    let within = |low: f64, high: f64| shares.iter().any(|share| (low..high).contains(share));
    assert!(within(0.0, 0.3) && within(0.3, FIRST_SHARE) && within(FIRST_SHARE, 1.0));
    assert_eq!(told.share(), None);
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
    let field = field(&scene, &plan, Level::Fine);
    let found = read(&scene, &plan, &field, DVec3::ONE);
    assert!(found.iter().all(|light| *light == 0.0));
    assert_eq!(field.orders_left_out(1), 0.0);
}

mod again;
