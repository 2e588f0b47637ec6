//! A range of a sequence as pictures, or one fire from all around: the one road of command line and window.
//!
//! What one picture takes from its own file or measures on itself would flicker from frame to frame: the mapping of fields
//! at the file's peak, a camera that frames the fire, the automatic exposure and the white, the effects that can be seen, the
//! numbers that are exact enough. [`lock()`] finds them once, on frames spread over the range, and sets them as keys of the
//! scene file, so that every picture tells in its provenance what it was made with and can be made again by itself.
//! [`write()`] then makes the pictures frame by frame, and keeps those that are there already.

mod error;
mod hold;
mod kept;
mod lock;
mod look;
mod order;
mod reader;
mod shots;
mod target;
mod write;

pub use error::{FrameError, RangeError};
pub use hold::{Taken, is_held};
pub use lock::{Locked, lock};
pub use order::Order;
pub use shots::{Shot, Shots, VIEWS};
pub use target::target;
pub use write::{Ended, Made, Outcome, Seconds, write};

use std::path::PathBuf;
use std::sync::Arc;

use crate::project::{FieldSettings, Project};
use crate::render::Switch;
use crate::volume::{self, FieldKind, Volume, VolumeError, Watch};

/// Opens what a project needs of a frame's files.
///
/// # Errors
/// Any [`VolumeError`].
pub fn open(
    project: &Project,
    paths: &[PathBuf],
    watch: &Watch,
) -> Result<Arc<Volume>, VolumeError> {
    let limits = project.volume.limits();
    volume::open_wanted(paths, &project.wanted(), &limits, watch).map(Arc::new)
}

/// The project of one frame of a range that is held, and what it does without, in words: a frame before the fire is lit may
/// lack grids that later ones have.
pub fn project_of(held: &Project, paths: Vec<PathBuf>, volume: &Volume) -> (Project, Vec<String>) {
    let mut project = held.clone();
    project.volume.path = paths;
    let mut without = Vec::new();
    for kind in FieldKind::ALL {
        let field = project.volume.field_mut(kind);
        let lacking = field
            .grid
            .as_deref()
            .filter(|name| !name.is_empty() && volume.grid_names().all(|other| other != *name));
        if let Some(name) = lacking {
            without.push(format!(
                "this frame has no grid {name}: it is without {}",
                kind.name()
            ));
            *field = FieldSettings {
                grid: Some(String::new()),
                ..FieldSettings::default()
            };
            if kind == FieldKind::Flame {
                // Where the flame says what burns in the others, nothing burns here; heat alone is not to say so.
                project.effects.chemiluminescence = Switch::Off;
            }
        }
    }
    (project, without)
}
