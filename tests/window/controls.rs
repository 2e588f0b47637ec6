//! Every control changes the job or the view exactly as it should, and says so where it cannot.

use sootlight::physics::soot::SootModel;
use sootlight::project::Job;
use sootlight::render::{Cancel, render_still};
use sootlight::scene::{Fuel, Interpolation, Salt};
use sootlight::volume::Producer;

use super::*;

/// A window as tall as its panel, so that the pointer reaches every control.
pub(super) fn tall_window(project: Project) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size([520.0, 3600.0])
        .with_step_dt(0.05)
        .build_eframe(|creation| app(creation, project));
    harness.state_mut().document_mut().fixed_size = Some([40, 60]);
    settle(&mut harness);
    harness
}

pub(super) fn job(harness: &Harness<'_, App>) -> Job {
    harness.state().job().cloned().expect("a job")
}

pub(super) fn choose(harness: &mut Harness<'_, App>, menu: &str, option: &str) {
    // What the newest picture says under the controls moves those below.
    settle(harness);
    harness.get_by_role_and_label(Role::ComboBox, menu).click();
    harness.run_steps(3);
    let options = harness.get_all_by_label(option).collect::<Vec<_>>();
    // The chosen one of a menu is also its title.
    options.last().expect("an option").click();
    harness.run_steps(3);
}

/// Types into a number field as a person does: a click, the text, Enter.
pub(super) fn type_into(harness: &mut Harness<'_, App>, label: &str, text: &str) {
    // What the newest picture says under the controls moves those below.
    settle(harness);
    harness
        .get_by_role_and_label(Role::SpinButton, label)
        .click();
    harness.run_steps(2);
    harness
        .input_mut()
        .events
        .push(egui::Event::Text(text.to_owned()));
    harness.run_steps(1);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
}

#[test]
fn fuel_changes_the_job_and_the_picture_where_the_soot_model_looks_at_it() {
    // How much soot there is was said by hand, so that only the soot's kind is the fuel's.
    let mut project = Project::default();
    project.set("volume.soot.scale=1").unwrap();
    // Nor do its products bend light.
    project.set("effects.refraction=off").unwrap();
    let mut harness = tall_window(project);
    let (before, generation) = (job(&harness), harness.state().generation());
    harness.get_by_label_contains("one soot for all fuels");
    choose(&mut harness, "Fuel", "Acetylene, C₂H₂");
    assert_eq!(job(&harness).flame.fuel, Fuel::named("acetylene").unwrap());
    assert_eq!(
        harness.state().generation(),
        generation,
        "rendered for nothing"
    );

    choose(&mut harness, "Soot model", "Dalzell & Sarofim 1969");
    assert_eq!(job(&harness).flame.soot_model, SootModel::DalzellSarofim);
    assert!(harness.query_by_label_contains("for all fuels").is_none());
    settle(&mut harness);
    let acetylene = harness.state().generation();
    assert_ne!(acetylene, generation);
    choose(&mut harness, "Fuel", "Propane, C₃H₈");
    assert_eq!(job(&harness).flame.fuel, Fuel::named("propane").unwrap());
    settle(&mut harness);
    assert_ne!(harness.state().generation(), acetylene);
    assert_eq!(job(&harness).settings, before.settings);
    assert_eq!(job(&harness).camera, before.camera);
}

#[test]
fn a_salt_colours_the_fire_and_its_amount_acts_only_then() {
    let mut harness = tall_window(Project::default());
    harness.get_by_label("there is no salt");
    let generation = harness.state().generation();
    choose(&mut harness, "Salt", "Sodium (yellow)");
    settle(&mut harness);
    assert_ne!(harness.state().generation(), generation);
    assert!(harness.query_by_label("there is no salt").is_none());
    assert_eq!(
        job(&harness).flame.glow.salt,
        Salt::named("sodium").unwrap()
    );
    type_into(&mut harness, "Salt amount", "2500");
    assert_eq!(job(&harness).flame.glow.salt_ppm, 2500.0);
}

