//! Keys: what can be set, how it is set from text, and what was probably meant.
//!
//! [`KEYS`] is the one list of everything in a scene file. Scene file, command line and help read it, and a test
//! holds it equal to the fields of [`Project`]. A key is set by its dotted name; what its value must look like
//! is decided by the same types that read a scene file, so the two roads cannot disagree.

use serde::Deserialize;
use thiserror::Error;
use toml::{Table, Value};

use super::Project;

mod keys;

pub use keys::{KEYS, Key};

/// Why a key could not be set.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SetError {
    /// There is no `=`.
    #[error("\"{0}\" is not an assignment: expected key=value, such as soot.amount=2")]
    NotAnAssignment(String),
    /// No such key.
    #[error("there is no key {key}{hint}")]
    UnknownKey {
        /// What was written.
        key: String,
        /// "; did you mean …?" or nothing.
        hint: String,
    },
    /// The value is not of the key's kind.
    #[error("{key} is {found}: expected {expects}{}", hint(*.meant))]
    WrongValue {
        /// The dotted key.
        key: String,
        /// What was written.
        found: String,
        /// What the key takes.
        expects: &'static str,
        /// Which of its names is most like that, if it takes names.
        meant: Option<&'static str>,
    },
}

/// What was probably meant, in words.
fn hint(meant: Option<&str>) -> String {
    meant.map_or_else(String::new, |name| format!("; did you mean {name}?"))
}

impl Project {
    /// Sets one key: `soot.amount=2`. The value is TOML where it can be read so, else the text as it stands.
    /// A path is relative to the working directory. Ranges are not checked here: [`Project::check`] does.
    ///
    /// # Errors
    /// [`SetError`] says what was expected, or which key may have been meant; nothing is changed then.
    pub fn set(&mut self, assignment: &str) -> Result<(), SetError> {
        let (name, text) = assignment
            .split_once('=')
            .map(|(name, text)| (name.trim(), text.trim()))
            .ok_or_else(|| SetError::NotAnAssignment(assignment.to_owned()))?;
        let known = find(name)?;
        // A grid may be named "1": what TOML makes of a value comes first, its plain text second.
        let readings = [toml_value(text), Some(Value::String(text.to_owned()))];
        let changed = readings.into_iter().flatten().find_map(|value| {
            let mut table = self.to_table();
            insert(&mut table, known.name, value);
            Self::deserialize(table).ok()
        });
        *self = changed.ok_or_else(|| known.wrong(text.to_owned()))?;
        Ok(())
    }

    /// Sets keys one after the other; the last of a name wins.
    ///
    /// # Errors
    /// As [`Project::set`]; what came before the error stays set.
    pub fn set_all<'a>(
        &mut self,
        assignments: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), SetError> {
        assignments
            .into_iter()
            .try_for_each(|assignment| self.set(assignment))
    }
}

impl Key {
    /// The error for a value that is not of this key's kind.
    fn wrong(&self, found: String) -> SetError {
        let found = if found.is_empty() {
            "empty".to_owned()
        } else {
            found
        };
        SetError::WrongValue {
            key: self.name.to_owned(),
            meant: did_you_mean(&found, self.names()),
            found,
            expects: self.expects,
        }
    }

    /// The names that it takes, if it takes names.
    fn names(&self) -> impl Iterator<Item = &'static str> {
        let pieces = self
            .expects
            .split(", ")
            .flat_map(|piece| piece.split(" or "));
        pieces.filter(|piece| {
            let is_letter = |c: char| c.is_ascii_lowercase() || c == '-';
            !piece.is_empty() && piece.chars().all(is_letter)
        })
    }

    /// Whether a value is of this key's kind.
    pub(super) fn check(&self, value: &Value) -> Result<(), SetError> {
        let mut alone = Table::new();
        insert(&mut alone, self.name, value.clone());
        Project::deserialize(alone)
            .map(|_| ())
            .map_err(|_| self.wrong(value.to_string()))
    }
}

/// The key of a name.
pub(super) fn find(name: &str) -> Result<&'static Key, SetError> {
    KEYS.iter()
        .find(|key| key.name == name)
        .ok_or_else(|| SetError::UnknownKey {
            key: name.to_owned(),
            hint: hint(nearest_key(name)),
        })
}

