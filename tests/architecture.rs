//! The floors of the house: imports go strictly down, rooms on one floor are strangers, files in a room make no
//! circles. Read from the `crate::` and `super::` paths of the code itself.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Rooms and their floors, as the picture in `src/lib.rs` draws them.
const FLOORS: &[(&str, u32)] = &[
    ("main", 11),
    ("cli", 10),
    ("app", 9),
    ("range", 8),
    ("engine", 7),
    ("export", 7),
    ("study", 7),
    ("sequence", 7),
    ("project", 6),
    ("render", 5),
    ("scene", 4),
    ("volume", 3),
    ("physics", 2),
    ("colour", 2),
    ("spectral", 1),
    ("math", 1),
];

fn floor(room: &str) -> u32 {
    FLOORS
        .iter()
        .find(|(name, _)| *name == room)
        .unwrap_or_else(|| panic!("no floor for room {room}"))
        .1
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Whether a file is a test module of its own: `tests.rs`, or below a folder `tests`.
fn is_a_test(path: &Path) -> bool {
    path.iter()
        .any(|name| name == "tests" || name == "tests.rs")
        && path.starts_with(Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

/// Source files as (room, path below src, code without comments and without its test module).
fn code() -> Vec<(String, PathBuf, String)> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    sources(&src)
        .into_iter()
        .filter(|path| !is_a_test(path))
        .map(|path| {
            let below = path.strip_prefix(&src).unwrap().to_path_buf();
            let room = below
                .iter()
                .next()
                .unwrap()
                .to_str()
                .unwrap()
                .trim_end_matches(".rs")
                .to_owned();
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]").next().unwrap();
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            (room, below, code.collect::<Vec<_>>().join("\n"))
        })
        .collect()
}

/// First path segments after `prefix`, groups in braces opened.
fn segments(code: &str, prefix: &str) -> BTreeSet<String> {
    let word = |text: &str| {
        text.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let mut start = true;
            for (i, c) in group.char_indices() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => start = true,
                    c if c.is_alphabetic() && start => {
                        found.insert(word(&group[i..]));
                        start = false;
                    }
                    _ => {}
                }
            }
        } else {
            found.insert(word(rest));
        }
    }
    found.remove("");
    found
}

#[test]
fn imports_go_strictly_down() {
    for (room, path, code) in code() {
        if room == "lib" {
            continue;
        }
        for used in segments(&code, "crate::")
            .iter()
            .chain(&segments(&code, "sootlight::"))
        {
            let known = FLOORS.iter().any(|(name, _)| name == used);
            assert!(known, "{}: crate::{used} is not a room", path.display());
            assert!(
                *used == room || floor(used) < floor(&room),
                "{}: {room} (floor {}) must not use {used} (floor {})",
                path.display(),
                floor(&room),
                floor(used)
            );
        }
    }
}

#[test]
fn every_room_is_in_the_picture_of_the_house() {
    let lib =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    for (room, _, _) in code() {
        let drawn = lib.lines().any(|line| {
            let words = line.trim_start_matches("//!").trim_start();
            let words = words
                .trim_start_matches(|c: char| c.is_ascii_digit())
                .trim_start();
            words.starts_with(&room)
        });
        assert!(
            room == "lib" || drawn,
            "{room} is not in the picture of src/lib.rs"
        );
    }
}

#[test]
fn only_the_window_knows_egui_and_only_the_top_floors_print() {
    for (room, path, code) in code() {
        let above = ["app", "cli", "main"].contains(&room.as_str());
        for word in ["egui", "eframe", "wgpu", "rfd::"] {
            assert!(
                room == "app" || !code.contains(word),
                "{}: {word} below the window",
                path.display()
            );
        }
        for word in ["println!", "eprintln!", "print!(", "stdout()", "stderr()"] {
            assert!(
                above || !code.contains(word),
                "{}: {word} below app and cli",
                path.display()
            );
        }
    }
}

#[test]
fn unsafe_stands_in_one_file() {
    for (_, path, code) in code() {
        let allowed = path.ends_with("math/lanes.rs");
        assert!(
            allowed || !code.contains("unsafe "),
            "{}: unsafe",
            path.display()
        );
    }
}

/// `deny.toml` holds licences and advisories by a tool that need not be there; where crates come from can be told here.
#[test]
fn every_dependency_comes_from_the_registry() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let deny = std::fs::read_to_string(root.join("deny.toml")).unwrap();
    let registry = "https://github.com/rust-lang/crates.io-index";
    assert!(deny.contains(&format!("allow-registry = [\"{registry}\"]")));
    let lock = std::fs::read_to_string(root.join("Cargo.lock")).unwrap();
    let sources: Vec<&str> = lock
        .lines()
        .filter_map(|line| line.strip_prefix("source = "))
        .collect();
    assert!(sources.len() > 100);
    for source in sources {
        assert_eq!(source, format!("\"registry+{registry}\""));
    }
}

#[test]
fn files_of_a_room_make_no_circles() {
    let mut uses: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
    for (room, path, code) in code() {
        let file = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if file == "mod" || path.components().count() != 2 {
            continue;
        }
        let mut siblings = segments(&code, "super::");
        siblings.extend(segments(&code, &format!("crate::{room}::")));
        uses.insert((room, file), siblings);
    }
    for (room, file) in uses.keys() {
        let mut reached = BTreeSet::new();
        let mut open = vec![file.clone()];
        while let Some(next) = open.pop() {
            for sibling in uses.get(&(room.clone(), next)).into_iter().flatten() {
                assert!(sibling != file, "{room}: {file} comes back to itself");
                if uses.contains_key(&(room.clone(), sibling.clone()))
                    && reached.insert(sibling.clone())
                {
                    open.push(sibling.clone());
                }
            }
        }
    }
}

#[test]
fn the_reader_of_paths_sees_groups_and_plain_paths() {
    let code =
        "use crate::{math::{Ray, Aabb}, scene};\nlet x = crate::volume::open(a); mycrate::no();";
    let expected = ["math", "scene", "volume"].map(String::from);
    assert_eq!(segments(code, "crate::"), BTreeSet::from(expected));
}
