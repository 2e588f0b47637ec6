//! A disk that is full, and a folder that may not be written to.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

use sootlight::project::Project;

/// Runs the program under a shell that lets no file grow beyond so many blocks of 512 bytes.
fn run(folder: &Path, blocks: u32, words: &str) -> Output {
    // Without its signal the limit is an error like any other, as a full disk is.
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {words}");
    Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_sootlight")])
        .current_dir(folder)
        .output()
        .unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[track_caller]
fn assert_refused(output: &Output, words: &[&str]) {
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    for words in words {
        assert!(error.contains(words), "no {words} in {error}");
    }
}

const SMALL: &str = "render --size 64x64 --quality draft";

#[test]
fn a_full_disk_leaves_the_old_picture_and_no_half_of_the_new() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.exr"] {
        fs::write(folder.path().join(name), "kept").unwrap();
        let output = run(folder.path(), 1, &format!("{SMALL} -o {name}"));
        assert_refused(&output, &[name, "the disk is full; free some space"]);
        assert_eq!(fs::read(folder.path().join(name)).unwrap(), b"kept");
        let new = format!("new_{name}");
        let output = run(folder.path(), 1, &format!("{SMALL} -o {new}"));
        assert_refused(&output, &[&new, "the disk is full"]);
    }
    // Statistics come last, and are as much as the picture is not.
    let output = run(
        folder.path(),
        64,
        &format!("{SMALL} -o b.png --stats s.json"),
    );
    assert!(output.status.success());
    fs::write(folder.path().join("s.json"), "kept").unwrap();
    let output = run(
        folder.path(),
        1,
        &format!("{SMALL} -o c.png --stats s.json"),
    );
    assert_refused(&output, &["the disk is full"]);
    assert_eq!(fs::read(folder.path().join("s.json")).unwrap(), b"kept");
    assert_eq!(names(folder.path()), ["a.exr", "a.png", "b.png", "s.json"]);
    // With room it works as ever.
    let output = run(folder.path(), 4096, &format!("{SMALL} -o a.png"));
    assert!(output.status.success());
    assert!(fs::metadata(folder.path().join("a.png")).unwrap().len() > 1000);
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_without_room_says_so() {
    let folder = tempfile::tempdir().unwrap();
    symlink("/dev/full", folder.path().join("a.png")).unwrap();
    let output = run(folder.path(), 4096, &format!("{SMALL} -o a.png"));
    assert_refused(&output, &["a.png", "the disk is full"]);
    // A scene that cannot be saved leaves the project as it was.
    let project = Project::default();
    let error = project.write(&folder.path().join("a.png")).unwrap_err();
    assert!(error.to_string().contains("a.png"), "{error}");
    assert_eq!(names(folder.path()), ["a.png"]);
}

#[test]
fn a_folder_that_may_not_be_written_to_is_said_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let locked = folder.path().join("locked");
    fs::create_dir(&locked).unwrap();
    fs::write(locked.join("old.png"), "kept").unwrap();
    let set = |mode| {
        let mode = std::os::unix::fs::PermissionsExt::from_mode(mode);
        fs::set_permissions(&locked, mode).unwrap();
    };
    set(0o555);
    // A superuser may write anywhere but where the system itself writes nothing.
    let place = [locked.as_path(), Path::new("/sys")]
        .into_iter()
        .find(|place| fs::File::create(place.join("new.png")).is_err());
    if let Some(place) = place {
        let place = place.display();
        // The volume is not even looked for.
        let output = run(
            folder.path(),
            4096,
            &format!("render no-such.vdb -o {place}/new.png"),
        );
        assert_refused(
            &output,
            &["new.png", "choose a place that you may write to"],
        );
    } else {
        eprintln!("skipped: every folder can be written to");
    }
    set(0o755);
    assert_eq!(fs::read(locked.join("old.png")).unwrap(), b"kept");
    assert!(names(folder.path()) == ["locked"]);
}
