//! How exactly the fire is computed, and what that costs.

use std::cmp::Ordering;

use egui::{Button, RichText, Ui};

use super::knob::{Choice, Knob};
use super::{Known, section, short, unit};
use crate::app::accuracy::Told;
use crate::app::theme::IDLE;
use crate::project::{Project, Quality, RenderSettings, ranges};
use crate::render::{Effects, Switch};
use crate::scene::{Interpolation, WavelengthSet};
use crate::study::{Numbers, RAYS, STEPS};

/// Orders of scattering that are offered.
const ORDERS: [u32; 5] = [1, 2, 4, 16, 64];

/// Draws the section.
pub(super) fn show(ui: &mut Ui, project: &mut Project, known: Known<'_>, told: Option<&Told>) {
    section(ui, "Quality", true, |ui| {
        let render = &mut project.render;
        wished(ui, render);
        if let Some(told) = told {
            by_cause(ui, render, &mut project.effects, known, told);
        }
        // What is not set by hand is as chosen, or as for a scene that nobody has looked at yet.
        let (step_default, wavelengths_default, rays_default) =
            known.job.map_or(render.quality.numbers(), |job| {
                let settings = &job.settings;
                (
                    settings.step_voxels,
                    settings.wavelengths,
                    settings.samples_per_pixel,
                )
            });
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
            render.step_voxels = Some(step);
        }
        by_hand(ui, &mut render.step_voxels);

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
            render.wavelengths = Some(wavelengths);
        }
        by_hand(ui, &mut render.wavelengths);

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
            render.samples_per_pixel = Some(rays);
        }
        by_hand(ui, &mut render.samples_per_pixel);
        between_voxels(ui, &mut render.interpolation);
        orders(ui, &mut render.scattering_orders);
    });
}

/// How exact the picture is wished.
fn wished(ui: &mut Ui, render: &mut RenderSettings) {
    let by_hand = render.step_voxels.is_some()
        || render.wavelengths.is_some()
        || render.samples_per_pixel.is_some();
    let options = Quality::ALL.map(|quality| {
        let name = capitalised(quality.name());
        let words = if by_hand && quality == render.quality {
            format!("{name} · changed")
        } else if let (Some(target), true) = (render.target_error, quality == render.quality) {
            format!("{} ΔE, set by hand", short(target))
        } else {
            format!("{name} · {} ΔE", short(quality.target_de()))
        };
        (quality, words, "")
    });
    let changed = Choice {
        label: "Quality",
        options: &options,
        tip: "How exact: step, wavelengths and rays are chosen for this fire so that 95 % of it are within so many ΔE of the \
              finest picture. 1 is a difference that is just seen. A still can be exported at another quality.",
        default: Quality::default(),
        idle: None,
    }
    .show(ui, &mut render.quality);
    if changed {
        // A quality that is chosen by hand is meant to be seen.
        render.target_error = None;
        (
            render.step_voxels,
            render.wavelengths,
            render.samples_per_pixel,
        ) = (None, None, None);
    }
}

/// Lets a number that was set by hand be chosen again.
fn by_hand<T>(ui: &mut Ui, number: &mut Option<T>) {
    if number.is_some() {
        let button = ui.small_button("set by hand: let it be chosen");
        let tip = "Give the number up, so that it follows the quality again.";
        if button.on_hover_text(tip).clicked() {
            *number = None;
        }
    }
}

/// The picture's error by what it comes from; a click raises only that.
fn by_cause(
    ui: &mut Ui,
    render: &mut RenderSettings,
    effects: &mut Effects,
    known: Known<'_>,
    told: &Told,
) {
    let (error, numbers) = (told.here.error, told.here.numbers);
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("error from").color(IDLE));
        let cause = |ui: &mut Ui, words: String, tip: &str, enabled: bool| {
            let button = ui.add_enabled(enabled, Button::new(words).small());
            button.on_hover_text(tip).clicked()
        };
        let finer = STEPS.into_iter().find(|step| *step < numbers.step_voxels);
        let words = format!("step {}", short_de(error.step));
        if cause(
            ui,
            words,
            "Take the next shorter step, and leave all else.",
            finer.is_some(),
        ) {
            pin(
                render,
                Numbers {
                    step_voxels: finer.unwrap_or(numbers.step_voxels),
                    ..numbers
                },
            );
        }
        let more = WavelengthSet::ALL.into_iter();
        let more = more
            .filter(|set| set.count() > numbers.wavelengths.count())
            .find(|set| set.count() != 16);
        let words = format!("wavelengths {}", short_de(error.wavelengths));
        if cause(
            ui,
            words,
            "Take more wavelengths, and leave all else.",
            more.is_some(),
        ) {
            pin(
                render,
                Numbers {
                    wavelengths: more.unwrap_or(numbers.wavelengths),
                    ..numbers
                },
            );
        }
        let rays = RAYS
            .into_iter()
            .find(|rays| *rays > numbers.samples_per_pixel);
        let words = format!("edges {}", short_de(error.rays));
        if cause(
            ui,
            words,
            "Take more rays for each pixel, and leave all else.",
            rays.is_some(),
        ) {
            pin(
                render,
                Numbers {
                    samples_per_pixel: rays.unwrap_or(numbers.samples_per_pixel),
                    ..numbers
                },
            );
        }
        let out = known
            .decisions
            .iter()
            .filter(|it| !it.on && it.switch == Switch::Auto);
        let largest = out
            .filter(|it| it.bound.is_some_and(|bound| bound > 0.0))
            .filter(|it| effects.switch_mut(it.effect).is_some())
            .max_by(|one, other| {
                one.bound
                    .partial_cmp(&other.bound)
                    .unwrap_or(Ordering::Equal)
            });
        let bound = largest.and_then(|it| it.bound).unwrap_or(0.0);
        let words = format!("left out ≤ {}", short_de(bound));
        let tip = "Compute the effect that may change most of those that are left out.";
        if cause(ui, words, tip, largest.is_some())
            && let Some(switch) = largest.and_then(|it| effects.switch_mut(it.effect))
        {
            *switch = Switch::On;
        }
    });
}

/// Sets all three numbers by hand.
fn pin(render: &mut RenderSettings, numbers: Numbers) {
    render.step_voxels = Some(numbers.step_voxels);
    render.wavelengths = Some(numbers.wavelengths);
    render.samples_per_pixel = Some(numbers.samples_per_pixel);
}

/// An error in two figures.
pub(super) fn short_de(de: f64) -> String {
    if de < 0.01 {
        "0.00".to_owned()
    } else if de < 1.0 {
        format!("{de:.2}")
    } else if de < 10.0 {
        format!("{de:.1}")
    } else {
        format!("{de:.0}")
    }
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
