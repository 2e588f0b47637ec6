//! Cases 59 and 60: a grid far away from the origin, and files that are none.

use std::sync::Arc;

use glam::{DAffine3, DVec3, IVec3};
use sootlight::render::{Prober, Switch};
use sootlight::scene::{Camera, Scene};
use sootlight::volume::{Border, Grid, Limits, Volume, VolumeError, open};

use super::super::common;
use super::{ALONG, RGB_NM, assert_close, march, scene_of, unbounded};

/// A ball of soot of 32³ voxels of a millimetre, looked at from half a metre.
fn far_away(origin: DVec3) -> Scene {
    let world = DAffine3::from_translation(origin) * DAffine3::from_scale(DVec3::splat(1e-3));
    let grid = |name: &str, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(
            name,
            IVec3::splat(32),
            world,
            Border::Background,
            0.0,
            |voxel| {
                let from_middle = (voxel.as_dvec3() - 15.5).length() / 16.0;
                value((1.0 - from_middle * from_middle).max(0.0)) as f32
            },
        )
    };
    let grids = vec![
        grid("soot", &|inside| 1e-5 * inside),
        grid("temperature", &|inside| 1200.0 + 600.0 * inside),
    ];
    let mut scene = scene_of(Volume::from_grids(grids, "far"), &[]);
    // Of the middle, beside the middle line of the voxels.
    let target = origin + DVec3::new(0.0153, 0.0155, 0.0161);
    scene.camera = Camera {
        eye: target - 0.5 * DVec3::Y,
        target,
        ..ALONG
    };
    scene
}

#[test]
fn case_59_a_hundred_thousand_kilometres_away_millimetres_do_not_jitter() {
    let near = march(&far_away(DVec3::ZERO), 2e-4, RGB_NM);
    assert!(near.radiance.iter().all(|light| *light > 0.0));
    let far = march(&far_away(DVec3::new(1e8, -1e8, 1e8)), 2e-4, RGB_NM);
    for c in 0..3 {
        // f64 has 1.5e-8 m there, 1.5e-5 voxels, over which a tenth of all there is changes in a voxel.
        assert_close(far.radiance[c], near.radiance[c], 2e-5, "radiance");
        assert_close(far.opacity[c], near.opacity[c], 2e-5, "opacity");
    }
}

#[test]
fn case_60_a_file_that_is_no_volume_is_refused_with_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let read = |contents: &[u8]| {
        let path = folder.path().join("soot.txt");
        std::fs::write(&path, contents).unwrap();
        open(&[path], &Limits::default())
    };
    for (contents, words) in [
        ("0 2 2\n", "line 1: "),
        ("2 -1 2\n1 2 3 4", "line 1: "),
        ("4294967296 4294967296 1\n1", "line 1: "),
        ("65536 65536 65536\n1", "soot.txt: "),
        ("18446744073709551617 1 1\n1", "line 1: "),
        (
            "2 2 2\n1 2 3 4 5 6 7",
            "announces 8 values, found at most 7",
        ),
        ("2 2 1\n1 2 3 4 5", "found 5"),
        ("2 1\n1 2", "expected the header"),
        ("2 1 1\n1 x", "line 2: "),
    ] {
        let error = read(contents.as_bytes()).unwrap_err();
        let typed = matches!(
            error,
            VolumeError::Malformed { .. } | VolumeError::TooLarge { .. }
        );
        let said = error.to_string();
        assert!(
            typed && said.contains(words) && said.contains("soot.txt"),
            "{contents:?}: {said}"
        );
    }
    assert!(matches!(read(b""), Err(VolumeError::Empty { .. })));
    // A count whose records would be 2³² + 84 bytes, one that is negative, and records that are cut.
    for count in [97_612_895_i32, -1, i32::MAX, 3] {
        let mut bytes = count.to_le_bytes().to_vec();
        bytes.extend([0; 84]);
        assert!(
            matches!(read(&bytes), Err(VolumeError::Malformed { .. })),
            "{count}"
        );
    }
    // Values that are no numbers are read as none, which is said, and make a picture.
    let volume = read(b"2 1 2\n1e-6 nan\ninf -inf").unwrap();
    let notes = volume.notes.join("\n");
    assert!(
        notes.contains("NaN, infinity or values beyond 1e20 in 3 voxels read as 0"),
        "{notes}"
    );
    let mut project = unbounded(&[]);
    project.volume.temperature.grid = None;
    let scene = project.job(&Arc::new(volume)).unwrap().scene(None);
    let seen = Prober::new(&scene, [8, 8], common::scattered_alone(Switch::Off));
    assert!(
        seen.read([4.0, 4.0])
            .unwrap()
            .xyz
            .iter()
            .all(|v| v.is_finite())
    );
}
