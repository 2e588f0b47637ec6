//! Where collisions may be: bounds of each brick, and a ray's way through the bricks.

use glam::IVec3;
use rayon::prelude::*;

use crate::math::Ray;
use crate::render::walk::{Stretch, for_each_stretch};
use crate::scene::Interpolation;
use crate::scene::medium::{BRICK_SAMPLES, Medium, NO_BRICK};

use super::optics::{Optics, Place};

/// What one brick is at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Largest extinction at any point and wavelength, 1/m. Values between samples are means of samples, so the
    /// largest of those that are read bounds them all.
    pub(super) extinction: f64,
    /// Brightest sample, in the measure of [`Optics::glow`].
    pub(super) glow: f64,
}

/// Bounds of all stored bricks, in the order of their slots.
pub(super) fn bounds(medium: &Medium, optics: &Optics) -> Vec<Bounds> {
    let of_brick = |(slot, samples): (usize, &[[f32; 2]])| {
        let start = (0.0_f64, 0.0_f64);
        let (extinction, glow) =
            samples
                .iter()
                .enumerate()
                .fold(start, |(extinction, glow), (i, sample)| {
                    let [volume_fraction, kelvin] = sample.map(f64::from);
                    let beside = |field: &[f32]| {
                        let value = field.get(slot * BRICK_SAMPLES + i);
                        f64::from(value.copied().unwrap_or(0.0))
                    };
                    let place = Place {
                        soot: volume_fraction,
                        kelvin,
                        flame: beside(&medium.flame),
                        smoke: beside(&medium.smoke),
                    };
                    (
                        extinction.max(optics.extinction(&place)),
                        glow.max(optics.glow(&place)),
                    )
                });
        Bounds { extinction, glow }
    };
    let own: Vec<Bounds> = medium
        .samples
        .par_chunks_exact(BRICK_SAMPLES)
        .enumerate()
        .map(of_brick)
        .collect();
    match medium.interpolation() {
        Interpolation::Nearest | Interpolation::Trilinear => own,
        Interpolation::Tricubic => with_neighbours(medium, &own),
    }
}

/// Bounds of bricks that read samples of the bricks beside them as well.
fn with_neighbours(medium: &Medium, own: &[Bounds]) -> Vec<Bounds> {
    let mut wide = own.to_vec();
    let size = medium.bricks.as_ivec3();
    let bricks = (0..size.z).flat_map(|z| (0..size.y).map(move |y| (y, z)));
    let bricks = bricks.flat_map(|(y, z)| (0..size.x).map(move |x| IVec3::new(x, y, z)));
    let slot_of = |brick: IVec3| match medium.table[medium.brick_index(brick.as_uvec3())] {
        NO_BRICK => None,
        slot => Some(slot as usize),
    };
    for brick in bricks {
        let Some(slot) = slot_of(brick) else { continue };
        for i in 0..27 {
            let beside = brick + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1;
            if beside.cmplt(IVec3::ZERO).any() || beside.cmpge(size).any() {
                continue;
            }
            if let Some(beside) = slot_of(beside) {
                wide[slot].extinction = wide[slot].extinction.max(own[beside].extinction);
                wide[slot].glow = wide[slot].glow.max(own[beside].glow);
            }
        }
    }
    wide
}

/// Collects the stretches of a ray of the lattice that have a length.
pub(super) fn stretches(medium: &Medium, ray: &Ray, range: [f64; 2], found: &mut Vec<Stretch>) {
    found.clear();
    for_each_stretch(medium, ray, range, |stretch| {
        if stretch.to > stretch.from {
            found.push(stretch);
        }
    });
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::render::walk::tests::sparse;

    proptest! {
        /// Stretches come in order, apart, and hold every point with soot, within its brick's bound: along axes, planes
        /// and any ray.
        #[test]
        fn every_point_with_soot_is_in_a_stretch(
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
        ) {
            let medium = sparse(seed, interpolation);
            let origin = DVec3::from(origin);
            let origin = if whole { origin.round() } else { origin };
            let Some(ray) = Ray::new(origin, direction.into()) else { return Ok(()) };
            let Some((local, range)) = medium.enter(&ray) else { return Ok(()) };
            let optics = Optics::of_grey_soot();
            let bounds = bounds(&medium, &optics);
            let mut found = Vec::new();
            stretches(&medium, &local, range, &mut found);
            prop_assert!(found.iter().all(|s| s.from < s.to && s.from >= range[0] && s.to <= range[1]));
            prop_assert!(found.windows(2).all(|pair| pair[0].to <= pair[1].from), "{found:?}");
            for i in 0..500 {
                let t = range[0] + (range[1] - range[0]) * (f64::from(i) + 0.5) / 500.0;
                // Within rounding of a border a point may belong to either side.
                let [soot, kelvin] = medium.sample(local.at(t));
                let place = Place { soot, kelvin, flame: 0.0, smoke: 0.0 };
                if soot > 1e-18 {
                    let held = found.iter().any(|s| s.from - 1e-9 <= t && t <= s.to + 1e-9);
                    prop_assert!(held, "t = {t} is in no stretch: {found:?}");
                    let inside = found.iter().filter(|s| s.from + 1e-9 <= t && t <= s.to - 1e-9);
                    for stretch in inside {
                        let bound = bounds[stretch.slot as usize].extinction;
                        prop_assert!(optics.extinction(&place) <= bound * (1.0 + 1e-12), "t = {t}: above its bound");
                    }
                }
            }
        }
    }
}
