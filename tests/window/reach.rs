//! Every control has a name, and the keyboard reaches it in the order in which it is read.

use std::collections::BTreeMap;

use egui::Key;
use egui_kittest::kittest::{AccessKitNode, NodeT as _};

use super::*;
use crate::common::write_vdb;

/// What a person acts on.
const CONTROLS: [Role; 8] = [
    Role::Button,
    Role::CheckBox,
    Role::ComboBox,
    Role::RadioButton,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
    Role::Link,
];

/// A frame of a sequence in front of a stage, so that every section and the strip are there.
fn full_window(folder: &Path, size: [f32; 2]) -> Harness<'static, App> {
    for number in 1..=3 {
        let path = folder.join(format!("fire_{number}.vdb"));
        write_vdb(
            &path,
            &[("flame", 1.0), ("temperature", 1.0), ("density", 0.1)],
        );
    }
    let mut project = Project::default();
    project.volume.path = vec![folder.join("fire_1.vdb")];
    project
        .set_all([
            "stage.ground=true",
            "stage.spheres=[[0,0,0,0.1]]",
            "stage.backdrop=checker",
        ])
        .expect("such a stage");
    let mut harness = window_of(project, size);
    harness.state_mut().document_mut().fixed_size = Some([40, 30]);
    settle(&mut harness);
    for _ in 0..1000 {
        harness.run_steps(1);
        if harness.state().frame().is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    harness.run_steps(2);
    settle(&mut harness);
    harness
}

/// Controls that tell nobody what they are.
fn nameless(harness: &Harness<'_, App>) -> Vec<String> {
    let is_nameless = |node: &AccessKitNode<'_>| {
        let told = [node.label(), node.placeholder().map(str::to_owned)];
        CONTROLS.contains(&node.role()) && told.iter().flatten().all(String::is_empty)
    };
    let all = harness.query_all_by(is_nameless);
    all.map(|node| format!("{:?} at {:?}", node.accesskit_node().role(), node.rect()))
        .collect()
}

#[test]
fn every_control_has_a_name() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut harness = full_window(folder.path(), [1280.0, 3600.0]);
    assert_eq!(nameless(&harness), [""; 0], "in the panel");
    // Every window in turn.
    for key in [Key::S, Key::H, Key::V, Key::C, Key::F1] {
        harness.key_press(key);
        harness.run_steps(6);
        settle(&mut harness);
        assert_eq!(nameless(&harness), [""; 0], "with {key:?}");
        harness.key_press(Key::Escape);
        harness.run_steps(4);
    }
    harness.get_by_label("Export…").click();
    harness.run_steps(6);
    assert_eq!(nameless(&harness), [""; 0], "in the export's window");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    for menu in ["Recent", "Settings", "a preset…"] {
        harness.get_by_label(menu).click();
        harness.run_steps(4);
        assert_eq!(nameless(&harness), [""; 0], "in {menu}");
        harness.key_press(Key::Escape);
        harness.run_steps(4);
    }
}

#[test]
fn the_keyboard_reaches_every_control_from_the_top_down() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut harness = full_window(folder.path(), [1280.0, 3600.0]);
    // Beside the picture, whose own controls follow the panel's.
    let panel = harness.get_by_label("Open…").rect().min.x - 20.0;
    let acts = |node: &AccessKitNode<'_>| CONTROLS.contains(&node.role()) && !node.is_disabled();
    // What the newest picture says under the controls moves those below: who they are stays.
    let who = |node: &egui_kittest::Node<'_>| format!("{:?}", node.accesskit_node().id());
    // The line of status goes from one end of the window to the other, below the panel.
    let status = harness.get_by_label("Panel").rect().min.y;
    let in_panel = |node: &egui_kittest::Node<'_>| {
        let rect = node.rect();
        rect.min.x > panel && rect.max.y < status
    };
    let all = harness.query_all_by(acts).filter(in_panel);
    let named = |node: egui_kittest::Node<'_>| (who(&node), node.accesskit_node().label());
    let mut missing: BTreeMap<String, Option<String>> = all.map(named).collect();
    assert!(missing.len() > 60, "{}", missing.len());
    let mut last = f32::NEG_INFINITY;
    let mut backwards = Vec::new();
    for _ in 0..missing.len() + 60 {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        let focused = harness.query_by(|node| node.is_focused() && acts(node));
        let Some(node) = focused.filter(in_panel) else {
            continue;
        };
        // Controls of one row differ by some points in height.
        let is_first = missing.remove(&who(&node)).is_some();
        let row = node.rect().center().y;
        if is_first && row < last - 12.0 {
            backwards.push(node.accesskit_node().label());
        }
        last = if is_first { row } else { last };
    }
    assert!(missing.is_empty(), "not reached: {missing:?}");
    assert_eq!(backwards, [None; 0]);
}
