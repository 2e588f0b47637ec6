//! The names of a range's pictures.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Where the picture of a frame goes: the last `####` in the name becomes its number, with as many digits at least; without
/// one the number stands before the ending, with `padding` digits at least: `fire.png` becomes `fire_0003.png`.
pub fn target(output: &Path, number: u64, padding: usize) -> PathBuf {
    let name = output.file_name().unwrap_or_default();
    if let Some((before, width, after)) = name.to_str().and_then(around_hashes) {
        return output.with_file_name(format!("{before}{number:0width$}{after}"));
    }
    let mut named = OsString::from(output.file_stem().unwrap_or_default());
    named.push(format!("_{number:0padding$}"));
    if let Some(ending) = output.extension() {
        named.push(".");
        named.push(ending);
    }
    output.with_file_name(named)
}

/// What stands before and after the last run of `#`, and how long that is.
fn around_hashes(name: &str) -> Option<(&str, usize, &str)> {
    let end = name.rfind('#')? + 1;
    let before = name[..end].trim_end_matches('#');
    Some((before, end - before.len(), &name[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_where_it_is_asked_for_or_before_the_ending() {
        for (output, number, expected) in [
            ("a#/fire.png", 3, "a#/fire_0003.png"),
            ("fire.v2.exr", 12345, "fire.v2_12345.exr"),
            ("fire_##.png", 3, "fire_03.png"),
            ("a##b.#####.exr", 42, "a##b.00042.exr"),
            ("#.png", 12, "12.png"),
        ] {
            assert_eq!(target(Path::new(output), number, 4), Path::new(expected));
        }
    }
}