#[test]
fn interpolation_is_chosen_and_renders_anew() {
    let mut harness = tall_window(Project::default());
    for (words, way) in [
        ("Tricubic", Interpolation::Tricubic),
        ("Nearest", Interpolation::Nearest),
    ] {
        let generation = harness.state().generation();
        choose(&mut harness, "Between voxels", words);
        assert_eq!(job(&harness).flame.interpolation, way);
        settle(&mut harness);
        assert_ne!(harness.state().generation(), generation);
    }
}

#[test]
fn humidity_and_carbon_dioxide_change_the_air_and_say_that_nothing_shows_it() {
    let mut project = Project::default();
    project.set("effects.refraction=off").unwrap();
    let mut harness = tall_window(project);
    let (before, generation) = (job(&harness), harness.state().generation());
    set_slider(&mut harness, "Humidity", 0.9);
    set_slider(&mut harness, "CO₂", 1500.0);
    let after = job(&harness);
    assert_eq!(
        (after.flame.air.humidity, after.flame.air.co2_ppm),
        (0.9, 1500.0)
    );
    let mut same = after.flame.clone();
    same.air = before.flame.air;
    assert_eq!(same, before.flame, "something else changed");
    assert_eq!(
        harness.state().generation(),
        generation,
        "rendered for nothing"
    );
    for words in ["CO₂ acts", "pressure acts"] {
        harness.get_by_label(&format!(
            "{words} through refraction, which is off: switch it on under Effects"
        ));
    }
}

#[test]
fn adaptation_changes_the_view_and_renders_nothing() {
    let mut harness = tall_window(Project::default());
    let (before, view, generation) = (
        job(&harness),
        harness.state().view(),
        harness.state().generation(),
    );
    set_slider(&mut harness, "Adaptation", 0.75);
    assert_eq!(
        harness.state().view(),
        View {
            adaptation: 0.75,
            ..view
        }
    );
    assert_eq!(harness.state().generation(), generation);
    assert_eq!(job(&harness), before);
}

#[test]
fn numbers_are_typed_with_units_and_refused_in_words() {
    let mut harness = tall_window(Project::default());
    type_into(&mut harness, "Soot radius", "425 Å");
    assert_eq!(job(&harness).flame.soot_radius_nm, 42.5);
    type_into(&mut harness, "Adaptation", "60 %");
    assert!((harness.state().view().adaptation - 0.6).abs() < 1e-12);

    type_into(&mut harness, "Soot radius", "12 lbs");
    assert_eq!(job(&harness).flame.soot_radius_nm, 42.5);
    harness.get_by_label_contains("“12 lbs” is not understood");
    type_into(&mut harness, "Soot radius", "1 µm");
    assert_eq!(job(&harness).flame.soot_radius_nm, 100.0);
    harness.get_by_label_contains("the most is 100 nm");
    set_slider(&mut harness, "Soot radius", 30.0);
    assert!(harness.query_by_label_contains("the most is").is_none());
}

#[test]
fn a_double_click_resets_in_one_step_of_undo() {
    let mut harness = tall_window(Project::default());
    let default = job(&harness).flame.soot_radius_nm;
    let radius = |harness: &Harness<'_, App>| job(harness).flame.soot_radius_nm;
    for role in [Role::Label, Role::Slider] {
        set_slider(&mut harness, "Soot radius", 60.0);
        // So long ago that no click is a part of what came before.
        for _ in 0..60 {
            harness.run_steps(1);
        }
        for _ in 0..2 {
            harness.get_by_role_and_label(role, "Soot radius").click();
            harness.run_steps(1);
        }
        harness.run_steps(2);
        assert_eq!(radius(&harness), default, "{role:?}");
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(2);
        assert_eq!(radius(&harness), 60.0, "{role:?}");
    }
}

