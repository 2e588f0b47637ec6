//! Restarts: no stale tile, prompt cancel, prompt shutdown, a panic that is survived.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use sootlight::engine::{Engine, Generation, News, Packed, Picture};
use sootlight::project::Job;
use sootlight::render::plan::Effect;
use sootlight::render::{Cancel, Level, Plan, Region, Switch, render_still};
use sootlight::scene::{Scene, WavelengthSet};

use super::common;

/// A bound on waiting that no sane machine reaches; nothing is asserted about time but that it ends.
const PATIENCE: Duration = Duration::from_mins(2);

fn engine() -> (Engine, Arc<AtomicUsize>) {
    let wakes = Arc::new(AtomicUsize::new(0));
    let counter = Arc::clone(&wakes);
    let wake = Box::new(move || {
        counter.fetch_add(1, Ordering::SeqCst);
    });
    (Engine::new(2, wake).unwrap(), wakes)
}

/// Drains into the picture until `until` holds.
fn wait(engine: &Engine, picture: &mut Picture, until: impl Fn(&Picture) -> bool) {
    let begun = Instant::now();
    while !until(picture) {
        for update in engine.drain() {
            picture.take(update);
        }
        assert!(
            begun.elapsed() < PATIENCE,
            "waited in vain: {:?}",
            picture.progress
        );
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// A job whose picture tells its number: every one looks through another amount of soot.
fn numbered(number: u32, size: [u32; 2]) -> Job {
    let mut job = common::torch_job(size);
    job.flame.soot_amount = 0.2 + 0.1 * f64::from(number);
    job
}

#[test]
fn a_submitted_job_becomes_the_picture_that_a_still_has() {
    let (engine, wakes) = engine();
    let mut picture = Picture::new([64, 96]);
    let job = numbered(1, [64, 96]);
    let still = render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap();
    engine.submit(job);
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    assert_eq!(*picture.film(), still.film);
    assert!(wakes.load(Ordering::SeqCst) > 0);
    assert!(picture.progress.first_picture.is_some());
}

#[test]
fn costs_come_after_the_picture_and_whoever_looks_closer_sees_what_was_decided() {
    let (engine, _) = engine();
    let size = [64, 96];
    let mut picture = Picture::new(size);
    let job = numbered(1, size);
    let generation = engine.submit(job.clone());
    wait(&engine, &mut picture, |picture| {
        assert!(picture.progress.costs.is_none() || picture.progress.finished);
        picture.progress.costs.is_some()
    });
    let progress = &picture.progress;
    let costs = progress.costs.clone().unwrap();
    let cost = |effect| costs.iter().find(|it| it.effect == effect);
    assert!(
        cost(Effect::Scattering).is_some_and(|it| it.seconds > 0.0),
        "{costs:?}"
    );
    for nothing in [
        Effect::Soot,
        Effect::Lines,
        Effect::Bands,
        Effect::FireLight,
    ] {
        assert!(cost(nothing).is_none(), "{costs:?}");
    }
    let packed = engine.scene().unwrap();
    assert_eq!(packed.generation, generation);
    let decided = job.settings.effects.as_decided(&progress.decisions);
    assert_eq!(packed.effects, decided);
    assert!(![decided.scattering, decided.refraction, decided.lines].contains(&Switch::Auto));

    // A submit while costs are measured is the next picture; nothing of them comes after it.
    engine.submit(numbered(2, size));
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    let newest = engine.submit(numbered(3, size));
    wait(&engine, &mut picture, |picture| {
        picture.generation() == Some(newest) && picture.progress.finished
    });
}

#[test]
fn a_region_is_as_a_still_and_what_lies_around_it_stays_coarse() {
    let (engine, _) = engine();
    let size = [128, 192];
    let mut picture = Picture::new(size);
    let job = numbered(1, size);
    let region = Region {
        from: [40, 70],
        to: [50, 110],
    };
    engine.submit_within(job.clone(), Some(region));
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    let still = render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap();
    let mut sharp = 0;
    for (i, stride) in picture.strides().iter().enumerate() {
        let at = [(i % 128) as u32, (i / 128) as u32];
        let inside = [0, 1]
            .into_iter()
            .all(|axis| (region.from[axis]..region.to[axis]).contains(&at[axis]));
        assert!(*stride == 1 || !inside && *stride == 2, "{at:?}: {stride}");
        if *stride == 1 {
            sharp += 1;
            assert_eq!(picture.film().pixels()[i], still.film.pixels()[i]);
        }
    }
    // Tiles of 32 pixels, of which a row of two by two lies around the region.
    assert_eq!(sharp, 32 * 64);
    let last = picture.progress.passes.last().unwrap();
    assert_eq!(last.rays(size), 32 * 64);
}

#[test]
fn a_picture_pauses_goes_on_and_is_the_same() {
    let (engine, _) = engine();
    let size = [256, 384];
    let mut picture = Picture::new(size);
    let job = numbered(1, size);
    engine.submit(job.clone());
    engine.pause(true);
    assert!(engine.pauses());
    // What was in hand comes yet: a tile for each worker.
    std::thread::sleep(Duration::from_millis(400));
    engine.drain().into_iter().for_each(|it| picture.take(it));
    let rays = picture.progress.rays;
    std::thread::sleep(Duration::from_millis(300));
    engine.drain().into_iter().for_each(|it| picture.take(it));
    assert_eq!(picture.progress.rays, rays);
    assert!(!picture.progress.finished);
    engine.pause(false);
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    let still = render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap();
    assert_eq!(*picture.film(), still.film);

    // Another job does not wait behind one that pauses, nor does the end.
    engine.submit(numbered(2, size));
    engine.pause(true);
    let newest = engine.submit(numbered(3, size));
    assert!(!engine.pauses());
    wait(&engine, &mut picture, |picture| {
        picture.generation() == Some(newest) && picture.progress.finished
    });
    engine.submit(numbered(4, size));
    engine.pause(true);
    drop(engine);
}

#[test]
fn other_numbers_for_the_same_scene_work_nothing_out_again() {
    let (engine, _) = engine();
    let size = [64, 96];
    let mut picture = Picture::new(size);
    let job = numbered(1, size);
    engine.submit(job.clone());
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    let first = engine.scene().unwrap();
    let mut finer = job.clone();
    finer.settings.step_voxels *= 0.5;
    let newest = engine.refine(finer.clone(), None, None);
    wait(&engine, &mut picture, |picture| {
        picture.generation() == Some(newest) && picture.progress.finished
    });
    // No coarse pass, the same light from all sides, and yet the picture that a still has.
    assert_eq!(picture.progress.passes.len(), 1);
    let second = engine.scene().unwrap();
    let fine = |plan: &Plan, scene: &Scene| {
        let fields = plan.fields(scene, Level::Fine, &Cancel::never());
        fields.unwrap().clone()
    };
    let fields = |packed: &Packed| fine(&packed.plan, &packed.scene);
    assert!(fields(&first).shares_scattered_light(&fields(&second)));
    let still = render_still(
        &finer.scene(None),
        &finer.settings,
        &Cancel::never(),
        &|_| {},
    );
    assert_eq!(*picture.film(), still.unwrap().film);

    // What somebody tried with the same scene serves as well.
    let mut other = finer.clone();
    other.settings.wavelengths = WavelengthSet::Fitted(4);
    other.settings.effects.wavelengths = Switch::Off;
    let tried = second.plan.at(&second.scene, &other.settings);
    let of_tried = fine(&tried, &second.scene);
    let newest = engine.refine(other, None, Some(Arc::new(tried)));
    wait(&engine, &mut picture, |picture| {
        picture.generation() == Some(newest) && picture.progress.finished
    });
    let third = fields(&engine.scene().unwrap());
    assert!(third.shares_scattered_light(&of_tried));

    // Another scene is not refined.
    let newest = engine.submit(numbered(2, size));
    wait(&engine, &mut picture, |picture| {
        picture.generation() == Some(newest) && picture.progress.finished
    });
    let fourth = fields(&engine.scene().unwrap());
    assert!(!fourth.shares_scattered_light(&third));
}

#[test]
fn no_stale_tile_lands_in_two_hundred_restarts() {
    let (engine, _) = engine();
    let size = [96, 128];
    let mut newest: Option<Generation> = None;
    let mut seen = 0;
    for number in 0..200 {
        let generation = engine.submit(numbered(number % 7, size));
        newest = newest.max(Some(generation));
        let mut drain = || {
            for update in engine.drain() {
                assert_eq!(
                    Some(update.generation),
                    newest,
                    "a tile of an older job was drained"
                );
                seen += usize::from(matches!(update.news, News::Tile(_)));
            }
            seen
        };
        // Restarts at all moments: at once, while packing, and, however busy the machine, within a pass.
        std::thread::sleep(Duration::from_micros(u64::from(number % 11) * 400));
        let before = drain();
        let begun = Instant::now();
        while number % 20 == 19 && drain() == before {
            assert!(begun.elapsed() < PATIENCE);
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    // And what comes to rest is the last job's picture, bit for bit.
    let last = numbered(3, size);
    engine.submit(last.clone());
    let mut picture = Picture::new(size);
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    // What is at the border of being seen stays as it was on the way.
    let mut settings = last.settings;
    settings.effects = settings.effects.as_decided(&picture.progress.decisions);
    let still = render_still(&last.scene(None), &settings, &Cancel::never(), &|_| {}).unwrap();
    assert_eq!(*picture.film(), still.film);
}

#[test]
fn a_storm_of_submits_that_nobody_drains_queues_nothing() {
    let (engine, _) = engine();
    let size = [256, 256];
    let mut newest = None;
    for number in 0..300 {
        newest = Some(engine.submit(numbered(number % 7, size)));
        std::thread::sleep(Duration::from_micros(u64::from(number % 5) * 300));
    }
    let mut picture = Picture::new(size);
    let begun = Instant::now();
    let (mut started, mut rays) = (0, 0);
    while !picture.progress.finished {
        for update in engine.drain() {
            assert_eq!(Some(update.generation), newest);
            started += usize::from(matches!(update.news, News::Started { .. }));
            if let News::Tile(tile) = &update.news {
                rays += tile.pixels.len();
            }
            picture.take(update);
        }
        assert!(begun.elapsed() < PATIENCE);
    }
    // 256 × 256 pixels at strides 8, 4, 2 and 1, each once, in however many tiles.
    let squares = [32, 64, 128, 256].map(|side: usize| side * side);
    assert_eq!((started, rays), (1, squares.iter().sum()));
}

#[test]
fn the_old_picture_stays_until_the_first_pass_of_the_new_one_is_whole() {
    let (engine, _) = engine();
    let size = [120, 160];
    let mut picture = Picture::new(size);
    engine.submit(numbered(1, size));
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    let old = picture.film().clone();
    engine.submit(numbered(20, size));
    let begun = Instant::now();
    while picture.progress.done == 0 || picture.progress.finished {
        let mut updates = engine.drain().into_iter();
        for update in updates.by_ref() {
            let first_whole = matches!(update.news, News::PassDone { index: 0, .. });
            picture.take(update);
            if first_whole {
                break;
            }
            assert_eq!(
                *picture.film(),
                old,
                "a part of the new picture showed before its first pass was whole"
            );
        }
        assert!(begun.elapsed() < PATIENCE);
        if picture.progress.done == 1 {
            break;
        }
    }
    assert_ne!(*picture.film(), old);
}

#[test]
fn only_what_changed_is_packed_again() {
    let job = numbered(1, [32, 32]);
    let before = job.scene(None);
    let mut other = job.clone();
    other.flame.soot_radius_nm = 30.0;
    other.flame.soot_amount = 3.0;
    assert!(
        other
            .scene(Some(&before))
            .flame
            .shares_medium_with(&before.flame)
    );
    assert!(
        other
            .scene(Some(&before))
            .flame
            .absorption_per_sample(550.0)
            > before.flame.absorption_per_sample(550.0)
    );
    let map = other.flame.maps.temperature.as_mut().unwrap();
    map.scale *= 0.9;
    assert!(
        !other
            .scene(Some(&before))
            .flame
            .shares_medium_with(&before.flame)
    );
}

#[test]
fn a_cancel_leaves_nothing_to_drain_and_the_next_job_runs() {
    let (engine, _) = engine();
    let size = [64, 64];
    engine.submit(numbered(2, [1024, 1024]));
    // Cancelled in the middle of a pass, once tiles have come.
    let begun = Instant::now();
    while engine.drain().is_empty() {
        assert!(begun.elapsed() < PATIENCE);
        std::thread::yield_now();
    }
    engine.cancel();
    for _ in 0..50 {
        assert!(engine.drain().is_empty(), "news of a cancelled job");
        std::thread::sleep(Duration::from_micros(200));
    }
    let generation = engine.submit(numbered(4, size));
    let mut picture = Picture::new(size);
    wait(&engine, &mut picture, |picture| picture.progress.finished);
    assert_eq!(picture.generation(), Some(generation));
}

#[test]
fn a_worker_that_panics_is_reported_and_the_next_job_runs() {
    // Past the doors rendering is infallible, so the fault is planted in what workers call: the window's wake.
    let armed = Arc::new(AtomicBool::new(true));
    let fuse = Arc::clone(&armed);
    let wake = move || {
        let on_a_worker = std::thread::current()
            .name()
            .is_some_and(|name| name.starts_with("sootlight-worker"));
        assert!(
            !(on_a_worker && fuse.swap(false, Ordering::SeqCst)),
            "planted fault"
        );
    };
    let engine = Engine::new(2, Box::new(wake)).unwrap();
    let size = [48, 48];
    let mut picture = Picture::new(size);
    engine.submit(numbered(1, size));
    wait(&engine, &mut picture, |picture| {
        picture.progress.failure.is_some()
    });
    let words = picture.progress.failure.clone().unwrap();
    assert!(words.contains("planted fault"), "{words}");
    engine.submit(numbered(1, size));
    wait(&engine, &mut picture, |picture| {
        picture.progress.finished && picture.progress.failure.is_none()
    });
}

#[test]
fn dropping_the_engine_in_the_middle_of_a_picture_returns() {
    let (engine, _) = engine();
    engine.submit(numbered(1, [2048, 2048]));
    std::thread::sleep(Duration::from_millis(20));
    drop(engine);
}

#[test]
fn the_engine_lends_the_scene_of_the_newest_job_and_no_other() {
    let (engine, _) = engine();
    let mut picture = Picture::new([32, 48]);
    assert!(engine.scene().is_none(), "nothing was submitted");
    let mut medium = None;
    for number in 0..3 {
        let job = numbered(number, [32, 48]);
        let newest = engine.submit(job.clone());
        // Whenever it is asked: the scene is the newest job's, or there is none yet.
        let begun = Instant::now();
        let scene = loop {
            if let Some(packed) = engine.scene() {
                assert_eq!((packed.generation, packed.size), (newest, [32, 48]));
                break packed.scene;
            }
            assert!(begun.elapsed() < PATIENCE, "no scene");
            std::thread::sleep(Duration::from_micros(50));
        };
        let expected = job.scene(None).flame.absorption_per_sample(550.0);
        assert_eq!(scene.flame.absorption_per_sample(550.0), expected);
        let before = medium.replace(scene.flame.clone());
        assert!(
            before.is_none_or(|before| before.shares_medium_with(&scene.flame)),
            "nothing is packed for a lent scene"
        );
        wait(&engine, &mut picture, |picture| {
            picture.generation() == Some(newest) && picture.progress.finished
        });
    }
    engine.cancel();
    assert!(engine.scene().is_none(), "cancelled");
}
