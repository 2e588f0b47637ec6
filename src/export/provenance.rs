//! Where a picture comes from, as text that travels in its file: enough to make it again.

use std::fmt::Write as _;
use std::path::Path;

use crate::project::Project;
use crate::render::Flaws;

/// What a picture says of itself. The same picture says the same: no clock, no machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// Program and version.
    pub software: String,
    /// For people: what was rendered, and what could not be faithful.
    pub comment: String,
    /// The complete scene file.
    pub scene: String,
}

impl Provenance {
    /// The provenance of a project's picture.
    pub fn new(project: &Project, flaws: &Flaws) -> Self {
        let software = concat!("sootlight ", env!("CARGO_PKG_VERSION")).to_owned();
        let mut comment = format!("Made by {software} from ");
        if project.volume.path.is_empty() {
            comment.push_str("the built-in flame");
        }
        for (i, path) in project.volume.path.iter().enumerate() {
            let separator = if i == 0 { "" } else { ", " };
            let _ = write!(comment, "{separator}{}", described(path));
        }
        comment.push_str(". Emission and absorption of soot, spectral.");
        for flaw in flaws.iter() {
            let _ = write!(comment, "\nFlaw: {flaw}");
        }
        Self {
            software,
            comment,
            scene: project.to_toml(),
        }
    }
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
}
