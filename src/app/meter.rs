//! Automatic exposure and white: measured when a volume is first seen, then kept, so that a slider that makes the
//! fire darker makes the picture darker. And what is wrong with a film, in words.

use std::sync::Arc;

use crate::colour::display::View;
use crate::engine::{Generation, Picture};
use crate::render::develop::{Metering, ViewParams, flaws_of};
use crate::render::{Film, Flaws};
use crate::volume::Volume;

/// A picture whose brightest pixel is darker than this share of display white shows nothing.
const INVISIBLE: f64 = 1.0 / 512.0;

/// Pictures with a shorter side, as while a window is being resized or unfolded, show too little to be judged.
const LEAST_SIDE: u32 = 32;

/// Holds what was measured.
#[derive(Default)]
pub(super) struct Meter {
    metering: Option<Metering>,
    /// The volume that it was measured on.
    volume: Option<Arc<Volume>>,
    /// The job whose first whole pass was judged last.
    judged: Option<Generation>,
    /// The job that was measured before it had its full resolution.
    coarse: Option<Generation>,
    /// The film that was looked through last: its job, and how many passes were whole.
    seen: Option<(Generation, usize)>,
    flaws: Flaws,
    /// Whether nothing on that film could be seen at any exposure.
    black: bool,
    /// Y of its brightest pixel.
    peak_y: f64,
}

impl Meter {
    /// Looks at a picture of `volume` of which at least one pass is whole: measures it if it is the first one, or
    /// if nothing could be seen otherwise. A coarse picture that was measured is measured again when it has become
    /// a full one, because a still is.
    pub(super) fn follow(&mut self, volume: &Arc<Volume>, picture: &Picture) {
        let Some(generation) = picture.generation() else {
            return;
        };
        if picture.film().size().iter().any(|&side| side < LEAST_SIDE) {
            return;
        }
        let done = picture.progress.done;
        if self.seen != Some((generation, done)) {
            self.seen = Some((generation, done));
            self.flaws = flaws_of(picture.film());
            self.black = Metering::of(picture.film()).is_black();
            self.peak_y = peak_y(picture.film());
        }
        let mut whole = picture.progress.passes.iter().take(done);
        let full = whole.any(|pass| pass.stride == 1);
        if self.judged == Some(generation) {
            if full && self.coarse == Some(generation) {
                self.measure(picture.film());
            }
            return;
        }
        self.judged = Some(generation);
        if !self
            .volume
            .as_ref()
            .is_some_and(|known| Arc::ptr_eq(known, volume))
        {
            self.volume = Some(Arc::clone(volume));
            self.metering = None;
        }
        let visible = self
            .metering
            .is_some_and(|metering| self.peak_y * metering.exposure > INVISIBLE);
        // What was measured on an older job stays: it is what the sliders' effect is judged by.
        self.coarse = None;
        if !visible {
            self.measure(picture.film());
            self.coarse = (!full).then_some(generation);
        }
    }

    /// What is wrong with the picture that was followed last.
    pub(super) fn flaws(&self) -> &Flaws {
        &self.flaws
    }

    /// Whether the film that was followed last is black at any exposure.
    pub(super) fn is_black(&self) -> bool {
        self.black
    }

    /// Whether the film that was followed last could be seen, but not with this view.
    pub(super) fn is_underexposed(&self, view: &View) -> bool {
        self.seen.is_some() && !self.black && self.peak_y * view.exposure < INVISIBLE
    }

    /// Measures a film. A black one tells nothing: what was measured before stays.
    pub(super) fn measure(&mut self, film: &Film) {
        self.coarse = None;
        let metering = Metering::of(film);
        if metering.bright_y > 0.0 {
            self.metering = Some(metering);
        }
    }

    /// What was measured; of a picture that was black so far, that it is.
    pub(super) fn metering(&self) -> Metering {
        self.metering.unwrap_or(Metering {
            exposure: 1.0,
            white_xyz: [0.0; 3],
            bright_y: 0.0,
        })
    }

    /// The view that a person set, over what was measured.
    pub(super) fn view(&self, params: &ViewParams) -> View {
        self.metering().view(params)
    }
}

/// Y of the brightest pixel.
fn peak_y(film: &Film) -> f64 {
    let finite = film
        .pixels()
        .iter()
        .map(|pixel| pixel.xyz[1])
        .filter(|y| y.is_finite());
    f64::from(finite.fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Pixel;
    use crate::render::Tile;

    fn film(pixels: [[f32; 3]; 2]) -> Film {
        let mut film = Film::new([2, 1]);
        film.merge(&Tile {
            stride: 1,
            sample: 0,
            origin: [0, 0],
            size: [2, 1],
            pixels: pixels
                .map(|xyz| Pixel {
                    xyz,
                    opacity: [0.0; 3],
                })
                .to_vec(),
            samples: 0,
        });
        film
    }

    #[test]
    fn spoilt_pixels_are_told() {
        let words = |pixels| {
            let film = film(pixels);
            let flaws = flaws_of(&film);
            flaws.iter().collect::<Vec<_>>().join("; ")
        };
        assert_eq!(words([[1.0; 3], [0.0; 3]]), "");
        let spoilt = words([[1.0; 3], [f32::NAN, 1.0, 1.0]]);
        assert!(spoilt.starts_with("1 pixels are no numbers"), "{spoilt}");
    }
}
