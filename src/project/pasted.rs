//! Settings that were made for one fire, taken over for another.

use std::path::PathBuf;

use super::Project;

impl Project {
    /// Takes over all that another project sets but its fire. Only where both are of the same fire, what its fields mean and the
    /// camera, which suit no other, are taken as well.
    pub fn take_settings(&mut self, other: Self) {
        let fire = self.clone();
        *self = other;
        if !self.is_of_the_same_fire(&fire) {
            self.volume = fire.volume;
            self.camera = fire.camera;
        }
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

        let mut other = of("b.vdb");
        other.volume.temperature.scale = Some(1.0);
        other.take_settings(told.clone());
        assert_eq!(other.volume.path, [PathBuf::from("b.vdb")]);
        assert_eq!(other.volume.temperature.scale, Some(1.0));
        assert_ne!(other.camera, told.camera);
        assert_eq!(
            (other.soot, other.view),
            (told.soot.clone(), told.view.clone())
        );

        // Whole or relative, it is the same file.
        let mut same = of(&std::path::absolute("a.vdb")
            .unwrap_or_default()
            .to_string_lossy());
        same.take_settings(told.clone());
        assert_eq!((&same.volume, &same.camera), (&told.volume, &told.camera));
    }
}
