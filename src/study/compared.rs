//! A whole picture against the reference of its scene, pixel by pixel.

use super::numbers::Numbers;
use super::pilot::Pilot;
use super::sight::{Error, Sight};
use crate::render::film::{Film, Tile};
use crate::render::pass::MOSAIC;
use crate::render::{Cancel, Plan, Settings, render_mosaic};
use crate::scene::Scene;

/// Renders a picture that others are compared with, by these numbers, as large as the settings have it and with their effects, as
/// a mosaic that becomes finer. In the calling thread's rayon pool; `false` if cancelled.
pub fn render_reference(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    numbers: Numbers,
    cancel: &Cancel,
    sink: &(dyn Fn(Tile) + Sync),
) -> bool {
    let settings = numbers.within(settings);
    let mut at = plan.at(scene, &settings);
    at.take_over(plan);
    render_mosaic(scene, &at, &settings, cancel, sink)
}

/// How different each pixel of a picture looks from its reference, ΔE_ITP, row by row; none if they are not of one size. Where
/// `known` says that there is no reference yet it is the mean over the packet that stands for its block of the mosaic, and not a
/// number where that is not there either.
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
    let [.., side] = MOSAIC;
    let across = width.div_ceil(side);
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let packet = |[x, y]: [u32; 2]| (y / side * across + x / side) as usize;
    let mut packets = vec![(0.0_f32, 0.0_f32); (across * height.div_ceil(side)) as usize];
    for (place, (apart, _)) in places()
        .zip(apart.iter().zip(known))
        .filter(|(_, (_, known))| **known)
    {
        let (sum, count) = &mut packets[packet(place)];
        *sum += apart;
        *count += 1.0;
    }
    for (place, (apart, known)) in places().zip(apart.iter_mut().zip(known)) {
        if !known {
            let corner = |side: u32| packet(place.map(|at| at / side * side));
            let blocks = MOSAIC.into_iter().rev().map(|side| packets[corner(side)]);
            let there = blocks.into_iter().find(|(_, count)| *count > 0.0);
            *apart = there.map_or(f32::NAN, |(sum, count)| sum / count);
        }
    }
    apart
}

/// How far a whole picture is from its reference. `None` where it is nearer than the reference is off by itself, of which a
/// comparison tells nothing; where nothing is lit; or where they are not of one size.
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
    let found = sight.error(&reference, &picture);
    (found.de95 > own.de95).then(|| found.at_least(own))
}
