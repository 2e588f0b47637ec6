//! What each effect costs or saves in seconds, measured here and now.
//!
//! An effect's cost is the difference between two pictures, one with it and one without: in working out the fields, and
//! in the march. The fields of the picture itself were on the clock when they were worked out; only those that the other
//! picture needs besides are worked out again. Of the march a spread sample of packets stands for all.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::clock::timed;
use super::fields::Fields;
use super::march::{Marcher, PACKET_SIDE};
use super::orders::HigherOrders;
use super::pass::offset;
use super::plan::{Effect, Plan, is_on};
use super::{Cancel, Level, Settings};
use crate::math::lanes::LANES;
use crate::scene::Scene;

/// What an effect takes of a picture's time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Which.
    pub effect: Effect,
    /// Wall-clock seconds of the whole picture that it takes, or would take if it were computed; 0 where that is less than
    /// what measuring it is off by.
    pub seconds: f64,
    /// Whether there was no time to measure to the end: then it is more.
    pub at_least: bool,
}

/// Most packets that stand for a picture's.
const PACKETS: usize = 256;
/// The same where each of their rays is followed by paths.
const PACKETS_BY_PATHS: usize = 64;
/// How often each sample is marched; the median counts.
const ROUNDS: usize = 5;
/// Least time that is told, seconds.
const LEAST_SECONDS: f64 = 0.01;

impl Cost {
    /// The seconds in words: "0.60 s", "less than 0.01 s", "more than 1.2 s".
    pub fn in_words(&self) -> String {
        let seconds = self.seconds;
        if seconds < LEAST_SECONDS {
            return format!("less than {LEAST_SECONDS} s");
        }
        let decimals = (1 - seconds.log10().floor() as i32).clamp(0, 2) as usize;
        let more = if self.at_least { "more than " } else { "" };
        format!("{more}{seconds:.decimals$} s")
    }
}

/// Measures, in the calling thread's rayon pool, each effect that could be switched in this picture: what is on costs so
/// much, what is off would cost so much. It takes the `budget`, and the fields of the plan if nobody has asked for them.
/// `None` if cancelled.
pub fn costs(
    scene: &Scene,
    settings: &Settings,
    plan: &Plan,
    budget: Duration,
    cancel: &Cancel,
) -> Option<Vec<Cost>> {
    let fields = plan.fields(scene, Level::Fine, cancel)?;
    let others = Effect::ALL.into_iter().filter_map(|effect| {
        let other = plan.switched(scene, settings, effect)?;
        Some((effect, other))
    });
    let mut others: Vec<(Effect, Plan)> = others.collect();
    // What takes no fields of its own is soon measured.
    others.sort_by_key(|(_, other)| !other.takes_fields_over(plan));
    let end = Instant::now().checked_add(budget);
    let mut costs = Vec::with_capacity(others.len());
    let count = others.len();
    for (i, (effect, other)) in others.into_iter().enumerate() {
        // Each has an even share of what is left, and leaves on what it does not need.
        let left = end.map_or(budget, |end| end.saturating_duration_since(Instant::now()));
        let share = left / u32::try_from(count - i).unwrap_or(u32::MAX);
        let in_time = cancel.or_after(share);
        let (difference, spent) = timed(|| {
            let theirs = other.fields_beside(scene, plan, fields, &in_time)?;
            let in_fields = theirs.seconds.all() - fields.seconds.all();
            let in_march = march(
                scene,
                settings,
                [(plan, fields), (&other, &theirs)],
                &in_time,
            );
            Some((in_fields, in_march))
        });
        if cancel.is_cancelled() {
            return None;
        }
        let is_on = is_on(&plan.decisions, effect);
        let (more, at_least) = match difference {
            Some((in_fields, Some(in_march))) => (in_fields + in_march, false),
            Some((in_fields, None)) => (in_fields, true),
            // Fields that were not ready after so long take more than that, but other ones may be saved.
            None if !is_on => (spent - fields.seconds.all(), true),
            None => continue,
        };
        let cost = Cost {
            effect,
            seconds: if is_on { -more } else { more }.max(0.0),
            at_least,
        };
        if !cost.at_least || cost.seconds >= LEAST_SECONDS {
            costs.push(cost);
        }
    }
    let place = |effect: Effect| Effect::ALL.iter().position(|it| *it == effect);
    costs.sort_by_key(|cost| place(cost.effect));
    Some(costs)
}

