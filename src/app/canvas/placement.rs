//! Where the picture lies on the canvas and how large: fit, zoom and pan. Positions on the canvas are in screen pixels
//! from its upper left corner.

/// Least and greatest zoom, screen pixels for one film pixel: a sixteenth, and 64. A fit may go beyond.
const ZOOM: [f64; 2] = [1.0 / 16.0, 64.0];

/// A zoom so close to a power of two is that power, so that a zoom in and out again ends on whole pixels.
const CLOSE: f64 = 1e-4;

/// What a person chose: fit, or a zoom and which point of the film is in the middle of the canvas.
///
/// The point is kept as shares of the film's sides, so that it stays when the film gets another size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    /// `None` is fit.
    zoom: Option<f64>,
    /// 0 to 1 on each axis: so the picture cannot be lost.
    middle: [f64; 2],
}

/// How the pixels of a film lie on a canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping {
    /// Screen pixels for one film pixel, above 0.
    pub zoom: f64,
    /// Where the upper left corner of the film lies on the canvas, screen pixels.
    pub corner: [f64; 2],
    /// Width and height of the canvas, screen pixels.
    pub canvas: [u32; 2],
}

impl Mapping {
    /// Where a film of another size lies that is seen in the place of this one: as large as fits, in the middle.
    pub(super) fn for_another(self, this: [u32; 2], other: [u32; 2]) -> Self {
        let [this, other] = [this, other].map(|size| size.map(f64::from));
        let [across, down] = [0, 1].map(|axis| this[axis] / other[axis]);
        let zoom = self.zoom * across.min(down);
        let corner = [0, 1]
            .map(|axis| self.corner[axis] + 0.5 * (self.zoom * this[axis] - zoom * other[axis]));
        Self {
            zoom,
            corner,
            ..self
        }
    }
}

/// The sizes that a placement is about: film and canvas, in their own pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    pub(super) film: [u32; 2],
    pub(super) canvas: [u32; 2],
}

impl Default for Placement {
    fn default() -> Self {
        Self::FIT
    }
}

impl Placement {
    /// The whole picture, as large as the canvas lets it be.
    pub(super) const FIT: Self = Self {
        zoom: None,
        middle: [0.5; 2],
    };

    /// Whether the picture follows the size of the canvas.
    pub(super) fn is_fit(self) -> bool {
        self.zoom.is_none()
    }

    /// Where the film lies. Where zoom or its inverse is whole, the corner is moved to a whole pixel, so that the
    /// edges of film and screen pixels fall together.
    pub(super) fn mapping(self, sizes: Sizes) -> Mapping {
        let zoom = self.zoom_on(sizes);
        let whole = zoom.fract() == 0.0 || zoom.recip().fract() == 0.0;
        let corner = [0, 1].map(|axis| {
            let corner =
                sizes.middle(axis) - self.middle[axis] * zoom * f64::from(sizes.film[axis]);
            if whole { corner.round() } else { corner }
        });
        Mapping {
            zoom,
            corner,
            canvas: sizes.canvas,
        }
    }

    /// One film pixel to a screen pixel, about a point of the canvas that stays.
    pub(super) fn one_to_one(self, about: [f64; 2], sizes: Sizes) -> Self {
        self.zoomed_to(1.0, about, sizes)
    }

    /// Larger by a factor, about a point of the canvas: the film point under it stays there.
    pub(super) fn zoomed(self, factor: f64, about: [f64; 2], sizes: Sizes) -> Self {
        self.zoomed_to(self.zoom_on(sizes) * factor, about, sizes)
    }

    /// The next power of two that is larger or smaller.
    pub(super) fn stepped(self, larger: bool, about: [f64; 2], sizes: Sizes) -> Self {
        let exponent = self.zoom_on(sizes).log2();
        let next = if larger {
            (exponent + CLOSE).floor() + 1.0
        } else {
            (exponent - CLOSE).ceil() - 1.0
        };
        self.zoomed_to(next.exp2(), about, sizes)
    }

