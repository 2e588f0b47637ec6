//! What is held over a range, so that nothing flickers.

use std::path::Path;

use serde_json::Value;
use sootlight::project::Project;

use super::{Place, QUICK, RANGE, place, read_png, stats, write_frame};
use crate::common::{shared, write_vdb};

/// Mean level, 0 to 65535, of the left part of a picture of 16 bits, where nothing changes.
fn left(path: &Path) -> f64 {
    let (pixels, info, _) = read_png(path);
    let row = info.width as usize * 6;
    let rows = pixels.chunks_exact(row);
    let levels: Vec<f64> = rows
        .flat_map(|row| row[..row.len() * 2 / 5].chunks_exact(2))
        .map(|level| f64::from(u16::from_be_bytes([level[0], level[1]])))
        .collect();
    levels.iter().sum::<f64>() / levels.len() as f64
}

#[test]
fn what_does_not_change_does_not_flicker() {
    let place = place();
    write_frame(&place, "13", 0.6);
    // The march cuts its steps by what all of a frame's light needs: fine ones make no difference.
    let keys = format!("--bits 16 {QUICK} --set render.step_voxels=0.05");
    let words = format!("{RANGE} -o a.png --frames 8-13 --stats s.json {keys}");
    let [said, _] = place.expect(0, &words);
    let still = left(&place.path("a_08.png"));
    assert!(still > 1000.0, "nothing is seen: {still}");
    for name in ["a_09.png", "a_10.png", "a_12.png"] {
        let ratio = left(&place.path(name)) / still;
        assert!((ratio - 1.0).abs() < 1e-3, "{name} flickers: {ratio}");
    }
    let [first, last] = ["a_08.png", "a_13.png"].map(|name| read_png(&place.path(name)).0);
    assert!(first == last, "the same fire twice");
    // The hottest frame's peak is the hottest of all: what is cooler is so in each.
    let stats = stats(&place, "s.json");
    let temperature = &stats["frames"][0]["scene"]["volume"]["temperature"];
    let scale = temperature["scale"].as_f64().unwrap();
    assert!((scale / (1700.0 / 1.2) - 1.0).abs() < 1e-6, "{scale}");
    // What is said to be assumed of one file is said of all.
    assert!(
        said.contains("mapped to 300 K at 0 and 2000 K at the peak"),
        "{said}"
    );

    // Each by itself takes its own peak, and measures itself.
    let alone = |number: &str| {
        let name = format!("alone_{number}.png");
        let files = format!("density_{number}.txt temperature_{number}.txt");
        place.expect(0, &format!("render {files} -o {name} {keys}"));
        left(&place.path(&name))
    };
    let ratio = alone("08") / alone("12");
    assert!(
        (ratio - 1.0).abs() > 0.1,
        "this fire would not have flickered: {ratio}"
    );
}

#[test]
fn smoke_that_comes_late_is_in_all_frames_that_have_it() {
    let place = Place::new();
    // The hottest frame, the first, has no smoke yet; the last has no flame any more.
    for (number, grids) in [
        (1, &[("flame", 1.0), ("temperature", 2.0)][..]),
        (2, &[("flame", 1.0), ("temperature", 1.5), ("density", 0.3)]),
        (3, &[("temperature", 1.0), ("density", 0.3)]),
    ] {
        write_vdb(&place.path(&format!("a{number}.vdb")), grids);
    }
    let words = format!("render a1.vdb -o a.png --frames 1-3 --stats s.json {QUICK}");
    let [said, _] = place.expect(0, &words);
    let stats = stats(&place, "s.json");
    let smoke = |frame: usize| &stats["frames"][frame]["scene"]["volume"]["smoke"]["grid"];
    assert_eq!(
        (smoke(0), smoke(1)),
        (&Value::from(""), &Value::from("density"))
    );
    for words in [
        "grid density: it is without smoke",
        "grid flame: it is without soot",
    ] {
        assert!(
            said.contains(&format!("this frame has no {words}")),
            "{said}"
        );
    }
    // Without the flame nothing says what burns: no glow is made up from heat alone.
    assert!(!said.contains("no flame field"), "{said}");
}

