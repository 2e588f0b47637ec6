//! Saving what is set, opening it, and carrying it from one fire to another.

use egui::{Event, Key, Modifiers, OutputCommand};

use super::export::ask_to_close;
use super::*;

fn press(harness: &mut Harness<'_, App>, label: &str) {
    harness.run_steps(2);
    harness.get_by_label(label).click();
    // A window that opens is laid out before it is seen.
    harness.run_steps(4);
}

fn wait_until_saved(harness: &mut Harness<'_, App>) {
    for _ in 0..1000 {
        harness.run_steps(1);
        if !harness.state().is_unsaved() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("never saved: {:?}", harness.state().notice());
}

/// Types a path in the place of what stands in the field.
fn name_it(harness: &mut Harness<'_, App>, path: &Path) {
    let field = harness.get_by_label("Scene file");
    field.focus();
    harness.run_steps(1);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(1);
    let field = harness.get_by_label("Scene file");
    field.type_text(&path.display().to_string());
    harness.run_steps(1);
}

#[test]
fn a_scene_is_saved_where_it_is_told_and_opened_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let mut harness = window_of(Project::default(), [900.0, 600.0]);
    assert!(!harness.state().is_unsaved());
    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
    assert!(harness.state().is_unsaved());

    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    // The ending may be left out.
    name_it(&mut harness, &path.with_extension(""));
    harness.key_press(Key::Enter);
    wait_until_saved(&mut harness);
    assert!(harness.query_by_label("Scene file").is_none(), "it closes");
    assert_eq!(
        Project::read(&path).unwrap(),
        harness.state().document().project
    );

    // From here on the same file is written without a question, and not before it is asked for.
    harness.state_mut().document_mut().project.soot.amount = 0.5;
    settle(&mut harness);
    assert_eq!(Project::read(&path).unwrap().soot.amount, 2.5);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    wait_until_saved(&mut harness);
    assert!(harness.query_by_label("Scene file").is_none());
    assert_eq!(Project::read(&path).unwrap().soot.amount, 0.5);

    let mut other = window(Project::default());
    other.state_mut().open(vec![path.clone()]);
    settle(&mut other);
    assert_eq!(other.state().document().project.soot.amount, 0.5);
    assert!(!other.state().is_unsaved());
    // Opened by mistake, it is taken back.
    other.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut other);
    assert_eq!(other.state().document().project.soot.amount, 1.0);
    // What is open then is not that file's scene, and does not replace it.
    other.key_press_modifiers(Modifiers::COMMAND, Key::S);
    other.run_steps(4);
    assert!(
        other.query_by_label("Scene file").is_some(),
        "it asks where"
    );
    assert_eq!(Project::read(&path).unwrap().soot.amount, 0.5);
    other.key_press(Key::Escape);
    other.run_steps(2);

    // A scene that cannot be read leaves all as it is, in words.
    std::fs::write(&path, "[soot]\namont = 1").unwrap();
    other.state_mut().open(vec![path.clone()]);
    let words = settle_with_notice(&mut other);
    assert!(
        words.contains("mine.toml") && words.contains("amount"),
        "{words}"
    );
    assert_eq!(other.state().document().project.soot.amount, 1.0);
}

#[test]
fn a_scene_that_was_named_is_where_it_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("named.toml");
    std::fs::write(&path, "[soot]\namount = 2.5\n").unwrap();
    let said = Project::read(&path).unwrap();
    // As with `--set soot.amount=3` beside it: that is in no file yet.
    let mut project = said.clone();
    project.soot.amount = 3.0;
    let mut harness = Harness::builder()
        .with_size([900.0, 600.0])
        .build_eframe(|creation| {
            let mut app = app(creation, project);
            app.is_of_scene(&path, said);
            app
        });
    settle(&mut harness);
    assert!(harness.state().is_unsaved());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    wait_until_saved(&mut harness);
    assert!(
        harness.query_by_label("Scene file").is_none(),
        "it is known"
    );
    assert_eq!(Project::read(&path).unwrap().soot.amount, 3.0);
    assert!(!harness.state().is_unsaved());
}

#[test]
fn a_scene_that_cannot_be_written_stays_open_and_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(Project::default(), [900.0, 600.0]);
    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    name_it(&mut harness, &folder.path().join("nowhere").join("a.toml"));
    harness.key_press(Key::Enter);
    let words = settle_with_notice(&mut harness);
    assert!(
        words.contains("a.toml") && words.contains("folder"),
        "{words}"
    );
    assert!(harness.state().is_unsaved());
}

#[test]
fn a_window_whose_settings_are_in_no_file_asks_before_it_closes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.toml");
    let mut harness = window_of(Project::default(), [900.0, 600.0]);
    // Where somebody looks from is not worth a question.
    harness.state_mut().document_mut().project.camera.fov_deg = Some(40.0);
    settle(&mut harness);
    assert!(ask_to_close(&mut harness));

    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
    assert!(!ask_to_close(&mut harness));
    press(&mut harness, "Go on working");
    assert!(harness.query_by_label("Save and close").is_none());
    assert!(!ask_to_close(&mut harness));
    press(&mut harness, "Save and close");
    name_it(&mut harness, &path);
    harness.key_press(Key::Enter);
    wait_until_saved(&mut harness);
    assert_eq!(Project::read(&path).unwrap().soot.amount, 2.5);
    assert!(ask_to_close(&mut harness), "it is saved");

    let mut other = window_of(Project::default(), [900.0, 600.0]);
    other.state_mut().document_mut().project.soot.amount = 3.0;
    settle(&mut other);
    assert!(!ask_to_close(&mut other));
    press(&mut other, "Close without saving");
    assert!(ask_to_close(&mut other));
}

