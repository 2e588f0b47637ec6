//! What the numbers of a grid mean: affine maps with clamps from file units to physical ones.
//!
//! ```text
//! physical = clamp(scale · raw + offset, min, max)
//! ```

use serde::{Deserialize, Serialize};

/// The physical fields that a fire is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FieldKind {
    /// Glowing soot: volume of soot per volume of gas.
    Soot,
    /// Cold smoke: volume of soot per volume of gas, held apart so that it can be turned off.
    Smoke,
    /// Progress of the reaction, 0 to 1: where chemiluminescent bands shine.
    Flame,
    /// Gas temperature, kelvin.
    Temperature,
}

impl FieldKind {
    /// All kinds, in the order they are listed to people.
    pub const ALL: [Self; 4] = [Self::Soot, Self::Smoke, Self::Flame, Self::Temperature];

    /// Lower-case name, as in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Soot => "soot",
            Self::Smoke => "smoke",
            Self::Flame => "flame",
            Self::Temperature => "temperature",
        }
    }

    /// Greatest physical value that a mapping may give: all of the gas is soot, all of it burns, 100 000 K. The least
    /// is 0 for every kind.
    pub fn greatest(self) -> f64 {
        match self {
            Self::Soot | Self::Smoke | Self::Flame => 1.0,
            Self::Temperature => 1e5,
        }
    }

    /// Unit of the mapped values: "f_v" (dimensionless volume fraction), "" (0 to 1) or "K".
    pub fn unit(self) -> &'static str {
        match self {
            Self::Soot | Self::Smoke => "f_v",
            Self::Flame => "",
            Self::Temperature => "K",
        }
    }
}

/// How one physical field is made from one grid. An empty `grid` means that the field is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldMap {
    /// Name of the grid.
    pub grid: String,
    /// Physical units per file unit.
    pub scale: f64,
    /// Physical value of a raw 0, before clamping.
    pub offset: f64,
    /// Lowest physical value; at most `max`.
    pub min: f64,
    /// Highest physical value.
    pub max: f64,
}

impl FieldMap {
    /// A map to the units of its field.
    pub fn new(grid: &str, scale: f64, offset: f64, min: f64, max: f64) -> Self {
        Self {
            grid: grid.to_owned(),
            scale,
            offset,
            min,
            max,
        }
    }

    /// The physical value of a raw one. NaN maps to `min`.
    pub fn apply(&self, raw: f64) -> f64 {
        // max before min: both return the other operand for a NaN, so a NaN ends at the lower bound.
        (self.scale * raw + self.offset).max(self.min).min(self.max)
    }

    /// The physical range of a raw range, lowest first.
    pub fn mapped_range(&self, raw: (f64, f64)) -> (f64, f64) {
        let (a, b) = (self.apply(raw.0), self.apply(raw.1));
        (a.min(b), a.max(b))
    }
}

/// The maps of all four fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FieldMaps {
    /// To soot volume fraction.
    pub soot: Option<FieldMap>,
    /// To soot volume fraction of cold smoke.
    pub smoke: Option<FieldMap>,
    /// To 0..1.
    pub flame: Option<FieldMap>,
    /// To kelvin.
    pub temperature: Option<FieldMap>,
}

impl FieldMaps {
    /// The map of one field.
    pub fn get(&self, kind: FieldKind) -> Option<&FieldMap> {
        let map = match kind {
            FieldKind::Soot => &self.soot,
            FieldKind::Smoke => &self.smoke,
            FieldKind::Flame => &self.flame,
            FieldKind::Temperature => &self.temperature,
        };
        map.as_ref().filter(|map| !map.grid.is_empty())
    }

    /// The fields that are present.
    pub fn iter(&self) -> impl Iterator<Item = (FieldKind, &FieldMap)> {
        FieldKind::ALL
            .into_iter()
            .filter_map(|kind| Some((kind, self.get(kind)?)))
    }
}

/// Who wrote a volume, and so what its numbers mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Producer {
    /// Whoever [`recognise`](super::recognise()) says.
    #[default]
    Auto,
    /// Blender's Mantaflow: density, flame 0..1, temperature as solver heat.
    Blender,
    /// JangaFX EmberGen: flames and temperature, often without density.
    #[serde(rename = "embergen")]
    EmberGen,
    /// SideFX Houdini: density, burn or flame, heat, temperature; y up.
    Houdini,
    /// Soot volume fraction and kelvin as they stand.
    Physical,
}

impl Producer {
    /// All choices.
    pub const ALL: [Self; 5] = [
        Self::Auto,
        Self::Blender,
        Self::EmberGen,
        Self::Houdini,
        Self::Physical,
    ];

    /// Lower-case name, as in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Blender => "blender",
            Self::EmberGen => "embergen",
            Self::Houdini => "houdini",
            Self::Physical => "physical",
        }
    }
}

impl std::str::FromStr for Producer {
    type Err = String;

    /// The name in any case; the error lists the names.
    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|producer| producer.name().eq_ignore_ascii_case(text.trim()))
            .ok_or_else(|| {
                let names: Vec<&str> = Self::ALL.into_iter().map(Self::name).collect();
                format!(
                    "unknown producer \"{text}\": expected one of {}",
                    names.join(", ")
                )
            })
    }
}

/// The axis of the file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpAxis {
    /// Houdini and most games.
    Y,
    /// Blender, EmberGen and the report.
    Z,
}

/// A guess at the producer, with its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recognised {
    /// Never [`Producer::Auto`].
    pub producer: Producer,
    /// Why, in words for the person.
    pub reason: String,
}

/// A proposal for everything the file does not say.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// How fields are made from grids.
    pub maps: FieldMaps,
    /// The axis of the file that points up.
    pub up: UpAxis,
    /// Edge of a voxel in metres, where the file has no physical size. `None`: file units are metres.
    pub voxel_size_m: Option<f64>,
    /// Everything that was assumed.
    pub assumptions: Vec<Assumption>,
}

/// Something that a file does not say and a preset had to assume.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumption {
    /// What it is about: a person who sets this settles it.
    pub about: About,
    /// The assumption in words.
    pub words: String,
}

/// What an assumption is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// The mapping of a field.
    Field(FieldKind),
    /// The size of a voxel.
    VoxelSize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_scales_offsets_and_clamps() {
        let map = FieldMap::new("heat", 1000.0, 300.0, 300.0, 2000.0);
        assert_eq!(map.apply(0.5), 800.0);
        assert_eq!(map.apply(-1.0), 300.0);
        assert_eq!(map.apply(9.0), 2000.0);
        assert_eq!(map.apply(f64::NAN), 300.0);
    }

    #[test]
    fn a_mapped_range_is_ordered_even_for_a_negative_scale() {
        let map = FieldMap::new("cold", -1.0, 1.0, 0.0, 1.0);
        assert_eq!(map.mapped_range((0.0, 0.75)), (0.25, 1.0));
    }

    #[test]
    fn a_producer_is_read_in_any_case_and_a_wrong_one_lists_the_names() {
        assert_eq!("EmberGen".parse(), Ok(Producer::EmberGen));
        let error = "maya".parse::<Producer>().err().unwrap_or_default();
        assert!(error.contains("houdini"), "{error}");
    }

    #[test]
    fn the_scene_file_and_the_command_line_name_producers_alike() {
        for producer in Producer::ALL {
            let written = serde_json::to_value(producer).ok();
            assert_eq!(written, Some(serde_json::Value::from(producer.name())));
        }
    }
}
