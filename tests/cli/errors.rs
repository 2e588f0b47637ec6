//! What is said, with which exit code, when something is wrong.

use super::place::Place;

#[test]
fn wrong_usage_is_2_and_names_what_would_be_right() {
    let place = Place::new();
    let cases = [
        ("render", "--output"),
        ("render -o a.jpg", "end with .png"),
        ("render -o a.png --quality best", "reference"),
        ("render -o a.png --size 640", "1280x720"),
        ("render -o a.png --size 0x5", "0 × 5"),
        ("render -o a.png --threads 0", "1..=1024"),
        ("render -o a.exr --bits 8", "--bits is for PNG"),
        (
            "render -o a.png --set soot.radus_nm=3",
            "did you mean soot.radius_nm?",
        ),
        (
            "render -o a.png --set soot.radius_nm=-1",
            "must lie between 1 and 100",
        ),
        (
            "render -o a.png --set soot.amount=much",
            "expected a number, 0 to 10000",
        ),
        ("render -o a.png --set soot.amount", "key=value"),
        (
            "render density.txt -o a.png --set volume.soot.grid=densty",
            "did you mean \"density\"?",
        ),
        (
            "render density.txt -o a.png --set volume.soot.scale=nan",
            "finite",
        ),
        (
            "render -o a.png --set camera.fov_deg=180",
            "camera.fov_deg is 180",
        ),
        (
            "render -o a.png --set air.pressure_pa=10",
            "air.pressure_pa is 10: it must lie between 1000 and 1000000",
        ),
        (
            "render -o a.png --set air.saturation=hunag",
            "did you mean huang?",
        ),
        (
            "render -o a.png --set soot.asymmetry=1",
            "soot.asymmetry is 1",
        ),
        (
            "render -o a.png --set stage.spheres=[[0,0,0,-1]]",
            "stage.spheres: the radius of sphere 1 is -1 m",
        ),
        (
            "render -o a.png --set stage.spheres=[[0,0,0]]",
            "lists of four numbers of m",
        ),
        (
            "render -o a.png --set stage.backdrop=picture",
            "set stage.backdrop_picture",
        ),
        (
            "render -o a.png --set stage.ground=true --set air.temperature_k=400 --set air.humidity=1 --set \
             air.pressure_pa=1000",
            "(air.humidity, air.temperature_k, air.pressure_pa)",
        ),
        ("rendr", "did you mean render?"),
        ("render -o a.png --frobnicate", "--frobnicate"),
    ];
    for (words, expected) in cases {
        let [said, error] = place.expect(2, words);
        assert!(
            error.contains(expected) && said.is_empty(),
            "sootlight {words}\n{said}{error}"
        );
    }
    std::fs::write(place.path("s.toml"), "[soot]\nradus_nm = 3\n").unwrap();
    let [_, error] = place.expect(2, "render --scene s.toml -o a.png");
    assert!(
        error.contains("s.toml, line 2") && error.contains("did you mean soot.radius_nm?"),
        "{error}"
    );
    assert_eq!(place.names(), ["density.txt", "s.toml", "temperature.txt"]);
}

#[test]
fn failed_work_is_1_names_the_file_and_leaves_nothing_behind() {
    let place = Place::new();
    std::fs::write(place.path("bad.txt"), "4 4 4\n1 2 three\n").unwrap();
    std::fs::write(place.path("bad.png"), "no picture").unwrap();
    let cases = [
        ("render no-such.vdb -o a.png", "no-such.vdb"),
        ("render bad.txt -o a.png", "bad.txt"),
        ("info bad.txt", "bad.txt"),
        ("render --scene no-such.toml -o a.png", "no-such.toml"),
        (
            "render -o a.png --set stage.backdrop=picture --set stage.backdrop_picture=bad.txt",
            "bad.txt cannot be shown: expected a PNG picture, found no picture",
        ),
        (
            "render -o a.png --set stage.backdrop=picture --set stage.backdrop_picture=no-such.png",
            "no-such.png cannot be read",
        ),
        (
            "render -o bad.png --set stage.backdrop=picture --set stage.backdrop_picture=bad.png",
            "is a file that the picture is made from",
        ),
        ("render -o missing/a.png", "folder does not exist"),
        ("render -o density.txt/a.png", "is a file, not a folder"),
        (
            "render -o a.png --stats density.txt/s.json",
            "is a file, not a folder",
        ),
    ];
    let before = place.names();
    for (words, expected) in cases {
        let [said, error] = place.expect(1, words);
        assert!(
            error.starts_with("error: ") && error.contains(expected),
            "sootlight {words}\n{error}"
        );
        assert!(said.is_empty(), "{said}");
    }
    assert_eq!(place.names(), before);
    let [_, error] = place.expect(1, "info no-such.vdb");
    assert_eq!(
        error.matches("os error").count(),
        1,
        "a cause is said once:\n{error}"
    );
}

#[test]
fn without_a_display_one_sentence_says_what_to_do_instead() {
    let place = Place::new();
    let [said, error] = place.expect(1, "density.txt");
    assert!(
        error.contains("`cargo run --release -- render -o fire.png`"),
        "{error}"
    );
    assert_eq!((error.lines().count(), said.as_str()), (1, ""), "{error}");
}

#[test]
fn a_limit_of_memory_is_raised_as_the_refusal_says() {
    let place = Place::new();
    // 4.4 million values are 17.6 MB.
    let row = format!("{}\n", "1 ".repeat(200));
    let text = format!("200 200 110\n{}", row.repeat(200 * 110));
    std::fs::write(place.path("large_density.txt"), text).unwrap();
    let info = "info large_density.txt --set volume.memory_limit_mb";
    let [_, error] = place.expect(1, &format!("{info}=16"));
    assert!(
        error.contains(
            "large_density.txt: the dense box needs 17600000 bytes, the limit is 16000000"
        ) && error.contains("raise volume.memory_limit_mb to 18"),
        "{error}"
    );
    // What is packed of the grid takes twice as much: the next refusal names that.
    let [_, error] = place.expect(2, &format!("{info}=18"));
    let enough = error.split("raise volume.memory_limit_mb to ").nth(1);
    let enough: String = enough
        .unwrap_or_else(|| panic!("{error}"))
        .chars()
        .take_while(char::is_ascii_digit)
        .collect();
    place.expect(0, &format!("{info}={enough}"));
    let [_, error] = place.expect(2, &format!("{info}=1"));
    assert!(error.contains("must lie between 16 and 1000000"), "{error}");
}