    /// Moved by screen pixels, until an edge of the picture comes to the middle of the canvas.
    pub(super) fn panned(self, by: [f64; 2], sizes: Sizes) -> Self {
        let zoom = self.zoom_on(sizes);
        let middle =
            [0, 1].map(|axis| self.middle[axis] - by[axis] / (zoom * f64::from(sizes.film[axis])));
        Self::free(zoom, middle)
    }

    fn zoomed_to(self, zoom: f64, about: [f64; 2], sizes: Sizes) -> Self {
        let before = self.mapping(sizes);
        let fit = sizes.fit();
        let [least, greatest] = ZOOM;
        // A fit beyond the limits is no further from them after a step.
        let zoom = settled(zoom).clamp(least.min(fit), greatest.max(fit));
        let middle = [0, 1].map(|axis| {
            let held = (about[axis] - before.corner[axis]) / before.zoom;
            let middle = held + (sizes.middle(axis) - about[axis]) / zoom;
            middle / f64::from(sizes.film[axis])
        });
        Self::free(zoom, middle)
    }

    fn free(zoom: f64, middle: [f64; 2]) -> Self {
        Self {
            zoom: Some(zoom),
            middle: middle.map(|share| share.clamp(0.0, 1.0)),
        }
    }

    fn zoom_on(self, sizes: Sizes) -> f64 {
        self.zoom.unwrap_or_else(|| sizes.fit())
    }
}

impl Sizes {
    /// The middle of the canvas.
    fn middle(self, axis: usize) -> f64 {
        0.5 * f64::from(self.canvas[axis])
    }

    /// The zoom at which the whole film just fits.
    fn fit(self) -> f64 {
        let [across, down] =
            [0, 1].map(|axis| f64::from(self.canvas[axis]) / f64::from(self.film[axis]));
        across.min(down)
    }
}

