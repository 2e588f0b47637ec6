//! A ray prepared for the march: its steps through the domain, and which of them may meet soot.

use super::walk::for_each_stretch;
use crate::math::Ray;
use crate::scene::medium::Medium;

/// Steps of one ray that lie in bricks with soot: `first..end`, rising, apart.
pub(super) type Runs = Vec<[u32; 2]>;

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
    /// Cuts a ray of the world into steps of `step_m` metres, up to a distance of `limit_m` where something is in the
    /// way; `None` if it meets no soot. A step longer than the chord is the chord.
    pub(super) fn new(medium: &Medium, ray: &Ray, step_m: f64, limit_m: f64) -> Option<Self> {
        let (local, [enter, exit]) = medium.enter(ray)?;
        let exit = exit.min(limit_m);
        let length = exit - enter;
        if length <= 0.0 {
            return None;
        }
        // A chord that is whole steps long up to rounding has no extra sliver of a step.
        let steps = (length / step_m - 1e-9).ceil().max(1.0);
        let last_share = (length - (steps - 1.0) * step_m) / step_m;
        let runs = occupied_runs(medium, &local, [enter, exit], step_m, steps);
        (!runs.is_empty()).then(|| Self {
            start: local.at(enter).to_array(),
            delta: (local.direction * step_m).to_array(),
            last: (steps - 1.0) as u32,
            last_share: last_share as f32,
            runs,
            middles: Vec::new(),
        })
    }
}

/// Collects the steps whose middle may lie in a stored brick. Each run is a step longer at both ends than the brick's
/// stretch, so rounding loses none.
fn occupied_runs(medium: &Medium, ray: &Ray, range: [f64; 2], step_m: f64, steps: f64) -> Runs {
    let mut runs = Runs::new();
    let enter = range[0];
    for_each_stretch(medium, ray, range, |stretch| {
        let first = ((stretch.from - enter) / step_m - 1.5).ceil().max(0.0) as u32;
        let end = (((stretch.to - enter) / step_m + 1.5).floor()).min(steps) as u32;
        match runs.last_mut() {
            Some(run) if first <= run[1] => run[1] = run[1].max(end),
            _ if first < end => runs.push([first, end]),
            _ => {}
        }
    });
    runs
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::super::walk::tests::sparse;
    use super::*;
    use crate::scene::Interpolation;

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
            step_m in 0.2..9.0_f64,
            interpolation in prop::sample::select(Interpolation::ALL.to_vec()),
        ) {
            let medium = sparse(seed, interpolation);
            let origin = DVec3::from(origin);
            // Half of the rays run exactly along planes of the lattice.
            let origin = if whole { origin.round() } else { origin };
            let Some(ray) = Ray::new(origin, direction.into()) else { return Ok(()) };
            let Some((local, [enter, exit])) = medium.enter(&ray) else { return Ok(()) };
            let runs = Chord::new(&medium, &ray, step_m, f64::INFINITY).map_or(Runs::new(), |chord| chord.runs);
            let steps = ((exit - enter) / step_m - 1e-9).ceil().max(1.0) as u32;
            for step in 0..steps {
                let begin = enter + f64::from(step) * step_m;
                let middle = 0.5 * (begin + (begin + step_m).min(exit));
                if medium.sample(local.at(middle))[0] > 0.0 {
                    let taken = runs.iter().any(|run| (run[0]..run[1]).contains(&step));
                    prop_assert!(taken, "step {step} of {steps} is skipped: {runs:?}");
                }
            }
            prop_assert!(runs.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{runs:?}");
        }
    }
}
