//! Light that is scattered more than once, as a picture adds it, against the unbiased reference.

use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use sootlight::render::null_collision::{Estimate, NullCollision, Params, Scattering};
use sootlight::render::{Cancel, Effects, Settings, Switch, render_still};
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::volume::{Border, Grid, Volume};

use super::super::common;
use super::z_test::Comparison;

const SIZE: [u32; 2] = [12, 12];
/// Edge of a block of pixels that are compared together.
const BLOCK: usize = 3;
const ORDERS: u32 = 16;
/// Relative error of the field of light scattered once, of which all higher orders are made, where its cells are a mean free
/// path wide: its first order is 8 % too bright there and its second 7 % too dim.
const FIELD_ERROR: f64 = 0.08;

/// A ball of white smoke around a small hot core of soot: ten mean free paths from the core to the edge or so.
fn white_cloud(amount: f64) -> Volume {
    const EDGE: i32 = 32;
    let grid = |name: &str, background: f32, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(
            name,
            IVec3::splat(EDGE),
            DAffine3::from_scale(DVec3::splat(0.01)),
            Border::Background,
            background,
            |voxel| {
                let middle = DVec3::splat(0.5 * f64::from(EDGE - 1));
                value((voxel.as_dvec3() - middle).length()) as f32
            },
        )
    };
    let core = |radius: f64| f64::exp(-(radius / 4.0).powi(2));
    let smoke = |radius: f64| f64::exp(-(radius / 12.0).powi(4)) - 0.9 * core(radius);
    Volume::from_grids(
        vec![
            grid("soot", 0.0, &|radius| 1e-6 * core(radius)),
            grid("smoke", 0.0, &|radius| amount * smoke(radius)),
            grid("temperature", 300.0, &|radius| {
                400.0 + 1400.0 * core(radius)
            }),
        ],
        "white cloud",
    )
}

fn scene(amount: f64, more: &[&str]) -> Scene {
    let mut project = common::physical();
    let keys = ["effects.scattering=on", "smoke.albedo=0.99"];
    project.set_all(keys).unwrap();
    project.set_all(more.iter().copied()).unwrap();
    project.render.size = SIZE;
    let job = project.job(&Arc::new(white_cloud(amount))).unwrap();
    job.scene(None)
}

/// XYZ of a still.
fn still(scene: &Scene, scattering_orders: u32) -> Vec<[f64; 3]> {
    let settings = Settings {
        size: SIZE,
        step_voxels: 0.25,
        wavelengths: WavelengthSet::Fitted(6),
        samples_per_pixel: 16,
        scattering_orders,
        effects: Effects {
            scattering: Switch::On,
            ..Effects::AUTO
        },
    };
    let frame = render_still(scene, &settings, &Cancel::never(), &|_| {}).unwrap();
    let pixels = frame.film.pixels().iter();
    pixels.map(|pixel| pixel.xyz.map(f64::from)).collect()
}

/// Sums over blocks of pixels, with their variances.
fn in_blocks(estimates: &[Estimate]) -> Vec<Estimate> {
    let side = SIZE[0] as usize / BLOCK;
    let mut blocks = vec![
        Estimate {
            mean: [0.0; 3],
            variance_of_mean: [0.0; 3],
        };
        side * side
    ];
    for (pixel, estimate) in estimates.iter().enumerate() {
        let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize];
        let block = &mut blocks[y / BLOCK * side + x / BLOCK];
        for c in 0..3 {
            block.mean[c] += estimate.mean[c];
            block.variance_of_mean[c] += estimate.variance_of_mean[c];
        }
    }
    blocks
}

/// Asserts that what is added beyond the first order is what plain paths, that have to find the core, bring.
fn assert_agreement(name: &str, scene: &Scene, samples: u32) {
    let wavelengths = WavelengthSet::Fitted(6).wavelengths(scene.flame.soot());
    let params = Params {
        scattering: Scattering::Flame,
        min_bounces: 2,
        max_bounces: ORDERS,
        ..Params::default()
    };
    let reference = NullCollision::new(scene, &wavelengths, &params);
    let mut expected = in_blocks(&reference.render(SIZE, samples, 3).unwrap());
    let of_noise = expected.clone();
    for estimate in &mut expected {
        for c in 0..3 {
            estimate.variance_of_mean[c] += (FIELD_ERROR * estimate.mean[c]).powi(2);
        }
    }
    let (once, all) = (still(scene, 1), still(scene, ORDERS));
    let added: Vec<Estimate> = once
        .iter()
        .zip(&all)
        .map(|(once, all)| Estimate {
            mean: std::array::from_fn(|c| all[c] - once[c]),
            variance_of_mean: [0.0; 3],
        })
        .collect();
    let added: Vec<[f64; 3]> = in_blocks(&added).iter().map(|block| block.mean).collect();

    let sum = |all: &mut dyn Iterator<Item = f64>| all.sum::<f64>();
    let of_reference = sum(&mut expected.iter().map(|block| block.mean[1]));
    let ours = sum(&mut added.iter().map(|xyz| xyz[1]));
    let first = sum(&mut once.iter().map(|xyz| xyz[1]));
    let agreement = Comparison::new(&expected, &added);
    println!("{name}: {ours:e} of {of_reference:e} beside {first:e}: {agreement:.3?}");
    assert!(
        agreement.pixels >= 12 && agreement.noise < 0.15,
        "{name}: {agreement:?}"
    );
    assert!(agreement.each_agrees(), "{name}: {agreement:?}");
    // The field's error is the same at all places: together it may be off by that, and by the noise.
    let variance = |block: &Estimate| block.variance_of_mean[1];
    let noise = of_noise.iter().map(variance).sum::<f64>().sqrt();
    let off = (ours - of_reference).abs();
    assert!(
        off < FIELD_ERROR * of_reference + 4.0 * noise,
        "{name}: {ours} {of_reference} ± {noise}"
    );
}

#[test]
fn higher_orders_of_a_thick_white_cloud_agree_with_the_reference() {
    assert_agreement("white cloud", &scene(8e-8, &[]), 4096);
}

#[test]
fn higher_orders_agree_where_light_is_scattered_ahead() {
    assert_agreement("ahead", &scene(8e-8, &["soot.asymmetry=0.5"]), 4096);
}
