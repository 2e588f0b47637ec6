//! What burns: presets, fuels and what they say of themselves, and menus that close alone.

use egui::Key;
use sootlight::render::develop::Metering;

use super::controls::{choose, job, tall_window};
use super::*;

/// Lets the fire burn as in a preset.
fn burn_as(harness: &mut Harness<'_, App>, preset: &str) {
    harness.get_by_label("a preset…").click();
    harness.run_steps(3);
    harness.get_by_label(preset).click();
    harness.run_steps(3);
    settle(harness);
}

fn metering(harness: &Harness<'_, App>) -> Metering {
    harness
        .state()
        .document()
        .metering
        .expect("a picture was seen")
}

#[test]
fn a_preset_is_exposed_for_what_it_burns_and_undo_brings_the_old_exposure_back() {
    let mut project = Project::default();
    project
        .set_all(["fuel.name=acetylene", "soot.amount=0.01"])
        .unwrap();
    let mut harness = tall_window(project.clone());
    let before = metering(&harness);
    burn_as(&mut harness, "Propane torch");
    let after = metering(&harness);
    assert_eq!(after, Metering::of(harness.state().picture().film()));
    assert!(after.exposure < 0.5 * before.exposure, "{after:?}");

    harness.get_by_label("Undo").click();
    settle(&mut harness);
    assert_eq!(harness.state().document().project, project);
    assert_eq!(metering(&harness), before);
    harness.get_by_label("Redo").click();
    settle(&mut harness);
    assert_eq!(metering(&harness), after);

    // What burns so already is not exposed anew, nor is what is changed by hand afterwards.
    burn_as(&mut harness, "Propane torch");
    harness.state_mut().document_mut().project.soot.amount = 0.1;
    settle(&mut harness);
    assert_eq!(metering(&harness), after);
}

#[test]
fn a_fuel_says_how_much_soot_it_makes_where_the_volume_does_not() {
    let mut harness = tall_window(Project::default());
    choose(&mut harness, "Fuel", "Acetylene, C₂H₂");
    harness.get_by_label("4 × the soot of propane");
    choose(&mut harness, "Fuel", "Methanol, CH₃OH (spirit)");
    settle(&mut harness);
    harness.get_by_label("burns without soot");
    harness.get_by_label("this fuel burns without soot");
    harness.get_by_label_contains("and nothing else glows");
    harness.get_by_label("Burn propane").click();
    settle(&mut harness);
    assert_eq!(job(&harness).flame.fuel.name(), "propane");
    assert!(harness.query_by_label_contains("without soot").is_none());
}

#[test]
fn escape_closes_an_open_menu_before_anything_else() {
    let mut harness = window_of(Project::default(), [1200.0, 900.0]);
    harness.key_press(Key::S);
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::ComboBox, "Salt")
        .click();
    harness.run_steps(3);
    harness.get_by_label("Copper (green)");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("Copper (green)").is_none());
    harness.get_by_label("Fuel and air");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("Fuel and air").is_none());
}
