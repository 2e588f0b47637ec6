//! Pointer and keys over the picture: the camera moves, the picture zooms, and undo takes back whole gestures.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable};
use sootlight::app::App;
use sootlight::project::{CameraSettings, Project};
use sootlight::scene::Camera;

use super::{settle, window, window_of};

/// A place on the picture, and another.
const HERE: Pos2 = pos2(84.0, 120.0);
const THERE: Pos2 = pos2(124.0, 100.0);

fn camera(harness: &Harness<'_, App>) -> Camera {
    harness.state().job().expect("a job").camera
}

fn distance(camera: &Camera) -> f64 {
    (camera.eye - camera.target).length()
}

fn press(button: PointerButton, pos: Pos2, pressed: bool, modifiers: Modifiers) -> Event {
    Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers,
    }
}

/// A drag from [`HERE`] to [`THERE`], a frame for each event.
fn drag(harness: &mut Harness<'_, App>, button: PointerButton, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.event(Event::PointerMoved(HERE));
    harness.event(press(button, HERE, true, modifiers));
    for share in [0.1, 0.5, 0.8, 1.0] {
        harness.event(Event::PointerMoved(HERE.lerp(THERE, share)));
    }
    harness.event(press(button, THERE, false, modifiers));
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run_steps(2);
}

fn wheel(harness: &mut Harness<'_, App>, notches: f32, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.event(Event::PointerMoved(HERE));
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, notches),
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers,
    });
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run_steps(20);
}

#[test]
fn a_drag_orbits_and_keeps_distance_and_target() {
    for (button, modifiers) in [
        (PointerButton::Middle, Modifiers::NONE),
        (PointerButton::Primary, Modifiers::NONE),
        (PointerButton::Primary, Modifiers::ALT),
    ] {
        let mut harness = window(Project::default());
        let before = camera(&harness);
        drag(&mut harness, button, modifiers);
        let after = camera(&harness);
        // 40 points right and 20 up at 0.4° each: the eye goes left and down.
        let wanted = before.orbited((-16_f64).to_radians(), (-8_f64).to_radians());
        assert!(after.eye.abs_diff_eq(wanted.eye, 1e-6 * distance(&before)));
        assert!((distance(&after) / distance(&before) - 1.0).abs() < 1e-9);
        assert_eq!(
            (after.target, after.fov_deg),
            (before.target, before.fov_deg)
        );
        let set = &harness.state().document().project.camera;
        assert_eq!(
            (set.eye, set.fov_deg),
            (Some(after.eye), Some(after.fov_deg))
        );
    }
}

#[test]
fn a_drag_with_shift_moves_the_fire_with_the_pointer() {
    for button in [PointerButton::Middle, PointerButton::Primary] {
        let mut harness = window(Project::default());
        let before = camera(&harness);
        drag(&mut harness, button, Modifiers::SHIFT);
        let after = camera(&harness);
        let height = 2.0 * distance(&before) * (0.5 * before.fov_deg).to_radians().tan();
        let pixels = f64::from(harness.state().job().expect("a job").settings.size[1]);
        let wanted = glam::DVec3::new(-40.0, 0.0, -20.0) * (height / pixels);
        assert!((after.eye - before.eye).abs_diff_eq(wanted, 1e-6 * height));
        assert!((after.target - before.target).abs_diff_eq(wanted, 1e-6 * height));
    }
}

#[test]
fn wheel_and_drag_with_ctrl_dolly() {
    let mut harness = window(Project::default());
    let before = camera(&harness);
    wheel(&mut harness, 1.0, Modifiers::NONE);
    let nearer = camera(&harness);
    assert!((distance(&nearer) / distance(&before) - (-0.18_f64).exp()).abs() < 1e-3);
    assert_eq!(nearer.target, before.target);
    wheel(&mut harness, -1.0, Modifiers::NONE);
    assert!((distance(&camera(&harness)) / distance(&before) - 1.0).abs() < 1e-3);
    // Up is nearer.
    drag(&mut harness, PointerButton::Middle, Modifiers::CTRL);
    assert!(distance(&camera(&harness)) < 0.95 * distance(&before));
}

