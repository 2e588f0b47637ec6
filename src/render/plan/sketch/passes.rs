//! Rays of a coarse raster through the parts of bricks.

use glam::DVec3;
use rayon::prelude::*;

use crate::math::Ray;
use crate::render::walk::{Stretch, for_each_stored};
use crate::scene::Scene;
use crate::scene::means::{PART_EDGE, PARTS};
use crate::scene::medium::BRICK;

/// Rays along the longer side of the raster.
const RAYS: u32 = 40;

/// What a sketched ray ends at.
#[derive(Debug, Clone, Copy)]
pub(super) enum Behind {
    Dark,
    Screen([f64; 3]),
    /// A surface: place, normal, mean albedo.
    Surface(DVec3, DVec3, f64),
}

/// The parts of bricks that a ray passes, front to back, with metres in each, and what is behind.
pub(super) struct Pass {
    pub(super) parts: Vec<(u32, f64)>,
    pub(super) behind: Behind,
}

/// The rays of a picture's raster.
pub(super) fn passes(scene: &Scene, size: [u32; 2]) -> Vec<Pass> {
    let Ok(view) = scene.camera.view(size) else {
        return Vec::new();
    };
    let medium = scene.flame.medium();
    let backdrop = scene.stage.backdrop.as_ref();
    let screen = backdrop.and_then(|it| it.facing(&scene.camera, size).ok());
    let longer = f64::from(size[0].max(size[1]));
    let counts = size.map(|side| {
        ((f64::from(side) / longer * f64::from(RAYS)).ceil() as u32)
            .min(side)
            .max(1)
    });
    let pass = |i: u32| {
        let cell = [i % counts[0], i / counts[0]];
        let [x, y] = [0, 1].map(|axis| {
            // From border to border: what is just in the picture is seen.
            let along = f64::from(cell[axis]) / f64::from((counts[axis] - 1).max(1));
            along * f64::from(size[axis])
        });
        let ray: Ray = view.ray(x, y);
        let hit = scene.stage.hit(&ray, f64::INFINITY);
        let limit = hit.map_or(f64::INFINITY, |hit| hit.distance_m);
        let mut parts = Vec::new();
        if let Some((local, [enter, exit])) = medium.enter(&ray)
            && enter < limit
        {
            for_each_stored(medium, &local, [enter, exit.min(limit)], |stretch| {
                in_parts(&local, stretch, &mut parts);
            });
        }
        let behind = match (hit, &screen) {
            (Some(hit), _) => {
                let albedo = hit.colour.into_iter().fold(0.0, f64::max);
                Behind::Surface(hit.point, hit.normal, albedo)
            }
            (None, Some(screen)) => Behind::Screen(screen.xyz(&ray)),
            (None, None) => Behind::Dark,
        };
        Pass { parts, behind }
    };
    (0..counts[0] * counts[1])
        .into_par_iter()
        .map(pass)
        .collect()
}

/// Cuts a ray's stretch in a brick where it goes from one part of it to another.
fn in_parts(local: &Ray, stretch: Stretch, parts: &mut Vec<(u32, f64)>) {
    let Stretch { slot, from, to } = stretch;
    let middle = local.at(0.5 * (from + to));
    let brick = (middle / BRICK as f64).floor() * BRICK as f64;
    let mut cuts = [to; 4];
    for axis in 0..3 {
        let t = (brick[axis] + PART_EDGE as f64 - local.origin[axis]) / local.direction[axis];
        if t > from && t < to {
            cuts[axis] = t;
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut begin = from;
    for cut in cuts {
        if cut > begin {
            let within = local.at(0.5 * (begin + cut)) - brick;
            let half = within.cmpge(DVec3::splat(PART_EDGE as f64)).bitmask();
            parts.push((slot * PARTS as u32 + half, cut - begin));
            begin = cut;
        }
    }
}
