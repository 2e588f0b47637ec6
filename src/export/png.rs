//! PNG: the picture as it looks, sRGB, 8 or 16 bits.
//!
//! The colour space is said in every way that readers know: cICP (1, 13, 0, 1: Rec. 709 primaries, sRGB curve, RGB,
//! full range), sRGB, and gAMA with cHRM for those that know neither. Values are rounded to the nearest, without
//! dithering: the same film gives the same bytes.

use std::io::Write as _;

use png::text_metadata::ITXtChunk;
use png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent, chunk};

use super::{Encoded, ExportError, Provenance, is_finite};
use crate::colour::display::BakedView;
use crate::colour::xyz::{PRIMARIES_XY, WHITE_XY};
use crate::render::develop::develop;
use crate::render::{Cancel, Film};

/// Keyword of the text that holds the scene file.
pub const SCENE_KEYWORD: &str = "sootlight.scene";

/// Rec. 709 primaries, sRGB transfer, RGB, full range (ITU-T H.273).
const CICP: [u8; 4] = [1, 13, 0, 1];

/// Bits of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bits {
    /// 256 levels.
    #[default]
    Eight,
    /// 65536 levels.
    Sixteen,
}

/// Rows that are encoded between two looks at whether to stop.
const BAND: usize = 32;

/// Develops a film and encodes it. Pixels that are not finite become black and are counted.
///
/// # Errors
/// The encoder refuses: a picture without pixels. [`ExportError::Cancelled`].
pub fn encode(
    film: &Film,
    view: &BakedView,
    bits: Bits,
    provenance: &Provenance,
    cancel: &Cancel,
) -> Result<Encoded, ExportError> {
    let mut display = develop(film, view);
    let mut spoilt_pixels = 0;
    for (colour, pixel) in display.iter_mut().zip(film.pixels()) {
        if !is_finite(pixel) {
            *colour = [0.0; 3];
            spoilt_pixels += 1;
        }
    }
    let mut bytes = Vec::new();
    let [width, height] = film.size();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(match bits {
        Bits::Eight => BitDepth::Eight,
        Bits::Sixteen => BitDepth::Sixteen,
    });
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let [red, green, blue] = PRIMARIES_XY.map(scaled);
    // Written beside sRGB only if they are exactly what sRGB stands for; these are.
    encoder.set_source_gamma(png::ScaledFloat::from_scaled(45455));
    encoder.set_source_chromaticities(png::SourceChromaticities {
        white: scaled(WHITE_XY),
        red,
        green,
        blue,
    });
    let mut writer = encoder.write_header()?;
    writer.write_chunk(chunk::cICP, &CICP)?;
    for (keyword, text) in [
        ("Software", &provenance.software),
        ("Comment", &provenance.comment),
        (SCENE_KEYWORD, &provenance.scene),
    ] {
        writer.write_text_chunk(&ITXtChunk::new(keyword, text.as_str()))?;
    }
    let mut stream = writer.stream_writer()?;
    for rows in display.chunks(BAND * width as usize) {
        if cancel.is_cancelled() {
            return Err(ExportError::Cancelled);
        }
        let levels = quantised(rows, bits);
        stream
            .write_all(&levels)
            .map_err(png::EncodingError::from)?;
    }
    stream.finish()?;
    writer.finish()?;
    Ok(Encoded {
        bytes,
        spoilt_pixels,
    })
}

fn scaled([x, y]: [f64; 2]) -> (png::ScaledFloat, png::ScaledFloat) {
    (
        png::ScaledFloat::new(x as f32),
        png::ScaledFloat::new(y as f32),
    )
}

/// Display values, 0 to 1, as levels; 16 bits have the high byte first.
fn quantised(display: &[[f32; 3]], bits: Bits) -> Vec<u8> {
    let level = |value: &f32, top: f32| (value.clamp(0.0, 1.0) * top).round();
    let values = display.iter().flatten();
    match bits {
        Bits::Eight => values.map(|value| level(value, 255.0) as u8).collect(),
        Bits::Sixteen => values
            .flat_map(|value| (level(value, 65535.0) as u16).to_be_bytes())
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::io::Cursor;

    use super::super::test_film;
    use super::*;
    use crate::colour::display::{Curve, View};
    use crate::project::Project;
    use crate::render::Flaws;

    fn encoded(bits: Bits) -> (Encoded, Provenance) {
        let provenance = Provenance::new(&Project::default(), &Flaws::default());
        let view = View {
            exposure: 1.0,
            adaptation: 0.0,
            white_xyz: [0.0; 3],
            curve: Curve::Linear,
            half_saturation: 1.0,
            false_colour: false,
        };
        let encoded = encode(
            &test_film(),
            &BakedView::new(&view),
            bits,
            &provenance,
            &Cancel::never(),
        )
        .unwrap();
        (encoded, provenance)
    }

    #[test]
    fn levels_are_rounded_to_the_nearest_and_ordered_high_byte_first() {
        let display = [[0.0, 1.0, 0.5], [0.499 / 255.0, 0.501 / 255.0, 2.0]];
        assert_eq!(quantised(&display, Bits::Eight), [0, 255, 128, 0, 1, 255]);
        let sixteen = quantised(&[[0.0, 1.0, 258.0 / 65535.0]], Bits::Sixteen);
        assert_eq!(sixteen, [0, 0, 255, 255, 1, 2]);
    }

    #[test]
    fn a_picture_reads_back_with_its_colour_space_and_its_provenance() {
        for (bits, depth) in [
            (Bits::Eight, BitDepth::Eight),
            (Bits::Sixteen, BitDepth::Sixteen),
        ] {
            let (file, provenance) = encoded(bits);
            let mut reader = png::Decoder::new(Cursor::new(&file.bytes))
                .read_info()
                .unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            let info = reader.info();
            assert_eq!((info.width, info.height, info.bit_depth), (3, 2, depth));
            assert_eq!(info.srgb, Some(SrgbRenderingIntent::Perceptual));
            let text: Vec<(String, String)> = info
                .utf8_text
                .iter()
                .map(|chunk| (chunk.keyword.clone(), chunk.get_text().unwrap()))
                .collect();
            let expected = [
                ("Software", provenance.software),
                ("Comment", provenance.comment),
                (SCENE_KEYWORD, provenance.scene),
            ];
            assert_eq!(
                text,
                expected.map(|(keyword, text)| (keyword.to_owned(), text))
            );
            for chunk in [&b"cICP\x01\x0d\x00\x01"[..], b"sRGB\x00", b"gAMA", b"cHRM"] {
                assert!(
                    file.bytes
                        .windows(chunk.len())
                        .any(|window| window == chunk),
                    "{chunk:?}"
                );
            }
            // Half of display white in Y is 0.735 in sRGB; the spoilt pixel is black.
            if bits == Bits::Eight {
                assert!(pixels[3].abs_diff(188) <= 1, "{pixels:?}");
                assert_eq!(pixels[9..12], [0; 3]);
            }
            assert_eq!(file.spoilt_pixels, 1);
        }
    }

    #[test]
    fn the_same_film_gives_the_same_bytes() {
        assert_eq!(encoded(Bits::Eight).0.bytes, encoded(Bits::Eight).0.bytes);
    }
}
