//! Which pictures `sootlight render` makes.

use crate::sequence::Frames;

/// Which pictures a command makes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Pictures {
    /// One, of the project's files.
    One,
    /// These frames of the sequence that the project's files are of.
    Frames(Frames),
    /// So many views once round the fire.
    Turntable(u32),
}
