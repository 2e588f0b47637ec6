//! Who wrote a volume, and which of its grids have a meaning.

use super::field::{Producer, Recognised};
use super::naming::{FRACTION_CEILING, KELVIN_FLOOR, figures};
use super::{Grid, Volume};

/// Grid names, most telling first; matched without case.
const TEMPERATURE: &[&str] = &["temperature", "temp", "kelvin", "heat"];
const FLAME: &[&str] = &["flame", "flames", "fire", "burn", "reaction", "heat"];
const SOOT: &[&str] = &["soot", "fv", "f_v", "soot_volume_fraction"];
const SMOKE: &[&str] = &["density", "smoke"];

/// The grids that have a meaning. No grid stands for two fields here.
pub(super) struct Cast<'a> {
    pub temperature: Option<&'a Grid>,
    pub flame: Option<&'a Grid>,
    pub soot: Option<&'a Grid>,
    pub smoke: Option<&'a Grid>,
}

impl<'a> Cast<'a> {
    pub(super) fn of(volume: &'a Volume) -> Self {
        let find = |names: &[&str], not: Option<&Grid>| {
            names.iter().find_map(|name| {
                volume.grids.iter().find(|grid| {
                    grid.name.eq_ignore_ascii_case(name)
                        && !grid.bounds().is_empty()
                        && not.is_none_or(|other| other.name != grid.name)
                })
            })
        };
        let temperature = find(TEMPERATURE, None);
        Self {
            temperature,
            flame: find(FLAME, temperature),
            soot: find(SOOT, None),
            smoke: find(SMOKE, None),
        }
    }
}

pub(super) fn peak(grid: &Grid) -> f64 {
    f64::from(grid.range().1)
}

pub(super) fn is_kelvin(grid: &Grid) -> bool {
    grid.range().1 > KELVIN_FLOOR
}

pub(super) fn is_fraction(grid: &Grid) -> bool {
    (f32::MIN_POSITIVE..=FRACTION_CEILING).contains(&grid.range().1)
}

/// Guesses who wrote a volume: by its values where they are physical, then by what the file says of itself,
/// then by the names of its grids.
pub fn recognise(volume: &Volume) -> Recognised {
    let cast = Cast::of(volume);
    let glowing = cast.soot.or(cast.smoke);
    let kelvin = cast.temperature.filter(|grid| is_kelvin(grid));
    let fraction = glowing.filter(|grid| is_fraction(grid));
    let answer = |producer, reason: String| Recognised { producer, reason };

    match (kelvin, fraction, cast.temperature, glowing) {
        (Some(t), Some(s), ..) => {
            let (t_peak, s_peak) = (figures(peak(t)), figures(peak(s)));
            let reason = format!(
                "{} peaks at {t_peak} (kelvin) and {} at {s_peak} (a volume fraction)",
                t.name, s.name
            );
            return answer(Producer::Physical, reason);
        }
        (Some(t), None, _, None) if cast.flame.is_none() => {
            return answer(
                Producer::Physical,
                format!("{} peaks at {}: kelvin", t.name, figures(peak(t))),
            );
        }
        (None, Some(s), None, _) if cast.flame.is_none() => {
            let reason = format!(
                "{} peaks at {}: a volume fraction",
                s.name,
                figures(peak(s))
            );
            return answer(Producer::Physical, reason);
        }
        _ => {}
    }
    let creator = volume.metadata.creator.clone().unwrap_or_default();
    for (word, producer) in [
        ("blender", Producer::Blender),
        ("embergen", Producer::EmberGen),
        ("jangafx", Producer::EmberGen),
        ("houdini", Producer::Houdini),
    ] {
        if creator.to_lowercase().contains(word) {
            return answer(
                producer,
                format!("the file says that it was written by {creator}"),
            );
        }
        let entry = |(name, _): &&(String, String)| name.to_lowercase().contains(word);
        if let Some((name, _)) = volume.metadata.entries.iter().find(entry) {
            return answer(producer, format!("the file has an entry \"{name}\""));
        }
    }
    let has = |name: &str| {
        volume
            .grids
            .iter()
            .any(|grid| grid.name.eq_ignore_ascii_case(name))
    };
    if has("flames") {
        return answer(
            Producer::EmberGen,
            "its flame grid is named \"flames\"".to_owned(),
        );
    }
    if has("burn") || has("heat") && has("temperature") || has("vel.x") {
        let reason = "its grids are named as Houdini's pyro solver names them";
        return answer(Producer::Houdini, reason.to_owned());
    }
    let reason = if has("flame") {
        "its flame grid is named \"flame\""
    } else {
        "nothing tells the producer; values are taken as those of a solver without units"
    };
    answer(Producer::Blender, reason.to_owned())
}
