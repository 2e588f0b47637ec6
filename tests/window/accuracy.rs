//! Numbers are chosen for the quality that is wished, and what they are worth is said.

use sootlight::project::Quality;
use sootlight::scene::WavelengthSet;

use super::*;

/// A window that looks at its scene and chooses.
fn choosing(project: Project) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size([1200.0, 1000.0])
        .build_eframe(|creation| App::new(creation, project).expect("the system gives threads"));
    harness.state_mut().document_mut().fixed_size = Some([64, 64]);
    settle(&mut harness);
    harness
}

fn quick() -> Project {
    let mut project = Project::default();
    project.set_all(["effects.scattering=off"]).unwrap();
    project.render.quality = Quality::Draft;
    project
}

#[test]
fn the_numbers_of_a_quality_are_chosen_and_the_error_is_said() {
    let mut harness = choosing(quick());
    let draft = harness.state().job().unwrap().settings;
    // The scene asks for other numbers than one that nobody has looked at.
    let (step, set, rays) = Quality::Draft.numbers();
    let fallback = (step, set, rays);
    assert_ne!(
        (
            draft.step_voxels,
            draft.wavelengths,
            draft.samples_per_pixel
        ),
        fallback
    );
    harness.get_by_label_contains("ΔE (95 %), predicted");

    harness.state_mut().document_mut().project.render.quality = Quality::Look;
    settle(&mut harness);
    let look = harness.state().job().unwrap().settings;
    let finer = |one: f64, other: f64| one <= other;
    assert!(finer(look.step_voxels, draft.step_voxels));
    assert!(look.samples_per_pixel >= draft.samples_per_pixel);
    assert_ne!(look, draft);
}

#[test]
fn a_number_set_by_hand_stays_and_the_others_are_chosen_around_it() {
    let mut project = quick();
    project.render.wavelengths = Some(WavelengthSet::Plain(16));
    let harness = choosing(project);
    let settings = harness.state().job().unwrap().settings;
    assert_eq!(settings.wavelengths, WavelengthSet::Plain(16));
}

#[test]
fn a_cause_that_is_clicked_is_raised_alone() {
    let mut harness = choosing(quick());
    let before = harness.state().job().unwrap().settings;
    harness.get_by_label_contains("edges ").click();
    settle(&mut harness);
    let after = harness.state().job().unwrap().settings;
    assert!(after.samples_per_pixel > before.samples_per_pixel);
    let render = &harness.state().document().project.render;
    assert_eq!(render.samples_per_pixel, Some(after.samples_per_pixel));
    // All else is as it was.
    assert_eq!(render.step_voxels, Some(before.step_voxels));
    assert!(render.wavelengths.is_some());
}

#[test]
fn the_chart_opens_by_its_key_and_measures_in_the_background() {
    let mut harness = choosing(quick());
    harness.key_press(egui::Key::C);
    harness.run_steps(3);
    harness.get_by_label("Error against seconds");
    for _ in 0..6000 {
        harness.run_steps(1);
        if harness.query_by_label_contains("measured").is_some() {
            harness.key_press(egui::Key::C);
            harness.run_steps(3);
            assert!(harness.query_by_label("Error against seconds").is_none());
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("nothing was measured");
}
