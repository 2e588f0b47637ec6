//! Which settings ask for which picture.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use glam::{DAffine3, IVec3};

use super::*;
use crate::render::{Cancel, Frame, render_still};
use crate::volume::{Border, Grid, procedural};

/// Whether a change of settings asks for another picture of the torch.
fn asks_anew(before: &[&str], change: &str) -> bool {
    let volume = Arc::new(procedural::torch());
    let job = |assignments: &[&str]| {
        let mut project = Project::default();
        project.set_all(assignments.iter().copied()).unwrap();
        project.job(&volume).unwrap()
    };
    job(before) != job(&[before, &[change]].concat())
}

#[test]
fn gas_of_which_a_file_says_nothing_holds_no_salt_however_hot_its_mapping_is() {
    // As of EmberGen's heat, whose zero is 1300 K: without this the whole box would glow.
    let mut project = Project::default();
    let hot = ["fuel.salt=sodium", "volume.temperature.offset=1300"];
    project.set_all(hot).unwrap();
    let job = project.job(&Arc::new(procedural::torch())).unwrap();
    assert_eq!(
        job.flame.glow.clear_k, 1600.0,
        "300 K of the file's own, and the offset"
    );
    let scene = job.scene(None);
    let glow = scene.flame.glow();
    assert_eq!(glow.vapour_share(1600.0), 0.0);
    assert!(glow.vapour_share(1700.0) > 0.0);
    let (stored, all) = scene.flame.medium().occupancy();
    assert!(stored < all / 2, "{stored} of {all} bricks");
}

#[test]
fn only_what_changes_the_light_asks_for_a_picture() {
    let field = "volume.flame.grid=soot";
    for (before, change) in [
        (&["fuel.salt=sodium"][..], "fuel.salt_ppm=20"),
        (&["fuel.salt=sodium"], "fuel.salt=copper"),
        (&["fuel.salt=sodium"], "fuel.name=acetylene"),
        (&["fuel.salt=sodium"], "air.temperature_k=350"),
        (&["fuel.salt=sodium"], "effects.lines=off"),
        (&["fuel.salt=copper"], "effects.bands=off"),
        (&[field], "fuel.blue_glow=2"),
        (&[field], "fuel.name=acetylene"),
        (&[field], "effects.chemiluminescence=off"),
        (&[], "effects.chemiluminescence=on"),
        (&["volume.temperature.grid="], "air.temperature_k=350"),
        (&[], "render.interpolation=tricubic"),
        (&[], "soot.asymmetry=0.3"),
        (&[], "effects.scattering=off"),
        (&["soot.hold=volume"], "soot.radius_nm=30"),
        (&[], "stage.ground=true"),
        (&["stage.ground=true"], "stage.ground_colour=[0, 0, 0]"),
        (&["stage.ground=true"], "air.humidity=0.9"),
        (&["stage.backdrop=checker"], "air.pressure_pa=50000"),
        (&["stage.backdrop=checker"], "air.temperature_k=350"),
        (&["stage.backdrop=checker"], "air.saturation=davis"),
        (&["stage.backdrop=checker"], "air.refraction_gain=2"),
        (&["stage.backdrop=checker"], "effects.dispersion=on"),
        (&["stage.backdrop=checker"], "stage.backdrop_square_m=0.01"),
        (&["effects.refraction=on"], "air.co2_ppm=0"),
    ] {
        assert!(asks_anew(before, change), "{before:?} then {change}");
    }
    for (before, change) in [
        (&[][..], "fuel.salt_ppm=20"),
        (
            &["fuel.salt=sodium", "effects.lines=off"],
            "fuel.salt=potassium",
        ),
        (
            &["fuel.salt=sodium", "effects.lines=off", "effects.bands=off"],
            "fuel.salt=copper",
        ),
        (&["fuel.salt_ppm=0"], "fuel.salt=copper"),
        // Nothing says what burns.
        (&[], "fuel.blue_glow=2"),
        (&["fuel.blue_glow=0"], field),
        // The file says how hot the gas is.
        (&["effects.refraction=off"], "air.temperature_k=350"),
        (&["effects.refraction=off"], "air.humidity=0.9"),
        (&["effects.refraction=off"], "air.refraction_gain=2"),
        // There is no smoke.
        (&[], "smoke.albedo=0.5"),
        (
            &["soot.hold=volume", "effects.scattering=off"],
            "soot.radius_nm=30",
        ),
        (&[], "stage.ground_colour=[0, 0, 0]"),
        (&["stage.backdrop=gradient"], "stage.backdrop_square_m=0.01"),
        (
            &["stage.ground=true", "effects.refraction=off"],
            "air.humidity=0.9",
        ),
    ] {
        assert!(!asks_anew(before, change), "{before:?} then {change}");
    }
}

