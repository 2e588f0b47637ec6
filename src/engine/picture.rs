//! The picture that a window shows, put together from updates: the old one stays until the first pass of the new
//! one is whole.

use super::progress::Progress;
use super::{Generation, News, Update};
use crate::render::{Film, Tile};

/// The film on show and how far it is.
#[derive(Debug)]
pub struct Picture {
    shown: Sheet,
    /// Tiles of the newest job, while its first pass is not whole.
    coming: Option<Sheet>,
    generation: Option<Generation>,
    /// How far the newest job is.
    pub progress: Progress,
    /// What each pixel of the newest job weighs in the share of a pass: what it took in the passes before.
    weights: Vec<f32>,
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

impl Picture {
    /// A black picture.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            shown: Sheet::new(size),
            coming: None,
            generation: None,
            progress: Progress::default(),
            weights: Vec::new(),
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
            self.weights.clear();
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
            News::PassBegun { since_submit } => progress.begun.push(since_submit),
            News::Tile(tile) => {
                progress.rays_in_pass += tile.pixels.len() as u64;
                progress.rays += tile.pixels.len() as u64;
                progress.samples += tile.samples();
                progress.share_of_pass += if self.weights.is_empty() {
                    tile.pixels.len() as f64 / progress.rays_of_pass.max(1) as f64
                } else {
                    weight_of(&tile, &self.weights, self.shown.film.size())
                };
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
                (progress.rays_in_pass, progress.share_of_pass) = (0, 0.0);
                if let Some(coming) = self.coming.take() {
                    self.shown = coming;
                    self.version += 1;
                }
                let size = self.shown.film.size();
                let next = progress.passes.get(progress.done);
                progress.rays_of_pass = next.map_or(0, |pass| pass.rays(size));
                // A region's tiles are a part of the picture's weight.
                self.weights = match next.filter(|pass| pass.region.is_none()) {
                    Some(_) => weights(&self.shown.samples),
                    None => Vec::new(),
                };
            }
            News::Finished => progress.finished = true,
            News::Costs(costs) => progress.costs = Some(costs),
            News::Failed(words) => progress.failure = Some(words),
        }
    }
}

/// What a pixel without samples takes of a fine pass, in samples of the coarse passes, of which a pixel has a few: next to
/// nothing.
const RAY: f32 = 0.05;

/// The share of a picture's work that each pixel is, where it took so many samples.
fn weights(samples: &[f32]) -> Vec<f32> {
    let all: f64 = samples.iter().map(|&it| f64::from(it + RAY)).sum();
    samples.iter().map(|it| (it + RAY) / all as f32).collect()
}

/// The share of a picture's work that the pixels below a tile are.
fn weight_of(tile: &Tile, weights: &[f32], size: [u32; 2]) -> f64 {
    let [across, down] = tile.covers(size);
    let rows = weights.chunks(size[0] as usize);
    let rows = rows.take(down.end).skip(down.start);
    rows.flat_map(|row| &row[across.clone()])
        .map(|&it| f64::from(it))
        .sum()
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
        let [across, down] = tile.covers(size);
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