#[test]
fn heat_smoke_fields_and_producer_change_what_the_file_means() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot, heat];
    let mut harness = tall_window(project);
    let map = |harness: &Harness<'_, App>| job(harness).flame.maps.temperature.expect("a map");
    let before = map(&harness);

    set_slider(&mut harness, "Temp. scale", 0.5);
    set_slider(&mut harness, "Temp. offset", 100.0);
    let after = map(&harness);
    assert_eq!((after.scale, after.offset), (0.5, 100.0));
    assert_eq!((after.min, after.max), (before.min, before.max));
    assert!((after.apply(1700.0) - 950.0).abs() < 1e-9);

    harness.get_by_label_contains("this volume has no smoke field");
    choose(&mut harness, "Smoke from", "soot");
    assert!(harness.query_by_label_contains("no smoke field").is_none());
    set_slider(&mut harness, "Smoke amount", 2.0);
    let flame = job(&harness).flame;
    assert_eq!(flame.maps.smoke.expect("smoke").grid, "soot");
    assert_eq!(flame.smoke_amount, 2.0);

    choose(&mut harness, "Producer", "Blender");
    assert_eq!(job(&harness).producer, Producer::Blender);
    choose(&mut harness, "Temp. from", "None");
    assert!(job(&harness).flame.maps.temperature.is_none());

    set_slider(&mut harness, "Voxel size", 0.02);
    assert!((job(&harness).flame.placement.metres_per_unit - 0.02).abs() < 1e-12);
    choose(&mut harness, "Up axis", "y");
    assert_eq!(
        job(&harness).flame.placement.up,
        sootlight::volume::UpAxis::Y
    );
}

#[test]
fn a_lens_keeps_the_camera_where_it_is() {
    let mut harness = tall_window(Project::default());
    let before = job(&harness).camera;
    set_slider(&mut harness, "Focal length", 85.0);
    let after = job(&harness).camera;
    assert_eq!((after.eye, after.target), (before.eye, before.target));
    let half_angle = (12.0_f64 / 85.0).atan().to_degrees();
    assert!((after.fov_deg - 2.0 * half_angle).abs() < 1e-9);
    type_into(&mut harness, "Focal length", "40°");
    assert!((job(&harness).camera.fov_deg - 40.0).abs() < 1e-9);
}

#[test]
fn a_picture_size_is_rendered_whatever_the_window() {
    let mut harness = tall_window(Project::default());
    choose(&mut harness, "Picture", "1080 × 1080");
    assert_eq!(job(&harness).settings.size, [1080, 1080]);
    choose(&mut harness, "Picture", "fills the window");
    assert_ne!(job(&harness).settings.size, [1080, 1080]);
}

#[test]
fn what_was_open_before_and_the_built_in_flame_can_be_opened_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot.clone()];
    let mut harness = tall_window(project);
    let open = |harness: &mut Harness<'_, App>, entry: &str| {
        harness.get_by_label("Recent").click();
        harness.run_steps(3);
        harness.get_by_role_and_label(Role::Button, entry).click();
        harness.run_steps(3);
        settle(harness);
        job(harness).volume.sources.clone()
    };
    assert!(open(&mut harness, "Built-in torch").is_empty());
    assert_eq!(open(&mut harness, "soot.txt"), [soot]);
}

