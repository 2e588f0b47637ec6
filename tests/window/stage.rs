//! What stands around the fire, the air that bends its light, and which effects are computed.

use egui::{Key, Modifiers};
use egui_kittest::kittest::NodeT as _;
use sootlight::physics::moist_air::Edition;
use sootlight::project::BackdropKind;
use sootlight::render::Switch;
use sootlight::render::plan::Effect;
use sootlight::scene::stage::Pattern;

use super::controls::{choose, job, tall_window, type_into};
use super::*;

fn press(harness: &mut Harness<'_, App>, label: &str) {
    settle(harness);
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Waits so long that no click is a part of what came before, then clicks a name twice.
fn double_click_name(harness: &mut Harness<'_, App>, label: &str) {
    harness.run_steps(60);
    for _ in 0..2 {
        harness.get_by_role_and_label(Role::Label, label).click();
        harness.run_steps(1);
    }
    harness.run_steps(2);
}

fn undo(harness: &mut Harness<'_, App>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
}

#[test]
fn a_button_sets_a_stage_that_suits_the_fire_and_undo_takes_it_back() {
    let mut harness = tall_window(Project::default());
    let before = harness.state().document().project.clone();
    press(&mut harness, "Logs and a sphere");
    let stage = job(&harness).stage;
    assert_eq!((stage.logs.len(), stage.spheres.len()), (2, 1));
    let defaults = job(&harness).stage_defaults;
    assert_eq!(
        stage.ground.expect("a ground").height_m,
        defaults.fire.min.z
    );
    assert!(job(&harness).flame.bending.is_some(), "it shows bent light");
    undo(&mut harness);
    assert_eq!(harness.state().document().project, before);
    assert!(!job(&harness).stage.shows_behind());
}

#[test]
fn shapes_are_added_moved_and_taken_away() {
    let mut harness = tall_window(Project::default());
    press(&mut harness, "Add a sphere");
    press(&mut harness, "Add a sphere");
    type_into(&mut harness, "Sphere 2 x", "35 cm");
    type_into(&mut harness, "Sphere 2 radius", "0.25");
    let first = job(&harness).stage.spheres[0];
    let second = job(&harness).stage.spheres[1];
    assert!((second.centre.x - 0.35).abs() < 1e-12 && (second.radius_m - 0.25).abs() < 1e-12);
    assert_eq!(
        (second.centre.y, second.centre.z),
        (first.centre.y, first.centre.z)
    );
    press(&mut harness, "Take sphere 1 away");
    assert_eq!(job(&harness).stage.spheres, [second]);
    press(&mut harness, "Add a log");
    type_into(&mut harness, "Log 1 to z", "2");
    assert_eq!(job(&harness).stage.logs[0].ends[1].z, 2.0);
    // No radius is nothing, and no length is a weight.
    type_into(&mut harness, "Log 1 radius", "0");
    assert!(job(&harness).stage.logs[0].radius_m > 0.0);
    let before = job(&harness).stage;
    type_into(&mut harness, "Log 1 to z", "3 lbs");
    assert_eq!(job(&harness).stage, before);
}

#[test]
fn a_backdrop_lets_the_air_act_and_its_numbers_go_back_to_automatic() {
    let mut harness = tall_window(Project::default());
    choose(&mut harness, "Backdrop", "Checker");
    settle(&mut harness);
    assert!(
        harness
            .query_by_label_contains("acts through refraction")
            .is_none()
    );
    harness.get_by_label_contains("refraction moves what is behind: by at most");
    // Three times the bending, three times the shift.
    let said = |harness: &Harness<'_, App>| harness.state().document().facts.largest_shift_px;
    let natural = said(&harness).expect("a shift");
    type_into(&mut harness, "Exaggeration", "3");
    settle(&mut harness);
    let exaggerated = said(&harness).expect("a shift");
    assert!(
        (exaggerated / natural / 3.0 - 1.0).abs() < 0.1,
        "{natural} px, then {exaggerated}"
    );
    type_into(&mut harness, "Exaggeration", "1");

    let backdrop = |harness: &Harness<'_, App>| job(harness).stage.backdrop.expect("a backdrop");
    let automatic = backdrop(&harness).distance_m;
    type_into(&mut harness, "Distance", "7 m");
    assert_eq!(backdrop(&harness).distance_m, 7.0);
    double_click_name(&mut harness, "Distance");
    assert_eq!(backdrop(&harness).distance_m, automatic);
    let set = |harness: &Harness<'_, App>| harness.state().document().project.stage.clone();
    assert_eq!(set(&harness).backdrop_distance_m, None);
    type_into(&mut harness, "Square", "5 cm");
    assert_eq!(
        backdrop(&harness).pattern,
        Pattern::Checker { square_m: 0.05 }
    );
    type_into(&mut harness, "Luminance", "300 nits");
    assert_eq!(backdrop(&harness).luminance_cd_m2, 300.0);
    choose(&mut harness, "Backdrop", "No backdrop");
    assert!(job(&harness).stage.backdrop.is_none());
}

#[test]
fn air_is_typed_as_people_write_it() {
    let mut project = Project::default();
    project.stage.ground = true;
    let mut harness = tall_window(project);
    type_into(&mut harness, "Pressure", "90000 Pa");
    type_into(&mut harness, "Air temp.", "0 °C");
    type_into(&mut harness, "Exaggeration", "4");
    choose(&mut harness, "Saturation", "Davis 1992");
    let flame = job(&harness).flame;
    assert!((flame.air.pressure_pa - 90_000.0).abs() < 1e-6);
    assert_eq!(flame.air.temperature_k, 273.15);
    assert_eq!(flame.air.edition, Edition::Ciddor1996);
    assert_eq!(flame.bending.expect("bent light").gain, 4.0);
    harness.get_by_label("• refraction is exaggerated 4 times");
    double_click_name(&mut harness, "Exaggeration");
    double_click_name(&mut harness, "Pressure");
    let flame = job(&harness).flame;
    assert_eq!(flame.bending.expect("bent light").gain, 1.0);
    assert_eq!(flame.air.pressure_pa, 101_325.0);
    type_into(&mut harness, "Exaggeration", "50");
    harness.get_by_label_contains("the most is 20 ×");
}

#[test]
fn effects_are_switched_and_what_needs_them_says_so() {
    let mut harness = tall_window(Project::default());
    assert!(job(&harness).flame.scattering.is_some());
    choose(&mut harness, "Scattered light", "Off");
    assert!(job(&harness).flame.scattering.is_none());
    harness.get_by_label("it acts through scattering, which is off: switch it on under Effects");
    double_click_name(&mut harness, "Scattered light");
    assert!(job(&harness).flame.scattering.is_some());
    for (label, read) in [
        (
            "Refraction",
            (|e| e.refraction) as fn(sootlight::render::Effects) -> Switch,
        ),
        ("Dispersion", |e| e.dispersion),
        ("Fire light", |e| e.fire_light),
        ("Salt lines", |e| e.lines),
        ("Salt bands", |e| e.bands),
        ("Radicals", |e| e.chemiluminescence),
    ] {
        choose(&mut harness, label, "On");
        assert_eq!(read(job(&harness).settings.effects), Switch::On, "{label}");
    }
    assert!(job(&harness).flame.bending.expect("asked for").dispersion);
    settle(&mut harness);
    harness.get_by_label_contains("there is nothing that it could fall on");
}

#[test]
fn an_asymmetry_goes_back_to_automatic_in_one_step_of_undo() {
    let mut harness = tall_window(Project::default());
    let set = |harness: &Harness<'_, App>| harness.state().document().project.soot.asymmetry;
    harness.get_by_label_contains("automatic: that of spheres");
    type_into(&mut harness, "Asymmetry", "0.6");
    assert_eq!(set(&harness), Some(0.6));
    assert!(
        harness
            .query_by_label_contains("automatic: that of spheres")
            .is_none()
    );
    double_click_name(&mut harness, "Asymmetry");
    assert_eq!(set(&harness), None);
    undo(&mut harness);
    assert_eq!(set(&harness), Some(0.6));
}

#[test]
fn a_dropped_png_goes_behind_the_fire_and_a_bad_one_says_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let white = image::RgbImage::from_pixel(2, 2, image::Rgb([255; 3]));
    white
        .save(path("wall.png"))
        .expect("the temporary folder can be written");
    std::fs::write(path("bad.png"), "no picture").expect("the temporary folder can be written");
    let mut harness = tall_window(Project::default());
    let volume = job(&harness).volume;
    drop_files(&mut harness, &[&path("wall.png")]);
    harness.run_steps(2);
    let now = job(&harness);
    assert!(Arc::ptr_eq(&now.volume, &volume), "the fire stays");
    let backdrop = now.stage.backdrop.expect("a backdrop");
    let Pattern::Picture(picture) = backdrop.pattern else {
        panic!("no picture")
    };
    assert_eq!(picture.size, [2, 2]);

    drop_files(&mut harness, &[&path("bad.png")]);
    harness.run_steps(2);
    harness.get_by_label_contains("bad.png cannot be shown: expected a PNG picture");
    assert!(
        job(&harness).stage.backdrop.is_some(),
        "the last picture stays"
    );
    undo(&mut harness);
    assert!(
        harness
            .query_by_label_contains("bad.png cannot be shown")
            .is_none()
    );
    undo(&mut harness);
    let stage = &harness.state().document().project.stage;
    assert_eq!(
        (stage.backdrop, &stage.backdrop_picture),
        (BackdropKind::None, &None)
    );
}

