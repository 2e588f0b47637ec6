//! Pictures on disk. A film goes in with its provenance as text; bytes come out, and reach the disk whole or not
//! at all.

pub mod atomic;
pub mod exr;
pub mod format;
pub mod png;
pub mod provenance;
mod read_back;
pub mod still;

use std::path::PathBuf;

use thiserror::Error;

use crate::render::Pixel;

pub use atomic::{check_writable, is_same_file, write};
pub use format::Format;
pub use provenance::Provenance;
pub use read_back::scene_of;
pub use still::{Still, Written, check_target};

/// A picture as the bytes of a file.
#[derive(Debug, Clone)]
pub struct Encoded {
    /// The file's contents.
    pub bytes: Vec<u8>,
    /// Pixels that were not finite and were written as black and clear: more than none is a flaw.
    pub spoilt_pixels: u64,
}

/// Why a picture could not be exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The system refused to write.
    #[error("{path} cannot be written: {advice}", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What to do.
        advice: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// The picture would take the place of what it is made from.
    #[error("{path} is a file that the picture is made from: choose another name", path = path.display())]
    OwnVolume {
        /// The file.
        path: PathBuf,
    },
    /// Nobody wants it any more.
    #[error("the export was cancelled; nothing was written")]
    Cancelled,
    /// The PNG encoder refused.
    #[error("the picture cannot be encoded as PNG")]
    Png(#[from] ::png::EncodingError),
    /// The EXR encoder refused.
    #[error("the picture cannot be encoded as EXR")]
    Exr(#[from] ::exr::error::Error),
}

/// Whether every number of a pixel is one.
fn is_finite(pixel: &Pixel) -> bool {
    pixel
        .xyz
        .iter()
        .chain(&pixel.opacity)
        .all(|value| value.is_finite())
}

/// A film for the encoders' tests: 3 × 2, one pixel of it spoilt.
#[cfg(test)]
fn test_film() -> crate::render::Film {
    use crate::render::{Film, Tile};
    let pixel = |y: f32, opacity: f32| Pixel {
        xyz: [0.9505 * y, y, 1.089 * y],
        opacity: [0.9505 * opacity, opacity, 1.089 * opacity],
    };
    let spoilt = Pixel {
        xyz: [f32::NAN, 1.0, 1.0],
        opacity: [0.0; 3],
    };
    let pixels = vec![
        pixel(0.0, 0.0),
        pixel(0.5, 0.0),
        pixel(1.0, 1.0),
        spoilt,
        pixel(0.25, 0.5),
        pixel(1e6, 0.1),
    ];
    let mut film = Film::new([3, 2]);
    film.merge(&Tile {
        stride: 1,
        sample: 0,
        origin: [0, 0],
        size: [3, 2],
        pixels,
        taken: Vec::new(),
    });
    film
}
