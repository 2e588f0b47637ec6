//! How time and memory grow with what they depend on, with exponents fitted by least squares of the logarithms.
//!
//! ```text
//! cargo bench --bench growth
//! ```
//!
//! An exponent of 1 is linear. All cases of a table are timed by turns within one run, medians are printed. Times of a shared
//! machine vary: compare ratios, and of one run only.
//!
//! * `march`: emission and absorption, after a plan; `all effects`: plan, fields and march with every effect automatic.
//! * memory: that of a process of its own as the system tells it (Linux), beside what the program counts itself. `peak` is
//!   over what the process had before, as `resident` is.

#![allow(clippy::print_stdout, reason = "what a bench is for")]

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use sootlight::project::{Job, Project};
use sootlight::render::{Cancel, Effects, Plan, Settings, Switch, render_planned, render_still};
use sootlight::scene::{Scene, WavelengthSet};
use sootlight::volume::{Border, BuiltIn, Grid, Volume};

mod fit;
mod made;
mod resident;

use fit::{Axis, Case};
use made::Fire;

/// Why nothing can be measured.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Side of a picture, pixels, where that is not what grows.
const PICTURE: u32 = 256;
/// Worker threads where they are not what grows.
const THREADS: usize = 2;
/// Voxels along the longest side.
const VOXELS: [i32; 4] = [64, 128, 256, 512];
/// Voxels along the longest side with all effects.
const FEWER_VOXELS: [i32; 3] = [64, 128, 256];
/// Sides of pictures, pixels.
const SIDES: [u32; 4] = [128, 256, 512, 1024];
/// Sides of pictures with all effects.
const FEWER_SIDES: [u32; 3] = [128, 256, 512];
const WAVELENGTHS: [WavelengthSet; 6] = [
    WavelengthSet::Fitted(4),
    WavelengthSet::Fitted(6),
    WavelengthSet::Fitted(8),
    WavelengthSet::Plain(16),
    WavelengthSet::Plain(32),
    WavelengthSet::Plain(64),
];
/// Radii of a column of flame, each with four times the voxels of the one before; the side of its cube.
const RADII: [f64; 4] = [0.05, 0.1, 0.2, 0.4];
const COLUMN_SIDE: i32 = 256;
/// Factors of the soot.
const AMOUNTS: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];

fn main() {
    let done = match resident::Order::of_this_process() {
        Some(order) => order.follow(),
        None => measure(),
    };
    if let Err(error) = done {
        println!("{error}");
        std::process::exit(1);
    }
}

fn measure() -> Result<(), Failure> {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    println!("time, {PICTURE} × {PICTURE} pixels and {THREADS} threads where they do not grow:");
    pool(THREADS)?.install(|| {
        let torch = BuiltIn::Torch.volume();
        let resampled = VOXELS.map(|voxels| Arc::new(resample(&torch, voxels)));
        with_voxels(&resampled)?;
        let [_, torch, ..] = &resampled;
        with_pixels(torch)?;
        with_wavelengths(torch)?;
        with_fullness()?;
        with_depth(torch)
    })?;
    let cases = [1, 2].map(|threads| {
        let pool = pool(threads)?;
        let (scene, settings) = scene_of(&Arc::new(BuiltIn::Torch.volume()), 512)?;
        let march = march(scene, settings);
        Ok(Case::new(threads as f64, move || pool.install(&march)))
    });
    Axis::new("threads", "march").print(&of_all(cases)?);
    resident::measure()
}

