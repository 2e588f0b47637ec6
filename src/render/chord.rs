//! A ray prepared for the march: its steps through the domain, which of them may meet soot, and how finely these are cut.
//!
//! Steps are cut into shorter ones where the fire's light changes from voxel to voxel ([`Medium::cuts`]): thin hot sheets
//! are what a picture's error comes from.

use glam::DVec3;

use super::walk::for_each_brick;
use crate::math::Ray;
use crate::scene::medium::{BRICK, Medium};

/// Steps of one ray that lie in bricks with soot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Run {
    /// The first of them.
    pub(super) first: u32,
    /// The first behind them.
    pub(super) end: u32,
    /// Into how many samples each is cut.
    pub(super) cuts: u32,
}

/// All of them, rising, apart.
pub(super) type Runs = Vec<Run>;

/// By how much stretches are widened at both ends, steps: far more than is rounded off on the way.
const SLACK: f64 = 1e-4;

/// Runs for which there is room at first: few rays go in and out of the fire more often.
const RUNS: usize = 16;

/// What is known of how finely bricks are to be looked at, for steps of which each is such a vector of the lattice. A step as
/// long as a brick crosses several and is ruled by none: such steps stay even.
pub(super) fn known_cuts(medium: &Medium, step: DVec3) -> &[u8] {
    if step.abs().max_element() < BRICK as f64 {
        medium.cuts()
    } else {
        &[]
    }
}

/// The bricks that rays look into.
#[derive(Clone, Copy)]
pub(super) struct Bricks<'a> {
    pub(super) medium: &'a Medium,
    /// Stored bricks before this one.
    before: u32,
}

impl<'a> Bricks<'a> {
    /// All in which something can show; without `glow` of the gas, those with soot or smoke.
    pub(super) fn new(medium: &'a Medium, glow: bool) -> Self {
        let before = if glow { medium.shown } else { medium.sooty };
        Self { medium, before }
    }

    /// Whether a ray looks into a brick.
    #[inline(always)]
    pub(super) fn has(self, slot: u32) -> bool {
        slot < self.before
    }
}

/// Into how many samples a step in a brick is cut, of what is known of all bricks; 0 where nothing shows.
#[inline(always)]
pub(super) fn cuts_of(bricks: Bricks<'_>, cuts: &[u8], slot: u32) -> u32 {
    if bricks.has(slot) {
        cuts.get(slot as usize).map_or(1, |&cuts| u32::from(cuts))
    } else {
        0
    }
}

/// The part of a ray inside the domain, cut into steps.
pub(super) struct Chord {
    /// Lattice position where step 0 begins.
    pub(super) start: [f64; 3],
    /// Lattice vector of a whole step.
    pub(super) delta: [f64; 3],
    /// Index of the last step.
    pub(super) last: u32,
    /// Length of the last step as a share of a whole one, so that the steps end where the domain ends.
    pub(super) last_share: f32,
    /// The steps worth taking.
    pub(super) runs: Runs,
    /// Lattice positions of the middles of all steps, where the ray is bent; empty where it is straight.
    pub(super) middles: Vec<[f64; 3]>,
}

impl Chord {
    /// Cuts a ray of the world into steps, up to a distance of `limit_m` where something is in the way; `None` if it meets no
    /// soot. A step longer than the chord is the chord. Bricks are looked for between two distances beyond which there are
    /// none.
    pub(super) fn new(
        bricks: Bricks<'_>,
        ray: &Ray,
        step_m: f64,
        limit_m: f64,
        [near_m, far_m]: [f64; 2],
    ) -> Option<Self> {
        let medium = bricks.medium;
        let (local, [enter, exit]) = medium.enter(ray)?;
        let exit = exit.min(limit_m);
        let length = exit - enter;
        if length <= 0.0 {
            return None;
        }
        // A chord that is whole steps long up to rounding has no extra sliver of a step.
        let steps = (length / step_m - 1e-9).ceil().max(1.0);
        let last_share = (length - (steps - 1.0) * step_m) / step_m;
        let mut cutter = Cutter {
            runs: Runs::with_capacity(RUNS),
            steps,
        };
        let range = [enter.max(near_m), exit.min(far_m)];
        if range[0] <= range[1] {
            let (per_m, cuts) = (1.0 / step_m, known_cuts(medium, local.direction * step_m));
            // Neighbours that are cut alike are one stretch.
            let (mut current, mut begin, mut end) = (0, 0.0, 0.0);
            for_each_brick(medium, &local, range, |stretch| {
                let cuts = cuts_of(bricks, cuts, stretch.slot);
                if cuts != current {
                    cutter.add(
                        [begin, stretch.from].map(|at| (at - enter) * per_m),
                        current,
                    );
                    (current, begin) = (cuts, stretch.from);
                }
                end = stretch.to;
            });
            cutter.add([begin, end].map(|at| (at - enter) * per_m), current);
        }
        (!cutter.runs.is_empty()).then(|| Self {
            start: local.at(enter).to_array(),
            delta: (local.direction * step_m).to_array(),
            last: (steps - 1.0) as u32,
            last_share: last_share as f32,
            runs: cutter.runs,
            middles: Vec::new(),
        })
    }

    /// Where each sample's part of the ray begins and ends, in whole steps from the begin.
    pub(super) fn samples(&self) -> impl Iterator<Item = [f64; 2]> {
        let steps = self
            .runs
            .iter()
            .flat_map(|run| (run.first..run.end).map(|step| (step, run.cuts)));
        steps.flat_map(|(step, cuts)| {
            let length = if step == self.last {
                f64::from(self.last_share)
            } else {
                1.0
            };
            let border =
                move |cut: u32| f64::from(step) + length * f64::from(cut) / f64::from(cuts);
            (0..cuts).map(move |cut| [border(cut), border(cut + 1)])
        })
    }

