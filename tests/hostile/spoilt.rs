//! One pixel gone wrong: counted, located, shown as a flaw; it spoils no neighbour, no exposure and no export.

use std::io::Cursor;
use std::path::Path;

use sootlight::colour::display::BakedView;
use sootlight::engine::{Engine, News, Picture, Update};
use sootlight::export::png::Bits;
use sootlight::export::{Format, Still};
use sootlight::project::Project;
use sootlight::render::develop::{Metering, develop, flaws_of};
use sootlight::render::{Cancel, Film, Frame, Pixel, Tile};

use crate::common;

const SIZE: [u32; 2] = [32, 40];
/// Where the fault is planted: in the middle of the flame.
const AT: [u32; 2] = [16, 25];
const NO_NUMBER: Pixel = Pixel {
    xyz: [f32::NAN, 1.0, f32::INFINITY],
    opacity: [0.5; 3],
};

fn index() -> usize {
    (AT[1] * SIZE[0] + AT[0]) as usize
}

fn tile(pixel: Pixel, sample: u32) -> Tile {
    Tile {
        stride: 1,
        sample,
        origin: AT,
        size: [1, 1],
        pixels: vec![pixel],
        taken: vec![1],
    }
}

fn still() -> Still {
    let mut project = Project::default();
    project.render.size = SIZE;
    project.render.samples_per_pixel = Some(1);
    Still::new(&project, &common::torch(), None).unwrap()
}

fn frame(still: &Still) -> Frame {
    still
        .render(&still.scene(), &Cancel::never(), &|_| {})
        .unwrap()
}

fn words(film: &Film) -> String {
    flaws_of(film).iter().collect()
}

/// The fault at its first or a later sample.
fn spoilt(film: &Film, sample: u32) -> Film {
    let mut film = film.clone();
    film.merge(&tile(NO_NUMBER, sample));
    film
}

fn without_it(film: &Film) -> Film {
    let mut film = film.clone();
    film.merge(&tile(Pixel::default(), 0));
    film
}

#[test]
fn it_is_counted_and_located_and_changes_nothing_around() {
    let film = frame(&still()).film;
    assert_eq!(words(&film), "");
    for sample in [0, 3] {
        let bad = spoilt(&film, sample);
        let told = words(&bad);
        assert!(told.starts_with("1 pixels are no numbers"), "{told}");
        assert!(told.contains("column 16, row 25"), "{told}");
        let metering = Metering::of(&bad);
        assert_eq!(metering, Metering::of(&without_it(&film)));
        let view = BakedView::new(&metering.view(&Project::default().view()));
        let [shown, good] = [&bad, &film].map(|film| develop(film, &view));
        assert_eq!(shown[index()], [0.0; 3]);
        assert!(good[index()][0] > 0.1, "nothing is to be seen there anyway");
        for (i, (shown, good)) in shown.iter().zip(&good).enumerate() {
            assert!(
                i == index() || shown == good,
                "pixel {i}: {shown:?}, {good:?}"
            );
        }
    }
}

#[test]
fn the_film_of_a_window_keeps_it_in_its_place() {
    let engine = Engine::new(1, Box::new(|| {})).unwrap();
    let mut picture = Picture::new(SIZE);
    let generation = engine.submit(still().job);
    while !picture.progress.finished {
        engine.drain().into_iter().for_each(|it| picture.take(it));
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let good = picture.film().clone();
    let news = News::Tile(tile(NO_NUMBER, 1));
    picture.take(Update { generation, news });
    assert!(words(picture.film()).contains("column 16, row 25"));
    for (i, (shown, good)) in picture
        .film()
        .pixels()
        .iter()
        .zip(good.pixels())
        .enumerate()
    {
        assert!(i == index() || shown == good, "pixel {i}");
    }
    // The next picture knows nothing of it.
    engine.submit(still().job);
    picture.progress.finished = false;
    while !picture.progress.finished {
        engine.drain().into_iter().for_each(|it| picture.take(it));
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(*picture.film(), good);
}

#[test]
fn a_png_has_it_black_and_all_else_as_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let still = still();
    let good = frame(&still);
    let levels = |film: Film, path: &Path| {
        let frame = Frame {
            film,
            ..good.clone()
        };
        let format = Format::Png(Bits::Sixteen);
        let written = still.write(&frame, format, path, &Cancel::never()).unwrap();
        let bytes = std::fs::read(path).unwrap();
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let text = reader.info().utf8_text.iter();
        let text: String = text.map(|chunk| chunk.get_text().unwrap()).collect();
        (pixels, written.flaws, text)
    };
    let (bad, flaws, text) = levels(spoilt(&good.film, 0), &folder.path().join("bad.png"));
    let (clean, ..) = levels(without_it(&good.film), &folder.path().join("clean.png"));
    assert_eq!(bad, clean);
    assert_eq!(bad[6 * index()..6 * index() + 6], [0; 6]);
    assert!(flaws.iter().any(|flaw| flaw.contains("column 16, row 25")));
    assert!(text.contains("column 16, row 25"), "{text}");
}

#[test]
fn an_exr_has_it_black_and_clear_and_all_else_as_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let still = still();
    let good = frame(&still);
    let channels = |film: Film, path: &Path| {
        let frame = Frame {
            film,
            ..good.clone()
        };
        let written = still.write(&frame, Format::Exr, path, &Cancel::never());
        let image = exr::prelude::read_first_flat_layer_from_file(path).unwrap();
        let list = image.layer_data.channel_data.list.iter();
        let values = list.map(|it| it.sample_data.values_as_f32().collect::<Vec<f32>>());
        (values.collect::<Vec<_>>(), written.unwrap().flaws)
    };
    let (bad, flaws) = channels(spoilt(&good.film, 0), &folder.path().join("bad.exr"));
    let (clean, _) = channels(without_it(&good.film), &folder.path().join("clean.exr"));
    assert!(bad.iter().flatten().all(|value| value.is_finite()));
    assert_eq!(bad, clean);
    assert!(flaws.iter().any(|flaw| flaw.contains("column 16, row 25")));
}
