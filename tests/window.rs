//! The window, headless and by accessible label. No display is needed; what needs a graphics driver says so.

mod accuracy;
mod canvas;
mod compare;
mod controls;
mod export;
mod fire;
mod opening;
mod plots;
mod reach;
mod real;
mod scene_file;
mod sequence;
mod session;
mod shader;
mod stage;
mod tasks;
mod view;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sootlight::app::App;
use sootlight::colour::display::{BakedView, View};
use sootlight::physics::soot::Hold;
use sootlight::project::Project;

/// A window so small that its pictures are quick, with a canvas of 168 × 292 pixels.
fn window(project: Project) -> Harness<'static, App> {
    window_of(project, [480.0, 320.0])
}

/// A window of this size in points, each of them a pixel.
fn window_of(project: Project, size: [f32; 2]) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size(size)
        .build_eframe(|creation| app(creation, project));
    settle(&mut harness);
    harness
}

/// A window whose numbers stay as for a scene that nobody has looked at: pictures are quick, and what is compared with them
/// need not be looked at either. `accuracy` tests how they are chosen.
fn app(creation: &eframe::CreationContext<'_>, project: Project) -> App {
    let mut app = App::new(creation, project).expect("the system gives threads");
    app.choose_numbers(false);
    app
}

/// Draws frames until everything is loaded and rendered. The bound is only there so that a lost wake fails.
fn settle(harness: &mut Harness<'_, App>) {
    for _ in 0..6000 {
        harness.run_steps(1);
        if harness.state().is_settled() {
            harness.run_steps(1);
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("never settled: {:?}", harness.state().picture().progress);
}

/// Draws frames until there are these words.
fn wait_for(harness: &mut Harness<'_, App>, words: &str) {
    for _ in 0..6000 {
        harness.run_steps(1);
        if harness.query_by_label_contains(words).is_some() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("never said: {words}");
}

/// Waits until a notice is up.
fn settle_with_notice(harness: &mut Harness<'_, App>) -> String {
    for _ in 0..1000 {
        harness.run_steps(1);
        if let Some(words) = harness.state().notice() {
            return words.to_owned();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("no notice");
}

/// Prints past the test harness, which keeps what a passing test prints to itself.
fn say(words: &str) {
    // Nobody may be reading.
    let _ = writeln!(std::io::stderr(), "{words}");
}

fn set_slider(harness: &mut Harness<'_, App>, label: &str, value: f64) {
    harness
        .get_by_role_and_label(Role::Slider, label)
        .set_value_accesskit(value);
    harness.run_steps(2);
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_files(harness: &mut Harness<'_, App>, paths: &[&Path]) {
    for path in paths {
        harness
            .input_mut()
            .dropped_files
            .push(Arc::new(Dropped(path.to_path_buf())));
    }
    harness.run_steps(1);
}

/// A dense ASCII file of 6 × 6 × 6 values, `edge` at the border and `core` within.
fn write_dense(folder: &Path, name: &str, edge: f64, core: f64) -> PathBuf {
    let within = |i: i32| (1..5).contains(&i);
    let mut text = "6 6 6\n".to_owned();
    for z in 0..6 {
        for y in 0..6 {
            for x in 0..6 {
                let value = if within(x) && within(y) && within(z) {
                    core
                } else {
                    edge
                };
                text.push_str(&value.to_string());
                text.push(' ');
            }
            text.push('\n');
        }
    }
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the temporary folder can be written");
    path
}

fn soot_and_heat(folder: &Path) -> (PathBuf, PathBuf) {
    (
        write_dense(folder, "soot.txt", 0.0, 2e-6),
        write_dense(folder, "temperature.txt", 300.0, 1700.0),
    )
}

#[test]
fn the_built_in_flame_is_shown_and_can_be_seen() {
    let harness = window(Project::default());
    let app = harness.state();
    let brightest = app
        .picture()
        .film()
        .pixels()
        .iter()
        .map(|pixel| pixel.xyz[1])
        .fold(0.0, f32::max);
    assert!(brightest > 0.0);
    assert_eq!(
        app.picture().film().size(),
        app.job().expect("a job").settings.size
    );
    let baked = BakedView::new(&app.view());
    let lit = app
        .picture()
        .film()
        .pixels()
        .iter()
        .filter(|pixel| baked.apply(pixel.xyz)[0] > 0.5)
        .count();
    assert!(lit > 100, "only {lit} pixels are lit");
    harness.get_by_label_contains("built-in torch");
}

#[test]
fn soot_radius_and_its_hold_change_the_job() {
    let mut harness = window_of(Project::default(), [480.0, 480.0]);
    let (job, view) = (
        harness.state().job().cloned().expect("a job"),
        harness.state().view(),
    );
    set_slider(&mut harness, "Soot radius", 40.0);
    let changed = harness.state().job().cloned().expect("a job");
    assert_eq!(changed.flame.soot_radius_nm, 40.0);
    assert_ne!(changed, job);
    assert_eq!(changed.settings, job.settings);

    let other = if changed.flame.soot_hold == Hold::Number {
        "volume"
    } else {
        "number"
    };
    harness.get_by_label(other).click();
    harness.run_steps(2);
    let held = harness.state().job().expect("a job").flame.soot_hold;
    assert_ne!(held, changed.flame.soot_hold);
    settle(&mut harness);
    assert_eq!(harness.state().view(), view, "the metering is kept");
}

#[test]
fn step_size_changes_the_job_and_nothing_else() {
    let mut harness = window(Project::default());
    let job = harness.state().job().cloned().expect("a job");
    set_slider(&mut harness, "Step size", 4.0);
    let changed = harness.state().job().cloned().expect("a job");
    assert_eq!(changed.settings.step_voxels, 4.0);
    assert_eq!(changed.flame, job.flame);
    settle(&mut harness);
}

#[test]
fn exposure_changes_the_view_and_renders_nothing() {
    let mut harness = window(Project::default());
    let (generation, view) = (harness.state().generation(), harness.state().view());
    set_slider(&mut harness, "Exposure", 2.0);
    assert_eq!(harness.state().generation(), generation);
    let brighter = harness.state().view();
    assert!((brighter.exposure / view.exposure - 4.0).abs() < 1e-9);
    assert_eq!(
        View {
            exposure: view.exposure,
            ..brighter
        },
        view
    );

    // The button lies below what is visible of so small a window.
    harness.get_by_label("Auto exposure").click_accesskit();
    harness.run_steps(2);
    assert_eq!(harness.state().generation(), generation);
    let auto = harness.state().view().exposure;
    assert!(
        (auto / view.exposure).log2().abs() < 1.0,
        "{auto}, at first {}",
        view.exposure
    );
    assert_eq!(harness.state().document().project.view.exposure_ev, 0.0);
}

#[test]
fn a_setting_out_of_range_keeps_the_last_picture_and_says_why() {
    let mut project = Project::default();
    project.view.exposure_ev = 0.0;
    let mut harness = window(project);
    let generation = harness.state().generation();
    harness.state_mut().document_mut().project.soot.radius_nm = -1.0;
    harness.run_steps(2);
    assert_eq!(harness.state().generation(), generation);
    harness.get_by_label_contains("soot.radius_nm");
    harness.state_mut().document_mut().project.soot.radius_nm = 30.0;
    harness.run_steps(2);
    assert_ne!(harness.state().generation(), generation);
    assert!(harness.query_by_label_contains("soot.radius_nm").is_none());
}

#[test]
fn a_pair_dropped_together_becomes_one_volume() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let mut harness = window(Project::default());
    drop_files(&mut harness, &[&soot, &heat]);
    settle(&mut harness);
    let job = harness.state().job().expect("a job");
    assert_eq!(job.volume.sources, [soot, heat]);
    assert!(job.flame.maps.soot.is_some() && job.flame.maps.temperature.is_some());
    harness.get_by_label("soot.txt + temperature.txt");
    assert!(harness.get_all_by_label_contains("1700 K").count() == 2);
}

#[test]
fn a_partner_dropped_later_completes_and_a_rival_replaces() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let rival = write_dense(folder.path(), "other_soot.txt", 0.0, 4e-6);
    let mut harness = window(Project::default());
    let sources =
        |harness: &Harness<'_, App>| harness.state().job().expect("a job").volume.sources.clone();

    drop_files(&mut harness, &[&soot]);
    settle(&mut harness);
    assert_eq!(sources(&harness), std::slice::from_ref(&soot));
    drop_files(&mut harness, &[&rival]);
    settle(&mut harness);
    assert_eq!(sources(&harness), std::slice::from_ref(&rival));
    drop_files(&mut harness, &[&heat]);
    settle(&mut harness);
    assert_eq!(sources(&harness), [rival, heat]);
    drop_files(&mut harness, &[&soot]);
    settle(&mut harness);
    assert_eq!(sources(&harness), [soot]);
}

#[test]
fn a_bad_file_leaves_the_scene_and_says_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let bad = folder.path().join("bad.txt");
    std::fs::write(&bad, "3 3 3\n1 2 three\n").expect("the temporary folder can be written");
    let mut harness = window(Project::default());
    let before = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );
    drop_files(&mut harness, &[&bad]);
    let words = settle_with_notice(&mut harness);
    assert!(words.contains("bad.txt"), "{words}");
    settle(&mut harness);
    harness.get_by_label_contains("bad.txt");
    assert_eq!(
        (
            harness.state().generation(),
            harness.state().document().project.clone()
        ),
        before
    );

    harness.get_by_label("Dismiss").click();
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("bad.txt").is_none());
}

#[test]
fn a_missing_first_file_gives_the_built_in_flame_and_words() {
    let mut project = Project::default();
    project.volume.path = vec![PathBuf::from("no/such/file.vdb")];
    let mut harness = window(project);
    let words = settle_with_notice(&mut harness);
    assert!(
        words.contains("no/such/file.vdb") && words.contains("built-in"),
        "{words}"
    );
}

#[test]
fn flaws_are_shown_in_words() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut harness = window(Project::default());
    drop_files(&mut harness, &[&soot]);
    settle(&mut harness);
    let flaws: Vec<String> = harness
        .state()
        .job()
        .expect("a job")
        .flaws
        .iter()
        .map(str::to_owned)
        .collect();
    assert!(
        !flaws.is_empty(),
        "a soot without a temperature is an assumption"
    );
    for flaw in flaws {
        let told = harness.query_all_by_label_contains(&flaw).count();
        assert!(told > 0, "{flaw}");
    }
}

#[test]
fn a_change_can_be_taken_back_and_done_again() {
    let mut harness = window(Project::default());
    let radius =
        |harness: &Harness<'_, App>| harness.state().job().expect("a job").flame.soot_radius_nm;
    let first = radius(&harness);
    set_slider(&mut harness, "Soot radius", 60.0);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(radius(&harness), first);
    harness.key_press_modifiers(
        egui::Modifiers::COMMAND | egui::Modifiers::SHIFT,
        egui::Key::Z,
    );
    harness.run_steps(2);
    assert_eq!(radius(&harness), 60.0);
}
