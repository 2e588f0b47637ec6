//! Air, stage and effects on the command line: told in statistics, and kept by a scene file.

use serde_json::{Value, json};
use sootlight::project::Project;

use super::place::Place;

/// The statistics of a small picture.
fn stats(place: &Place, words: &str) -> Value {
    place.expect(
        0,
        &format!("render {words} --size 24x32 --quality draft -o a.png --stats s.json"),
    );
    serde_json::from_str(&place.text("s.json")).unwrap()
}

/// Everything about the new keys, as words of a command line.
const SET: &[&str] = &[
    "air.pressure_pa=90000",
    "air.saturation=davis",
    "air.refraction_gain=3",
    "soot.asymmetry=0.4",
    "smoke.albedo=0.5",
    "stage.ground=true",
    "stage.ground_height_m=-0.25",
    "stage.ground_colour=[0.1,0.2,0.3]",
    "stage.spheres=[[0.5,0,0.1,0.1],[-0.5,0,0.1,0.1]]",
    "stage.sphere_colour=[1,0,0]",
    "stage.logs=[[0,0,0,1,0,0,0.05]]",
    "stage.log_colour=[0,0,1]",
    "stage.backdrop=checker",
    "stage.backdrop_distance_m=2.5",
    "stage.backdrop_square_m=0.125",
    "stage.backdrop_luminance_cd_m2=500",
    "effects.scattering=on",
    "effects.refraction=on",
    "effects.dispersion=on",
    "effects.fire_light=off",
];

#[test]
fn statistics_tell_of_air_and_stage_what_was_set_and_what_follows() {
    let place = Place::new();
    let set: Vec<String> = SET.iter().map(|key| format!("--set {key}")).collect();
    let all = stats(&place, &set.join(" "));
    let told = json!({
        "ground_height_m": -0.25, "spheres": 2, "logs": 1,
        "backdrop": { "pattern": "checker", "distance_m": 2.5, "square_m": 0.125, "luminance_cd_m2": 500.0 },
    });
    assert_eq!(all["stage"], told);
    assert_eq!(all["air"]["pressure_pa"], 90000.0);
    assert_eq!(all["air"]["saturation"], "davis");
    assert_eq!(all["air"]["refraction_gain"], 3.0);
    assert_eq!(all["fire"]["asymmetry"], 0.4);
    let flaws = all["flaws"].as_array().unwrap();
    assert!(
        flaws.contains(&json!("refraction is exaggerated 3 times")),
        "{flaws:?}"
    );

    let bare = stats(&place, "");
    let none = json!({ "ground_height_m": null, "spheres": 0, "logs": 0, "backdrop": null });
    assert_eq!(bare["stage"], none);
    assert_eq!(bare["air"]["refraction_gain"], 1.0);
    let straight = stats(&place, "--set effects.refraction=off");
    assert_eq!(straight["air"]["refraction_gain"], Value::Null);
    assert_eq!(bare["fire"]["asymmetry"], Value::Null);
}

#[test]
fn a_scene_file_keeps_every_key_of_air_stage_and_effects() {
    let place = Place::new();
    let mut project = Project::default();
    project.set_all(SET.iter().copied()).unwrap();
    project.write(&place.path("fire.toml")).unwrap();
    assert_eq!(Project::read(&place.path("fire.toml")).unwrap(), project);
    let again = stats(&place, "--scene fire.toml");
    let scene: Project = serde_json::from_value(again["scene"].clone()).unwrap();
    assert_eq!((&scene.stage, &scene.air), (&project.stage, &project.air));
    assert_eq!(
        (&scene.effects, &scene.soot),
        (&project.effects, &project.soot)
    );
}

#[test]
fn a_picture_for_the_backdrop_lies_beside_the_scene_file() {
    let place = Place::new();
    std::fs::create_dir(place.path("scenes")).unwrap();
    let picture = image::RgbImage::from_pixel(4, 3, image::Rgb([200, 100, 50]));
    picture.save(place.path("scenes/wall.png")).unwrap();
    let scene = "[stage]\nbackdrop = \"picture\"\nbackdrop_picture = \"wall.png\"\n";
    std::fs::write(place.path("scenes/fire.toml"), scene).unwrap();
    let told = stats(&place, "--scene scenes/fire.toml");
    assert_eq!(told["stage"]["backdrop"]["pattern"], "picture");
    assert_eq!(told["stage"]["backdrop"]["square_m"], Value::Null);
}
