//! What becomes of the hue of fires and of the lone lines of metals, up to eight stops over white, by two measures of hue
//! that are not ours: Oklab as another crate has it, and ITP (ITU-R BT.2124).
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

use palette::white_point::D65;
use palette::{FromColor, Oklab, Xyz};

use super::super::cie::colour_matching;
use super::super::golden_csv::Table;
use super::*;

const INTEGRALS_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/cie_integrals.csv"
));
/// Lone wavelengths, nm: CH, C₂ and copper, thallium, CaOH, sodium, SrOH, lithium.
const LINES_NM: [f64; 8] = [431.0, 510.0, 516.0, 535.0, 554.0, 589.0, 620.0, 671.0];
/// Chroma in Oklab above which a displayed colour has a hue to speak of.
const CHROMATIC: f64 = 0.03;

/// Fires up to 2500 K and metals' lines by name, XYZ with Y = 1.
fn lights() -> Vec<(String, [f64; 3])> {
    let table = Table::parse(INTEGRALS_CSV);
    let bodies = table.rows().filter(|row| row.number("T_K") <= 2500.0);
    let bodies = bodies.map(|row| {
        let xyz = ["X", "Y", "Z"].map(|column| row.number(column));
        (format!("{} K", row.text("T_K")), xyz)
    });
    let lines = LINES_NM.map(|nm| (format!("{nm} nm"), colour_matching(nm)));
    bodies
        .chain(lines)
        .map(|(name, xyz)| (name, xyz.map(|v| v / xyz[1])))
        .collect()
}

/// Hue in degrees and chroma by Oklab.
fn oklab(xyz: [f64; 3]) -> (f64, f64) {
    let lab = Oklab::from_color(Xyz::<D65, f64>::new(xyz[0], xyz[1], xyz[2]));
    (lab.b.atan2(lab.a).to_degrees(), lab.a.hypot(lab.b))
}

/// Hue in degrees by ITP, display white at 203 cd m⁻².
fn itp(xyz: [f64; 3]) -> f64 {
    let [x, y, z] = xyz.map(|v| 203.0 * v);
    let lms = [
        0.3592832590121217 * x + 0.6976051147779502 * y - 0.0358915932320290 * z,
        -0.1920808463704993 * x + 1.1004767970374321 * y + 0.0753748658519118 * z,
        0.0070797844607479 * x + 0.0748396662186362 * y + 0.8433265453898765 * z,
    ];
    let [l, m, s] = lms.map(|v| {
        let power = (v.max(0.0) / 1e4).powf(2610.0 / 16384.0);
        ((3424.0 / 4096.0 + 2413.0 / 128.0 * power) / (1.0 + 2392.0 / 128.0 * power))
            .powf(2523.0 / 32.0)
    });
    let tritan = 0.5 * (6610.0 * l - 13613.0 * m + 7003.0 * s) / 4096.0;
    let protan = (17933.0 * l - 17390.0 * m - 543.0 * s) / 4096.0;
    protan.atan2(tritan).to_degrees()
}

fn turned(one: f64, other: f64) -> f64 {
    ((one - other + 540.0).rem_euclid(360.0) - 180.0).abs()
}

fn displayed(light: [f64; 3], stop: i32, curve: Curve) -> [f64; 3] {
    let view = View {
        exposure: f64::from(stop).exp2(),
        adaptation: 0.0,
        white_xyz: [0.0; 3],
        curve,
        half_saturation: 1.0,
        false_colour: false,
    };
    let rgb = BakedView::new(&view).linear(light.map(|v| v as f32));
    (xyz::xyz_from_rgb() * DVec3::from_array(rgb.map(f64::from))).to_array()
}

/// The furthest that a light's hue turns by each measure, as long as it is chromatic.
fn furthest(light: [f64; 3], curve: Curve) -> [f64; 2] {
    let mut furthest = [0.0_f64; 2];
    for stop in -4..=8 {
        let shown = displayed(light, stop, curve);
        let (hue, chroma) = oklab(shown);
        if chroma < CHROMATIC {
            continue;
        }
        // ITP looks at the brightness, too.
        let as_bright = light.map(|v| v * shown[1]);
        furthest[0] = furthest[0].max(turned(hue, oklab(light).0));
        furthest[1] = furthest[1].max(turned(itp(shown), itp(as_bright)));
    }
    furthest
}

#[test]
fn curves_that_keep_hue_keep_it_up_to_eight_stops_over_white() {
    for curve in [Curve::Filmic, Curve::Eye] {
        for (name, light) in lights() {
            let [by_oklab, by_itp] = furthest(light, curve);
            assert!(by_oklab < 0.5, "{curve:?}, {name}: {by_oklab}°");
            // The two measures themselves disagree by so much about where a hue leads when it pales.
            assert!(by_itp < 15.0, "{curve:?}, {name}: {by_itp}° by ITP");
            let is_fire = name.ends_with('K');
            assert!(!is_fire || by_itp < 10.0, "{curve:?}, {name}: {by_itp}°");
        }
    }
}

#[test]
fn a_photograph_of_a_bright_fire_turns_and_clipping_turns_further() {
    let fire = |curve| {
        let turns = lights()
            .into_iter()
            .take(8)
            .map(|l| furthest(l.1, curve)[0]);
        turns.fold(0.0, f64::max)
    };
    assert!((40.0..45.0).contains(&fire(Curve::Photographic)));
    assert!(fire(Curve::Linear) > 60.0);
}

#[test]
fn dark_light_outside_of_the_triangle_keeps_its_hue_on_every_curve_but_clipping() {
    for (name, light) in lights() {
        let turns = |curve| {
            let shown = displayed(light, -4, curve);
            assert!(
                oklab(shown).1 > 2.0 * CHROMATIC,
                "{curve:?}, {name} is grey"
            );
            turned(oklab(shown).0, oklab(light).0)
        };
        for (curve, bound) in [
            (Curve::Photographic, 5.5),
            (Curve::Filmic, 0.5),
            (Curve::Eye, 0.5),
        ] {
            assert!(turns(curve) < bound, "{curve:?}, {name}: {}°", turns(curve));
        }
    }
    // What the hue's road saves copper's green from.
    let copper = colour_matching(510.0);
    let clipped = displayed(copper, -4, Curve::Linear);
    assert!(turned(oklab(clipped).0, oklab(copper).0) > 20.0);
}

#[test]
fn the_display_gives_the_luminance_that_the_eye_responds_with() {
    for (name, light) in lights() {
        for stop in -8..=8 {
            let shown = displayed(light, stop, Curve::Eye)[1];
            let response = adaptation::naka_rushton(f64::from(stop).exp2(), 1.0);
            assert!(
                (shown / response - 1.0).abs() < 1e-3,
                "{name}, {stop}: {shown} for {response}"
            );
        }
    }
}

#[test]
fn embers_are_red_and_not_pink() {
    for curve in [Curve::Photographic, Curve::Filmic, Curve::Eye] {
        for (name, light) in lights().into_iter().take(4) {
            let view = View {
                exposure: 0.125,
                adaptation: 0.0,
                white_xyz: [0.0; 3],
                curve,
                half_saturation: 1.0,
                false_colour: false,
            };
            let [r, g, b] = BakedView::new(&view).linear(light.map(|v| v as f32));
            assert!(
                b < 0.03 * r && g < 0.2 * r,
                "{curve:?}, {name}: {r} {g} {b}"
            );
        }
    }
}