#[test]
fn home_frames_all_from_the_side_that_is_seen() {
    let mut harness = window(Project::default());
    let first = camera(&harness);
    drag(&mut harness, PointerButton::Middle, Modifiers::NONE);
    let turned = camera(&harness);
    drag(&mut harness, PointerButton::Middle, Modifiers::SHIFT);
    wheel(&mut harness, 9.0, Modifiers::NONE);
    harness.key_press(Key::Home);
    harness.run_steps(2);
    let framed = camera(&harness);
    let direction = |camera: &Camera| (camera.target - camera.eye).normalize();
    assert!(direction(&framed).abs_diff_eq(direction(&turned), 1e-9));
    assert!(framed.target.abs_diff_eq(first.target, 1e-9));
    assert!((distance(&framed) / distance(&first) - 1.0).abs() < 0.5);

    // From the front the project goes back to following the flame.
    harness.key_press(Key::Num1);
    harness.key_press(Key::Home);
    harness.run_steps(2);
    let set = &harness.state().document().project.camera;
    assert_eq!(
        *set,
        CameraSettings {
            fov_deg: Some(first.fov_deg),
            ..CameraSettings::default()
        }
    );
    assert_eq!(camera(&harness), first);
}

#[test]
fn a_frame_that_is_dragged_is_sharpened_alone() {
    let mut harness = window_of(Project::default(), [900.0, 700.0]);
    let first = camera(&harness);
    let sharp = |harness: &Harness<'_, App>| {
        let strides = harness.state().picture().strides();
        let is_sharp = |stride: &u8| usize::from(*stride == 1);
        strides.iter().map(is_sharp).sum::<usize>()
    };
    let all = sharp(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::B);
    harness.run_steps(2);
    harness.get_by_label("drag a frame over the picture");
    drag(&mut harness, PointerButton::Primary, Modifiers::NONE);
    settle(&mut harness);
    assert_eq!(camera(&harness), first, "the drag was for the frame");
    let some = sharp(&harness);
    assert!(some > 0 && some < all / 2, "{some} of {all}");
    // The next drag turns the camera again, and the frame stays.
    drag(&mut harness, PointerButton::Primary, Modifiers::NONE);
    settle(&mut harness);
    assert_ne!(camera(&harness), first);
    assert_eq!(sharp(&harness), some);
    harness.get_by_label("whole picture").click_accesskit();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(sharp(&harness), all);

    // A second thought.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::B);
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    harness.get_by_label("a region");
}

#[test]
fn a_view_is_kept_by_a_name_and_gone_back_to() {
    let mut harness = window_of(Project::default(), [900.0, 1400.0]);
    drag(&mut harness, PointerButton::Primary, Modifiers::NONE);
    let kept = camera(&harness);
    let field = harness.get_by_role_and_label(Role::TextInput, "Keep view as");
    field.focus();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::TextInput, "Keep view as")
        .type_text("low left");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    let views = |harness: &Harness<'_, App>| {
        let views = &harness.state().document().project.camera.views;
        views
            .iter()
            .map(|view| view.name.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(views(&harness), ["low left"]);
    // Other moves leave it.
    harness.key_press(Key::Num1);
    harness.key_press(Key::Home);
    harness.run_steps(3);
    assert_ne!(camera(&harness), kept);
    assert_eq!(views(&harness), ["low left"]);
    harness.get_by_label("low left").click_accesskit();
    harness.run_steps(3);
    assert_eq!(camera(&harness), kept);
    let text = harness.state().document().project.to_toml();
    assert!(text.contains("[[camera.views]]"), "{text}");
    harness
        .get_by_label("Forget view low left")
        .click_accesskit();
    harness.run_steps(3);
    assert!(views(&harness).is_empty());
}

#[test]
fn the_picture_pauses_and_goes_on() {
    let mut harness = window_of(Project::default(), [900.0, 700.0]);
    assert!(
        harness
            .get_by_label("Pause the picture")
            .accesskit_node()
            .is_disabled(),
        "there is nothing to pause"
    );
    harness.state_mut().document_mut().project.soot.amount = 1.5;
    harness.run_steps(1);
    harness.key_press(Key::P);
    harness.run_steps(2);
    harness
        .get_by_label("Go on with the picture")
        .click_accesskit();
    harness.run_steps(2);
    settle(&mut harness);
    // What is changed is seen, whatever paused.
    harness.state_mut().document_mut().project.soot.amount = 2.0;
    harness.run_steps(1);
    harness.key_press(Key::P);
    harness.run_steps(2);
    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
}

#[test]
fn keys_show_the_sides() {
    let mut harness = window(Project::default());
    let mut seen_from = |modifiers, key| {
        harness.key_press_modifiers(modifiers, key);
        harness.run_steps(2);
        let camera = camera(&harness);
        (camera.eye - camera.target).normalize()
    };
    for (modifiers, key, wanted) in [
        (Modifiers::NONE, Key::Num3, glam::DVec3::X),
        (Modifiers::COMMAND, Key::Num3, glam::DVec3::NEG_X),
        (Modifiers::NONE, Key::Num7, glam::DVec3::Z),
        (Modifiers::COMMAND, Key::Num7, glam::DVec3::NEG_Z),
        (Modifiers::COMMAND, Key::Num1, glam::DVec3::Y),
        (Modifiers::NONE, Key::Num1, glam::DVec3::NEG_Y),
    ] {
        let seen = seen_from(modifiers, key);
        assert!(seen.abs_diff_eq(wanted, 2e-3), "{key:?}: {seen}");
    }
}

