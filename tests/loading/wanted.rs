//! Only grids that something needs are read.

use std::fs;
use std::sync::Arc;

use sootlight::project::Project;
use sootlight::volume::{Wanted, Watch, open_wanted};

use super::{Limits, Path, Volume, VolumeError, grid, open_one, survives_a_render, voxels};
use crate::common::write_vdb;

/// Everything that a solver may write: of "fuel" no field is made.
const GRIDS: [(&str, f32); 5] = [
    ("density", 0.4),
    ("flame", 1.0),
    ("fuel", 0.7),
    ("soot", 2e-6),
    ("temperature", 1900.0),
];

fn open_for(path: &Path, wanted: &Wanted) -> Result<Volume, VolumeError> {
    open_wanted(
        &[path.to_owned()],
        wanted,
        &Limits::default(),
        &Watch::default(),
    )
}

fn names(volume: &Volume) -> [Vec<&str>; 2] {
    [
        volume.grids.iter().map(|it| it.name.as_str()).collect(),
        volume.unread.iter().map(|it| it.name.as_str()).collect(),
    ]
}

fn wanted(sets: &[&str]) -> Wanted {
    let mut project = Project::default();
    for set in sets {
        project.set(set).unwrap();
    }
    project.wanted()
}

const BOTH_OFF: [&str; 2] = ["effects.chemiluminescence=off", "effects.smoke=off"];

#[test]
fn what_no_active_effect_reads_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fire.vdb");
    write_vdb(&path, &GRIDS);
    // The same without the word that its offsets can be relied on.
    let stream = folder.path().join("stream.vdb");
    let mut bytes = fs::read(&path).unwrap();
    bytes[20] = 0;
    fs::write(&stream, bytes).unwrap();
    for path in [&path, &stream] {
        let whole = open_one(path).unwrap();
        assert_eq!(names(&whole), [GRIDS.map(|it| it.0).to_vec(), Vec::new()]);
        let fields = open_for(path, &wanted(&[])).unwrap();
        assert_eq!(
            names(&fields),
            [
                vec!["density", "flame", "soot", "temperature"],
                vec!["fuel"]
            ]
        );
        let few = open_for(path, &wanted(&BOTH_OFF)).unwrap();
        assert_eq!(
            names(&few),
            [
                vec!["soot", "temperature"],
                vec!["density", "flame", "fuel"]
            ]
        );
        let fuel = open_for(path, &wanted(&["volume.flame.grid=fuel"])).unwrap();
        assert!(fuel.grid("fuel").is_some());
        for some in [&fields, &few] {
            for read in &some.grids {
                let same = grid(&whole, &read.name);
                let bounds = same.bounds();
                assert_eq!(read.bounds(), bounds);
                assert!(voxels(bounds.min, bounds.max).all(|it| read.value(it) == same.value(it)));
            }
        }
        assert_eq!(
            fields.lacks(&wanted(&["volume.flame.grid=fuel"])),
            Some("fuel")
        );
        assert_eq!(few.lacks(&wanted(&BOTH_OFF[..1])), Some("density"));
        assert_eq!(few.lacks(&wanted(&[])), Some("flame"));
        assert_eq!(fields.lacks(&wanted(&BOTH_OFF)), None);
        assert_eq!(fields.lacks(&wanted(&[])), None);
        // Whoever renders without what is wanted is told.
        let job = Project::default().job(&Arc::new(few)).unwrap();
        assert!(
            job.flaws
                .iter()
                .any(|it| it.starts_with("flame was not read"))
        );
    }
}

#[test]
fn damage_in_a_grid_that_is_not_read_does_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fire.vdb");
    write_vdb(&path, &GRIDS);
    let mut bytes = fs::read(&path).unwrap();
    let ends: Vec<usize> = ["flame", "fuel", "soot"]
        .map(|name| {
            let name = name.as_bytes();
            let at = bytes.windows(name.len()).position(|it| it == name);
            at.unwrap()
        })
        .to_vec();
    // From the middle of the fuel's tree to the next grid.
    bytes[usize::midpoint(ends[1], ends[2])..ends[2] - 8].fill(0xff);
    fs::write(&path, bytes).unwrap();
    assert!(matches!(
        open_one(&path),
        Err(VolumeError::Malformed { .. })
    ));
    let fields = open_for(&path, &wanted(&[])).unwrap();
    assert!(survives_a_render(fields, "fuel is damaged"));
}
