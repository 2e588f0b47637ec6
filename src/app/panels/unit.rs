//! Numbers with units, as people write and read them: "425 Å", "60 %", "0,5 voxels".

/// Turns a number of one unit into one of another.
type Convert = fn(f64) -> f64;

/// How a number is shown and typed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    /// The unit it is shown in, behind the number.
    pub(super) name: &'static str,
    /// The unit behind a 1, where that is another word.
    pub(super) one: Option<&'static str>,
    /// What is shown for a value of 1.
    pub(super) shown: f64,
    /// Decimals that are worth showing.
    pub(super) decimals: usize,
    /// Other names for the shown unit, and other units, each with what turns its number into the shown one.
    pub(super) also: &'static [(&'static str, Convert)],
    /// What may be typed, for a person who typed something else.
    pub(super) example: &'static str,
}

fn same(number: f64) -> f64 {
    number
}

/// Lengths of particles, held in nm.
pub(super) const NANOMETRES: Unit = Unit {
    name: "nm",
    one: None,
    shown: 1.0,
    decimals: 2,
    also: &[
        ("å", |n| 0.1 * n),
        ("a", |n| 0.1 * n),
        ("angstrom", |n| 0.1 * n),
        ("µm", |n| 1e3 * n),
        ("um", |n| 1e3 * n),
        ("m", |n| 1e9 * n),
    ],
    example: "42.5 nm or 425 Å",
};

/// Shares, held as 0 to 1.
pub(super) const PERCENT: Unit = Unit {
    name: "%",
    one: None,
    shown: 100.0,
    decimals: 0,
    also: &[("percent", same)],
    example: "60 %",
};

/// Mole fractions, held in parts in a million.
pub(super) const PPM: Unit = Unit {
    name: "ppm",
    one: None,
    shown: 1.0,
    decimals: 0,
    also: &[("%", |n| 1e4 * n), ("‰", |n| 1e3 * n)],
    example: "420 ppm or 0.04 %",
};

/// Factors.
pub(super) const TIMES: Unit = Unit {
    name: "×",
    one: None,
    shown: 1.0,
    decimals: 2,
    also: &[("x", same), ("times", same), ("%", |n| 0.01 * n)],
    example: "2.5 or 250 %",
};

/// Lengths of steps.
pub(super) const VOXELS: Unit = Unit {
    name: "voxels",
    one: Some("voxel"),
    shown: 1.0,
    decimals: 2,
    also: &[("voxel", same), ("vx", same)],
    example: "0.5 voxels",
};

/// Exposures.
pub(super) const STOPS: Unit = Unit {
    name: "EV",
    one: None,
    shown: 1.0,
    decimals: 2,
    also: &[("stops", same), ("stop", same)],
    example: "-1.5 EV",
};

/// Temperatures.
pub(super) const KELVIN: Unit = Unit {
    name: "K",
    one: None,
    shown: 1.0,
    decimals: 0,
    also: &[
        ("°c", |n| n + 273.15),
        ("c", |n| n + 273.15),
        ("°f", |n| (n - 32.0) / 1.8 + 273.15),
        ("f", |n| (n - 32.0) / 1.8 + 273.15),
    ],
    example: "300 K or 27 °C",
};

/// Temperatures of whites.
pub(super) const WHITE_KELVIN: Unit = Unit {
    example: "2856 K",
    ..KELVIN
};

/// Luminances.
pub(super) const LUMINANCE: Unit = Unit {
    name: "cd/m²",
    one: None,
    shown: 1.0,
    decimals: 0,
    also: &[
        ("cd/m2", same),
        ("cd", same),
        ("nit", same),
        ("nits", same),
        ("kcd/m²", |n| 1e3 * n),
    ],
    example: "20000 cd/m²",
};

/// Memory, held in 10⁶ bytes.
pub(super) const MEGABYTES: Unit = Unit {
    name: "MB",
    one: None,
    shown: 1.0,
    decimals: 0,
    also: &[("gb", |n| 1e3 * n), ("tb", |n| 1e6 * n)],
    example: "8000 MB or 8 GB",
};

