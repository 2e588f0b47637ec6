//! Files of every kind become volumes, or errors that help.

mod borders;
mod real;
mod wanted;
mod watching;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec3, IVec3};
use sootlight::project::Project;
use sootlight::render::{Cancel, render_still};
use sootlight::volume::{
    Border, Grid, Limits, Producer, Volume, VolumeError, open, recognise, summarise,
};

pub(super) fn hostile(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/hostile")
        .join(name)
}

fn open_one(path: &Path) -> Result<Volume, VolumeError> {
    open(&[path.to_owned()], &Limits::default())
}

fn write(folder: &Path, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, contents).unwrap();
    path
}

fn grid<'a>(volume: &'a Volume, name: &str) -> &'a Grid {
    volume
        .grid(name)
        .unwrap_or_else(|| panic!("no grid {name}"))
}

fn voxels(min: IVec3, max: IVec3) -> impl Iterator<Item = IVec3> {
    (min.z..max.z).flat_map(move |z| {
        (min.y..max.y).flat_map(move |y| (min.x..max.x).map(move |x| IVec3::new(x, y, z)))
    })
}

/// Packs and renders what was read, as it would be shown; false if it cannot be.
pub(super) fn survives_a_render(volume: Volume, name: &str) -> bool {
    let mut project = Project::default();
    project.render.size = [16, 16];
    let Ok(job) = project.job(&Arc::new(volume)) else {
        return false;
    };
    let scene = job.scene(None);
    let frame = render_still(&scene, &job.settings, &Cancel::never(), &|_| {}).unwrap();
    for pixel in frame.film.pixels() {
        let numbers = pixel.xyz.iter().chain(&pixel.opacity);
        assert!(
            numbers.into_iter().all(|x| x.is_finite()),
            "{name}: {pixel:?}"
        );
    }
    true
}

#[test]
fn every_hostile_file_behaves_as_the_manifest_says() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = b"1 1 1\n".to_vec();
    long.extend(std::iter::repeat_n(b'0', 2_000_000));
    long.extend(b"1\n");
    write(folder.path(), "ascii_long_line.txt", long);

    let manifest = fs::read_to_string(hostile("MANIFEST.tsv")).unwrap();
    let (mut rows, mut rendered) = (0, 0);
    for row in manifest.lines().skip(1) {
        let [name, promise, choice, line, what] = row.split('\t').collect::<Vec<_>>()[..] else {
            panic!("the manifest has five columns: {row}");
        };
        rows += 1;
        assert!(
            promise == choice || promise == "either",
            "{name}: {promise}, {choice}"
        );
        let path = Some(hostile(name)).filter(|path| path.exists());
        let path = path.unwrap_or_else(|| folder.path().join(name));
        let start = Instant::now();
        let result = open_one(&path);
        assert!(
            start.elapsed().as_secs() < 10,
            "{name} took {:?}",
            start.elapsed()
        );
        match result {
            Ok(volume) => {
                assert_eq!(choice, "ok", "{name} ({what}) was read");
                // What was read must survive everything that is done with it.
                let summary = summarise(&volume, Producer::Auto);
                for field in &summary.fields {
                    assert!(
                        field.mapped.0.is_finite() && field.mapped.1.is_finite(),
                        "{name}"
                    );
                }
                rendered += u32::from(survives_a_render(volume, name));
            }
            Err(error) => {
                let message = error.to_string();
                assert_eq!(choice, "err", "{name} ({what}): {message}");
                assert!(message.contains(name), "{name} is not named: {message}");
                if line != "-" {
                    let expected = format!("line {line}:");
                    assert!(
                        message.contains(&expected),
                        "{name}: no {expected} in {message}"
                    );
                }
            }
        }
    }
    assert!(rows > 90, "the manifest was cut: {rows} rows");
    assert!(rendered > 20, "only {rendered} were rendered");
}

#[test]
fn repairs_are_told() {
    for (name, word) in [
        ("ascii_bom.txt", "byte order mark"),
        ("ascii_nan_inf.txt", "in 3 voxels read as 0"),
        ("ascii_negative.txt", "negative values in 1 voxels"),
        ("sparse_duplicates.bin", "2 voxels came more than once"),
        ("vdb_dupnames.vdb", "3 grids named density"),
        ("vdb_trailing_garbage.vdb", "700 bytes"),
        ("vdb_mismatch.vdb", "different voxel sizes"),
        ("vdb_emptygrid.vdb", "no voxel holds data"),
    ] {
        let notes = open_one(&hostile(name)).unwrap().notes.join("\n");
        assert!(notes.contains(word), "{name}: {notes}");
    }
}

