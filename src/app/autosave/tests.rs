//! Tests of what is kept and what is offered.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use super::*;

fn with_soot(amount: f64) -> Project {
    let mut project = Project::default();
    project.soot.amount = amount;
    project
}

/// A window in which this was set and kept.
fn kept(folder: &Path, amount: f64) -> Autosave {
    let mut window = Autosave::in_folder(folder, &Project::default());
    let now = Instant::now();
    let project = with_soot(amount);
    assert!(window.follow(&project, now).is_some_and(|it| it <= QUIET));
    assert_eq!(window.follow(&project, now + QUIET), None);
    window.own.as_mut().unwrap().finish(true);
    window
}

fn names(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn what_was_not_changed_is_not_kept_and_what_goes_on_changing_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Autosave::in_folder(folder.path(), &with_soot(2.0));
    let begun = Instant::now();
    assert_eq!(window.follow(&with_soot(2.0), begun + LONGEST), None);
    assert_eq!(names(folder.path()), 0);
    // A hand on a slider: half of the quiet time between two changes.
    let mut now = begun;
    while window.own.as_ref().unwrap().writing.is_none() {
        assert!(now <= begun + LONGEST + QUIET);
        now += QUIET / 2;
        window.follow(&with_soot(now.duration_since(begun).as_secs_f64()), now);
    }
    window.end();
    assert_eq!(names(folder.path()), 0);
}

#[test]
fn a_window_that_is_gone_left_what_it_kept_and_one_that_lives_did_not() {
    let folder = tempfile::tempdir().unwrap();
    let (gone, living) = (kept(folder.path(), 3.0), kept(folder.path(), 4.0));
    assert_eq!(names(folder.path()), 4, "each keeps files of its own");
    drop(gone);
    let mut next = Autosave::in_folder(folder.path(), &Project::default());
    assert_eq!(next.left().unwrap().soot.amount, 3.0);
    assert!(next.offer().unwrap().contains("built-in torch"));
    // While one offers it, no other does.
    let other = Autosave::in_folder(folder.path(), &Project::default());
    assert_eq!(other.left(), None);
    next.take_over(&with_soot(3.0));
    assert_eq!(next.left(), None);
    // Restored, it is this window's to keep.
    drop(next);
    let mut last = Autosave::in_folder(folder.path(), &Project::default());
    assert_eq!(last.left().unwrap().soot.amount, 3.0);
    last.forget();
    assert_eq!(names(folder.path()), 2);
    drop(living);
    let last = Autosave::in_folder(folder.path(), &Project::default());
    assert_eq!(last.left().unwrap().soot.amount, 4.0);
}

#[test]
fn a_folder_that_cannot_be_had_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a file");
    fs::write(&file, "").unwrap();
    let mut window = Autosave::in_folder(&file, &Project::default());
    let mut now = Instant::now();
    let mut told = Vec::new();
    for amount in [2.0, 3.0] {
        window.follow(&with_soot(amount), now);
        now += QUIET;
        window.follow(&with_soot(amount), now);
        told.extend(window.problem());
    }
    assert!(told.len() == 1 && told[0].contains("a file"), "{told:?}");
}