#[test]
fn a_gesture_is_one_step_of_undo() {
    let mut harness = window(Project::default());
    let first = camera(&harness);
    drag(&mut harness, PointerButton::Middle, Modifiers::NONE);
    let turned = camera(&harness);
    wheel(&mut harness, 1.0, Modifiers::NONE);
    harness.key_press(Key::Num3);
    harness.run_steps(2);
    let mut undone = || {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.run_steps(2);
        camera(&harness)
    };
    assert!(distance(&undone()) < distance(&turned));
    assert_eq!(undone(), turned);
    assert_eq!(undone(), first);
}

#[test]
fn zooming_the_picture_renders_nothing_and_a_double_click_fits() {
    let mut harness = window(Project::default());
    let (generation, before) = (harness.state().generation(), camera(&harness));
    harness.get_by_label("Zoom 100 %");
    harness.key_press(Key::Plus);
    harness.run_steps(2);
    harness.get_by_label("Zoom 200 %");
    drag(&mut harness, PointerButton::Secondary, Modifiers::NONE);
    harness.key_press(Key::Minus);
    harness.key_press(Key::Minus);
    harness.run_steps(2);
    harness.get_by_label("Zoom 50 %");
    wheel(&mut harness, 2.0, Modifiers::COMMAND);
    assert!(harness.query_by_label("Zoom 50 %").is_none());
    harness.event(Event::Zoom(3.0));
    harness.run_steps(2);

    // All in one frame, so that it is quick enough.
    let events = &mut harness.input_mut().events;
    events.push(Event::PointerMoved(HERE));
    for _ in 0..2 {
        for pressed in [true, false] {
            events.push(press(
                PointerButton::Primary,
                HERE,
                pressed,
                Modifiers::NONE,
            ));
        }
    }
    harness.run_steps(3);
    harness.get_by_label("Zoom 100 %");
    assert_eq!(
        (harness.state().generation(), camera(&harness)),
        (generation, before)
    );
}

#[test]
fn the_buttons_do_what_they_are_called() {
    let mut harness = window(Project::default());
    for (button, zoom) in [
        ("Zoom in", "Zoom 200 %"),
        ("Zoom out", "Zoom 100 %"),
        ("Zoom out", "Zoom 50 %"),
        ("One to one", "Zoom 100 %"),
        ("Zoom in", "Zoom 200 %"),
        ("Fit", "Zoom 100 %"),
    ] {
        harness.get_by_label(button).click();
        harness.run_steps(3);
        harness.get_by_label(zoom);
    }
    let first = camera(&harness);
    wheel(&mut harness, 5.0, Modifiers::NONE);
    assert_ne!(camera(&harness), first);
    harness.get_by_label("Frame all").click();
    harness.run_steps(3);
    assert_eq!(camera(&harness), first);
}

#[test]
fn what_is_typed_into_a_field_moves_nothing() {
    let mut harness = window(Project::default());
    let before = camera(&harness);
    harness
        .get_by_role_and_label(Role::TextInput, "Keep view as")
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::Num3);
    harness.key_press(Key::Plus);
    harness.run_steps(2);
    assert_eq!(camera(&harness), before);
    harness.get_by_label("Zoom 100 %");
}

#[test]
fn a_hand_on_the_picture_leaves_the_field_that_was_typed_into() {
    let mut harness = window_of(Project::default(), [480.0, 1200.0]);
    let radius = |harness: &Harness<'_, App>| harness.state().document().project.soot.radius_nm;
    let before = radius(&harness);
    harness
        .get_by_role_and_label(Role::SpinButton, "Soot radius")
        .click();
    harness.run_steps(3);
    drag(&mut harness, PointerButton::Primary, Modifiers::NONE);
    let dragged = camera(&harness);
    harness.event(Event::Text("3".to_owned()));
    harness.key_press(Key::Num3);
    harness.run_steps(3);
    assert_ne!(camera(&harness), dragged, "a key for the camera");
    assert_eq!(radius(&harness), before);
}

#[test]
fn keys_are_not_for_the_picture_while_an_export_is_asked_for() {
    let mut harness = window(Project::default());
    let before = camera(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
    harness.run_steps(3);
    harness.key_press(Key::Num3);
    harness.run_steps(3);
    assert_eq!(camera(&harness), before);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    harness.key_press(Key::Num3);
    harness.run_steps(3);
    assert_ne!(camera(&harness), before);
}
