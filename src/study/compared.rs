//! A whole picture against the reference of its scene, pixel by pixel.

use super::numbers::Numbers;
use super::pilot::Pilot;
use super::report::REFERENCE;
use super::sight::{Error, Sight};
use crate::render::film::{Film, Tile};
use crate::render::pass::MOSAIC;
use crate::render::{Cancel, Plan, Settings, render_mosaic};
use crate::scene::Scene;

/// Renders the picture that others are compared with, as large as these settings have it and with their effects, as a mosaic that
/// becomes finer. In the calling thread's rayon pool; `false` if cancelled.
pub fn render_reference(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    sink: &(dyn Fn(Tile) + Sync),
) -> bool {
    let settings = REFERENCE.within(settings);
    let plan = plan.at(scene, &settings);
    render_mosaic(scene, &plan, &settings, cancel, sink)
}

/// Whether a picture with these numbers is its own reference.
pub fn is_the_reference(numbers: Numbers) -> bool {
    numbers == REFERENCE
}

/// How different each pixel of a picture looks from its reference, ΔE_ITP, row by row; none if they are not of one size. Where
/// `known` says that there is no reference yet it is that of the nearest block of the mosaic, and not a number where that is
/// not there either.
pub fn apart(pilot: &Pilot, reference: &Film, known: &[bool], picture: &Film) -> Vec<f32> {
    if reference.size() != picture.size() {
        return Vec::new();
    }
    let pixels = reference.pixels().iter().zip(picture.pixels()).zip(known);
    let mut apart: Vec<f32> = pixels
        .map(|((reference, pixel), known)| {
            if !known {
                return f32::NAN;
            }
            let [reference, pixel] = [reference, pixel].map(|it| it.xyz.map(f64::from));
            pilot.apart(reference, pixel) as f32
        })
        .collect();
    let [width, height] = reference.size();
    let [.., packet] = MOSAIC;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        // The same place within the packet in the corner of the block.
        let within = |side: u32| [x, y].map(|at| (at / side * side + at % packet) as usize);
        let index = |[x, y]: [usize; 2]| y * width as usize + x;
        let here = index([x as usize, y as usize]);
        if !known[here] {
            let blocks = MOSAIC.into_iter().rev().map(|side| index(within(side)));
            let there = blocks.filter(|&at| known.get(at).copied().unwrap_or(false));
            apart[here] = there.map(|at| apart[at]).next().unwrap_or(f32::NAN);
        }
    }
    apart
}

/// How far a whole picture is from its reference, and never nearer than the reference is off by itself. `None` where nothing is
/// lit, or where they are not of one size.
pub fn measured(reference: &Film, picture: &Film, own: Error) -> Option<Error> {
    if reference.size() != picture.size() {
        return None;
    }
    let [reference, picture] = [reference, picture].map(|film| {
        let pixels = film.pixels().iter();
        pixels
            .map(|pixel| pixel.xyz.map(f64::from))
            .collect::<Vec<_>>()
    });
    let sight = Sight::of(&reference, vec![1.0; reference.len()])?;
    Some(sight.error(&reference, &picture).at_least(own))
}
