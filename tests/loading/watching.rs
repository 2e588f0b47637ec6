//! How far opening is, and how it is cancelled.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use glam::IVec3;
use sootlight::volume::{BuiltIn, Limits, Volume, VolumeError, Watch, open, open_watched};

use super::{grid, hostile, open_one, voxels, write};

/// One way to come to a volume.
type Way = Box<dyn Fn(&Watch) -> Result<Volume, VolumeError>>;

fn way(path: &Path) -> Way {
    let paths = [path.to_owned()];
    Box::new(move |watch| open_watched(&paths, &Limits::default(), watch))
}

/// A file of 40³ values that lie about 1e-6.
fn dense(folder: &Path, name: &str) -> PathBuf {
    let values: Vec<String> = voxels(IVec3::ZERO, IVec3::splat(40))
        .map(|voxel| format!("{}e-7", voxel.element_sum()))
        .collect();
    write(folder, name, format!("40 40 40\n{}\n", values.join("\n")))
}

/// Voxels of a sparse file, every third of a box, the last first.
fn sparse() -> Vec<(IVec3, f64)> {
    let mut list: Vec<_> = voxels(IVec3::ZERO, IVec3::new(40, 40, 60))
        .filter(|voxel| voxel.element_sum() % 3 == 0)
        .map(|voxel| (voxel, 1e-7 * f64::from(1 + voxel.element_sum())))
        .collect();
    list.reverse();
    list
}

fn sparse_ascii(folder: &Path) -> PathBuf {
    let list = sparse();
    let lines: Vec<String> = list
        .iter()
        .map(|(voxel, value)| format!("{} {} {} {value}", voxel.x, voxel.y, voxel.z))
        .collect();
    let text = format!("40 40 60 {} 0\n{}\n", list.len(), lines.join("\n"));
    write(folder, "sparse.txt", text)
}

fn sparse_binary(folder: &Path) -> PathBuf {
    let list = sparse();
    let mut bytes = (list.len() as i32).to_le_bytes().to_vec();
    for (voxel, value) in list {
        bytes.extend(voxel.to_array().iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend([value; 4].iter().flat_map(|channel| channel.to_le_bytes()));
    }
    write(folder, "sparse.bin", bytes)
}

/// The same grids without the word that their offsets can be relied on.
fn vdb_stream(folder: &Path, name: &str) -> PathBuf {
    let mut bytes = fs::read(hostile(name)).unwrap();
    assert_eq!(bytes[20], 1);
    bytes[20] = 0;
    write(folder, name, bytes)
}

/// Every way, with its name.
fn ways(folder: &Path) -> Vec<(&'static str, Way)> {
    let soot = dense(folder, "soot.txt");
    let heat = dense(folder, "temperature.txt");
    let first = open_one(&soot).unwrap();
    let partner: Way =
        Box::new(move |watch| first.with_file_watched(&heat, &Limits::default(), watch));
    vec![
        ("dense ASCII", way(&soot)),
        ("sparse ASCII", way(&sparse_ascii(folder))),
        ("sparse binary", way(&sparse_binary(folder))),
        ("OpenVDB", way(&hostile("vdb_good.vdb"))),
        ("OpenVDB tiles", way(&hostile("vdb_tiles_zip.vdb"))),
        ("OpenVDB stream", way(&vdb_stream(folder, "vdb_good.vdb"))),
        ("a partner", partner),
        (
            "the torch",
            Box::new(|watch| BuiltIn::Torch.volume_watched(watch)),
        ),
        (
            "the burner",
            Box::new(|watch| BuiltIn::Burner.volume_watched(watch)),
        ),
    ]
}

#[test]
fn the_share_rises_to_one_on_every_way() {
    let folder = tempfile::tempdir().unwrap();
    for (name, way) in ways(folder.path()) {
        let shares = Arc::new(Mutex::new(vec![0.0]));
        let heard = Arc::clone(&shares);
        let watch = Watch::with_listener(move |watch| {
            // The share is read inside the lock: several threads call.
            let mut shares = heard.lock().unwrap();
            shares.push(watch.share());
        });
        way(&watch).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(watch.share(), 1.0, "{name}");
        let shares = shares.lock().unwrap();
        assert!(shares.is_sorted(), "{name}: {shares:?}");
        let widest = shares.windows(2).map(|pair| pair[1] - pair[0]);
        let widest = widest.fold(0.0, f32::max);
        assert!(shares.len() > 8 && widest < 0.6, "{name}: {shares:?}");
    }
}

#[test]
fn a_watch_that_was_cancelled_beforehand_opens_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (name, way) in ways(folder.path()) {
        let watch = Watch::default();
        watch.clone().cancel();
        assert!(watch.is_cancelled());
        let error = way(&watch).err();
        assert!(
            matches!(error, Some(VolumeError::Cancelled)),
            "{name}: {error:?}"
        );
        assert_eq!(watch.share(), 0.0, "{name} was begun");
    }
}

