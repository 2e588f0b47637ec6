//! What each effect costs or saves in seconds, measured here and now.
//!
//! An effect's cost is the difference between two pictures, one with it and one without: in working out the fields, and
//! in the march. The fields of the picture itself were on the clock when they were worked out; only those that the other
//! picture needs besides are worked out again. Of the march a spread sample of packets stands for all.

use std::time::{Duration, Instant};

use super::clock::timed;
use super::fields::Fields;
use super::packets::Packets;
use super::part::Part;
use super::plan::{Effect, Plan, is_on};
use super::{Cancel, Level, Settings};
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
    let part = Part::spread(
        settings.size,
        if by_paths { PACKETS_BY_PATHS } else { PACKETS },
    );
    let [here, there] = pictures
        .map(|(plan, fields)| Packets::new(scene, plan, fields, settings.step_voxels, true));
    let of_pixel = f64::from(settings.samples_per_pixel);
    let mut took = [Vec::new(), Vec::new()];
    let both = [here.ok()?, there.ok()?];
    'rounds: for _ in 0..ROUNDS {
        // By turns, so that what else the machine does falls on both.
        for (took, packets) in took.iter_mut().zip(&both) {
            let Some(rendered) = part.render_with(packets, 1, cancel) else {
                break 'rounds;
            };
            took.push(of_pixel * rendered.wall_s);
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

/// The median, and how far the values are from it in the median; `None` where there are none.
fn middle(values: &mut [f64]) -> Option<(f64, f64)> {
    values.sort_by(f64::total_cmp);
    let median = *values.get(values.len() / 2)?;
    let mut off: Vec<f64> = values.iter().map(|value| (value - median).abs()).collect();
    off.sort_by(f64::total_cmp);
    Some((median, *off.get(off.len() / 2)?))
}

#[cfg(test)]
mod tests {
    use super::*;

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
