//! The laws of fire: how a hot body glows, how soot absorbs and scatters and into which directions, which lines and bands
//! hot gas has, how air and hot gas bend light.
//!
//! Every law is a plain function of f64 in SI units; wavelengths are vacuum wavelengths in nanometres where a name says
//! `_nm`. No grids, no pictures, no state. Each file opens with its formula, the symbols with their units, the range of
//! validity and the source.
//!
//! Physics is infallible: what a number must satisfy is checked where it enters the program, and stated here as a
//! precondition. Inside the stated domain every function returns a finite number.

pub mod bands;
pub mod blackbody;
pub mod constants;
pub mod growth;
pub mod hot_gas;
pub mod lines;
pub mod mie;
pub mod moist_air;
pub mod phase;
pub mod saturation;
pub mod soot;
pub mod soot_index;

#[cfg(test)]
#[allow(
    clippy::duplicate_mod,
    reason = "physics and colour are strangers: each reads the reference files for itself"
)]
#[path = "../../tests/golden/csv.rs"]
mod golden_csv;
