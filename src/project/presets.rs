//! Flames that come with the program, as scene files: what burns, and which built-in flame shows it best.
//!
//! They lie in assets/scenes/presets and are read by the same road as any scene file. To add one, add a file and a row, and
//! make its picture by the command at the top of `tests/screenshots.rs`. A person's own presets are scene files of her own.

use std::path::Path;

use super::Project;
use super::settings::{FuelSettings, ViewSettings, VolumeSettings};

/// A flame by its scene file.
#[derive(Debug, PartialEq, Eq)]
pub struct Preset {
    /// The name on the command line.
    pub name: &'static str,
    /// The name for a person.
    pub label: &'static str,
    /// What it looks like.
    pub words: &'static str,
    scene: &'static str,
    /// Its picture, a PNG of [`THUMBNAIL`] pixels.
    pub picture: &'static [u8],
}

/// Width and height of a preset's picture, pixels.
pub const THUMBNAIL: [u32; 2] = [72, 90];

macro_rules! preset {
    ($name:literal, $label:literal, $words:literal) => {
        Preset {
            name: $name,
            label: $label,
            words: $words,
            scene: include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/assets/scenes/presets/",
                $name,
                ".toml"
            )),
            picture: include_bytes!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/assets/scenes/presets/",
                $name,
                ".png"
            )),
        }
    };
}

/// Every preset, in the order of a menu.
pub static PRESETS: &[Preset] = &[
    preset!(
        "torch",
        "Propane torch",
        "Wrinkled sheets of soot, orange to yellow."
    ),
    preset!(
        "candle",
        "Candle",
        "A still, bright cone of wax's soot over a dark foot."
    ),
    preset!(
        "gas-burner",
        "Gas burner",
        "A blue cone under a yellow tip: burnt with too little air."
    ),
    preset!(
        "wood",
        "Wood",
        "A thin, transparent flame with the yellow of wood's sodium."
    ),
    preset!(
        "pool-fire",
        "Pool fire",
        "More soot than a torch: it glows like a surface of its own."
    ),
    preset!(
        "smoky-diesel",
        "Smoky diesel",
        "Cool soot outside hides the bright soot within; dark smoke where the file has any."
    ),
    preset!("sodium", "Sodium yellow", "Table salt in a spirit flame."),
    preset!("copper", "Copper green", "A copper salt in a spirit flame."),
    preset!(
        "strontium",
        "Strontium red",
        "A strontium salt in a spirit flame."
    ),
    preset!(
        "lithium",
        "Lithium crimson",
        "A lithium salt in a spirit flame."
    ),
];

impl Preset {
    /// The preset of a name on the command line.
    pub fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }

    /// The whole scene.
    pub fn project(&self) -> Project {
        // The files are compiled in, and a test reads every one.
        Project::from_toml(self.scene, Path::new("")).unwrap_or_default()
    }

    /// Lets a project burn so, as [`Project::burn_as`].
    pub fn apply(&self, project: &mut Project) {
        project.burn_as(self.project());
    }
}

impl Project {
    /// Takes over what burns in a scene. A person's file stays as it is mapped and looked at: only where one of the program's own
    /// flames is shown does the scene choose which, and how it is exposed.
    pub fn burn_as(&mut self, scene: Self) {
        let is_own_flame = self.volume.path.is_empty() && scene.volume.path.is_empty();
        if is_own_flame {
            if self.volume.built_in != scene.volume.built_in {
                self.volume = VolumeSettings {
                    built_in: scene.volume.built_in,
                    ..VolumeSettings::default()
                };
            }
            self.view = scene.view;
        }
        // How thin a volume's sheets of flame are is its own, and so is how much of the blue glow it wants.
        let blue_glow = if is_own_flame {
            scene.fuel.blue_glow
        } else {
            self.fuel.blue_glow
        };
        self.fuel = FuelSettings {
            blue_glow,
            ..scene.fuel
        };
        self.soot = scene.soot;
        self.smoke = scene.smoke;
        self.effects = scene.effects;
    }

    /// What burns, as a scene of its own: all that [`Project::burn_as`] takes.
    #[must_use]
    pub fn what_burns(&self) -> Self {
        let is_own_flame = self.volume.path.is_empty();
        Self {
            volume: VolumeSettings {
                built_in: self.volume.built_in,
                ..VolumeSettings::default()
            },
            fuel: self.fuel.clone(),
            soot: self.soot.clone(),
            smoke: self.smoke.clone(),
            effects: self.effects,
            view: if is_own_flame {
                self.view.clone()
            } else {
                ViewSettings::default()
            },
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::path::PathBuf;

    use super::*;
    use crate::volume::BuiltIn;

    #[test]
    fn every_preset_reads_and_is_named_once() {
        for (i, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[..i].iter().all(|other| other.name != preset.name));
            let project = Project::from_toml(preset.scene, Path::new("")).unwrap();
            project.check().unwrap();
            assert_eq!(project, preset.project());
            assert_eq!(Preset::named(preset.name), Some(preset));
        }
    }

    #[test]
    fn what_burns_is_carried_by_a_scene_of_its_own() {
        let mut from = Preset::named("copper").unwrap().project();
        from.camera.fov_deg = Some(50.0);
        from.air.humidity = 0.9;
        let kept = from.what_burns();
        assert_eq!(
            (&kept.camera, &kept.air),
            (&Project::default().camera, &Project::default().air)
        );
        let mut onto = Project::default();
        onto.burn_as(kept);
        assert_eq!(
            (&onto.fuel, &onto.soot, &onto.view),
            (&from.fuel, &from.soot, &from.view)
        );
        assert_eq!(onto.volume.built_in, from.volume.built_in);
    }

    #[test]
    fn a_preset_changes_what_burns_and_leaves_a_file_as_it_is_read() {
        let copper = Preset::named("gas-burner").unwrap();
        let mut project = Project::default();
        copper.apply(&mut project);
        assert_eq!(project.volume.built_in, BuiltIn::Burner);
        assert_eq!(project.fuel, copper.project().fuel);

        let mut project = Project::default();
        project.volume.path = vec![PathBuf::from("a.vdb")];
        project.volume.temperature.scale = Some(700.0);
        project.view.exposure_ev = 1.5;
        let before = project.clone();
        copper.apply(&mut project);
        assert_eq!(project.volume, before.volume);
        assert_eq!(project.view, before.view);
        assert_eq!(project.camera, before.camera);
        Preset::named("copper").unwrap().apply(&mut project);
        assert_ne!(project.fuel, before.fuel);
        assert_eq!(project.fuel.blue_glow, before.fuel.blue_glow);
    }
}
