//! What presets make of small volumes.

use glam::{DAffine3, IVec3};

use super::super::Border;
use super::*;

/// A volume of grids whose values rise from 0 to the peak.
fn volume(grids: &[(&str, f32)]) -> Volume {
    let grid = |(name, peak): &(&str, f32)| {
        let dims = IVec3::new(5, 1, 1);
        Grid::from_fn(
            name,
            dims,
            DAffine3::IDENTITY,
            Border::Background,
            0.0,
            |v| peak * v.x as f32 / 4.0,
        )
    };
    Volume::from_grids(grids.iter().map(grid).collect(), "test")
}

fn top(map: Option<&FieldMap>, raw: f64) -> f64 {
    map.map_or(f64::NAN, |map| map.apply(raw))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs()
}

#[test]
fn blender_heat_becomes_kelvin_and_flame_becomes_soot() {
    let volume = volume(&[("density", 0.3), ("flame", 1.0), ("temperature", 2.4)]);
    assert_eq!(recognise(&volume).producer, Producer::Blender);
    let plan = preset(Producer::Auto, &volume);
    let maps = &plan.maps;
    assert!(near(top(maps.soot.as_ref(), 1.0), 2e-6));
    assert!(near(top(maps.smoke.as_ref(), 0.15), 0.25e-6));
    assert!(near(top(maps.temperature.as_ref(), 2.4), 2000.0));
    assert!(near(top(maps.temperature.as_ref(), 0.0), 300.0));
    assert!(
        plan.assumptions
            .iter()
            .any(|it| it.words.contains("peak of 2.4:")),
        "{:?}",
        plan.assumptions
    );
    assert_eq!(plan.voxel_size_m, None);
}

#[test]
fn physical_fields_keep_their_values_under_every_producer() {
    let volume = volume(&[("density", 2e-6), ("temperature", 1900.0)]);
    assert_eq!(recognise(&volume).producer, Producer::Physical);
    for producer in Producer::ALL {
        let maps = preset(producer, &volume).maps;
        assert!(near(top(maps.soot.as_ref(), 1e-6), 1e-6), "{producer:?}");
        assert!(
            near(top(maps.temperature.as_ref(), 1234.0), 1234.0),
            "{producer:?}"
        );
        assert_eq!(maps.smoke, None, "{producer:?}");
    }
}

#[test]
fn names_are_matched_without_case_and_houdini_is_y_up() {
    let volume = volume(&[("Density", 1.0), ("BURN", 1.0), ("Temperature", 1.2)]);
    let plan = preset(Producer::Auto, &volume);
    assert_eq!(recognise(&volume).producer, Producer::Houdini);
    assert_eq!(plan.up, UpAxis::Y);
    assert_eq!(plan.maps.soot.map(|map| map.grid), Some("BURN".to_owned()));
}

#[test]
fn embergen_flames_are_normalised_and_given_a_size() {
    let volume = volume(&[("flames", 0.18), ("temperature", 1.27)]);
    let plan = preset(Producer::Auto, &volume);
    assert!(near(top(plan.maps.flame.as_ref(), f64::from(0.18f32)), 1.0));
    assert!(near(top(plan.maps.soot.as_ref(), f64::from(0.18f32)), 2e-6));
    assert_eq!(plan.voxel_size_m, Some(0.01));
}

#[test]
fn missing_fields_are_assumed_and_said() {
    for (grids, soot_raw, words) in [
        (&[("flame", 1.0f32)][..], 1.0, "no temperature grid"),
        (&[("density", 0.8)], 0.8, "no flame or soot grid"),
        (
            &[("temperature", 1900.0)],
            1900.0,
            "no soot, flame or density grid",
        ),
    ] {
        let volume = volume(grids);
        let plan = preset(Producer::Auto, &volume);
        assert!(
            near(top(plan.maps.soot.as_ref(), soot_raw), 2e-6),
            "{grids:?}"
        );
        assert!(plan.maps.temperature.is_some(), "{grids:?}");
        assert!(
            plan.assumptions.iter().any(|it| it.words.contains(words)),
            "{:?}",
            plan.assumptions
        );
        assert!(
            plan.maps
                .iter()
                .all(|(_, map)| volume.grid(&map.grid).is_some()),
            "{grids:?}"
        );
    }
    let warm = preset(Producer::Auto, &volume(&[("temperature", 1900.0)]));
    assert_eq!(
        top(warm.maps.soot.as_ref(), 700.0),
        0.0,
        "cold gas has no soot"
    );
}
