//! What several kinds of test need: scenes, golden tables, the shared volumes.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use glam::{DAffine3, DVec3, IVec3};
use sootlight::project::{Job, Project};
use sootlight::render::{Effects, Settings, Switch};
use sootlight::scene::{Camera, Scene};
use sootlight::spectral::Wavelengths;
use sootlight::volume::{self, Border, Grid, Limits, Producer, Volume};

/// The folder of shared volumes, or `None` with a word in print.
pub(crate) fn shared() -> Option<PathBuf> {
    let folder = std::env::var_os("SOOTLIGHT_SHARED").map(PathBuf::from);
    if folder.is_none() {
        // Straight to the stream: what a passing test prints is captured and never seen.
        let _ = writeln!(std::io::stderr(), "skipped: SOOTLIGHT_SHARED is not set");
    }
    folder
}

/// Rows of numbers of a table under tests/golden; words become NaN.
pub(crate) fn golden(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/golden")
        .join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        row.split(',')
            .map(|cell| cell.trim().parse().unwrap_or(f64::NAN))
            .collect()
    })
    .collect()
}

/// The project of a physical volume with soot that keeps its volume fraction.
pub(crate) fn physical() -> Project {
    let mut project = Project::default();
    project.volume.producer = Producer::Physical;
    // What is compared with laws along a line is seen along a line.
    project.effects.refraction = Switch::Off;
    project
}

/// Effects for what is compared with laws along a line, or with paths: seen along a line, with light that was scattered
/// once or not at all, at the very wavelengths that were asked for.
pub(crate) fn scattered_alone(scattering: Switch) -> Effects {
    Effects {
        scattering,
        scattering_orders: Switch::Off,
        refraction: Switch::Off,
        wavelengths: Switch::Off,
        ..Effects::AUTO
    }
}

/// Three wavelengths whose radiances land in X, Y and Z as they are.
pub(crate) fn three(nodes_nm: [f64; 3]) -> Wavelengths {
    let unit = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Wavelengths {
        nodes_nm: nodes_nm.to_vec(),
        xyz: unit.clone(),
        opacity: unit,
    }
}

/// The scene of a physical volume seen by a camera.
pub(crate) fn scene(volume: Volume, camera: Camera) -> Scene {
    let mut job = physical().job(&Arc::new(volume)).unwrap();
    job.camera = camera;
    job.scene(None)
}

/// The built-in flame, computed once for all tests.
pub(crate) fn torch() -> Arc<Volume> {
    static TORCH: LazyLock<Arc<Volume>> = LazyLock::new(|| Arc::new(volume::procedural::torch()));
    Arc::clone(&TORCH)
}

/// A job on the built-in flame, as the window would make it at this size.
pub(crate) fn torch_job(size: [u32; 2]) -> Job {
    let mut project = Project::default();
    project.render.size = size;
    project.job(&torch()).unwrap()
}

/// The built-in flame as framed by default in a picture of this shape (width/height).
pub(crate) fn torch_scene(aspect: f64) -> Scene {
    torch_job([(1000.0 * aspect) as u32, 1000]).scene(None)
}

/// A column of n voxels along y, `length` m long and wide, standing on the plane y = 0 around the y axis, with
/// soot and temperature by depth, 0 to 1.
pub(crate) fn slab(
    n: i32,
    length: f64,
    soot: impl Fn(f64) -> f64 + Sync,
    kelvin: impl Fn(f64) -> f64 + Sync,
) -> Volume {
    let voxel = length / f64::from(n);
    let scale = DAffine3::from_scale(DVec3::new(length, voxel, length));
    let world = scale * DAffine3::from_translation(DVec3::new(0.0, 0.5, 0.0));
    let grid = |name: &str, value: &(dyn Fn(f64) -> f64 + Sync)| {
        Grid::from_fn(
            name,
            IVec3::new(1, n, 1),
            world,
            Border::Clamp,
            0.0,
            |voxel| value((f64::from(voxel.y) + 0.5) / f64::from(n)) as f32,
        )
    };
    Volume::from_grids(
        vec![grid("soot", &soot), grid("temperature", &kelvin)],
        "slab",
    )
}

/// A scene file of assets/scenes on the given volume, with its settings at another size.
pub(crate) fn scene_file(name: &str, file: &Path, size: [u32; 2]) -> (Scene, Settings) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets/scenes")
        .join(name);
    let mut project = Project::read(&path).unwrap();
    project.render.size = size;
    let volume = volume::open(&[file.to_path_buf()], &Limits::default()).unwrap();
    let job = project.job(&Arc::new(volume)).unwrap();
    (job.scene(None), job.settings)
}

/// Writes an OpenVDB file of cubes of 12³ voxels of 1 cm. Each has a name and a peak, to which it rises from a tenth of it.
pub(crate) fn write_vdb(path: &Path, grids: &[(&str, f32)]) {
    use openvdb_rs::grid::{AnyGrid, GridClass};
    use openvdb_rs::math::{Coord, Transform};
    const SIDE: i32 = 12;
    let grids: Vec<AnyGrid> = grids
        .iter()
        .map(|&(name, peak)| {
            let transform = Transform::linear(0.01);
            let mut grid = openvdb_rs::grid::Grid::<f32>::new(0.0);
            grid = grid.with_transform(transform).with_name(name);
            grid.set_grid_class(GridClass::FogVolume);
            for i in 0..SIDE.pow(3) {
                let voxel = Coord::new(i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE);
                let share = 0.1 + 0.9 * (i % 97) as f32 / 96.0;
                grid.set_value(&voxel, share * peak);
            }
            AnyGrid::from(grid)
        })
        .collect();
    openvdb_rs::io::write_file(path, &grids, &openvdb_rs::metadata::MetaMap::default()).unwrap();
}
