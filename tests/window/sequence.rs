//! Frames of a sequence in the window: which is on show, what is held, how they play.

use std::collections::BTreeSet;

use egui::Key;

use super::*;
use crate::common::write_vdb;

/// A folder with frames 1, 2, 4, 5 and 6 of a fire in solver heat, each hotter than the one before; 5 is bad.
fn frames() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (number, heat) in [(1, 1.0), (2, 1.2), (4, 1.4), (6, 1.5)] {
        let path = folder.path().join(format!("fire_{number:02}.vdb"));
        write_vdb(&path, &[("flame", 1.0), ("temperature", heat)]);
    }
    std::fs::write(folder.path().join("fire_05.vdb"), "no volume at all").expect("written");
    folder
}

fn window_on(path: &Path) -> Harness<'static, App> {
    let mut project = Project::default();
    project.volume.path = vec![path.to_owned()];
    let mut harness = window_of(project, [900.0, 420.0]);
    wait_until(&mut harness, |app| app.frame().is_some());
    harness.run_steps(2);
    harness
}

/// Draws frames until something is so.
fn wait_until(harness: &mut Harness<'_, App>, is_so: impl Fn(&App) -> bool) {
    for _ in 0..6000 {
        harness.run_steps(1);
        if is_so(harness.state()) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("it was never so: frame {:?}", harness.state().frame());
}

fn press(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click_accesskit();
    harness.run_steps(2);
    settle(harness);
}

fn peak_y(app: &App) -> f32 {
    let pixels = app.picture().film().pixels().iter();
    pixels.map(|pixel| pixel.xyz[1]).fold(0.0, f32::max)
}

#[test]
fn a_step_holds_what_would_flicker_and_passes_a_bad_frame_over() {
    let folder = frames();
    let mut harness = window_on(&folder.path().join("fire_02.vdb"));
    harness.get_by_label_contains("frame 02 of 01 to 06");
    let of = |app: &App| {
        let job = app.job().expect("a job");
        (job.flame.maps.clone(), job.camera, app.view())
    };
    let before = of(harness.state());
    let light = peak_y(harness.state());
    press(&mut harness, "Next frame");
    // There is no frame 3.
    assert_eq!(harness.state().frame(), Some(4));
    harness.get_by_label_contains("frame 04 of 01 to 06");
    harness.get_by_label("fire_04.vdb");
    assert!(of(harness.state()) == before, "something is not held");
    // What is hotter is brighter: its own peak would have made it as bright.
    assert!(peak_y(harness.state()) > 1.2 * light);

    press(&mut harness, "Next frame");
    assert_eq!(harness.state().frame(), Some(4), "frame 5 is bad");
    let notice = harness.state().notice().expect("a notice").to_owned();
    assert!(
        notice.contains("frame 5 is passed over") && notice.contains("fire_05.vdb"),
        "{notice}"
    );
    harness.get_by_label("frame 5 is bad");
    press(&mut harness, "Next frame");
    assert_eq!(harness.state().frame(), Some(6));
    press(&mut harness, "Previous frame");
    assert_eq!(harness.state().frame(), Some(4));
    assert!(of(harness.state()) == before);

    // Neither frames nor what is held over them are steps of undo.
    assert!(!harness.state().document().can_undo());
    // What a person did before comes back as it was, on the frame on show and with the same held.
    let document = harness.state_mut().document_mut();
    document.change(|document| document.project.soot.amount = 2.0);
    harness.run_steps(1);
    settle(&mut harness);
    press(&mut harness, "Next frame");
    harness.state_mut().document_mut().undo();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(harness.state().document().project.soot.amount, 1.0);
    assert!(of(harness.state()) == before);
    assert_eq!(harness.state().frame(), Some(6));
    harness.get_by_label("fire_06.vdb");
}

#[test]
fn what_a_frame_before_the_fire_has_not_is_not_lost_to_the_others() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |number: u32, grids: &[(&str, f32)]| {
        write_vdb(&folder.path().join(format!("fire{number}.vdb")), grids);
    };
    write(1, &[("density", 0.2)]);
    write(2, &[("density", 0.3), ("flame", 1.0), ("temperature", 1.0)]);
    write(3, &[("density", 0.3), ("flame", 1.0), ("temperature", 1.5)]);
    let mut harness = window_on(&folder.path().join("fire1.vdb"));
    let flame = |app: &App| app.job().expect("a job").flame.maps.flame.clone();
    let heat = |app: &App| app.job().expect("a job").flame.maps.temperature.clone();
    assert!(flame(harness.state()).is_none());
    press(&mut harness, "Next frame");
    let (lit, hot) = (flame(harness.state()), heat(harness.state()));
    assert!(lit.is_some(), "the fire was set away");
    press(&mut harness, "Next frame");
    assert_eq!(harness.state().frame(), Some(3));
    assert!(flame(harness.state()) == lit && heat(harness.state()) == hot);
}

