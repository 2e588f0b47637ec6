//! The real window on a virtual display, with the hands of the desktop: a file is dropped on the program by the
//! desktop's own protocol, a slider is dragged, a still is exported and looked at.
//!
//! Where the controls lie is asked of the same window without a display: it is laid out by the same code.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use egui::accesskit::Role;
use sootlight::project::Project;

use super::export::read_png;
use super::{App, Harness, Queryable, say, settle, window_of, write_dense};

/// Size of the screen and of the window that fills it.
const SCREEN: [f32; 2] = [1280.0, 800.0];

/// A python that knows X11: the first one found may be a person's own, without the system's packages.
fn python_with_xlib() -> Option<&'static str> {
    ["python3", "/usr/bin/python3"].into_iter().find(|python| {
        let import = Command::new(python)
            .args(["-c", "import Xlib"])
            .stderr(Stdio::null())
            .status();
        import.is_ok_and(|status| status.success())
    })
}

fn is_installed(tool: &str) -> bool {
    let status = Command::new(tool)
        .arg("--help")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok()
}

/// Opens the window, drops the file, does what `$HANDS` says, and closes the window again, whatever came of it.
const SCRIPT: &str = r#"
# In a folder of its own: what it writes by mistake is not left lying about.
mkdir "$XDG_DATA_HOME/elsewhere"
(cd "$XDG_DATA_HOME/elsewhere" && exec "$PROGRAM") & program=$!
"$PYTHON" tests/drop_file.py --until-titled "$TITLE" Sootlight "$FILE" & drop=$!
wait -n $program $drop
dropped=$?
# A program that ends by itself has opened nothing.
kill $drop 2>/dev/null && dropped=1
if [ $dropped = 0 ]; then bash -ec "$HANDS"; dropped=$?; fi
kill $program 2>/dev/null
wait
exit $dropped
"#;

/// Runs the program on a virtual display; `None`, and the reason is said, where the tools are not there.
fn run(file: &Path, title: &str, hands: &str, folder: &Path) -> Option<Output> {
    for tool in ["xvfb-run", "xauth", "timeout", "bash", "xdotool"] {
        if !is_installed(tool) {
            say(&format!("skipped: {tool} is not installed"));
            return None;
        }
    }
    let Some(python) = python_with_xlib() else {
        say("skipped: python3-xlib is not installed");
        return None;
    };
    // The time is only there so that a window that hangs fails; `timeout` ends all that it started.
    let screen = format!("--server-args=-screen 0 {}x{}x24", SCREEN[0], SCREEN[1]);
    let run = Command::new("timeout")
        .args(["--kill-after=5", "180", "xvfb-run", "--auto-servernum"])
        .args([screen.as_str(), "bash", "-c", SCRIPT])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        // What the window remembers is neither read from a person's own nor left there.
        .env("XDG_DATA_HOME", folder)
        .env("PROGRAM", env!("CARGO_BIN_EXE_sootlight"))
        .env("PYTHON", python)
        .env("TITLE", title)
        .env("FILE", file)
        .env("HANDS", hands)
        .output()
        .expect("the tools can be started");
    let said = [&run.stdout, &run.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    let said = said.join("\n");
    if said.contains("no graphics driver was found") {
        say("skipped: no graphics driver");
        return None;
    }
    if said.contains("a library that windows need is missing") {
        say("skipped: a library that windows need is not installed");
        return None;
    }
    assert!(run.status.success(), "{}: {said}", run.status);
    Some(run)
}

/// The middle of a control, in pixels of the screen.
fn middle(harness: &Harness<'_, App>, role: Role, label: &str) -> [i32; 2] {
    let at = harness.get_by_role_and_label(role, label).rect().center();
    [at.x, at.y].map(|v| v.round() as i32)
}

#[test]
fn a_dropped_fire_is_changed_by_a_slider_and_exported() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = write_dense(folder.path(), "dropped_soot.txt", 0.0, 2e-6);
    let target = folder.path().join("exported.png");

    // The same window, to know where things are.
    let mut project = Project::default();
    project.volume.path = vec![file.clone()];
    let mut harness = window_of(project, SCREEN);
    settle(&mut harness);
    harness.run_steps(4);
    let slider = middle(&harness, Role::Slider, "Soot amount");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::E);
    harness.run_steps(4);
    let path = middle(&harness, Role::TextInput, "File");
    let export = middle(&harness, Role::Button, "Export");
    drop(harness);

    let [x, y] = slider;
    let to = x + 30;
    // Each step gets a frame of its own: a hand is slower than this.
    let hands = format!(
        r#"
        step() {{ xdotool "$@"; sleep 0.6; }}
        xdotool search --name Sootlight windowfocus
        # What was opened is rendered and looked at first: a busy machine without a graphics card draws few frames then.
        sleep 4
        step mousemove {x} {y}
        step mousedown 1
        step mousemove $(({x} + 15)) {y}
        step mousemove {to} {y}
        step mouseup 1
        step key ctrl+e
        # The window of the export finds its size and its place in some frames, which a busy machine draws slowly.
        sleep 3
        step mousemove {} {}
        step click 1
        step key ctrl+a
        step type --delay 5 {}
        step key Return
        step mousemove {} {}
        step click 1
        for i in $(seq 400); do [ -s {} ] && exit 0; sleep 0.1; done
        exit 1"#,
        path[0],
        path[1],
        target.display(),
        export[0],
        export[1],
        target.display(),
    );
    let title = "Sootlight — dropped_soot.txt";
    if run(&file, title, &hands, folder.path()).is_none() {
        return;
    }

    let (_, levels, made) = read_png(&target);
    let amount = made.soot.amount;
    assert!(amount > 2.0, "the slider was not dragged: {amount}");
    assert_eq!(made.volume.path, [file]);
    let lit = levels.iter().filter(|&&level| level > 100).count();
    assert!(lit > 1000, "only {lit} levels are lit");
}
