//! `render --frames`: a range of a sequence, its names, its gaps and bad frames, and what is held over it.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::place::{Place, read_png};

mod held;

/// What makes renders of these small fires quick, and keeps light of one part of a picture from the other.
const QUICK: &str = "--size 48x32 --set render.step_voxels=1 --set render.wavelengths=4 \
                     --set render.samples_per_pixel=1 --set effects.scattering=off --set effects.refraction=off";

/// Writes a frame as two files of one field each: a cube on the left that never changes, of solver heat 1, and one on the
/// right of this heat.
fn write_frame(place: &Place, number: &str, heat: f64) {
    let [width, height, depth] = [20, 6, 8];
    let mut files = [
        (format!("density_{number}.txt"), String::new()),
        (format!("temperature_{number}.txt"), String::new()),
    ];
    for (_, text) in &mut files {
        writeln!(text, "{width} {height} {depth}").unwrap();
    }
    for i in 0..width * height * depth {
        let (x, y, z) = (i % width, i / width % height, i / (width * height));
        let inside = (1..5).contains(&y) && (1..7).contains(&z);
        let [density, heat] = match x {
            2..7 if inside => [0.3, 1.0],
            13..18 if inside => [0.3, heat],
            _ => [0.0, 0.0],
        };
        writeln!(files[0].1, "{density}").unwrap();
        writeln!(files[1].1, "{heat}").unwrap();
    }
    for (name, text) in files {
        fs::write(place.path(&name), text).unwrap();
    }
}

/// A place with frames 8, 9, 10 and 12, the hottest of them last.
fn place() -> Place {
    let place = Place::new();
    for (number, heat) in [("08", 0.6), ("09", 0.9), ("10", 1.1), ("12", 1.2)] {
        write_frame(&place, number, heat);
    }
    place
}

const RANGE: &str = "render density_08.txt temperature_08.txt";

fn stats(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.text(name)).unwrap()
}

#[test]
fn frames_are_named_by_their_numbers_and_gaps_and_bad_frames_are_told() {
    let place = place();
    let [said, errors] = place.expect(0, &format!("{RANGE} -o fire.png --frames 8-13 {QUICK}"));
    for name in ["fire_08.png", "fire_09.png", "fire_10.png", "fire_12.png"] {
        assert!(
            said.contains(&format!("{name}: 48 × 32 pixels in ")),
            "{said}"
        );
        assert!(place.path(name).exists());
    }
    assert!(!place.path("fire_11.png").exists());
    assert!(
        said.contains("frame 11: skipped, there is no such file"),
        "{said}"
    );
    assert!(said.contains("frame 13: skipped"), "{said}");
    assert!(
        said.ends_with("4 frames: 4 rendered, 0 kept, 0 failed\n"),
        "{said}"
    );
    assert_eq!(errors, "", "a pipe gets no progress bar");

    // A bad frame ends nothing, wherever it stands, and is told in the exit code.
    fs::write(place.path("temperature_08.txt"), "20 6 8\n1 2 three\n").unwrap();
    fs::remove_file(place.path("temperature_10.txt")).unwrap();
    let words = format!("{RANGE} -o a_###.png --frames 8-12:2 --stats s.json {QUICK}");
    let [said, errors] = place.expect(1, &words);
    assert!(place.path("a_012.png").exists() && !place.path("a_010.png").exists());
    assert!(
        !place.path("a_009.png").exists(),
        "every second was asked for"
    );
    assert!(errors.contains("frame 08: skipped, "), "{errors}");
    assert!(
        errors.contains("temperature_08.txt: the header 20 6 8 announces"),
        "{errors}"
    );
    assert!(
        errors.contains("frame 10: skipped, temperature_10.txt: cannot be read"),
        "{errors}"
    );
    assert!(
        errors.contains("2 of 3 frames could not be rendered"),
        "{errors}"
    );
    assert!(
        said.ends_with("3 frames: 1 rendered, 0 kept, 2 failed\n"),
        "{said}"
    );
    let stats = stats(&place, "s.json");
    let states: Vec<&Value> = (0..3).map(|i| &stats["frames"][i]["state"]).collect();
    assert_eq!(states, ["failed", "failed", "rendered"]);
    assert!(
        stats["frames"][2]["seconds"]["render"].is_f64() && stats["frames"][2]["flaws"].is_array()
    );
    assert_eq!(stats["measured_on_frame"], 12);
}

