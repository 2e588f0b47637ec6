//! What a stage is made of, what it takes where nothing is set, and what is refused.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use std::sync::Arc;

use super::super::{Job, Project};
use super::*;
use crate::volume::procedural;

fn job(assignments: &[&str]) -> Result<Job, ProjectError> {
    let mut project = Project::default();
    project.set_all(assignments.iter().copied()).unwrap();
    project.job(&Arc::new(procedural::torch()))
}

#[test]
fn nothing_stands_around_a_fire_unless_it_is_set() {
    let job = job(&[]).unwrap();
    assert_eq!(job.stage, Stage::default());
    assert!(
        job.flame.bending.is_some(),
        "the fire is seen through its own gas"
    );
    assert!(job.flame.scattering.is_some());
}

#[test]
fn what_is_set_stands_where_it_was_put() {
    let stage = job(&[
        "stage.ground=true",
        "stage.ground_height_m=-0.5",
        "stage.ground_colour=[0.1, 0.2, 0.3]",
        "stage.spheres=[[1, 2, 3, 0.25]]",
        "stage.logs=[[1, 2, 3, 4, 5, 6, 0.125]]",
        "stage.log_colour=[0, 0, 1]",
        "stage.backdrop=gradient",
        "stage.backdrop_distance_m=7",
        "stage.backdrop_luminance_cd_m2=50",
    ])
    .unwrap()
    .stage;
    let ground = Ground {
        height_m: -0.5,
        colour: [0.1, 0.2, 0.3],
    };
    let sphere = Sphere {
        centre: DVec3::new(1.0, 2.0, 3.0),
        radius_m: 0.25,
        colour: [0.5; 3],
    };
    let log = Log {
        ends: [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)],
        radius_m: 0.125,
        colour: [0.0, 0.0, 1.0],
    };
    let backdrop = Backdrop {
        pattern: Pattern::Gradient,
        distance_m: 7.0,
        luminance_cd_m2: 50.0,
    };
    let expected = Stage {
        ground: Some(ground),
        spheres: vec![sphere],
        logs: vec![log],
        backdrop: Some(backdrop),
    };
    assert_eq!(stage, expected);
}

#[test]
fn what_is_not_set_follows_the_fire_and_the_camera() {
    let camera = [
        "camera.eye=[0, -3, 0.1]",
        "camera.target=[0, 1, 0.1]",
        "camera.fov_deg=90",
        "stage.ground=true",
        "stage.backdrop=checker",
    ];
    let job = job(&camera).unwrap();
    let flame = &job.flame;
    let fire = crate::scene::flame::world_bounds(&job.volume, &flame.maps, &flame.placement);
    let side = fire.size().max_element();
    assert_eq!(job.stage.ground.unwrap().height_m, fire.min.z);
    let backdrop = job.stage.backdrop.unwrap();
    assert!((backdrop.distance_m - 2.0 * side).abs() < 1e-12);
    let Pattern::Checker { square_m } = backdrop.pattern else {
        panic!("no checker")
    };
    // At 90° the frame is twice as high as it is far away.
    assert!((12.0 * square_m - 2.0 * (4.0 + 2.0 * side)).abs() < 1e-12);
}

#[test]
fn light_is_bent_where_something_shows_it_or_it_was_asked_for() {
    let bending = |set: &[&str]| job(set).unwrap().flame.bending;
    for shown in [
        "stage.ground=true",
        "stage.spheres=[[0, 0, 0, 1]]",
        "stage.logs=[[0, 0, 0, 1, 0, 0, 1]]",
        "stage.backdrop=gradient",
        "effects.refraction=on",
    ] {
        let found = bending(&[shown]).unwrap();
        assert_eq!((found.gain, found.dispersion), (1.0, false), "{shown}");
    }
    assert_eq!(
        bending(&["stage.ground=true", "effects.refraction=off"]),
        None
    );
    let set = [
        "stage.ground=true",
        "effects.dispersion=on",
        "air.refraction_gain=4",
    ];
    let strong = job(&set).unwrap();
    let found = strong.flame.bending.unwrap();
    assert_eq!((found.gain, found.dispersion), (4.0, true));
    let says = |job: &Job| {
        job.flaws
            .iter()
            .any(|it| it == "refraction is exaggerated 4 times")
    };
    assert!(says(&strong));
    let straight = [set[2], "effects.refraction=off"];
    assert!(!says(&job(&straight).unwrap()), "nothing is bent");
}