/// By how many seconds the march of the second of two pictures takes longer than that of the first, 0 where that cannot be
/// told from noise; `None` if it was cancelled before either was through.
fn march(
    scene: &Scene,
    settings: &Settings,
    pictures: [(&Plan, &Fields); 2],
    cancel: &Cancel,
) -> Option<f64> {
    let by_paths = pictures.iter().any(|(plan, _)| plan.orders > 1);
    let packets = packets(
        settings.size,
        if by_paths { PACKETS_BY_PATHS } else { PACKETS },
    );
    let rays = packets.iter().flatten().flatten().count().max(1) as f64;
    let all = settings.pixels() as f64 * f64::from(settings.samples_per_pixel);
    let mut samples = Vec::with_capacity(pictures.len());
    for (plan, fields) in pictures {
        let marcher = Marcher::with_fields(scene, plan, fields, settings.step_voxels)
            .ok()?
            .for_a_picture();
        let higher = (plan.orders > 1).then(|| HigherOrders::new(scene, &plan.tables, plan.orders));
        samples.push((marcher, higher));
    }
    let mut took = [Vec::new(), Vec::new()];
    'rounds: for _ in 0..ROUNDS {
        // By turns, so that what else the machine does falls on both.
        for (took, (marcher, higher)) in took.iter_mut().zip(&samples) {
            let (whole, seconds) = timed(|| march_all(marcher, higher.as_ref(), &packets, cancel));
            if !whole {
                break 'rounds;
            }
            took.push(seconds * all / rays);
        }
    }
    let [(here, off_here), (there, off_there)] = [middle(&mut took[0])?, middle(&mut took[1])?];
    let more = there - here;
    Some(if more.abs() > off_here + off_there {
        more
    } else {
        0.0
    })
}

/// Marches every packet; `false` if cancelled.
fn march_all(
    marcher: &Marcher<'_>,
    higher: Option<&HigherOrders<'_>>,
    packets: &[[Option<[f64; 2]>; LANES]],
    cancel: &Cancel,
) -> bool {
    packets.par_iter().all(|points| {
        if cancel.is_cancelled() {
            return false;
        }
        let (mut pixels, _) = marcher.march(points);
        for (pixel, point) in pixels.iter_mut().zip(points) {
            if let (Some(higher), Some(point)) = (higher, point) {
                higher.add(*point, 0, pixel, cancel);
            }
        }
        // What nobody looks at would not be marched.
        std::hint::black_box(pixels);
        true
    })
}

/// The median, and how far the values are from it in the median; `None` where there are none.
fn middle(values: &mut [f64]) -> Option<(f64, f64)> {
    values.sort_by(f64::total_cmp);
    let median = *values.get(values.len() / 2)?;
    let mut off: Vec<f64> = values.iter().map(|value| (value - median).abs()).collect();
    off.sort_by(f64::total_cmp);
    Some((median, *off.get(off.len() / 2)?))
}

/// The centres of the pixels of at most so many packets, spread evenly over the picture.
fn packets(size: [u32; 2], most: usize) -> Vec<[Option<[f64; 2]>; LANES]> {
    let across = size.map(|side| side.div_ceil(PACKET_SIDE));
    let all = across[0] as usize * across[1] as usize;
    let count = all.min(most);
    let corner = |i: usize| -> [u32; 2] {
        if count == all {
            return [i as u32 % across[0], i as u32 / across[0]];
        }
        let spread = offset(i as u32);
        std::array::from_fn(|axis| (spread[axis] * f64::from(across[axis])) as u32)
    };
    let of = |i: usize| {
        let corner = corner(i).map(|side| side * PACKET_SIDE);
        std::array::from_fn(|lane| {
            let x = corner[0] + lane as u32 % PACKET_SIDE;
            let y = corner[1] + lane as u32 / PACKET_SIDE;
            (x < size[0] && y < size[1]).then(|| [f64::from(x) + 0.5, f64::from(y) + 0.5])
        })
    };
    (0..count).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_all_of_a_small_picture_and_spread_over_a_large_one() {
        let rays = |size| packets(size, PACKETS).iter().flatten().flatten().count();
        assert_eq!(rays([13, 6]), 13 * 6);
        let large = packets([1001, 703], PACKETS);
        assert_eq!(large.len(), PACKETS);
        for quarter in [[0.0, 0.0], [500.0, 0.0], [0.0, 350.0], [500.0, 350.0]] {
            let inside = large.iter().filter(|packet| {
                packet[0].is_some_and(|[x, y]| {
                    (quarter[0]..quarter[0] + 500.0).contains(&x)
                        && (quarter[1]..quarter[1] + 350.0).contains(&y)
                })
            });
            let share = inside.count() as f64 / PACKETS as f64;
            assert!((share - 0.25).abs() < 0.03, "{quarter:?}: {share}");
        }
    }

    #[test]
    fn the_middle_is_no_matter_of_what_goes_astray() {
        assert_eq!(middle(&mut [1.0, 90.0, 3.0, 2.0, 0.5]), Some((2.0, 1.0)));
        assert_eq!(middle(&mut []), None);
    }

    #[test]
    fn seconds_are_told_with_two_figures() {
        let words = |seconds, at_least| {
            let effect = Effect::Scattering;
            Cost {
                effect,
                seconds,
                at_least,
            }
            .in_words()
        };
        assert_eq!(words(0.604, false), "0.60 s");
        assert_eq!(words(12.34, false), "12 s");
        assert_eq!(words(1.21, true), "more than 1.2 s");
        assert_eq!(words(0.0, false), "less than 0.01 s");
    }
}
