//! Which file a fire's scene is in, and whether it has changed since.

use super::*;

fn of(path: &str) -> Project {
    let mut project = Project::default();
    project.volume.path = vec![PathBuf::from(path)];
    project
}

#[test]
fn a_scene_is_unsaved_once_something_worth_keeping_differs() {
    let mut project = of("fire_0001.vdb");
    let mut scene = SceneFile::new(&project);
    project.camera.fov_deg = Some(40.0);
    assert!(!scene.is_unsaved(&project));
    scene.begin(Some(PathBuf::from("a.toml")), of("fire_0001.vdb"));
    assert!(scene.is_unsaved(&project));
    scene.keep(&project);
    assert!(!scene.is_unsaved(&project));
    // Another frame is nothing to be saved; how its numbers are understood is.
    project.volume.path = vec![PathBuf::from("fire_0002.vdb")];
    assert!(!scene.is_unsaved(&project));
    project.volume.temperature.scale = Some(2.0);
    assert!(scene.is_unsaved(&project));
}

#[test]
fn a_fire_that_comes_back_brings_its_own_file_and_never_another_ones() {
    let (one, other) = (of("a.vdb"), of("b.vdb"));
    let mut scenes = SceneFile::new(&one);
    scenes.begin(Some(PathBuf::from("b.toml")), other.clone());
    assert_eq!(scenes.path(), Some(Path::new("b.toml")));
    scenes.follow(&one, None);
    assert_eq!(scenes.path(), None);
    assert!(!scenes.is_unsaved(&one));
    scenes.follow(&other, None);
    assert_eq!(scenes.path(), Some(Path::new("b.toml")));
    scenes.follow(&of("c.vdb"), None);
    assert_eq!(scenes.path(), None);
}

#[test]
fn what_was_set_before_a_scene_was_opened_is_not_that_scene() {
    let (project, torch) = (
        Project::default(),
        Arc::new(crate::volume::procedural::torch()),
    );
    let mut scenes = SceneFile::new(&project);
    scenes.follow(&project, Some(&torch));
    // The same flame once more, from a file.
    let opened = Arc::new(crate::volume::procedural::torch());
    scenes.begin(Some(PathBuf::from("b.toml")), project.clone());
    scenes.known[1].volume = Arc::downgrade(&opened);
    scenes.follow(&project, Some(&opened));
    assert_eq!(scenes.path(), Some(Path::new("b.toml")));
    scenes.follow(&project, Some(&torch));
    assert_eq!(scenes.path(), None);
    // Read once more, it is what it was.
    let again = Arc::new(crate::volume::procedural::torch());
    scenes.follow(&project, Some(&again));
    assert_eq!(scenes.path(), None);
}

#[test]
fn settings_are_told_from_paths() {
    assert!(is_settings(&Project::default().to_toml()));
    assert!(is_settings("[soot]\namount = 2"));
    for path in [
        "/fires/a.vdb",
        "C:\\a b\\c.vdb",
        "file:///a.vdb\n/b=c.vdb",
        "",
    ] {
        assert!(!is_settings(path), "{path}");
    }
}
