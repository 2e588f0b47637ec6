//! The command line, as a script sees it: exit codes, streams, files.

use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _};
use sootlight::project::Project;
use sootlight::project::file::SceneFileError;

mod errors;
mod fire;
mod outputs;
mod place;
mod sequence;
mod spectrum;
mod stage;
mod study;
mod view;

use place::{Place, read_png};

const SMALL: &str = "render density.txt temperature.txt --size 40x24";

#[test]
fn the_built_in_flame_renders_without_any_file() {
    let place = Place::new();
    let [said, errors] = place.expect(0, "render -o fire.png --size 45x80 --quality draft");
    assert!(said.contains("fire.png: 45 × 80 pixels"), "{said}");
    assert_eq!(errors, "", "a pipe gets no progress bar");
    let (pixels, info, text) = read_png(&place.path("fire.png"));
    assert_eq!(
        (info.width, info.height, info.bit_depth),
        (45, 80, png::BitDepth::Eight)
    );
    let bright = pixels.chunks_exact(3).filter(|rgb| rgb[0] > 150).count();
    assert!(
        (50..2500).contains(&bright),
        "{bright} bright pixels of 3600"
    );
    assert!(text("Comment").contains("built-in flame"));
}

#[test]
fn a_png_carries_the_scene_that_makes_it_again() {
    let place = Place::new();
    place.expect(
        0,
        &format!("{SMALL} -o a.png --bits 16 --set soot.amount=0.3 --quality draft"),
    );
    let (_, info, text) = read_png(&place.path("a.png"));
    assert_eq!(
        (info.width, info.height, info.bit_depth),
        (40, 24, png::BitDepth::Sixteen)
    );
    assert!(text("Software").starts_with("sootlight "));
    assert!(
        text("Comment").contains("density.txt (") && !text("Comment").contains('/'),
        "{}",
        text("Comment")
    );
    let project = Project::from_toml(&text("sootlight.scene"), Path::new("")).unwrap();
    assert_eq!((project.soot.amount, project.render.size), (0.3, [40, 24]));
    assert_eq!(
        project.volume.path,
        [Path::new("density.txt"), Path::new("temperature.txt")]
    );

    std::fs::write(place.path("again.toml"), text("sootlight.scene")).unwrap();
    place.expect(0, "render --scene again.toml -o b.png --bits 16");
    assert_eq!(
        std::fs::read(place.path("a.png")).unwrap(),
        std::fs::read(place.path("b.png")).unwrap()
    );
}

#[test]
fn an_exr_holds_the_light_and_what_it_passed_through() {
    let place = Place::new();
    place.expect(0, &format!("{SMALL} -o a.exr"));
    let image = read_exr(&place.path("a.exr"));
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<String> = channels
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    assert_eq!(
        names,
        [
            "A", "B", "G", "R", "T.B", "T.G", "T.R", "xyz.X", "xyz.Y", "xyz.Z"
        ]
    );
    assert_eq!(
        (image.layer_data.size.x(), image.layer_data.size.y()),
        (40, 24)
    );
    let at = |name: &str, x: usize, y: usize| {
        let channel = channels
            .iter()
            .find(|channel| channel.name.eq(name))
            .unwrap();
        let FlatSamples::F32(values) = &channel.sample_data else {
            panic!("{name} is not f32")
        };
        values[y * 40 + x]
    };
    // The corner sees past the flame: dark, clear. The middle glows and hides a little, blue more than red.
    assert_eq!(
        (at("xyz.Y", 0, 0), at("A", 0, 0), at("T.R", 0, 0)),
        (0.0, 0.0, 1.0)
    );
    let (y, red, alpha) = (at("xyz.Y", 20, 12), at("R", 20, 12), at("A", 20, 12));
    assert!(
        y > 0.0 && red > 683.0 * y && (0.001..1.0).contains(&alpha),
        "Y {y}, R {red}, A {alpha}"
    );
    assert!(at("T.B", 20, 12) < at("T.R", 20, 12) && at("T.R", 20, 12) < 1.0);
    let scene = image
        .layer_data
        .attributes
        .other
        .iter()
        .find(|(name, _)| (*name).eq("sootlight.scene"))
        .unwrap()
        .1;
    let exr::meta::attribute::AttributeValue::Text(scene) = scene else {
        panic!("not a text")
    };
    let scene = std::str::from_utf8(scene.as_slice()).unwrap();
    assert_eq!(
        Project::from_toml(scene, Path::new(""))
            .unwrap()
            .render
            .size,
        [40, 24]
    );
}

/// An EXR as another program reads it.
fn read_exr(
    path: &Path,
) -> exr::image::Image<exr::image::Layer<exr::image::AnyChannels<FlatSamples>>> {
    exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap()
}

/// A channel of an EXR, row by row.
fn channel(path: &Path, name: &str) -> Vec<f32> {
    let image = read_exr(path);
    let channels = &image.layer_data.channel_data.list;
    let found = channels.iter().find(|channel| channel.name.eq(name));
    let FlatSamples::F32(values) = &found.unwrap().sample_data else {
        panic!("{name} is not f32")
    };
    values.clone()
}

