//! Which frames of a range are looked at, and how bright one is.

use crate::render::develop::Metering;
use crate::render::{Cancel, Effects, Plan, Settings, Switch, render_planned};
use crate::scene::{Scene, WavelengthSet};

/// So many frames are looked at: the first may come before the fire is lit and the last after it is out, and in between a
/// fire has grown and flickered by more than a neighbour of any of them differs from it.
pub(super) const MOST: usize = 5;

/// Longest side of the picture by which the brightest frame is found, pixels: a bright part of a fire fills many.
const LOOK_SIDE: u32 = 160;
/// Longest side of the picture that exposure and white are measured on, pixels. A larger one is measured within a percent
/// alike, and takes longer.
pub(super) const METERED_SIDE: u32 = 480;
/// Step of a march that only tells which frame is brightest, voxels.
const LOOK_STEP_VOXELS: f64 = 2.0;

/// Frames spread over a range of so many, its ends among them; then all others, in case none of those can be read. At most
/// [`MOST`] of them are to be looked at.
pub(super) fn order_of(count: usize) -> Vec<usize> {
    let spread: Vec<usize> = if count <= MOST {
        (0..count).collect()
    } else {
        let last = count - 1;
        (0..MOST)
            .map(|i| (i * last + (MOST - 1) / 2) / (MOST - 1))
            .collect()
    };
    let rest = (0..count).filter(|at| !spread.contains(at));
    spread.iter().copied().chain(rest).collect()
}

/// A size of the same shape with no side longer than this.
pub(super) fn within(size: [u32; 2], side: u32) -> [u32; 2] {
    let longest = size[0].max(size[1]);
    if longest <= side {
        return size;
    }
    let scale = f64::from(side) / f64::from(longest);
    size.map(|pixels| ((f64::from(pixels) * scale).round() as u32).max(1))
}

/// Y of the bright parts, W m⁻² sr⁻¹, by a small and coarse picture of the fire's own light; `None` if cancelled.
pub(super) fn brightness(scene: &Scene, settings: &Settings, cancel: &Cancel) -> Option<f64> {
    let coarse = Settings {
        size: within(settings.size, LOOK_SIDE),
        step_voxels: LOOK_STEP_VOXELS,
        wavelengths: WavelengthSet::Fitted(4),
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: Effects {
            scattering: Switch::Off,
            scattering_orders: Switch::Off,
            refraction: Switch::Off,
            fire_light: Switch::Off,
            ..settings.effects
        },
    };
    let plan = Plan::new(scene, &coarse);
    let frame = render_planned(scene, &plan, &coarse, cancel, &|_| {})?;
    Some(Metering::of(&frame.film).bright_y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_looked_at_from_end_to_end_and_the_others_after_them() {
        assert_eq!(order_of(1), [0]);
        assert_eq!(order_of(3), [0, 1, 2]);
        let order = order_of(12);
        assert_eq!(order[..MOST], [0, 3, 6, 8, 11]);
        assert_eq!(order[MOST..], [1, 2, 4, 5, 7, 9, 10]);
    }

    #[test]
    fn a_smaller_size_keeps_its_shape() {
        assert_eq!(within([1280, 720], 480), [480, 270]);
        assert_eq!(within([72, 128], 480), [72, 128]);
        assert_eq!(within([16384, 1], 480), [480, 1]);
    }
}