/// Pressures, held in Pa.
pub(super) const HECTOPASCAL: Unit = Unit {
    name: "hPa",
    one: None,
    shown: 0.01,
    decimals: 2,
    also: &[
        ("pa", |n| 0.01 * n),
        ("kpa", |n| 10.0 * n),
        ("mbar", same),
        ("bar", |n| 1e3 * n),
        // The standard atmosphere.
        ("atm", |n| 1013.25 * n),
    ],
    example: "1013.25 hPa or 101325 Pa",
};

/// Cosines.
pub(super) const COSINE: Unit = Unit {
    name: "",
    one: None,
    shown: 1.0,
    decimals: 3,
    also: &[],
    example: "0.6",
};

/// Lengths of what stands around the fire, held in m.
pub(super) const METRES: Unit = Unit {
    name: "m",
    one: None,
    shown: 1.0,
    decimals: 3,
    also: &[
        ("cm", |n| 0.01 * n),
        ("mm", |n| 1e-3 * n),
        ("km", |n| 1e3 * n),
    ],
    example: "0.35 m or 35 cm",
};

/// Kelvin for one unit of a file.
pub(super) const KELVIN_PER_UNIT: Unit = Unit {
    name: "K/unit",
    one: None,
    shown: 1.0,
    decimals: 1,
    also: &[("k", same)],
    example: "780 K for each unit of the file",
};

/// Edges of voxels, held in m.
pub(super) const MILLIMETRES: Unit = Unit {
    name: "mm",
    one: None,
    shown: 1000.0,
    decimals: 2,
    also: &[
        ("cm", |n| 10.0 * n),
        ("m", |n| 1000.0 * n),
        ("µm", |n| 1e-3 * n),
    ],
    example: "6.25 mm or 1 cm",
};

/// Angles, held in degrees.
pub(super) const DEGREES: Unit = Unit {
    name: "°",
    one: None,
    shown: 1.0,
    decimals: 1,
    also: &[("deg", |n| n), ("rad", f64::to_degrees)],
    example: "12.5 or 12.5°",
};

/// Focal lengths on a 36 × 24 mm frame, held in mm; an angle is the picture's vertical field of view.
pub(super) const FOCAL_LENGTH: Unit = Unit {
    name: "mm",
    one: None,
    shown: 1.0,
    decimals: 1,
    also: &[
        ("°", crate::scene::camera::focal_length_mm),
        ("deg", crate::scene::camera::focal_length_mm),
        ("cm", |n| 10.0 * n),
    ],
    example: "50 mm or 27°",
};

impl Unit {
    /// A value in words, without its unit.
    pub(super) fn number(&self, value: f64) -> String {
        let shown = value * self.shown;
        let text = format!("{shown:.*}", self.decimals);
        // A small number must not look like zero, nor a large one fill the panel.
        let small = shown.abs() < 0.5 * 10f64.powi(-(self.decimals as i32));
        if shown != 0.0 && small || shown.abs() >= 1e5 {
            return super::short(shown);
        }
        if self.decimals > 0 {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        text
    }

    /// A value in words, with its unit.
    pub(super) fn words(&self, value: f64) -> String {
        let words = format!("{} {}", self.number(value), self.beside(value));
        words.trim_end().to_owned()
    }

    /// The unit as it stands beside a value.
    pub(super) fn beside(&self, value: f64) -> &'static str {
        match self.one {
            Some(one) if self.number(value) == "1" => one,
            _ => self.name,
        }
    }