#[test]
fn a_fire_comps_over_a_plate_as_if_it_stood_before_it() {
    let place = Place::new();
    let render = |name: &str, sets: &str| {
        // The numbers that are chosen for a scene are not those of another. One ray a pixel: within a pixel at the fire's edge
        // no alpha can say which part of the plate is hidden.
        let numbers = "--set render.step_voxels=0.5 --set render.wavelengths=8 --set render.samples_per_pixel=1";
        let straight = "--set effects.refraction=off --set effects.scattering=off";
        let words = format!("{SMALL} -o {name}.exr {straight} {numbers} {sets}");
        place.expect(0, &words);
        place.path(&format!("{name}.exr"))
    };
    let plate_of = "--set stage.backdrop=gradient --set stage.backdrop_luminance_cd_m2=3e4";
    let fire = render("fire", "--set soot.amount=100");
    let plate = render("plate", &format!("{plate_of} --set soot.amount=0"));
    let both = render("both", &format!("{plate_of} --set soot.amount=100"));
    let alpha = channel(&fire, "A");
    let deepest = alpha.iter().copied().fold(0.0, f32::max);
    assert!(
        deepest > 0.5,
        "the plate is seen through all of it: {deepest}"
    );
    let through = ["T.R", "T.G", "T.B"].map(|name| channel(&fire, name));
    let mut luminance = vec![[0.0_f32; 2]; alpha.len()];
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        let [fire, plate, both] = [&fire, &plate, &both].map(|path| channel(path, name));
        let brightest = both.iter().copied().fold(0.0, f32::max);
        for (i, both) in both.iter().enumerate() {
            // Premultiplied light over a white plate, colour by colour: the same but for the last digits of what white is.
            let comp = fire[i] + plate[i] * through[c][i];
            assert!(
                (comp - both).abs() < 2e-4 * brightest,
                "{name} of pixel {i}: {comp} {both}"
            );
            // With the one alpha that every program knows, luminance is right and blue is a little off.
            let over = fire[i] + plate[i] * (1.0 - alpha[i]);
            let weight = [0.2126, 0.7152, 0.0722][c];
            luminance[i][0] += weight * over;
            luminance[i][1] += weight * both;
        }
    }
    let brightest = luminance.iter().fold(0.0, |most: f32, [_, y]| most.max(*y));
    for (i, [over, both]) in luminance.into_iter().enumerate() {
        assert!(
            (over - both).abs() < 2e-4 * brightest,
            "pixel {i}: {over} {both}"
        );
    }
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    let place = Place::new();
    for ending in ["png", "exr"] {
        let bytes = ["--threads 1", "--threads 2", "--threads 5", ""].map(|threads| {
            place.expect(0, &format!("{SMALL} -o a.{ending} {threads}"));
            std::fs::read(place.path(&format!("a.{ending}"))).unwrap()
        });
        assert!(
            bytes.iter().all(|other| *other == bytes[0]),
            "{ending} differs"
        );
    }
}

#[test]
fn statistics_have_the_keys_that_scripts_read() {
    let place = Place::new();
    let draft = |set: &str| {
        place.expect(
            0,
            &format!("{SMALL} -o a.png --stats s.json --quality draft --threads 2 --set render.samples_per_pixel=1 {set}"),
        );
        serde_json::from_str::<serde_json::Value>(&place.text("s.json")).unwrap()
    };
    let stats = draft("--set view.exposure_ev=1");
    for key in ["load", "bake", "render", "write"] {
        assert!(stats["seconds"][key].as_f64().unwrap() >= 0.0, "{key}");
    }
    assert_eq!(stats["rays"], 40 * 24);
    assert_eq!(stats["threads"], 2);
    assert!(stats["samples"].as_u64().unwrap() > 0);
    let plan = stats["plan"].as_array().unwrap();
    for row in plan {
        let keys = [
            "effect",
            "switch",
            "state",
            "bound_de",
            "cost_seconds",
            "reason",
        ];
        assert!(keys.iter().all(|key| row.get(key).is_some()), "{row}");
    }
    let states: Vec<_> = plan
        .iter()
        .map(|it| {
            (
                it["effect"].as_str().unwrap(),
                it["state"].as_str().unwrap(),
            )
        })
        .collect();
    assert_eq!(
        states,
        [
            ("emission-absorption", "on"),
            ("smoke", "off"),
            ("lines", "off"),
            ("bands", "off"),
            ("chemiluminescence", "off"),
            ("scattering", "on"),
            ("scattering_orders", "on"),
            ("refraction", "on"),
            ("dispersion", "off"),
            ("fire_light", "off"),
            ("wavelengths", "on"),
        ]
    );
    assert!(
        !stats["flaws"].as_array().unwrap().is_empty(),
        "the voxel size is a guess"
    );
    assert_eq!(stats["settings"]["size"], serde_json::json!([40, 24]));
    assert!(stats["settings"]["step_voxels"].as_f64().unwrap() > 0.0);
    assert!(stats["settings"]["wavelengths"].as_u64().unwrap() >= 4);
    assert_eq!(stats["accuracy"]["wished_de95"], 5.0);
    assert!(stats["accuracy"]["expected"]["de95"].as_f64().unwrap() > 0.0);
    assert!(stats["cpu_seconds"]["render"].as_f64().unwrap() > 0.0);
    let exposure = &stats["exposure"];
    let white = exposure["display_white_cd_m2"].as_f64().unwrap()
        * exposure["multiplier"].as_f64().unwrap();
    assert!((white / 683.0 - 1.0).abs() < 1e-12);
    assert_eq!(exposure["relative_ev"], 1.0);
    assert!(stats["peak"]["luminance_cd_m2"].as_f64().unwrap() > 0.0);

    // A number that was set wins over the quality.
    assert_eq!(
        draft("--set render.step_voxels=0.5")["settings"]["step_voxels"],
        0.5
    );
}

