//! The mapping to physical units that follows from who wrote a volume.
//!
//! Solvers write numbers without units. The figures below are proposals, each told to the person:
//!
//! | field | from | physical |
//! |---|---|---|
//! | soot | flame 0..1 | 2e-6 · flame, a bright flame 1 to 3 dm across |
//! | smoke | density | 0.5e-6 · min(density / 0.3, 1) for Blender |
//! | temperature | solver heat 0..peak | 300 K + 1700 K · heat / peak |
//! | temperature | EmberGen's heat 0..peak | 1300 K + 700 K · heat / peak |
//!
//! EmberGen writes flames as sheets a voxel thin, with heat that falls to a fifth of its peak within them. What
//! burns glows: the luminous parts of sooting flames lie between some 1300 K and 2000 K. Mapped from 300 K on,
//! only scattered voxels would shine, and the lattice with them.
//!
//! The peaks are those of the one file. Over a sequence the numbers of one frame must be kept, or the fire
//! would flicker with the peak of each frame.

use super::field::{About, Assumption, FieldKind, FieldMap, FieldMaps, Preset, Producer, UpAxis};
use super::naming::figures;
use super::recognise::{Cast, is_fraction, is_kelvin, peak, recognise};
use super::{Grid, Volume};

/// Soot volume fraction of a fully burning voxel.
const SOOT_PEAK: f64 = 2e-6;
/// Soot volume fraction of dense smoke.
const SMOKE_PEAK: f64 = 0.5e-6;
/// Blender density that counts as dense smoke.
const BLENDER_DENSE_SMOKE: f64 = 0.3;
/// Ambient temperature, K.
const AMBIENT_K: f64 = 300.0;
/// Temperature of the coolest burning gas of an EmberGen flame, K.
const LUMINOUS_K: f64 = 1300.0;
/// Temperature assumed for the hottest voxel of a field without units, K.
pub const PEAK_K: f64 = 2000.0;
/// Above this, artist scales included, no solver heat is meant, K.
const SOLVER_CEILING_K: f64 = 2500.0;
/// Soot glows visibly above this temperature, K.
pub const GLOW_K: f64 = 700.0;
/// Hottest temperature taken from a file in kelvin: above any flame, K.
const FLAME_CEILING_K: f64 = 6000.0;
/// Densest soot taken from a file in volume fractions: a hundred times a sooting flame.
const FRACTION_MAX: f64 = 1e-3;
/// A fair voxel where the file has none, m.
const GUESSED_VOXEL_M: f64 = 0.01;

/// Proposes how physical fields are made from a volume, with everything that was assumed in words. A grid
/// that is already in kelvin or volume fractions keeps its values under every producer.
pub fn preset(producer: Producer, volume: &Volume) -> Preset {
    let producer = match producer {
        Producer::Auto => recognise(volume).producer,
        named => named,
    };
    let cast = Cast::of_volume(volume);
    let mut assumed = Vec::new();
    let soot = soot(&cast, producer, &mut assumed);
    let mut maps = FieldMaps {
        smoke: smoke(&cast, producer, soot.as_ref()),
        soot,
        flame: cast.flame.map(|grid| flame(grid, producer, &mut assumed)),
        temperature: cast
            .temperature
            .map(|grid| temperature(grid, producer, &mut assumed)),
    };
    fill_soot(&mut maps, &cast, &mut assumed);
    fill_temperature(&mut maps, &cast, &mut assumed);
    Preset {
        maps,
        up: match producer {
            Producer::Houdini => UpAxis::Y,
            _ => UpAxis::Z,
        },
        voxel_size_m: guessed_voxel(volume, producer, &mut assumed),
        assumptions: assumed,
    }
}

/// How a grid that a person chose for a field is mapped, with what had to be assumed.
///
/// A grid in physical units stands as it is; under [`Producer::Physical`] every grid does.
pub fn mapping(kind: FieldKind, grid: &Grid, producer: Producer) -> (FieldMap, Vec<Assumption>) {
    let mut assumed = Vec::new();
    let map = match kind {
        FieldKind::Soot => glowing(grid, producer, &mut assumed),
        FieldKind::Smoke => smoking(grid, producer),
        FieldKind::Flame => flame(grid, producer, &mut assumed),
        FieldKind::Temperature => temperature(grid, producer, &mut assumed),
    };
    (map, assumed)
}

