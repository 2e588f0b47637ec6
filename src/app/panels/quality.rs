//! How exactly the fire is computed, and what that costs.

use egui::Ui;

use super::knob::{Choice, Knob};
use super::{section, unit};
use crate::project::{Project, Quality, ranges};
use crate::scene::{Interpolation, WavelengthSet};

/// Rays for each pixel that are offered.
const RAYS: [u32; 5] = [1, 2, 4, 8, 16];

/// Orders of scattering that are offered.
const ORDERS: [u32; 5] = [1, 2, 4, 16, 64];

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project) {
    section(ui, "Quality", true, |ui| {
        let render = &mut project.render;
        let (step_default, ..) = render.quality.numbers();
        let mut step = render.step_voxels.unwrap_or(step_default);
        let changed = Knob {
            label: "Step size",
            unit: unit::VOXELS,
            slider: [0.25, 8.0],
            range: ranges::STEP_VOXELS,
            logarithmic: true,
            default: step_default,
            tip: "How far apart the fire is sampled along a line of sight at most: closer where its light changes from \
                  voxel to voxel. Longer steps are faster, but step over thin sheets of flame: they become blurred and \
                  too dim or too bright.",
            idle: None,
        }
        .show(ui, &mut step);
        if changed {
            render.step_voxels = (step != step_default).then_some(step);
        }

        let changed_by_hand = render.step_voxels.is_some()
            || render.wavelengths.is_some()
            || render.samples_per_pixel.is_some();
        let options = Quality::ALL.map(|quality| {
            let (step, wavelengths, rays) = quality.numbers();
            if changed_by_hand && quality == render.quality {
                return (
                    quality,
                    format!("{} · changed", capitalised(quality.name())),
                    "",
                );
            }
            let words = format!(
                "{} · step {step}, {} λ, {rays} {}",
                capitalised(quality.name()),
                wavelengths.count(),
                if rays == 1 { "ray" } else { "rays" },
            );
            (quality, words, "")
        });
        let changed = Choice {
            label: "Preset",
            options: &options,
            tip: "Step size, wavelengths and rays together. A still can be exported at another quality.",
            default: Quality::default(),
            idle: None,
        }
        .show(ui, &mut render.quality);
        if changed {
            // A preset that is chosen by hand is meant to be seen.
            (
                render.step_voxels,
                render.wavelengths,
                render.samples_per_pixel,
            ) = (None, None, None);
        }
        let (_, wavelengths_default, rays_default) = render.quality.numbers();

        let options = WavelengthSet::ALL.map(|set| {
            let (kind, tip) = match set {
                WavelengthSet::Fitted(_) => ("fitted", "Chosen and weighted for this fire's soot."),
                WavelengthSet::Plain(_) => ("plain", "Evenly over the spectrum: for comparison."),
            };
            (set, format!("{} {kind}", set.count()), tip)
        });
        let mut wavelengths = render.wavelengths.unwrap_or(wavelengths_default);
        let changed = Choice {
            label: "Wavelengths",
            options: &options,
            tip: "At how many wavelengths light is carried through the fire. Six fitted ones are within 0.1 % of all.",
            default: wavelengths_default,
            idle: None,
        }
        .show(ui, &mut wavelengths);
        if changed {
            render.wavelengths = (wavelengths != wavelengths_default).then_some(wavelengths);
        }

        let mut rays = render.samples_per_pixel.unwrap_or(rays_default);
        let mut options: Vec<(u32, String, &str)> =
            RAYS.map(|rays| (rays, rays.to_string(), "")).to_vec();
        if !RAYS.contains(&rays) {
            options.push((rays, rays.to_string(), ""));
        }
        let changed = Choice {
            label: "Rays a pixel",
            options: &options,
            tip: "More rays smooth the edges; each costs as much time as the first.",
            default: rays_default,
            idle: None,
        }
        .show(ui, &mut rays);
        if changed {
            render.samples_per_pixel = (rays != rays_default).then_some(rays);
        }
        between_voxels(ui, &mut render.interpolation);
        orders(ui, &mut render.scattering_orders);
    });
}

/// How often light may be scattered.
fn orders(ui: &mut Ui, orders: &mut u32) {
    let words = |orders: u32| match orders {
        1 => "By fields, without noise".to_owned(),
        orders => format!("By paths, up to {orders} times"),
    };
    let mut options: Vec<(u32, String, &str)> =
        ORDERS.map(|orders| (orders, words(orders), "")).to_vec();
    if !ORDERS.contains(orders) {
        options.push((*orders, words(*orders), ""));
    }
    Choice {
        label: "Scatterings",
        options: &options,
        tip: "How light is followed from soot to soot where scattering is computed (Effects says whether, and whether more \
              than once). Fields have no noise, but get light too far in smoke that is thick within a voxel. Paths follow \
              all but the first scattering exactly, with some noise: more rays a pixel take it away.",
        default: 1,
        idle: None,
    }
    .show(ui, orders);
}

/// How values between voxels are formed. Not a part of the quality's presets: more is not always nearer to what was
/// meant.
fn between_voxels(ui: &mut Ui, interpolation: &mut Interpolation) {
    let options = Interpolation::ALL.map(|way| {
        let tip = match way {
            Interpolation::Nearest => "Each voxel a block, as the file has them.",
            Interpolation::Trilinear => "Straight between voxels.",
            Interpolation::Tricubic => {
                "Smooth, without lines of the lattice; softens detail of one voxel. Takes several times as long."
            }
        };
        (way, capitalised(way.name()), tip)
    });
    Choice {
        label: "Between voxels",
        options: &options,
        tip: "How values between the file's voxels are formed.",
        default: Interpolation::default(),
        idle: None,
    }
    .show(ui, interpolation);
}

/// A name with a capital, as a menu has it.
pub(super) fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
