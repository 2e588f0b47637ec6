//! Pictures for a backdrop: PNG files, read into linear light and kept as long as the file is the same.
//!
//! ```text
//! c = C/12.92 where C ≤ 0.04045, else ((C + 0.055)/1.055)^2.4
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | C | a channel as the file has it, 0 to 1 | 1 |
//! | c | the same, linear in light | 1 |
//!
//! **Validity.** Every picture is taken to be sRGB, whatever profile it names. What is transparent lies before black.
//!
//! **Source.** IEC 61966-2-1 (1999), by [`xyz::srgb_decode`].

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageError, Limits};
use thiserror::Error;

use crate::colour::xyz;
use crate::render::{MAX_PIXELS, MAX_SIDE};
use crate::scene::stage::BackdropPicture;

/// Most bytes of a decoded pixel: four channels of 16 bits.
const PIXEL_BYTES: u64 = 8;
/// Bytes of a PNG up to the end of its size: signature (8), length and name of the first chunk (8), width, height (8).
const HEADER_BYTES: usize = 24;

/// Why a picture cannot be a backdrop.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The system refused to read it.
    #[error("{path} cannot be read: expected a PNG file, found: {words}", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        words: String,
    },
    /// It is something else, or damaged.
    #[error("{path} cannot be shown: expected a PNG picture, found {found}", path = path.display())]
    NotAPicture {
        /// The file.
        path: PathBuf,
        /// What it is instead.
        found: String,
    },
    /// It has too many pixels.
    #[error(
        "{path} is too large: expected at most {MAX_SIDE} pixels a side and {MAX_PIXELS} in all, found {width} × {height}",
        path = path.display(), width = size[0], height = size[1]
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its width and height in pixels.
        size: [u32; 2],
    },
}

/// The picture that was read last, so that a slider that moves does not read it again.
#[derive(Debug, Clone, Default)]
pub struct Backdrops {
    last: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    path: PathBuf,
    stamp: Stamp,
    picture: Arc<BackdropPicture>,
}

/// What tells one state of a file from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stamp {
    modified: Option<SystemTime>,
    bytes: u64,
}

impl Backdrops {
    /// The picture of a file: as it was read before, if the file has not changed since.
    ///
    /// # Errors
    /// [`PictureError`] names the file, what was expected and what was found.
    pub fn read(&mut self, path: &Path) -> Result<Arc<BackdropPicture>, PictureError> {
        let unreadable = |words: String| PictureError::Unreadable {
            path: path.to_owned(),
            words,
        };
        let about = fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
        // A pipe would be waited for, and a folder has no bytes.
        if !about.is_file() {
            return Err(unreadable("no ordinary file".to_owned()));
        }
        let stamp = Stamp {
            modified: about.modified().ok(),
            bytes: about.len(),
        };
        if let Some(kept) = &self.last
            && kept.path == path
            && kept.stamp == stamp
        {
            return Ok(Arc::clone(&kept.picture));
        }
        let picture = Arc::new(read(path)?);
        self.last = Some(Kept {
            path: path.to_owned(),
            stamp,
            picture: Arc::clone(&picture),
        });
        Ok(picture)
    }
}

fn read(path: &Path) -> Result<BackdropPicture, PictureError> {
    let path_ = || path.to_owned();
    let unreadable = |error: io::Error| PictureError::Unreadable {
        path: path_(),
        words: error.to_string(),
    };
    let wrong = |found: String| PictureError::NotAPicture {
        path: path_(),
        found,
    };
    let mut file = File::open(path).map_err(unreadable)?;
    let mut header = Vec::new();
    (&mut file)
        .take(HEADER_BYTES as u64)
        .read_to_end(&mut header)
        .map_err(unreadable)?;
    match image::guess_format(&header) {
        Ok(image::ImageFormat::Png) if header.len() == HEADER_BYTES => {}
        Ok(image::ImageFormat::Png) => return Err(wrong("only the beginning of one".to_owned())),
        Ok(other) => return Err(wrong(format!("{other:?}").to_uppercase())),
        Err(_) => return Err(wrong("no picture".to_owned())),
    }
    // The size is judged before anything is made that is as large.
    let number = |at: usize| {
        let bytes = header[at..at + 4].iter();
        bytes.fold(0_u32, |number, &byte| number << 8 | u32::from(byte))
    };
    let size = [number(16), number(20)];
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if size.iter().any(|side| *side > MAX_SIDE) || pixels > MAX_PIXELS {
        return Err(PictureError::TooLarge {
            path: path_(),
            size,
        });
    }
    file.rewind().map_err(unreadable)?;
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_PIXELS * PIXEL_BYTES);
    let damaged = |error: ImageError| wrong(format!("a damaged one ({error})"));
    let decoder = PngDecoder::with_limits(BufReader::new(file), limits).map_err(damaged)?;
    let image = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    Ok(linear(image))
}

