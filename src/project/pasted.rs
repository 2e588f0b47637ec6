//! Settings that were made for one fire, carried to another as text.

use std::path::{Path, PathBuf};

use toml::Table;

use super::Project;

impl Project {
    /// All that is set, as text that means the same wherever it is pasted: its paths are whole.
    pub fn copied(&self) -> String {
        let mut whole = self.clone();
        for path in whole.paths_mut() {
            if let Ok(absolute) = std::path::absolute(&path) {
                *path = absolute;
            }
        }
        whole.to_toml()
    }

    /// This project with the sections that a scene's text holds. The fire stays; only where both are of the same one, what its
    /// fields mean and the camera, which suit no other, are taken as well.
    ///
    /// # Errors
    /// Words that name the key, what was found and what was expected.
    pub fn with_pasted(&self, text: &str) -> Result<Self, String> {
        let pasted = Self::from_toml(text, Path::new("")).map_err(|error| error.to_string())?;
        pasted.check().map_err(|error| error.to_string())?;
        // It has just been read as such.
        let sections: Table = toml::from_str(text).map_err(|error| error.to_string())?;
        let has = |section: &str| sections.contains_key(section);
        let is_same = has("volume") && pasted.is_of_the_same_fire(self);
        let mut project = self.clone();
        if is_same {
            project.volume.clone_from(&pasted.volume);
            project.volume.path.clone_from(&self.volume.path);
        }
        if has("camera") && (is_same || !has("volume")) {
            project.camera = pasted.camera;
        }
        macro_rules! take {
            ($($section:ident),*) => {
                $(if has(stringify!($section)) {
                    project.$section = pasted.$section;
                })*
            };
        }
        take!(fuel, soot, smoke, air, stage, effects, render, view);
        Ok(project)
    }

    fn is_of_the_same_fire(&self, other: &Self) -> bool {
        let whole = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let paths = |project: &Self| project.volume.path.iter().map(whole).collect::<Vec<_>>();
        paths(self) == paths(other)
            && (!self.volume.path.is_empty() || self.volume.built_in == other.volume.built_in)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    fn of(path: &str) -> Project {
        let mut project = Project::default();
        project.volume.path = vec![PathBuf::from(path)];
        project
    }

    #[test]
    fn another_fire_keeps_its_files_mapping_and_camera_and_burns_as_told() {
        let mut told = of("a.vdb");
        told.volume.temperature.scale = Some(700.0);
        told.camera.fov_deg = Some(50.0);
        told.soot.amount = 3.0;
        told.view.exposure_ev = 1.5;
        let text = told.copied();

        let mut other = of("b.vdb");
        other.volume.temperature.scale = Some(1.0);
        // What was set by hand and is automatic in the text becomes so again.
        other.soot.asymmetry = Some(0.5);
        let pasted = other.with_pasted(&text).unwrap();
        assert_eq!(
            (&pasted.volume, &pasted.camera),
            (&other.volume, &other.camera)
        );
        assert_eq!((&pasted.soot, &pasted.view), (&told.soot, &told.view));

        let same = of("a.vdb").with_pasted(&text).unwrap();
        assert_eq!((&same.volume, &same.camera), (&told.volume, &told.camera));
    }

    #[test]
    fn sections_that_are_not_in_the_text_stay() {
        let mut project = of("a.vdb");
        project.air.humidity = 0.9;
        project.camera.fov_deg = Some(20.0);
        let pasted = project.with_pasted("[soot]\namount = 2").unwrap();
        assert_eq!(pasted.soot.amount, 2.0);
        assert_eq!(
            (&pasted.air, &pasted.camera),
            (&project.air, &project.camera)
        );
        assert!(
            project
                .with_pasted("[soot]\namount = -1")
                .unwrap_err()
                .contains("soot.amount")
        );
        assert!(
            project
                .with_pasted("[soot]\namont = 1")
                .unwrap_err()
                .contains("amont")
        );
    }
}
