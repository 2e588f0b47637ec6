//! The same bits from any number of threads and any order of tiles; cancelling; settings at the door.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use sootlight::project::Job;
use sootlight::render::pass::{self, Audience};
use sootlight::render::{
    Cancel, Effects, Film, Plan, Prober, Settings, SettingsError, Switch, render_pass, render_still,
};
use sootlight::scene::WavelengthSet;

use super::common;

const SETTINGS: Settings = Settings {
    size: [77, 101],
    step_voxels: 1.0,
    wavelengths: WavelengthSet::Fitted(6),
    samples_per_pixel: 2,
    scattering_orders: 1,
    effects: Effects::AUTO,
};

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap()
}

#[test]
fn one_thread_and_many_give_the_same_bits() {
    let scene = common::torch_scene(1.0);
    let films = [1, 2, 5].map(|threads| {
        pool(threads).install(|| {
            render_still(&scene, &SETTINGS, &Cancel::never(), &|_| {})
                .unwrap()
                .film
        })
    });
    assert!(films[0].pixels().iter().any(|pixel| pixel.xyz[1] > 0.0));
    assert_eq!(films[0], films[1]);
    assert_eq!(films[0], films[2]);
}

#[test]
fn a_windows_last_pass_has_the_bits_of_a_still() {
    let scene = common::torch_scene(1.0);
    let settings = Settings {
        step_voxels: 2.0,
        ..SETTINGS
    };
    let still = render_still(&scene, &settings, &Cancel::never(), &|_| {})
        .unwrap()
        .film;
    let plan = Plan::new(&scene, &settings);
    let film = std::sync::Mutex::new(Film::new(settings.size));
    for pass in pass::ladder(&settings, Audience::Window) {
        assert!(render_pass(
            &scene,
            &plan,
            &pass,
            &Cancel::never(),
            &|tile| film.lock().unwrap().merge(&tile)
        ));
    }
    assert_eq!(film.into_inner().unwrap(), still);
}

#[test]
fn a_coarse_pass_is_the_picture_in_small() {
    let scene = common::torch_scene(1.0);
    let settings = Settings {
        size: [160, 200],
        samples_per_pixel: 1,
        effects: Effects::AUTO,
        ..SETTINGS
    };
    let plan = Plan::new(&scene, &settings);
    let mean = |stride: u32| {
        let film = std::sync::Mutex::new(Film::new(settings.size));
        let ladder = pass::ladder(&settings, Audience::Window);
        let pass = ladder.iter().find(|pass| pass.stride == stride).unwrap();
        render_pass(&scene, &plan, pass, &Cancel::never(), &|tile| {
            film.lock().unwrap().merge(&tile);
        });
        let film = film.into_inner().unwrap();
        film.pixels()
            .iter()
            .map(|pixel| f64::from(pixel.xyz[1]))
            .sum::<f64>()
    };
    let (coarse, full) = (mean(8), mean(1));
    assert!((coarse / full - 1.0).abs() < 0.05, "{coarse} {full}");
}

#[test]
fn a_cancel_stops_within_a_packet() {
    let scene = common::torch_scene(1.0);
    let settings = Settings {
        size: [400, 400],
        ..SETTINGS
    };
    let plan = Plan::new(&scene, &settings);
    let pass = pass::ladder(&settings, Audience::Still)[0];
    let current = Arc::new(AtomicU64::new(1));
    let cancel = Cancel::when_passed(Arc::clone(&current), 1);
    let tiles = AtomicUsize::new(0);
    let whole = pool(2).install(|| {
        render_pass(&scene, &plan, &pass, &cancel, &|_| {
            tiles.fetch_add(1, Ordering::SeqCst);
            current.store(2, Ordering::SeqCst);
        })
    });
    assert!(!whole);
    // Two workers, each at most at the end of the tile it was in.
    assert!(tiles.into_inner() <= 2);
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let step = Settings {
        step_voxels: 0.0,
        ..SETTINGS
    }
    .validated()
    .unwrap_err();
    assert!(
        step.to_string().contains("render.step_voxels is 0"),
        "{step}"
    );
    assert!(matches!(
        Settings {
            step_voxels: f64::NAN,
            ..SETTINGS
        }
        .validated(),
        Err(SettingsError::Step(_))
    ));
    assert!(matches!(
        Settings {
            size: [0, 5],
            ..SETTINGS
        }
        .validated(),
        Err(SettingsError::Size(_))
    ));
    assert!(matches!(
        Settings {
            samples_per_pixel: 0,
            ..SETTINGS
        }
        .validated(),
        Err(SettingsError::Samples(0))
    ));
    assert_eq!(SETTINGS.validated(), Ok(SETTINGS));
}