/// Linear pixels of an sRGB image before black.
fn linear(image: DynamicImage) -> BackdropPicture {
    let size = [image.width(), image.height()];
    let wide = image.color().bytes_per_pixel() > image.color().channel_count();
    // Every code is decoded once: there are fewer of them than pixels.
    let table = |most: u16| -> Vec<f32> {
        let code = |code: u16| xyz::srgb_decode(f32::from(code) / f32::from(most));
        (0..=most).map(code).collect()
    };
    let pixels = if wide {
        let table = table(u16::MAX);
        let pixel = |&[r, g, b, a]: &[u16; 4]| {
            let alpha = f32::from(a) / f32::from(u16::MAX);
            [r, g, b].map(|code| alpha * table[usize::from(code)])
        };
        let image = image.into_rgba16();
        image.pixels().map(|it| pixel(&it.0)).collect()
    } else {
        let table = table(u16::from(u8::MAX));
        let pixel = |&[r, g, b, a]: &[u8; 4]| {
            let alpha = f32::from(a) / f32::from(u8::MAX);
            [r, g, b].map(|code| alpha * table[usize::from(code)])
        };
        let image = image.into_rgba8();
        image.pixels().map(|it| pixel(&it.0)).collect()
    };
    BackdropPicture { size, pixels }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use image::{ImageBuffer, Luma, Rgb, Rgba};

    use super::*;

    fn said(path: &Path) -> String {
        Backdrops::default().read(path).unwrap_err().to_string()
    }

    #[test]
    fn codes_become_linear_light_at_either_depth() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        // sRGB 188 is 0.502886 of white, 10 is 10/255/12.92 = 0.003035: by hand from the formula.
        let eight = ImageBuffer::from_fn(2, 1, |x, _| {
            Rgb(if x == 0 { [255_u8, 188, 10] } else { [0; 3] })
        });
        eight.save(path("8.png")).unwrap();
        let picture = Backdrops::default().read(&path("8.png")).unwrap();
        assert_eq!(picture.size, [2, 1]);
        for (channel, expected) in picture.pixels[0]
            .into_iter()
            .zip([1.0, 0.502_886, 0.003_035])
        {
            assert!(
                (channel - expected).abs() < 1e-5,
                "{channel}, not {expected}"
            );
        }
        assert_eq!(picture.pixels[1], [0.0; 3]);
        // 48316 = 188 · 257: the same light in 16 bits; half of it behind half an alpha.
        let sixteen = ImageBuffer::from_pixel(1, 1, Rgba([48_316_u16, 0, 65_535, 32_768]));
        sixteen.save(path("16.png")).unwrap();
        let [red, _, blue] = Backdrops::default().read(&path("16.png")).unwrap().pixels[0];
        assert!((red - 0.5 * 0.502_886).abs() < 1e-5 && (blue - 0.5).abs() < 1e-4);
        let grey = ImageBuffer::from_pixel(1, 1, Luma([188_u8]));
        grey.save(path("grey.png")).unwrap();
        let [r, g, b] = Backdrops::default().read(&path("grey.png")).unwrap().pixels[0];
        assert!((r - 0.502_886).abs() < 1e-5 && r == g && g == b);
    }

    #[test]
    fn a_picture_is_read_again_only_when_its_file_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        ImageBuffer::from_pixel(1, 1, Luma([9_u8]))
            .save(&path)
            .unwrap();
        let mut kept = Backdrops::default();
        let first = kept.read(&path).unwrap();
        assert!(Arc::ptr_eq(&first, &kept.read(&path).unwrap()));
        ImageBuffer::from_pixel(40, 30, Luma([9_u8]))
            .save(&path)
            .unwrap();
        assert_eq!(kept.read(&path).unwrap().size, [40, 30]);
    }

    #[test]
    fn what_is_no_picture_is_named_with_what_was_found() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            fs::write(&path, bytes).unwrap();
            path
        };
        let missing = folder.path().join("none.png");
        assert!(said(&missing).contains("none.png"));
        assert!(said(folder.path()).contains("no ordinary file"));
        assert!(said(&file("a.png", b"")).contains("found no picture"));
        assert!(said(&file("a.png", b"\xff\xd8\xff\xe0 and more")).contains("found JPEG"));
        let whole = folder.path().join("whole.png");
        let noise = ImageBuffer::from_fn(64, 64, |x, y| Luma([(x * x + 7 * y) as u8]));
        noise.save(&whole).unwrap();
        let bytes = fs::read(&whole).unwrap();
        assert!(said(&file("a.png", &bytes[..12])).contains("only the beginning"));
        for end in (HEADER_BYTES..bytes.len() - 12).step_by(7) {
            let words = said(&file("a.png", &bytes[..end]));
            assert!(
                words.contains("a.png") && words.contains("damaged"),
                "{words}"
            );
        }
    }

    #[test]
    fn a_header_that_promises_too_much_is_refused_before_anything_is_made() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("vast.png");
        ImageBuffer::from_pixel(1, 1, Luma([9_u8]))
            .save(&path)
            .unwrap();
        let mut bytes = fs::read(&path).unwrap();
        for (size, fits) in [
            ([MAX_SIDE + 1, 1], false),
            ([1, u32::MAX], false),
            ([MAX_SIDE, MAX_SIDE], false),
            ([2, 1], true),
        ] {
            bytes[16..20].copy_from_slice(&size[0].to_be_bytes());
            bytes[20..24].copy_from_slice(&size[1].to_be_bytes());
            fs::write(&path, &bytes).unwrap();
            let error = Backdrops::default().read(&path).unwrap_err();
            let too_large =
                matches!(error, PictureError::TooLarge { size: found, .. } if found == size);
            assert_eq!(too_large, !fits, "{error}");
        }
    }
}