#[test]
fn what_is_set_by_hand_stays() {
    let place = place();
    let set = "--set view.display_white_cd_m2=2000 --set view.white_k=2100 --set camera.eye=[0.1,-3,0.1] \
               --set camera.target=[0.1,0,0.05] --set volume.temperature.scale=700 --set effects.smoke=off \
               --set stage.ground=true --set fuel.name=acetylene";
    place.expect(0, &format!("{RANGE} -o a.png --frames 8-9 {set} {QUICK}"));
    let (_, _, text) = read_png(&place.path("a_09.png"));
    let project = Project::from_toml(&text("sootlight.scene"), Path::new("")).unwrap();
    assert_eq!(project.view.display_white_cd_m2, Some(2000.0));
    assert_eq!(
        (project.view.white_k, project.view.white_xy),
        (Some(2100.0), None)
    );
    assert_eq!(project.camera.eye.unwrap().y, -3.0);
    assert_eq!(project.volume.temperature.scale, Some(700.0));
    assert_eq!(
        project.volume.temperature.grid.as_deref(),
        Some("temperature")
    );
    assert_eq!(project.render.step_voxels, Some(1.0));
    assert!(project.stage.ground && project.stage.ground_height_m.is_some());
    assert_eq!(project.soot.amount, 1.0);
    // Acetylene has four times the soot of propane, 2e-6 at the peak of a density of 0.3.
    let soot = project.volume.soot.max.unwrap();
    assert!((soot / 8e-6 - 1.0).abs() < 1e-9, "{soot}");
}

/// Mean luminance of a picture that was developed linearly, in display white, and that of the light itself, cd m⁻².
fn means(place: &Place, frame: u32) -> [f64; 2] {
    let (levels, ..) = read_png(&place.path(&format!("a_{frame:04}.png")));
    let linear = |level: u16| {
        let display = f64::from(level) / 65535.0;
        if display <= 0.04045 {
            display / 12.92
        } else {
            ((display + 0.055) / 1.055).powf(2.4)
        }
    };
    let levels: Vec<f64> = levels
        .chunks_exact(2)
        .map(|bytes| linear(u16::from_be_bytes([bytes[0], bytes[1]])))
        .collect();
    let pixels = levels.chunks_exact(3);
    let shown = pixels.map(|rgb| 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
    let light =
        exr::prelude::read_first_flat_layer_from_file(place.path(&format!("a_{frame:04}.exr")));
    let light = light.unwrap().layer_data;
    let channel = light
        .channel_data
        .list
        .iter()
        .find(|channel| channel.name.eq("xyz.Y"));
    let y = channel.unwrap().sample_data.values_as_f32().map(f64::from);
    let count = f64::from(levels.len() as u32) / 3.0;
    [shown.sum::<f64>() / count, 683.0 * y.sum::<f64>() / count]
}

#[test]
fn a_pan_fire_is_metered_once_and_its_brightness_follows_its_light() {
    let Some(folder) = shared() else { return };
    let place = Place::new();
    let folder = folder.join("data/panfire_seq");
    // Linear and underexposed, so that nothing is clipped; the eye not adapted, so that luminance is kept. What takes long
    // is left out.
    let keys = "--frames 3-9 --size 120x90 --quality draft --set view.curve=linear --set view.exposure_ev=-5 \
                --set view.adaptation=0 --set effects.scattering=off --set effects.refraction=off";
    for output in ["a.png --bits 16 --stats s.json", "a.exr"] {
        place.expect(
            0,
            &format!("render {} -o {output} {keys}", folder.display()),
        );
    }
    let stats = stats(&place, "s.json");
    let frames = stats["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 7);
    let told = |frame: &Value| {
        let scene = &frame["scene"];
        [
            &frame["exposure"]["multiplier"],
            &frame["exposure"]["white_xyz"],
            &frame["settings"],
            &scene["volume"]["temperature"],
            &scene["volume"]["soot"],
            &scene["camera"],
            &scene["effects"],
        ]
        .map(Value::clone)
    };
    for frame in frames {
        assert_eq!(told(frame), told(&frames[0]), "frame {}", frame["frame"]);
    }
    let ratios: Vec<f64> = (3..=9)
        .map(|frame| {
            let [shown, light] = means(&place, frame);
            shown / light
        })
        .collect();
    for ratio in &ratios {
        assert!((ratio / ratios[0] - 1.0).abs() < 0.01, "{ratios:?}");
    }
    // The same light makes another picture where each frame measures itself.
    let lights: Vec<f64> = (3..=9).map(|frame| means(&place, frame)[1]).collect();
    assert!((lights[6] / lights[0] - 1.0).abs() > 0.02, "{lights:?}");
}