#[test]
fn a_step_too_long_for_dense_soot_is_a_flaw() {
    let flaws = |radius_nm: f64, step_voxels: f64| {
        let mut job = common::torch_job([8, 8]);
        job.flame.soot_radius_nm = radius_nm;
        let scene = job.scene(None);
        let plan = Plan::new(
            &scene,
            &Settings {
                step_voxels,
                ..job.settings
            },
        );
        plan.flaws.iter().map(String::from).collect::<Vec<_>>()
    };
    assert!(flaws(21.25, 1.0).is_empty());
    let dense = flaws(80.0, 1.0);
    assert!(
        dense.iter().any(|it| it.contains("optical depths thick")),
        "{dense:?}"
    );
    let fine = flaws(80.0, 0.05);
    assert!(!fine.iter().any(|it| it.contains("optical depths thick")));
}

#[test]
fn a_probe_sees_the_pixel_that_the_picture_has() {
    // Fields of scattered light are coarser for a probe.
    let effects = Effects {
        scattering: Switch::Off,
        ..Effects::AUTO
    };
    let job = Job {
        settings: Settings {
            step_voxels: 0.5,
            wavelengths: WavelengthSet::Plain(64),
            effects,
            ..common::torch_job([48, 64]).settings
        },
        ..common::torch_job([48, 64])
    };
    let scene = job.scene(None);
    let frame = render_still(&scene, &job.settings, &Cancel::never(), &|_| {}).unwrap();
    let mut lit = 0;
    for (x, y) in [(24, 20), (24, 40), (20, 50), (28, 33), (0, 0), (47, 63)] {
        let point = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let probe = Prober::new(&scene, [48, 64], effects).read(point).unwrap();
        let pixel = frame.film.pixels()[(y * 48 + x) as usize].xyz;
        for (got, expected) in probe.xyz.into_iter().zip(pixel) {
            assert!(
                (got - f64::from(expected)).abs() <= 1e-6 * got.abs(),
                "{x}, {y}: {:?}, pixel {pixel:?}",
                probe.xyz
            );
        }
        assert_eq!(probe.spectrum.len(), 64);
        if probe.luminance() > 0.0 {
            lit += 1;
            // A black body of less than 3700 K is brightest beyond the red end.
            assert!(
                probe
                    .spectrum
                    .is_sorted_by(|a, b| a[0] < b[0] && a[1] < b[1])
            );
            let kelvin = probe.black_body_k().unwrap();
            assert!((1200.0..2300.0).contains(&kelvin), "{kelvin}");
        } else {
            assert_eq!(probe.chromaticity(), None);
        }
    }
    assert!((2..6).contains(&lit), "{lit} points are lit");
}

#[test]
fn what_nothing_comes_through_hides_the_backdrop_and_ground_is_opaque() {
    use sootlight::project::Project;
    use sootlight::render::march::Marcher;
    let marched = |sets: &[&str]| {
        let mut project = Project::default();
        project.set_all(sets.iter().copied()).unwrap();
        project.render.size = [64, 48];
        let job = project.job(&common::torch()).unwrap();
        let scene = job.scene(None);
        let plan = Plan::new(&scene, &job.settings);
        let marcher = Marcher::new(&scene, &plan, 1.0).unwrap();
        // Through the body of the fire, and beside it above and below.
        let points = [[32.0, 30.0], [5.0, 5.0], [5.0, 47.0]];
        let (pixels, _) = marcher.march(&std::array::from_fn(|lane| points.get(lane).copied()));
        pixels
    };
    let dense = ["soot.amount=10000", "effects.refraction=off"];
    let alone = marched(&dense);
    let bright = [
        dense[0],
        dense[1],
        "stage.backdrop=gradient",
        "stage.backdrop_luminance_cd_m2=1e6",
    ];
    let before = marched(&bright);
    for c in 0..3 {
        let (alone, before) = (alone[0].xyz[c], before[0].xyz[c]);
        // The backdrop's 1464 W m⁻² sr⁻¹ would show as 0.1 % of itself.
        assert!(
            (before - alone).abs() < 1e-3 * alone.abs().max(1e-3),
            "{c}: {alone}, {before}"
        );
    }
    assert!(before[1].xyz[1] > 1000.0);
    // What is opaque is white under D65, as the table of the observer has it.
    let ground = marched(&["stage.ground=true", "effects.refraction=off"]);
    for (found, white) in ground[2].opacity.into_iter().zip([0.9505, 1.0, 1.0890]) {
        assert!((found - white).abs() < 2e-3, "{:?}", ground[2].opacity);
    }
    assert_eq!(before[1].opacity, ground[2].opacity);
}
