//! Maps over the picture, and snapshots to compare it with.

use sootlight::project::Quality;
use sootlight::volume::BuiltIn;

use super::*;

/// A window with a small picture of the torch and all of its controls in sight.
fn small() -> Harness<'static, App> {
    let mut project = Project::default();
    project.set_all(["effects.scattering=off"]).unwrap();
    project.render.quality = Quality::Draft;
    let mut harness = Harness::builder()
        .with_size([1200.0, 1600.0])
        .build_eframe(|creation| App::new(creation, project).expect("the system gives threads"));
    harness.state_mut().document_mut().fixed_size = Some([48, 48]);
    settle(&mut harness);
    harness
}

fn press(harness: &mut Harness<'_, App>, key: egui::Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

#[test]
fn the_cost_of_each_pixel_is_a_key_away() {
    let mut harness = small();
    press(&mut harness, egui::Key::K);
    harness.get_by_label_contains("Cost of each pixel");
    harness.get_by_label("10000 and more");
    // All that was taken is on the map, up to rounding in single precision.
    let picture = harness.state().picture();
    let all: f64 = picture.samples().iter().copied().map(f64::from).sum();
    let taken = picture.progress.samples as f64;
    assert!(
        taken > 0.0 && (all / taken - 1.0).abs() < 1e-4,
        "{all} {taken}"
    );
    press(&mut harness, egui::Key::K);
    assert!(
        harness
            .query_by_label_contains("Cost of each pixel")
            .is_none()
    );
}

#[test]
fn the_error_of_each_pixel_is_measured_and_then_said_to_be() {
    let mut harness = small();
    harness.get_by_label_contains("ΔE (95 %), predicted");
    harness.get_by_label("error per pixel").click();
    harness.run_steps(3);
    harness.get_by_label_contains("Error of each pixel");
    for _ in 0..6000 {
        harness.run_steps(1);
        if harness
            .query_by_label_contains("ΔE (95 %), measured")
            .is_some()
        {
            let line = |harness: &Harness<'_, App>| {
                let line = harness.get_by_label_contains("ΔE (95 %), ");
                let words = line.value().unwrap_or_default();
                words.split(" ·").next().unwrap_or_default().to_owned()
            };
            // Another picture of the same scene is measured as well, without another reference, and by itself.
            let first = line(&harness);
            harness
                .state_mut()
                .document_mut()
                .project
                .render
                .step_voxels = Some(0.25);
            settle(&mut harness);
            wait_for(&mut harness, "ΔE (95 %), measured");
            assert_ne!(line(&harness), first);
            // Another scene is not.
            harness
                .state_mut()
                .document_mut()
                .project
                .render
                .step_voxels = None;
            harness.state_mut().document_mut().project.air.humidity = 0.9;
            press(&mut harness, egui::Key::E);
            harness.state_mut().document_mut().project.camera.fov_deg = Some(20.0);
            settle(&mut harness);
            harness.get_by_label_contains("ΔE (95 %), predicted");
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("nothing was measured");
}

#[test]
fn a_snapshot_is_wiped_against_and_goes_back() {
    let mut harness = small();
    let before = harness.state().document().project.clone();
    // Without a snapshot the picture itself becomes one.
    press(&mut harness, egui::Key::W);
    harness.get_by_role_and_label(Role::Button, "Snapshot 1");
    let line = harness.get_by_label("Wipe line");
    let first = line.rect().center().x;
    harness.state_mut().document_mut().project.soot.radius_nm = 55.0;
    settle(&mut harness);
    // The line follows the hand.
    let from = egui::pos2(first, 500.0);
    harness.drag_at(from);
    harness.run_steps(1);
    harness.hover_at(from + egui::vec2(-60.0, 0.0));
    harness.run_steps(1);
    harness.drop_at(from + egui::vec2(-60.0, 0.0));
    harness.run_steps(2);
    let moved = harness.get_by_label("Wipe line").rect().center().x;
    assert!((moved - first + 60.0).abs() < 2.0, "{first} {moved}");
    // The camera has not moved with it.
    let now = &harness.state().document().project;
    assert_eq!(now.camera, before.camera);
    assert_ne!(*now, before);

    harness.get_by_label("Restore").click();
    harness.run_steps(2);
    assert_eq!(harness.state().document().project, before);
    harness.state_mut().document_mut().undo();
    assert_ne!(harness.state().document().project, before);
    press(&mut harness, egui::Key::Escape);
    assert!(harness.query_by_label("Wipe line").is_none());
}

#[test]
fn a_snapshot_that_is_forgotten_ends_the_comparison() {
    let mut harness = small();
    harness.get_by_label("Grab snapshot").click();
    harness.run_steps(2);
    press(&mut harness, egui::Key::Q);
    harness.get_by_label("Forget").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Snapshot 1").is_none());
    harness.get_by_label_contains("grab one");
}

#[test]
fn a_picture_that_is_not_there_yet_is_not_grabbed() {
    let mut harness = small();
    // The camera has moved in the same frame: what is on show is not what is set.
    harness.state_mut().document_mut().project.camera.fov_deg = Some(25.0);
    harness.key_press(egui::Key::G);
    harness.run_steps(1);
    assert!(
        harness
            .state()
            .notice()
            .is_some_and(|words| words.contains("wait"))
    );
    assert!(
        harness
            .query_by_role_and_label(Role::Button, "Snapshot 1")
            .is_none()
    );
    settle(&mut harness);
    press(&mut harness, egui::Key::G);
    harness.get_by_role_and_label(Role::Button, "Snapshot 1");
}

#[test]
fn a_key_that_is_held_down_grabs_once() {
    let mut harness = small();
    for repeat in [false, true, true] {
        harness.input_mut().events.push(egui::Event::Key {
            key: egui::Key::G,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: egui::Modifiers::NONE,
        });
        harness.run_steps(1);
    }
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Snapshot 1");
    let second = harness.query_by_role_and_label(Role::Button, "Snapshot 2");
    assert!(second.is_none());
}

#[test]
fn arrows_move_the_line_again_and_again() {
    let mut harness = small();
    press(&mut harness, egui::Key::W);
    let x = |harness: &Harness<'_, App>| harness.get_by_label("Wipe line").rect().center().x;
    let first = x(&harness);
    harness.get_by_label("Wipe line").focus();
    harness.run_steps(2);
    for _ in 0..5 {
        press(&mut harness, egui::Key::ArrowRight);
    }
    let moved = x(&harness) - first;
    press(&mut harness, egui::Key::ArrowLeft);
    assert!(moved > 0.0);
    assert!((x(&harness) - first) / moved > 0.75 && x(&harness) < first + moved);
}

#[test]
fn a_snapshot_whose_volume_was_let_go_reads_it_again() {
    let mut harness = small();
    press(&mut harness, egui::Key::G);
    let first = harness.state().document().project.clone();
    for flame in [BuiltIn::Burner, BuiltIn::Spirit] {
        let document = harness.state_mut().document_mut();
        document.project.volume.built_in = flame;
        document.open(Arc::new(flame.volume())).unwrap();
        settle(&mut harness);
        press(&mut harness, egui::Key::G);
    }
    harness.get_by_role_and_label(Role::Button, "Snapshot 3");
    harness.get_all_by_label("Restore").next().unwrap().click();
    harness.run_steps(2);
    settle(&mut harness);
    let document = harness.state().document();
    assert_eq!(document.project, first);
    let open = document.volume().unwrap();
    assert_eq!(open.built_in, Some(BuiltIn::default()));
}
