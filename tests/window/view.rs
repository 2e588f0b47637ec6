//! The eye and the display: every control of the view changes how the picture is developed, and renders nothing.

use egui_kittest::kittest::NodeT as _;
use sootlight::colour::display::Curve;
use sootlight::render::white::black_body_xyz;

use super::controls::{choose, job, tall_window};
use super::*;

/// Does something to the view of a settled window, and gives the view before and after.
#[track_caller]
fn changed(
    harness: &mut Harness<'_, App>,
    change: impl FnOnce(&mut Harness<'_, App>),
) -> [View; 2] {
    let before = (harness.state().view(), job(harness));
    let generation = harness.state().generation();
    change(harness);
    harness.run_steps(2);
    assert_eq!(harness.state().generation(), generation, "rendered again");
    assert_eq!(job(harness), before.1);
    [before.0, harness.state().view()]
}

#[test]
fn a_white_is_set_in_kelvin_and_taken_from_the_scene_again() {
    let mut harness = tall_window(Project::default());
    assert!(
        harness
            .query_by_role_and_label(Role::Slider, "White at")
            .is_none()
    );
    let [measured, set] = changed(&mut harness, |harness| choose(harness, "White", "Set"));
    assert_eq!(
        set,
        View {
            white_xyz: black_body_xyz(1900.0),
            ..measured
        }
    );
    let [_, lamp] = changed(&mut harness, |harness| {
        set_slider(harness, "White at", 2856.0);
    });
    assert_eq!(lamp.white_xyz, black_body_xyz(2856.0));
    assert_eq!(
        harness.state().document().project.view.white_k,
        Some(2856.0)
    );
    let [_, again] = changed(&mut harness, |harness| {
        choose(harness, "White", "From the scene");
    });
    assert_eq!(again, measured);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(harness.state().view(), lamp);
}

#[test]
fn a_white_that_no_eye_looks_at_says_so() {
    let mut project = Project::default();
    project.view.adaptation = 0.0;
    let mut harness = tall_window(project);
    harness.get_by_label_contains("looks at no white");
    set_slider(&mut harness, "Adaptation", 0.5);
    assert!(
        harness
            .query_by_label_contains("looks at no white")
            .is_none()
    );
}

#[test]
fn every_curve_can_be_chosen_and_the_eye_has_its_half_saturation() {
    let mut harness = tall_window(Project::default());
    let mut last = Curve::Photographic;
    for (name, curve) in [
        ("Filmic, hue kept", Curve::Filmic),
        ("Linear", Curve::Linear),
        ("Eye", Curve::Eye),
    ] {
        let [before, after] = changed(&mut harness, |harness| choose(harness, "Curve", name));
        assert_eq!(before.curve, last);
        assert_eq!(after, View { curve, ..before });
        last = curve;
    }
    harness.get_by_label("follows the measured exposure");
    let [before, after] = changed(&mut harness, |harness| {
        set_slider(harness, "Half at", 55_555.5);
    });
    // As wide a number as there is: nothing is pushed out of the panel.
    let right = |label| {
        let row = harness.get_by_role_and_label(Role::SpinButton, label);
        row.rect().right()
    };
    assert_eq!(right("Half at"), right("Exposure"));
    let metered = harness.state().document().metering.expect("a metering");
    let wanted = 55_555.5 * metered.exposure / 683.0;
    assert!((after.half_saturation / wanted - 1.0).abs() < 1e-12);
    assert_eq!(
        View {
            half_saturation: before.half_saturation,
            ..after
        },
        before
    );
    assert!(
        harness
            .query_by_label("follows the measured exposure")
            .is_none()
    );

    choose(&mut harness, "Curve", "Photographic");
    assert!(
        harness
            .query_by_role_and_label(Role::Slider, "Half at")
            .is_none(),
        "only the eye has one"
    );
}

#[test]
fn false_colour_comes_with_a_legend_in_stops_and_luminance() {
    let mut harness = tall_window(Project::default());
    assert!(harness.query_by_label_contains("mid grey").is_none());
    let [before, after] = changed(&mut harness, |harness| {
        choose(harness, "False colour", "Luminance in stops");
    });
    assert_eq!(
        after,
        View {
            false_colour: true,
            ..before
        }
    );
    harness.get_by_label_contains("0 mid grey, ");
    harness.get_by_label_contains("black, below ");
    harness.get_by_label_contains("white, from ");
    for stop in ["−6, ", "−1, ", "+1, ", "+7, "] {
        harness.get_by_label_contains(stop);
    }
    harness.get_by_label_contains("which adaptation leaves alone");
    // A stop more of exposure, and each colour stands for half the light.
    let grey = |harness: &Harness<'_, App>| {
        let node = harness.get_by_label_contains("0 mid grey, ");
        let words = node.accesskit_node().value().expect("words");
        let number = words.split([',', 'c']).nth(1).expect("a luminance");
        number.trim().parse::<f64>().expect("a number")
    };
    let at_first = grey(&harness);
    set_slider(&mut harness, "Exposure", 1.0);
    assert!((grey(&harness) / at_first - 0.5).abs() < 1e-2);
    choose(&mut harness, "Curve", "Linear");
    assert!(harness.query_by_label_contains("+3, ").is_none());
    harness.get_by_label_contains("+2, ");
}

#[test]
fn the_legend_leaves_the_buttons_of_a_narrow_window_alone() {
    for width in [480.0, 560.0, 640.0, 900.0] {
        let mut project = Project::default();
        project.set("view.false_colour=true").unwrap();
        let harness = window_of(project, [width, 420.0]);
        let black = harness.get_by_label_contains("black, below ").rect();
        for button in ["Zoom in", "Fit", "Frame all"] {
            let button = harness.get_by_role_and_label(Role::Button, button).rect();
            assert!(!button.intersects(black), "{width}: {button:?} {black:?}");
        }
    }
}
