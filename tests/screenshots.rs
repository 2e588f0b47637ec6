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

use sootlight::project::{PRESETS, THUMBNAIL};

use super::common;

const PROGRAM: &str = env!("CARGO_BIN_EXE_sootlight");

fn screenshots() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("screenshots")
}

/// Where a picture goes, with the old one out of the way: what is there afterwards was made now.
fn cleared(name: &str) -> PathBuf {
    let output = screenshots().join(name);
    match std::fs::remove_file(&output) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => panic!("{name}: {error}"),
        _ => output,
    }
}

/// Renders a still in the given folder.
fn still(folder: &Path, name: &str, arguments: &[&str]) {
    still_at(folder, &cleared(name), arguments);
}

fn still_at(folder: &Path, output: &Path, arguments: &[&str]) {
    let status = Command::new(PROGRAM)
        .current_dir(folder)
        .args(["render", "--quality", "final", "-o"])
        .arg(output)
        .args(arguments)
        .status()
        .unwrap();
    assert!(status.success() && output.is_file(), "{}", output.display());
}

/// Opens the window on a virtual display and takes its picture after it has come to rest.
fn window(folder: &Path, name: &str, files: &[&str]) {
    window_after(folder, name, files, "true");
}

/// [`window`], after hands did something to it.
fn window_after(folder: &Path, name: &str, files: &[&str], hands: &str) {
    // The script succeeds if the picture was taken and the program was there to be seen.
    let script = format!(
        r#""$0" "${{@:2}}" & program=$!; sleep 45; {hands}; import -window root "$1"; taken=$?
        kill $program || exit 1; wait; exit $taken"#
    );
    let output = cleared(name);
    let memory = tempfile::tempdir().expect("a temporary folder");
    let status = Command::new("xvfb-run")
        .current_dir(folder)
        // What a person's own windows remember is left alone.
        .env("XDG_DATA_HOME", memory.path())
        .args([
            "-a",
            "-s",
            "-screen 0 1280x800x24",
            "bash",
            "-c",
            &script,
            PROGRAM,
        ])
        .arg(&output)
        .args(files)
        .status()
        .expect("xvfb-run and import (ImageMagick) must be installed");
    assert!(status.success() && output.is_file(), "{name}");
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_built_in_flame() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    still(here, "torch.png", &["--size", "900x1100"]);
    window(here, "window.png", &[]);
    // Down to the list of effects.
    let hands = "xdotool mousemove 1100 500; for i in $(seq 16); do xdotool click 5; sleep 0.05; done; sleep 2";
    window_after(here, "window_effects.png", &[], hands);
    let set = ["--set", "view.false_colour=true"];
    window(here, "window_false_colour.png", &set);
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_presets() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for preset in PRESETS.iter().filter(|preset| preset.name != "torch") {
        let name = format!("{}.png", preset.name.replace('-', "_"));
        still(here, &name, &["--preset", preset.name, "--size", "600x900"]);
    }
    // Their pictures in the menu.
    let presets = here.join("assets/scenes/presets");
    let [width, height] = THUMBNAIL;
    let size = format!("{width}x{height}");
    for preset in PRESETS {
        let arguments = ["--preset", preset.name, "--size", &size];
        still_at(
            here,
            &presets.join(format!("{}.png", preset.name)),
            &arguments,
        );
    }
    // The spectrum of the blue cone, under the pointer.
    let hands = "xdotool search --name Sootlight windowfocus; sleep 0.3; xdotool key s; sleep 0.5; \
                 xdotool mousemove 455 600; sleep 2";
    let gas_burner = ["--preset", "gas-burner"];
    window_after(here, "window_spectrum.png", &gas_burner, hands);
}

