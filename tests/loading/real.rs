//! Large real volumes, where `SOOTLIGHT_SHARED` names the folder that holds `data/`.

use std::fs;

use glam::IVec3;
use sootlight::volume::{
    FieldMap, Grid, Limits, Producer, UpAxis, Volume, open, preset, recognise, summarise,
};

use super::{grid, open_one, voxels};
use crate::common::shared;

fn shared_volume(file: &str) -> Option<Volume> {
    let path = shared()?.join("data").join(file);
    Some(open_one(&path).unwrap_or_else(|error| panic!("{error}")))
}

/// Fails unless both grids have a value within `tolerance(a)` of each other in every voxel of their boxes.
fn assert_same(a: &Grid, b: &Grid, shift: IVec3, tolerance: impl Fn(f64) -> f64) {
    let (ab, bb) = (a.bounds(), b.bounds());
    let (min, max) = (ab.min.min(bb.min - shift), ab.max.max(bb.max - shift));
    for voxel in voxels(min, max) {
        let (x, y) = (f64::from(a.value(voxel)), f64::from(b.value(voxel + shift)));
        assert!(
            (x - y).abs() <= tolerance(x),
            "{} at {voxel}: {x} and {y}",
            a.name
        );
    }
}

#[test]
fn every_shared_vdb_opens_with_sane_ranges() {
    let Some(root) = shared() else { return };
    let mut opened = 0;
    for (folder, voxel, up) in [
        ("campfire", 0.01, UpAxis::Z),
        ("pool", 0.00625, UpAxis::Z),
        ("burst", 0.0125, UpAxis::Z),
        ("panfire_seq", 0.01875, UpAxis::Z),
        ("embergen_cc0", 1.0, UpAxis::Z),
    ] {
        for entry in fs::read_dir(root.join("data").join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let volume = open_one(&path).unwrap_or_else(|error| panic!("{error}"));
            opened += 1;
            let plan = preset(Producer::Auto, &volume);
            assert_eq!(plan.up, up);
            let mapped = |map: &FieldMap| volume.grid(&map.grid).is_some();
            assert!(plan.maps.soot.is_some() && plan.maps.iter().all(|(_, map)| mapped(map)));
            for grid in &volume.grids {
                let size = grid.voxel_size();
                assert!(
                    (size - voxel).abs().max_element() < 1e-8,
                    "{} {size}",
                    path.display()
                );
                let (low, high) = grid.range();
                assert!(
                    low <= high && high.is_finite(),
                    "{} {low} {high}",
                    grid.name
                );
            }
            let summary = summarise(&volume, Producer::Auto);
            for field in &summary.fields {
                let sane = match field.kind.name() {
                    "temperature" => 1900.0..2100.0,
                    "flame" => 0.9..1.01,
                    "soot" => 1.8e-6..2.6e-6,
                    _ => 1e-8..5.01e-7,
                };
                assert!(
                    sane.contains(&field.mapped.1),
                    "{} {field:?}",
                    path.display()
                );
            }
        }
    }
    assert!(opened >= 27, "{opened} files");
}

#[test]
fn compressions_and_storage_types_agree() {
    let read = |variant: &str| shared_volume(&format!("campfire/campfire_0022_{variant}.vdb"));
    let Some(plain) = read("none_float") else {
        return;
    };
    for variant in ["zip_float", "blosc_float_fuel_velocity", "blender_original"] {
        let other = read(variant).unwrap();
        for name in ["density", "flame", "temperature"] {
            assert_same(grid(&plain, name), grid(&other, name), IVec3::ZERO, |_| 0.0);
        }
    }
    for variant in ["zip_half", "blosc_half"] {
        let half = read(variant).unwrap();
        for name in ["density", "flame", "temperature"] {
            assert_eq!(grid(&half, name).stored_as(), "half");
            // Ten bits after the leading one, and steps of 6e-8 near zero.
            let tolerance = |value: f64| value.abs() / 2048.0 + 3.1e-8;
            assert_same(
                grid(&plain, name),
                grid(&half, name),
                IVec3::ZERO,
                tolerance,
            );
        }
    }
}

#[test]
fn the_two_report_formats_and_the_vdb_hold_the_same_fire() {
    let Some(vdb) = shared_volume("panfire_seq/panfire_0007.vdb") else {
        return;
    };
    let read = |format: &str, extension: &str| {
        let paths = ["density", "temperature"].map(|field| {
            let file = format!("data/{format}/panfire_{field}.{extension}");
            shared().unwrap().join(file)
        });
        open(&paths, &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
    };
    let (ascii, binary) = (read("dense_ascii", "txt"), read("sparse_binary", "bin"));
    for name in ["density", "temperature"] {
        // Six printed digits.
        let tolerance = |value: f64| value.abs() * 5.1e-6 + 1e-12;
        let (a, b) = (grid(&ascii, name), grid(&binary, name));
        assert_eq!(a.world_from_index(), b.world_from_index());
        for voxel in voxels(a.bounds().min, a.bounds().max) {
            let (x, y) = (f64::from(a.value(voxel)), f64::from(b.value(voxel)));
            assert!(
                (x - y).abs() <= tolerance(x),
                "{name} at {voxel}: {x} and {y}"
            );
        }
    }
    let raw =
        |name: &str, voxel: IVec3| f64::from(grid(&vdb, name).value(voxel + IVec3::new(6, 5, 0)));
    for voxel in voxels(IVec3::ZERO, IVec3::new(40, 34, 63)) {
        let kelvin = 300.0 + 1800.0 * (raw("temperature", voxel) / 2.3).clamp(0.0, 1.0);
        let fraction = 2e-6 * raw("flame", voxel).clamp(0.0, 1.0)
            + 0.5e-6 * (raw("density", voxel) / 0.3).min(1.0);
        let stored = |name: &str| f64::from(grid(&binary, name).value(voxel));
        // The VDB holds halves of what was mapped.
        assert!((kelvin - stored("temperature")).abs() < 1.0, "{voxel}");
        assert!((fraction - stored("density")).abs() < 1.5e-9, "{voxel}");
    }
}

#[test]
fn the_plume_stands_where_its_page_says() {
    let Some(plume) = shared_volume("plume/plume.vdb") else {
        return;
    };
    let (soot, temperature) = (grid(&plume, "soot"), grid(&plume, "temperature"));
    assert!((f64::from(soot.range().1) - 9.48e-7).abs() < 1e-9);
    assert_eq!(temperature.range().1, 2000.0);
    assert_eq!(temperature.background(), 300.0);
    for index in [IVec3::ZERO, IVec3::new(63, 1, 127)] {
        let world = soot.world_from_index().transform_point3(index.as_dvec3());
        let expected = (index.as_dvec3() + 0.5) / 128.0;
        assert!(
            (world - expected).abs().max_element() < 1e-12,
            "{world} {expected}"
        );
    }
    assert_eq!(recognise(&plume).producer, Producer::Physical);
    assert_eq!(preset(Producer::Auto, &plume).voxel_size_m, None);
}
