//! Three tasks of an artist, from the open window to what was wanted, with every click and key counted:
//!
//! ```sh
//! cargo test --release --test main window::tasks -- --nocapture
//! ```

use super::*;
use crate::common::{shared, write_vdb};

/// A hand that counts what it does.
struct Hand {
    harness: Harness<'static, App>,
    clicks: usize,
    /// Fields that were typed into, and characters that were typed.
    typed: [usize; 2],
}

impl Hand {
    /// Begins at a window on the built-in flame, as wide as a notebook's and as tall as its panel.
    fn new() -> Self {
        let mut harness = window_of(Project::default(), [900.0, 3600.0]);
        harness.state_mut().document_mut().fixed_size = Some([60, 40]);
        settle(&mut harness);
        Self {
            harness,
            clicks: 0,
            typed: [0; 2],
        }
    }

    /// Lets a file go over the window: one move.
    fn drop(&mut self, path: &Path) {
        drop_files(&mut self.harness, &[path]);
        self.harness.run_steps(2);
        settle(&mut self.harness);
        self.clicks += 1;
    }

    fn click(&mut self, label: &str) {
        // The chosen one of a menu is also its title; and there is a window of the name "Export".
        let all = self.harness.get_all_by(|node| {
            node.role() != Role::Window && node.label().as_deref() == Some(label)
        });
        let all: Vec<_> = all.collect();
        all.last().expect("there is such a control").click();
        self.harness.run_steps(4);
        self.clicks += 1;
    }

    /// A click into a field, the text, and Enter.
    fn type_into(&mut self, role: Role, label: &str, text: &str) {
        self.harness.get_by_role_and_label(role, label).click();
        self.harness.run_steps(3);
        if role == Role::TextInput {
            let all = (egui::Modifiers::COMMAND, egui::Key::A);
            self.harness.key_press_modifiers(all.0, all.1);
            self.harness.run_steps(1);
        }
        let typed = egui::Event::Text(text.to_owned());
        self.harness.input_mut().events.push(typed);
        self.harness.run_steps(1);
        self.harness.key_press(egui::Key::Enter);
        self.harness.run_steps(3);
        self.clicks += 1;
        self.typed[0] += 1;
        self.typed[1] += text.len() + 1;
    }

    /// Says what it took, which is at most so many clicks.
    fn told(&self, task: &str, most: usize) {
        let [fields, characters] = self.typed;
        say(&format!(
            "{task}: {} clicks or drops, {fields} fields typed into with {characters} keys",
            self.clicks
        ));
        assert!(self.clicks <= most, "{task} takes {} clicks", self.clicks);
    }
}

#[test]
fn the_temperature_that_a_producer_tells_is_matched() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = folder.path().join("fire.vdb");
    write_vdb(&made, &[("flames", 1.0), ("temperature", 3.7)]);
    let real = shared().map(|shared| shared.join("data/embergen_cc0/embergen_fire_a_60.vdb"));
    for path in std::iter::once(made).chain(real) {
        let mut hand = Hand::new();
        hand.drop(&path);
        // What EmberGen shows as the hottest place of this fire, say.
        hand.type_into(Role::SpinButton, "Hottest", "1650");
        settle(&mut hand.harness);
        let job = hand.harness.state().job().expect("a job");
        let map = job.flame.maps.temperature.as_ref().expect("heat");
        let (_, peak) = job.volume.grid(&map.grid).expect("its grid").range();
        let kelvin = map.apply(f64::from(peak));
        assert!((kelvin - 1650.0).abs() < 1e-6, "{kelvin}");
        hand.told("match the producer's temperature", 2);
    }
}

#[test]
fn a_copper_green_burner_becomes_a_still_of_1080p() {
    let output = tempfile::tempdir().expect("a temporary folder");
    let path = output.path().join("green.png");
    let mut hand = Hand::new();
    hand.click("a preset…");
    hand.click("Copper green");
    settle(&mut hand.harness);
    hand.click("Export…");
    let name = path.to_str().expect("a path of letters");
    hand.type_into(Role::TextInput, "File", name);
    hand.click("1920 × 1080");
    // What a person would wait for: at the window's numbers this test does not.
    hand.click("As I see it");
    hand.click("Export");
    wait_for(&mut hand.harness, "written, 1920 × 1080");
    let (size, pixels, _) = export::read_png(&path);
    assert_eq!(size, [1920, 1080]);
    let sum = |c: usize| {
        pixels
            .iter()
            .skip(c)
            .step_by(3)
            .map(|&it| u64::from(it))
            .sum::<u64>()
    };
    assert!(sum(1) > sum(0) && sum(1) > sum(2), "it is not green");
    hand.told("make a copper-green burner still at 1080p", 7);
}

#[test]
fn frames_3_to_9_become_exrs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = || {
        for number in 1..=12_u8 {
            let path = folder.path().join(format!("fire_{number:04}.vdb"));
            write_vdb(
                &path,
                &[
                    ("flame", 1.0),
                    ("temperature", 1.0 + 0.01 * f32::from(number)),
                ],
            );
        }
        folder.path().join("fire_0001.vdb")
    };
    let real = shared().map(|shared| shared.join("data/panfire_seq/panfire_0001.vdb"));
    let output = tempfile::tempdir().expect("a temporary folder");
    let mut hand = Hand::new();
    hand.drop(&real.unwrap_or_else(made));
    for _ in 0..1000 {
        hand.harness.run_steps(1);
        if hand.harness.state().frame().is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    hand.harness.run_steps(2);
    hand.type_into(Role::SpinButton, "In", "3");
    hand.type_into(Role::SpinButton, "Out", "9");
    settle(&mut hand.harness);
    hand.click("Export…");
    let path = output.path().join("fire.exr");
    hand.type_into(
        Role::TextInput,
        "File",
        path.to_str().expect("a path of letters"),
    );
    // Small and coarse, so that this test is quick: no part of the task.
    for (label, side) in [("Width", 48.0), ("Height", 32.0)] {
        let field = hand.harness.get_by_role_and_label(Role::SpinButton, label);
        field.set_value_accesskit(side);
        hand.harness.run_steps(2);
    }
    hand.click("Export range");
    wait_for(&mut hand.harness, "pictures written");
    for number in 1..=12 {
        let is_there = output.path().join(format!("fire_{number:04}.exr")).exists();
        assert_eq!(is_there, (3..=9).contains(&number), "{number}");
    }
    hand.told("export frames 3 to 9 as EXR", 6);
}
