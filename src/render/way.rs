//! A ray's way: through the fire, and to what it meets behind.

use super::bend::{Surroundings, bend, follow};
use super::chord::{Bricks, Chord};
use super::fields::Bent;
use crate::math::Ray;
use crate::scene::stage::{Hit, Screen, Stage};

/// What one ray passes.
pub(super) struct Way {
    /// Its steps through the fire; `None` if it meets nothing there.
    pub(super) chord: Option<Chord>,
    /// What it ends at.
    pub(super) end: End,
}

/// What a ray ends at.
pub(super) enum End {
    /// Nothing.
    Dark,
    /// A surface of the stage.
    Surface(Hit),
    /// The backdrop: X, Y, Z, W m⁻² sr⁻¹.
    Screen([f64; 3]),
}

/// Finds ways through one scene.
pub(super) struct Ways<'a> {
    pub(super) bricks: Bricks<'a>,
    pub(super) stage: &'a Stage,
    pub(super) screen: Option<Screen>,
    pub(super) bent: Option<&'a Bent>,
    pub(super) step_m: f64,
}

impl Ways<'_> {
    /// Whether a straight ray that meets no brick brings nothing home.
    pub(super) fn is_dark_behind(&self) -> bool {
        !self.stage.shows_behind()
    }

    /// The way of a ray of the world; a straight one meets bricks at most at distances in `range`.
    pub(super) fn of(&self, ray: &Ray, range: Option<[f64; 2]>) -> Way {
        match self.bent {
            Some(bent) => self.bent(ray, bent),
            None => self.straight(ray, range),
        }
    }

    fn straight(&self, ray: &Ray, range: Option<[f64; 2]>) -> Way {
        let hit = self.stage.hit(ray, f64::INFINITY);
        let limit_m = hit.map_or(f64::INFINITY, |hit| hit.distance_m);
        Way {
            chord: range
                .and_then(|range| Chord::new(self.bricks, ray, self.step_m, limit_m, range)),
            end: match (hit, &self.screen) {
                (Some(hit), _) => End::Surface(hit),
                (None, Some(screen)) => End::Screen(screen.xyz(ray)),
                (None, None) => End::Dark,
            },
        }
    }

    fn bent(&self, ray: &Ray, bent: &Bent) -> Way {
        let around = |gas| Surroundings {
            medium: self.bricks.medium,
            gas,
            stage: self.stage,
        };
        let main = bend(around(&bent.main), self.bricks, ray, self.step_m);
        let end = match (main.hit, &self.screen) {
            (Some(hit), _) => End::Surface(hit),
            (None, Some(screen)) => End::Screen(match &bent.others {
                None => screen.xyz(&main.exit),
                // What lies behind is seen in X, Y and Z each along a path of its own.
                Some([for_x, for_z]) => {
                    let seen = |gas, c: usize| screen.xyz(&follow(around(gas), ray).exit)[c];
                    let y = screen.xyz(&main.exit)[1];
                    [seen(for_x, 0), y, seen(for_z, 2)]
                }
            }),
            (None, None) => End::Dark,
        };
        Way {
            chord: main.chord,
            end,
        }
    }
}
