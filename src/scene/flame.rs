//! The flame: a volume, what its fields mean, and the laws of its soot.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::fuel::Fuel;
use super::medium::Medium;
use super::packing::{self, Fields, PackingError};
use crate::math::Aabb;
use crate::physics::soot::{self, Hold, SootLaw, SootModel};
use crate::volume::{FieldMaps, Limits, UpAxis, Volume};

/// How the file's axes and lengths lie in the world of metres with z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The file's axis that points up.
    pub up: UpAxis,
    /// Metres for one unit of the file's transform.
    pub metres_per_unit: f64,
}

impl Placement {
    /// The world from the file's own frame.
    pub fn world_from_file(&self) -> DAffine3 {
        let turn = match self.up {
            UpAxis::Z => DMat3::IDENTITY,
            // y up → z up: a quarter turn about x.
            UpAxis::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
        };
        DAffine3::from_mat3(turn * self.metres_per_unit)
    }
}

/// Everything about the flame that a person can set.
#[derive(Debug, Clone, PartialEq)]
pub struct FlameParams {
    /// Which grid is which field, and in what units.
    pub maps: FieldMaps,
    /// The file's frame in the world.
    pub placement: Placement,
    /// What burns.
    pub fuel: Fuel,
    /// How σ_a depends on wavelength.
    pub soot_model: SootModel,
    /// Radius of a primary soot particle, nm, above 0.
    pub soot_radius_nm: f64,
    /// What stays the same when the radius changes.
    pub soot_hold: Hold,
    /// Multiplies the soot field, at least 0.
    pub soot_amount: f64,
    /// Multiplies the smoke field, at least 0.
    pub smoke_amount: f64,
    /// Temperature of the air, K: where the volume has no temperature field.
    pub ambient_k: f64,
}

impl FlameParams {
    /// Whether this volume's fields can be packed side by side.
    ///
    /// # Errors
    /// They lie too far apart or fill too much of the air.
    pub fn check(&self, volume: &Volume) -> Result<(), PackingError> {
        let (amounts, _) = self.packed_amounts();
        Fields {
            volume,
            maps: &self.maps,
            amounts,
            ambient_k: self.ambient_k,
        }
        .check(&Limits::default())
    }

    /// Weights of soot and smoke in the packed medium, and the factor that is left to the laws. With soot alone its
    /// amount is such a factor, so that it can change without packing.
    fn packed_amounts(&self) -> ([f64; 2], f64) {
        let two_fields = self.maps.smoke.is_some() && self.smoke_amount > 0.0;
        if two_fields || self.soot_amount <= 0.0 {
            ([self.soot_amount, self.smoke_amount], 1.0)
        } else {
            ([1.0, 0.0], self.soot_amount)
        }
    }
}

/// What must be packed anew: everything about the medium except the laws.
#[derive(Debug, Clone, PartialEq)]
struct PackingKey {
    maps: FieldMaps,
    placement: Placement,
    /// Weights of soot and smoke.
    amounts: [f64; 2],
    ambient_k: f64,
}

/// A volume made into a medium with optics. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Flame {
    volume: Arc<Volume>,
    key: PackingKey,
    medium: Arc<Medium>,
    soot: SootLaw,
    /// Multiplies the medium's volume fraction: amount and radius.
    volume_fraction_factor: f64,
}

impl Flame {
    /// Makes the medium and its laws. What `before` has packed already is taken over if it is the same.
    ///
    /// Fields that [`FlameParams::check`] refuses are not packed: the medium is clear.
    pub fn new(volume: &Arc<Volume>, params: &FlameParams, before: Option<&Self>) -> Self {
        let radius_factor = soot::volume_fraction_factor(params.soot_hold, params.soot_radius_nm);
        let (amounts, common) = params.packed_amounts();
        let key = PackingKey {
            maps: params.maps.clone(),
            placement: params.placement,
            amounts,
            ambient_k: params.ambient_k,
        };
        let reusable =
            before.filter(|before| Arc::ptr_eq(&before.volume, volume) && before.key == key);
        let medium = reusable.map_or_else(
            || {
                let fields = Fields {
                    volume,
                    maps: &key.maps,
                    amounts,
                    ambient_k: key.ambient_k,
                };
                let frame = params.placement.world_from_file();
                Arc::new(
                    fields
                        .pack(&frame, &Limits::default())
                        .unwrap_or_else(|_| packing::empty()),
                )
            },
            |before| Arc::clone(&before.medium),
        );
        Self {
            volume: Arc::clone(volume),
            key,
            medium,
            soot: SootLaw {
                model: params.soot_model,
                fuel_index: params.fuel.soot_index(),
            },
            volume_fraction_factor: common * radius_factor,
        }
    }

    /// The packed fields.
    pub fn medium(&self) -> &Medium {
        &self.medium
    }

    /// Whether two flames share their packed fields.
    pub fn shares_medium_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.medium, &other.medium)
    }

    /// How this flame's soot absorbs.
    pub fn soot(&self) -> SootLaw {
        self.soot
    }

    /// Absorption coefficient at a wavelength for a volume fraction of the *medium*, 1/m for each unit: the
    /// soot's law times amount and radius.
    pub fn absorption_per_sample(&self, lambda_nm: f64) -> f64 {
        self.volume_fraction_factor * self.soot.absorption_per_volume_fraction(lambda_nm)
    }
}

/// The box of the bulk of a volume's soot (its smoke where there is no soot) in the world, metres; empty if there is
/// none. What a camera frames.
pub fn world_bounds(volume: &Volume, maps: &FieldMaps, placement: &Placement) -> Aabb {
    let fields = [&maps.soot, &maps.smoke];
    let grids = fields
        .into_iter()
        .flatten()
        .filter_map(|map| volume.grid(&map.grid));
    let Some((grid, bulk)) = grids
        .map(|grid| (grid, grid.bulk()))
        .find(|(_, bulk)| !bulk.is_empty())
    else {
        return Aabb::EMPTY;
    };
    let voxels = Aabb {
        min: bulk.min.as_dvec3() - 0.5,
        max: bulk.max.as_dvec3() - 0.5,
    };
    voxels.transformed(&(placement.world_from_file() * grid.world_from_index()))
}
