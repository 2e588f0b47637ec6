//! All that may throw a shadow on one point, for asking about many lights.

use std::ops::Range;

use glam::DVec3;

use super::Stage;
use super::shadow::{Beam, Bound, Caster, Place};

/// What stands between one point of a surface and all the light that it may get, made ready to be asked about parts of that
/// light.
#[derive(Debug, Clone)]
pub struct Shadows {
    point: DVec3,
    casters: Vec<Bounded>,
}

/// A caster, and where it surely casts nothing. The ground and what is around the point have no bound.
#[derive(Debug, Clone, Copy)]
struct Bounded {
    bound: Option<Bound>,
    caster: Caster,
}

impl Bounded {
    /// Which share of a ball's light it leaves.
    #[inline]
    fn leaves(&self, beam: &Beam) -> f64 {
        match &self.bound {
            Some(bound) if bound.is_clear_of(beam) => 1.0,
            _ => self.caster.leaves(beam),
        }
    }
}

impl Shadows {
    pub(super) fn new(
        stage: &Stage,
        point: DVec3,
        normal: DVec3,
        (centre, radius_m): (DVec3, f64),
    ) -> Self {
        let place = &Place { point, normal };
        let all = &Beam::new(point, centre, radius_m);
        let ground = stage.ground.iter().filter_map(|ground| {
            let caster = Caster::of_ground(place, ground)?;
            (caster.leaves(all) < 1.0).then_some(Bounded {
                bound: None,
                caster,
            })
        });
        let bounded = |bound: Bound, caster: &dyn Fn() -> Option<Caster>| {
            if bound.is_clear_of(all) {
                return None;
            }
            Some(Bounded {
                bound: Some(bound),
                caster: caster()?,
            })
        };
        let spheres = stage.spheres.iter().filter_map(|sphere| {
            bounded(Bound::of_sphere(place, sphere), &|| {
                Caster::of_sphere(place, sphere)
            })
        });
        let logs = stage
            .logs
            .iter()
            .filter_map(|log| bounded(Bound::of_log(place, log), &|| Caster::of_log(place, log)));
        Self {
            point,
            casters: ground.chain(spheres).chain(logs).collect(),
        }
    }

    /// How many objects there are.
    pub fn count(&self) -> usize {
        self.casters.len()
    }

    /// How much of the light of a ball (radius in m) among the lights, 0 to 1, comes past all objects.
    pub fn visibility(&self, to: DVec3, radius_m: f64) -> f64 {
        let beam = Beam::new(self.point, to, radius_m);
        let left = self.casters.iter().map(|caster| caster.leaves(&beam));
        product(left)
    }

    /// The same past the objects of these numbers.
    pub fn visibility_past(&self, objects: &[u32], to: DVec3, radius_m: f64) -> f64 {
        let beam = Beam::new(self.point, to, radius_m);
        let left = objects
            .iter()
            .map(|&at| self.casters[at as usize].leaves(&beam));
        product(left)
    }

    /// Of the objects at these places of a list of their numbers, adds those to the list that hide a part of a ball (radius
    /// in m); `false` if one of them hides all of it.
    pub fn list_those_before(
        &self,
        list: &mut Vec<u32>,
        among: Range<usize>,
        to: DVec3,
        radius_m: f64,
    ) -> bool {
        let beam = Beam::new(self.point, to, radius_m);
        for at in among {
            let left = self.casters[list[at] as usize].leaves(&beam);
            if left <= 0.0 {
                return false;
            }
            if left < 1.0 {
                list.push(list[at]);
            }
        }
        true
    }
}

/// The product of shares, no farther than to the first 0.
fn product(shares: impl Iterator<Item = f64>) -> f64 {
    let mut product = 1.0;
    for share in shares {
        product *= share;
        if product <= 0.0 {
            return 0.0;
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::stage::{Ground, Log, Sphere};
    use proptest::prelude::*;

    fn place() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-2.0..2.0_f64).prop_map(DVec3::from)
    }

    proptest! {
        /// What is passed over would have hidden nothing.
        #[test]
        fn only_what_hides_nothing_is_passed_over(
            spheres in prop::collection::vec((place(), 0.01..0.4_f64), 0..20),
            logs in prop::collection::vec((place(), place(), 0.01..0.2_f64), 0..20),
            point in place(),
            normal in place(),
            lights in (place(), 0.01..2.0_f64),
            balls in prop::collection::vec((place(), 0.0..1.0_f64), 50),
        ) {
            let colour = [0.5; 3];
            let stage = Stage {
                ground: Some(Ground { height_m: -1.0, colour }),
                spheres: spheres
                    .into_iter()
                    .map(|(centre, radius_m)| Sphere { centre, radius_m, colour })
                    .collect(),
                logs: logs
                    .into_iter()
                    .map(|(end, other, radius_m)| Log { ends: [end, other], radius_m, colour })
                    .collect(),
                ..Stage::default()
            };
            let normal = normal.normalize_or(DVec3::Z);
            let here = &Place { point, normal };
            let ground = stage.ground.iter().filter_map(|it| Caster::of_ground(here, it));
            let spheres = stage.spheres.iter().filter_map(|it| Caster::of_sphere(here, it));
            let logs = stage.logs.iter().filter_map(|it| Caster::of_log(here, it));
            let all: Vec<Caster> = ground.chain(spheres).chain(logs).collect();
            let shadows = stage.shadows_at(point, normal, lights);
            let numbers: Vec<u32> = (0..shadows.count() as u32).collect();
            for (off, share) in balls {
                // Inside of the ball of all lights, and as large as it may be there.
                let off = off.clamp_length_max(1.0) * lights.1;
                let (to, radius_m) = (lights.0 + off, share * (lights.1 - off.length()) + 1e-6);
                let radius_m = radius_m.min(lights.1 - off.length()).max(1e-9);
                let beam = Beam::new(point, to, radius_m);
                let slowly: f64 = all.iter().map(|caster| caster.leaves(&beam)).product();
                let seen = shadows.visibility(to, radius_m);
                prop_assert!((seen - slowly).abs() < 1e-12, "{} {}", seen, slowly);
                let mut list = numbers.clone();
                let among = 0..list.len();
                let some = shadows.list_those_before(&mut list, among, to, radius_m);
                let left = shadows.visibility_past(&list[numbers.len()..], to, radius_m);
                prop_assert_eq!(if some { left } else { 0.0 }, seen);
            }
        }
    }
}
