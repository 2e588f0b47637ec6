//! One number, tried with all else the same.

use super::numbers::{RAYS, STEPS};
use super::sight::{Error, Picture, Sight};
use crate::project::Accuracy;
use crate::render::part::{Part, Rendered};
use crate::render::{Cancel, Plan, Settings};
use crate::scene::{Scene, WavelengthSet};

/// Step at which wavelengths and rays are tried, voxels.
pub(super) const STEP: f64 = 1.0;

/// Most wavelengths of a set that steps are tried with where none is good enough.
const QUICK_SET: u32 = 16;
/// Share of the target that wavelengths may take for the set to be the one that steps are tried with.
const SHARE_OF_SET: f64 = 0.7;

/// How alike the errors of two lattices of rays are, the r of [`own_error`]: between not at all and wholly. What the reference
/// is then said to be off by was within 1.5 times what it is, on real fires: see `the_reference_is_as_exact_as_it_is_said_to_be`
/// among the tests.
const ALIKE: f64 = 0.5;

/// One number, tried.
#[derive(Debug, Clone)]
pub(super) struct Tried<T> {
    pub(super) what: T,
    pub(super) xyz: Picture,
    /// How it looks different from the finest, pixel by pixel and in all.
    pub(super) shift: Vec<[f64; 3]>,
    pub(super) error: Error,
    /// Samples, processor's seconds and wall-clock seconds of the whole picture as the part has it.
    pub(super) samples: f64,
    pub(super) cpu_s: f64,
    pub(super) wall_s: f64,
}

impl<T> Tried<T> {
    fn new(what: T, rendered: Rendered) -> Self {
        Self {
            what,
            xyz: rendered.xyz,
            shift: Vec::new(),
            error: Error::default(),
            samples: rendered.samples,
            cpu_s: rendered.cpu_s,
            wall_s: rendered.wall_s,
        }
    }
}

/// Every set of at least so many wavelengths, without light from all sides.
pub(super) fn sets(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    least: u32,
    part: &Part,
    cancel: &Cancel,
) -> Option<Vec<Tried<WavelengthSet>>> {
    let each = |set| {
        let settings = Settings {
            wavelengths: set,
            ..*settings
        };
        let direct = plan.direct(scene, &settings);
        let rendered = part.render(scene, &direct, STEP, 1, cancel)?;
        Some(Tried::new(set, rendered))
    };
    let all = WavelengthSet::ALL.into_iter();
    all.filter(|set| set.count() >= least).map(each).collect()
}

/// Steps, longest first, with one that was set by hand.
pub(super) fn steps(
    scene: &Scene,
    plan: &Plan,
    set: f64,
    part: &Part,
    cancel: &Cancel,
) -> Option<Vec<Tried<f64>>> {
    let mut all = STEPS.to_vec();
    if !all.contains(&set) {
        all.push(set);
        all.sort_by(|one, other| other.total_cmp(one));
    }
    let each = |step| {
        let rendered = part.render(scene, plan, step, 1, cancel)?;
        Some(Tried::new(step, rendered))
    };
    all.into_iter().map(each).collect()
}

/// Rays for each pixel, of which one was tried among the steps.
pub(super) fn rays(
    scene: &Scene,
    plan: &Plan,
    one: &Tried<f64>,
    part: &Part,
    cancel: &Cancel,
) -> Option<Vec<Tried<u32>>> {
    let one = Rendered {
        xyz: one.xyz.clone(),
        samples: one.samples,
        cpu_s: one.cpu_s,
        wall_s: one.wall_s,
    };
    let mut all = vec![Tried::new(RAYS[0], one)];
    for count in RAYS.into_iter().skip(1) {
        let rendered = part.render(scene, plan, STEP, count, cancel)?;
        all.push(Tried::new(count, rendered));
    }
    Some(all)
}

/// Compares what was tried with the finest of it.
pub(super) fn compare<T>(sight: &Sight, all: &mut [Tried<T>], finest: &[[f64; 3]]) {
    for tried in all {
        tried.shift = sight.shift(finest, &tried.xyz);
        tried.error = sight.error(finest, &tried.xyz);
    }
}

/// How many times as bright each channel of each pixel is in another picture; 1 where one of them is dark.
pub(super) fn times(one: &[[f64; 3]], other: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let of_channel = |one: f64, other: f64| {
        if one > 0.0 && other > 0.0 {
            other / one
        } else {
            1.0
        }
    };
    let pixels = one.iter().zip(other);
    pixels
        .map(|(one, other)| std::array::from_fn(|c| of_channel(one[c], other[c])))
        .collect()
}

/// The smallest set whose error leaves some of the target to others. Where there is none, that of the plan if its light from all
/// sides would have to be worked out again for another; or else the best of those that are not slow.
pub(super) fn set_for(
    sets: &[Tried<WavelengthSet>],
    plan: &Plan,
    settings: &Settings,
    wished: Accuracy,
) -> WavelengthSet {
    if !wished.wavelengths {
        return settings.wavelengths;
    }
    let good = sets
        .iter()
        .find(|it| it.error.de95 <= SHARE_OF_SET * wished.target_de);
    let quick = sets.iter().filter(|it| it.what.count() <= QUICK_SET);
    let best = quick.min_by(|one, other| one.error.de95.total_cmp(&other.error.de95));
    let known = sets.iter().find(|it| it.what.count() == plan.wavelengths());
    let known = known.filter(|_| plan.gathers());
    good.or(known)
        .or(best)
        .map_or(settings.wavelengths, |it| it.what)
}

/// What the reference is off by: the midpoint rule's error falls to a quarter with half the step (L. F. Richardson 1911), that
/// of bands of wavelengths likewise with twice their number. That of rays falls at least as their number grows, and two lattices
/// are off by what is alike in part: their errors e and n e differ by e √(1 + n² − 2 r n).
pub(super) fn own_error(
    sight: &Sight,
    steps: &[Tried<f64>],
    sets: &[Tried<WavelengthSet>],
    rays: &[Tried<u32>],
) -> Error {
    fn last<T: Copy>(sight: &Sight, tried: &[Tried<T>], share: impl Fn([T; 2]) -> f64) -> Error {
        let [.., before, last] = tried else {
            return Error::default();
        };
        let share = share([before.what, last.what]);
        sight.error(&last.xyz, &before.xyz).scaled(share)
    }
    let of_step = |[before, last]: [f64; 2]| 1.0 / ((before / last).powi(2) - 1.0);
    let of_rays = |[before, last]: [u32; 2]| {
        let times = f64::from(last) / f64::from(before);
        1.0 / (1.0 + times * times - 2.0 * ALIKE * times).sqrt()
    };
    last(sight, steps, of_step)
        .beside(last(sight, sets, |_| 1.0 / 3.0))
        .beside(last(sight, rays, of_rays))
}