#[test]
fn info_lists_what_is_there_and_what_would_be_made_of_it() {
    let place = Place::new();
    let [said, errors] = place.expect(0, "info density.txt temperature.txt");
    for expected in [
        "density.txt",
        "dense ASCII",
        "8 × 8 × 12",
        "soot",
        "temperature",
        " K",
        "f_v",
        "physical",
        "up ",
        "\ndata      x 0 to 0.08, y 0 to 0.08, z 0 to 0.12 m\n",
        "\nfire      x ",
    ] {
        assert!(said.contains(expected), "no \"{expected}\" in:\n{said}");
    }
    assert!(
        said.contains("assumed or repaired") && errors.is_empty(),
        "{said}{errors}"
    );

    // Alone, a temperature that is switched off leaves nothing to render: told all the same, then 1.
    let off = "--set volume.soot.grid= --set volume.smoke.grid=";
    let [said, error] = place.expect(1, &format!("info density.txt {off}"));
    assert!(
        said.contains("8 × 8 × 12") && error.contains("nothing to render"),
        "{said}{error}"
    );

    let [said, _] = place.expect(0, "info");
    assert!(said.contains("built-in flame"), "{said}");
}

#[test]
fn a_mapping_that_was_set_is_the_one_that_info_shows() {
    let place = Place::new();
    let [said, _] = place.expect(
        0,
        "info density.txt temperature.txt --set volume.temperature.max=1234 --set volume.up=y",
    );
    assert!(said.contains("to 1234"), "{said}");
    let up = said.lines().find(|line| line.starts_with("up")).unwrap();
    assert!(up.ends_with(" y"), "{up}");
}

#[test]
fn a_scene_file_finds_its_volume_beside_it() {
    let place = Place::new();
    std::fs::create_dir(place.path("scenes")).unwrap();
    let scene =
        "volume.path = [\"../density.txt\", \"../temperature.txt\"]\nrender.size = [16, 9]\n";
    std::fs::write(place.path("scenes/fire.toml"), scene).unwrap();
    place.expect(0, "render --scene scenes/fire.toml -o a.png");
    assert_eq!(read_png(&place.path("a.png")).1.width, 16);
    // Named where volumes are, it is the scene to start from as well.
    let [by_flag, _] = place.expect(0, "info --scene scenes/fire.toml");
    let [by_name, _] = place.expect(0, "info scenes/fire.toml");
    assert_eq!(by_flag, by_name);
    for words in [
        "info scenes/fire.toml --preset candle",
        "info scenes/fire.toml --scene scenes/fire.toml",
        "render scenes/fire.toml scenes/fire.toml -o a.png",
    ] {
        let [_, error] = place.expect(2, words);
        assert!(error.contains("name one scene"), "{error}");
    }
    // A file on the command line takes the place of the scene's.
    let [said, _] = place.expect(0, "info density.txt --scene scenes/fire.toml");
    assert!(!said.contains("temperature.txt"), "{said}");
}

#[test]
fn the_scene_of_the_standard_plume_is_what_its_page_says() -> Result<(), SceneFileError> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/plume.toml");
    let project = Project::read(&scene)?;
    let settings = project.settings(project.render.size).unwrap();
    assert_eq!((settings.size, settings.samples_per_pixel), ([512, 512], 1));
    // 8 m⁻¹ at 550 nm where the soot peaks, falling with the power 1.39.
    let law = project.fuel.name.soot_law(project.soot.model);
    let absorption = |nm| 9.4797e-7 * project.soot.amount * law.absorption_per_volume_fraction(nm);
    assert!(
        (absorption(550.0) / 8.0 - 1.0).abs() < 1e-5,
        "{}",
        absorption(550.0)
    );
    assert!(
        (absorption(450.0) / absorption(550.0) / (550.0_f64 / 450.0).powf(1.39) - 1.0).abs()
            < 1e-12
    );
    Ok(())
}

#[test]
fn help_lists_every_key() {
    let [said, _] = Place::new().expect(0, "render --help");
    for key in sootlight::project::set::KEYS {
        assert!(said.contains(key.name), "{}", key.name);
    }
}
