//! How hot the fire is: what the file's heat is in kelvin.

use egui::Ui;

use crate::app::panels::knob::Knob;
use crate::app::panels::{Known, short, unit};
use crate::project::{Control, FieldSettings, Project};
use crate::volume::FieldMap;

/// Temperatures that a fire's hottest place may be set to, K: from what is hardly seen to more than oxygen makes of any fuel.
const HOTTEST_K: [f64; 2] = [600.0, 5000.0];
/// What temperature offsets may be, K: more than any flame.
const OFFSETS_K: [f64; 2] = [-1e5, 1e5];
/// What factors from a file's numbers to kelvin may be.
const SCALES_K: [f64; 2] = [-1e9, 1e9];

/// Draws the controls; nothing where the file has no heat.
pub(super) fn show(ui: &mut Ui, project: &mut Project, known: Known<'_>) {
    let maps = known.job.and_then(|job| {
        let map = job.flame.maps.temperature.as_ref()?;
        let peak = job.volume.grid(&map.grid).map(|grid| grid.range().1);
        let peak = peak.map(f64::from).filter(|peak| *peak > 0.0);
        Some((map, job.proposed.temperature.as_ref()?, peak))
    });
    let Some((map, proposed, peak)) = maps else {
        return;
    };
    let set = &mut project.volume.temperature;
    if let Some(peak) = peak {
        hottest(ui, set, [map, proposed], peak, known);
    }
    let size = proposed.scale.abs().max(1e-6);
    let mut scale = set.scale.unwrap_or(map.scale);
    let changed = Knob {
        label: "Temp. scale",
        unit: unit::KELVIN_PER_UNIT,
        slider: [0.25 * size, 4.0 * size],
        range: SCALES_K,
        logarithmic: true,
        default: proposed.scale,
        tip: "Kelvin for one unit of the file's heat. Hotter soot is brighter and whiter: its light grows with about \
              the tenth power of its temperature. Solvers write heat without a unit, so this is the first number to \
              get right. What exceeds the field's bounds is cut off there, and said below.",
        idle: known.idle(Control::Heat),
    }
    .show(ui, &mut scale);
    if changed {
        set.scale = (scale != proposed.scale).then_some(scale);
    }
    let mut offset = set.offset.unwrap_or(map.offset);
    let changed = Knob {
        label: "Temp. offset",
        unit: unit::KELVIN,
        slider: [proposed.offset - 1000.0, proposed.offset + 1000.0],
        range: OFFSETS_K,
        logarithmic: false,
        default: proposed.offset,
        tip: "Temperature where the file's heat is 0. Raising it warms all of the fire by as many kelvin.",
        idle: None,
    }
    .show(ui, &mut offset);
    if changed {
        set.offset = (offset != proposed.offset).then_some(offset);
    }
}

/// The temperature of the file's highest number: what the program that made the fire says of it is typed here.
fn hottest(
    ui: &mut Ui,
    set: &mut FieldSettings,
    [map, proposed]: [&FieldMap; 2],
    peak: f64,
    known: Known<'_>,
) {
    let at_peak = |map: &FieldMap| map.scale * peak + map.offset;
    let (offset, mut kelvin) = (map.offset, at_peak(map));
    let cut_off =
        (kelvin > map.max).then(|| format!("cut off at {} K, the field's bound", short(map.max)));
    let changed = Knob {
        label: "Hottest",
        unit: unit::KELVIN,
        slider: HOTTEST_K,
        range: [offset + 1.0, HOTTEST_K[1]],
        logarithmic: false,
        default: at_peak(proposed),
        tip: "Temperature where the file's heat is highest: what the program that made the fire says of it. It sets the \
              scale below; the offset stays.",
        idle: known.idle(Control::Heat).or(cut_off),
    }
    .show(ui, &mut kelvin);
    if changed {
        let scale = (kelvin - offset) / peak;
        set.scale = (scale != proposed.scale).then_some(scale);
        // A bound that was only proposed is not to cut off what a person wants.
        if kelvin > map.max {
            set.max = Some(kelvin);
        }
    }
}
