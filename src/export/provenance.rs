//! Where a picture comes from, as text that travels in its file: enough to make it again.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::project::Project;
use crate::render::Flaws;

/// What a picture says of itself. The same picture says the same: no clock, no machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// Program and version.
    pub software: String,
    /// For people: what was rendered, and what could not be faithful.
    pub comment: String,
    /// The complete scene file. A volume below the working directory is named relative to it, so that a picture
    /// tells no more of the machine than it must; others stand as they were given.
    pub scene: String,
}

impl Provenance {
    /// The provenance of a project's picture.
    pub fn new(project: &Project, flaws: &Flaws) -> Self {
        let software = concat!("sootlight ", env!("CARGO_PKG_VERSION")).to_owned();
        let mut comment = format!("Made by {software} from ");
        if project.volume.path.is_empty() {
            comment.push_str("the built-in flame, ");
            comment.push_str(project.volume.built_in.name());
        }
        for (i, path) in project.volume.path.iter().enumerate() {
            let separator = if i == 0 { "" } else { ", " };
            let _ = write!(comment, "{separator}{}", described(path));
        }
        comment.push_str(". Emission and absorption, spectral.");
        for flaw in flaws.iter() {
            let _ = write!(comment, "\nFlaw: {flaw}");
        }
        Self {
            software,
            comment,
            scene: scene(project),
        }
    }
}

fn scene(project: &Project) -> String {
    let mut portable = project.clone();
    // Without a working directory nothing is below it.
    if let Ok(here) = std::env::current_dir() {
        for path in &mut portable.volume.path {
            if let Some(relative) = below(&here, path) {
                *path = relative;
            }
        }
    }
    portable.to_toml()
}

/// An absolute path as one relative to a folder that it is below, whichever links either was reached by.
fn below(folder: &Path, path: &Path) -> Option<PathBuf> {
    if !path.is_absolute() {
        return None;
    }
    if let Ok(relative) = path.strip_prefix(folder) {
        return Some(relative.to_owned());
    }
    // The file itself keeps the name it was given, if it is a link.
    let parent = path.parent()?.canonicalize().ok()?;
    let folder = folder.canonicalize().ok()?;
    Some(parent.strip_prefix(folder).ok()?.join(path.file_name()?))
}

/// Name and size of a file: the folders above it are nobody's business.
fn described(path: &Path) -> String {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    match std::fs::metadata(path) {
        Ok(about) => format!("{name} ({} bytes)", about.len()),
        Err(_) => name.into_owned(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn a_provenance_names_its_files_and_flaws_and_holds_the_project() {
        let mut project = Project::default();
        project.soot.amount = 0.1;
        project.volume.path = vec!["somewhere/a.vdb".into(), "b.vdb".into()];
        let mut flaws = Flaws::default();
        flaws.add("no temperature grid");
        let provenance = Provenance::new(&project, &flaws);
        assert!(
            provenance.comment.contains("from a.vdb, b.vdb."),
            "{}",
            provenance.comment
        );
        assert!(provenance.comment.ends_with("Flaw: no temperature grid"));
        assert_eq!(
            Project::from_toml(&provenance.scene, Path::new("")).unwrap(),
            project
        );
    }

    #[test]
    fn what_is_below_the_working_directory_is_named_from_there() {
        let folder = tempfile::tempdir().unwrap();
        let here = folder.path();
        let inside = |path: &str| below(here, &here.join(path));
        assert_eq!(inside("a.vdb"), Some("a.vdb".into()));
        assert_eq!(inside("deep/a.vdb"), Some("deep/a.vdb".into()));
        assert_eq!(below(here, Path::new("../a.vdb")), None);
        assert_eq!(below(&here.join("other"), &here.join("a.vdb")), None);
        #[cfg(unix)]
        {
            std::fs::create_dir(here.join("real")).unwrap();
            std::os::unix::fs::symlink("real", here.join("link")).unwrap();
            let by_link = here.join("link/a.vdb");
            assert_eq!(below(&here.join("real"), &by_link), Some("a.vdb".into()));
        }
    }
}