    /// Lattice position of a place in whole steps from the begin, in the middle of a step or near it where the path is bent:
    /// there it is taken as straight for the length of a step.
    #[inline(always)]
    pub(super) fn bent_at(&self, place: f64) -> [f64; 3] {
        let (step, last) = (place as usize, self.last as usize);
        let middle = |step: usize| {
            step as f64
                + if step == last {
                    0.5 * f64::from(self.last_share)
                } else {
                    0.5
                }
        };
        let (before, after) = (step.saturating_sub(1), (step + 1).min(last));
        let off = place - middle(step);
        if off == 0.0 || before == after {
            return self.middles[step];
        }
        let share = off / (middle(after) - middle(before));
        std::array::from_fn(|axis| {
            self.middles[step][axis]
                + share * (self.middles[after][axis] - self.middles[before][axis])
        })
    }
}

/// Makes runs of stretches that come one after the other.
struct Cutter {
    runs: Runs,
    /// How many steps there are.
    steps: f64,
}

impl Cutter {
    /// Adds all steps that have a part in a stretch, which is given in steps. One that has a part in two is cut as finely as
    /// either.
    fn add(&mut self, [from, to]: [f64; 2], cuts: u32) {
        if cuts == 0 {
            return;
        }
        let mut first = (from - SLACK).max(0.0) as u32;
        let end = ceil(to + SLACK).min(self.steps as u32);
        while let Some(run) = self.runs.last_mut()
            && first < run.end
        {
            if cuts < run.cuts {
                first = run.end;
                break;
            }
            if cuts == run.cuts {
                run.end = run.end.max(end);
                return;
            }
            // Its ends are no later than this one's: what is cut more coarsely gives way.
            run.end = first.max(run.first);
            if run.first < run.end {
                break;
            }
            self.runs.pop();
        }
        if let Some(run) = self.runs.last_mut()
            && run.end == first
            && run.cuts == cuts
        {
            run.end = run.end.max(end);
        } else if first < end {
            self.runs.push(Run { first, end, cuts });
        }
    }
}

/// The least whole number that is at least `x`, and 0 at least. The standard one is a call where a processor is not known to
/// have an instruction for it.
#[inline(always)]
fn ceil(x: f64) -> u32 {
    let whole = x as u32;
    whole + u32::from(f64::from(whole) < x)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::walk::tests::sparse;
    use super::*;
    use crate::scene::Interpolation;
    use crate::scene::refractivity::stored;

    proptest! {
        /// No sample with soot is skipped: along axes, diagonals, grazing rays and any others.
        #[test]
        fn every_step_with_soot_is_in_a_run(
            seed in 0_u32..500,
            origin in prop::array::uniform3(-40.0..60.0_f64),
            direction in prop_oneof![
                prop::array::uniform3(-1.0..1.0_f64),
                prop::sample::select(vec![
                    [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [-1.0, 1.0, -1.0],
                ]),
            ],
            whole in any::<bool>(),
            step_m in 0.1..9.0_f64,
            interpolation in prop::sample::select(Interpolation::ALL.to_vec()),
        ) {
            let medium = sparse(seed, interpolation);
            let origin = DVec3::from(origin);
            // Half of the rays run exactly along planes of the lattice.
            let origin = if whole { origin.round() } else { origin };
            let Some(ray) = Ray::new(origin, direction.into()) else { return Ok(()) };
            let Some((local, [enter, exit])) = medium.enter(&ray) else { return Ok(()) };
            let chord = Chord::new(Bricks::new(&medium, true), &ray, step_m, f64::INFINITY, [0.0, f64::INFINITY]);
            let runs = chord.map_or(Runs::new(), |chord| chord.runs);
            let steps = ((exit - enter) / step_m - 1e-9).ceil().max(1.0) as u32;
            for step in 0..steps {
                let begin = enter + f64::from(step) * step_m;
                let end = (begin + step_m).min(exit);
                for part in [0.01, 0.3, 0.5, 0.8, 0.99] {
                    let at = local.at(begin + part * (end - begin));
                    let run = runs.iter().find(|run| (run.first..run.end).contains(&step));
                    if medium.sample(at)[0] > 0.0 {
                        prop_assert!(run.is_some(), "step {step} of {steps} is skipped: {runs:?}");
                    }
                    let known = known_cuts(&medium, local.direction * step_m);
                    // A ray along an edge between bricks is in any of them that it touches.
                    let touched = (0..8).map(|corner| {
                        let side = DVec3::from([0, 1, 2].map(|axis| f64::from(corner >> axis & 1) - 0.5));
                        let at = (at + 1e-9 * side).to_array().map(|at| at as i32);
                        let slot = stored(&medium, at);
                        slot.map_or(0, |slot| cuts_of(Bricks::new(&medium, true), known, slot))
                    });
                    let cuts = touched.min().unwrap_or(0);
                    let own = run.map_or(0, |run| run.cuts);
                    prop_assert!(own >= cuts, "step {step} is cut into {own}, not {cuts}");
                }
            }
            prop_assert!(runs.iter().all(|run| run.first < run.end && run.cuts > 0), "{runs:?}");
            let apart = |pair: &[Run]| {
                pair[0].end < pair[1].first || pair[0].end == pair[1].first && pair[0].cuts != pair[1].cuts
            };
            prop_assert!(runs.windows(2).all(apart), "{runs:?}");
        }
    }
}