#[test]
fn logs_and_a_sphere_stand_on_the_ground_and_touch_where_they_cross() {
    let mut project = Project::default();
    let volume = Arc::new(procedural::torch());
    let defaults = project.job(&volume).unwrap().stage_defaults;
    project.stage.set_logs_and_a_sphere(&defaults);
    let stage = project.job(&volume).unwrap().stage;
    let floor = stage.ground.unwrap().height_m;
    let [lying, leaning] = stage.logs.as_slice() else {
        panic!("{:?}", stage.logs)
    };
    let middle = |log: &Log| 0.5 * (log.ends[0] + log.ends[1]);
    let apart = middle(leaning) - middle(lying);
    assert!(
        (apart - DVec3::Z * 2.0 * lying.radius_m).length() < 1e-12,
        "{apart}"
    );
    for log in &stage.logs {
        let lowest = log.ends[0].z.min(log.ends[1].z) - log.radius_m;
        assert!((lowest - floor).abs() < 1e-12);
    }
    let ball = stage.spheres[0];
    assert!((ball.centre.z - ball.radius_m - floor).abs() < 1e-12);
    let fire = defaults.fire.centre();
    assert!((middle(lying).truncate() - fire.truncate()).length() < 1e-12);
    assert!(ball.centre.distance(fire) < 2.0 * defaults.fire.size().max_element());
}

#[test]
fn air_that_cannot_be_is_refused_with_the_keys_that_would_mend_it() {
    let steam = [
        "air.temperature_k=400",
        "air.humidity=1",
        "air.pressure_pa=1000",
    ];
    assert!(job(&steam).is_ok(), "nothing asks for its index");
    let error = job(&[&steam[..], &["stage.ground=true"]].concat()).unwrap_err();
    let words = error.to_string();
    assert!(matches!(error, ProjectError::Air(_)), "{words}");
    for key in ["air.humidity", "air.temperature_k", "air.pressure_pa"] {
        assert!(words.contains(key), "{words}");
    }
}

#[test]
fn a_stage_that_cannot_be_is_refused_by_key() {
    for (assignment, said) in [
        ("stage.ground_height_m=nan", "stage.ground_height_m is NaN"),
        (
            "stage.ground_colour=[0, 1.1, 0]",
            "stage.ground_colour is 1.1",
        ),
        ("stage.log_colour=[nan, 0, 0]", "stage.log_colour is NaN"),
        (
            "stage.spheres=[[0, 0, 0, 1], [0, 0, 0, 0]]",
            "stage.spheres: the radius of sphere 2 is 0 m",
        ),
        (
            "stage.spheres=[[0, inf, 0, 1]]",
            "stage.spheres: the position of sphere 1 is inf m",
        ),
        (
            "stage.logs=[[0, 0, 0, 1, 0, 0, -1]]",
            "stage.logs: the radius of log 1 is -1 m",
        ),
        (
            "stage.backdrop_distance_m=0",
            "stage.backdrop_distance_m is 0",
        ),
        (
            "stage.backdrop_square_m=-1",
            "stage.backdrop_square_m is -1",
        ),
        (
            "stage.backdrop_luminance_cd_m2=inf",
            "stage.backdrop_luminance_cd_m2 is inf",
        ),
        ("stage.backdrop=picture", "set stage.backdrop_picture"),
    ] {
        let error = job(&[assignment]).unwrap_err().to_string();
        assert!(error.contains(said), "{assignment}: {error}");
    }
    let mut project = Project::default();
    project.stage.spheres = vec![[1.0; 4]; MOST_SHAPES];
    assert!(project.check().is_ok());
    project.stage.spheres.push([1.0; 4]);
    let error = project.check().unwrap_err().to_string();
    assert!(error.contains("stage.spheres has 257 entries"), "{error}");
}

#[test]
fn a_picture_is_behind_the_fire_and_kept_from_job_to_job() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("behind.png");
    image::RgbImage::from_pixel(3, 2, image::Rgb([255; 3]))
        .save(&path)
        .unwrap();
    let volume = Arc::new(procedural::torch());
    let mut project = Project::default();
    project.stage.backdrop = BackdropKind::Picture;
    project.stage.backdrop_picture = Some(path);
    let mut kept = Backdrops::default();
    let mut picture = |project: &Project| {
        let job = project.job_keeping(&volume, &mut kept).unwrap();
        match job.stage.backdrop.clone().unwrap().pattern {
            Pattern::Picture(picture) => (job, picture),
            other => panic!("{other:?}"),
        }
    };
    let (first, one) = picture(&project);
    assert_eq!((one.size, one.pixels.clone()), ([3, 2], vec![[1.0; 3]; 6]));
    let (same, again) = picture(&project);
    assert!(Arc::ptr_eq(&one, &again) && first == same);
    // The same pixels read anew ask for no other picture, another place of the same picture does.
    assert!(project.job(&volume).unwrap() == first);
    project.stage.backdrop_distance_m = Some(3.0);
    assert!(picture(&project).0 != first);
    project.stage.backdrop_picture = Some("no/such.png".into());
    let error = project.job(&volume).unwrap_err().to_string();
    assert!(
        error.starts_with("stage.backdrop_picture: no/such.png cannot be read"),
        "{error}"
    );
}
