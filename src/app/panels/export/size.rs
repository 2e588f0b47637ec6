//! Width and height of an export.

use crate::render::MAX_SIDE;

/// Shapes that differ by less, as whole pixels make them, look alike.
const SAME_SHAPE: f64 = 0.01;

/// A size in pixels, that of the canvas until another is set.
#[derive(Debug)]
pub(super) struct Size {
    /// `None`: as in the window.
    set: Option<[u32; 2]>,
    /// Two sides whose ratio is kept. Not those of the last edit, whose rounding would add up. `None`: the canvas.
    shape: Option<[u32; 2]>,
    /// Whether one side follows the other.
    keeps_shape: bool,
}

impl Default for Size {
    fn default() -> Self {
        Self {
            set: None,
            shape: None,
            keeps_shape: true,
        }
    }
}

impl Size {
    /// The size where the canvas has this many pixels.
    pub(super) fn of(&self, canvas: [u32; 2]) -> [u32; 2] {
        self.set.unwrap_or(canvas)
    }

    /// Sets both sides; `None` for those of the canvas, whatever they become.
    pub(super) fn set(&mut self, size: Option<[u32; 2]>) {
        self.set = size;
        self.shape = size;
    }

    /// Sets one side, width (0) or height (1).
    pub(super) fn set_side(&mut self, axis: usize, side: u32, canvas: [u32; 2]) {
        if self.keeps_shape {
            let shape = self.shape.unwrap_or(canvas);
            self.shape = Some(shape);
            self.set = Some(with_side(axis, side, shape));
        } else {
            let mut size = self.of(canvas);
            size[axis] = side;
            self.set(Some(size));
        }
    }

    /// Whether one side follows the other.
    pub(super) fn keeps_shape(&self) -> bool {
        self.keeps_shape
    }

    /// Locks the present shape, or sets the sides free.
    pub(super) fn keep_shape(&mut self, keeps: bool, canvas: [u32; 2]) {
        if keeps {
            self.shape = Some(self.of(canvas));
        }
        self.keeps_shape = keeps;
    }
}

/// The size of a shape with one side as long as asked, unless the other would become too long.
fn with_side(axis: usize, side: u32, shape: [u32; 2]) -> [u32; 2] {
    let ratio = f64::from(shape[1 - axis].max(1)) / f64::from(shape[axis].max(1));
    let whole = |side: f64| (side.round() as u32).clamp(1, MAX_SIDE);
    let other = f64::from(side) * ratio;
    let mut size = [0; 2];
    size[1 - axis] = whole(other);
    size[axis] = if other > f64::from(MAX_SIDE) {
        whole(f64::from(MAX_SIDE) / ratio)
    } else {
        side.clamp(1, MAX_SIDE)
    };
    size
}

/// Sizes that are often asked for, in words; `None` is that of the canvas.
pub(super) fn presets(canvas: [u32; 2]) -> [(&'static str, Option<[u32; 2]>); 4] {
    let doubled = canvas.map(|side| (2 * side).min(MAX_SIDE));
    [
        ("As in the window", None),
        ("2 × that", Some(doubled)),
        ("1920 × 1080", Some([1920, 1080])),
        ("3840 × 2160", Some([3840, 2160])),
    ]
}

/// What a picture of another shape than the canvas shows: the camera's field of view is that of its height.
pub(super) fn beside(size: [u32; 2], canvas: [u32; 2]) -> Option<&'static str> {
    let aspect = |[width, height]: [u32; 2]| f64::from(width) / f64::from(height);
    let wider = aspect(size) / aspect(canvas);
    if wider > 1.0 + SAME_SHAPE {
        Some("Wider than in the window: more is seen at the sides.")
    } else if wider < 1.0 / (1.0 + SAME_SHAPE) {
        Some("Narrower than in the window: less is seen at the sides.")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_follows_the_canvas_until_it_is_set() {
        let mut size = Size::default();
        assert_eq!(size.of([968, 772]), [968, 772]);
        assert_eq!(size.of([100, 50]), [100, 50]);
        size.set(Some([1920, 1080]));
        assert_eq!(size.of([100, 50]), [1920, 1080]);
        size.set(None);
        assert_eq!(size.of([100, 50]), [100, 50]);
    }

    #[test]
    fn a_kept_shape_does_not_drift_and_stays_within_bounds() {
        let canvas = [100, 50];
        let mut size = Size::default();
        size.set(Some([1920, 1080]));
        size.set_side(0, 7, canvas);
        assert_eq!(size.of(canvas), [7, 4]);
        size.set_side(1, 1080, canvas);
        assert_eq!(size.of(canvas), [1920, 1080]);
        size.set_side(1, MAX_SIDE, canvas);
        assert_eq!(size.of(canvas), [MAX_SIDE, 9216]);
        size.set_side(0, 1, canvas);
        assert_eq!(size.of(canvas), [1, 1]);
    }

    #[test]
    fn sides_are_free_without_the_lock_and_the_lock_takes_the_shape_that_is() {
        let canvas = [100, 50];
        let mut size = Size::default();
        size.keep_shape(false, canvas);
        size.set_side(1, 25, canvas);
        assert_eq!(size.of(canvas), [100, 25]);
        size.keep_shape(true, canvas);
        size.set_side(0, 200, canvas);
        assert_eq!(size.of(canvas), [200, 50]);
    }

    #[test]
    fn another_shape_is_told() {
        assert_eq!(beside([1936, 1544], [968, 772]), None);
        assert_eq!(beside([640, 361], [1920, 1080]), None);
        assert!(beside([1920, 1080], [968, 772]).is_some_and(|words| words.contains("more")));
        assert!(beside([500, 900], [968, 772]).is_some_and(|words| words.contains("less")));
    }
}
