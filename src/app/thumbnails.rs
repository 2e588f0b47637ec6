//! Small pictures: of snapshots, and of what was opened before.
//!
//! What was open is pictured as it looked last. The pictures lie in a folder of their own beside what else windows remember;
//! one that cannot be written or read is no picture, and nothing more.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::Cursor;
use std::path::{Path, PathBuf};

use egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use image::{ImageFormat, RgbImage};

use super::recent::Recent;
use crate::colour::display::{BakedView, View};
use crate::project::file::write_whole;
use crate::render::Film;

/// Longer side of a thumbnail, pixels.
const LONGER_SIDE: u32 = 160;

/// Pictures of what was opened before.
pub(super) struct Thumbnails {
    ctx: Context,
    /// Where they lie; `None` where nothing is remembered between windows.
    folder: Option<PathBuf>,
    known: HashMap<PathBuf, Known>,
}

struct Known {
    texture: TextureHandle,
    /// What is not on the disk yet.
    fresh: Option<ColorImage>,
}

impl Thumbnails {
    /// The pictures that earlier windows have kept of these.
    pub(super) fn load(ctx: &Context, folder: Option<PathBuf>, recent: &Recent) -> Self {
        let mut thumbnails = Self {
            ctx: ctx.clone(),
            folder,
            known: HashMap::new(),
        };
        for files in recent.iter() {
            let name = name_of(files);
            let path = thumbnails.folder.as_ref().map(|folder| folder.join(&name));
            if let Some(image) = path.and_then(|path| read(&path)) {
                thumbnails.set(name, image, false);
            }
        }
        thumbnails
    }

    /// The picture of what was opened as these files.
    pub(super) fn of(&self, files: &[PathBuf]) -> Option<&TextureHandle> {
        self.known.get(&name_of(files)).map(|known| &known.texture)
    }

    /// Keeps how these files, by their whole paths, look now.
    pub(super) fn keep(&mut self, files: &[PathBuf], film: &Film, view: &View) {
        self.set(name_of(files), thumbnail(film, view), true);
    }

    fn set(&mut self, name: PathBuf, image: ColorImage, is_fresh: bool) {
        let fresh = is_fresh.then(|| image.clone());
        let title = name.to_string_lossy();
        let texture = self.ctx.load_texture(title, image, TextureOptions::LINEAR);
        self.known.insert(name, Known { texture, fresh });
    }

