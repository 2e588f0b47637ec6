//! Which field a file holds whose format does not say: the file's name first, else the range of its values.

use std::path::Path;

/// Ambient temperature of a kelvin file that stores only hot voxels.
pub(super) const AMBIENT_K: f32 = 300.0;
/// Above this the largest value of a field can only be a temperature in kelvin.
pub(super) const KELVIN_FLOOR: f32 = 200.0;
/// Up to this the largest value of a field can only be a soot volume fraction: flames reach 1e-5.
pub(super) const FRACTION_CEILING: f32 = 1e-3;

/// The field of a file of one field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NamedField {
    /// "temperature", "density" or "soot".
    pub name: &'static str,
    /// How that was told, for the person.
    pub reason: String,
}

impl NamedField {
    /// Decides from the file's name and its largest finite value.
    pub(super) fn decide(path: &Path, largest: f32) -> Self {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let lower = file.to_lowercase();
        let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).collect();
        let says = |whole: &str, short: &[&str]| {
            lower.contains(whole) || short.iter().any(|word| words.contains(word))
        };
        let hints = [
            (
                "temperature",
                says("temperature", &["temp", "heat", "kelvin"]),
            ),
            ("density", says("density", &["dens", "smoke"])),
            ("soot", says("soot", &["fv"])),
        ];
        let mut named = hints.iter().filter(|(_, said)| *said);
        if let (Some((name, _)), None) = (named.next(), named.next()) {
            return Self {
                name,
                reason: format!("{file}: taken as {name}, after its name"),
            };
        }
        let (name, why) = if largest > KELVIN_FLOOR {
            ("temperature", "kelvin")
        } else if largest <= FRACTION_CEILING {
            ("soot", "a volume fraction")
        } else {
            ("density", "neither kelvin nor a volume fraction")
        };
        Self {
            name,
            reason: format!(
                "{file}: taken as {name}, because its largest value {} is {why}",
                figures(f64::from(largest))
            ),
        }
    }

    /// The value of voxels that a sparse file leaves out.
    pub(super) fn ambient(&self, largest: f32) -> f32 {
        if self.name == "temperature" && largest > KELVIN_FLOOR {
            AMBIENT_K
        } else {
            0.0
        }
    }
}

/// A value for people: four digits without idle zeros, with an exponent where it is very small or very large.
pub fn figures(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs();
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decide(name: &str, largest: f32) -> &'static str {
        NamedField::decide(Path::new(name), largest).name
    }

    #[test]
    fn the_name_decides_before_the_range() {
        assert_eq!(decide("a/panfire_temperature.txt", 1e-6), "temperature");
        assert_eq!(decide("Fire-Temp.0007.bin", 1.0), "temperature");
        assert_eq!(decide("soot.txt", 2000.0), "soot");
        assert_eq!(
            decide("temperature/field.txt", 1e-6),
            "soot",
            "folders do not count"
        );
    }

    #[test]
    fn figures_keep_four_digits_at_any_size() {
        let cases = [
            (0.0, "0"),
            (300.0, "300"),
            (1963.677, "1964"),
            (0.18237, "0.1824"),
            (0.01875, "0.01875"),
            (-1.5, "-1.5"),
            (2.4358744e-6, "2.436e-6"),
            (123456.0, "1.235e5"),
            (1e30, "1.000e30"),
        ];
        for (value, text) in cases {
            assert_eq!(figures(value), text);
        }
    }

    #[test]
    fn the_range_decides_where_the_name_is_silent_or_says_two_things() {
        assert_eq!(decide("template.txt", 1800.0), "temperature");
        assert_eq!(decide("a.txt", 2e-6), "soot");
        assert_eq!(decide("a.txt", 0.7), "density");
        assert_eq!(decide("density_temperature.bin", 900.0), "temperature");
    }
}
