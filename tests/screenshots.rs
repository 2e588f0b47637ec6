//! The pictures of screenshots/, made by the program:
//!
//! ```text
//! cargo test --release --test main -- --ignored screenshots
//! ```
//!
//! Stills come from the command line, pictures of the window from the real window on a virtual display (`xvfb-run`
//! and ImageMagick's `import`). Those of shared volumes need `SOOTLIGHT_SHARED`. Files are named relative to the
//! shared folder, so that no path of a machine gets into a picture's provenance.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::common;

const PROGRAM: &str = env!("CARGO_BIN_EXE_sootlight");

fn screenshots() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("screenshots")
}

/// Renders a still in the given folder.
fn still(folder: &Path, name: &str, arguments: &[&str]) {
    let output = screenshots().join(name);
    let status = Command::new(PROGRAM)
        .current_dir(folder)
        .args(["render", "--quality", "final", "-o"])
        .arg(&output)
        .args(arguments)
        .status()
        .unwrap();
    assert!(status.success(), "{name}");
}

/// Opens the window on a virtual display and takes its picture after it has come to rest.
fn window(folder: &Path, name: &str, files: &[&str]) {
    let script =
        r#""$0" "${@:2}" & program=$!; sleep 6; import -window root "$1"; kill $program; wait"#;
    let status = Command::new("xvfb-run")
        .current_dir(folder)
        .args([
            "-a",
            "-s",
            "-screen 0 1280x800x24",
            "bash",
            "-c",
            script,
            PROGRAM,
        ])
        .arg(screenshots().join(name))
        .args(files)
        .status()
        .expect("xvfb-run and import (ImageMagick) must be installed");
    // The script ends with the program's own status: killed, after the picture was taken.
    assert!(
        screenshots().join(name).is_file() && status.code().is_some(),
        "{name}"
    );
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_built_in_flame() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    still(here, "torch.png", &["--size", "900x1100"]);
    window(here, "window.png", &[]);
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_shared_volumes() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    for (name, file, size) in [
        ("pool.png", "pool/pool_0022_zip_half.vdb", "700x900"),
        (
            "campfire.png",
            "campfire/campfire_0022_zip_half.vdb",
            "700x900",
        ),
        (
            "embergen.png",
            "embergen_cc0/embergen_fire_a_60.vdb",
            "900x900",
        ),
    ] {
        still(&data, name, &[file, "--size", size]);
    }
    window(&data, "window_pool.png", &["pool/pool_0022_zip_half.vdb"]);
}