/// The cases, or why one of them cannot be.
fn of_all<const N: usize>(cases: [Result<Case<'_>, Failure>; N]) -> Result<Vec<Case<'_>>, Failure> {
    cases.into_iter().collect()
}

/// A volume with other voxels: so many along its longest side, of the same size in the world.
fn resample(volume: &Volume, voxels: i32) -> Volume {
    let grids = volume.grids.iter().map(|grid| {
        let bounds = grid.bounds();
        let from = bounds.dims().as_dvec3();
        let scale = from.max_element() / f64::from(voxels);
        let dims = (from / scale).round().max(DVec3::ONE).as_ivec3();
        let old_from_new = DAffine3::from_translation(bounds.min.as_dvec3() - 0.5)
            * DAffine3::from_scale(DVec3::splat(scale))
            * DAffine3::from_translation(DVec3::splat(0.5));
        let world = grid.world_from_index() * old_from_new;
        let background = grid.background();
        Grid::from_fn(
            &grid.name,
            dims,
            world,
            Border::Background,
            background,
            |voxel| grid.sample_trilinear(old_from_new.transform_point3(voxel.as_dvec3())) as f32,
        )
    });
    Volume {
        built_in: volume.built_in,
        ..Volume::from_grids(grids.collect(), "resampled")
    }
}

fn job_of(volume: &Arc<Volume>, side: u32) -> Result<Job, Failure> {
    let mut project = Project::default();
    project.render.size = [side; 2];
    Ok(project.job(volume)?)
}

/// A scene of which emission and absorption alone are computed.
fn scene_of(volume: &Arc<Volume>, side: u32) -> Result<(Scene, Settings), Failure> {
    let job = job_of(volume, side)?;
    let scene = job.scene(None);
    Ok((scene, soot_alone(job.settings)))
}

fn soot_alone(settings: Settings) -> Settings {
    Settings {
        effects: Effects {
            scattering: Switch::Off,
            refraction: Switch::Off,
            wavelengths: Switch::Off,
            ..Effects::AUTO
        },
        ..settings
    }
}

/// Renders with a plan that is made before; gives the samples taken.
fn march(scene: Scene, settings: Settings) -> impl Fn() -> u64 + Sync {
    let plan = Plan::new(&scene, &settings);
    move || {
        let frame = render_planned(&scene, &plan, &settings, &Cancel::never(), &|_| {});
        frame.map_or(0, |frame| frame.samples)
    }
}

/// Renders with all effects from a plan to the film.
fn whole(volume: &Arc<Volume>, side: u32) -> Result<impl Fn() -> u64, Failure> {
    let job = job_of(volume, side)?;
    let scene = job.scene(None);
    Ok(move || {
        let frame = render_still(&scene, &job.settings, &Cancel::never(), &|_| {});
        frame.map_or(0, |frame| frame.samples)
    })
}

fn with_voxels(resampled: &[Arc<Volume>; 4]) -> Result<(), Failure> {
    let all = || VOXELS.into_iter().zip(resampled);
    let packing = all().map(|(voxels, volume)| {
        let job = job_of(volume, PICTURE)?;
        let pack = move || {
            let (bricks, _) = job.scene(None).flame.medium().occupancy();
            bricks as u64
        };
        Ok(Case::new(f64::from(voxels), pack))
    });
    let packing = packing.collect::<Result<Vec<_>, Failure>>()?;
    Axis::new("voxels a side", "packing")
        .counts("bricks")
        .print(&packing);
    let marches = all().map(|(voxels, volume)| {
        let (scene, settings) = scene_of(volume, PICTURE)?;
        Ok(Case::new(f64::from(voxels), march(scene, settings)))
    });
    let marches = marches.collect::<Result<Vec<_>, Failure>>()?;
    Axis::new("voxels a side", "march").print(&marches);
    let wholes = FEWER_VOXELS
        .into_iter()
        .zip(resampled)
        .map(|(voxels, volume)| Ok(Case::new(f64::from(voxels), whole(volume, PICTURE)?)));
    let wholes = wholes.collect::<Result<Vec<_>, Failure>>()?;
    Axis::new("voxels a side", "all effects").print(&wholes);
    Ok(())
}

fn with_pixels(torch: &Arc<Volume>) -> Result<(), Failure> {
    let pixels = |side: u32| f64::from(side).powi(2);
    let marches = SIDES.map(|side| {
        let (scene, settings) = scene_of(torch, side)?;
        Ok(Case::new(pixels(side), march(scene, settings)))
    });
    Axis::new("pixels", "march").print(&of_all(marches)?);
    let wholes = FEWER_SIDES.map(|side| Ok(Case::new(pixels(side), whole(torch, side)?)));
    Axis::new("pixels", "all effects").print(&of_all(wholes)?);
    Ok(())
}

fn with_wavelengths(torch: &Arc<Volume>) -> Result<(), Failure> {
    let cases = WAVELENGTHS.map(|wavelengths| {
        let (scene, settings) = scene_of(torch, PICTURE)?;
        let settings = Settings {
            wavelengths,
            ..settings
        };
        Ok(Case::new(
            wavelengths.count() as f64,
            march(scene, settings),
        ))
    });
    Axis::new("wavelengths", "march").print(&of_all(cases)?);
    Ok(())
}

fn with_fullness() -> Result<(), Failure> {
    let column = |radius| {
        let fire = Fire {
            side: COLUMN_SIDE,
            radius,
        };
        Arc::new(fire.volume())
    };
    // Seen from where the widest one is framed: what grows is what is full, not the fire in the picture.
    let camera = job_of(&column(RADII[3]), PICTURE)?.camera;
    let cases = RADII.map(|radius| {
        let mut job = job_of(&column(radius), PICTURE)?;
        job.camera = camera;
        let scene = job.scene(None);
        let (bricks, _) = scene.flame.medium().occupancy();
        let all = f64::from(COLUMN_SIDE / 8).powi(3);
        Ok(Case::new(
            bricks as f64 / all,
            march(scene, soot_alone(job.settings)),
        ))
    });
    Axis::new("occupied fraction", "march").print(&of_all(cases)?);
    Ok(())
}

fn with_depth(torch: &Arc<Volume>) -> Result<(), Failure> {
    let cases = AMOUNTS.map(|amount| {
        let mut project = Project::default();
        project.render.size = [PICTURE; 2];
        project.soot.amount = amount;
        let job = project.job(torch)?;
        Ok(Case::new(
            amount,
            march(job.scene(None), soot_alone(job.settings)),
        ))
    });
    Axis::new("optical depth", "march").print(&of_all(cases)?);
    Ok(())
}