/// Notes an assumption about a field.
fn assume(assumed: &mut Vec<Assumption>, kind: FieldKind, words: String) {
    assumed.push(Assumption {
        about: About::Field(kind),
        words,
    });
}

/// Soot that the file itself carries: volume fractions as they stand.
fn soot(cast: &Cast, producer: Producer, assumed: &mut Vec<Assumption>) -> Option<FieldMap> {
    let named = cast.soot;
    let fraction = named.or(cast.smoke).filter(|grid| is_fraction(grid));
    let taken = match producer {
        Producer::Physical => named.or(cast.smoke),
        _ => named.or(fraction.filter(|_| cast.flame.is_none() || is_physical(cast))),
    }?;
    Some(glowing(taken, producer, assumed))
}

/// A grid as glowing soot.
fn glowing(grid: &Grid, producer: Producer, assumed: &mut Vec<Assumption>) -> FieldMap {
    if !is_fraction(grid) && peak(grid) > 0.0 {
        if producer != Producer::Physical {
            return normalised(grid, SOOT_PEAK, FieldKind::Soot, assumed);
        }
        let words = format!(
            "{} peaks at {}, above any soot volume fraction: clamped to {FRACTION_MAX:e}",
            grid.name,
            figures(peak(grid))
        );
        assume(assumed, FieldKind::Soot, words);
    }
    FieldMap::new(&grid.name, 1.0, 0.0, 0.0, FRACTION_MAX)
}

fn is_physical(cast: &Cast) -> bool {
    cast.temperature.is_some_and(is_kelvin)
}

/// A field without units, scaled so that its peak becomes `physical_peak`.
fn normalised(
    grid: &Grid,
    physical_peak: f64,
    kind: FieldKind,
    assumed: &mut Vec<Assumption>,
) -> FieldMap {
    let raw = peak(grid);
    let scale = if raw > 0.0 { physical_peak / raw } else { 0.0 };
    let words = format!(
        "{} has no units: its peak {} was assumed to be {} {}",
        grid.name,
        figures(raw),
        kind.name(),
        figures(physical_peak)
    );
    assume(assumed, kind, words);
    FieldMap::new(&grid.name, scale, 0.0, 0.0, physical_peak)
}

/// Cold smoke, where the density is not already the soot.
fn smoke(cast: &Cast, producer: Producer, soot: Option<&FieldMap>) -> Option<FieldMap> {
    let grid = cast
        .smoke
        .filter(|grid| soot.is_none_or(|soot| soot.grid != grid.name))?;
    Some(smoking(grid, producer))
}

/// A grid as cold smoke.
fn smoking(grid: &Grid, producer: Producer) -> FieldMap {
    if producer == Producer::Physical || is_fraction(grid) {
        return FieldMap::new(&grid.name, 1.0, 0.0, 0.0, FRACTION_MAX);
    }
    let scale = match producer {
        Producer::Houdini => SMOKE_PEAK,
        _ => SMOKE_PEAK / BLENDER_DENSE_SMOKE,
    };
    FieldMap::new(&grid.name, scale, 0.0, 0.0, SMOKE_PEAK)
}

/// Progress of the reaction. Blender and Houdini write 0..1; EmberGen writes an intensity.
fn flame(grid: &Grid, producer: Producer, assumed: &mut Vec<Assumption>) -> FieldMap {
    if producer == Producer::EmberGen || peak(grid) > 4.0 {
        return normalised(grid, 1.0, FieldKind::Flame, assumed);
    }
    FieldMap::new(&grid.name, 1.0, 0.0, 0.0, 1.0)
}

fn temperature(grid: &Grid, producer: Producer, assumed: &mut Vec<Assumption>) -> FieldMap {
    let raw = peak(grid);
    let mut assume = |words| assume(assumed, FieldKind::Temperature, words);
    if is_kelvin(grid) || producer == Producer::Physical {
        if raw > FLAME_CEILING_K {
            assume(format!(
                "{} peaks at {} K, hotter than any flame: clamped to {FLAME_CEILING_K} K",
                grid.name,
                figures(raw)
            ));
        }
        if !is_kelvin(grid) {
            assume(format!(
                "{} peaks at {}: taken as kelvin, as you said",
                grid.name,
                figures(raw)
            ));
        }
        return FieldMap::new(&grid.name, 1.0, 0.0, 0.0, FLAME_CEILING_K);
    }
    let (coolest, why) = match producer {
        Producer::Blender => (
            AMBIENT_K,
            "Blender's maximum flame temperature is not in the file",
        ),
        Producer::EmberGen => (LUMINOUS_K, "it has no units and what burns glows"),
        _ => (AMBIENT_K, "it has no units"),
    };
    assume(format!(
        "{} is solver heat with a peak of {}: mapped to {coolest} K at 0 and {PEAK_K} K at the peak, because {why}",
        grid.name,
        figures(raw)
    ));
    let mut map = rise(grid, raw, coolest);
    map.max = SOLVER_CEILING_K;
    map
}

