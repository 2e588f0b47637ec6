//! Exporting a still from the window: what is written, what is not, and that the window stays as it is.

use std::io::Cursor;
use std::sync::Arc;

use sootlight::colour::display::BakedView;
use sootlight::export::png::{Bits, SCENE_KEYWORD};
use sootlight::export::{Format, Still};
use sootlight::render::Cancel;
use sootlight::render::develop::{Metering, develop};
use sootlight::scene::WavelengthSet;
use sootlight::study;

use super::*;

/// Opens the window that asks for an export and types a path into it.
pub(super) fn ask_for(harness: &mut Harness<'_, App>, path: &Path) {
    press(harness, "Export…");
    let field = harness.get_by_role_and_label(Role::TextInput, "File");
    field.set_text_value_accesskit(path.to_str().expect("a path of letters"));
    harness.run_steps(2);
}

fn press(harness: &mut Harness<'_, App>, label: &str) {
    control(harness, label).click_accesskit();
    // The click is taken, obeyed, and a window that opens is measured before it is shown.
    harness.run_steps(4);
}

/// What is clicked by this name: there is a window of the name "Export", too.
fn control<'a>(harness: &'a Harness<'_, App>, label: &'a str) -> egui_kittest::Node<'a> {
    harness.get_by(|node| node.role() != Role::Window && node.label().as_deref() == Some(label))
}

fn set_number(harness: &mut Harness<'_, App>, label: &str, value: u32) {
    harness
        .get_by_role_and_label(Role::SpinButton, label)
        .set_value_accesskit(f64::from(value));
    harness.run_steps(2);
}

/// Size, pixels as levels of 8 bits, and the scene of a PNG.
pub(super) fn read_png(path: &Path) -> ([u32; 2], Vec<u8>, Project) {
    let bytes = std::fs::read(path).expect("the picture was written");
    let mut reader = png::Decoder::new(Cursor::new(bytes))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a small picture")];
    reader.next_frame(&mut pixels).expect("a whole PNG");
    let info = reader.info();
    let scene = info
        .utf8_text
        .iter()
        .find(|chunk| chunk.keyword == SCENE_KEYWORD)
        .expect("a scene");
    let scene = scene.get_text().expect("text");
    let project = Project::from_toml(&scene, Path::new("")).expect("a scene file");
    ([info.width, info.height], pixels, project)
}

/// The largest difference in levels, and the mean.
fn difference(a: &[u8], b: &[u8]) -> (u8, f64) {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
    let sum: f64 = differences.clone().map(f64::from).sum();
    (differences.max().unwrap_or(0), sum / a.len() as f64)
}

/// What the window shows, as levels of 8 bits.
fn on_show(app: &App) -> Vec<u8> {
    develop(app.picture().film(), &BakedView::new(&app.view()))
        .into_iter()
        .flatten()
        .map(|value| (255.0 * value).round() as u8)
        .collect()
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("an entry").file_name())
        .map(|name| name.to_string_lossy().into_owned())
        .collect()
}

#[test]
fn as_i_see_it_is_the_picture_on_show() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.png");
    let mut project = Project::default();
    project.render.step_voxels = Some(1.5);
    project.render.samples_per_pixel = Some(2);
    let mut harness = window(project);
    // A fire other than the one that was metered, under another exposure.
    set_slider(&mut harness, "Soot amount", 3.0);
    set_slider(&mut harness, "Exposure", 0.5);
    settle(&mut harness);
    let before = (
        harness.state().generation(),
        harness.state().document().project.clone(),
    );

    ask_for(&mut harness, &path);
    press(&mut harness, "As I see it");
    harness.get_by_label_contains("1.5 voxels, 6 wavelengths, 2 rays");
    press(&mut harness, "Export");
    wait_for(&mut harness, "fire.png written");

    let (size, pixels, scene) = read_png(&path);
    let app = harness.state();
    assert_eq!(size, app.picture().film().size());
    let (most, _) = difference(&pixels, &on_show(app));
    assert!(most <= 1, "{most} levels");
    assert!(
        pixels.iter().any(|&level| level > 128),
        "something is to be seen"
    );
    // Nothing in the window has changed, and the scene is the document's, made explicit.
    let after = (app.generation(), app.document().project.clone());
    assert_eq!(after, before);
    assert_eq!(scene.soot, after.1.soot);
    assert_eq!(scene.render.step_voxels, Some(1.5));
    let seen_from = app.job().expect("a job").camera;
    assert_eq!(
        (scene.camera.eye, scene.camera.fov_deg),
        (Some(seen_from.eye), Some(seen_from.fov_deg))
    );

    // It is there: the next one replaces it, and says so.
    assert!(harness.query_by_label("fire.png exists").is_none());
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    assert!(
        harness.query_by_label("As I see it").is_none(),
        "Esc closes"
    );
    press(&mut harness, "Export…");
    harness.get_by_label("fire.png exists");
    press(&mut harness, "Replace");
    wait_for(&mut harness, "fire.png written");
    assert_eq!(names(&folder), ["fire.png"]);
}

