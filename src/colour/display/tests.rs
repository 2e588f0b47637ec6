//! Tests of the baked view.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

use super::super::golden_csv::Table;
use super::*;
use proptest::prelude::*;

const INTEGRALS_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/cie_integrals.csv"
));
const CURVES: [Curve; 4] = Curve::ALL;
const EMBER: [f64; 3] = [2.1655753604028249, 1.6095576549577186, 0.16768824092932585];

fn view(exposure: f64, adaptation: f64, curve: Curve) -> View {
    View {
        exposure,
        adaptation,
        white_xyz: EMBER,
        curve,
        half_saturation: 1.0,
        false_colour: false,
    }
}

/// T and XYZ with Y = 1 of the reference black bodies up to 3000 K.
fn black_bodies() -> Vec<(f64, [f32; 3])> {
    let bodies: Vec<_> = Table::parse(INTEGRALS_CSV)
        .rows()
        .map(|row| {
            let y = row.number("Y");
            let xyz = ["X", "Y", "Z"].map(|column| (row.number(column) / y) as f32);
            (row.number("T_K"), xyz)
        })
        .filter(|(temperature_k, _)| *temperature_k <= 3000.0)
        .collect();
    assert!(bodies.len() > 8);
    bodies
}

fn xyz_of_grey(grey: f32) -> [f32; 3] {
    let white = xyz::xyz_from_rgb() * DVec3::ONE;
    (white * f64::from(grey)).as_vec3().to_array()
}

/// The steps of the channels' road after paling, by their formulae in f64, without tables.
fn exact(rgb: [f64; 3], curve: Curve) -> [f64; 3] {
    let max = |c: [f64; 3]| c[0].max(c[1]).max(c[2]);
    let luminance = |c: [f64; 3]| (0..3).map(|i| c[i] * f64::from(xyz::LUMINANCE[i])).sum();
    let bend = curve.softness() * max(rgb);
    let positive = rgb.map(|c| 0.5 * (c + (c * c + bend * bend).sqrt()));
    let (before, after): (f64, f64) = (luminance(rgb), luminance(positive));
    let rgb = positive.map(|c| c * before / after);
    let brightest = max(rgb);
    rgb.map(|c| {
        let kept = c / brightest * curve.shown(brightest, 1.0);
        let mixed = kept + (curve.shown(c, 1.0) - kept) * curve.per_channel();
        let linear = mixed + (curve.shown(brightest, 1.0) - mixed) * curve.whiteness(brightest);
        if linear <= 0.0031308 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        }
    })
}

#[test]
fn exposure_brings_its_inverse_to_display_white() {
    let baked = BakedView::new(&view(4.0, 0.0, Curve::Linear));
    for channel in baked.linear(xyz_of_grey(0.25)) {
        assert!((channel - 1.0).abs() < 1e-6);
    }
    for channel in baked.linear(xyz_of_grey(0.125)) {
        assert!((channel - 0.5).abs() < 1e-4);
    }
}

#[test]
fn adaptation_makes_the_white_grey_and_keeps_its_brightness() {
    for degree in [0.0, 0.2, 0.6, 1.0] {
        let baked = BakedView::new(&view(0.1, degree, Curve::Linear));
        let [r, g, b] = baked
            .rgb_from_xyz
            .map(|row| (0..3).map(|i| f64::from(row[i]) * EMBER[i]).sum::<f64>());
        let weights = baked.luminance.map(f64::from);
        let y = weights[0] * r + weights[1] * g + weights[2] * b;
        assert!((y - 0.1 * EMBER[1]).abs() < 1e-6, "degree {degree}: {y}");
        let spread = (r - b) / y;
        assert_eq!(spread < 1e-3, degree == 1.0, "degree {degree}: {spread}");
    }
}

#[test]
fn without_adaptation_the_white_does_not_matter() {
    let plain = BakedView::new(&view(2.0, 0.0, Curve::Photographic));
    for white_xyz in [[0.0; 3], [f64::NAN; 3], [1.0, -1.0, 0.0], [0.2, 0.5, 3.0]] {
        let other = View {
            white_xyz,
            ..view(2.0, 0.0, Curve::Photographic)
        };
        assert_eq!(BakedView::new(&other), plain);
    }
}

#[test]
fn a_white_that_is_no_light_leaves_colours_alone() {
    for white_xyz in [
        [0.0; 3],
        [f64::NAN; 3],
        [1.0, -1.0, 0.0],
        [f64::INFINITY; 3],
    ] {
        let odd = View {
            white_xyz,
            ..view(2.0, 0.6, Curve::Photographic)
        };
        let plain = view(2.0, 0.0, Curve::Photographic);
        assert_eq!(BakedView::new(&odd), BakedView::new(&plain));
    }
}

#[test]
fn black_is_black() {
    for curve in CURVES {
        let baked = BakedView::new(&view(1.0, 0.5, curve));
        assert_eq!(baked.apply([0.0; 3]), [0.0; 3]);
        assert_eq!(baked.apply([f32::NAN; 3]), [0.0; 3]);
        assert_eq!(baked.apply([-1.0, -1.0, -1.0]), [0.0; 3]);
    }
}

