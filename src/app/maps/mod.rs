//! Maps over the picture: what each pixel costs, and by how much it is off. In false colours whose legend is always the same.

mod against;
mod scale;

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Color32, ColorImage, Context, TextureHandle, TextureId, TextureOptions};

use self::against::Against;
use self::scale::Scale;
use super::background::Wake;
use crate::engine::{Packed, Picture};
use crate::project::Job;
use crate::study::{Error, Pilot};

/// While tiles come in, a map is drawn anew this often: it takes as long as it takes to look through the picture, and drawing takes
/// its time from what works behind.
pub(super) const ANEW: Duration = Duration::from_millis(250);

/// What is mapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Map {
    /// Samples of the medium that each pixel takes.
    Cost,
    /// How far each pixel is from the reference.
    Error,
}

impl Map {
    fn scale(self) -> &'static Scale {
        match self {
            Self::Cost => &scale::SAMPLES,
            Self::Error => &scale::ERROR,
        }
    }
}

/// The map on show, if one is.
pub(super) struct Maps {
    shown: Option<Map>,
    drawn: Option<Drawn>,
    against: Against,
}

/// A map as the graphics card has it.
struct Drawn {
    map: Map,
    /// Which state of what it shows.
    version: u64,
    at: Instant,
    texture: TextureHandle,
}

/// The picture that a map is of.
pub(super) struct About<'a> {
    pub(super) picture: &'a Picture,
    /// Its job, if the picture is of the one that was submitted last.
    pub(super) job: Option<&'a Job>,
    /// Whether nothing is to be seen in it.
    pub(super) sees_nothing: bool,
    /// What is known of its scene.
    pub(super) pilot: Option<&'a Arc<Pilot>>,
    /// Its scene, as the engine has packed it.
    pub(super) packed: Option<Packed>,
}

impl Maps {
    /// Calls `wake`, from any thread, when there is something new.
    pub(super) fn new(wake: Wake) -> Self {
        Self {
            shown: None,
            drawn: None,
            against: Against::new(wake),
        }
    }

    /// Shows a map, or takes it away if it is that.
    pub(super) fn toggle(&mut self, map: Map) {
        self.shown = (self.shown != Some(map)).then_some(map);
        self.drawn = None;
    }

    /// Takes the map away, if there is one. True if there was.
    pub(super) fn close(&mut self) -> bool {
        self.drawn = None;
        self.shown.take().is_some()
    }

    /// Which map is on show.
    pub(super) fn shown(&self) -> Option<Map> {
        self.shown
    }

    /// How far the whole picture of a job is from its reference, where that has been measured.
    pub(super) fn measured(&self, job: &Job, picture: &Picture) -> Option<Error> {
        self.against.measured(job, picture)
    }

    /// The legend's title and rows, least first, and what is to be said beside it.
    pub(super) fn legend(&self, picture: &Picture) -> Option<(String, Vec<(Color32, String)>)> {
        let map = self.shown?;
        let title = match map {
            Map::Cost => map.scale().title.to_owned(),
            Map::Error => format!(
                "{}; {}",
                map.scale().title,
                self.against.progress_words(picture)
            ),
        };
        Some((title, map.scale().rows()))
    }

    /// Takes in what was found, and has the reference rendered where somebody looks at the error.
    pub(super) fn follow(&mut self, about: &About<'_>) {
        let wanted = self.shown == Some(Map::Error);
        self.against.follow(about, wanted);
    }

    /// The map as a picture of its own, to be laid over the picture.
    pub(super) fn texture(&mut self, ctx: &Context, about: &About<'_>) -> Option<TextureId> {
        let map = self.shown?;
        // An error is that of the picture it was found for, not of one that a camera has left behind.
        if map == Map::Error && about.job.is_none() {
            self.drawn = None;
            return None;
        }
        let version = match map {
            Map::Cost => about.picture.version,
            Map::Error => self.against.version(),
        };
        if let Some(drawn) = &self.drawn
            && drawn.map == map
            && (drawn.version == version || drawn.at.elapsed() < ANEW)
        {
            if drawn.version != version {
                ctx.request_repaint_after(ANEW);
            }
            return Some(drawn.texture.id());
        }
        let values: &[f32] = match map {
            Map::Cost => about.picture.samples(),
            Map::Error => self.against.values(about.picture)?,
        };
        let most = ctx.input(|input| input.max_texture_side);
        let image = image(map.scale(), values, about.picture.film().size(), most);
        let texture = ctx.load_texture("map", image, TextureOptions::NEAREST);
        let id = texture.id();
        self.drawn = Some(Drawn {
            map,
            version,
            at: Instant::now(),
            texture,
        });
        Some(id)
    }
}

/// Values in their colours: every pixel, or where a side has more than `most` every second, third and so on.
fn image(scale: &Scale, values: &[f32], size: [u32; 2], most: usize) -> ColorImage {
    let [width, height] = size.map(|side| side as usize);
    let every = width.max(height).div_ceil(most.max(1)).max(1);
    let rows = (0..height).step_by(every);
    let pixels = rows.flat_map(|y| (0..width).step_by(every).map(move |x| y * width + x));
    let colour = |at| scale.colour(values.get(at).copied().unwrap_or(f32::NAN));
    ColorImage::new(
        [width.div_ceil(every), height.div_ceil(every)],
        pixels.map(colour).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_too_large_for_the_card_has_every_second_pixel() {
        let values: Vec<f32> = (0..15).map(|i| i as f32).collect();
        let whole = image(&scale::SAMPLES, &values, [5, 3], 8);
        assert_eq!(whole.size, [5, 3]);
        let half = image(&scale::SAMPLES, &values, [5, 3], 4);
        assert_eq!(half.size, [3, 2]);
        let expected = [0.0, 2.0, 4.0, 10.0, 12.0, 14.0].map(|v| scale::SAMPLES.colour(v));
        assert_eq!(half.pixels, expected);
    }
}
