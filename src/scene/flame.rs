//! The flame: a volume, what its fields mean, and the laws of its soot.

use std::sync::Arc;

use super::flame_params::Effect;
use super::glow::Glow;
use super::medium::Medium;
use super::packing;
use crate::math::Aabb;
use crate::physics::soot::SootLaw;
use crate::volume::{FieldMap, FieldMaps, Volume};

pub use super::flame_params::{
    Bending, BentAir, FlameParams, Placement, Scattering, ScatteringParams,
};

/// A volume made into a medium with optics. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Flame {
    volume: Arc<Volume>,
    effect: Effect,
    medium: Arc<Medium>,
    smoke_left_out: Option<f64>,
}

impl Flame {
    /// Makes the medium and its laws. What `before` has packed already is taken over if it is the same.
    ///
    /// Fields that [`FlameParams::check`] refuses are not packed: the medium is clear.
    pub fn new(volume: &Arc<Volume>, params: &FlameParams, before: Option<&Self>) -> Self {
        let effect = params.effect();
        let key = &effect.key;
        let reusable = before
            .filter(|before| Arc::ptr_eq(&before.volume, volume) && before.effect.key == *key);
        let medium = reusable.map_or_else(
            || {
                let fields = key.fields(volume);
                let frame = params.placement.world_from_file();
                Arc::new(
                    fields
                        .pack(&frame, &volume.limits)
                        .unwrap_or_else(|_| packing::empty()),
                )
            },
            |before| Arc::clone(&before.medium),
        );
        Self {
            volume: Arc::clone(volume),
            effect,
            medium,
            smoke_left_out: params.smoke_left_out,
        }
    }

    /// Whether any of the packed soot is smoke.
    pub fn has_smoke(&self) -> bool {
        self.effect.has_smoke()
    }

    /// What smoke that is not packed would change in the picture at most, ΔE_ITP; `None` where none was left out.
    pub fn smoke_left_out(&self) -> Option<f64> {
        self.smoke_left_out
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
        self.effect.soot
    }

    /// What glows in the gas beside soot.
    pub fn glow(&self) -> &Glow {
        &self.effect.glow
    }

    /// How this flame's soot and smoke scatter; `None` where that is not to be computed.
    pub fn scattering(&self) -> Option<&Scattering> {
        self.effect.scattering.as_ref()
    }

    /// Scattering coefficients at a wavelength for a volume fraction of the *medium* that is soot, and that is smoke, 1/m
    /// for each unit; zero where scattering is not to be computed.
    pub fn scattering_per_sample(&self, lambda_nm: f64) -> [f64; 2] {
        let Some(Scattering { params, radius_m }) = self.effect.scattering else {
            return [0.0; 2];
        };
        let absorption = self.absorption_per_sample(lambda_nm);
        let ratio = self.effect.soot.scattering_ratio(lambda_nm, radius_m);
        let albedo = params.smoke_albedo;
        [ratio, albedo / (1.0 - albedo)].map(|ratio| absorption * ratio)
    }

    /// Mean cosine of the scattering at a wavelength, −1 to 1 open.
    ///
    /// What was asked for, else that of the soot's spheres by Mie's series; 0 where nothing scatters. Smoke is taken to
    /// scatter into the same directions.
    pub fn asymmetry(&self, lambda_nm: f64) -> f64 {
        let Some(Scattering { params, radius_m }) = self.effect.scattering else {
            return 0.0;
        };
        let of_spheres = || self.effect.soot.asymmetry(lambda_nm, radius_m);
        params.asymmetry.unwrap_or_else(of_spheres)
    }

    /// How this flame's gas bends light; `None` where that is not to be computed.
    pub fn bending(&self) -> Option<&BentAir> {
        self.effect.bending.as_ref()
    }

    /// What a volume fraction of the *medium* is to be multiplied by: the scene's amount, and what the radius does to it.
    pub fn volume_fraction_factor(&self) -> f64 {
        self.effect.volume_fraction_factor
    }

    /// Absorption coefficient at a wavelength for a volume fraction of the *medium*, 1/m for each unit: the
    /// soot's law times amount and radius.
    pub fn absorption_per_sample(&self, lambda_nm: f64) -> f64 {
        self.effect.volume_fraction_factor
            * self.effect.soot.absorption_per_volume_fraction(lambda_nm)
    }
}

/// The box of the bulk of a volume's soot (its smoke where there is no soot) and of what burns, in the world, metres;
/// empty if there is none. What a camera frames.
pub fn world_bounds(volume: &Volume, maps: &FieldMaps, placement: &Placement) -> Aabb {
    let bulk_of = |map: &Option<FieldMap>| {
        let grid = volume.grid(&map.as_ref()?.grid)?;
        let bulk = grid.bulk();
        let voxels = Aabb {
            min: bulk.min.as_dvec3() - 0.5,
            max: bulk.max.as_dvec3() - 0.5,
        };
        let world = placement.world_from_file() * grid.world_from_index();
        (!bulk.is_empty()).then(|| voxels.transformed(&world))
    };
    let soot = bulk_of(&maps.soot).or_else(|| bulk_of(&maps.smoke));
    let burning = bulk_of(&maps.flame);
    soot.into_iter()
        .chain(burning)
        .fold(Aabb::EMPTY, |all, bulk| all.union(&bulk))
}

#[cfg(test)]
impl Flame {
    /// This flame with one number of its packed field spoilt, soot (0) or temperature (1): for tests of how far that
    /// reaches.
    pub(crate) fn with_spoilt_sample(&self, at: usize, field: usize) -> Self {
        let mut medium = (*self.medium).clone();
        medium.samples[at][field] = f32::NAN;
        Self {
            medium: Arc::new(medium),
            ..self.clone()
        }
    }
}
