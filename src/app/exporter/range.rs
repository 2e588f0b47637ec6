//! A range of frames, or one fire from all around, exported by the road of the command line.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::NotExported;
use super::order::Wish;
use crate::app::Document;
use crate::export::Format;
use crate::project::Project;
use crate::range::{self, Outcome, RangeError, Shots, Taken};
use crate::render::develop::Metering;
use crate::render::{Cancel, Effects, Flaws, Gate};
use crate::sequence::Sequence;

/// Pictures to be written.
#[derive(Debug, Clone)]
pub(in crate::app) struct RangeOrder {
    /// What is set, with what the window holds over its frames.
    pub(super) project: Project,
    pub(super) shots: Shots,
    /// Where to; see [`range::target`].
    pub(super) output: PathBuf,
    pub(super) format: Format,
    /// What was assumed of the files where it is held now, in words.
    pub(super) assumed: Vec<String>,
}

/// What became of the pictures.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::app) struct Counts {
    /// Pictures that were made.
    pub(in crate::app) written: usize,
    /// Pictures that were there already.
    pub(in crate::app) kept: usize,
    /// Frames that have none, and why.
    pub(in crate::app) failed: Vec<String>,
}

/// The frames that a window plays, and what it holds over them.
pub(in crate::app) struct Playing {
    pub(in crate::app) sequence: Arc<Sequence>,
    pub(in crate::app) numbers: Vec<u64>,
    pub(in crate::app) current: u64,
    pub(in crate::app) assumed: Vec<String>,
}

impl Playing {
    /// The frames that play.
    pub(in crate::app) fn shots(&self) -> Shots {
        Shots::frames(&self.sequence, &self.numbers)
    }

    /// Where pictures of theirs go that are named after that of the frame on show.
    pub(in crate::app) fn output(&self, path: &Path) -> PathBuf {
        numbered(path, &self.sequence.padded(self.current))
    }
}

impl Wish {
    /// The order of all frames that play: seen from where the window sees them, with its brightness, its effects and its mapping
    /// of fields. `None` while nothing is shown.
    pub(in crate::app) fn range(
        self,
        document: &Document,
        playing: Playing,
        metering: Option<Metering>,
        on_show: Option<Effects>,
    ) -> Option<RangeOrder> {
        Some(RangeOrder {
            project: self.held(document, metering, on_show)?,
            shots: playing.shots(),
            output: playing.output(&self.path),
            format: self.format,
            assumed: playing.assumed,
        })
    }

    /// The order of so many views of what is on show, once round it from where the window sees it, with what was assumed of it
    /// before it was held. `None` while nothing is shown.
    pub(in crate::app) fn turntable(
        self,
        document: &Document,
        (views, assumed): (u32, Vec<String>),
        metering: Option<Metering>,
        on_show: Option<Effects>,
    ) -> Option<RangeOrder> {
        let sources = document.volume().map_or(&[][..], |volume| &volume.sources);
        Some(RangeOrder {
            project: self.held(document, metering, on_show)?,
            shots: Shots::turntable(sources, views),
            output: self.path,
            format: self.format,
            assumed,
        })
    }

    /// What is set, with what the window has measured and found where nothing is.
    fn held(
        &self,
        document: &Document,
        metering: Option<Metering>,
        on_show: Option<Effects>,
    ) -> Option<Project> {
        let mut project = self.project(document)?;
        Taken::of(&document.project, document.last_job()?).hold(&mut project);
        // What another frame or view calls for beside them is found when all are looked at.
        project.effects = on_show.map_or(project.effects, |shown| project.effects.computing(shown));
        if let Some(metering) = metering {
            project.view.hold(&metering);
        }
        Some(project)
    }
}

/// A name that ends with the number of the frame on show, with that of each frame in its place. Digits that are a part of a longer
/// number, or a lone one that belongs to a word as in `v2`, are no frame's.
fn numbered(path: &Path, current: &str) -> PathBuf {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let before = stem.and_then(|stem| stem.strip_suffix(current));
    let is_number = |before: &&str| {
        let last = before.chars().next_back();
        !last.is_some_and(|last| {
            last.is_ascii_digit() || current.len() == 1 && last.is_alphanumeric()
        })
    };
    let Some(before) = before.filter(is_number) else {
        return path.to_owned();
    };
    let name = format!("{before}{}", "#".repeat(current.len()));
    let named = path.with_file_name(name);
    match path.extension() {
        Some(ending) => named.with_added_extension(ending),
        None => named,
    }
}

/// Writes them, in the calling thread's rayon pool.
pub(super) fn export(
    order: RangeOrder,
    gate: &Gate,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<(Counts, Flaws), NotExported> {
    let stopped = |error| match error {
        RangeError::Cancelled => NotExported::Export(crate::export::ExportError::Cancelled),
        error => NotExported::Range(error),
    };
    // What is measured first takes about as long as a frame.
    let all = order.shots.len() as f64 + 1.0;
    let measuring = |share: f64| progress(share / all);
    let locked = range::lock(&order.project, &order.shots, cancel, &measuring);
    let locked = locked.map_err(stopped)?;
    let mut assumed = order.assumed;
    assumed.extend(locked.assumed);
    let order = range::Order {
        project: locked.project,
        shots: order.shots,
        output: order.output,
        format: order.format,
        assumed,
    };
    let done = std::sync::atomic::AtomicUsize::new(0);
    let order_of_all = std::sync::atomic::Ordering::Relaxed;
    let frames = |share: f64| progress((1.0 + done.load(order_of_all) as f64 + share) / all);
    let mut counts = Counts::default();
    let mut flaws = BTreeSet::new();
    let ended = range::write(&order, gate, cancel, &frames, &mut |ended| {
        match ended.outcome {
            Outcome::Written(made) => {
                counts.written += 1;
                flaws.extend(made.written.flaws.iter().map(String::from));
            }
            Outcome::Kept => counts.kept += 1,
            Outcome::Failed(error) => counts
                .failed
                .push(format!("frame {}: {error}", ended.number)),
        }
        done.fetch_add(1, order_of_all);
        frames(0.0);
    });
    ended.map_err(stopped)?;
    let mut told = Flaws::default();
    told.extend(flaws);
    Ok((counts, told))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_the_frame_on_show_becomes_that_of_each() {
        for (path, current, expected) in [
            ("a/fire_02.png", "02", "a/fire_##.png"),
            ("fire.0022.exr", "0022", "fire.####.exr"),
            ("fire.png", "02", "fire.png"),
            ("fire_2.png", "02", "fire_2.png"),
            ("fire_2.png", "2", "fire_#.png"),
            ("fire_12.png", "2", "fire_12.png"),
            ("final_v2.png", "2", "final_v2.png"),
            ("fire0002.png", "0002", "fire####.png"),
        ] {
            assert_eq!(numbered(Path::new(path), current), Path::new(expected));
        }
    }
}
