//! A picture of our own, read back: whether it is whole, and the scene file that it carries.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use exr::meta::attribute::AttributeValue;
use exr::prelude::{ReadChannels as _, ReadLayers as _};

use super::exr::SCENE_ATTRIBUTE;
use super::png::SCENE_KEYWORD;
use super::{Format, png::Bits};

/// The text of the scene file in a picture of this format, if every pixel of it can be read. `None` for what is not there,
/// not whole, another format, or no picture of this program.
pub fn scene_of(path: &Path, format: Format) -> Option<String> {
    match format {
        Format::Png(bits) => of_png(path, bits),
        Format::Exr => of_exr(path),
    }
}

fn of_png(path: &Path, bits: Bits) -> Option<String> {
    let file = BufReader::new(File::open(path).ok()?);
    let mut reader = ::png::Decoder::new(file).read_info().ok()?;
    let depth = match bits {
        Bits::Eight => ::png::BitDepth::Eight,
        Bits::Sixteen => ::png::BitDepth::Sixteen,
    };
    if reader.info().bit_depth != depth {
        return None;
    }
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    // The last chunk says that nothing is cut off.
    reader.finish().ok()?;
    let mut texts = reader.info().utf8_text.iter();
    texts
        .find(|chunk| chunk.keyword == SCENE_KEYWORD)?
        .get_text()
        .ok()
}

fn of_exr(path: &Path) -> Option<String> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .ok()?;
    let mut attributes = image.layer_data.attributes.other.iter();
    let (_, scene) = attributes.find(|(name, _)| name.as_slice() == SCENE_ATTRIBUTE.as_bytes())?;
    match scene {
        AttributeValue::Text(text) => String::from_utf8(text.as_slice().to_vec()).ok(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::fs;

    use super::super::{Provenance, test_film};
    use super::*;
    use crate::colour::display::BakedView;
    use crate::project::Project;
    use crate::render::develop::Metering;
    use crate::render::{Cancel, Flaws};

    fn encoded(format: Format) -> (Vec<u8>, String) {
        let (film, never) = (test_film(), Cancel::never());
        let project = Project::default();
        let provenance = Provenance::new(&project, &Flaws::default());
        let encoded = match format {
            Format::Png(bits) => {
                let view = BakedView::new(&Metering::of(&film).view(&project.view()));
                super::super::png::encode(&film, &view, bits, &provenance, &never)
            }
            Format::Exr => super::super::exr::encode(&film, &provenance, &never),
        };
        (encoded.unwrap().bytes, provenance.scene)
    }

    #[test]
    fn the_scene_of_a_whole_picture_is_read_back_and_of_a_spoilt_one_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for format in Format::ALL {
            let (bytes, scene) = encoded(format);
            fs::write(&path, &bytes).unwrap();
            assert_eq!(scene_of(&path, format), Some(scene), "{format:?}");
            for other in Format::ALL.into_iter().filter(|&other| other != format) {
                assert_eq!(scene_of(&path, other), None, "{format:?} as {other:?}");
            }
            for cut in [1, 8, bytes.len() / 4, bytes.len()] {
                fs::write(&path, &bytes[..bytes.len() - cut]).unwrap();
                assert_eq!(scene_of(&path, format), None, "{format:?} less {cut}");
            }
        }
        assert_eq!(scene_of(&folder.path().join("none"), Format::Exr), None);
    }
}