/// Waits until costs are measured and drawn.
fn measure(harness: &mut Harness<'_, App>) {
    settle(harness);
    for _ in 0..6000 {
        harness.run_steps(1);
        if harness.state().picture().progress.costs.is_some() {
            harness.run_steps(2);
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("nothing was measured");
}

/// The line under an effect's switch: state, change and cost, and below the reason.
fn words_under(harness: &Harness<'_, App>, effect: Effect, switch: &str) -> String {
    let decisions = &harness.state().document().decisions;
    let decision = decisions.iter().find(|it| it.effect == effect);
    let change = decision.expect("a decision").change().expect("a bound");
    let lines = harness.get_all_by_label_contains(&change);
    let bottom = harness
        .get_by_role_and_label(Role::ComboBox, switch)
        .rect()
        .bottom();
    let under = lines.filter(|line| line.rect().top() >= bottom - 1.0);
    let nearest = under.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    let node = nearest.expect("words under the switch");
    let node = node.accesskit_node();
    node.value().or(node.label()).unwrap_or_default()
}

#[test]
fn each_effect_tells_its_state_its_bound_its_reason_and_its_cost() {
    let mut project = Project::default();
    project.effects.scattering = Switch::On;
    let mut harness = tall_window(project);
    measure(&mut harness);
    let words = words_under(&harness, Effect::Scattering, "Scattered light");
    assert!(words.starts_with("computed · changes "), "{words}");
    assert!(words.contains(" ΔE · costs "), "{words}");
    assert!(words.contains(" s\nsoot of 21 nm scatters"), "{words}");
    let measured = harness.state().document().costs.clone();
    let cost = measured.iter().find(|it| it.effect == Effect::Scattering);
    assert!(cost.is_some_and(|cost| cost.seconds > 0.0), "{measured:?}");
    let again = words_under(&harness, Effect::ScatteringOrders, "Scattered again");
    // On a busy machine there is no time left to measure what it would take.
    assert!(again.contains(" ΔE"), "{again}");
    harness.get_by_label_contains("wavelengths hold the colours of soot");
    harness.get_by_label("computed\nsoot glows and absorbs");
    let of_salt = harness.query_all_by_label("left out\nthere is no salt");
    assert_eq!(of_salt.count(), 2, "lines and bands");

    // What this picture took says nothing of the next.
    choose(&mut harness, "Scattered light", "Off");
    measure(&mut harness);
    let costs = &harness.state().document().costs;
    assert!(costs.iter().all(|it| it.effect != Effect::Scattering));
    harness.get_by_label("left out\nit was switched off");
    assert!(
        harness
            .query_by_label_contains("soot of 21 nm scatters")
            .is_none()
    );
}

#[test]
fn smoke_is_switched_where_there_is_some() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot, heat];
    project.set("volume.smoke.grid=soot").expect("a key");
    let mut harness = tall_window(project);
    harness.get_by_label("computed\nit takes light from what is behind");
    choose(&mut harness, "Smoke", "Off");
    settle(&mut harness);
    harness.get_by_label("left out\nit was switched off");
    let smoke = harness.state().document().decisions.clone();
    let smoke = smoke.iter().find(|it| it.effect == Effect::Smoke);
    assert!(smoke.is_some_and(|it| !it.on), "{smoke:?}");
    choose(&mut harness, "Smoke", "On");
    settle(&mut harness);
    harness.get_by_label("computed\nit takes light from what is behind");
}
