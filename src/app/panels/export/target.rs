//! Where an export goes: a path that is typed or chosen, whose ending is the format.

use std::path::PathBuf;

use egui::Context;
use rfd::FileDialog;

use crate::app::files::{Asked, paths_of};
use crate::app::panels::believed::Believed;
use crate::app::words::name_of;
use crate::export::Format;
use crate::export::png::Bits;

/// The path of an export.
#[derive(Debug, Default)]
pub(super) struct Target {
    /// What is in the field.
    pub(super) text: String,
    /// The volume that it was named after.
    named_after: Option<Vec<PathBuf>>,
    /// Bits of a PNG: its ending does not tell them.
    bits: Bits,
    dialog: Asked,
    /// Whether there is a file, and whether an export ran then, which may have made it.
    looked_up: Believed<(PathBuf, bool), bool>,
}

impl Target {
    /// Names the picture after a volume, unless it was already.
    pub(super) fn name_after(&mut self, sources: &[PathBuf]) {
        if self.named_after.as_deref() == Some(sources) {
            return;
        }
        self.named_after = Some(sources.to_vec());
        let stem = sources.first().and_then(|path| path.file_stem());
        let stem = stem.map_or("torch".into(), |stem| stem.to_string_lossy());
        let ending = self.format().unwrap_or(Format::ALL[0]).ending();
        self.text = format!("{stem}.{ending}");
    }

    /// The path as it is typed.
    fn path(&self) -> Option<PathBuf> {
        paths_of(&self.text).into_iter().next()
    }

    /// The format that is asked for, if it is one.
    pub(super) fn format(&self) -> Option<Format> {
        Some(match Format::of(&self.path()?)? {
            Format::Png(_) => Format::Png(self.bits),
            Format::Exr => Format::Exr,
        })
    }

    /// The file to write and its format; `None` if the name is not right.
    pub(super) fn file(&self) -> Option<(PathBuf, Format)> {
        Some((self.path()?, self.format()?))
    }

    /// Asks for a format: the name gets its ending.
    pub(super) fn set_format(&mut self, format: Format) {
        if let Format::Png(bits) = format {
            self.bits = bits;
        }
        if let Some(path) = self.path() {
            self.text = format.name_file(&path).display().to_string();
        }
    }

    /// Why nothing can be written by this name, or chosen.
    pub(super) fn problem(&self) -> Option<&'static str> {
        if self.format().is_none() {
            Some("The name must end with .png or .exr.")
        } else if self.dialog.has_none() {
            Some("This desktop offers no file dialog: type a path.")
        } else {
            None
        }
    }

    /// The whole path, for a person.
    pub(super) fn whereabouts(&self) -> String {
        let path = self.path().unwrap_or_default();
        let whole = std::path::absolute(&path).unwrap_or(path);
        format!("The file to write: {}", whole.display())
    }

    /// The file's name, if it exists.
    pub(super) fn existing(&mut self, running: bool) -> Option<String> {
        let path = self.path()?;
        let name = name_of(&path);
        let exists = |(path, _): &(PathBuf, bool)| path.exists();
        (*self.looked_up.of((path, running), exists)).then_some(name)
    }

    /// Asks with the desktop's dialog, on a thread of its own.
    pub(super) fn ask(&mut self, ctx: &Context) {
        let dialog = FileDialog::new()
            .set_title("Export the picture")
            .add_filter("Pictures", &["png", "exr"]);
        let near = self.path().and_then(|path| std::path::absolute(path).ok());
        self.dialog
            .ask(dialog, FileDialog::save_file, near.as_deref(), ctx);
    }

    /// Takes in what was chosen.
    pub(super) fn receive(&mut self) {
        if let Some(path) = self.dialog.answered() {
            // Some dialogs leave the ending to the program.
            let format = Format::of(&path).or(self.format());
            let path = format.map_or(path.clone(), |format| format.name_file(&path));
            self.text = path.display().to_string();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_named_after_its_volume_until_a_person_names_it() {
        let mut target = Target::default();
        target.name_after(&[]);
        assert_eq!(target.text, "torch.png");
        target.text = "mine.exr".to_owned();
        target.name_after(&[]);
        assert_eq!(target.text, "mine.exr");
        target.name_after(&[PathBuf::from("a/fire.vdb"), PathBuf::from("b.vdb")]);
        assert_eq!(target.text, "fire.exr");
    }

    #[test]
    fn the_ending_and_the_format_are_one_thing() {
        let mut target = Target {
            text: "a/fire.png".to_owned(),
            ..Target::default()
        };
        for (format, text) in [
            (Format::Png(Bits::Sixteen), "a/fire.png"),
            (Format::Exr, "a/fire.exr"),
            (Format::Png(Bits::Eight), "a/fire.png"),
        ] {
            target.set_format(format);
            assert_eq!(
                (target.text.as_str(), target.format()),
                (text, Some(format))
            );
        }
        target.text = "fire.jpg".to_owned();
        assert!(target.file().is_none() && target.problem().is_some());
        target.set_format(Format::Exr);
        assert_eq!(target.text, "fire.jpg.exr");
        target.text = "  ".to_owned();
        assert!(target.file().is_none() && target.problem().is_some());
    }

    #[test]
    fn a_path_that_cannot_be_shown_is_not_changed_by_being_shown() {
        let mut target = Target {
            text: "\"/a b/fire.png\"".to_owned(),
            ..Target::default()
        };
        assert_eq!(
            target.file().map(|(path, _)| path),
            Some("/a b/fire.png".into())
        );
        target.set_format(Format::Exr);
        assert_eq!(target.text, "/a b/fire.exr");
    }
}