#[test]
fn a_drag_under_full_load_stays_live_and_ends_at_the_last_job() {
    let mut harness = Harness::builder()
        .with_size([1280.0, 800.0])
        .build_eframe(|creation| app(creation, Project::default()));
    settle(&mut harness);
    let mut seen = std::collections::BTreeSet::new();
    for i in 0..120 {
        // One that only changes laws, and one for which the medium is packed anew.
        let project = &mut harness.state_mut().document_mut().project;
        project.soot.amount = 0.5 + 0.02 * f64::from(i);
        project.volume.temperature.scale = Some(1.0 - 0.001 * f64::from(i));
        harness.run_steps(1);
        std::thread::sleep(Duration::from_millis(8));
        let app = harness.state();
        seen.insert(app.picture().version);
    }
    assert!(
        seen.len() > 10,
        "the picture stood still: {} versions",
        seen.len()
    );
    settle(&mut harness);
    let last = job(&harness);
    // What is at the border of being seen stays as it was on the way.
    let mut settings = last.settings;
    let decisions = &harness.state().picture().progress.decisions;
    settings.effects = settings.effects.as_decided(decisions);
    let still = render_still(&last.scene(None), &settings, &Cancel::never(), &|_| {});
    assert!(*harness.state().picture().film() == still.expect("not cancelled").film);
}

#[test]
fn the_panel_makes_room_for_the_picture_and_comes_back() {
    let mut harness = window(Project::default());
    let narrow = job(&harness).settings.size;
    harness.key_press(egui::Key::N);
    harness.run_steps(3);
    assert!(job(&harness).settings.size[0] > narrow[0]);
    assert!(harness.query_by_label("Soot radius").is_none());
    harness.get_by_label("Panel").click();
    harness.run_steps(3);
    assert_eq!(job(&harness).settings.size, narrow);
}

#[test]
fn an_automatic_exposure_can_be_taken_back() {
    let mut harness = tall_window(Project::default());
    harness.state_mut().document_mut().project.soot.amount = 8.0;
    set_slider(&mut harness, "Exposure", 3.0);
    settle(&mut harness);
    let before = harness.state().view();
    harness.get_by_label("Auto exposure").click();
    harness.run_steps(2);
    let auto = harness.state().view();
    assert_ne!(auto, before);
    harness.get_by_label("Undo").click();
    harness.run_steps(2);
    assert_eq!(harness.state().view(), before);
    harness.get_by_label("Redo").click();
    harness.run_steps(2);
    assert_eq!(harness.state().view(), auto);
}

#[test]
fn a_shortcut_works_while_a_slider_has_the_focus() {
    let mut harness = tall_window(Project::default());
    let before = job(&harness).flame.soot_radius_nm;
    let slider = harness.get_by_role_and_label(Role::Slider, "Soot radius");
    slider.click();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::Slider, "Soot radius")
        .focus();
    harness.run_steps(2);
    assert_ne!(job(&harness).flame.soot_radius_nm, before);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(job(&harness).flame.soot_radius_nm, before);
}

#[test]
fn a_change_long_after_another_is_a_step_of_its_own() {
    let mut harness = tall_window(Project::default());
    let radius = |harness: &Harness<'_, App>| job(harness).flame.soot_radius_nm;
    harness
        .get_by_role_and_label(Role::Slider, "Soot radius")
        .click();
    harness.run_steps(2);
    let clicked = radius(&harness);
    // Frames are drawn only as long as somebody asks for the next one.
    for _ in 0..100 {
        let asked = &harness.output().viewport_output[&egui::ViewportId::ROOT];
        if asked.repaint_delay > Duration::from_secs(1) {
            break;
        }
        harness.run_steps(1);
    }
    set_slider(&mut harness, "Soot radius", 70.0);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(radius(&harness), clicked);
}

#[test]
fn a_field_that_is_only_looked_into_keeps_its_value() {
    let mut project = Project::default();
    // More digits than the fields show.
    project.soot.amount = 0.123_456;
    project.soot.radius_nm = 21.256_789;
    project.camera.fov_deg = Some(31.234_567);
    let mut harness = tall_window(project);
    let before = harness.state().document().project.clone();
    for label in ["Soot amount", "Soot radius", "Focal length", "Voxel size"] {
        harness
            .get_by_role_and_label(Role::SpinButton, label)
            .click();
        harness.run_steps(2);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(2);
        assert_eq!(harness.state().document().project, before, "{label}");
    }
    assert!(!harness.state().document().can_undo());
}
