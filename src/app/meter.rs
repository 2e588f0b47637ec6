//! Automatic exposure and white: measured when a volume is first seen, then kept, so that a slider that makes the
//! fire darker makes the picture darker.

use std::sync::Arc;

use crate::colour::display::View;
use crate::engine::{Generation, Picture};
use crate::render::Film;
use crate::render::develop::{Metering, ViewParams};
use crate::volume::Volume;

/// A picture whose brightest pixel is darker than this share of display white shows nothing.
const INVISIBLE: f64 = 1.0 / 512.0;

/// Holds what was measured.
#[derive(Default)]
pub(super) struct Meter {
    metering: Option<Metering>,
    /// The volume that it was measured on.
    volume: Option<Arc<Volume>>,
    /// The job whose first whole pass was judged last.
    judged: Option<Generation>,
}

impl Meter {
    /// Looks at a picture of `volume` of which at least one pass is whole: measures it if it is the first one, or
    /// if nothing could be seen otherwise.
    pub(super) fn follow(&mut self, volume: &Arc<Volume>, picture: &Picture) {
        if self.judged == picture.generation() {
            return;
        }
        self.judged = picture.generation();
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
            .is_some_and(|metering| peak_y(picture.film()) * metering.exposure > INVISIBLE);
        if !visible {
            self.measure(picture.film());
        }
    }

    /// Measures a film. A black one tells nothing: what was measured before stays.
    pub(super) fn measure(&mut self, film: &Film) {
        let metering = Metering::of(film);
        if metering.bright_y > 0.0 {
            self.metering = Some(metering);
        }
    }

    /// The view that a person set, over what was measured.
    pub(super) fn view(&self, params: &ViewParams) -> View {
        let nothing = Metering {
            exposure: 1.0,
            white_xyz: [0.0; 3],
            bright_y: 0.0,
        };
        self.metering.unwrap_or(nothing).view(params)
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