/// A still with an effect on and off.
fn stills_of(folder: &Path, names: [&str; 2], switch: &str, arguments: &[&str]) {
    for (name, state) in names.into_iter().zip(["off", "on"]) {
        let set = format!("{switch}={state}");
        still(folder, name, &[arguments, &["--set", &set]].concat());
    }
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_stage() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = ["--scene", "assets/scenes/crossed_logs.toml"];
    let names = ["fire_light_off.png", "crossed_logs.png"];
    stills_of(here, names, "effects.fire_light", &scene);
    // Down to the controls of the stage.
    let hands = "xdotool mousemove 1100 500; for i in $(seq 13); do xdotool click 5; sleep 0.05; done; sleep 8";
    window_after(here, "window_stage.png", &scene, hands);
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_scattered_and_bent_light() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    let smoky = [
        "campfire/campfire_0022_zip_half.vdb",
        "--size",
        "560x700",
        "--set",
        "smoke.amount=2",
        "--set",
        "smoke.albedo=0.5",
        "--set",
        "view.exposure_ev=1",
    ];
    let names = ["scattering_off.png", "scattering_on.png"];
    stills_of(&data, names, "effects.scattering", &smoky);
    let hot = [
        "pool/pool_0022_zip_half.vdb",
        "--size",
        "560x700",
        "--set",
        "stage.backdrop=checker",
        "--set",
        "stage.backdrop_distance_m=8",
        "--set",
        "stage.backdrop_luminance_cd_m2=6000",
    ];
    let names = ["refraction_off.png", "refraction_on.png"];
    stills_of(&data, names, "effects.refraction", &hot);
    let exaggerated = [&hot[..], &["--set", "air.refraction_gain=8"]].concat();
    still(&data, "refraction_8_times.png", &exaggerated);
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
    let pool = ["pool/pool_0022_zip_half.vdb"];
    let embergen = ["embergen_cc0/embergen_fire_a_60.vdb"];
    window(&data, "window_pool.png", &pool);
    window(&data, "window_embergen.png", &embergen);
    window_after(&data, "window_histogram.png", &pool, &press("h"));
    window_after(&data, "window_volume.png", &embergen, &press("v"));
}

/// Hands that press some keys.
fn press(keys: &str) -> String {
    format!("xdotool search --name Sootlight windowfocus; sleep 0.3; xdotool key {keys}; sleep 2")
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_the_windows() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    let fire = "embergen_cc0/embergen_fire_a_60.vdb";
    // The window tells where a picture goes: nothing but its name, from the topmost folder.
    let whole = data.join(fire);
    let whole = whole.to_str().expect("a path of letters");
    window_after(
        Path::new("/"),
        "window_export.png",
        &[whole],
        &press("ctrl+e"),
    );
    window_after(&data, "window_light.png", &[fire], &press("F2"));
    window_after(&data, "window_keys.png", &[fire], &press("F1"));
    let bright = [fire, "--set", "view.exposure_ev=2.5"];
    window_after(&data, "window_clipped.png", &bright, &press("h j"));
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_a_sequence() {
    let Some(shared) = common::shared() else {
        return;
    };
    // Two steps on, and the first and the last frame that play.
    let hands = "xdotool search --name Sootlight windowfocus; sleep 0.3; xdotool key period; sleep 2; \
                 xdotool key period; sleep 20";
    let frame = ["panfire_seq/panfire_0006.vdb"];
    window_after(&shared.join("data"), "window_sequence.png", &frame, hands);
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_what_accuracy_costs() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    for (name, file) in [
        ("plume", "plume/plume.vdb"),
        ("pool", "pool/pool_0022_zip_half.vdb"),
        ("embergen", "embergen_cc0/embergen_fire_a_60.vdb"),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let status = Command::new(PROGRAM)
            .current_dir(&data)
            .args(["study", file, "--size", "480x270", "-o"])
            .arg(folder.path())
            .status()
            .unwrap();
        assert!(status.success(), "{name}");
        for ending in ["png", "svg", "csv"] {
            let output = cleared(&format!("accuracy_{name}.{ending}"));
            std::fs::copy(folder.path().join(format!("accuracy.{ending}")), output).unwrap();
        }
    }
    // The chart, once some of it was measured.
    let focus = "xdotool search --name Sootlight windowfocus; sleep 0.3";
    let hands = format!("{focus}; xdotool key c; sleep 60");
    window_after(&data, "window_accuracy.png", &["plume/plume.vdb"], &hands);
}

#[test]
#[ignore = "writes screenshots/, by the command at the top of this file"]
fn of_maps_and_snapshots() {
    let Some(shared) = common::shared() else {
        return;
    };
    let data = shared.join("data");
    let focus = "xdotool search --name Sootlight windowfocus; sleep 0.3";
    let fire = ["embergen_cc0/embergen_fire_a_60.vdb"];
    window_after(&data, "window_cost.png", &fire, &press("k"));
    // Minutes, until much of the reference is there.
    let hands = format!("{focus}; xdotool key e; sleep 240");
    window_after(&data, "window_error.png", &fire, &hands);
    // The same fire from another side.
    let hands = format!("{focus}; xdotool key g; xdotool key w; xdotool key 3; sleep 25");
    let fire = ["pool/pool_0022_zip_half.vdb"];
    window_after(&data, "window_compare.png", &fire, &hands);
}
