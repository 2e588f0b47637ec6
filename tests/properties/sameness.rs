//! The same settings give the same bits, whoever renders, with however many threads, however often interrupted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use proptest::prelude::*;
use sootlight::engine::{Engine, Picture};
use sootlight::export::{Format, Still};
use sootlight::project::Project;
use sootlight::render::{Cancel, Film, Frame, render_still};

use crate::common;

/// Sets that are drawn from: each is taken or left.
const SETS: [&str; 8] = [
    "soot.radius_nm=45",
    "soot.amount=30",
    "render.step_voxels=3",
    "render.interpolation=nearest",
    "fuel.salt=sodium",
    "stage.backdrop=checker",
    "effects.scattering=off",
    "render.samples_per_pixel=2",
];

/// Hears the finished share.
type Progress<'a> = &'a (dyn Fn(f64) + Sync);

fn project(taken: u8, size: [u32; 2]) -> Project {
    let mut project = Project::default();
    project.set("render.wavelengths=4").unwrap();
    let taken = SETS.iter().enumerate().filter(|(i, _)| taken >> i & 1 == 1);
    project.set_all(taken.map(|(_, set)| *set)).unwrap();
    project.render.size = size;
    project
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// Renders until so many rays are done, is stopped, and begins anew.
fn interrupted(render: impl Fn(&Cancel, Progress<'_>) -> Option<Frame>, at: f64) -> Frame {
    let current = Arc::new(AtomicU64::new(1));
    let cancel = Cancel::when_passed(Arc::clone(&current), 1);
    let stop = |share: f64| {
        if share >= at {
            current.store(2, Ordering::SeqCst);
        }
    };
    // A small picture may be whole before it hears of it.
    let _ = render(&cancel, &stop);
    render(&Cancel::never(), &|_| {}).unwrap()
}

/// What the window comes to, interrupted by another picture.
fn of_the_engine(still: &Still, other: &Still) -> (Film, Picture) {
    let engine = Engine::new(2, Box::new(|| {})).unwrap();
    let mut picture = Picture::new(still.job.settings.size);
    let mut wait = |until: &dyn Fn(&Picture) -> bool| {
        while !until(&picture) {
            engine.drain().into_iter().for_each(|it| picture.take(it));
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    };
    engine.submit(still.job.clone());
    wait(&|picture| picture.progress.rays > 0);
    engine.submit(other.job.clone());
    engine.cancel();
    let last = engine.submit(still.job.clone());
    wait(&|picture| picture.generation() == Some(last) && picture.progress.finished);
    (picture.film().clone(), picture)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5, ..ProptestConfig::default() })]

    #[test]
    fn threads_interruptions_windows_and_exports_come_to_the_same_bits(
        taken in any::<u8>(),
        size in [16..40_u32, 16..40],
        threads in 2..6_usize,
        at in 0.0..1.0_f64,
    ) {
        let project = project(taken, size);
        let still = Still::new(&project, &common::torch(), None).unwrap();
        let scene = still.scene();
        let settings = still.job.settings;
        let render = |cancel: &Cancel, progress: Progress<'_>| {
            render_still(&scene, &settings, cancel, progress)
        };
        let one = with_threads(1, || render(&Cancel::never(), &|_| {})).unwrap();
        let many = with_threads(threads, || interrupted(render, at));
        prop_assert_eq!(&one.film, &many.film);

        let other = Still::new(&self::project(!taken, size), &common::torch(), None).unwrap();
        let (film, picture) = of_the_engine(&still, &other);
        // What is at the border of being seen stays as it was decided first.
        let mut decided = settings;
        decided.effects = decided.effects.as_decided(&picture.progress.decisions);
        let as_shown = render_still(&scene, &decided, &Cancel::never(), &|_| {}).unwrap();
        prop_assert_eq!(&film, &as_shown.film);

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        still.write(&one, Format::Exr, &path, &Cancel::never()).unwrap();
        let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let channels = &image.layer_data.channel_data.list;
        let y = channels.iter().find(|channel| channel.name.eq("xyz.Y")).unwrap();
        let exported: Vec<f32> = y.sample_data.values_as_f32().collect();
        let rendered: Vec<f32> = one.film.pixels().iter().map(|pixel| pixel.xyz[1]).collect();
        prop_assert_eq!(exported, rendered);
    }
}
