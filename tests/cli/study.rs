//! `sootlight study`: tables and charts of what accuracy costs; and pictures that stop at an error or in time.

use super::place::Place;

/// A picture so small that a study of it is quick.
const SMALL: &str = "density.txt temperature.txt --size 48x64 --set volume.voxel_size_m=0.01 --set effects.scattering=off \
                     --set effects.refraction=off";

#[test]
fn a_study_writes_tables_and_charts_that_say_the_same() {
    let place = Place::new();
    let [said, _] = place.expect(0, &format!("study {SMALL} -o found"));
    for quality in ["draft", "look", "final", "reference"] {
        assert!(said.contains(quality), "{said}");
    }
    let table = place.text("found/accuracy.csv");
    let mut rows = table.lines();
    assert_eq!(
        rows.next(),
        Some(
            "family,step_voxels,wavelengths,interpolation,samples,cpu_seconds,seconds,seconds_spread,de95,de_mean,rel_xyz,\
             rel_y,on_front,status,reason"
        )
    );
    let rows: Vec<Vec<&str>> = rows.map(|row| row.splitn(15, ',').collect()).collect();
    for family in [
        "chosen",
        "step",
        "wavelengths",
        "samples",
        "interpolation",
        "baked-rgb",
    ] {
        assert!(rows.iter().any(|row| row[0] == family), "{family}");
    }
    let error = |row: &Vec<&str>| row[8].parse::<f64>().unwrap();
    for row in &rows {
        assert!(
            error(row) > 0.0 && row[5].parse::<f64>().unwrap() > 0.0,
            "{row:?}"
        );
    }
    // A longer step is never nearer by more than chance.
    let steps: Vec<f64> = rows
        .iter()
        .filter(|row| row[0] == "step")
        .map(error)
        .collect();
    assert!(steps[0] > 3.0 * steps[steps.len() - 1], "{steps:?}");
    assert!(rows.iter().any(|row| row[12] == "true"));

    let json: serde_json::Value = serde_json::from_str(&place.text("found/accuracy.json")).unwrap();
    assert_eq!(json["points"].as_array().unwrap().len(), rows.len());
    assert_eq!(json["size"], serde_json::json!([48, 64]));
    let own = json["reference"]["de95"].as_f64().unwrap();
    // Nothing is told below what the reference itself is off by.
    assert!(rows.iter().all(|row| error(row) >= own - 1e-6));
    let chart = place.text("found/accuracy.svg");
    assert!(
        chart.contains("just seen") && chart.contains("48 × 64 pixels"),
        "{chart}"
    );
    let picture = image::open(place.path("found/accuracy.png"))
        .unwrap()
        .to_rgb8();
    assert!(picture.pixels().any(|pixel| pixel.0 != [255; 3]));
}

#[test]
fn what_cannot_be_studied_is_said() {
    let place = Place::new();
    let [_, said] = place.expect(2, &format!("study {SMALL} -o density.txt"));
    assert!(said.contains("name the folder"), "{said}");
    let [_, said] = place.expect(1, &format!("study {SMALL} -o dark --set soot.amount=0"));
    assert!(said.contains("nothing to be seen"), "{said}");
    assert!(!place.path("dark/accuracy.csv").exists());
    // Behind hot gas that shows nothing itself a picture is lit, and no sample is taken.
    place.expect(
        0,
        &format!("study {SMALL} -o behind --set soot.amount=0 --set stage.backdrop=checker"),
    );
    assert!(place.path("behind/accuracy.png").exists());
    let [_, said] = place.expect(2, "studdy");
    assert!(said.contains("did you mean study?"), "{said}");
}

#[test]
fn an_error_that_is_wished_or_a_time_that_is_up_stops_a_picture() {
    let place = Place::new();
    let stats = |words: &str| -> serde_json::Value {
        place.expect(
            0,
            &format!("render {SMALL} -o a.png --stats s.json {words}"),
        );
        serde_json::from_str(&place.text("s.json")).unwrap()
    };
    let exact = stats("--set render.target_error=0.5");
    assert_eq!(exact["accuracy"]["stopped_by"], "target");
    assert!(exact["accuracy"]["expected"]["de95"].as_f64().unwrap() <= 0.5);
    let coarse = stats("--set render.target_error=20");
    let work = |stats: &serde_json::Value| stats["samples"].as_u64().unwrap();
    assert!(work(&coarse) < work(&exact));
    // The same again, whatever the clock says.
    let settings = exact["settings"].clone();
    assert_eq!(
        stats("--set render.target_error=0.5 --threads 1")["settings"],
        settings
    );

    let hurried = stats("--quality reference --time-limit 0.001");
    assert_eq!(hurried["accuracy"]["stopped_by"], "time-limit");
    let flaws = hurried["flaws"].as_array().unwrap();
    assert!(
        flaws
            .iter()
            .any(|flaw| flaw.as_str().unwrap().contains("the time was up")),
        "{flaws:?}"
    );
    assert!(hurried["peak"]["luminance_cd_m2"].as_f64().unwrap() > 0.0);
    // What the clock has chosen is told, so that the same picture can be had again.
    let told = &hurried["scene"]["render"];
    assert_eq!(told["step_voxels"], hurried["settings"]["step_voxels"]);
    assert_eq!(told["wavelengths"], hurried["settings"]["wavelengths"]);
    let by_hand = stats(
        "--set render.step_voxels=2 --set render.wavelengths=6 --set render.samples_per_pixel=1",
    );
    assert_eq!(by_hand["accuracy"]["stopped_by"], "settings");
    assert!(by_hand["accuracy"]["expected"].is_null());
}