    /// Writes what is new, and lets go of what is no longer remembered.
    pub(super) fn save(&mut self, recent: &Recent) {
        let Some(folder) = &self.folder else { return };
        let remembered: Vec<PathBuf> = recent.iter().map(name_of).collect();
        for (name, known) in &mut self.known {
            if let Some(image) = known.fresh.take_if(|_| remembered.contains(name)) {
                // The next window does without.
                let _ = write(&folder.join(name), &image);
            }
        }
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = PathBuf::from(entry.file_name());
            if !remembered.contains(&name) && name.extension().is_some_and(|it| it == ENDING) {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

const ENDING: &str = "png";

/// The name of the picture of these files. Another Rust may hash them to another: then a picture is lost.
fn name_of(files: &[PathBuf]) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    files.hash(&mut hasher);
    PathBuf::from(format!("{:016x}.{ENDING}", hasher.finish()))
}

fn read(path: &Path) -> Option<ColorImage> {
    let picture = image::open(path).ok()?.to_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    let is_small = size.iter().all(|&side| side <= LONGER_SIDE as usize);
    is_small.then(|| ColorImage::from_rgb(size, &picture))
}

fn write(path: &Path, image: &ColorImage) -> std::io::Result<()> {
    let bytes = image.pixels.iter().flat_map(|it| [it.r(), it.g(), it.b()]);
    let [width, height] = image.size.map(|side| side as u32);
    let picture = RgbImage::from_raw(width, height, bytes.collect());
    let picture = picture.ok_or(std::io::ErrorKind::InvalidData)?;
    let mut encoded = Cursor::new(Vec::new());
    picture
        .write_to(&mut encoded, ImageFormat::Png)
        .map_err(std::io::Error::other)?;
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    write_whole(path, encoded.get_ref())
}

/// A small picture of a film, each pixel the mean light of its block.
pub(super) fn thumbnail(film: &Film, view: &View) -> ColorImage {
    let size = film.size();
    let every = size[0].max(size[1]).div_ceil(LONGER_SIDE).max(1);
    let small = size.map(|side| side.div_ceil(every));
    let view = BakedView::new(view);
    let places = (0..small[1]).flat_map(|y| (0..small[0]).map(move |x| [x * every, y * every]));
    let pixels = places.map(|[left, top]| {
        let (mut sum, mut count) = ([0.0_f32; 3], 0.0);
        for y in top..(top + every).min(size[1]) {
            for x in left..(left + every).min(size[0]) {
                let light = film.pixel(x, y).map_or([0.0; 3], |pixel| pixel.xyz);
                // What is no number is black, as in the picture.
                if light.iter().all(|value| value.is_finite()) {
                    sum = std::array::from_fn(|c| sum[c] + light[c]);
                }
                count += 1.0;
            }
        }
        let [r, g, b] = view.apply(sum.map(|value| value / f32::max(count, 1.0)));
        let byte = |value: f32| (255.0 * value).round() as u8;
        Color32::from_rgb(byte(r), byte(g), byte(b))
    });
    ColorImage::new(small.map(|side| side as usize), pixels.collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::app::Document;
    use crate::project::Project;
    use crate::render::{Pixel, Tile};

    /// A bright film of this width over height.
    fn film(size: [u32; 2]) -> Film {
        let mut film = Film::new(size);
        let bright = Pixel {
            xyz: [1e3; 3],
            ..Pixel::default()
        };
        film.merge(&Tile {
            stride: 1,
            sample: 0,
            origin: [0; 2],
            size,
            pixels: vec![bright; (size[0] * size[1]) as usize],
            taken: Vec::new(),
        });
        film
    }

    #[test]
    fn the_next_window_knows_how_it_looked_and_what_is_forgotten_leaves_no_picture() {
        let folder = tempfile::tempdir().unwrap();
        let view = Document::new(Project::default()).view();
        let [first, other] = ["/a.vdb", "/b.vdb"].map(|path| vec![PathBuf::from(path)]);
        let mut recent = Recent::default();
        recent.add(&first);
        recent.add(&other);
        let ctx = Context::default();
        let load = |recent: &Recent| Thumbnails::load(&ctx, Some(folder.path().to_owned()), recent);
        let mut here = load(&recent);
        assert!(here.of(&first).is_none());
        here.keep(&first, &film([400, 200]), &view);
        here.keep(&other, &film([20, 30]), &view);
        // On show at once, and on the disk once it is saved.
        assert!(here.of(&first).is_some() && load(&recent).of(&first).is_none());
        here.save(&recent);
        let next = load(&recent);
        assert_eq!(next.of(&first).map(TextureHandle::size), Some([134, 67]));
        assert_eq!(next.of(&other).map(TextureHandle::size), Some([20, 30]));

        let mut recent = Recent::default();
        recent.add(&other);
        std::fs::write(folder.path().join("mine.txt"), "not a picture").unwrap();
        load(&recent).save(&recent);
        let left = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(left, 2, "one picture, and what is none of ours");
    }

    #[test]
    fn a_window_that_remembers_nothing_and_a_bad_picture_are_no_trouble() {
        let files = vec![PathBuf::from("/a.vdb")];
        let mut recent = Recent::default();
        recent.add(&files);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(name_of(&files)), "no picture").unwrap();
        let ctx = Context::default();
        let bad = Thumbnails::load(&ctx, Some(folder.path().to_owned()), &recent);
        assert!(bad.of(&files).is_none());
        Thumbnails::load(&ctx, None, &recent).save(&recent);
    }
}