#[test]
fn a_frame_that_is_shown_instead_is_nothing_to_be_saved() {
    let folder = tempfile::tempdir().unwrap();
    let paths = [1, 2].map(|number| {
        let path = folder.path().join(format!("fire_{number}.vdb"));
        let peak = 0.5 + 0.2 * number as f32;
        crate::common::write_vdb(
            &path,
            &[("density", 0.4), ("flame", peak), ("temperature", 2.0)],
        );
        path
    });
    let mut harness = window_of(Project::default(), [900.0, 600.0]);
    harness.state_mut().open(vec![paths[0].clone()]);
    settle(&mut harness);
    assert!(!harness.state().is_unsaved(), "it was opened");
    for _ in 0..200 {
        if harness.state().frame().is_some() {
            break;
        }
        harness.run_steps(1);
        std::thread::sleep(Duration::from_millis(10));
    }
    harness.key_press(Key::ArrowRight);
    settle(&mut harness);
    assert_eq!(harness.state().frame(), Some(2));
    assert!(!harness.state().is_unsaved());
    harness
        .state_mut()
        .document_mut()
        .project
        .volume
        .temperature
        .offset = Some(250.0);
    settle(&mut harness);
    assert!(harness.state().is_unsaved());

    // What was set for one fire and goes on for the next is still in no file.
    let mut harness = window_of(Project::default(), [900.0, 600.0]);
    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
    harness.state_mut().open(vec![paths[0].clone()]);
    settle(&mut harness);
    assert!(harness.state().is_unsaved());
}

#[test]
fn settings_are_copied_as_text_and_pasted_onto_another_fire() {
    let mut from = window(Project::default());
    from.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut from);
    from.event(Event::ModifiersChanged(
        Modifiers::COMMAND | Modifiers::SHIFT,
    ));
    from.event(Event::Copy);
    from.step();
    let commands = &from.output().platform_output.commands;
    let copied = commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.expect("text on the clipboard");

    let mut onto = window({
        let mut project = Project::default();
        project.set("volume.built_in=burner").unwrap();
        project
    });
    onto.input_mut().events.push(Event::Paste(copied));
    settle(&mut onto);
    let project = &onto.state().document().project;
    assert_eq!(project.soot.amount, 2.5);
    assert_eq!(project.volume.built_in.name(), "burner");
    onto.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut onto);
    assert_eq!(onto.state().document().project.soot.amount, 1.0);

    let wrong = "[soot]\namount = -1".to_owned();
    onto.input_mut().events.push(Event::Paste(wrong));
    let words = settle_with_notice(&mut onto);
    assert!(words.contains("soot.amount"), "{words}");
    assert_eq!(onto.state().document().project.soot.amount, 1.0);
}

#[test]
fn what_burns_is_kept_as_a_preset_and_given_to_another_fire() {
    let folder = tempfile::tempdir().unwrap();
    let presets = folder.path().join("presets");
    let mut harness = window_of(Project::default(), [900.0, 700.0]);
    harness.state_mut().keep_presets_in(&presets);
    harness.state_mut().document_mut().project.soot.amount = 2.5;
    settle(&mut harness);
    press(&mut harness, "a preset…");
    harness.get_by_label("Name of a preset").focus();
    harness.run_steps(1);
    harness
        .get_by_label("Name of a preset")
        .type_text("my fire");
    harness.run_steps(2);
    press(&mut harness, "Keep");
    let kept = Project::read(&presets.join("my fire.toml")).unwrap();
    assert_eq!(kept.soot.amount, 2.5);

    let mut other = window_of(Project::default(), [900.0, 700.0]);
    other.state_mut().keep_presets_in(&presets);
    press(&mut other, "a preset…");
    press(&mut other, "my fire");
    settle(&mut other);
    assert_eq!(other.state().document().project.soot.amount, 2.5);
    other.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut other);
    assert_eq!(other.state().document().project.soot.amount, 1.0);
}

#[test]
fn one_page_tells_what_all_keys_do() {
    let mut harness = window_of(Project::default(), [1280.0, 720.0]);
    assert!(harness.query_by_label("frame all of the fire").is_none());
    harness.key_press(Key::F1);
    harness.run_steps(2);
    harness.get_by_label("frame all of the fire");
    // What the README says is on it.
    let readme = include_str!("../../README.md");
    for key in ["Ctrl+O", "Ctrl+S", "Ctrl+E", "Ctrl+Shift+C", "Home", "F1"] {
        assert!(readme.contains(key), "{key}");
        let told = harness.query_all_by_label_contains(key).next();
        assert!(told.is_some(), "{key}");
    }
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("frame all of the fire").is_none());
}
