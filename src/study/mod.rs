//! What accuracy costs in time: of this scene, on this machine.
//!
//! A [`Part`](crate::render::part::Part) of the picture, spread over where there is light, is rendered in several ways and
//! compared with a reference of the same pixels: the shortest step, 64 wavelengths, 28 rays a pixel. What a part takes is
//! scaled to the whole picture.
//!
//! * The [`Pilot`] is quick: it tries steps, wavelengths and rays each by themselves. Small differences add up pixel by pixel
//!   (`sight`), so the error of every choice of the three is known, and the cheapest that is good enough is chosen.
//! * The [`Report`] measures every variant for itself, and is what `sootlight study` writes.
//!
//! Which numbers are chosen depends on the scene alone, never on a clock: what a choice costs is counted for that in samples
//! and wavelengths, so that the same input gives the same picture. Seconds are only told.
//!
//! The reference is of this program's own: how far it is from a real fire nobody knows from it.

mod aim;
mod chart;
mod compared;
mod front;
mod numbers;
mod pilot;
mod report;
mod sight;
mod table;
mod tried;
mod variant;

pub use aim::{Aim, aim};
pub use chart::{Chart, ChartError};
pub use compared::{apart, measured, render_reference};
pub use numbers::{Numbers, RAYS, REFERENCE, STEPS};
pub use pilot::{Choice, Pilot, Split};
pub use report::{Point, Report, Status, report};
pub use sight::Error;
pub use variant::{Family, Variant};
