//! Where pictures and statistics go, and what must never be lost on the way.

use std::fs;

use super::SMALL;
use super::place::{Place, read_png};

#[test]
fn a_second_picture_replaces_the_first_whole_and_a_failure_leaves_it() {
    let place = Place::new();
    place.expect(0, &format!("{SMALL} -o a.png --bits 16"));
    let first = fs::read(place.path("a.png")).unwrap();
    place.expect(
        0,
        "render density.txt temperature.txt --size 16x9 -o a.png --quality draft",
    );
    let second = fs::read(place.path("a.png")).unwrap();
    assert!(second.len() < first.len());
    let (_, info, _) = read_png(&place.path("a.png"));
    assert_eq!((info.width, info.height), (16, 9));
    // Nothing of the longer file is left behind the shorter one.
    assert!(second.ends_with(b"IEND\xaeB`\x82"));

    fs::write(place.path("bad.txt"), "4 4 4\n1 2 three\n").unwrap();
    for words in ["render bad.txt -o a.png", "render no-such.vdb -o a.png"] {
        place.expect(1, words);
        assert_eq!(fs::read(place.path("a.png")).unwrap(), second, "{words}");
    }
}

#[test]
fn one_file_is_not_asked_to_hold_two_things() {
    let place = Place::new();
    fs::create_dir(place.path("folder")).unwrap();
    fs::write(place.path("s.toml"), "soot.amount = 2\n").unwrap();
    let flame = place.text("density.txt");
    let absolute = place.path("a.png").display().to_string();
    for stats in ["a.png", "./a.png", "folder/../a.png", &absolute] {
        let [_, error] = place.expect(2, &format!("{SMALL} -o a.png --stats {stats}"));
        assert!(
            error.contains("--stats") && error.contains("a.png"),
            "{error}"
        );
    }
    // What is read is not written over, either.
    for (input, stats) in [
        ("", "./density.txt"),
        ("--scene s.toml", "folder/../s.toml"),
    ] {
        let [_, error] = place.expect(2, &format!("{SMALL} {input} -o a.png --stats {stats}"));
        assert!(error.contains(stats), "{error}");
    }
    assert_eq!(place.text("density.txt"), flame);
    assert!(!place.path("a.png").exists());
}

#[test]
fn a_picture_is_not_written_over_its_own_volume() {
    let place = Place::new();
    fs::copy(place.path("density.txt"), place.path("density.png")).unwrap();
    let words = "render density.png temperature.txt --size 16x9 -o ./density.png";
    let [_, error] = place.expect(1, words);
    assert!(error.contains("that the picture is made from"), "{error}");
    assert_eq!(place.text("density.png"), place.text("density.txt"));
}

#[test]
fn what_cannot_be_written_is_said_before_anything_is_read() {
    let place = Place::new();
    for name in ["locked.png", "locked.json"] {
        fs::write(place.path(name), "kept").unwrap();
        let mut permissions = fs::metadata(place.path(name)).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(place.path(name), permissions).unwrap();
    }
    for (outputs, name) in [
        ("-o locked.png", "locked.png"),
        ("-o a.png --stats locked.json", "locked.json"),
    ] {
        let [_, error] = place.expect(1, &format!("render no-such.vdb {outputs}"));
        assert!(error.contains(name), "{error}");
        assert!(error.contains("read-only"), "{error}");
        assert_eq!(place.text(name), "kept");
    }
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_even_to_where_nothing_is_yet() {
    use std::os::unix::fs::symlink;
    let place = Place::new();
    fs::create_dir(place.path("pictures")).unwrap();
    symlink("b.png", place.path("pictures/a.png")).unwrap();
    symlink("pictures/a.png", place.path("link.png")).unwrap();
    for _ in 0..2 {
        place.expect(0, &format!("{SMALL} -o link.png"));
        assert!(place.path("link.png").is_symlink());
        assert!(place.path("pictures/a.png").is_symlink());
        assert_eq!(read_png(&place.path("pictures/b.png")).1.width, 40);
    }
    let [_, error] = place.expect(2, &format!("{SMALL} -o link.png --stats pictures/b.png"));
    assert!(error.contains("--stats"), "{error}");

    // The check before the render follows the link, too.
    symlink("missing/a.png", place.path("lost.png")).unwrap();
    symlink("ring.png", place.path("ring.png")).unwrap();
    for name in ["lost.png", "ring.png"] {
        let [_, error] = place.expect(1, &format!("render no-such.vdb -o {name}"));
        assert!(error.contains(name), "{error}");
        assert!(place.path(name).is_symlink());
    }
}

#[test]
fn a_shared_picture_does_not_tell_where_it_was_made() {
    let place = Place::new();
    let [density, temperature] =
        ["density.txt", "temperature.txt"].map(|name| place.path(name).display().to_string());
    place.expect(
        0,
        &format!("render {density} {temperature} --size 16x9 -o a.png"),
    );
    place.expect(0, "render density.txt temperature.txt --size 16x9 -o b.png");
    assert_eq!(
        fs::read(place.path("a.png")).unwrap(),
        fs::read(place.path("b.png")).unwrap()
    );
}

/// While the program waits for a reader of its statistics, its threads are counted.
#[cfg(target_os = "linux")]
#[test]
fn no_step_takes_more_threads_than_were_given() {
    use std::process::Command;
    use std::time::{Duration, Instant};
    let place = Place::new();
    for words in ["-o a.png", "density.txt temperature.txt -o b.png"] {
        let pipe = place.path("stats.json");
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        let picture = place.path(words.split(' ').next_back().unwrap());
        let mut program = Command::new(env!("CARGO_BIN_EXE_sootlight"))
            .args(["render", "--size", "16x9", "--threads", "1"])
            .args(["--stats", "stats.json"])
            .args(words.split(' '))
            // A pool that nobody asked for would have this many more.
            .env("RAYON_NUM_THREADS", "5")
            .current_dir(place.path(""))
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while !picture.exists() && start.elapsed() < Duration::from_mins(1) {
            std::thread::sleep(Duration::from_millis(10));
        }
        let tasks = fs::read_dir(format!("/proc/{}/task", program.id())).unwrap();
        let threads = tasks.count();
        let stats = fs::read_to_string(&pipe).unwrap();
        assert!(program.wait().unwrap().success() && stats.contains("\"threads\": 1"));
        assert_eq!(
            threads, 2,
            "{words}: the program's own and the one to render with"
        );
        fs::remove_file(pipe).unwrap();
    }
}