#[test]
fn active_tiles_and_backgrounds_are_read() {
    let volume = open_one(&hostile("vdb_tiles_zip.vdb")).unwrap();
    let density = grid(&volume, "density");
    assert_eq!(density.active_voxels(), 128 * 128 * 128 + 1);
    assert_eq!(density.value(IVec3::splat(64)), 1e-6);
    assert_eq!(density.value(IVec3::splat(-1)), 0.0);

    let volume = open_one(&hostile("vdb_bgnonzero_blosc.vdb")).unwrap();
    let temperature = grid(&volume, "temperature");
    assert_eq!(temperature.background(), 300.0);
    assert_eq!(temperature.value(IVec3::splat(1000)), 300.0);
    assert_eq!(temperature.border(), Border::Background);
}

#[test]
fn two_files_of_different_dimensions_are_refused_with_both_names() {
    let names =
        ["density", "temperature"].map(|field| format!("ascii_pair_dims_differ_{field}.txt"));
    let paths = names.each_ref().map(|name| hostile(name));
    let message = open(&paths, &Limits::default()).unwrap_err().to_string();
    for expected in [
        names[0].as_str(),
        names[1].as_str(),
        "2 × 2 × 2",
        "2 × 2 × 3",
    ] {
        assert!(message.contains(expected), "no {expected} in {message}");
    }
}

#[test]
fn a_second_file_fills_the_missing_field_but_never_doubles_one() {
    let folder = tempfile::tempdir().unwrap();
    let soot = write(folder.path(), "a.txt", "2 1 1\n1e-6 2e-6\n");
    let heat = write(folder.path(), "b.txt", "2 1 1\n900 1800\n");
    let volume = open_one(&soot)
        .unwrap()
        .with_file(&heat, &Limits::default())
        .unwrap();
    assert_eq!(grid(&volume, "temperature").value(IVec3::X), 1800.0);
    assert_eq!(grid(&volume, "soot").value(IVec3::X), 2e-6);
    assert_eq!(recognise(&volume).producer, Producer::Physical);
    assert!(Project::default().job(&Arc::new(volume.clone())).is_ok());

    let again = volume.with_file(&soot, &Limits::default());
    assert!(
        matches!(again, Err(VolumeError::SameField { .. })),
        "{again:?}"
    );
    let mixed = volume.with_file(&hostile("vdb_good.vdb"), &Limits::default());
    assert!(
        matches!(mixed, Err(VolumeError::FormatsDoNotMix { .. })),
        "{mixed:?}"
    );
}

#[test]
fn dense_ascii_has_x_fastest_centred_voxels_and_a_clamped_border() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(
        folder.path(),
        "density.txt",
        "2 2 3\n0 1 2 3 4 5\r\n6\t7\n8 9 10 11",
    );
    let volume = open_one(&path).unwrap();
    let density = grid(&volume, "density");
    for voxel in voxels(IVec3::ZERO, IVec3::new(2, 2, 3)) {
        let expected = voxel.x + 2 * (voxel.y + 2 * voxel.z);
        assert_eq!(density.value(voxel), expected as f32);
    }
    assert_eq!(density.value(IVec3::new(9, 9, 9)), 11.0);
    assert_eq!(density.sample_trilinear(DVec3::new(0.5, 0.5, 0.5)), 3.5);
    assert_eq!(
        density.world_from_index().transform_point3(DVec3::ZERO),
        DVec3::splat(0.5)
    );
    assert!(!volume.voxel_size_is_known);
}

#[test]
fn sparse_ascii_is_read_and_checked_line_by_line() {
    let folder = tempfile::tempdir().unwrap();
    let good = write(
        folder.path(),
        "heat.txt",
        "20 20 20 2 300\n1 2 3 900\n19 0 19 1500\n",
    );
    let volume = open_one(&good).unwrap();
    let heat = grid(&volume, "temperature");
    assert_eq!(heat.value(IVec3::new(19, 0, 19)), 1500.0);
    assert_eq!(heat.value(IVec3::new(5, 5, 5)), 300.0);
    for (contents, words) in [
        (
            "20 20 20 2 300\n1 2 3 900\n20 0 19 1500\n",
            "line 3: expected x from 0 to 19",
        ),
        (
            "20 20 20 2 300\n1 2 3 900\n1 2 3 1\n4 5 6 7\n",
            "announces 2 voxels, found more",
        ),
        ("20 20 20 9999999999 300\n1 2 3 900\n", "bytes follow"),
        ("20 20 20 2 300\n1 2 3 900\n1 2 3", "ends within a voxel"),
    ] {
        let path = write(folder.path(), "bad.txt", contents);
        let message = open_one(&path).unwrap_err().to_string();
        assert!(message.contains(words), "no {words} in {message}");
    }
}

