//! Names on disk, as sequences.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use super::*;

/// A folder with empty files of these names.
fn folder(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        fs::write(folder.path().join(name), "").unwrap();
    }
    folder
}

fn numbers(sequence: &Sequence) -> Vec<u64> {
    sequence.numbers().collect()
}

fn file_name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

#[test]
fn any_start_any_padding_and_gaps_are_one_sequence_from_any_of_its_frames() {
    for (names, expected, padding) in [
        (
            &["a_0003.vdb", "a_0004.vdb", "a_0007.vdb"][..],
            &[3, 4, 7][..],
            4,
        ),
        (&["a.9.vdb", "a.10.vdb", "a.11.vdb"], &[9, 10, 11], 1),
        (&["998", "999", "1000"], &[998, 999, 1000], 3),
        (&["a00.txt", "a01.txt"], &[0, 1], 2),
    ] {
        let place = folder(names);
        for name in names {
            let sequence = Sequence::of(&place.path().join(name)).unwrap();
            assert_eq!(numbers(&sequence), expected);
            assert_eq!(sequence.padding(), padding);
            let number = sequence.number_of(&[place.path().join(name)]).unwrap();
            assert_eq!(sequence.paths(number), [place.path().join(name)]);
            assert_eq!(sequence.notes().count(), 0);
        }
        assert_eq!(numbers(&Sequence::of(place.path()).unwrap()), expected);
    }
}

#[test]
fn what_is_named_otherwise_is_another_sequence() {
    let place = folder(&[
        "a_1.vdb", "a_2.vdb", "b_3.vdb", "a_4.txt", "a_5x.vdb", "A_6.vdb", ".a_7.vdb", "a_.vdb",
    ]);
    fs::create_dir(place.path().join("a_8.vdb")).unwrap();
    let sequence = Sequence::of(&place.path().join("a_1.vdb")).unwrap();
    assert_eq!(numbers(&sequence), [1, 2]);
    assert_eq!((sequence.ends(), sequence.has(3)), ([1, 2], false));
    assert_eq!(sequence.pattern(), "a_#.vdb");
}

#[test]
fn of_two_files_with_one_number_the_shorter_is_taken_and_that_is_told() {
    let place = folder(&["a_007.vdb", "a_7.vdb", "a_08.vdb", "a_0007.vdb"]);
    let sequence = Sequence::of(&place.path().join("a_007.vdb")).unwrap();
    assert_eq!(numbers(&sequence), [7, 8]);
    assert_eq!(file_name(&sequence.paths(7)[0]), "a_7.vdb");
    assert_eq!(file_name(&sequence.paths(8)[0]), "a_08.vdb");
    let notes: Vec<&str> = sequence.notes().collect();
    assert_eq!(notes.len(), 2);
    assert!(
        notes[1].contains("a_7.vdb is taken, and a_007.vdb"),
        "{notes:?}"
    );
}

#[test]
fn files_of_one_field_each_count_together() {
    let place = folder(&["d_01.txt", "d_02.txt", "t_1.txt", "t_3.txt"]);
    let paths = ["d_01.txt", "t_1.txt"].map(|name| place.path().join(name));
    let sequence = Sequence::of_all(&paths).unwrap();
    assert_eq!(numbers(&sequence), [1, 2, 3]);
    let names = |number| {
        let paths = sequence.paths(number);
        paths
            .iter()
            .map(|path| file_name(path).to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(names(1), ["d_01.txt", "t_1.txt"]);
    // What is not there has the name that it would have.
    assert_eq!(names(2), ["d_02.txt", "t_2.txt"]);
    assert_eq!(names(3), ["d_03.txt", "t_3.txt"]);
    assert_eq!(sequence.number_of(&paths), Some(1));
}

#[test]
fn what_is_no_sequence_is_named_with_what_to_do() {
    let place = folder(&["a_1.vdb", "fire.vdb"]);
    let words = |path: &Path| Sequence::of(path).unwrap_err().to_string();
    let alone = words(&place.path().join("a_1.vdb"));
    assert!(
        alone.contains("a_1.vdb: it is alone") && alone.contains("a_#.vdb"),
        "{alone}"
    );
    assert!(words(&place.path().join("fire.vdb")).contains("has no number"));
    assert!(words(place.path()).contains("no sequence is in this folder"));
    assert!(words(&place.path().join("none/a_1.vdb")).contains("cannot be listed"));
    assert!(Sequence::of_all(&[]).is_err());

    let several = folder(&[
        "a_1.vdb", "a_2.vdb", "b1.vdb", "b2.vdb", "a_1.png", "a_2.png",
    ]);
    let words = words(several.path());
    assert!(words.contains("a_#.vdb, b#.vdb;"), "{words}");
    // Pictures beside the volumes are no other sequence.
    let one = folder(&[
        "a_1.vdb", "a_2.vdb", "a_1.png", "a_2.png", "a_1.EXR", "a_2.EXR",
    ]);
    assert_eq!(Sequence::of(one.path()).unwrap().pattern(), "a_#.vdb");
}

#[test]
fn frames_are_a_range_one_or_every_so_many() {
    let read = |text: &str| text.parse::<Frames>();
    let frames = |first, last, step| Ok(Frames { first, last, step });
    assert_eq!(read("3-9"), frames(3, 9, 1));
    assert_eq!(read(" 3 – 9 : 2"), frames(3, 9, 2));
    assert_eq!(read("0007"), frames(7, 7, 1));
    for wrong in [
        "",
        "-",
        "3-",
        "-3",
        "a-b",
        "1-2-3",
        "1-2:",
        "1.5-2",
        "99999999999999999999",
    ] {
        assert!(
            read(wrong).unwrap_err().contains("expected frames"),
            "{wrong}"
        );
    }
    assert!(read("9-3").unwrap_err().contains("comes before the first"));
    assert!(read("3-9:0").unwrap_err().contains("must be 1 or more"));
    for text in ["3-9", "7", "3-9:2"] {
        assert_eq!(read(text).unwrap().to_string(), text);
    }
}

#[test]
fn gaps_are_told_from_end_to_end() {
    let place = folder(&["a3", "a4", "a7", "a11"]);
    let sequence = Sequence::of(place.path()).unwrap();
    let told = |text: &str| {
        let frames: Frames = text.parse().unwrap();
        (frames.of(&sequence), frames.gaps(&sequence))
    };
    assert_eq!(told("3-4"), (vec![3, 4], vec![]));
    assert_eq!(
        told("1-12"),
        (vec![3, 4, 7, 11], vec![[1, 2], [5, 6], [8, 10], [12, 12]])
    );
    assert_eq!(told("3-11:4"), (vec![3, 7, 11], vec![]));
    assert_eq!(told("1-12:3"), (vec![4, 7], vec![[1, 1], [10, 10]]));
    assert_eq!(told("5-6"), (vec![], vec![[5, 6]]));
    let most = u64::MAX;
    assert_eq!(told(&format!("11-{most}")), (vec![11], vec![[12, most]]));
}
