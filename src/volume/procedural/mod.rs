//! The built-in flames: fields of soot, kelvin and burning, made by the same grid path as a file.

use glam::{DAffine3, DVec3, IVec3, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::watch::{Stretch, Watch};
use super::{Border, Grid, Volume, VolumeError};

mod burner;
mod noise;
mod spirit;
mod torch;

/// A flame that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BuiltIn {
    /// A torch: wrinkled sheets of soot.
    #[default]
    Torch,
    /// A gas burner: a blue cone, hot gas, a sooty tip.
    Burner,
    /// Burning spirit: a sheet without soot, for salts to colour.
    Spirit,
}

impl BuiltIn {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Torch, Self::Burner, Self::Spirit];

    /// The name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Torch => "torch",
            Self::Burner => "burner",
            Self::Spirit => "spirit",
        }
    }

    /// Makes it: soot volume fraction, kelvin and, where more than its soot glows, the flame field; z up, metres,
    /// standing on the origin.
    pub fn volume(self) -> Volume {
        self.make(Watch::default().whole())
    }

    /// [`BuiltIn::volume`] under the eyes of a watch.
    ///
    /// # Errors
    /// [`VolumeError::Cancelled`].
    pub fn volume_watched(self, watch: &Watch) -> Result<Volume, VolumeError> {
        let volume = self.make(watch.whole());
        watch.whole().reach(1, 1)?;
        Ok(volume)
    }

    /// The flame; once the watch is cancelled parts of it are left out.
    fn make(self, stretch: Stretch) -> Volume {
        let grids = match self {
            Self::Torch => torch::LATTICE.grids(torch::at, stretch),
            Self::Burner => burner::LATTICE.grids(burner::at, stretch),
            Self::Spirit => spirit::LATTICE.grids(spirit::at, stretch),
        };
        Volume {
            notes: Vec::new(),
            built_in: Some(self),
            ..Volume::from_grids(grids, "")
        }
    }
}

/// The built-in torch.
pub fn torch() -> Volume {
    BuiltIn::Torch.volume()
}

/// Temperature of the air, K.
const AIR_K: f32 = 300.0;
/// Share of the time that the fields take; the rest is building bricks, which is too quick to watch.
const MIXING: f32 = 0.95;

/// What is at a point of a flame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fields {
    /// Volume fraction.
    soot: f32,
    /// Temperature, K.
    kelvin: f32,
    /// Flame field, 0 to 1.
    flame: f32,
}

impl Fields {
    const AIR: Self = Self {
        soot: 0.0,
        kelvin: AIR_K,
        flame: 0.0,
    };
}

/// A lattice that stands on the origin.
struct Lattice {
    dims: IVec3,
    /// Edge of a voxel, m.
    voxel_m: f64,
}

impl Lattice {
    /// The grids of fields that are given at points in metres.
    fn grids(&self, at: impl Fn(Vec3) -> Fields + Sync, stretch: Stretch) -> Vec<Grid> {
        let dims = self.dims;
        let corner = DVec3::new(-0.5 * f64::from(dims.x), -0.5 * f64::from(dims.y), 0.0) + 0.5;
        let world_from_index =
            DAffine3::from_scale(DVec3::splat(self.voxel_m)) * DAffine3::from_translation(corner);
        let rows: Vec<(i32, i32)> = (0..dims.z)
            .flat_map(|z| (0..dims.y).map(move |y| (y, z)))
            .collect();
        let counter = stretch.part(0.0, MIXING).counter(rows.len());
        let at = &at;
        let fields: Vec<Fields> = rows
            .par_iter()
            .flat_map_iter(|&(y, z)| {
                let width = if counter.goes_on() { dims.x } else { 0 };
                (0..width).map(move |x| {
                    let voxel = IVec3::new(x, y, z).as_dvec3();
                    at(world_from_index.transform_point3(voxel).as_vec3())
                })
            })
            .collect();
        let grid = |name: &str, field: fn(&Fields) -> f32| {
            let values: Vec<f32> = fields.iter().map(field).collect();
            let air = field(&Fields::AIR);
            Grid::from_dense(
                name,
                dims,
                &values,
                world_from_index,
                Border::Background,
                air,
            )
        };
        let mut grids = vec![
            grid("soot", |fields| fields.soot),
            grid("temperature", |fields| fields.kelvin),
        ];
        if fields.iter().any(|fields| fields.flame > 0.0) {
            grids.push(grid("flame", |fields| fields.flame));
        }
        grids
    }
}
