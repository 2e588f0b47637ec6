//! A ray prepared for the march: its steps through the domain, and which of them may meet soot.

use glam::IVec3;

use crate::math::Ray;
use crate::scene::medium::{BRICK, Medium, NO_BRICK};

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
}

impl Chord {
    /// Cuts a ray of the world into steps of `step_m` metres; `None` if it meets no soot. A step longer than the
    /// chord is the chord.
    pub(super) fn new(medium: &Medium, ray: &Ray, step_m: f64) -> Option<Self> {
        let (local, [enter, exit]) = medium.enter(ray)?;
        let length = exit - enter;
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
        })
    }
}

/// Walks the table of bricks along a ray (Amanatides & Woo 1987) and collects the steps whose middle may lie in
/// a brick with soot. Each run is a step longer at both ends than the brick's chord, so rounding loses none.
fn occupied_runs(
    medium: &Medium,
    ray: &Ray,
    [enter, exit]: [f64; 2],
    step_m: f64,
    steps: f64,
) -> Runs {
    let mut runs = Runs::new();
    let edge = BRICK as f64;
    let at_enter = ray.at(enter) / edge;
    let limit = medium.bricks.as_ivec3();
    let mut cell = at_enter.floor().as_ivec3().clamp(IVec3::ZERO, limit - 1);
    let inverse = ray
        .direction
        .to_array()
        .map(|d| if d == 0.0 { f64::INFINITY } else { edge / d });
    let step = ray
        .direction
        .to_array()
        .map(|d| if d < 0.0 { -1 } else { 1 });
    let origin = (ray.origin / edge).to_array();
    let border = |axis: usize, cell: i32| {
        if inverse[axis].is_infinite() {
            return f64::INFINITY;
        }
        (f64::from(cell + i32::from(step[axis] > 0)) - origin[axis]) * inverse[axis]
    };
    let mut next: [f64; 3] = std::array::from_fn(|axis| border(axis, cell[axis]));
    let mut t = enter;
    loop {
        let axis = (0..3).fold(
            0,
            |best, axis| if next[axis] < next[best] { axis } else { best },
        );
        let leave = next[axis].min(exit);
        if medium.table[medium.brick_index(cell.as_uvec3())] != NO_BRICK {
            let first = ((t - enter) / step_m - 1.5).ceil().max(0.0) as u32;
            let end = (((leave - enter) / step_m + 1.5).floor()).min(steps) as u32;
            match runs.last_mut() {
                Some(run) if first <= run[1] => run[1] = run[1].max(end),
                _ if first < end => runs.push([first, end]),
                _ => {}
            }
        }
        if next[axis] >= exit {
            return runs;
        }
        cell[axis] += step[axis];
        if cell[axis] < 0 || cell[axis] >= limit[axis] {
            return runs;
        }
        t = leave.max(t);
        next[axis] = border(axis, cell[axis]);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use glam::{DAffine3, DVec3};
    use proptest::prelude::*;

    use super::*;
    use crate::scene::Interpolation;
    use crate::volume::{Border, FieldMap, FieldMaps, Grid, Volume};

    /// A sparse volume of 24³ voxels of 1 m with soot where the hash of the voxel says so, packed.
    fn sparse(seed: u32, interpolation: Interpolation) -> Medium {
        let soot = move |voxel: IVec3| {
            let block = voxel / 5;
            let hash = (block.x as u32 * 73 + block.y as u32 * 179 + block.z as u32 * 283 + seed)
                .wrapping_mul(0x9e37_79b1);
            if hash >> 29 == 0 { 1e-6 } else { 0.0 }
        };
        let grid = Grid::from_fn(
            "soot",
            IVec3::splat(24),
            DAffine3::IDENTITY,
            Border::Background,
            0.0,
            soot,
        );
        let maps = FieldMaps {
            soot: Some(FieldMap::new("soot", 1.0, 0.0, 0.0, 1.0)),
            ..FieldMaps::default()
        };
        let volume = Volume::from_grids(vec![grid], "sparse");
        crate::scene::pack_for_tests(&volume, &maps, interpolation).unwrap()
    }

    proptest! {
        /// No sample with soot is skipped: along axes, diagonals, grazing rays and any others.
        #[test]
        fn every_step_with_soot_is_in_a_run(
            seed in 0_u32..500,
            interpolation in prop::sample::select(Interpolation::ALL.to_vec()),
            origin in prop::array::uniform3(-40.0..60.0_f64),
            direction in prop_oneof![
                prop::array::uniform3(-1.0..1.0_f64),
                prop::sample::select(vec![
                    [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [-1.0, 1.0, -1.0],
                ]),
            ],
            whole in any::<bool>(),
            step_m in 0.2..9.0_f64,
        ) {
            let medium = sparse(seed, interpolation);
            let origin = DVec3::from(origin);
            // Half of the rays run exactly along planes of the lattice.
            let origin = if whole { origin.round() } else { origin };
            let Some(ray) = Ray::new(origin, direction.into()) else { return Ok(()) };
            let Some((local, [enter, exit])) = medium.enter(&ray) else { return Ok(()) };
            let runs = Chord::new(&medium, &ray, step_m).map_or(Runs::new(), |chord| chord.runs);
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
