//! What leaving an effect out changes in the picture at most, ΔE_ITP.
//!
//! Nothing is rendered for it: a [`Sketch`] of brick means with the effect's most and without it says how far apart two
//! pictures can be. Each bound is checked against pictures with and without the effect in `tests/bounds.rs`.

use super::sketch::{self, Of, Sketch};
use crate::physics::soot::volume_fraction_factor;
use crate::scene::glow::Kind;
use crate::scene::means::PartMean;
use crate::scene::{FlameParams, Scene};

/// Above this, how much more makes no difference to anyone, ΔE_ITP: white against black.
const MOST: f64 = 400.0;

/// Where smoke takes most of the light that counts, nm.
const SMOKE_NM: f64 = 400.0;

/// Scattering once: what it takes away, and what it brings.
pub(super) fn scattering(sketch: &Sketch<'_>) -> f64 {
    let plain = sketch.of(Of::Radicals, true);
    let less = sketch.of(Of::ScatteredAway, true);
    let more = sketch.of(Of::ScatteredHere, true);
    let cool = sketch.of_cooler(Of::Plain, true);
    let cool_more = sketch.of_cooler(Of::ScatteredHere, true);
    sketch::greatest(&plain, &less)
        .max(sketch::greatest(&plain, &more))
        .max(sketch::greatest_seen(&plain, &cool, &cool_more))
        .min(MOST)
}

/// Scattering more than once.
pub(super) fn orders(sketch: &Sketch<'_>) -> f64 {
    let once = sketch.of(Of::ScatteredHere, true);
    let often = sketch.of(Of::ScatteredOften, true);
    let cool = sketch.of_cooler(Of::ScatteredHere, true);
    let cool_often = sketch.of_cooler(Of::ScatteredOften, true);
    sketch::greatest(&once, &often)
        .max(sketch::greatest_seen(&once, &cool, &cool_often))
        .min(MOST)
}

/// The light of radicals.
pub(super) fn radicals(sketch: &Sketch<'_>) -> f64 {
    let without = sketch.of(Of::Plain, false);
    let with = sketch.of(Of::Radicals, false);
    // Where soot is dense only its outside is seen, which may be cooler than the mean.
    let cool = sketch.of_cooler(Of::Plain, false);
    let cool_with = sketch.of_cooler(Of::Radicals, false);
    sketch::greatest(&without, &with).max(sketch::greatest_seen(&without, &cool, &cool_with))
}

/// Lines or bands of a metal: as bright as if they were thin, and of the colour that counts most.
pub(super) fn of_metal(sketch: &Sketch<'_>, kind: Kind) -> f64 {
    let range_nm = [360.0, 830.0];
    let glow = sketch.flame.glow().only(kind);
    let shines = |brick: &PartMean| {
        let mut matter = sketch.plain(brick);
        if brick.hottest_k > 0.0 {
            let gas = glow.coefficients(range_nm, brick.hottest_k, 0.0);
            let light = gas.emission * (range_nm[1] - range_nm[0]);
            matter.gas = [light; 3];
        }
        matter
    };
    let without = sketch.of(Of::Plain, false);
    let with = sketch.picture(shines, false);
    sketch::greatest(&without, &with)
}

/// The fire's light on what stands around.
pub(super) fn fire_light(sketch: &Sketch<'_>) -> f64 {
    let dark = sketch.of(Of::Radicals, false);
    let lit = sketch.of(Of::Radicals, true);
    sketch::greatest(&lit, &dark)
}

/// By how much gas may bend a ray, rad, and how far that moves what is seen of the fire itself, voxels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    pub(super) angle_rad: f64,
    pub(super) voxels: f64,
}

/// From the steepest places of all bricks along a ray: as if they all bent it the same way. `None` where nothing bends.
///
/// n − 1 goes as 1/T, nearly: ∇n = (n − 1) T ∇(1/T).
pub(super) fn bend(scene: &Scene, sketch: &Sketch<'_>, nm: f64) -> Option<Bend> {
    let flame = &scene.flame;
    let bent = flame.bending()?;
    let air = &bent.air;
    let gas = air.gas(bent.fuel).ok()?;
    let dispersion = crate::physics::moist_air::Dispersion::at(nm).ok()?;
    let excess = gas.refractivity(dispersion, air.temperature_k, 0.0) * bent.bending.gain;
    let angle_rad = sketch.most_along(|brick| excess * air.temperature_k * brick.steepest);
    let voxel_m = flame.medium().voxel_size_m();
    (angle_rad > 0.0).then(|| Bend {
        angle_rad,
        voxels: 0.5 * angle_rad * sketch.longest_m() / voxel_m,
    })
}

/// Steepest change of a fire's light from voxel to voxel, as a share of it: over a voxel soot ends, and light is gone.
const STEEPEST: f64 = 1.0;

/// Bent light: what is seen of the fire is moved by so many voxels, and what lies behind by so many pixels.
pub(super) fn refraction(scene: &Scene, bend: Bend, size: [u32; 2]) -> f64 {
    let of_fire = sketch::of_share(STEEPEST * bend.voxels);
    let behind = if scene.stage.shows_behind() {
        shift_px(scene, bend.angle_rad, size) * PIXEL
    } else {
        0.0
    };
    of_fire.max(behind).min(MOST)
}

/// Colours that go apart: only what lies behind is seen so, and of that what lies at an edge. How much of a picture that is
/// depends on how far they go apart in units of the picture, not of its pixels.
pub(super) fn dispersion(scene: &Scene, apart_rad: f64, size: [u32; 2]) -> f64 {
    if scene.stage.backdrop.is_some() {
        let share = shift_px(scene, apart_rad, size) / f64::from(size[0].max(size[1]));
        (share * APART).min(MOST)
    } else {
        0.0
    }
}

/// What the hundredth of pixels that changes most changes where colours of a checker go apart by a whole picture's width,
/// ΔE_ITP, if they could. Measured on the torch, the plume and the pool fire, at 64 to 1280 pixels: 33 to 51.
const APART: f64 = 150.0;

/// What a pixel changes where a pattern of black and white is moved by a whole one, ΔE_ITP, for the hundredth of pixels that
/// changes most: one in fifty lies at an edge.
const PIXEL: f64 = 20.0;

/// How far a bend by an angle moves what lies behind, pixels of a picture.
fn shift_px(scene: &Scene, angle_rad: f64, size: [u32; 2]) -> f64 {
    let Ok(view) = scene.camera.view(size) else {
        return 0.0;
    };
    let [x, y] = size.map(|side| 0.5 * f64::from(side));
    let pixel = view
        .ray(x, y)
        .direction
        .angle_between(view.ray(x + 1.0, y).direction);
    angle_rad / pixel
}

/// Smoke of a greatest volume fraction, beside soot of one, on a way of so many metres, ΔE_ITP: what it takes from light, and
/// what it adds if all of it is as hot as the hottest soot. Known before anything is packed.
pub fn smoke(smoke: f64, soot: f64, flame: &FlameParams, way_m: f64) -> f64 {
    let law = flame.fuel.soot_law(flame.soot_model);
    let albedo = flame.scattering.map_or(0.0, |it| it.smoke_albedo);
    let extinction = law.absorption_per_volume_fraction(SMOKE_NM) / (1.0 - albedo)
        * volume_fraction_factor(flame.soot_hold, flame.soot_radius_nm);
    let taken = extinction * smoke * way_m;
    let glow = smoke / soot;
    if !(taken.is_finite() && glow.is_finite()) {
        return MOST;
    }
    sketch::of_share(-taken.min(1.0))
        .max(sketch::in_the_dark(glow))
        .min(MOST)
}
