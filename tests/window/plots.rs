//! Spectra in the window: of the pixel under the pointer, of fuel and air.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable};
use sootlight::app::App;
use sootlight::project::Project;

use super::{set_slider, settle, wait_for, window_of};

/// A window with room for the plots beside the fire.
const SIZE: [f32; 2] = [1100.0, 720.0];
const PIXEL: &str = "Spectral radiance of the pixel against wavelength";

fn plots() -> Harness<'static, App> {
    let mut harness = window_of(Project::default(), SIZE);
    harness.key_press(Key::S);
    harness.run_steps(3);
    harness
}

/// The place on the screen of a share of the picture.
fn on_picture(harness: &Harness<'_, App>, x: f32, y: f32) -> Pos2 {
    let rect = harness.get_by_role_and_label(Role::Image, "Picture").rect();
    rect.lerp_inside([x, y])
}

fn point_at(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(3);
}

fn click(harness: &mut Harness<'_, App>, at: Pos2) {
    for pressed in [true, false] {
        harness.event(Event::PointerMoved(at));
        harness.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.run_steps(1);
    }
    harness.run_steps(2);
}

fn label_with(harness: &mut Harness<'_, App>, words: &str) -> String {
    wait_for(harness, words);
    let node = harness.get_by_label_contains(words);
    node.accesskit_node()
        .value()
        .or(node.accesskit_node().label())
        .unwrap_or_default()
}

/// The brightest pixel of the film, as shares of its sides, and its luminance.
fn brightest(harness: &Harness<'_, App>) -> ([f32; 2], f64) {
    let film = harness.state().picture().film();
    let pixels = film.pixels();
    let (index, pixel) = pixels
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.xyz[1].total_cmp(&b.1.xyz[1]))
        .unwrap();
    let [width, height] = film.size();
    let share = |at: usize, side: u32| (at as f32 + 0.5) / side as f32;
    let at = [
        share(index % width as usize, width),
        share(index / width as usize, height),
    ];
    (at, 683.0 * f64::from(pixel.xyz[1]))
}

#[test]
fn a_key_or_the_button_opens_and_closes_the_spectra() {
    let mut harness = window_of(Project::default(), SIZE);
    let open = |harness: &Harness<'_, App>| harness.query_by_label("Fuel and air").is_some();
    assert!(!open(&harness));
    harness.key_press(Key::S);
    harness.run_steps(3);
    assert!(open(&harness));
    harness
        .get_by_role_and_label(Role::Button, "Spectrum")
        .click();
    harness.run_steps(3);
    assert!(!open(&harness));
    harness
        .get_by_role_and_label(Role::Button, "Spectrum")
        .click();
    harness.run_steps(3);
    assert!(open(&harness));
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(!open(&harness));
}

#[test]
fn the_histogram_tells_what_is_black_and_what_is_clipped() {
    let mut harness = window_of(Project::default(), SIZE);
    harness.key_press(Key::H);
    harness.run_steps(3);
    let shares = |harness: &Harness<'_, App>| -> Vec<f64> {
        let node = harness.get_by_label_contains("Histogram of the picture");
        let words = node.accesskit_node().label().unwrap();
        let numbers = words.split(|it: char| !it.is_ascii_digit() && it != '.');
        numbers.filter_map(|it| it.parse().ok()).collect()
    };
    let before = shares(&harness);
    // Most around the flame is black, and little of it has lost its colour.
    assert!(before[0] > 20.0 && before[3] < 5.0, "{before:?}");
    harness.state_mut().document_mut().project.view.exposure_ev = 6.0;
    harness.run_steps(3);
    let after = shares(&harness);
    assert!(
        after[1] > before[1] + 10.0 && after[0] <= before[0],
        "{before:?} {after:?}"
    );
    // Marks stay when the histogram goes.
    let marks = |harness: &Harness<'_, App>| {
        let mark = harness.get_by_label("Mark what is clipped");
        mark.accesskit_node().toggled()
    };
    let off = marks(&harness);
    harness
        .get_by_label("Mark what is clipped")
        .click_accesskit();
    harness.run_steps(3);
    assert_ne!(marks(&harness), off);
    harness.key_press(Key::J);
    harness.run_steps(3);
    assert_eq!(marks(&harness), off);
    harness.key_press(Key::H);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("Histogram of").is_none());
    // The spectra have their own key, whatever was on show.
    harness.key_press(Key::S);
    harness.run_steps(3);
    harness.get_by_label("Fuel and air");
    assert!(harness.query_by_label("Histogram of").is_none());
}

