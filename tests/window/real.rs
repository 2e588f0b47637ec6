//! The real window on a virtual display: a file is dropped on the program itself, by the desktop's own protocol.

use std::process::{Command, Stdio};

use super::{say, write_dense};

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

/// Opens the window, drops the file, and closes the window again, whatever came of it.
const SCRIPT: &str = r#"
"$PROGRAM" & program=$!
"$PYTHON" tests/drop_file.py --until-titled "$TITLE" Sootlight "$FILE" & drop=$!
wait -n $program $drop
dropped=$?
# A program that ends by itself has opened nothing.
kill $drop 2>/dev/null && dropped=1
kill $program 2>/dev/null
wait
exit $dropped
"#;

#[test]
fn a_file_dropped_on_the_real_window_is_opened() {
    for tool in ["xvfb-run", "xauth", "timeout", "bash"] {
        if !is_installed(tool) {
            say(&format!("skipped: {tool} is not installed"));
            return;
        }
    }
    let Some(python) = python_with_xlib() else {
        say("skipped: python3-xlib is not installed");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = write_dense(folder.path(), "dropped_soot.txt", 0.0, 2e-6);
    // The time is only there so that a window that hangs fails; `timeout` ends all that it started.
    let run = Command::new("timeout")
        .args(["--kill-after=5", "120", "xvfb-run", "--auto-servernum"])
        .args(["--server-args=-screen 0 1280x800x24", "bash", "-c", SCRIPT])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("PROGRAM", env!("CARGO_BIN_EXE_sootlight"))
        .env("PYTHON", python)
        .env("TITLE", "Sootlight — dropped_soot.txt")
        .env("FILE", &file)
        .output()
        .expect("the tools can be started");
    let said = [run.stdout, run.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let said = said.join("\n");
    if said.contains("no graphics driver was found") {
        say("skipped: no graphics driver");
        return;
    }
    if said.contains("a library that windows need is missing") {
        say("skipped: a library that windows need is not installed");
        return;
    }
    assert!(run.status.success(), "{}: {said}", run.status);
}