/// Whether a name is that of a section, such as `volume` or `volume.soot`.
pub(super) fn is_section(name: &str) -> bool {
    KEYS.iter().any(|key| {
        key.name
            .strip_prefix(name)
            .is_some_and(|rest| rest.starts_with('.'))
    })
}

/// The key that a wrong name most likely means: one with the same last word in another section, else the most
/// similar.
fn nearest_key(name: &str) -> Option<&'static str> {
    let last = |name: &str| name.rsplit('.').next().map(str::to_lowercase);
    let mut same_word = KEYS.iter().filter(|key| last(key.name) == last(name));
    match (same_word.next(), same_word.next()) {
        (Some(only), None) => Some(only.name),
        _ => did_you_mean(name, KEYS.iter().map(|key| key.name)),
    }
}

/// How alike two words must be, by Jaro and Winkler, for one to be offered in place of the other.
const ALIKE: f64 = 0.8;

/// The candidate that is most like a word, if any is alike at all. Case does not count.
pub fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| {
            (
                strsim::jaro_winkler(&word, &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// What TOML makes of a text as a value; `None` if it cannot be one.
fn toml_value(text: &str) -> Option<Value> {
    // One line, one key: a text with a line break must not bring keys of its own.
    let mut table: Table = toml::from_str(&format!("value = {text}")).ok()?;
    let value = table.remove("value")?;
    table.is_empty().then_some(value)
}

/// Puts a value at a dotted key, making sections on the way.
fn insert(table: &mut Table, dotted: &str, value: Value) {
    match dotted.split_once('.') {
        None => {
            table.insert(dotted.to_owned(), value);
        }
        Some((section, rest)) => {
            let below = table
                .entry(section)
                .or_insert_with(|| Value::Table(Table::new()));
            if let Value::Table(below) = below {
                insert(below, rest, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::path::{Path, PathBuf};

    use glam::DVec3;

    use super::super::settings::{BackdropKind, everything_set};
    use super::*;

    fn leaves(table: &Table, prefix: &str, into: &mut Vec<String>) {
        for (name, value) in table {
            let dotted = format!("{prefix}{name}");
            match value {
                Value::Table(below) => leaves(below, &format!("{dotted}."), into),
                _ => into.push(dotted),
            }
        }
    }

    #[test]
    fn the_list_of_keys_is_the_fields_of_a_project() {
        let mut fields = Vec::new();
        leaves(&everything_set().to_table(), "", &mut fields);
        let listed: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
        assert_eq!(fields, listed);
    }

    #[test]
    fn keys_tell_the_ranges_that_are_checked() {
        use super::super::ranges;
        for (name, [min, max]) in [
            ("soot.radius_nm", ranges::SOOT_RADIUS_NM),
            ("soot.amount", ranges::AMOUNT),
            ("smoke.amount", ranges::AMOUNT),
            ("soot.asymmetry", ranges::ASYMMETRY),
            ("smoke.albedo", ranges::ALBEDO),
            ("air.pressure_pa", ranges::PRESSURE_PA),
            ("air.refraction_gain", ranges::REFRACTION_GAIN),
            ("stage.ground_height_m", ranges::STAGE_POSITION_M),
            ("stage.backdrop_distance_m", ranges::STAGE_LENGTH_M),
            ("stage.backdrop_square_m", ranges::STAGE_LENGTH_M),
            ("stage.backdrop_luminance_cd_m2", ranges::BACKDROP_CD_M2),
            ("air.temperature_k", ranges::AIR_TEMPERATURE_K),
            ("air.humidity", ranges::HUMIDITY),
            ("air.co2_ppm", ranges::CO2_PPM),
            ("camera.fov_deg", ranges::FOV_DEG),
            ("camera.roll_deg", ranges::ROLL_DEG),
            ("render.step_voxels", ranges::STEP_VOXELS),
            ("volume.memory_limit_mb", ranges::MEMORY_LIMIT_MB),
            ("view.exposure_ev", ranges::EXPOSURE_EV),
            ("view.adaptation", ranges::ADAPTATION),
            ("view.white_k", ranges::WHITE_K),
            ("view.half_saturation_cd_m2", ranges::HALF_SATURATION_CD_M2),
            ("view.display_white_cd_m2", ranges::DISPLAY_WHITE_CD_M2),
        ] {
            let expects = find(name).unwrap().expects;
            assert!(
                expects.contains(&format!("{min} to {max}")),
                "{name}: {expects}"
            );
            for (value, fits) in [(min, true), (max, true), (max + 1.0, false)] {
                let mut project = Project::default();
                project.set(&format!("{name}={value}")).unwrap();
                assert_eq!(project.check().is_ok(), fits, "{name} = {value}");
            }
        }
    }

    #[test]
    fn a_value_is_toml_where_it_parses_and_text_where_not() {
        let mut project = Project::default();
        project
            .set_all([
                "soot.amount=2",
                "camera.eye = [0, -2, 0.5]",
                "volume.soot.grid=1",
                "volume.path=some dir/a=b.vdb",
                "render.wavelengths=8",
                "render.quality=final",
                "volume.smoke.grid=",
                "stage.spheres=[[0, -2, 0.5, 0.1], [1, 2, 3, 4]]",
                "stage.logs = [[0, 0, 0, 1, 0, 0, 0.05]]",
                "stage.ground_colour=[0, 0.5, 1]",
                "stage.backdrop=gradient",
                "stage.backdrop_picture=some dir/a.png",
            ])
            .unwrap();
        assert_eq!(
            project.stage.spheres,
            [[0.0, -2.0, 0.5, 0.1], [1.0, 2.0, 3.0, 4.0]]
        );
        assert_eq!(project.stage.logs, [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.05]]);
        assert_eq!(project.stage.ground_colour, [0.0, 0.5, 1.0]);
        assert_eq!(project.stage.backdrop, BackdropKind::Gradient);
        assert_eq!(
            project.stage.backdrop_picture.as_deref(),
            Some(Path::new("some dir/a.png"))
        );
        assert_eq!(project.soot.amount, 2.0);
        assert_eq!(project.camera.eye, Some(DVec3::new(0.0, -2.0, 0.5)));
        assert_eq!(project.volume.soot.grid.as_deref(), Some("1"));
        assert_eq!(project.volume.path, [PathBuf::from("some dir/a=b.vdb")]);
        assert_eq!(project.volume.smoke.grid.as_deref(), Some(""));
        project.set(r#"volume.path=["a.vdb", "b.vdb"]"#).unwrap();
        assert_eq!(project.volume.path.len(), 2);
    }

    #[test]
    fn a_wrong_key_or_value_says_what_would_be_right_and_changes_nothing() {
        let mut project = Project::default();
        let mut error = |assignment: &str| project.set(assignment).unwrap_err().to_string();
        assert!(error("soot.radus_nm=3").contains("did you mean soot.radius_nm?"));
        assert!(error("exposure_ev=3").contains("did you mean view.exposure_ev?"));
        assert!(!error("zzz=3").contains("did you mean"));
        assert!(error("soot=3").contains("no key soot"));
        assert!(error("soot.amount").contains("key=value"));
        assert_eq!(
            error("soot.amount=much"),
            "soot.amount is much: expected a number, 0 to 10000"
        );
        assert_eq!(
            error("render.wavelengths=31"),
            format!(
                "render.wavelengths is 31: expected {}",
                find("render.wavelengths").unwrap().expects
            )
        );
        assert!(error("fuel.name=propan").ends_with("or black-body; did you mean propane?"));
        assert!(error("fuel.salt=Sodium").ends_with("; did you mean sodium?"));
        assert!(!error("view.curve=aces").contains("did you mean"));
        assert!(error("stage.backdrop=chequer").ends_with("; did you mean checker?"));
        assert!(error("stage.spheres=[[0, 0, 1]]").contains("four numbers of m"));
        assert!(error("soot.amount=\"2\"\nsoot.radius_nm=3").contains("expected a number"));
        assert_eq!(project, Project::default());
    }
}