#[test]
fn a_plane_through_the_volume_is_cut_where_it_is_wanted() {
    let mut harness = window_of(Project::default(), SIZE);
    harness.key_press(Key::V);
    harness.run_steps(3);
    let plane = harness.get_by_label("Plane of the volume across y").rect();
    harness.get_by_label("Hottest soot of each plane");
    // Where the flame is there is soot, and it is hot.
    let middle = plane.min + plane.size() * egui::vec2(0.5, 0.6);
    point_at(&mut harness, middle);
    let words = label_with(&mut harness, "ppm");
    let kelvin: f64 = words
        .split_once("   ")
        .and_then(|(_, told)| told.split(' ').next()?.parse().ok())
        .unwrap();
    assert!((1000.0..2500.0).contains(&kelvin), "{words}");
    // At the end of the box there is none.
    set_slider(&mut harness, "Place of the plane", 0.0);
    harness.run_steps(2);
    point_at(&mut harness, middle);
    let words = label_with(&mut harness, " m   ");
    assert!(
        words.contains("clear air") || words.contains("soot 0 ppm"),
        "{words}"
    );
    harness.get_by_label("Soot fraction").click_accesskit();
    harness.run_steps(2);
    harness.get_by_label("Mean soot of each plane");
    harness.get_by_label("x").click_accesskit();
    harness.run_steps(2);
    harness.get_by_label("Plane of the volume across x");
}

#[test]
fn the_pixel_under_the_pointer_is_read() {
    let mut harness = plots();
    harness.get_by_label("Point at the picture");
    assert!(harness.query_by_label_contains("cd/m²").is_none());
    let ([x, y], luminance) = brightest(&harness);
    let at = on_picture(&harness, x, y);
    point_at(&mut harness, at);
    harness.get_by_role_and_label(Role::Image, PIXEL);
    let words = label_with(&mut harness, "cd/m²");
    let read: f64 = words.split(' ').next().unwrap().parse().unwrap();
    assert!(
        (read / luminance - 1.0).abs() < 0.02,
        "{words}, film {luminance}"
    );
    assert!(words.contains("as a black body of 1"), "{words}");

    // What the ray has passed stands below.
    for label in ["Temperature along the ray", "Soot along the ray"] {
        harness.get_by_label_contains(label);
    }
    let words = label_with(&mut harness, "optical depth");
    assert!(
        words.contains("hottest soot") && words.contains("m away"),
        "{words}"
    );

    // Beside the fire it is black, and the reading says so.
    let corner = on_picture(&harness, 0.01, 0.01);
    point_at(&mut harness, corner);
    harness.get_by_label_contains("0 cd/m², black");
}

#[test]
fn a_click_keeps_a_pixel_whose_light_follows_the_sliders() {
    let mut harness = plots();
    let ([x, y], luminance) = brightest(&harness);
    let at = on_picture(&harness, x, y);
    click(&mut harness, at);
    let pixel = label_with(&mut harness, "Pixel ");
    let corner = on_picture(&harness, 0.01, 0.01);
    point_at(&mut harness, corner);
    assert_eq!(label_with(&mut harness, "Pixel "), pixel);

    set_slider(&mut harness, "Soot amount", 0.1);
    settle(&mut harness);
    harness.run_steps(2);
    let words = label_with(&mut harness, "cd/m²");
    let read: f64 = words.split(' ').next().unwrap().parse().unwrap();
    assert!(read < 0.5 * luminance, "{words}, before {luminance}");

    harness.get_by_label("Follow the pointer").click();
    harness.run_steps(2);
    point_at(&mut harness, corner);
    assert_ne!(label_with(&mut harness, "Pixel "), pixel);
}