#[test]
fn cancelling_in_the_middle_stops_soon() {
    let folder = tempfile::tempdir().unwrap();
    for (name, way) in ways(folder.path()) {
        for at in [0.01, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0] {
            let told = Arc::new(Mutex::new(None));
            let tell = Arc::clone(&told);
            let watch = Watch::with_listener(move |watch| {
                if watch.share() >= at {
                    watch.cancel();
                    tell.lock().unwrap().get_or_insert(watch.share());
                }
            });
            let error = way(&watch).err();
            assert!(
                matches!(error, Some(VolumeError::Cancelled)),
                "{name} at {at}: {error:?}"
            );
            let told = told.lock().unwrap().unwrap();
            assert!(
                watch.share() < told + 0.05,
                "{name}: told at {told}, stopped at {}",
                watch.share()
            );
        }
    }
}

#[test]
fn the_share_of_several_files_goes_by_their_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let soot = dense(folder.path(), "soot.txt");
    let length = fs::metadata(&soot).unwrap().len();
    // The second file is a third of both, and wrong from the start.
    let bad = write(
        folder.path(),
        "temperature.txt",
        format!("not numbers{}", " ".repeat(length as usize / 2)),
    );
    let watch = Watch::default();
    let error = open_watched(&[soot, bad], &Limits::default(), &watch).unwrap_err();
    assert!(matches!(error, VolumeError::Malformed { .. }), "{error}");
    assert!((0.66..0.75).contains(&watch.share()), "{}", watch.share());
}

#[test]
fn a_stream_gives_the_grids_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["vdb_good.vdb", "vdb_double.vdb", "vdb_mismatch.vdb"] {
        let file = open_one(&hostile(name)).unwrap();
        let stream = open_one(&vdb_stream(folder.path(), name)).unwrap();
        assert_eq!(file.grids.len(), stream.grids.len(), "{name}");
        for from_file in &file.grids {
            let from_stream = grid(&stream, &from_file.name);
            assert_eq!(from_file.bounds(), from_stream.bounds(), "{name}");
            assert_eq!(from_file.range(), from_stream.range(), "{name}");
            assert_eq!(from_file.world_from_index(), from_stream.world_from_index());
            let bounds = from_file.bounds();
            for voxel in voxels(bounds.min, bounds.max) {
                assert_eq!(
                    from_file.value(voxel),
                    from_stream.value(voxel),
                    "{name} {voxel}"
                );
            }
        }
    }
}

#[test]
fn voxels_in_any_order_find_their_bricks() {
    let folder = tempfile::tempdir().unwrap();
    for path in [sparse_ascii(folder.path()), sparse_binary(folder.path())] {
        let volume = open(&[path], &Limits::default()).unwrap();
        let soot = &volume.grids[0];
        let list = sparse();
        assert_eq!(soot.active_voxels(), list.len() as u64);
        for (voxel, value) in list {
            assert_eq!(soot.value(voxel), value as f32, "{voxel}");
            assert_eq!(soot.value(voxel + IVec3::X), 0.0, "{voxel}");
        }
    }
}

#[test]
fn the_last_value_of_a_voxel_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let list = sparse();
    let line = |voxel: &IVec3, value: f64| format!("{} {} {} {value}", voxel.x, voxel.y, voxel.z);
    let wrong = list.iter().map(|(voxel, _)| line(voxel, 9e-6));
    let right = list.iter().map(|(voxel, value)| line(voxel, *value));
    let lines: Vec<String> = wrong.chain(right).collect();
    let text = format!("40 40 60 {} 0\n{}\n", lines.len(), lines.join("\n"));
    let volume = open_one(&write(folder.path(), "soot.txt", text)).unwrap();
    let soot = grid(&volume, "soot");
    for (voxel, value) in list {
        assert_eq!(soot.value(voxel), value as f32, "{voxel}");
    }
}