#[test]
fn an_exr_has_the_size_that_was_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut harness = window(Project::default());
    ask_for(&mut harness, &folder.path().join("fire.png"));
    press(&mut harness, "EXR");
    press(&mut harness, "Keep shape");
    set_number(&mut harness, "Width", 60);
    set_number(&mut harness, "Height", 40);
    harness.get_by_label_contains("Wider than in the window");
    press(&mut harness, "As I see it");
    press(&mut harness, "Export");
    wait_for(&mut harness, "fire.exr written, 60 × 40");
    assert_eq!(names(&folder), ["fire.exr"]);

    let image = exr::prelude::read_first_flat_layer_from_file(folder.path().join("fire.exr"))
        .expect("an EXR");
    assert_eq!(image.layer_data.size, exr::prelude::Vec2(60, 40));
    // The light is the fire's own, whatever the exposure: that of the picture on show.
    let brightest = |values: &mut dyn Iterator<Item = f32>| values.fold(0.0, f32::max);
    let channels = &image.layer_data.channel_data.list;
    let y = channels
        .iter()
        .find(|channel| channel.name.eq("xyz.Y"))
        .expect("the layer of XYZ");
    let exported = brightest(&mut y.sample_data.values_as_f32());
    let film = harness.state().picture().film();
    let shown = brightest(&mut film.pixels().iter().map(|pixel| pixel.xyz[1]));
    assert!(
        (exported / shown - 1.0).abs() < 0.1,
        "{exported}, shown {shown}"
    );
}

#[test]
fn final_quality_tells_in_its_file_how_it_is_made() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.png");
    let mut project = Project::default();
    project.render.step_voxels = Some(4.0);
    let mut harness = window(project);
    // Three times the soot is brighter than what was metered: the exposure that is locked is not that of a still.
    set_slider(&mut harness, "Soot amount", 3.0);
    settle(&mut harness);
    let seen = on_show(harness.state());
    ask_for(&mut harness, &path);
    harness.get_by_label_contains("0.5 voxels, 8 wavelengths, 4 rays");
    press(&mut harness, "Export");
    wait_for(&mut harness, "fire.png written");

    let (size, pixels, scene) = read_png(&path);
    let (most, mean) = difference(&pixels, &seen);
    assert!(
        most > 1 && mean < 12.0,
        "another quality, the same brightness: {most}, {mean}"
    );
    let settings = scene.settings(size).expect("settings in their range");
    assert_eq!(
        (
            settings.step_voxels,
            settings.wavelengths,
            settings.samples_per_pixel
        ),
        (0.5, WavelengthSet::Fitted(8), 4)
    );
    assert!(
        scene.view.exposure_ev.abs() > 0.1,
        "{}",
        scene.view.exposure_ev
    );

    // As the command line makes it: measured on the still itself.
    let app = harness.state();
    let volume = Arc::clone(app.document().volume().expect("a volume"));
    let mut still = Still::new(&scene, &volume, None).expect("it was rendered before");
    let again = folder.path().join("again.png");
    let never = Cancel::never();
    let packed = still.scene();
    let (settings, wished) = (still.job.settings, still.job.accuracy);
    let aim = study::aim(
        &packed,
        still.plan(&packed),
        &settings,
        wished,
        None,
        &never,
    );
    still.job.settings = aim.settings;
    let frame = still
        .render_planned(&packed, &aim.plan, &never, &|_| {})
        .expect("nobody cancels");
    let written = still
        .write(&frame, Format::Png(Bits::Eight), &again, &never)
        .expect("the folder can be written");
    let exposure = written.metering.view(&scene.view()).exposure;
    let locked = app.view().exposure;
    assert!(
        (exposure / locked - 1.0).abs() < 1e-9,
        "{exposure}, {locked}"
    );
    let (_, repeated, _) = read_png(&again);
    let (most, mean) = difference(&pixels, &repeated);
    assert!(most <= 3 && mean < 0.5, "{most}, {mean}");
    // The exposure is what makes them alike: without it they are not.
    let own = Metering::of(&frame.film).exposure;
    assert!((own / locked).log2().abs() > 0.1, "{own}, {locked}");
}

#[test]
fn a_cancelled_export_leaves_nothing_and_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut harness = window(Project::default());
    ask_for(&mut harness, &folder.path().join("fire.png"));
    press(&mut harness, "3840 × 2160");
    press(&mut harness, "Export");
    wait_for(&mut harness, " left");
    // The window follows its controls meanwhile, and says how far the export is when nobody asks.
    press(&mut harness, "Close");
    harness.get_by_label_contains("fire.png ");
    set_slider(&mut harness, "Step size", 4.0);
    assert_eq!(
        harness.state().job().expect("a job").settings.step_voxels,
        4.0
    );
    press(&mut harness, "Export…");
    press(&mut harness, "Cancel");
    wait_for(&mut harness, "nothing was written");
    assert!(names(&folder).is_empty());
    settle(&mut harness);
}

