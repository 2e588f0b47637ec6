//! Which kind of file a picture becomes: its name's ending says it.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::png::Bits;

/// A picture's file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// The picture as it looks.
    Png(Bits),
    /// The light itself.
    Exr,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Png(Bits::Eight), Self::Png(Bits::Sixteen), Self::Exr];

    /// The format that a file's ending asks for, in capitals or not; a PNG with 8 bits. `None` for other endings.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| ending == OsStr::new(format.ending()))
    }

    /// The ending of its files, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png(_) => "png",
            Self::Exr => "exr",
        }
    }

    /// The name for a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Png(Bits::Eight) => "PNG 8 bit",
            Self::Png(Bits::Sixteen) => "PNG 16 bit",
            Self::Exr => "EXR",
        }
    }

    /// The path as one of this format's files: the ending of another format is replaced. Any other ending is part of
    /// the name, such as the number of a frame.
    pub fn name_file(self, path: &Path) -> PathBuf {
        match Self::of(path) {
            Some(format) if format.ending() == self.ending() => path.to_owned(),
            Some(_) => path.with_extension(self.ending()),
            None => path.with_added_extension(self.ending()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_tells_the_format_in_capitals_or_not() {
        let of = |path: &str| Format::of(Path::new(path));
        assert_eq!(of("a.PNG"), Some(Format::Png(Bits::Eight)));
        assert_eq!(of("b/a.b.exr"), Some(Format::Exr));
        for other in ["a.jpg", "png", ".png", "a.", ""] {
            assert_eq!(of(other), None, "{other}");
        }
    }

    #[test]
    fn another_format_takes_the_place_of_the_ending_but_not_of_a_part_of_the_name() {
        let named = |format: Format, path: &str| format.name_file(Path::new(path));
        let png = Format::Png(Bits::Sixteen);
        for (format, path, expected) in [
            (Format::Exr, "a/fire.png", "a/fire.exr"),
            (png, "fire.exr", "fire.png"),
            (png, "fire.PNG", "fire.PNG"),
            (Format::Exr, "fire.0022", "fire.0022.exr"),
            (png, "fire", "fire.png"),
        ] {
            assert_eq!(named(format, path), Path::new(expected), "{path}");
        }
    }
}
