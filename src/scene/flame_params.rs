//! Everything about a flame that a person can set, and what it comes to for packing and laws.

use glam::{DAffine3, DMat3, DVec3};

use super::air::Air;
use super::fuel::Fuel;
use super::glow::{Glow, GlowParams};
use super::interpolation::Interpolation;
use super::packing::{Burning, Fields, GasFields, PackingError};
use crate::physics::constants::METRES_PER_NM;
use crate::physics::soot::{self, Hold, SootLaw, SootModel};
use crate::volume::{FieldMap, FieldMaps, UpAxis, Volume};

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

/// How much hotter than the air gas must be for its bricks to be stored where light is bent, K. One kelvin at 300 K
/// changes n by 9e-7: over the width of a brick that bends a ray by a microradian, less than a hundredth of a pixel; and a
/// file's noise about its background fills no bricks.
const BENDS_ABOVE_AIR_K: f64 = 1.0;

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
    /// Where smoke is left out because nobody could see it: what it would change at most, ΔE_ITP.
    pub smoke_left_out: Option<f64>,
    /// What glows in the gas beside soot.
    pub glow: GlowParams,
    /// The air around.
    pub air: Air,
    /// How values between the samples of a field are formed.
    pub interpolation: Interpolation,
    /// How soot and smoke scatter; `None` where that is not to be computed.
    pub scattering: Option<ScatteringParams>,
    /// How hot gas bends light; `None` where nothing shows it or it is not to be computed.
    pub bending: Option<Bending>,
}

/// How soot and smoke scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScatteringParams {
    /// Mean cosine g of the scattering, −1 to 1 open; `None`: that of a sphere of the soot's radius, by Mie's series.
    pub asymmetry: Option<f64>,
    /// Share of what smoke takes from light that it scatters, 0 to below 1.
    pub smoke_albedo: f64,
}

/// How hot gas bends light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bending {
    /// Multiplies the gradient of the refractive index; 1 is nature's.
    pub gain: f64,
    /// Whether colours take paths of their own.
    pub dispersion: bool,
}

impl FlameParams {
    /// Whether a flame of these parameters glows and absorbs exactly as one of the others: a parameter that no law
    /// looks at makes no difference.
    pub fn gives_same_light_as(&self, other: &Self) -> bool {
        self.effect() == other.effect()
    }

    /// What glows in the gas beside soot: radicals only where something says what burns.
    pub fn shining_gas(&self) -> Glow {
        let says_what_burns = self.maps.flame.is_some() || self.glow.by_heat;
        let glow = GlowParams {
            radicals: if says_what_burns {
                self.glow.radicals
            } else {
                0.0
            },
            ..self.glow
        };
        Glow::new(&glow, self.fuel, &self.air)
    }

    /// Whether the light of the gas depends on how hot it is.
    pub fn gas_shines_by_heat(&self) -> bool {
        let gas = self.gas_fields(&self.shining_gas());
        gas.hot_above_k.is_some() || gas.burning == Some(Burning::Temperature)
    }

    /// Whether any field of soot or smoke counts.
    pub fn has_soot(&self) -> bool {
        self.packed_amounts().0.iter().any(|amount| *amount > 0.0) && self.packed_amounts().1 > 0.0
    }

    /// What the parameters come to.
    pub(super) fn effect(&self) -> Effect {
        let (amounts, common) = self.packed_amounts();
        let glow = self.shining_gas();
        let gas = self.gas_fields(&glow);
        let scattering = self.scattering.filter(|_| self.has_soot());
        Effect {
            key: PackingKey {
                maps: FieldMaps {
                    // Nothing but burning gas that glows reads the reaction's progress.
                    flame: self.maps.flame.clone().filter(|_| gas.burning.is_some()),
                    ..self.maps.clone()
                },
                placement: self.placement,
                amounts,
                // Where a field says how hot all gas is, the air's own heat is not packed.
                ambient_k: match self.maps.temperature {
                    Some(_) => Air::default().temperature_k,
                    None => self.air.temperature_k,
                },
                gas,
                smoke_apart: scattering.is_some() && amounts[1] > 0.0,
                interpolation: self.interpolation,
            },
            soot: self.fuel.soot_law(self.soot_model),
            volume_fraction_factor: common
                * soot::volume_fraction_factor(self.soot_hold, self.soot_radius_nm),
            glow,
            // Without soot and smoke nothing scatters.
            scattering: scattering.map(|params| Scattering {
                params,
                radius_m: self.soot_radius_nm * METRES_PER_NM,
            }),
            bending: self.bends().map(|bending| BentAir {
                bending,
                air: self.air,
                fuel: self.fuel,
                clear_k: self.glow.clear_k,
            }),
        }
    }