#[test]
fn a_folder_is_the_only_sequence_in_it() {
    let place = Place::new();
    fs::create_dir(place.path("sim")).unwrap();
    for number in [1, 2] {
        let name = format!("sim/soot{number}.vdb");
        crate::common::write_vdb(
            &place.path(&name),
            &[("soot", 2e-6), ("temperature", 1700.0)],
        );
    }
    let [said, _] = place.expect(0, &format!("render sim -o sim/a.png --frames 1-2 {QUICK}"));
    assert!(
        said.contains("sim/a_1.png") && place.path("sim/a_2.png").exists(),
        "{said}"
    );
    // The pictures beside the volumes are no other sequence.
    place.expect(0, &format!("render sim -o sim/a.png --frames 2 {QUICK}"));
    let [_, error] = place.expect(1, &format!("render . -o a.png --frames 1-2 {QUICK}"));
    assert!(error.contains("no sequence is in this folder"), "{error}");
}

#[test]
fn a_frame_tells_how_to_make_it_again() {
    let place = place();
    for (format, keys) in [("png", "--bits 16"), ("exr", "")] {
        let words = format!("{RANGE} -o a.{format} --frames 8-12 {keys} {QUICK}");
        place.expect(0, &words);
        for number in ["08", "12"] {
            let picture = place.path(&format!("a_{number}.{format}"));
            let sootlight_format = match format {
                "png" => sootlight::export::Format::Png(sootlight::export::png::Bits::Sixteen),
                _ => sootlight::export::Format::Exr,
            };
            let scene = sootlight::export::scene_of(&picture, sootlight_format).unwrap();
            fs::write(place.path("again.toml"), &scene).unwrap();
            place.expect(
                0,
                &format!("render --scene again.toml -o again.{format} {keys}"),
            );
            let again = place.path(&format!("again.{format}"));
            assert!(
                pixels(&again) == pixels(&picture),
                "frame {number} as {format}"
            );
        }
    }
}

/// Every number of a picture.
fn pixels(path: &Path) -> Vec<u32> {
    if path.extension().is_some_and(|ending| ending == "png") {
        return read_png(path).0.into_iter().map(u32::from).collect();
    }
    let image = exr::prelude::read_first_flat_layer_from_file(path).unwrap();
    let channels = image.layer_data.channel_data.list.iter();
    let values = channels.flat_map(|channel| channel.sample_data.values_as_f32());
    values.map(f32::to_bits).collect()
}

#[test]
fn what_is_done_is_kept_by_its_content() {
    let place = place();
    let words = format!("{RANGE} -o a.png --frames 8-12 {QUICK}");
    let made = |words: &str| {
        let [said, _] = place.expect(0, words);
        let made: Vec<String> = said
            .lines()
            .filter(|line| line.contains(" pixels in "))
            .map(|line| line.split(':').next().unwrap().to_owned())
            .collect();
        made
    };
    let all = ["a_08.png", "a_09.png", "a_10.png", "a_12.png"];
    assert_eq!(made(&words), all);
    let before = all.map(|name| fs::read(place.path(name)).unwrap());
    assert_eq!(made(&words), [""; 0]);
    let [said, _] = place.expect(0, &words);
    assert!(
        said.contains("a_09.png: kept, made from the same files and settings"),
        "{said}"
    );

    // A picture that is lost, cut short, or that of another frame under this name.
    fs::remove_file(place.path("a_08.png")).unwrap();
    fs::write(place.path("a_09.png"), &before[1][..before[1].len() - 6]).unwrap();
    fs::write(place.path("a_10.png"), &before[3]).unwrap();
    assert_eq!(made(&words), all[..3]);
    for (name, before) in all.iter().zip(&before) {
        assert!(fs::read(place.path(name)).unwrap() == *before, "{name}");
    }

    // A file that is another one now; its neighbours stand.
    write_frame(&place, "10", 1.05);
    assert_eq!(made(&words), ["a_10.png"]);
    // The same file written again is the same file; so is one that lies elsewhere.
    write_frame(&place, "10", 1.05);
    assert_eq!(made(&words), [""; 0]);
    fs::create_dir(place.path("moved")).unwrap();
    for number in ["08", "09", "10", "12"] {
        for name in ["density", "temperature"].map(|name| format!("{name}_{number}.txt")) {
            fs::rename(place.path(&name), place.path(&format!("moved/{name}"))).unwrap();
        }
    }
    let words = words.replace("density_08", "moved/density_08");
    let words = words.replace("temperature_08", "moved/temperature_08");
    assert_eq!(made(&words), [""; 0]);
    // Other settings, another format: everything is made anew.
    assert_eq!(made(&format!("{words} --set soot.amount=0.9")), all);
    assert_eq!(
        made(&format!("{words} --set soot.amount=0.9 --bits 16")),
        all
    );
}

