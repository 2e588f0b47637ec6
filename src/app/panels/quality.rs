//! How exactly the fire is computed, and what that costs.

use std::cmp::Ordering;

use egui::{Button, RichText, Ui};

use super::knob::{Choice, Knob};
use super::{Beside, Command, Known, section, short, unit};
use crate::app::accuracy::Told;
use crate::app::maps::Map;
use crate::app::region::RegionFrame;
use crate::project::{Project, Quality, RenderSettings, ranges};
use crate::render::{Effects, Switch};
use crate::scene::{Interpolation, WavelengthSet};
use crate::study::{Numbers, RAYS, STEPS};

/// Orders of scattering that are offered.
const ORDERS: [u32; 5] = [1, 2, 4, 16, 64];

/// Draws the section.
pub(super) fn show(
    ui: &mut Ui,
    project: &mut Project,
    known: Known<'_>,
    beside: &Beside<'_>,
    commands: &mut Vec<Command>,
) {
    section(ui, "Quality", true, |ui| {
        let render = &mut project.render;
        wished(ui, render);
        if let Some(told) = beside.told {
            by_cause(ui, render, &mut project.effects, known, told);
        }
        maps(ui, beside.map, commands);
        region(ui, beside.region, commands);
        // What is not set by hand is as chosen, or as for a scene that nobody has looked at yet.
        let here = known.job.map(|job| Numbers::of(&job.settings));
        step(ui, render, here);
        wavelengths(ui, render, here);
        rays(ui, render, here);
        between_voxels(ui, &mut render.interpolation);
        orders(ui, &mut render.scattering_orders);
    });
}

/// Which part of the picture is sharpened.
fn region(ui: &mut Ui, region: &RegionFrame, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("sharpen").weak());
        let is_whole = !region.is_set() && !region.is_choosing();
        let whole = ui.selectable_label(is_whole, "whole picture");
        let tip = "Key: Ctrl+Alt+B";
        if whole.on_hover_text(tip).clicked() {
            commands.push(Command::WholePicture);
        }
        let words = if region.is_choosing() {
            "drag a frame over the picture"
        } else {
            "a region"
        };
        let part = ui.selectable_label(!is_whole, words);
        let tip = "Only what lies in a frame that you drag over the picture: it is sharp sooner, and the rest stays coarse. \
                   An export is of all of it. Key: Ctrl+B";
        if part.on_hover_text(tip).clicked() {
            commands.push(Command::ChooseRegion);
        }
    });
}

/// What may be laid over the picture.
fn maps(ui: &mut Ui, shown: Option<Map>, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("map of").weak());
        for (map, words, tip) in [
            (
                Map::Cost,
                "cost per pixel",
                "How many samples of the fire each pixel took so far. Key: K",
            ),
            (
                Map::Error,
                "error per pixel",
                "How far each pixel is from the reference, which is rendered in the background: that takes its time. Key: E",
            ),
        ] {
            let button = Button::selectable(shown == Some(map), words).small();
            if ui.add(button).on_hover_text(tip).clicked() {
                commands.push(Command::ToggleMap(map));
            }
        }
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

/// The step, or that it is chosen.
fn step(ui: &mut Ui, render: &mut RenderSettings, here: Option<Numbers>) {
    let (of_quality, ..) = render.quality.numbers();
    Knob {
        label: "Step size",
        unit: unit::VOXELS,
        slider: [0.125, 8.0],
        range: ranges::STEP_VOXELS,
        logarithmic: true,
        default: here.map_or(of_quality, |here| here.step_voxels),
        tip: "How far apart the fire is sampled along a line of sight at most: closer where its light changes from \
              voxel to voxel. Longer steps are faster, but step over thin sheets of flame: they become blurred and \
              too dim or too bright.",
        idle: None,
    }
    .show_optional(ui, &mut render.step_voxels, "chosen for the quality");
}

/// The wavelengths, or that they are chosen.
fn wavelengths(ui: &mut Ui, render: &mut RenderSettings, here: Option<Numbers>) {
    let words = |set: WavelengthSet| match set {
        WavelengthSet::Fitted(count) => format!("{count} fitted"),
        WavelengthSet::Plain(count) => format!("{count} plain"),
    };
    let tip = |set: WavelengthSet| match set {
        WavelengthSet::Fitted(_) => "Chosen and weighted for this fire's soot.",
        WavelengthSet::Plain(_) => "Evenly over the spectrum: for comparison.",
    };
    let mut options = vec![(
        None,
        chosen_words(here.map(|here| words(here.wavelengths))),
        "",
    )];
    options.extend(WavelengthSet::ALL.map(|set| (Some(set), words(set), tip(set))));
    Choice {
        label: "Wavelengths",
        options: &options,
        tip: "At how many wavelengths light is carried through the fire. Six fitted ones are within 0.1 % of all.",
        default: None,
        idle: None,
    }
    .show(ui, &mut render.wavelengths);
}

/// The rays of each pixel, or that they are chosen.
fn rays(ui: &mut Ui, render: &mut RenderSettings, here: Option<Numbers>) {
    let here = here.map(|here| here.samples_per_pixel.to_string());
    let mut options = vec![(None, chosen_words(here), "")];
    options.extend(RAYS.map(|rays| (Some(rays), rays.to_string(), "")));
    let set = render.samples_per_pixel;
    if let Some(other) = set.filter(|rays| !RAYS.contains(rays)) {
        options.push((set, other.to_string(), ""));
    }
    Choice {
        label: "Rays a pixel",
        options: &options,
        tip: "More rays smooth the edges; each costs as much time as the first.",
        default: None,
        idle: None,
    }
    .show(ui, &mut render.samples_per_pixel);
}

/// That a number is chosen, and which it is if that is known.
fn chosen_words(here: Option<String>) -> String {
    here.map_or_else(|| "Chosen".to_owned(), |here| format!("Chosen · {here}"))
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
        ui.label(RichText::new("error from").weak());
        let cause = |ui: &mut Ui, words: String, tip: &str, enabled: bool| {
            let button = ui.add_enabled(enabled, Button::new(words).small());
            button.on_hover_text(tip).clicked()
        };
        let finer = STEPS.into_iter().find(|step| *step < numbers.step_voxels);
        let finer = finer.map(|step_voxels| Numbers {
            step_voxels,
            ..numbers
        });
        // Sixteen plain ones are no better than eight fitted ones.
        let more = WavelengthSet::ALL.into_iter().find(|set| {
            set.count() > numbers.wavelengths.count() && *set != WavelengthSet::Plain(16)
        });
        let more = more.map(|wavelengths| Numbers {
            wavelengths,
            ..numbers
        });
        let rays = RAYS
            .into_iter()
            .find(|rays| *rays > numbers.samples_per_pixel);
        let rays = rays.map(|samples_per_pixel| Numbers {
            samples_per_pixel,
            ..numbers
        });
        for (name, de, better, tip) in [
            (
                "step",
                error.step,
                finer,
                "Take the next shorter step, and leave all else.",
            ),
            (
                "wavelengths",
                error.wavelengths,
                more,
                "Take more wavelengths, and leave all else.",
            ),
            (
                "edges",
                error.rays,
                rays,
                "Take more rays for each pixel, and leave all else.",
            ),
        ] {
            let clicked = cause(
                ui,
                format!("{name} {}", short_de(de)),
                tip,
                better.is_some(),
            );
            if let Some(better) = better.filter(|_| clicked) {
                better.by_hand(render);
            }
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
