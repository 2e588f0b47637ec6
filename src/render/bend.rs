//! A ray of the camera on its bent way through a fire's gas: what the march needs of it, where it comes out, and what it
//! meets.
//!
//! Outside of the domain and in bricks that are not stored there is air, and the path is straight: such parts are one
//! segment each. In stored bricks the path is integrated ([`super::eikonal`]) in steps of at most a voxel, so that no
//! structure of the grid is missed. Then the path is cut into the march's steps, as [`super::chord`] cuts a straight one:
//! equal in length along the arc, counted from where the ray enters the domain, the last one shorter.
//!
//! A path belongs to its ray alone: the same ray gives the same bits, whatever goes beside it.

use glam::DVec3;

use super::chord::{Bricks, Chord, Run, Runs, cuts_of, known_cuts};
use super::eikonal::{Index, Path, Tolerance};
use super::walk::for_each_stored;
use crate::math::Ray;
use crate::scene::Stage;
use crate::scene::medium::Medium;
use crate::scene::refractivity::{Refractivity, stored};
use crate::scene::stage::Hit;

/// Greatest estimated error of a step's direction, rad: a fiftieth of a pixel of 40° over 1500 pixels. The estimate is of
/// the second order, what is kept of the third: against steps a thousand times as exact, rays through a torch and a pool
/// fire come out within 4e-6 (measured), and a step of a voxel is nearly always enough.
const DIRECTION_RAD: f64 = 1e-5;
/// Greatest estimated error of a step's position, voxels: far below what the grid resolves.
const POSITION_VOXELS: f64 = 1e-4;
/// Distance from the domain's face at which the path counts as out, voxels.
const AT_FACE_VOXELS: f64 = 1e-6;
/// Longest path as a multiple of the domain's diagonal. Gas never winds light up so; numbers of a file might, and the path
/// must end.
const LONGEST_DIAGONALS: f64 = 4.0;

/// Knots for which there is room at first: a path that crosses a fire of usual size needs no more.
const KNOTS: usize = 128;

/// What a ray goes through.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    /// The fire.
    pub(super) medium: &'a Medium,
    /// Its gas, at the wavelength whose path is followed.
    pub(super) gas: &'a Refractivity,
    /// What stands around.
    pub(super) stage: &'a Stage,
}

/// A ray's way.
pub(super) struct Bent {
    /// Its part inside the domain; `None` if it meets no stored brick.
    pub(super) chord: Option<Chord>,
    /// How it goes on in the world behind the domain: its origin is where it comes out, or ends on a surface. The ray
    /// itself where it misses the domain or meets a surface before.
    pub(super) exit: Ray,
    /// The first surface that it meets, before, in or behind the domain; its distance is the length of the path from the
    /// eye. In the domain the path and its chord end there.
    pub(super) hit: Option<Hit>,
}

/// Follows a ray of the world, whose direction is a unit vector, and cuts it into steps of `step_m` metres, above 0. A
/// step longer than the path is the path.
pub(super) fn bend(around: Surroundings<'_>, bricks: Bricks<'_>, ray: &Ray, step_m: f64) -> Bent {
    let way = follow(around, ray);
    Bent {
        chord: cut(bricks, &way.knots, step_m),
        exit: way.exit,
        hit: way.hit,
    }
}

/// A point of a path, with the length of the path from the domain's face to there, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    pub(super) arc_m: f64,
    pub(super) at: Ray,
}

/// A path that is not cut yet.
pub(super) struct Way {
    /// Points of its part in the domain; none if it misses.
    pub(super) knots: Vec<Knot>,
    /// As in [`Bent`].
    pub(super) exit: Ray,
    /// As in [`Bent`].
    pub(super) hit: Option<Hit>,
}

