//! From light to a picture: the standard observer, adaptation, and what a display can show.
//!
//! The eye is modelled in three steps, each a file: a spectrum is weighed by the standard observer ([`cie`]), the result
//! is adapted to the brightest light in view ([`adaptation`]), and brought into what a display can show ([`display`]). How different two colours look is in [`itp`].

pub mod adaptation;
pub mod cie;
mod curve;
pub mod display;
pub mod false_colour;
mod gamut;
mod hue;
pub mod itp;
pub mod reflectance;
pub mod xyz;

#[cfg(test)]
#[allow(
    clippy::duplicate_mod,
    reason = "physics and colour are strangers: each reads the reference files for itself"
)]
#[path = "../../tests/golden/csv.rs"]
mod golden_csv;
