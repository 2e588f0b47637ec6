//! OpenEXR: the light itself, in 32-bit floats, for compositing and measuring.
//!
//! | channels | what | unit |
//! |---|---|---|
//! | `R G B A` | linear Rec. 709 with D65, premultiplied; A = 1 − transmittance, weighted as Y under D65 | cd m⁻² |
//! | `xyz.X xyz.Y xyz.Z` | Σ L x̄ Δλ with the CIE 1931 2° observer | W m⁻² sr⁻¹ |
//! | `T.R T.G T.B` | transmittance in linear Rec. 709; 1 where nothing is in the way | 1 |
//!
//! A picture laid over a plate B is RGB + (1 − A) B, or better RGB + T B. What glows without absorbing has A = 0,
//! and colours outside the triangle of Rec. 709, as fire has below 1900 K, keep a negative channel.
//!
//! All channels stand in a single part with dotted names, which Blender, Nuke and OpenImageIO show as layers and
//! which a reader without layers takes for a plain RGBA picture.

use std::io::{self, Cursor, Seek, SeekFrom, Write};

use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::meta::attribute::{AttributeValue, Chromaticities, LineOrder, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::{Compression, Vec2, WritableImage};
use glam::DVec3;

use super::{Encoded, ExportError, Provenance, is_finite};
use crate::colour::cie::MAX_LUMINOUS_EFFICACY;
use crate::colour::xyz::{PRIMARIES_XY, WHITE_XY, rgb_from_xyz};
use crate::render::{Cancel, Film, Pixel};

/// Name of the attribute that holds the scene file.
pub const SCENE_ATTRIBUTE: &str = "sootlight.scene";

/// The channels in the order of [`values`].
const CHANNELS: [&str; 10] = [
    "R", "G", "B", "A", "xyz.X", "xyz.Y", "xyz.Z", "T.R", "T.G", "T.B",
];

/// Encodes a film. Pixels that are not finite become black and clear, and are counted.
///
/// # Errors
/// The encoder refuses: a picture without pixels. [`ExportError::Cancelled`].
pub fn encode(
    film: &Film,
    provenance: &Provenance,
    cancel: &Cancel,
) -> Result<Encoded, ExportError> {
    let rgb_from_xyz = rgb_from_xyz();
    let mut channels: [Vec<f32>; CHANNELS.len()] = Default::default();
    let mut spoilt_pixels = 0;
    for pixel in film.pixels() {
        let spoilt = !is_finite(pixel);
        spoilt_pixels += u64::from(spoilt);
        let pixel = if spoilt { Pixel::default() } else { *pixel };
        for (channel, value) in channels.iter_mut().zip(values(&pixel, &rgb_from_xyz)) {
            channel.push(value);
        }
    }
    let channels = CHANNELS
        .into_iter()
        .zip(channels)
        .map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values)))
        .collect();

    let size = Vec2(film.size()[0] as usize, film.size()[1] as usize);
    let mut attributes = LayerAttributes {
        software_name: Some(text(&provenance.software)),
        comments: Some(text(&provenance.comment)),
        // RGB (1, 1, 1) is one candela for each square metre.
        white_luminance: Some(1.0),
        ..LayerAttributes::default()
    };
    // The one attribute of our own: several would be written in the order of a hash map, which no two runs share.
    attributes.other.insert(
        text(SCENE_ATTRIBUTE),
        AttributeValue::Text(text(&provenance.scene)),
    );
    // Blocks in a fixed order: the same film gives the same bytes, whichever block is compressed first.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        line_order: LineOrder::Increasing,
        ..Encoding::default()
    };
    let mut image = Image::from_layer(Layer::new(
        size,
        attributes,
        encoding,
        AnyChannels::sort(channels),
    ));
    image.attributes.chromaticities = Some(rec_709());

    let mut sink = Sink {
        bytes: Cursor::new(Vec::new()),
        cancel,
    };
    let write = image.write();
    // The encoder starts a pool of its own with a thread for each core. Where the caller's pool has fewer, that
    // would be more than were given: the caller's thread compresses alone, to the same bytes.
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let written = if rayon::current_num_threads() < cores {
        write.non_parallel().to_buffered(&mut sink)
    } else {
        write.to_buffered(&mut sink)
    };
    match written {
        Err(_) if cancel.is_cancelled() => Err(ExportError::Cancelled),
        Err(error) => Err(error.into()),
        Ok(()) => Ok(Encoded {
            bytes: sink.bytes.into_inner(),
            spoilt_pixels,
        }),
    }
}

