//! Cuts through a packed medium, for whoever wants to see what is in it: a plane across one of the world's axes, and the
//! profile along one.

use glam::DVec3;

use super::medium::Medium;
use crate::math::Aabb;

/// Soot volume fraction of the medium, and temperature (K; 0 where nothing is known of the gas).
pub type Cell = [f32; 2];

/// A plane across an axis, sampled at the middles of equal cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Cells across and up.
    pub size: [usize; 2],
    /// Row by row from the top.
    pub cells: Vec<Cell>,
    /// The lower left corner and the upper right one, m, on the two axes that [`axes_of`] gives.
    pub corners: [[f64; 2]; 2],
    /// Where on the axis it lies, m.
    pub at_m: f64,
}

/// The world's axes (0 to 2 for x, y and z) that go across and up in a plane across an axis: what is up in the world is up.
pub fn axes_of(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

impl Slice {
    /// The plane across an axis at a share 0 to 1 of the medium's box, with at most `most` cells on a side, and no more than
    /// voxels.
    pub fn new(medium: &Medium, axis: usize, share: f64, most: usize) -> Self {
        let room = room_of(medium);
        let [across, up] = axes_of(axis);
        let side = room.size().max_element().max(f64::MIN_POSITIVE);
        let voxels = (side / medium.voxel_size_m()).ceil().max(1.0);
        let cells_of = |axis: usize| {
            let share = room.size()[axis] / side;
            ((share * voxels.min(most as f64)).round() as usize).max(1)
        };
        let size = [cells_of(across), cells_of(up)];
        let at_m = room.min[axis] + share.clamp(0.0, 1.0) * room.size()[axis];
        let cell = |column: usize, row: usize| {
            let mut at = DVec3::ZERO;
            at[axis] = at_m;
            let along = |axis: usize, i: usize, of: usize| {
                room.min[axis] + (i as f64 + 0.5) / of as f64 * room.size()[axis]
            };
            at[across] = along(across, column, size[0]);
            at[up] = along(up, size[1] - 1 - row, size[1]);
            sample(medium, at)
        };
        Self {
            cells: (0..size[1])
                .flat_map(|row| (0..size[0]).map(move |column| (column, row)))
                .map(|(column, row)| cell(column, row))
                .collect(),
            size,
            corners: [room.min, room.max].map(|corner| [corner[across], corner[up]]),
            at_m,
        }
    }

    /// The cell at shares of the width from the left and of the height from the top, with its place on the two axes, m.
    pub fn at(&self, shares: [f64; 2]) -> Option<([f64; 2], Cell)> {
        if shares.iter().any(|share| !(0.0..1.0).contains(share)) {
            return None;
        }
        let index = [0, 1].map(|c| (shares[c] * self.size[c] as f64) as usize);
        let cell = self.cells.get(index[1] * self.size[0] + index[0])?;
        let [low, high] = self.corners;
        let up = 1.0 - shares[1];
        let place = [
            low[0] + shares[0] * (high[0] - low[0]),
            low[1] + up * (high[1] - low[1]),
        ];
        Some((place, *cell))
    }
}

/// What there is at each of `count` places along an axis: where (m), the highest temperature where there is soot (K; 0 where
/// there is none) and the mean soot volume fraction of the medium, over a plane of `side`² cells across it.
pub fn profile(medium: &Medium, axis: usize, count: usize, side: usize) -> Vec<(f64, f32, f32)> {
    let of_plane = |i: usize| {
        let slice = Slice::new(medium, axis, (i as f64 + 0.5) / count as f64, side);
        let sooty = slice.cells.iter().filter(|[soot, _]| *soot > 0.0);
        let hottest = sooty.fold(0.0, |most: f32, [_, kelvin]| most.max(*kelvin));
        let sum: f32 = slice.cells.iter().map(|[soot, _]| soot).sum();
        (slice.at_m, hottest, sum / slice.cells.len().max(1) as f32)
    };
    (0..count).map(of_plane).collect()
}

fn sample(medium: &Medium, world: DVec3) -> Cell {
    let at = medium.lattice_from_world.transform_point3(world);
    medium.sample(at).map(|value| value as f32)
}

/// The box in which the medium is defined, in the world, m.
fn room_of(medium: &Medium) -> Aabb {
    medium
        .domain
        .transformed(&medium.lattice_from_world.inverse())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::sync::Arc;

    use glam::{DAffine3, IVec3};

    use super::*;
    use crate::project::Project;
    use crate::volume::{Border, Grid, Volume};

    /// A box of 6 × 4 × 10 voxels of 0.1 m whose temperature rises with z and whose soot rises with x.
    fn medium() -> Medium {
        let world = DAffine3::from_scale(DVec3::splat(0.1));
        let grid = |name: &str, value: fn(IVec3) -> f64| {
            let size = IVec3::new(6, 4, 10);
            Grid::from_fn(name, size, world, Border::Clamp, 0.0, |at| value(at) as f32)
        };
        let grids = vec![
            grid("soot", |at| 1e-6 * f64::from(at.x + 1)),
            grid("temperature", |at| 1000.0 + 100.0 * f64::from(at.z)),
        ];
        let volume = Arc::new(Volume::from_grids(grids, "ramp"));
        let mut project = Project::default();
        project.set("volume.producer=physical").unwrap();
        let job = project.job(&volume).unwrap();
        job.scene(None).flame.medium().clone()
    }

    #[test]
    fn a_plane_shows_what_is_there_with_up_on_top() {
        let medium = medium();
        let slice = Slice::new(&medium, 1, 0.5, 1000);
        assert_eq!(slice.cells.len(), slice.size[0] * slice.size[1]);
        // Voxels and no finer; longer upwards.
        assert!(
            slice.size[1] <= 11 && slice.size[0] < slice.size[1],
            "{:?}",
            slice.size
        );
        let (at, top) = slice.at([0.5, 0.1]).unwrap();
        let (_, bottom) = slice.at([0.5, 0.9]).unwrap();
        assert!(top[1] > bottom[1] + 500.0, "{top:?} {bottom:?}");
        let wanted = 1000.0 + 1000.0 * at[1];
        assert!(
            (f64::from(top[1]) - wanted).abs() < 120.0,
            "{top:?} {wanted}"
        );
        let [left, right] = [0.1, 0.9].map(|x| slice.at([x, 0.5]).unwrap().1[0]);
        assert!(right > 2.0 * left, "{left} {right}");
        assert_eq!(slice.at([1.0, 0.5]), None);
        // Few cells are enough where few are asked for.
        assert!(Slice::new(&medium, 1, 0.5, 4).size[1] <= 4);
    }

    #[test]
    fn a_profile_rises_as_the_field_does() {
        let medium = medium();
        let up = profile(&medium, 2, 8, 16);
        assert_eq!(up.len(), 8);
        assert!(up.windows(2).all(|two| two[1].0 > two[0].0));
        assert!(up[6].1 > up[1].1 + 400.0, "{up:?}");
        // Soot is the same at every height.
        assert!((up[6].2 / up[1].2 - 1.0).abs() < 0.2, "{up:?}");
        let across = profile(&medium, 0, 6, 16);
        assert!(across[4].2 > 2.0 * across[0].2, "{across:?}");
    }
}
