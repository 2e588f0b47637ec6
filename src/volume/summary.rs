//! What is in a volume and what would be made of it, as data: others format it.

use std::path::PathBuf;

use glam::{DVec3, IVec3};

use super::field::{FieldKind, Preset, Recognised};
use super::{Format, IndexBox, Producer, SkippedGrid, Volume, preset, recognise};

/// One grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSummary {
    /// Name in the file.
    pub name: String,
    /// "half", "float", "double", "ascii" or "computed".
    pub stored_as: String,
    /// Box of the voxels that hold data.
    pub bounds: IndexBox,
    /// Its dimensions in voxels.
    pub dims: IVec3,
    /// Lowest and highest value, file units.
    pub range: (f32, f32),
    /// Value of absent voxels, file units.
    pub background: f32,
    /// Edges of a voxel, file units.
    pub voxel_size: DVec3,
    /// World position of the sample of voxel (0, 0, 0), file units.
    pub origin: DVec3,
    /// Voxels that hold data.
    pub active_voxels: u64,
    /// Resident size.
    pub bytes: u64,
}

/// One physical field as the preset would make it.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedField {
    /// Which field.
    pub kind: FieldKind,
    /// Grid it is made from.
    pub grid: String,
    /// Lowest and highest value in the file.
    pub raw: (f64, f64),
    /// Lowest and highest physical value.
    pub mapped: (f64, f64),
    /// Unit of `mapped`.
    pub unit: &'static str,
}

/// Everything to tell about a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The files.
    pub sources: Vec<PathBuf>,
    /// Their format.
    pub format: Format,
    /// The program that wrote them, where they say so.
    pub creator: Option<String>,
    /// The grids, in file order.
    pub grids: Vec<GridSummary>,
    /// Grids that are not used.
    pub skipped: Vec<SkippedGrid>,
    /// Who is thought to have written it, and why.
    pub recognised: Recognised,
    /// The proposal that follows, with its flaws.
    pub preset: Preset,
    /// The fields of the proposal.
    pub fields: Vec<MappedField>,
    /// What was repaired, chosen or assumed while reading.
    pub notes: Vec<String>,
}

/// Sums up a volume. `producer` overrides the guess unless it is [`Producer::Auto`].
pub fn summarise(volume: &Volume, producer: Producer) -> Summary {
    let recognised = recognise(volume);
    let preset = preset(producer, volume);
    let fields = preset
        .maps
        .iter()
        .filter_map(|(kind, map)| {
            let range = volume.grid(&map.grid)?.range();
            let raw = (f64::from(range.0), f64::from(range.1));
            Some(MappedField {
                kind,
                grid: map.grid.clone(),
                raw,
                mapped: map.mapped_range(raw),
                unit: kind.unit(),
            })
        })
        .collect();
    let grids = volume
        .grids
        .iter()
        .map(|grid| GridSummary {
            name: grid.name.clone(),
            stored_as: grid.stored_as().to_owned(),
            bounds: grid.bounds(),
            dims: grid.bounds().dims(),
            range: grid.range(),
            background: grid.background(),
            voxel_size: grid.voxel_size(),
            origin: grid.world_from_index().translation,
            active_voxels: grid.active_voxels(),
            bytes: grid.bytes(),
        })
        .collect();
    Summary {
        sources: volume.sources.clone(),
        format: volume.format,
        creator: volume.metadata.creator.clone(),
        grids,
        skipped: volume.skipped.clone(),
        recognised,
        preset,
        fields,
        notes: volume.notes.clone(),
    }
}
