//! The picture that a window shows, put together from updates: the old one stays until the first pass of the new
//! one is whole.

use std::time::Duration;

use super::{Generation, News, Update};
use crate::render::{Film, Flaws, Pass};

/// The film on show and how far it is.
#[derive(Debug)]
pub struct Picture {
    shown: Film,
    /// Tiles of the newest job, while its first pass is not whole.
    coming: Option<Film>,
    generation: Option<Generation>,
    /// How far the newest job is.
    pub progress: Progress,
    /// Rises whenever the shown film changes.
    pub version: u64,
}

/// How far a job is.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    /// Its passes.
    pub passes: Vec<Pass>,
    /// Passes that are whole.
    pub done: usize,
    /// Rays of the running pass that are on the film.
    pub rays_in_pass: u64,
    /// Rays of the running pass altogether.
    pub rays_of_pass: u64,
    /// All rays so far.
    pub rays: u64,
    /// All samples of the medium so far.
    pub samples: u64,
    /// Time from the submit to the first whole pass.
    pub first_picture: Option<Duration>,
    /// Time from the submit to the last whole pass.
    pub elapsed: Duration,
    /// Whether every pass is whole.
    pub finished: bool,
    /// What the settings cannot show faithfully.
    pub flaws: Flaws,
    /// What went wrong, if something did.
    pub failure: Option<String>,
}

impl Picture {
    /// A black picture.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            shown: Film::new(size),
            coming: None,
            generation: None,
            progress: Progress::default(),
            version: 0,
        }
    }

    /// The film to show.
    pub fn film(&self) -> &Film {
        &self.shown
    }

    /// The job whose news were taken last.
    pub fn generation(&self) -> Option<Generation> {
        self.generation
    }

    /// Takes one update. Updates of a job older than the newest are not taken.
    pub fn take(&mut self, update: Update) {
        if self
            .generation
            .is_some_and(|newest| update.generation < newest)
        {
            return;
        }
        if self.generation != Some(update.generation) {
            self.generation = Some(update.generation);
            self.progress = Progress::default();
            self.coming = None;
        }
        let progress = &mut self.progress;
        match update.news {
            News::Started {
                passes,
                size,
                flaws,
                ..
            } => {
                progress.flaws = flaws;
                progress.rays_of_pass = passes.first().map_or(0, |pass| rays_of(pass, size));
                progress.passes = passes;
                self.coming = Some(Film::new(size));
            }
            News::Tile(tile) => {
                progress.rays_in_pass += tile.pixels.len() as u64;
                progress.rays += tile.pixels.len() as u64;
                progress.samples += tile.samples;
                if let Some(coming) = &mut self.coming {
                    coming.merge(&tile);
                } else {
                    self.shown.merge(&tile);
                    self.version += 1;
                }
            }
            News::PassDone {
                index,
                since_submit,
                ..
            } => {
                progress.done = index + 1;
                progress.elapsed = since_submit;
                progress.first_picture.get_or_insert(since_submit);
                progress.rays_in_pass = 0;
                if let Some(coming) = self.coming.take() {
                    self.shown = coming;
                    self.version += 1;
                }
                let size = self.shown.size();
                progress.rays_of_pass = progress
                    .passes
                    .get(progress.done)
                    .map_or(0, |pass| rays_of(pass, size));
            }
            News::Finished => progress.finished = true,
            News::Failed(words) => progress.failure = Some(words),
        }
    }
}

fn rays_of(pass: &Pass, size: [u32; 2]) -> u64 {
    size.iter()
        .map(|side| u64::from(side.div_ceil(pass.stride)))
        .product()
}