#[test]
fn what_cannot_be_written_says_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = folder.path().join("missing/fire.png");
    let mut harness = window(Project::default());
    ask_for(&mut harness, &missing);
    press(&mut harness, "As I see it");
    press(&mut harness, "Export");
    wait_for(&mut harness, "folder does not exist");
    assert!(names(&folder).is_empty());
    let generation = harness.state().generation();

    // A name of no format, and a picture too large for memory, cannot even be asked for.
    for (name, words) in [
        ("fire.jpg", "must end with .png or .exr"),
        ("", "must end with .png or .exr"),
    ] {
        ask_for(&mut harness, Path::new(name));
        harness.get_by_label_contains(words);
        press(&mut harness, "Export");
        assert!(harness.query_by_label_contains("written").is_none());
    }
    ask_for(&mut harness, &folder.path().join("fire.png"));
    press(&mut harness, "Keep shape");
    set_number(&mut harness, "Width", 16384);
    set_number(&mut harness, "Height", 16384);
    harness.get_by_label_contains("the picture is 16384 × 16384 pixels");
    press(&mut harness, "Export");
    assert!(names(&folder).is_empty());

    // After all that it works.
    press(&mut harness, "As in the window");
    press(&mut harness, "Export");
    wait_for(&mut harness, "fire.png written");
    assert_eq!(harness.state().generation(), generation);
}

#[test]
fn edits_during_an_export_do_not_change_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.png");
    let mut harness = window(Project::default());
    let (seen, before) = (
        on_show(harness.state()),
        harness.state().document().project.clone(),
    );
    ask_for(&mut harness, &path);
    press(&mut harness, "As I see it");
    // Pressed and edited between two frames: the export has not begun to render.
    control(&harness, "Export").click_accesskit();
    harness.run_steps(1);
    harness.state_mut().document_mut().project.soot.amount = 0.1;
    harness.state_mut().document_mut().project.view.exposure_ev = -3.0;
    harness.state_mut().document_mut().project.camera.fov_deg = Some(90.0);
    harness.run_steps(1);
    wait_for(&mut harness, "fire.png written");
    let (_, pixels, scene) = read_png(&path);
    assert!(difference(&pixels, &seen).0 <= 1);
    assert_eq!(scene.soot, before.soot);
    settle(&mut harness);
}

#[test]
fn the_keyboard_opens_it_and_a_small_window_holds_it() {
    let mut harness = Harness::builder()
        .with_size([640.0, 400.0])
        .build_eframe(|creation| app(creation, Project::default()));
    settle(&mut harness);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::E);
    harness.run_steps(3);
    let inside = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(640.0, 400.0));
    for label in ["Choose…", "EXR", "Keep shape", "Close", "3840 × 2160"] {
        let rect = harness.get_by_label(label).rect();
        assert!(inside.contains_rect(rect), "{label} is at {rect:?}");
    }
    let name = harness.get_by_role_and_label(Role::TextInput, "File");
    assert_eq!(name.value().as_deref(), Some("torch.png"));
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Choose…").is_none());
}

/// Asks the window to close, as its frame's button does; whether it does close.
pub(super) fn ask_to_close(harness: &mut Harness<'_, App>) -> bool {
    let root = egui::ViewportId::ROOT;
    let viewport = harness.input_mut().viewports.entry(root).or_default();
    viewport.events.push(egui::ViewportEvent::Close);
    harness.run_steps(1);
    let commands = &harness.output().viewport_output[&root].commands;
    let closes = !commands.contains(&egui::ViewportCommand::CancelClose);
    // It was asked once, and not again in every frame from here on.
    let viewport = harness.input_mut().viewports.entry(root).or_default();
    viewport.events.clear();
    closes
}

#[test]
fn a_window_that_exports_asks_before_it_closes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("fire.png");
    let mut harness = window(Project::default());
    assert!(ask_to_close(&mut harness), "nothing holds it");
    ask_for(&mut harness, &path);
    set_number(&mut harness, "Width", 4000);
    press(&mut harness, "Export");
    assert!(!ask_to_close(&mut harness));
    harness.run_steps(3);
    harness.get_by_label_contains("An export is running");

    press(&mut harness, "Go on working");
    assert!(
        harness
            .query_by_label_contains("An export is running")
            .is_none()
    );
    assert!(!ask_to_close(&mut harness));
    harness.run_steps(3);
    press(&mut harness, "Stop it and close");
    assert!(
        ask_to_close(&mut harness),
        "it was told to close, whatever runs"
    );
}