/// Takes the file's bytes until it is cancelled: the encoder stops at a writer that fails, block by block.
struct Sink<'a> {
    bytes: Cursor<Vec<u8>>,
    cancel: &'a Cancel,
}

impl Write for Sink<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.cancel.is_cancelled() {
            return Err(io::Error::other("cancelled"));
        }
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Sink<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// The numbers of a pixel, one for each of [`CHANNELS`].
fn values(pixel: &Pixel, rgb_from_xyz: &glam::DMat3) -> [f32; CHANNELS.len()] {
    let xyz = DVec3::from(pixel.xyz.map(f64::from));
    let opacity = DVec3::from(pixel.opacity.map(f64::from));
    let [r, g, b] = (MAX_LUMINOUS_EFFICACY * (*rgb_from_xyz * xyz))
        .as_vec3()
        .to_array();
    let [tr, tg, tb] = (DVec3::ONE - *rgb_from_xyz * opacity).as_vec3().to_array();
    let [x, y, z] = pixel.xyz;
    [r, g, b, pixel.opacity[1], x, y, z, tr, tg, tb]
}

fn rec_709() -> Chromaticities {
    let xy = |[x, y]: [f64; 2]| Vec2(x as f32, y as f32);
    let [red, green, blue] = PRIMARIES_XY.map(xy);
    Chromaticities {
        red,
        green,
        blue,
        white: xy(WHITE_XY),
    }
}

/// Text as UTF-8 bytes, which is what readers of today take them for.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use exr::prelude::*;

    use super::super::test_film;
    use super::*;
    use crate::project::Project;
    use crate::render::Flaws;

    fn encoded() -> (Encoded, Provenance) {
        let mut flaws = Flaws::default();
        flaws.add("σ was guessed");
        let provenance = Provenance::new(&Project::default(), &flaws);
        (
            encode(&test_film(), &provenance, &Cancel::never()).unwrap(),
            provenance,
        )
    }

    #[test]
    fn every_channel_reads_back_in_its_units() {
        let (file, provenance) = encoded();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(&file.bytes))
            .unwrap();
        let layer = &image.layer_data;
        let value = |name: &str, i: usize| {
            let channel = layer
                .channel_data
                .list
                .iter()
                .find(|channel| channel.name.eq(name))
                .unwrap();
            let FlatSamples::F32(values) = &channel.sample_data else {
                unreachable!("all are f32")
            };
            f64::from(values[i])
        };
        assert_eq!(
            (layer.size, layer.channel_data.list.len()),
            (Vec2(3, 2), CHANNELS.len())
        );
        // Luminance from R, G, B with the weights of Rec. 709 is 683 Y; A is the opacity's Y.
        let luminance =
            |i| 0.2126 * value("R", i) + 0.7152 * value("G", i) + 0.0722 * value("B", i);
        assert!((luminance(1) / (683.0 * 0.5) - 1.0).abs() < 1e-4);
        assert_eq!((value("A", 1), value("A", 2)), (0.0, 1.0));
        assert_eq!(value("xyz.Y", 4), 0.25);
        for name in ["T.R", "T.G", "T.B"] {
            assert_eq!(value(name, 1), 1.0);
            assert!(value(name, 2).abs() < 1e-3, "{name}");
            assert!((value(name, 4) - 0.5).abs() < 1e-3, "{name}");
        }
        // The spoilt pixel is black and clear.
        assert_eq!(
            (value("R", 3), value("A", 3), value("T.G", 3)),
            (0.0, 0.0, 1.0)
        );
        assert_eq!(file.spoilt_pixels, 1);

        assert_eq!(image.attributes.chromaticities, Some(rec_709()));
        let comment = layer.attributes.comments.as_ref().unwrap();
        assert_eq!(comment.as_slice(), provenance.comment.as_bytes());
        let scene = layer.attributes.other.get(&text(SCENE_ATTRIBUTE)).unwrap();
        assert_eq!(scene, &AttributeValue::Text(text(&provenance.scene)));
    }

    #[test]
    fn the_same_film_gives_the_same_bytes() {
        assert_eq!(encoded().0.bytes, encoded().0.bytes);
    }
}