#[test]
fn a_field_is_packed_once_an_effect_reads_it_and_not_before() {
    // The torch's soot stands for all: soot, smoke beside it, and where gas burns.
    let volume = Arc::new(procedural::torch());
    let medium = |more: &[&str], before: Option<&Scene>| {
        let mut project = Project::default();
        let sets = [
            "volume.flame.grid=soot",
            "volume.smoke.grid=soot",
            "volume.smoke.scale=0.2",
            "effects.smoke=on",
            "effects.chemiluminescence=off",
            "effects.scattering=off",
            "effects.refraction=off",
        ];
        let sets = sets.iter().chain(more).copied();
        project.set_all(sets).unwrap();
        project.job(&volume).unwrap().scene(before)
    };
    let fields = |scene: &Scene| {
        let medium = scene.flame.medium();
        let [flame, smoke] = [&medium.flame, &medium.smoke].map(|field| !field.is_empty());
        (flame, smoke, scene.flame.has_smoke())
    };
    let plain = medium(&[], None);
    assert_eq!(fields(&plain), (false, false, true));
    let burning = medium(&["effects.chemiluminescence=auto"], Some(&plain));
    assert_eq!(fields(&burning), (true, false, true));
    let scattering = medium(&["effects.scattering=on"], Some(&burning));
    assert_eq!(fields(&scattering), (false, true, true));
    let smokeless = medium(&["effects.smoke=off"], Some(&scattering));
    assert_eq!(fields(&smokeless), (false, false, false));
    // Hot gas without soot is there for bent light alone.
    let bricks = |scene: &Scene| scene.flame.medium().occupancy().0;
    let bent = medium(&["effects.refraction=on"], Some(&plain));
    assert!(bricks(&bent) > bricks(&plain));
}

#[test]
fn bricks_in_which_gas_alone_glows_are_visited_only_for_its_light() {
    let grid = |name: &str, inside: fn(i32) -> bool, value: f32| {
        let of_voxel = move |voxel: IVec3| if inside(voxel.x) { value } else { 0.0 };
        let dims = IVec3::new(64, 16, 16);
        let world = DAffine3::from_scale(DVec3::splat(0.01));
        Grid::from_fn(name, dims, world, Border::Background, 0.0, of_voxel)
    };
    let grids = vec![
        grid("soot", |x| x < 20, 1e-7),
        grid("flame", |x| x > 36, 1.0),
        grid("temperature", |_| true, 1700.0),
    ];
    let volume = Arc::new(Volume::from_grids(grids, "two halves"));
    for interpolation in ["trilinear", "tricubic"] {
        let frame = |packed: &str, computed: Switch| {
            let mut project = Project::default();
            project.set("render.size=[48, 16]").unwrap();
            let sets = [
                format!("render.interpolation={interpolation}"),
                format!("effects.chemiluminescence={packed}"),
                "effects.scattering=off".to_owned(),
            ];
            project.set_all(sets.iter().map(String::as_str)).unwrap();
            let mut job = project.job(&volume).unwrap();
            let scene = job.scene(None);
            job.settings.effects.chemiluminescence = computed;
            render_still(&scene, &job.settings, &Cancel::never(), &|_| {}).unwrap()
        };
        let with = frame("on", Switch::On);
        let without = frame("on", Switch::Off);
        let alone = frame("off", Switch::Off);
        assert!(with.samples > without.samples * 5 / 4, "{interpolation}");
        // A smooth interpolation looks into what lies beside soot as well: of that the larger volume has more.
        if interpolation == "trilinear" {
            assert_eq!(without.samples, alone.samples);
        }
        // The lattice of the larger volume begins elsewhere, and with it the steps.
        let light = |frame: &Frame| frame.film.pixels().iter().map(|it| it.xyz[1]).sum::<f32>();
        let difference = light(&without) / light(&alone) - 1.0;
        assert!(difference.abs() < 1e-3, "{interpolation}: {difference}");
    }
}