#[test]
fn reading_pixels_renders_nothing_and_is_no_step_of_undo() {
    let mut harness = plots();
    let before = (
        harness.state().generation(),
        harness.state().document().project.clone(),
        harness.state().document().can_undo(),
    );
    for share in [0.3, 0.5, 0.7] {
        let at = on_picture(&harness, share, share);
        click(&mut harness, at);
    }
    let app = harness.state();
    assert_eq!(app.generation(), before.0);
    assert_eq!(app.document().project, before.1);
    assert_eq!(app.document().can_undo(), before.2);
}

#[test]
fn fuel_and_air_are_plotted_at_a_place_that_can_be_chosen() {
    let mut harness = plots();
    harness.get_by_label("Fuel and air").click();
    harness.run_steps(3);
    for chart in [
        "Emission against wavelength",
        "Absorption and scattering against wavelength",
        "Refractive index less one against wavelength",
    ] {
        harness.get_by_role_and_label(Role::Image, chart);
    }
    for curve in ["Absorption", "Scattering"] {
        harness.get_by_label(curve);
    }
    harness.get_by_label("the hottest and densest of this fire");
    set_slider(&mut harness, "Temperature there", 1234.0);
    harness.get_by_label("Logarithmic emission").click();
    harness.run_steps(2);
    // What was chosen is kept while the window is closed.
    for _ in 0..2 {
        harness.key_press(Key::S);
        harness.run_steps(3);
    }
    let slider = harness.get_by_role_and_label(Role::Slider, "Temperature there");
    assert_eq!(slider.accesskit_node().numeric_value(), Some(1234.0));
    harness.get_by_label("Back to the fire's").click();
    harness.run_steps(2);
    harness.get_by_label("the hottest and densest of this fire");

    // Air that holds more water than air says what to change, in place of curves.
    let air = &mut harness.state_mut().document_mut().project.air;
    (air.temperature_k, air.humidity) = (400.0, 1.0);
    harness.run_steps(3);
    // There, and in the picture's own words that its light is not bent.
    assert!(
        harness
            .query_all_by_label_contains("lower the humidity")
            .count()
            > 0
    );
}

#[test]
fn a_small_window_keeps_the_plots_within_reach() {
    let mut harness = window_of(Project::default(), [480.0, 320.0]);
    harness.key_press(Key::S);
    harness.run_steps(3);
    let tab = harness.get_by_label("Fuel and air").rect();
    let window = egui::Rect::from_min_max(pos2(0.0, 0.0), pos2(480.0, 320.0));
    assert!(window.contains_rect(tab), "{tab:?}");
}

#[test]
fn a_pixel_of_a_lit_stage_is_read_once_its_light_is_worked_out() {
    let mut project = Project::default();
    project.stage.ground = true;
    let mut harness = window_of(project, SIZE);
    harness.key_press(Key::S);
    harness.run_steps(3);
    // Below the fire, where nothing but ground is.
    let at = on_picture(&harness, 0.8, 0.97);
    point_at(&mut harness, at);
    let begun = std::time::Instant::now();
    while harness.query_by_label_contains("Pixel ").is_none() {
        assert!(begun.elapsed().as_secs() < 60, "nothing was read");
        std::thread::sleep(std::time::Duration::from_millis(20));
        harness.run_steps(1);
    }
    let words = label_with(&mut harness, "cd/m²");
    let film = harness.state().picture().film();
    let [x, y] =
        [(0.8, 0), (0.97, 1)].map(|(share, axis)| (share * film.size()[axis] as f32) as u32);
    let shown = 683.0 * f64::from(film.pixel(x, y).unwrap().xyz[1]);
    assert!(shown > 0.0);
    let read: f64 = words
        .split_whitespace()
        .find_map(|word| word.replace(',', "").parse().ok())
        .unwrap();
    // The pixel's light is worked out as coarsely as a first pass.
    assert!((read / shown - 1.0).abs() < 0.25, "{words}, {shown}");
}
