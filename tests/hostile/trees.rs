//! A small OpenVDB file whose tree is large in memory is refused before the tree is built, and the refusal says how to open it.

use openvdb_rs::grid::{AnyGrid, Grid, GridClass};
use openvdb_rs::io::{Compression, WriteOptions, write_file_with_options};
use openvdb_rs::math::CoordBBox;
use openvdb_rs::metadata::MetaMap;
use sootlight::volume::{Limits, VolumeError, open};

/// Inner nodes along two sides of a square, and the edge of what each stands for, in voxels.
const SIDE: i32 = 20;
const NODE_EDGE: i32 = 128;
/// Edge of a tile in it.
const TILE_EDGE: i32 = 8;
/// The least that can be set, MB.
const LIMIT_MB: f64 = 16.0;

#[test]
fn a_tree_that_would_grow_beyond_the_limit_is_refused_before_it_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flat.vdb");
    let mut grid = Grid::<f32>::new(0.0).with_name("density");
    grid.set_grid_class(GridClass::FogVolume);
    for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
        let [x, y] = [i * NODE_EDGE, j * NODE_EDGE];
        let last = TILE_EDGE - 1;
        let tile = CoordBBox::from_coords(x, y, 0, x + last, y + last, last);
        grid.tree_mut().fill(&tile, 0.5, true);
    }
    let options = WriteOptions {
        compression: Compression::ACTIVE_MASK,
        // Nothing announces what is to come.
        write_grid_stats: false,
    };
    write_file_with_options(&path, &[AnyGrid::from(grid)], &MetaMap::default(), &options).unwrap();
    let length = std::fs::metadata(&path).unwrap().len();
    // 49 KiB of memory for each KiB of the file.
    let expected = 49 * 1024 * (SIDE * SIDE) as u64;
    assert!(length < expected / 40, "{length} bytes");

    let open_within = |mb: f64| open(std::slice::from_ref(&path), &Limits::of_memory_mb(mb));
    let error = open_within(LIMIT_MB).unwrap_err();
    let words = error.to_string();
    let VolumeError::TooLarge {
        needed,
        raise_to_mb: Some(raise_to_mb),
        ..
    } = error
    else {
        panic!("{words}");
    };
    assert!(
        needed > expected && needed < expected + expected / 10,
        "{needed} against {expected}"
    );
    assert!(words.contains("the tree of grid density"), "{words}");
    assert!(
        words.contains(&format!("raise volume.memory_limit_mb to {raise_to_mb}")),
        "{words}"
    );
    let volume = open_within(raise_to_mb as f64).unwrap();
    let voxels = (SIDE * SIDE * TILE_EDGE.pow(3)) as u64;
    assert_eq!(volume.grids[0].active_voxels(), voxels);
}