#[test]
fn what_makes_no_sense_is_said() {
    let place = place();
    for (words, code, wanted) in [
        ("-o a.png --frames 1-2", 2, "built-in flame has no frames"),
        (
            "density_08.txt -o a.png --frames 9-8",
            2,
            "comes before the first",
        ),
        (
            "density_08.txt -o a.png --frames x",
            2,
            "expected frames such as",
        ),
        (
            "density_08.txt -o a.png --frames 8-9 --time-limit 5",
            2,
            "cannot be used with",
        ),
        (
            "density_08.txt -o a.png --frames 1-7",
            1,
            "density_##.txt has frames from 08 to 12",
        ),
        (
            "density.txt -o a.png --frames 1-7",
            1,
            "its name has no number",
        ),
        (
            "density_08.txt -o a.png --frames 8-9 --stats a_09.png",
            2,
            "the picture of a frame is the same file",
        ),
        (
            "density_08.txt -o a.png --frames 8-9 --stats density_09.txt",
            1,
            "nothing was rendered",
        ),
        (
            "density_08.txt -o none/a.png --frames 8-9",
            1,
            "folder does not exist",
        ),
    ] {
        let [_, error] = place.expect(code, &format!("render {words} {QUICK}"));
        assert!(error.contains(wanted), "{words}: {error}");
    }
    let names = place.names();
    assert!(
        names.iter().all(|name| !name.starts_with("a_")),
        "{names:?}"
    );
}

/// Levels of a picture of 8 bits, in columns from the left.
fn columns(path: &Path) -> Vec<f64> {
    let (pixels, info, _) = read_png(path);
    let width = info.width as usize;
    let mean = |x: usize| {
        let rows = pixels.chunks_exact(3 * width);
        rows.map(|row| {
            row[3 * x..3 * x + 3]
                .iter()
                .map(|&it| f64::from(it))
                .sum::<f64>()
        })
        .sum::<f64>()
    };
    (0..width).map(mean).collect()
}

#[test]
fn a_turntable_sees_the_fire_from_all_around_and_keeps_what_is_there() {
    let place = place();
    // A hot cube on the right of a cooler one.
    let words =
        format!("render density_12.txt temperature_12.txt -o turn.png --turntable 4 {QUICK}");
    let [said, _] = place.expect(0, &format!("{words} --stats s.json"));
    assert!(
        said.ends_with("4 views: 4 rendered, 0 kept, 0 failed\n"),
        "{said}"
    );
    let [front, right, back, left] =
        [1, 2, 3, 4].map(|number| columns(&place.path(&format!("turn_000{number}.png"))));
    let off = |one: &[f64], other: &[f64]| {
        let all: f64 = one.iter().sum();
        let apart = one
            .iter()
            .zip(other)
            .map(|(one, other)| (one - other).abs());
        apart.sum::<f64>() / all
    };
    let mirrored: Vec<f64> = back.iter().rev().copied().collect();
    assert!(
        off(&front, &mirrored) < 0.01 && off(&front, &back) > 0.05,
        "{front:?} {back:?}"
    );
    // From the sides one cube hides the other, and the nearer one is larger.
    let lit = |columns: &[f64]| columns.iter().filter(|&&level| level > 0.0).count();
    assert!(lit(&right) < lit(&front) && lit(&left) < lit(&front));
    let stats = stats(&place, "s.json");
    assert_eq!(stats["range"], "turntable of 4 views");
    // Exposure and white are those of one view in all.
    let held = |i: usize| stats["frames"][i]["exposure"].clone();
    assert!(held(0).is_object() && (1..4).all(|i| held(i)["view"] == held(0)["view"]));

    fs::remove_file(place.path("turn_0002.png")).unwrap();
    let [said, _] = place.expect(0, &words);
    assert!(
        said.ends_with("4 views: 1 rendered, 3 kept, 0 failed\n"),
        "{said}"
    );
    // A built-in flame has no files, and is turned all the same.
    let [said, _] = place.expect(0, &format!("render -o own.png --turntable 2 {QUICK}"));
    assert!(
        said.ends_with("2 views: 2 rendered, 0 kept, 0 failed\n"),
        "{said}"
    );
    for wrong in [
        "--turntable 1",
        "--turntable 4 --frames 8-12",
        "--turntable 4 --time-limit 3",
    ] {
        place.expect(2, &format!("{RANGE} -o no.png {wrong}"));
    }
}
