//! What is shown when files cannot be opened, complete what is open, or are asked for in a hurry.

use sootlight::render::develop::Metering;

use super::*;

/// A window on which files were dropped before its first volume could be read.
fn window_dropped_on(project: Project, paths: Vec<PathBuf>) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size([480.0, 320.0])
        .build_eframe(|creation| {
            let mut app = app(creation, project);
            app.open(paths);
            app
        });
    settle(&mut harness);
    harness
}

fn write_bad(folder: &Path) -> PathBuf {
    let bad = folder.join("bad.txt");
    std::fs::write(&bad, "3 3 3\n1 2 three\n").expect("the temporary folder can be written");
    bad
}

/// A file that can be read and has nothing in it.
fn empty_grid() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hostile/vdb_emptygrid.vdb")
}

#[test]
fn a_bad_file_dropped_at_once_leaves_the_first_volume_to_come() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot];
    let harness = window_dropped_on(project, vec![write_bad(folder.path())]);
    harness.get_by_label("soot.txt");
    harness.get_by_label_contains("bad.txt");
}

#[test]
fn a_file_of_nothing_dropped_at_once_leaves_the_first_volume_to_come() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot];
    let harness = window_dropped_on(project, vec![empty_grid()]);
    harness.get_by_label("soot.txt");
    harness.get_by_label_contains("nothing to render");
}

#[test]
fn two_bad_files_give_the_built_in_flame() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut project = Project::default();
    project.volume.path = vec![PathBuf::from("no/such/file.vdb")];
    let harness = window_dropped_on(project, vec![write_bad(folder.path())]);
    harness.get_by_label("built-in torch");
    harness.get_by_label_contains("The built-in flame is shown instead");
}

#[test]
fn a_first_load_that_is_cancelled_gives_the_built_in_flame() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot];
    project.volume.voxel_size_m = Some(0.02);
    let mut harness = Harness::builder()
        .with_size([480.0, 320.0])
        .build_eframe(|creation| {
            let mut app = app(creation, project);
            app.cancel_loading();
            app
        });
    settle(&mut harness);
    harness.get_by_label("built-in torch");
    assert_eq!(
        harness.state().document().project.volume,
        Project::default().volume
    );
    assert_eq!(harness.state().notice(), None);
}

#[test]
fn a_cancelled_load_leaves_the_scene_as_it_was() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let mut harness = window(Project::default());
    let before = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );
    harness.state_mut().open(vec![soot]);
    harness.state_mut().open(vec![heat]);
    assert!(!harness.state().is_settled());
    harness.state_mut().cancel_loading();
    // Nothing is loaded any more, without waiting for the threads that read.
    assert!(harness.state().is_settled());
    std::thread::sleep(Duration::from_millis(100));
    settle(&mut harness);
    let after = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );
    assert_eq!(after, before);
    assert_eq!(harness.state().notice(), None);
    harness.get_by_label("built-in torch");
    // Without a load there is nothing to cancel.
    harness.state_mut().cancel_loading();
    assert!(harness.state().is_settled());
}

#[test]
fn a_file_with_nothing_to_render_leaves_the_scene_and_says_why() {
    let mut harness = window(Project::default());
    set_slider(&mut harness, "Soot radius", 60.0);
    settle(&mut harness);
    let before = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );
    drop_files(&mut harness, &[&empty_grid()]);
    let words = settle_with_notice(&mut harness);
    assert!(
        words.contains("vdb_emptygrid.vdb") && words.contains("nothing to render"),
        "{words}"
    );
    settle(&mut harness);
    harness.get_by_label_contains("nothing to render");
    harness.get_by_label("built-in torch");
    let after = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );
    assert_eq!(after, before);
    // Undo is still there.
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_ne!(harness.state().document().project, before.1);
}

#[test]
fn a_partner_keeps_every_setting_and_undo() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, heat) = soot_and_heat(folder.path());
    let mut project = Project::default();
    project.volume.path = vec![soot.clone()];
    project.volume.producer = sootlight::volume::Producer::Physical;
    project.volume.voxel_size_m = Some(0.02);
    project.volume.soot.scale = Some(2.0);
    project.camera.fov_deg = Some(25.0);
    let mut harness = window(project);
    let radius = harness.state().document().project.soot.radius_nm;
    set_slider(&mut harness, "Soot radius", 60.0);
    let mut wanted = harness.state().document().project.clone();

    drop_files(&mut harness, &[&heat]);
    settle(&mut harness);
    wanted.volume.path = vec![soot.clone(), heat];
    assert_eq!(harness.state().document().project, wanted);
    harness.get_by_label("soot.txt + temperature.txt");
    assert!(harness.get_all_by_label_contains("1700 K").count() == 2);

    // The opening is a step of undo, and the changes before it are the ones before.
    let mut undo = || {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(2);
        let document = harness.state().document();
        let files = document.volume().map(|volume| volume.sources.clone());
        (document.project.clone(), files)
    };
    wanted.volume.path = vec![soot];
    assert_eq!(undo(), (wanted.clone(), Some(wanted.volume.path.clone())));
    wanted.soot.radius_nm = radius;
    assert_eq!(undo().0, wanted);
}

