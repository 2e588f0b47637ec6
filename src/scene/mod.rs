//! What is looked at, and from where: a [`Flame`], a [`Stage`] around it and a [`Camera`].
//!
//! The way from a file to something that can be marched: a `Volume` of named grids and [`FlameParams`] give a
//! [`Medium`] (fields in physical units, packed for the march) and optics (laws of the fuel's soot). Grids are
//! only touched when a field's mapping changes; fuel, radius and amount only change the laws.

mod air;
mod brick_means;
pub mod camera;
mod camera_moves;
mod columns;
pub mod curves;
mod cuts;
mod fit;
pub mod flame;
mod flame_params;
pub mod fuel;
pub mod glow;
pub mod interpolation;
pub(crate) mod means;
pub mod medium;
mod named;
pub mod optics;
mod packing;
pub mod quadrature;
pub mod refractivity;
pub mod salt;
pub mod slice;
mod source;
pub mod stage;

pub use air::Air;
pub use camera::Camera;
pub use flame::{Bending, BentAir, Flame, FlameParams, Placement, Scattering, ScatteringParams};
pub use fuel::Fuel;
pub use glow::{Glow, GlowParams};
pub use interpolation::Interpolation;
pub use medium::Medium;
pub use optics::{Coefficients, Local, Optics};
pub use packing::PackingError;
pub use quadrature::WavelengthSet;
pub use salt::Salt;
pub use stage::Stage;

/// Everything that light passes on its way to the film.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The glowing, absorbing medium.
    pub flame: Flame,
    /// The eye.
    pub camera: Camera,
    /// What stands around.
    pub stage: Stage,
}

/// Packs a volume whose fields are physical and in metres, for tests of the floors above. Where there is a flame field,
/// burning and hot gas are taken to glow.
#[cfg(test)]
pub(crate) fn pack_for_tests(
    volume: &crate::volume::Volume,
    maps: &crate::volume::FieldMaps,
    interpolation: Interpolation,
) -> Result<Medium, PackingError> {
    let fields = packing::Fields {
        volume,
        maps,
        amounts: [1.0, 1.0],
        ambient_k: 300.0,
        gas: packing::GasFields {
            burning: maps.flame.as_ref().map(|_| packing::Burning::Field),
            hot_above_k: maps.flame.as_ref().map(|_| glow::VAPOUR_K[0]),
            bends_above_k: None,
        },
        smoke_apart: maps.smoke.is_some(),
        interpolation,
    };
    fields.pack(&glam::DAffine3::IDENTITY, &crate::volume::Limits::default())
}