    /// How the gas bends light, where anything says how hot it is.
    fn bends(&self) -> Option<Bending> {
        self.bending.filter(|_| self.maps.temperature.is_some())
    }

    /// What of the gas is packed for a glow, and for bent light.
    fn gas_fields(&self, glow: &Glow) -> GasFields {
        let burning = if self.maps.flame.is_some() {
            Burning::Field
        } else {
            Burning::Temperature
        };
        GasFields {
            burning: glow.has_radicals().then_some(burning),
            hot_above_k: glow.has_metal().then(|| glow.vapour_above_k()),
            bends_above_k: self
                .bends()
                .map(|_| self.air.temperature_k.max(self.glow.clear_k) + BENDS_ABOVE_AIR_K),
        }
    }

    /// Whether this volume's fields can be packed side by side.
    ///
    /// # Errors
    /// They lie too far apart or fill too much of the air.
    pub fn check(&self, volume: &Volume) -> Result<(), PackingError> {
        self.effect().key.fields(volume).check(&volume.limits)
    }

    /// Weights of soot and smoke in the packed medium, and the factor that is left to the laws. With soot alone its
    /// amount is such a factor, so that it can change without packing.
    fn packed_amounts(&self) -> ([f64; 2], f64) {
        // An amount of what is not there makes no difference.
        let amount = |map: &Option<FieldMap>, amount: f64| if map.is_some() { amount } else { 0.0 };
        let soot = amount(&self.maps.soot, self.soot_amount);
        let smoke = match self.smoke_left_out {
            Some(_) => 0.0,
            None => amount(&self.maps.smoke, self.smoke_amount),
        };
        if smoke > 0.0 || soot <= 0.0 {
            ([soot, smoke], 1.0)
        } else {
            ([1.0, 0.0], soot)
        }
    }
}

/// What must be packed anew: everything about the medium except the laws.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PackingKey {
    maps: FieldMaps,
    placement: Placement,
    /// Weights of soot and smoke.
    amounts: [f64; 2],
    ambient_k: f64,
    gas: GasFields,
    /// Whether it must be known which part of the soot is smoke.
    smoke_apart: bool,
    interpolation: Interpolation,
}

impl PackingKey {
    /// The fields of a volume that this key tells to pack.
    pub(super) fn fields<'a>(&'a self, volume: &'a Volume) -> Fields<'a> {
        Fields {
            volume,
            maps: &self.maps,
            amounts: self.amounts,
            ambient_k: self.ambient_k,
            gas: self.gas,
            smoke_apart: self.smoke_apart,
            interpolation: self.interpolation,
        }
    }
}

/// Parameters as the laws see them: what must be packed, and what multiplies it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Effect {
    pub(super) key: PackingKey,
    pub(super) soot: SootLaw,
    /// Multiplies the medium's volume fraction: amount and radius.
    pub(super) volume_fraction_factor: f64,
    pub(super) glow: Glow,
    pub(super) scattering: Option<Scattering>,
    pub(super) bending: Option<BentAir>,
}

impl Effect {
    /// Whether smoke is packed.
    pub(super) fn has_smoke(&self) -> bool {
        self.key.amounts[1] > 0.0
    }
}

/// How the medium scatters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattering {
    /// What was asked for.
    pub params: ScatteringParams,
    /// Radius of the soot's primary particles, m.
    pub radius_m: f64,
}

/// The gas that bends light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BentAir {
    /// What was asked for.
    pub bending: Bending,
    /// The air around.
    pub air: Air,
    /// Whose products it mixes with.
    pub fuel: Fuel,
    /// Temperature of gas of which the volume says nothing, K: see [`Refractivity`].
    ///
    /// [`Refractivity`]: super::refractivity::Refractivity
    pub clear_k: f64,
}