#[test]
fn a_file_dropped_by_mistake_can_be_taken_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (soot, _) = soot_and_heat(folder.path());
    let mut harness = window(Project::default());
    set_slider(&mut harness, "Soot radius", 60.0);
    drop_files(&mut harness, &[&soot]);
    settle(&mut harness);
    harness.get_by_label("soot.txt");
    harness.get_by_label("Undo").click();
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("built-in torch");
    let job = harness.state().job().expect("a job");
    assert!(job.volume.sources.is_empty() && job.flame.soot_radius_nm == 60.0);
    harness.get_by_label("Redo").click();
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("soot.txt");
}

#[test]
fn a_black_picture_is_told() {
    let mut harness = window(Project::default());
    assert!(harness.query_by_label_contains("black").is_none());
    harness.state_mut().document_mut().project.soot.amount = 0.0;
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label_contains("the amount of soot is 0");
    harness.get_by_label("Set the soot amount to 1").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("black").is_none());
    assert_eq!(harness.state().document().project.soot.amount, 1.0);

    set_slider(&mut harness, "Exposure", -10.0);
    harness.state_mut().document_mut().project.view.exposure_ev = -20.0;
    harness.run_steps(2);
    harness.get_by_label_contains("black at this exposure");
    harness.get_by_label("Expose it automatically").click();
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("black").is_none());
}

#[test]
fn the_first_full_picture_is_exposed_as_a_still_of_it() {
    let mut harness = window(Project::default());
    let still = |harness: &Harness<'_, App>| {
        let app = harness.state();
        Metering::of(app.picture().film()).view(&app.document().project.view())
    };
    let view = harness.state().view();
    assert_eq!(view, still(&harness));

    // What a slider does is not metered away.
    set_slider(&mut harness, "Soot amount", 3.0);
    settle(&mut harness);
    assert_eq!(harness.state().view(), view);
    assert_ne!(view, still(&harness));
}

/// The names of the grids in memory.
fn read(harness: &Harness<'_, App>) -> Vec<String> {
    let volume = harness.state().document().volume().expect("a volume");
    volume.grids.iter().map(|grid| grid.name.clone()).collect()
}

#[test]
fn a_grid_is_read_once_something_needs_it_and_undo_knows_nothing_of_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.vdb");
    let grids = [
        ("density", 0.4),
        ("fuel", 0.7),
        ("soot", 2e-6),
        ("temperature", 1900.0),
    ];
    crate::common::write_vdb(&path, &grids);
    let mut project = Project::default();
    project.volume.path = vec![path.clone()];
    project.set("effects.smoke=off").expect("a key");
    let mut harness = controls::tall_window(project);
    assert_eq!(read(&harness), ["soot", "temperature"]);
    let before = harness.state().document().metering;

    // An effect comes to need one.
    harness.state_mut().document_mut().change(|document| {
        document.project.set("effects.smoke=auto").expect("a key");
    });
    settle(&mut harness);
    assert_eq!(read(&harness), ["density", "soot", "temperature"]);
    assert!(controls::job(&harness).flame.maps.smoke.is_some());
    assert_eq!(harness.state().document().metering, before);

    // A person chooses another.
    controls::choose(&mut harness, "Soot from", "fuel");
    settle(&mut harness);
    assert_eq!(read(&harness), ["density", "fuel", "soot", "temperature"]);
    let soot = controls::job(&harness).flame.maps.soot.expect("soot");
    assert_eq!(soot.grid, "fuel");

    // What is taken back is what a person did; what was read stays.
    for smoke_is_on in [true, false] {
        harness.state_mut().document_mut().undo();
        settle(&mut harness);
        let job = controls::job(&harness);
        assert_eq!(job.flame.maps.soot.expect("soot").grid, "soot");
        assert_eq!(job.flame.smoke_left_out.is_none(), smoke_is_on);
        assert_eq!(read(&harness).len(), 4);
    }
    assert!(!harness.state().document().can_undo());
}

#[test]
fn a_grid_that_cannot_be_read_any_more_leaves_the_picture_and_says_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.vdb");
    let grids = [("density", 2e-6), ("fuel", 0.7), ("temperature", 1900.0)];
    crate::common::write_vdb(&path, &grids);
    let mut project = Project::default();
    project.volume.path = vec![path.clone()];
    let mut harness = controls::tall_window(project);
    let before = controls::job(&harness);
    std::fs::remove_file(&path).expect("the file was there");
    controls::choose(&mut harness, "Soot from", "fuel");
    let notice = settle_with_notice(&mut harness);
    assert!(notice.contains("fire.vdb"), "{notice}");
    let problem = harness.state().document().problem().expect("a problem");
    assert!(
        problem.contains("\"fuel\", which was not read"),
        "{problem}"
    );
    assert_eq!(controls::job(&harness), before);
    controls::choose(&mut harness, "Soot from", "density");
    settle(&mut harness);
    assert_eq!(harness.state().document().problem(), None);
    // The file is back: asked for again, it is read again.
    crate::common::write_vdb(&path, &grids);
    controls::choose(&mut harness, "Soot from", "fuel");
    settle(&mut harness);
    assert_eq!(harness.state().document().problem(), None);
    assert_eq!(
        controls::job(&harness).flame.maps.soot.expect("soot").grid,
        "fuel"
    );
}
