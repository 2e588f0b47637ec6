//! A session is never lost: what was open and set in a window that was killed is offered by the next.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use super::*;

/// Where the child keeps what is set, and what it opens.
const FOLDER: &str = "SOOTLIGHT_TEST_SESSIONS";
const FILE: &str = "SOOTLIGHT_TEST_FILE";

/// A window that keeps what is set in a folder.
fn window_in(folder: &Path) -> Harness<'static, App> {
    let mut harness = window(Project::default());
    harness.state_mut().keep_in(folder);
    harness.run_steps(2);
    harness
}

fn scenes(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_scene = |path: PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    entries.filter(|entry| is_scene(entry.path())).count()
}

/// Draws frames until something is kept.
fn wait_until_kept(harness: &mut Harness<'_, App>, folder: &Path) {
    for _ in 0..6000 {
        harness.run_steps(1);
        if scenes(folder) > 0 {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("nothing was kept");
}

#[test]
#[ignore = "another test starts it in a process of its own, and kills it"]
fn a_window_to_be_killed() {
    let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else {
        return;
    };
    let mut harness = window_in(&folder);
    let file = PathBuf::from(std::env::var_os(FILE).expect("a file"));
    drop_files(&mut harness, &[&file]);
    settle(&mut harness);
    set_slider(&mut harness, "Soot amount", 7.0);
    wait_until_kept(&mut harness, &folder);
    println!("\nkept");
    loop {
        harness.run_steps(1);
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Starts the window of above and kills it once it has kept what was set.
fn kill_a_window(folder: &Path, file: &Path) {
    let mut child = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "window::session::a_window_to_be_killed"])
        .args(["--ignored", "--nocapture"])
        .env(FOLDER, folder)
        .env(FILE, file)
        .stdout(Stdio::piped())
        .spawn()
        .expect("this program starts again");
    let kept = says(&mut child, "kept");
    child.kill().expect("it runs");
    child.wait().expect("it was killed");
    assert!(kept, "the window kept nothing");
}

/// Whether a process says this before it ends.
fn says(child: &mut Child, word: &str) -> bool {
    let said = BufReader::new(child.stdout.take().expect("a pipe"));
    said.lines().map_while(Result::ok).any(|line| line == word)
}

#[test]
fn what_was_open_in_a_killed_window_is_offered_and_restored() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = place.path().join("sessions");
    let (soot, _) = soot_and_heat(place.path());
    kill_a_window(&folder, &soot);

    let mut harness = window_in(&folder);
    assert!(harness.state().document().title().contains("torch"));
    harness.get_by_label_contains("soot.txt) was kept");
    harness.get_by_label("Restore what was open").click();
    harness.run_steps(2);
    settle(&mut harness);
    let project = harness.state().document().project.clone();
    assert_eq!(project.soot.amount, 7.0);
    assert_eq!(harness.state().document().title(), "soot.txt");
    assert!(harness.query_by_label("Restore what was open").is_none());
    assert_eq!(scenes(&folder), 1, "it is kept as this window's own");
    // It is a step as any other.
    harness.state_mut().document_mut().undo();
    harness.run_steps(2);
    assert!(harness.state().document().title().contains("torch"));
}

#[test]
fn what_was_kept_can_be_declined_and_a_window_that_ends_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut gone = window_in(folder.path());
    set_slider(&mut gone, "Soot amount", 7.0);
    wait_until_kept(&mut gone, folder.path());
    // Two windows at once: what one keeps is not offered by the other, which keeps its own.
    let mut beside = window_in(folder.path());
    assert!(beside.query_by_label("Restore what was open").is_none());
    drop(gone);
    let mut next = window_in(folder.path());
    next.get_by_label("Forget it").click();
    next.run_steps(2);
    assert!(next.query_by_label("Restore what was open").is_none());
    assert_eq!(scenes(folder.path()), 0);

    set_slider(&mut beside, "Soot amount", 3.0);
    wait_until_kept(&mut beside, folder.path());
    eframe::App::on_exit(beside.state_mut());
    assert_eq!(
        std::fs::read_dir(folder.path())
            .expect("the folder")
            .count(),
        0
    );
}

#[test]
fn what_cannot_be_read_any_more_stays_offered_and_the_picture_stays() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = place.path().join("sessions");
    let (soot, _) = soot_and_heat(place.path());
    kill_a_window(&folder, &soot);
    let bytes = std::fs::read(&soot).expect("the file is there");
    std::fs::remove_file(&soot).expect("the file is there");

    let mut harness = window_in(&folder);
    harness.get_by_label("Restore what was open").click();
    harness.run_steps(2);
    let words = settle_with_notice(&mut harness);
    assert!(words.contains("soot.txt"), "{words}");
    assert!(harness.state().document().title().contains("torch"));
    std::fs::write(&soot, bytes).expect("the folder can be written");
    harness.get_by_label("Restore what was open").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(harness.state().document().title(), "soot.txt");
}

#[test]
fn a_window_that_loses_its_graphics_device_closes_and_keeps_what_was_set() {
    if shader::device().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut device = None;
    let mut harness = Harness::builder()
        .with_size([480.0, 320.0])
        .wgpu()
        .build_eframe(|creation| {
            let state = creation.wgpu_render_state.as_ref().expect("a device");
            device = Some(state.device.clone());
            App::new(creation, Project::default()).expect("the system gives threads")
        });
    settle(&mut harness);
    harness.state_mut().keep_in(folder.path());
    // Not kept yet when the device goes.
    set_slider(&mut harness, "Soot amount", 7.0);
    let device = device.expect("a device");
    device.destroy();
    let _ = device.poll(wgpu::PollType::Poll);
    harness.run_steps(1);
    let commands = &harness.output().viewport_output[&egui::ViewportId::ROOT].commands;
    assert!(
        commands.contains(&egui::ViewportCommand::Close),
        "{commands:?}"
    );
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let mut next = window_in(folder.path());
    next.get_by_label("Restore what was open").click();
    next.run_steps(2);
    settle(&mut next);
    assert_eq!(next.state().document().project.soot.amount, 7.0);
}
