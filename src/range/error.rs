//! Why a range, or one of its frames, could not become pictures.

use thiserror::Error;

use crate::export::ExportError;
use crate::project::ProjectError;
use crate::volume::VolumeError;

/// Why one frame could not become a picture; the others can.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// Its files cannot be read.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// It cannot be rendered as it is set.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// Its picture may not be written there.
    #[error(transparent)]
    Export(#[from] ExportError),
}

/// Why a range ended before its last frame.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RangeError {
    /// Nothing can be measured: no frame can be read. What is wrong with the first stands for all.
    #[error("no frame of the range can be rendered; the first, {number}")]
    NoFrame {
        /// Its number.
        number: u64,
        /// What is wrong with it.
        source: FrameError,
    },
    /// A picture was made and could not be written: the next could not be, either.
    #[error("frame {number} was not written, and no frame after it is tried")]
    Write {
        /// Its number.
        number: u64,
        /// Why not.
        source: ExportError,
    },
    /// Nobody wants it any more.
    #[error("the range was cancelled; pictures that are written stay")]
    Cancelled,
}
