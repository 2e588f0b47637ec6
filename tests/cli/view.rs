//! The eye and the display from the command line.

use sootlight::colour::display::{Curve, View};

use super::SMALL;
use super::place::{Place, read_png};

#[test]
fn the_keys_of_the_view_are_set_told_and_made_again() {
    let place = Place::new();
    let keys = "--set view.curve=eye --set view.white_k=2000 --set view.half_saturation_cd_m2=5000";
    place.expect(0, &format!("{SMALL} -o a.png --stats s.json {keys}"));
    let stats: serde_json::Value = serde_json::from_str(&place.text("s.json")).unwrap();
    let exposure = &stats["exposure"];
    assert_eq!(exposure["white"]["set_k"], 2000.0);
    assert_eq!(exposure["half_saturation_cd_m2"], 5000.0);

    place.expect(0, &format!("{SMALL} -o b.png --stats s.json"));
    let stats: serde_json::Value = serde_json::from_str(&place.text("s.json")).unwrap();
    assert_eq!(stats["exposure"]["white"], "from the scene");
    assert!(stats["exposure"]["half_saturation_cd_m2"].is_null());
    let bytes = |name| std::fs::read(place.path(name)).unwrap();
    assert_ne!(bytes("a.png"), bytes("b.png"));

    // Of the automatic half-saturation the statistics say what it was.
    place.expect(
        0,
        &format!("{SMALL} -o c.png --stats s.json --set view.curve=eye"),
    );
    let stats: serde_json::Value = serde_json::from_str(&place.text("s.json")).unwrap();
    let number = |key: &str| stats["exposure"][key].as_f64().unwrap();
    let ratio = number("half_saturation_cd_m2") / number("display_white_cd_m2");
    assert!((ratio - 2.0).abs() < 1e-9, "{ratio}");
}

#[test]
fn a_view_out_of_range_is_refused_by_name() {
    let place = Place::new();
    for (set, wanted) in [
        ("view.white_k=100", "between 1000 and 20000"),
        (
            "view.half_saturation_cd_m2=0",
            "between 0.001 and 1000000000",
        ),
        ("view.false_colour=maybe", "true or false"),
        ("view.curve=film", "photographic, filmic, eye or linear"),
    ] {
        let [_, errors] = place.expect(2, &format!("{SMALL} -o a.png --set {set}"));
        let key = set.split('=').next().unwrap();
        assert!(
            errors.contains(key) && errors.contains(wanted),
            "{set}: {errors}"
        );
    }
}

#[test]
fn a_false_picture_holds_the_colours_of_the_legend() {
    let place = Place::new();
    place.expect(0, &format!("{SMALL} -o a.png --set view.false_colour=true"));
    let (pixels, ..) = read_png(&place.path("a.png"));
    let view = View {
        exposure: 1.0,
        adaptation: 0.0,
        white_xyz: [0.0; 3],
        curve: Curve::default(),
        half_saturation: 1.0,
        false_colour: true,
    };
    let bands = view.bands();
    // Only at the edge between two stops, 1/32 of a stop wide, a colour is between two.
    let in_legend = |rgb: &&[u8]| bands.iter().any(|band| band.srgb == **rgb);
    let count = pixels.chunks_exact(3).filter(in_legend).count();
    assert!(count > 40 * 24 * 8 / 10, "only {count}");
    let black = bands[0].srgb;
    assert_eq!(pixels[..3], black, "the corner sees past the fire");
    assert!(pixels.chunks_exact(3).any(|rgb| *rgb != black));
}