#[test]
fn a_range_that_pauses_goes_on_when_the_window_is_to_close_after_it() {
    let folder = frames();
    let mut harness = window_on(&folder.path().join("fire_01.vdb"));
    harness.get_by_label("Export…").click_accesskit();
    harness.run_steps(4);
    let name = folder.path().join("fire_01.exr");
    let field = harness.get_by_role_and_label(Role::TextInput, "File");
    field.set_text_value_accesskit(name.to_str().expect("a path of letters"));
    harness.run_steps(2);
    harness.get_by_label("Export range").click_accesskit();
    harness.run_steps(3);
    harness.get_by_label("Pause export").click_accesskit();
    harness.run_steps(2);
    harness.get_by_label("Go on exporting");
    assert!(!export::ask_to_close(&mut harness));
    harness.run_steps(3);
    harness
        .get_by_label("Close when it is done")
        .click_accesskit();
    let root = egui::ViewportId::ROOT;
    let closes = |harness: &Harness<'_, App>| {
        let commands = &harness.output().viewport_output[&root].commands;
        commands.contains(&egui::ViewportCommand::Close)
    };
    for _ in 0..6000 {
        harness.run_steps(1);
        if closes(&harness) {
            assert!(folder.path().join("fire_06.exr").exists());
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("it never closed");
}

#[test]
fn frames_play_in_a_loop_and_none_is_black_on_the_way() {
    let folder = frames();
    let mut harness = window_on(&folder.path().join("fire_01.vdb"));
    harness
        .get_by_role_and_label(Role::SpinButton, "Frames per second")
        .set_value_accesskit(200.0);
    harness.run_steps(2);
    harness.get_by_label("Play").click_accesskit();
    let (mut seen, mut rounds, mut last) = (BTreeSet::new(), 0, 0);
    for _ in 0..6000 {
        harness.run_steps(1);
        let app = harness.state();
        assert!(peak_y(app) > 0.0, "a black picture between two frames");
        assert!(app.plays(), "a bad frame ended the play");
        let frame = app.frame().expect("a frame");
        rounds += u32::from(frame < last);
        last = frame;
        seen.insert(frame);
        if rounds == 2 {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert_eq!(
        seen.into_iter().collect::<Vec<_>>(),
        [1, 2, 4, 6],
        "{rounds} rounds"
    );
    harness.get_by_label("frame 5 is bad");
    press(&mut harness, "Pause");
    assert!(!harness.state().plays());
    let frame = harness.state().frame();
    harness.run_steps(20);
    assert_eq!(harness.state().frame(), frame);

    // Without a loop it ends at the last.
    harness.get_by_label("Loop").click_accesskit();
    harness.run_steps(2);
    harness.get_by_label("Play").click_accesskit();
    harness.run_steps(2);
    wait_until(&mut harness, |app| !app.plays());
    settle(&mut harness);
    assert_eq!(harness.state().frame(), Some(6));
}

#[test]
fn a_folder_opens_its_first_frame_and_a_hand_scrubs() {
    let folder = frames();
    let mut harness = window_of(Project::default(), [900.0, 420.0]);
    assert!(
        harness.query_by_label("Play").is_none(),
        "the built-in flame has no frames"
    );
    drop_files(&mut harness, &[folder.path()]);
    wait_until(&mut harness, |app| app.frame() == Some(1));
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("fire_01.vdb");
    set_slider(&mut harness, "Frame", 5.9);
    settle(&mut harness);
    assert_eq!(harness.state().frame(), Some(6));
    // What is not there gives the nearest.
    set_slider(&mut harness, "Frame", 3.0);
    settle(&mut harness);
    assert_eq!(harness.state().frame(), Some(2));

    let set = |harness: &mut Harness<'_, App>, label: &str, value: f64| {
        harness
            .get_by_role_and_label(Role::SpinButton, label)
            .set_value_accesskit(value);
        harness.run_steps(3);
    };
    set(&mut harness, "In", 2.0);
    set(&mut harness, "Out", 4.0);
    for (key, frame) in [
        (Key::Period, 4),
        (Key::Period, 2),
        (Key::Comma, 4),
        (Key::Comma, 2),
    ] {
        harness.key_press(key);
        harness.run_steps(2);
        settle(&mut harness);
        assert_eq!(harness.state().frame(), Some(frame));
    }

    // Another file has a strip of its own, or none.
    let alone = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(alone.path());
    drop_files(&mut harness, &[&soot]);
    settle(&mut harness);
    harness.get_by_label("soot.txt");
    assert!(harness.query_by_label("Play").is_none());
    // An undo brings back the frame, and its strip with it.
    harness.state_mut().document_mut().undo();
    wait_until(&mut harness, |app| app.frame() == Some(2));
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("Play");
}

#[test]
fn a_range_is_exported_as_the_window_holds_it_and_goes_on_where_it_was_stopped() {
    let folder = frames();
    let mut harness = window_on(&folder.path().join("fire_02.vdb"));
    press(&mut harness, "Next frame");
    let held = harness.state().document().project.clone();
    let exposure = harness.state().view().exposure;

    let output = tempfile::tempdir().expect("a temporary folder");
    // Named after the frame on show: its number becomes that of each.
    export::ask_for(&mut harness, &output.path().join("fire_04.png"));
    for (label, side) in [("Width", 60.0), ("Height", 40.0)] {
        harness
            .get_by_role_and_label(Role::SpinButton, label)
            .set_value_accesskit(side);
        harness.run_steps(2);
    }
    harness.get_by_label("Export range").click_accesskit();
    wait_for(&mut harness, "pictures written");
    harness.get_by_label_contains("4 pictures written, 0 kept");
    harness.get_by_label_contains("1 failed");
    let of = |number: u32| export::read_png(&output.path().join(format!("fire_{number:02}.png")));
    for number in [1, 2, 4, 6] {
        let (_, _, project) = of(number);
        assert_eq!(project.volume.temperature, held.volume.temperature);
        assert_eq!(
            project.volume.path,
            [folder.path().join(format!("fire_{number:02}.vdb"))]
        );
        // What the window shows as white is so in each.
        let white = project
            .view
            .display_white_cd_m2
            .expect("an exposure that is held");
        assert!((683.0 / white / exposure - 1.0).abs() < 1e-3, "{white}");
    }
    // The hotter the brighter: nothing was exposed by itself.
    let mean = |number| {
        let (_, levels, _) = of(number);
        levels.iter().map(|&level| f64::from(level)).sum::<f64>()
    };
    assert!(mean(1) < mean(2) && mean(2) < mean(4) && mean(4) < mean(6));

    std::fs::remove_file(output.path().join("fire_04.png")).expect("it is there");
    // What is there is told before it could be lost.
    wait_for(&mut harness, "3 of 5 exist");
    harness.get_by_label("Export range").click_accesskit();
    harness.run_steps(4);
    wait_for(&mut harness, "1 picture written, 3 kept");
}

#[test]
fn a_frame_that_lacks_a_grid_is_shown_without_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let all = [("flame", 1.0), ("temperature", 1.0), ("density", 0.3)];
    for (number, grids) in [(1, &all[..]), (2, &all[..2]), (3, &all[..])] {
        write_vdb(&folder.path().join(format!("fire{number}.vdb")), grids);
    }
    let mut harness = window_on(&folder.path().join("fire1.vdb"));
    let smoke = |app: &App| app.job().expect("a job").flame.maps.smoke.is_some();
    assert!(smoke(harness.state()));
    press(&mut harness, "Next frame");
    assert_eq!(harness.state().frame(), Some(2));
    assert!(!smoke(harness.state()) && harness.state().notice().is_none());
    press(&mut harness, "Next frame");
    assert_eq!(harness.state().frame(), Some(3));
    assert!(
        smoke(harness.state()),
        "what one frame lacks is not lost to the others"
    );
}

#[test]
fn a_turntable_goes_once_round_what_is_on_show() {
    let mut harness = window_of(Project::default(), [900.0, 420.0]);
    let output = tempfile::tempdir().expect("a temporary folder");
    export::ask_for(&mut harness, &output.path().join("turn.png"));
    for (label, value) in [("Width", 24.0), ("Height", 16.0), ("Views", 4.0)] {
        harness
            .get_by_role_and_label(Role::SpinButton, label)
            .set_value_accesskit(value);
        harness.run_steps(2);
    }
    harness.get_by_label("views all around, 90° apart");
    let camera = harness.state().job().expect("a job").camera;
    let exposure = harness.state().view().exposure;
    harness.get_by_label("Export turntable").click_accesskit();
    wait_for(&mut harness, "4 pictures written, 0 kept");
    for quarter in 0..4_u8 {
        let name = format!("turn_{:04}.png", quarter + 1);
        let (_, _, project) = export::read_png(&output.path().join(name));
        let turned = camera.orbited(f64::from(quarter) * std::f64::consts::FRAC_PI_2, 0.0);
        let eye = project.camera.eye.expect("where it was seen from");
        assert!(eye.distance(turned.eye) < 1e-9, "{eye} {}", turned.eye);
        assert_eq!(project.camera.target, Some(camera.target));
        let white = project
            .view
            .display_white_cd_m2
            .expect("an exposure that is held");
        assert!((683.0 / white / exposure - 1.0).abs() < 1e-3, "{white}");
    }
}
