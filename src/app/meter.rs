//! Automatic exposure and white: measured when a volume is first seen, then kept, so that a slider that makes the
//! fire darker makes the picture darker. And what is wrong with a film, in words.

use crate::colour::display::View;
use crate::engine::{Generation, Picture};
use crate::render::develop::{Metering, can_be_seen, flaws_of, is_too_dark};
use crate::render::{Film, Flaws};
use crate::scene::FlameParams;

/// Pictures with a shorter side, as while a window is being resized or unfolded, show too little to be judged.
const LEAST_SIDE: u32 = 32;

/// Looks at pictures. What it measures is the document's to keep.
#[derive(Default)]
pub(super) struct Meter {
    /// What was measured before it had its full resolution.
    coarse: Option<FlameParams>,
    /// The film that was looked through last: its job, and how many passes were whole.
    seen: Option<(Generation, usize)>,
    /// Whether it had its full resolution.
    full: bool,
    flaws: Flaws,
    /// Whether nothing on that film could be seen at any exposure.
    black: bool,
    /// Y of its brightest pixel.
    peak_y: f64,
}

impl Meter {
    /// Looks at a picture of a flame, of which at least one pass is whole, beside what is `known` of its volume. Gives
    /// what was measured, if nothing was known, or if what was known came from a coarse picture of the same flame and
    /// this is a full one: a still is measured so.
    pub(super) fn follow(
        &mut self,
        picture: &Picture,
        flame: &FlameParams,
        known: Option<Metering>,
    ) -> Option<Metering> {
        let generation = picture.generation()?;
        if picture.film().size().iter().any(|&side| side < LEAST_SIDE) {
            return None;
        }
        let done = picture.progress.done;
        if self.seen == Some((generation, done)) {
            return None;
        }
        self.seen = Some((generation, done));
        let mut whole = picture.progress.passes.iter().take(done);
        self.full = whole.any(|pass| pass.stride == 1);
        self.flaws = flaws_of(picture.film());
        self.peak_y = peak_y(picture.film());
        self.black = !can_be_seen(self.peak_y);

        let coarse = self.coarse.as_ref();
        let again = self.full && coarse.is_some_and(|known| known.gives_same_light_as(flame));
        // A black picture tells nothing of the fire to come.
        if self.black || !(known.is_none() || again) {
            return None;
        }
        self.coarse = (!self.full).then(|| flame.clone());
        Some(Metering::of(picture.film()))
    }

    /// What was measured stands, even if that was on a coarse picture.
    pub(super) fn settle(&mut self) {
        self.coarse = None;
    }

    /// Whether what was measured last was measured on a coarse picture.
    pub(super) fn is_coarse(&self) -> bool {
        self.coarse.is_some()
    }

    /// What a film is measured to be, if it is not black; it stands whatever becomes of the film.
    pub(super) fn measured(&mut self, film: &Film) -> Option<Metering> {
        self.coarse = None;
        Some(Metering::of(film)).filter(|metering| !metering.is_black())
    }

    /// What is wrong with the picture that was followed last.
    pub(super) fn flaws(&self) -> &Flaws {
        &self.flaws
    }

    /// Whether the picture of this job has its full resolution and is black at any exposure.
    pub(super) fn is_black(&self, job: Generation) -> bool {
        self.black && self.full && self.seen.is_some_and(|(seen, _)| seen == job)
    }

    /// Whether the film that was followed last could be seen, but not with this view.
    pub(super) fn is_underexposed(&self, view: &View) -> bool {
        self.full && !self.black && is_too_dark(self.peak_y * view.exposure)
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
            taken: Vec::new(),
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
        assert!(spoilt.contains("column 1, row 0"), "{spoilt}");
    }
}
