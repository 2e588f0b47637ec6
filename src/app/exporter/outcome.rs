//! What became of an export, and how that is said.

use std::path::PathBuf;

use super::Counts;
use crate::app::words::name_of;
use crate::render::Flaws;

/// What became of an export.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) enum Outcome {
    /// The file is there.
    Done {
        /// The file.
        path: PathBuf,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Wall-clock time of everything.
        seconds: f64,
        /// Everything assumed or not faithful.
        flaws: Flaws,
    },
    /// All pictures of a range were tried.
    Range {
        /// What became of them.
        counts: Counts,
        /// Wall-clock time of everything.
        seconds: f64,
        /// Everything assumed or not faithful in any of them.
        flaws: Flaws,
    },
    /// Nothing was written, or no more of a range, and why.
    Failed(String),
    /// Nothing was written, as was wished.
    Cancelled,
    /// A range was ended, as was wished; frames that are done stay.
    Stopped,
}

impl Outcome {
    /// In one line.
    pub(in crate::app) fn in_words(&self) -> String {
        match self {
            Self::Done {
                path,
                size: [width, height],
                seconds,
                ..
            } => {
                let name = name_of(path);
                format!("{name} written, {width} × {height}, {seconds:.1} s")
            }
            Self::Range {
                counts, seconds, ..
            } => {
                let Counts {
                    written,
                    kept,
                    failed,
                } = counts;
                let failed = match failed.len() {
                    0 => String::new(),
                    some => format!(", {some} failed"),
                };
                let plural = if *written == 1 { "" } else { "s" };
                format!("{written} picture{plural} written, {kept} kept, {seconds:.1} s{failed}")
            }
            Self::Failed(words) => words.clone(),
            Self::Stopped => "Export stopped; pictures that are written stay".to_owned(),
            Self::Cancelled => "Export cancelled; nothing was written".to_owned(),
        }
    }

    /// What more there is to be said: where it is, everything that was not faithful, and which frames failed.
    pub(in crate::app) fn in_full(&self) -> String {
        let (first, flaws, failed) = match self {
            Self::Done { path, flaws, .. } => (path.display().to_string(), Some(flaws), &[][..]),
            Self::Range { counts, flaws, .. } => {
                (self.in_words(), Some(flaws), counts.failed.as_slice())
            }
            Self::Failed(_) | Self::Stopped | Self::Cancelled => (self.in_words(), None, &[][..]),
        };
        let flaws = flaws.into_iter().flat_map(Flaws::iter);
        let more = flaws.chain(failed.iter().map(String::as_str));
        more.fold(first, |all, one| format!("{all}\n• {one}"))
    }

    /// Whether it went as was wished.
    pub(in crate::app) fn went_well(&self) -> bool {
        match self {
            Self::Range { counts, .. } => counts.failed.is_empty(),
            Self::Failed(_) => false,
            Self::Done { .. } | Self::Stopped | Self::Cancelled => true,
        }
    }
}
