//! What burns, on the command line: told in statistics, by `info` and in a picture's provenance.

use serde_json::Value;
use sootlight::project::Project;

use super::place::{Place, read_png};

/// The statistics of a small picture.
fn stats(place: &Place, words: &str) -> Value {
    place.expect(
        0,
        &format!("render {words} --size 24x32 -o a.png --stats s.json"),
    );
    serde_json::from_str(&place.text("s.json")).unwrap()
}

/// Effect, state and reason of each row of the plan.
fn plan(stats: &Value) -> Vec<[String; 3]> {
    let rows = stats["plan"].as_array().unwrap().iter();
    rows.map(|row| ["effect", "state", "reason"].map(|key| row[key].as_str().unwrap().to_owned()))
        .collect()
}

#[test]
fn statistics_tell_what_burns_and_which_effects_were_computed() {
    let place = Place::new();
    let copper = stats(
        &place,
        "--preset copper --set render.interpolation=tricubic --set render.wavelengths=6",
    );
    assert_eq!(copper["fire"]["fuel"], "methanol");
    assert_eq!(copper["fire"]["salt"], "copper");
    assert!(copper["fire"]["salt_ppm"].as_f64().unwrap() > 0.0);
    assert_eq!(copper["fire"]["soot_times_field"], 0.0);
    assert_eq!(copper["settings"]["interpolation"], "tricubic");
    let effects = plan(&copper);
    let states: Vec<&str> = effects.iter().map(|row| row[1].as_str()).collect();
    assert_eq!(
        states,
        [
            "off", "off", "on", "on", "on", "off", "off", "on", "off", "off", "off"
        ],
        "{effects:?}"
    );
    assert_eq!(effects[0][2], "there is no soot");

    let torch = stats(&place, "--set view.curve=eye --set view.adaptation=0.5");
    assert_eq!(torch["exposure"]["curve"], "eye");
    assert_eq!(torch["exposure"]["adaptation"], 0.5);
    assert_eq!(torch["exposure"]["false_colour"], false);
    let effects = plan(&torch);
    assert_eq!(effects[0][1], "on");
    for of_salt in [2, 3] {
        assert_eq!(effects[of_salt][1..], ["off", "there is no salt"]);
    }
    assert_eq!(effects[4][1], "off");
    assert!(effects[4][2].starts_with("no field says where gas burns"));

    let off = "--preset copper --set effects.lines=off --set effects.bands=off --set effects.chemiluminescence=off --set soot.amount=1 \
               --set effects.scattering=off --set effects.refraction=off --set effects.dispersion=off \
               --set effects.fire_light=off --set effects.smoke=off";
    let switched = [
        "smoke",
        "lines",
        "bands",
        "chemiluminescence",
        "scattering",
        "refraction",
        "dispersion",
        "fire_light",
    ];
    let rows = plan(&stats(&place, off));
    for row in rows
        .iter()
        .filter(|row| switched.contains(&row[0].as_str()))
    {
        assert_eq!(
            row[1..],
            ["off".to_owned(), format!("effects.{} is off", row[0])]
        );
    }
}

#[test]
fn statistics_tell_what_could_be_saved_and_what_it_costs() {
    let place = Place::new();
    let told = stats(
        &place,
        "--set effects.scattering=on --set stage.ground=true",
    );
    let cost = |effect: &str| {
        let rows = told["plan"].as_array().unwrap();
        let row = rows.iter().find(|row| row["effect"] == effect).unwrap();
        row["cost_seconds"].clone()
    };
    assert!(cost("scattering").as_f64().unwrap() > 0.0);
    for nothing in [
        "emission-absorption",
        "smoke",
        "lines",
        "bands",
        "chemiluminescence",
    ] {
        assert!(cost(nothing).is_null(), "{nothing}");
    }
}

#[test]
fn info_tells_the_plan_as_a_table() {
    let place = Place::new();
    let told = |words: &str| {
        let [said, _] = place.expect(0, &format!("info --set render.size=[48,64] {words}"));
        said
    };
    assert!(!told("").contains("is computed with"));
    let plan = told("--plan --set effects.scattering=on --set effects.dispersion=off");
    let row = |effect: &str| {
        let mut rows = plan
            .lines()
            .skip_while(|line| !line.contains("is computed with"));
        let found = rows.find(|line| line.split_whitespace().next() == Some(effect));
        let words = found.unwrap_or_else(|| panic!("{effect}: {plan}"));
        // Columns stand two spaces apart.
        let cells = words.split("  ").map(str::trim).filter(|it| !it.is_empty());
        cells.map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(plan.contains("a picture of 48 × 64 pixels"), "{plan}");
    assert_eq!(
        row("effect"),
        ["effect", "switch", "state", "changes", "seconds", "why"]
    );
    let scattering = row("scattering");
    assert_eq!(scattering[1..3], ["on", "computed"]);
    assert!(scattering[3].ends_with(" ΔE") && scattering[4].starts_with("costs "));
    assert!(scattering[5].starts_with("soot of 21 nm scatters"));
    assert_eq!(
        row("lines")[1..],
        ["auto", "left out", "-", "-", "there is no salt"]
    );
    assert_eq!(
        row("dispersion")[1..],
        ["off", "left out", "-", "-", "effects.dispersion is off"]
    );
    for effect in ["smoke", "refraction", "fire_light", "wavelengths"] {
        assert!(row(effect).len() == 6, "{effect}: {plan}");
    }
}

#[test]
fn the_scene_in_statistics_and_in_a_picture_makes_the_picture_again() {
    let place = Place::new();
    let words = "--preset strontium --set fuel.salt_ppm=12.5 --set render.interpolation=nearest --set view.white_k=3000";
    let first = stats(&place, words);
    let picture = read_png(&place.path("a.png")).0;
    let project: Project = serde_json::from_value(first["scene"].clone()).unwrap();
    assert_eq!(project.fuel.salt_ppm, 12.5);
    std::fs::write(place.path("again.toml"), project.to_toml()).unwrap();
    let again = stats(&place, "--scene again.toml");
    assert_eq!(again["scene"], first["scene"]);
    assert_eq!(again["exposure"], first["exposure"]);
    assert!(
        read_png(&place.path("a.png")).0 == picture,
        "another picture"
    );
}

#[test]
fn info_says_which_flame_and_what_the_fuel_does_to_its_soot() {
    let place = Place::new();
    let [said, _] = place.expect(0, "info --preset copper");
    for words in [
        "built-in flame, spirit",
        "methanol: burns without soot",
        "0 × the soot field",
        "salt      copper, ",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let [said, _] = place.expect(0, "info --set fuel.name=acetylene --set soot.amount=2");
    assert!(
        said.contains("acetylene: 4 × the soot of propane"),
        "{said}"
    );
    assert!(said.contains("8 × the soot field"), "{said}");
    assert!(!said.contains("salt"), "{said}");
}
