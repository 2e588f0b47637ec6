//! Who wrote a volume, and which of its grids have a meaning.

use super::field::{Producer, Recognised};
use super::naming::{FRACTION_CEILING, KELVIN_FLOOR, figures};
use super::{Grid, Volume};

/// Grid names, most telling first; matched without case.
const TEMPERATURE: &[&str] = &["temperature", "temp", "kelvin", "heat"];
const FLAME: &[&str] = &["flame", "flames", "fire", "burn", "reaction", "heat"];
const SOOT: &[&str] = &["soot", "fv", "f_v", "soot_volume_fraction"];
const SMOKE: &[&str] = &["density", "smoke"];

/// Which of some names have a meaning. No name stands for two fields here.
#[derive(Clone, Copy)]
pub(super) struct Roles<T> {
    pub temperature: Option<T>,
    pub flame: Option<T>,
    pub soot: Option<T>,
    pub smoke: Option<T>,
}

impl<'n> Roles<&'n str> {
    /// Among names in the order of their file.
    pub(super) fn of(names: &[&'n str]) -> Self {
        let find = |telling: &[&str], not: Option<&str>| {
            telling.iter().find_map(|wanted| {
                let mut names = names.iter().copied();
                names.find(|name| name.eq_ignore_ascii_case(wanted) && not != Some(name))
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

/// The grids that have a meaning: those that hold data.
pub(super) type Cast<'a> = Roles<&'a Grid>;

impl<'a> Cast<'a> {
    pub(super) fn of_volume(volume: &'a Volume) -> Self {
        let with_data = volume.grids.iter().filter(|grid| !grid.bounds().is_empty());
        let names: Vec<&str> = with_data.map(|grid| grid.name.as_str()).collect();
        let roles = Roles::of(&names);
        let grid = |name: Option<&str>| name.and_then(|name| volume.grid(name));
        Self {
            temperature: grid(roles.temperature),
            flame: grid(roles.flame),
            soot: grid(roles.soot),
            smoke: grid(roles.smoke),
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
    let cast = Cast::of_volume(volume);
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
        let mut names = volume.grid_names();
        names.any(|other| other.eq_ignore_ascii_case(name))
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