/// A power of two, if the zoom is as good as one.
fn settled(zoom: f64) -> f64 {
    let power = zoom.log2().round().exp2();
    if (zoom / power - 1.0).abs() < CLOSE {
        power
    } else {
        zoom
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: Sizes = Sizes {
        film: [640, 360],
        canvas: [1000, 700],
    };

    /// The film point under a point of the canvas.
    fn under(placement: Placement, at: [f64; 2]) -> [f64; 2] {
        let mapping = placement.mapping(SIZES);
        [0, 1].map(|axis| (at[axis] - mapping.corner[axis]) / mapping.zoom)
    }

    #[test]
    fn a_fit_touches_two_edges_and_follows_the_canvas() {
        let mapping = Placement::FIT.mapping(SIZES);
        assert_eq!(mapping.zoom, 1000.0 / 640.0);
        assert!(mapping.corner[0].abs() < 1e-9);
        assert!((mapping.corner[1] - (700.0 - 562.5) / 2.0).abs() < 1e-9);
        let same = Sizes {
            film: [301, 203],
            canvas: [301, 203],
        };
        let mapping = Placement::FIT.mapping(same);
        assert_eq!((mapping.zoom, mapping.corner), (1.0, [0.0; 2]));
    }

    #[test]
    fn one_to_one_lies_on_whole_pixels() {
        for canvas in [[1001, 700], [640, 361], [99, 98]] {
            let sizes = Sizes { canvas, ..SIZES };
            let placement = Placement::FIT
                .one_to_one([10.3, 20.7], sizes)
                .panned([0.4, 0.3], sizes);
            let mapping = placement.mapping(sizes);
            assert_eq!(mapping.zoom, 1.0);
            assert!(mapping.corner.iter().all(|corner| corner.fract() == 0.0));
        }
    }

    #[test]
    fn the_point_under_the_pointer_stays() {
        let at = [310.25, 402.5];
        let mut placement = Placement::FIT;
        let held = under(placement, at);
        for factor in [1.37, 3.1, 0.41, 1.003] {
            placement = placement.zoomed(factor, at, SIZES);
            let now = under(placement, at);
            for axis in [0, 1] {
                assert!((now[axis] - held[axis]).abs() < 1e-9);
            }
        }
        // Where the picture is moved to whole pixels, within half a screen pixel.
        placement = placement.stepped(true, at, SIZES);
        let shown = under(placement, at).map(|v| v * placement.mapping(SIZES).zoom);
        let exact = held.map(|v| v * placement.mapping(SIZES).zoom);
        for axis in [0, 1] {
            assert!((shown[axis] - exact[axis]).abs() <= 0.5 + 1e-9);
        }
    }

    #[test]
    fn steps_are_powers_of_two_within_the_limits() {
        let at = [500.0, 350.0];
        let zoom = |placement: Placement| placement.mapping(SIZES).zoom;
        let mut placement = Placement::FIT;
        let mut zooms = Vec::new();
        for _ in 0..12 {
            placement = placement.stepped(true, at, SIZES);
            zooms.push(zoom(placement));
        }
        assert_eq!(zooms[..4], [2.0, 4.0, 8.0, 16.0]);
        assert_eq!(zooms[11], 64.0);
        for _ in 0..20 {
            placement = placement.stepped(false, at, SIZES);
        }
        assert_eq!(zoom(placement), 1.0 / 16.0);
        assert_eq!(zoom(placement.zoomed(1e9, at, SIZES)), 64.0);
        assert_eq!(zoom(Placement::FIT.stepped(false, at, SIZES)), 1.0);
        // In and out again by a wheel's factors.
        let there = Placement::FIT.one_to_one(at, SIZES).zoomed(1.1, at, SIZES);
        assert_eq!(zoom(there.zoomed(1.0 / 1.100_000_1, at, SIZES)), 1.0);
    }

    #[test]
    fn a_film_too_large_for_the_least_zoom_still_fits() {
        let sizes = Sizes {
            film: [8192, 8192],
            canvas: [128, 256],
        };
        assert_eq!(Placement::FIT.mapping(sizes).zoom, 1.0 / 64.0);
        let at = [0.0; 2];
        let smaller = Placement::FIT.stepped(false, at, sizes).mapping(sizes);
        assert_eq!(smaller.zoom, 1.0 / 64.0);
        let larger = Placement::FIT.stepped(true, at, sizes).mapping(sizes);
        assert_eq!(larger.zoom, 1.0 / 32.0);
    }

    #[test]
    fn another_film_fills_the_place_of_this_one_as_far_as_it_goes() {
        let mapping = Mapping {
            zoom: 2.0,
            corner: [10.0, 20.0],
            canvas: [800, 600],
        };
        // The same picture with half as many pixels lies in the same place.
        let half = mapping.for_another([100, 60], [50, 30]);
        assert_eq!((half.zoom, half.corner), (4.0, mapping.corner));
        // A square in the middle of it.
        let square = mapping.for_another([100, 60], [60, 60]);
        assert_eq!((square.zoom, square.corner), (2.0, [50.0, 20.0]));
    }

    #[test]
    fn a_pan_follows_the_pointer_and_cannot_lose_the_picture() {
        let at = [500.0, 350.0];
        let placement = Placement::FIT.zoomed(3.3, at, SIZES);
        let moved = placement.panned([12.5, -7.0], SIZES);
        let (before, after) = (placement.mapping(SIZES), moved.mapping(SIZES));
        assert!((after.corner[0] - before.corner[0] - 12.5).abs() < 1e-9);
        assert!((after.corner[1] - before.corner[1] + 7.0).abs() < 1e-9);
        for far in [-1e6, 1e6] {
            let [x, y] = under(placement.panned([far, far], SIZES), at);
            assert!((0.0..=640.0).contains(&x) && (0.0..=360.0).contains(&y));
        }
    }
}