    /// The value that a person typed: a number with or without a unit, with a decimal point or a single comma.
    /// `None` if it is not understood.
    pub(super) fn parse(&self, typed: &str) -> Option<f64> {
        let typed = typed.trim().replace('−', "-").replace('\u{212b}', "å");
        let lower = typed.to_lowercase().replace('μ', "µ");
        // The longest start that is a number: "1e3" is one, "3 em" is 3 of something.
        let mut ends = lower.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
        let (number, rest) =
            ends.find_map(|end| Some((number_of(&lower[..end])?, lower[end..].trim())))?;
        let shown = if rest.is_empty() || rest == self.name.to_lowercase() {
            number
        } else {
            let (_, convert) = self.also.iter().find(|(name, _)| *name == rest)?;
            convert(number)
        };
        Some(shown / self.shown).filter(|value| value.is_finite())
    }
}

fn number_of(text: &str) -> Option<f64> {
    let text = text.trim();
    let starts = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',');
    // Words such as "inf" and "nan" are numbers to the parser, not to a person.
    if !text.starts_with(starts) || text.contains("inf") || text.contains("nan") {
        return None;
    }
    let decimal_comma = text.matches(',').count() == 1 && !text.contains('.');
    // "1,500" is fifteen hundred to one person and one and a half to another.
    let ambiguous = text
        .split_once(',')
        .is_some_and(|(_, rest)| rest.len() == 3 && rest.bytes().all(|b| b.is_ascii_digit()));
    if ambiguous {
        return None;
    }
    let text = if decimal_comma {
        text.replace(',', ".")
    } else {
        text.to_owned()
    };
    text.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_understood_as_people_write_them() {
        for (unit, typed, value) in [
            (NANOMETRES, "425 Å", 42.5),
            (NANOMETRES, "425\u{212b}", 42.5),
            (NANOMETRES, "42.5nm", 42.5),
            (NANOMETRES, "42,5", 42.5),
            (NANOMETRES, "0.04 µm", 40.0),
            (NANOMETRES, "0.04 μm", 40.0),
            (NANOMETRES, "4e-8 m", 40.0),
            (PERCENT, "60 %", 0.6),
            (PERCENT, "60", 0.6),
            (PPM, "0.04 %", 400.0),
            (TIMES, "250 %", 2.5),
            (TIMES, "3x", 3.0),
            (STOPS, "−1.5 stops", -1.5),
            (KELVIN, "27 °C", 300.15),
            (KELVIN, "80.6 °F", 300.15),
            (MILLIMETRES, "1 cm", 0.01),
            (METRES, "35 cm", 0.35),
            (HECTOPASCAL, "1013.25", 101_325.0),
            (HECTOPASCAL, "101325 Pa", 101_325.0),
            (HECTOPASCAL, "1 atm", 101_325.0),
            (COSINE, "-0.25", -0.25),
            (VOXELS, " .5 ", 0.5),
        ] {
            let parsed = unit.parse(typed);
            assert!(
                parsed.is_some_and(|parsed| (parsed - value).abs() < 1e-9 * value.abs()),
                "{typed}: {parsed:?}"
            );
        }
        for typed in [
            "", "nm", "12 lbs", "1e400", "inf", "nan", "1,2,3", "1,500", "--3", "12 nm nm",
        ] {
            assert_eq!(NANOMETRES.parse(typed), None, "{typed}");
        }
    }

    #[test]
    fn numbers_are_shown_in_few_digits_and_never_as_zero() {
        assert_eq!(PERCENT.words(0.6), "60 %");
        assert_eq!(NANOMETRES.words(21.25), "21.25 nm");
        assert_eq!(TIMES.words(1.0), "1 ×");
        assert_eq!(TIMES.number(1e-4), "1.00e-4");
        assert_eq!(TIMES.number(0.0), "0");
        assert_eq!(KELVIN.words(300.0), "300 K");
        assert_eq!(KELVIN.words(7.0003e8), "7.00e8 K");
        assert_eq!(HECTOPASCAL.words(101_325.0), "1013.25 hPa");
        assert_eq!(COSINE.words(0.5), "0.5");
        assert_eq!(VOXELS.words(1.0), "1 voxel");
        assert_eq!(VOXELS.words(1.5), "1.5 voxels");
    }
}