/// Follows a ray of the world, whose direction is a unit vector.
pub(super) fn follow(around: Surroundings<'_>, ray: &Ray) -> Way {
    let outside = |hit| Way {
        knots: Vec::new(),
        exit: *ray,
        hit,
    };
    let Some((_, [enter_m, _])) = around.medium.enter(ray) else {
        return outside(around.stage.hit(ray, f64::INFINITY));
    };
    if let Some(hit) = around.stage.hit(ray, enter_m) {
        return outside(Some(hit));
    }

    // Through the domain.
    let mut walk = Walk {
        around,
        has_surfaces: around.stage.has_surfaces(),
        knots: Vec::with_capacity(KNOTS),
    };
    walk.knots.push(Knot {
        arc_m: 0.0,
        at: Ray {
            origin: ray.at(enter_m),
            direction: ray.direction,
        },
    });
    let inside = walk.through();

    // Straight on, behind it.
    let Knot { arc_m, at: exit } = walk.end();
    let behind = || around.stage.hit(&exit, f64::INFINITY);
    let hit = match inside {
        Some(hit) => Some(Hit {
            distance_m: enter_m + arc_m,
            ..hit
        }),
        None => behind().map(|hit| Hit {
            distance_m: enter_m + arc_m + hit.distance_m,
            ..hit
        }),
    };
    Way {
        knots: walk.knots,
        exit,
        hit,
    }
}

/// A path on its way through the domain.
struct Walk<'a> {
    around: Surroundings<'a>,
    has_surfaces: bool,
    /// At least the point where it enters.
    knots: Vec<Knot>,
}

impl Walk<'_> {
    /// The last point.
    fn end(&self) -> Knot {
        self.knots[self.knots.len() - 1]
    }

    /// Goes through the domain, to its far face or to a surface in it.
    fn through(&mut self) -> Option<Hit> {
        let medium = self.around.medium;
        let diagonal = medium.domain.size().length() * medium.voxel_size_m();
        let longest_m = LONGEST_DIAGONALS * diagonal;
        while self.end().arc_m < longest_m {
            // Straight to the next stored brick, or out.
            let here = self.end().at;
            let (local, [_, out_m]) = medium.enter(&here)?;
            if out_m <= AT_FACE_VOXELS * medium.voxel_size_m() {
                return None;
            }
            let brick_m = first_stored(medium, &local, out_m);
            let length_m = brick_m.unwrap_or(out_m);
            if length_m > 0.0 {
                let end = Ray {
                    origin: here.at(length_m),
                    direction: here.direction,
                };
                if let Some(hit) = self.go(length_m, end) {
                    return Some(hit);
                }
            }
            // Bent through it, and through those beside it.
            brick_m?;
            if let Some(hit) = self.through_bricks(longest_m) {
                return Some(hit);
            }
        }
        None
    }

    /// Goes on through stored bricks, at least a step: rounding may leave the path just before one. To a surface, the
    /// domain's face, or a brick that is not stored.
    fn through_bricks(&mut self, longest_m: f64) -> Option<Hit> {
        let Surroundings { medium, gas, .. } = self.around;
        let voxel_m = medium.voxel_size_m();
        let ambient = gas.ambient();
        let index = |point: DVec3| {
            let position = medium.lattice_from_world.transform_point3(point).to_array();
            let [excess, x, y, z] = gas.at(medium, position).map(f64::from);
            Index {
                refractivity: ambient + excess,
                gradient: DVec3::new(x, y, z),
            }
        };
        let tolerance = Tolerance {
            position_m: POSITION_VOXELS * voxel_m,
            direction_rad: DIRECTION_RAD,
            longest_m: voxel_m,
        };
        let mut path = Path::new(index, self.end().at, tolerance);
        while self.end().arc_m < longest_m {
            // No further than to the domain's face.
            let local = path.at().transformed(&medium.lattice_from_world);
            let ahead = local.at(voxel_m);
            let domain = &medium.domain;
            let stays = ahead.cmpge(domain.min).all() && ahead.cmple(domain.max).all();
            let limit_m = if stays {
                voxel_m
            } else {
                domain.intersect(&local).map_or(0.0, |(_, out_m)| out_m)
            };
            if limit_m <= AT_FACE_VOXELS * voxel_m {
                return None;
            }
            let length_m = path.advance(limit_m);
            if let Some(hit) = self.go(length_m, path.at()) {
                return Some(hit);
            }
            let end = medium.lattice_from_world.transform_point3(path.at().origin);
            stored(medium, end.to_array().map(|p| p as i32))?;
        }
        None
    }

    /// Goes a segment of this length, unless a surface is in its way.
    fn go(&mut self, length_m: f64, end: Ray) -> Option<Hit> {
        let Knot { arc_m, at } = self.end();
        // Along its chord, so that segments leave no gap for a surface to slip through.
        let hit = if self.has_surfaces {
            let across = end.origin - at.origin;
            Ray::new(at.origin, across)
                .and_then(|chord| self.around.stage.hit(&chord, across.length()))
        } else {
            None
        };
        self.knots.push(match hit {
            None => Knot {
                arc_m: arc_m + length_m,
                at: end,
            },
            Some(hit) => Knot {
                arc_m: arc_m + hit.distance_m,
                at: Ray {
                    origin: hit.point,
                    direction: end.direction,
                },
            },
        });
        hit
    }
}