#[test]
fn limits_refuse_before_reading() {
    let small = Limits {
        max_bytes: 1000,
        ..Limits::default()
    };
    let error = open(&[hostile("vdb_good.vdb")], &small).unwrap_err();
    assert!(matches!(error, VolumeError::TooLarge { .. }), "{error}");
    let narrow = Limits {
        max_extent_bricks: 8,
        ..Limits::default()
    };
    let error = open(&[hostile("vdb_tiles_zip.vdb")], &narrow).unwrap_err();
    assert!(matches!(error, VolumeError::TooLarge { .. }), "{error}");
}

#[test]
fn nothing_to_open_is_said_plainly() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(
        open(&[], &Limits::default()),
        Err(VolumeError::NoFiles)
    ));
    let missing = open_one(&folder.path().join("missing.vdb"))
        .unwrap_err()
        .to_string();
    assert!(missing.contains("missing.vdb: cannot be read"), "{missing}");
    let dir = open_one(folder.path()).unwrap_err().to_string();
    assert!(dir.contains("a folder"), "{dir}");
}

#[test]
fn a_coloured_binary_file_gives_red_as_density_and_the_largest_channel_as_temperature() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, [red, green, blue]: [f64; 3]| {
        let mut bytes = 1i32.to_le_bytes().to_vec();
        for coordinate in [-3i32, 4, 5] {
            bytes.extend(coordinate.to_le_bytes());
        }
        for channel in [red, green, blue, 1.0] {
            bytes.extend(channel.to_le_bytes());
        }
        open_one(&write(folder.path(), name, bytes)).unwrap()
    };
    let voxel = IVec3::new(-3, 4, 5);
    let heat = file("heat.bin", [900.0, 1500.0, 300.0]);
    assert_eq!(grid(&heat, "temperature").value(voxel), 1500.0);
    assert_eq!(grid(&heat, "temperature").background(), 300.0);
    let soot = file("soot.bin", [1e-6, 3e-6, 2e-6]);
    assert_eq!(grid(&soot, "soot").value(voxel), 1e-6);
    assert_eq!(grid(&soot, "soot").background(), 0.0);
    assert!(soot.notes.iter().any(|note| note.contains("red was taken")));
}

#[test]
fn a_count_that_looks_like_another_format_is_a_count() {
    let folder = tempfile::tempdir().unwrap();
    // As little-endian bytes: the byte order marks of UTF-16, and the first two bytes of gzip.
    for count in [0xfffe_i32, 0xfeff, 0x8b1f] {
        let mut bytes = count.to_le_bytes().to_vec();
        for i in 0..count {
            for coordinate in [i % 64, i / 64 % 64, i / 4096] {
                bytes.extend(coordinate.to_le_bytes());
            }
            for channel in [1e-6_f64; 4] {
                bytes.extend(channel.to_le_bytes());
            }
        }
        let path = write(folder.path(), "soot.bin", &bytes);
        let volume = open_one(&path).unwrap_or_else(|error| panic!("{count}: {error}"));
        assert_eq!(grid(&volume, "soot").active_voxels(), count as u64);
    }
    for contents in [&b"\x1f\x8b\x08\0\0\0\0\0"[..], b"\xff\xfe4\0 \x004\0"] {
        let path = write(folder.path(), "foreign", contents);
        let error = open_one(&path).unwrap_err();
        assert!(matches!(error, VolumeError::Unsupported { .. }), "{error}");
    }
}

#[test]
fn announced_sizes_are_compared_with_the_file_before_they_are_believed() {
    let folder = tempfile::tempdir().unwrap();
    let ascii = write(folder.path(), "big.txt", "1000 1000 1000\n1 2 3");
    let message = open_one(&ascii).unwrap_err().to_string();
    assert!(
        message.contains("announces 1000000000 values, found at most 3"),
        "{message}"
    );
    let message = open_one(&hostile("vdb_trunc_29202.vdb"))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("the file has 29202; it was cut"),
        "{message}"
    );
}
