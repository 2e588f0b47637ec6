//! The picture that a window shows, put together from updates: the old one stays until the first pass of the new
//! one is whole.

use std::time::Duration;

use super::{Generation, News, Update};
use crate::render::costs::Cost;
use crate::render::plan::Decision;
use crate::render::{Facts, Film, Flaws, Pass, Tile};

/// The film on show and how far it is.
#[derive(Debug)]
pub struct Picture {
    shown: Sheet,
    /// Tiles of the newest job, while its first pass is not whole.
    coming: Option<Sheet>,
    generation: Option<Generation>,
    /// How far the newest job is.
    pub progress: Progress,
    /// Rises whenever the shown film changes.
    pub version: u64,
}

/// A film, and how coarse each of its pixels is.
#[derive(Debug)]
struct Sheet {
    film: Film,
    strides: Vec<u8>,
    /// Samples that each pixel took so far.
    samples: Vec<f32>,
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
    /// Which effects are computed, and why.
    pub decisions: Vec<Decision>,
    /// What has been found out about the picture so far.
    pub facts: Facts,
    /// What effects cost, once that is measured.
    pub costs: Option<Vec<Cost>>,
    /// What went wrong, if something did.
    pub failure: Option<String>,
}

impl Picture {
    /// A black picture.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            shown: Sheet::new(size),
            coming: None,
            generation: None,
            progress: Progress::default(),
            version: 0,
        }
    }

    /// The film to show.
    pub fn film(&self) -> &Film {
        &self.shown.film
    }

    /// For each pixel of the film, row by row, the stride of the pass that wrote it: 1 where it has a ray of its own.
    pub fn strides(&self) -> &[u8] {
        &self.shown.strides
    }

    /// For each pixel of the film, row by row, the samples of the medium that it took so far: those of a packet of rays, which
    /// march together, evenly spread over its pixels.
    pub fn samples(&self) -> &[f32] {
        &self.shown.samples
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
        }
        let progress = &mut self.progress;
        match update.news {
            News::Started {
                passes,
                size,
                flaws,
                decisions,
                ..
            } => {
                progress.flaws = flaws;
                progress.decisions = decisions;
                progress.rays_of_pass = passes.first().map_or(0, |pass| pass.rays(size));
                progress.passes = passes;
                // The first pass writes every pixel, so a sheet that was not finished serves again.
                let again = self.coming.take();
                let again = again.filter(|sheet| sheet.film.size() == size);
                let again = again.map(Sheet::with_nothing_taken);
                self.coming = Some(again.unwrap_or_else(|| Sheet::new(size)));
            }
            News::Tile(tile) => {
                progress.rays_in_pass += tile.pixels.len() as u64;
                progress.rays += tile.pixels.len() as u64;
                progress.samples += tile.samples();
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
                facts,
                ..
            } => {
                progress.facts = facts;
                progress.done = index + 1;
                progress.elapsed = since_submit;
                progress.first_picture.get_or_insert(since_submit);
                progress.rays_in_pass = 0;
                if let Some(coming) = self.coming.take() {
                    self.shown = coming;
                    self.version += 1;
                }
                let size = self.shown.film.size();
                progress.rays_of_pass = progress
                    .passes
                    .get(progress.done)
                    .map_or(0, |pass| pass.rays(size));
            }
            News::Finished => progress.finished = true,
            News::Costs(costs) => progress.costs = Some(costs),
            News::Failed(words) => progress.failure = Some(words),
        }
    }
}

impl Sheet {
    fn new(size: [u32; 2]) -> Self {
        let film = Film::new(size);
        let strides = vec![1; film.pixels().len()];
        let samples = vec![0.0; film.pixels().len()];
        Self {
            film,
            strides,
            samples,
        }
    }

    fn with_nothing_taken(mut self) -> Self {
        self.samples.fill(0.0);
        self
    }

    /// Lays a tile on the film, and notes its stride and what it took for the pixels that it covers.
    fn merge(&mut self, tile: &Tile) {
        self.film.merge(tile);
        self.count(tile);
        let size = self.film.size();
        let [across, down] = [0, 1].map(|axis| {
            let end = tile.origin[axis] + tile.size[axis] * tile.stride;
            tile.origin[axis] as usize..end.min(size[axis]) as usize
        });
        let stride = u8::try_from(tile.stride).unwrap_or(u8::MAX);
        for row in self
            .strides
            .chunks_mut(size[0] as usize)
            .take(down.end)
            .skip(down.start)
        {
            row[across.clone()].fill(stride);
        }
    }

    /// Adds what a tile took to its pixels: each ray's samples evenly to the pixels that it stands for.
    fn count(&mut self, tile: &Tile) {
        let size = self.film.size();
        for (row, column) in (0..tile.size[1]).flat_map(|y| (0..tile.size[0]).map(move |x| (y, x)))
        {
            let [across, down] = tile.block(column, row, size);
            let each = tile.samples_of(column, row) / (across.len() * down.len()).max(1) as f32;
            for y in down {
                let row = y * size[0] as usize;
                for samples in &mut self.samples[row + across.start..row + across.end] {
                    *samples += each;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Pixel;

    #[test]
    fn strides_follow_the_tiles_up_to_the_edge() {
        let tile = |stride: u32, origin: [u32; 2], size: [u32; 2]| Tile {
            stride,
            sample: 0,
            origin,
            size,
            pixels: vec![Pixel::default(); (size[0] * size[1]) as usize],
            taken: Vec::new(),
        };
        let mut sheet = Sheet::new([6, 3]);
        sheet.merge(&tile(4, [0, 0], [2, 1]));
        assert_eq!(sheet.strides, [4; 18]);
        // Each ray's samples are spread over the pixels of its block that are in the picture.
        let mut counted = tile(4, [0, 0], [2, 1]);
        counted.taken = vec![48];
        sheet.merge(&counted);
        let ends = [sheet.samples[0], sheet.samples[17]];
        assert_eq!(ends, [24.0 / 12.0, 24.0 / 6.0]);
        assert_eq!(sheet.samples.iter().sum::<f32>(), 48.0);
        sheet.merge(&tile(2, [4, 2], [1, 1]));
        sheet.merge(&tile(1, [1, 0], [2, 2]));
        let wanted = [
            [4, 1, 1, 4, 4, 4], //
            [4, 1, 1, 4, 4, 4],
            [4, 4, 4, 4, 2, 2],
        ];
        assert_eq!(sheet.strides, wanted.concat());
    }
}
