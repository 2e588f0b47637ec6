//! What stands in light's way between two places: ∫ f_v ds along a line, fine near one end, coarse farther off.

use glam::DVec3;

use super::cells::Cells;
use crate::math::Ray;
use crate::render::walk::for_each_stretch;
use crate::scene::Flame;
use crate::scene::medium::BRICK;

/// Distance, in bricks' edges, up to which a line is followed cell by cell: farther off, means of whole bricks do, for
/// there many lines pass each brick on their way to the point.
const NEAR_BRICKS: f64 = 2.0;

/// The medium's columns, for lines that begin at a point inside of it.
#[derive(Debug)]
pub(super) struct Columns {
    flame: Flame,
    cells: Cells,
    /// Mean of each brick's cells.
    bricks: Vec<[f32; 2]>,
}

impl Columns {
    /// Takes over the cells; only what stands in light's way is kept of them.
    pub(super) fn new(flame: &Flame, cells: Cells) -> Self {
        let count = cells.per_edge.pow(3);
        let mean = |cells: &[[f32; 2]]| {
            let sum = cells
                .iter()
                .fold([0.0; 2], |sum, cell| [sum[0] + cell[0], sum[1] + cell[1]]);
            sum.map(|sum| sum / count as f32)
        };
        Self {
            flame: flame.clone(),
            bricks: cells.dense.chunks_exact(count).map(mean).collect(),
            cells: Cells {
                dense_where_bright: Vec::new(),
                power: Vec::new(),
                growth: Vec::new(),
                spots: Vec::new(),
                ..cells
            },
        }
    }

    /// Whether a point of the world (m) lies in the medium's box.
    pub(super) fn hold(&self, point: DVec3) -> bool {
        let medium = self.flame.medium();
        let local = medium.lattice_from_world.transform_point3(point);
        local.cmpge(medium.domain.min).all() && local.cmple(medium.domain.max).all()
    }

    /// All volume fraction from a point on in a direction (any length), and the part of it that is smoke, m.
    #[inline]
    pub(super) fn behind(&self, point: DVec3, direction: DVec3) -> [f32; 2] {
        self.along(point, direction.normalize_or_zero(), f64::INFINITY)
    }

    /// The same between two points.
    #[inline]
    pub(super) fn between(&self, point: DVec3, other: DVec3) -> [f32; 2] {
        let apart = other - point;
        let length = apart.length();
        self.along(point, apart / length, length)
    }

    fn along(&self, point: DVec3, direction: DVec3, length_m: f64) -> [f32; 2] {
        let mut sum = [0.0; 2];
        let ray = Ray {
            origin: point,
            direction,
        };
        let medium = self.flame.medium();
        let Some((local, [enter, exit])) = medium.enter(&ray) else {
            return sum;
        };
        let exit = exit.min(length_m);
        if enter >= exit {
            return sum;
        }
        let near_m = NEAR_BRICKS * BRICK as f64 * medium.voxel_size_m;
        let step_m = self.cells.edge() * medium.voxel_size_m;
        let mut add = |dense: [f32; 2], length: f64| {
            for (sum, dense) in sum.iter_mut().zip(dense) {
                *sum += dense * length as f32;
            }
        };
        for_each_stretch(medium, &local, [enter, exit], |stretch| {
            let length = stretch.to - stretch.from;
            if stretch.from > near_m {
                add(self.bricks[stretch.slot as usize], length);
                return;
            }
            let steps = (length / step_m).ceil().max(1.0);
            let step = length / steps;
            for i in 0..steps as u32 {
                let position = local.at(stretch.from + (f64::from(i) + 0.5) * step);
                add(
                    self.cells.dense[self.cells.cell_at(stretch.slot, position)],
                    step,
                );
            }
        });
        sum
    }
}