#[test]
fn light_beyond_single_precision_is_black_and_not_half_a_colour() {
    for curve in CURVES {
        let baked = BakedView::new(&view(1.0, 0.0, curve));
        // The red channel overflows, green does not.
        assert_eq!(baked.apply([1.8e38, 1.2e38, 0.0]), [0.0; 3]);
        assert_eq!(baked.apply([f32::INFINITY, 1.0, 1.0]), [0.0; 3]);
        assert_eq!(baked.apply([1.0, f32::NAN, 1.0]), [0.0; 3]);
    }
}

#[test]
fn black_bodies_keep_the_order_of_their_hues() {
    // At any one brightness a hotter body has more blue and green for its red.
    for degree in [0.0, 0.3, 0.6] {
        for exposure in [0.03, 0.3, 1.0, 4.0] {
            let baked = BakedView::new(&view(exposure, degree, Curve::Photographic));
            let mut last_green = -1.0;
            for (temperature_k, xyz) in black_bodies() {
                let [r, g, b] = baked.linear(xyz);
                assert!(g / r > last_green, "{temperature_k} K, exposure {exposure}");
                last_green = g / r;
                if temperature_k >= 1000.0 && degree == 0.0 {
                    assert!(r > g && g > b, "{temperature_k} K, exposure {exposure}");
                }
            }
        }
    }
}

#[test]
fn a_bright_flame_goes_from_orange_through_yellow_to_white() {
    let flame = black_bodies()
        .into_iter()
        .find(|b| b.0 == 1800.0)
        .unwrap()
        .1;
    let at = |exposure| BakedView::new(&view(exposure, 0.2, Curve::Photographic)).apply(flame);
    let [_, orange, _] = at(0.3);
    let [_, yellow, little_blue] = at(4.0);
    let [_, white, blue] = at(64.0);
    assert!((0.3..0.6).contains(&orange), "{orange}");
    assert!(yellow > 0.8 && little_blue < yellow - 0.1, "{yellow}");
    assert!(white > 0.97 && blue > 0.95, "{white} {blue}");
}

#[test]
fn plain_clipping_is_plain() {
    let baked = BakedView::new(&view(1.0, 0.0, Curve::Linear));
    let xyz = xyz::xyz_from_rgb() * DVec3::new(3.0, 0.5, 0.25);
    let [r, g, b] = baked.linear(xyz.as_vec3().to_array());
    assert_eq!(r, 1.0);
    assert!((g - 0.5).abs() < 1e-4 && (b - 0.25).abs() < 1e-4);
}

proptest! {
    #[test]
    fn anything_gives_a_colour(bits in any::<[u32; 3]>(), degree in 0.0..1.0_f64, stop in -30.0..30.0_f64) {
        for curve in CURVES {
            let baked = BakedView::new(&view(stop.exp2(), degree, curve));
            let colour = baked.apply(bits.map(f32::from_bits));
            prop_assert!(colour.iter().all(|c| (0.0..=1.0).contains(c)), "{:?}", colour);
        }
    }

    #[test]
    fn grey_stays_grey(stop in -12.0..14.0_f32) {
        for curve in CURVES {
            let baked = BakedView::new(&view(1.0, 0.0, curve));
            let [r, g, b] = baked.apply(xyz_of_grey(stop.exp2()));
            prop_assert!((r - g).abs() < 2e-6 && (g - b).abs() < 2e-6, "{} {} {}", r, g, b);
        }
    }

    #[test]
    fn more_exposure_is_never_darker(
        x in 0.0..1.0_f32, y in 0.0..1.0_f32, z in 0.0..1.0_f32, stop in -8.0..8.0_f64, more in 0.01..2.0_f64,
    ) {
        for curve in CURVES {
            let less = BakedView::new(&view(stop.exp2(), 0.3, curve)).linear([x, y, z]);
            let brighter = BakedView::new(&view((stop + more).exp2(), 0.3, curve)).linear([x, y, z]);
            // The matrix is rounded to f32 anew for each exposure.
            let darker = |a: f32, b: f32| a < b - 1e-5;
            if curve.road() == Road::Channels {
                for i in 0..3 {
                    prop_assert!(!darker(brighter[i], less[i]), "{:?} {:?}", less, brighter);
                }
            }
            // A purple that pales at its hue gives up some blue for green, and is brighter all the same.
            let [bright, dim] = [brighter, less].map(gamut::luminance);
            prop_assert!(!darker(bright, dim), "{:?}: {:?} {:?}", curve, less, brighter);
        }
    }

    #[test]
    fn tables_are_as_good_as_the_formulae(
        r in 0.0..1.0_f64, g in 0.0..1.0_f64, b in -0.05..1.0_f64, stop in -10.0..10.0_f64,
    ) {
        for curve in [Curve::Photographic, Curve::Linear] {
            let rgb = [r, g, b].map(|c| c * stop.exp2());
            let xyz = xyz::xyz_from_rgb() * DVec3::from_array(rgb);
            prop_assume!(xyz.y > 1e-4 * stop.exp2());
            let baked = BakedView::new(&view(1.0, 0.0, curve));
            let got = baked.apply(xyz.as_vec3().to_array());
            let near = curve.paling().map_or(rgb, |paling| {
                gamut::paled(rgb.map(|c| c as f32), paling, &baked.hue).map(f64::from)
            });
            for (got, expected) in got.into_iter().zip(exact(near, curve)) {
                prop_assert!((f64::from(got) - expected).abs() < 0.1 / 255.0, "{} {}", got, expected);
            }
        }
    }
}