/// From `coolest` at 0 to 2000 K at the peak.
fn rise(grid: &Grid, raw_peak: f64, coolest: f64) -> FieldMap {
    let scale = if raw_peak > 0.0 {
        (PEAK_K - coolest) / raw_peak
    } else {
        0.0
    };
    FieldMap::new(&grid.name, scale, coolest, coolest, PEAK_K)
}

/// Finds something that glows where the file names no soot: the flame, else the smoke, else what is hot.
fn fill_soot(maps: &mut FieldMaps, cast: &Cast, assumed: &mut Vec<Assumption>) {
    if maps.soot.is_some() {
        return;
    }
    if let (Some(grid), Some(flame)) = (cast.flame, &maps.flame) {
        let scale = SOOT_PEAK * flame.scale;
        maps.soot = Some(FieldMap::new(&grid.name, scale, 0.0, 0.0, SOOT_PEAK));
        let words = format!(
            "no soot grid: assumed from {}, at most {SOOT_PEAK:e}",
            grid.name
        );
        assume(assumed, FieldKind::Soot, words);
    } else if let Some(grid) = cast.smoke {
        maps.smoke = None;
        let words = format!(
            "no flame or soot grid: {} is taken as glowing soot",
            grid.name
        );
        assume(assumed, FieldKind::Soot, words);
        maps.soot = Some(normalised(grid, SOOT_PEAK, FieldKind::Soot, assumed));
    } else if let (Some(grid), Some(kelvin)) = (cast.temperature, &maps.temperature) {
        // f_v rises from 0 at the first glow to the peak at the hottest voxel, as an affine map of the raw value.
        let hottest = kelvin.apply(peak(grid)).min(PEAK_K);
        let slope = SOOT_PEAK / (hottest - GLOW_K).max(1.0);
        let (scale, offset) = (slope * kelvin.scale, slope * (kelvin.offset - GLOW_K));
        maps.soot = Some(FieldMap::new(&grid.name, scale, offset, 0.0, SOOT_PEAK));
        let words = format!(
            "no soot, flame or density grid: soot assumed where {} is above {GLOW_K} K, {SOOT_PEAK:e} at {hottest:.0} K",
            grid.name
        );
        assume(assumed, FieldKind::Soot, words);
    }
}

/// Heats what glows where the file has no temperature.
fn fill_temperature(maps: &mut FieldMaps, cast: &Cast, assumed: &mut Vec<Assumption>) {
    if maps.temperature.is_some() {
        return;
    }
    let Some(grid) = cast.flame.or(cast.soot).or(cast.smoke) else {
        return;
    };
    let raw = peak(grid);
    let words = format!(
        "no temperature grid: assumed from {}, {AMBIENT_K} K at 0 to {PEAK_K} K at its peak {}",
        grid.name,
        figures(raw)
    );
    assume(assumed, FieldKind::Temperature, words);
    maps.temperature = Some(rise(grid, raw, AMBIENT_K));
}

/// A voxel size where the file has none: the report formats, and EmberGen's voxels of 1 unit.
fn guessed_voxel(
    volume: &Volume,
    producer: Producer,
    assumed: &mut Vec<Assumption>,
) -> Option<f64> {
    let unit_voxels = volume
        .grids
        .first()
        .is_some_and(|grid| (grid.voxel_size() - 1.0).abs().max_element() < 1e-6);
    let unknown = !volume.voxel_size_is_known || producer == Producer::EmberGen && unit_voxels;
    unknown.then(|| {
        assumed.push(Assumption {
            about: About::VoxelSize,
            words: format!(
                "the file has no physical size: voxels of {} mm assumed",
                GUESSED_VOXEL_M * 1000.0
            ),
        });
        GUESSED_VOXEL_M
    })
}

#[cfg(test)]
#[path = "preset_tests.rs"]
mod tests;