/// Where along a ray of the lattice, from 0 to `out_m`, its first stored brick begins.
fn first_stored(medium: &Medium, local: &Ray, out_m: f64) -> Option<f64> {
    let mut first = None;
    for_each_stored(medium, local, [0.0, out_m], |stretch| {
        first.get_or_insert(stretch.from);
    });
    first
}

/// Cuts a path into steps; `None` if it meets no stored brick.
fn cut(bricks: Bricks<'_>, knots: &[Knot], step_m: f64) -> Option<Chord> {
    let medium = bricks.medium;
    let length_m = knots.last()?.arc_m;
    // A path that is whole steps long up to rounding has no extra sliver of a step.
    let steps = (length_m / step_m - 1e-9).ceil().max(1.0);
    let last_share = (length_m - (steps - 1.0) * step_m) / step_m;
    let last = (steps - 1.0) as u32;
    let mut runs = Runs::new();
    let mut segments = knots.windows(2);
    let mut segment = segments.next()?;
    let mut at = |arc_m: f64| {
        while arc_m > segment[1].arc_m {
            let Some(next) = segments.next() else { break };
            segment = next;
        }
        let point = between([segment[0], segment[1]], arc_m);
        medium.lattice_from_world.transform_point3(point).to_array()
    };
    let along = medium
        .lattice_from_world
        .transform_vector3(knots[0].at.direction);
    let known = known_cuts(medium, along * step_m);
    let cuts_at = |position: [f64; 3]| {
        stored(medium, position.map(|p| p as i32)).map_or(0, |slot| cuts_of(bricks, known, slot))
    };
    let mut middles = Vec::with_capacity(last as usize + 1);
    let mut begin_cuts = cuts_at(at(0.0));
    for step in 0..=last {
        let share = if step == last { last_share } else { 1.0 };
        let place = |part: f64| (f64::from(step) + part * share) * step_m;
        let position = at(place(0.5));
        let end_cuts = cuts_at(at(place(1.0)));
        let cuts = begin_cuts.max(cuts_at(position)).max(end_cuts);
        begin_cuts = end_cuts;
        match runs.last_mut() {
            Some(run) if run.end == step && run.cuts == cuts => run.end = step + 1,
            _ if cuts > 0 => runs.push(Run {
                first: step,
                end: step + 1,
                cuts,
            }),
            _ => {}
        }
        middles.push(position);
    }
    (!runs.is_empty()).then(|| Chord {
        start: middles[0],
        delta: [0.0; 3],
        last,
        last_share: last_share as f32,
        runs,
        middles,
    })
}

/// The point of a segment at a length of the path: the cubic with the ends' places and directions (Hermite). On a straight
/// segment it is the straight line.
fn between([from, to]: [Knot; 2], arc_m: f64) -> DVec3 {
    let length_m = to.arc_m - from.arc_m;
    if length_m <= 0.0 {
        return to.at.origin;
    }
    let u = ((arc_m - from.arc_m) / length_m).clamp(0.0, 1.0);
    let v = 1.0 - u;
    let line = v * from.at.origin + u * to.at.origin;
    let across = to.at.origin - from.at.origin;
    let bow =
        v * (length_m * from.at.direction - across) - u * (length_m * to.at.direction - across);
    line + u * v * bow
}

#[cfg(test)]
mod tests;
