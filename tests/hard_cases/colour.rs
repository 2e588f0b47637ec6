//! Cases 61 to 69: colours without light, without blue, outside the display, endless and denormal.

use glam::{DMat3, DVec3};
use sootlight::colour::adaptation::{adapted, naka_rushton, von_kries};
use sootlight::colour::cie::colour_matching;
use sootlight::colour::display::{BakedView, Curve, View};
use sootlight::colour::xyz::{WHITE_XY, rgb_from_xyz, srgb_decode, srgb_encode, xyz_from_xy};
use sootlight::render::Film;
use sootlight::render::develop::{Metering, ViewParams, develop};
use sootlight::scene::WavelengthSet;

use super::{assert_close, even, planck};

/// XYZ to the responses of the cones, Hunt–Pointer–Estévez for D65, as printed to four decimals.
const M: DMat3 = DMat3::from_cols(
    DVec3::new(0.4002, -0.2263, 0.0),
    DVec3::new(0.7076, 1.1653, 0.0),
    DVec3::new(-0.0808, 0.0457, 0.9182),
);

/// A black body of 1900 K (tests/golden/cie_integrals.csv).
const WHITE: [f64; 3] = [4.3314803999933997, 3.3119925823398789, 0.41094020467204158];

/// A black body of 800 K.
const EMBER: [f64; 3] = [
    2.3753457484668861e-07,
    1.1084089268425428e-07,
    2.5601004278268411e-10,
];

/// Sum over the 1 nm table of the observer.
fn xyz_of(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let rows = (360..=830).map(f64::from);
    rows.map(|nm| spectrum(nm) * DVec3::from_array(colour_matching(nm)))
        .sum()
}

fn view(curve: Curve, white_xyz: [f64; 3], adaptation: f64) -> View {
    View {
        exposure: 1.0,
        adaptation,
        white_xyz,
        curve,
        half_saturation: 0.5,
        false_colour: false,
    }
}

/// What the display is sent for a colour, by every curve and degree.
#[track_caller]
fn assert_shown(xyz: [f32; 3], white_xyz: [f64; 3]) {
    for curve in Curve::ALL {
        for degree in [0.0, 0.5, 1.0] {
            let shown = BakedView::new(&view(curve, white_xyz, degree)).apply(xyz);
            let what = format!("{xyz:?} by {curve:?} at {degree}: {shown:?}");
            assert!(shown.iter().all(|v| (0.0..=1.0).contains(v)), "{what}");
        }
    }
}

#[test]
fn case_61_an_all_black_picture_is_black_and_no_nan() {
    for degree in [0.5, 1.0] {
        assert_eq!(adapted([0.0; 3], [0.0; 3], degree), DVec3::ZERO);
        assert_eq!(adapted(WHITE, [0.0; 3], degree), DVec3::ZERO);
        assert_eq!(von_kries([0.0; 3], degree), DMat3::ZERO);
    }
    let film = Film::new([4, 4]);
    let metering = Metering::of(&film);
    for curve in Curve::ALL {
        let params = ViewParams {
            exposure_ev: 0.0,
            display_white_cd_m2: None,
            adaptation: 1.0,
            white_k: None,
            white_xy: None,
            curve,
            half_saturation_cd_m2: None,
            false_colour: false,
        };
        let baked = BakedView::new(&metering.view(&params));
        assert!(
            develop(&film, &baked).iter().all(|rgb| *rgb == [0.0; 3]),
            "{curve:?}"
        );
    }
}

#[test]
fn case_62_a_white_without_blue_does_not_amplify_its_noise() {
    let lms = M * DVec3::from_array(EMBER);
    assert_close(lms.z / lms.x, 1.4e-3, 0.1, "s/l at 800 K");
    // Floored at a hundredth of l: noise is amplified 100/l times, not 700/l times.
    let noise = [0.0, 0.0, 1e-12];
    let seen = (M * adapted(noise, EMBER, 1.0)).z;
    assert_close(seen, 0.9182e-12 / (0.01 * lms.x), 1e-12, "s");
    // 1200 K has more than that, and keeps it.
    let warm = [
        3.2475036570779247e-03,
        1.9091570583869114e-03,
        3.8972488552121449e-05,
    ];
    let lms = M * DVec3::from_array(warm);
    assert!(lms.z / lms.x > 0.01);
    let white = M * adapted(warm, warm, 1.0);
    assert!((white - 1.0).abs().max_element() < 1e-12, "{white}");
    // Neither without any blue.
    let red = adapted([1.0, 0.5, 0.0], [1.0, 0.5, 0.0], 1.0);
    assert!(red.is_finite() && (M * red).z == 0.0, "{red}");
    assert_shown([1.0, 0.5, 1e-6], EMBER);
}

#[test]
fn case_63_the_white_lands_on_the_white_of_four_decimals() {
    let expected = DVec3::new(0.9504848375, 1.000020104, 1.089087345);
    for white in [WHITE, EMBER.map(|v| v * 1e7), [1.0, 1.0, 1.0]] {
        let response = M * DVec3::from_array(white);
        if response.z < 0.01 * response.x {
            continue;
        }
        for got in [
            adapted(white, white, 1.0),
            von_kries(white, 1.0) * DVec3::from_array(white),
            M.inverse() * DVec3::ONE,
        ] {
            let error = (got / expected - 1.0).abs().max_element();
            assert!(error < 5e-10, "{got}: off by {error:e}");
        }
    }
    assert_close(adapted(WHITE, WHITE, 1.0).y - 1.0, 2.0e-5, 0.01, "Y − 1");
}

#[test]
fn case_64_responses_below_zero_are_clamped_after_adaptation_and_not_before() {
    // Physical light, deep red alone too, has m above 0 wherever the eye sees anything of it.
    for nm in (390..=830).map(f64::from) {
        let response = M * DVec3::from_array(colour_matching(nm));
        assert!(response.y > 0.0, "{nm} nm: m = {:e}", response.y);
    }
    // What no light is goes through linearly: adapting a sum is summing what is adapted.
    let (no_light, light) = ([1.0, 0.0, 0.0], [0.5, 0.6, 0.1]);
    let one = adapted(no_light, WHITE, 1.0);
    assert!(one.is_finite() && (M * one).y < 0.0);
    let sum = adapted([1.5, 0.6, 0.1], WHITE, 1.0);
    let error = (sum - one - adapted(light, WHITE, 1.0)).abs().max_element();
    assert!(
        error < 8.0 * f64::EPSILON * sum.abs().max_element(),
        "{error:e}"
    );
    for colour in [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.5, 0.2],
        [0.1, 0.2, -3.0],
    ] {
        assert_shown(colour, WHITE);
    }
}

#[test]
fn case_65_naka_rushton_has_all_of_its_limits() {
    assert_eq!(naka_rushton(0.0, 0.0), 0.0);
    assert_eq!(naka_rushton(0.0, 1.0), 0.0);
    for luminance in [5e-324, 1.0, f64::MAX, f64::INFINITY] {
        assert_eq!(naka_rushton(luminance, 0.0), 1.0);
    }
    assert_eq!(naka_rushton(f64::INFINITY, 1.0), 1.0);
    assert_eq!(naka_rushton(f64::INFINITY, f64::MAX), 1.0);
    assert_eq!(naka_rushton(1e308, 1e308), 0.5);
    assert_eq!(naka_rushton(5e-324, 5e-324), 0.5);
    // The display's f32: the largest light is shown as full, and what is no number is black.
    let eye = BakedView::new(&view(Curve::Eye, [0.0; 3], 0.0));
    let white = xyz_from_xy(WHITE_XY);
    let shown = |scale: f64| eye.linear((white * scale).as_vec3().to_array())[1];
    assert_eq!(shown(0.0), 0.0);
    assert_close(f64::from(shown(0.5)), 0.5, 1e-3, "at the half-saturation");
    assert!(shown(1e30) > 0.9999 && shown(1e30) <= 1.0);
    assert_eq!(eye.linear([f32::INFINITY; 3]), [0.0; 3]);
    assert_eq!(eye.linear([f32::NAN; 3]), [0.0; 3]);
}

#[test]
fn case_66_cool_black_bodies_outside_the_display_are_brought_inside() {
    let rgb = |kelvin: f64| rgb_from_xyz() * xyz_of(|nm| planck(nm, kelvin));
    for kelvin in [800.0, 1000.0, 1500.0, 1900.0] {
        assert!(rgb(kelvin).z < 0.0, "{kelvin} K: {}", rgb(kelvin));
    }
    assert!(rgb(2000.0).min_element() > 0.0);
    assert!(rgb(800.0).y < 0.0 && rgb(1000.0).y > 0.0);
    for kelvin in [800.0, 900.0, 1000.0, 1500.0, 1900.0, 2000.0] {
        let xyz = xyz_of(|nm| planck(nm, kelvin));
        let scaled = (xyz / xyz.y * 0.3).as_vec3().to_array();
        assert_shown(scaled, [0.0; 3]);
        assert_shown(scaled, xyz.to_array());
        for curve in Curve::ALL {
            let [r, g, b] = BakedView::new(&view(curve, [0.0; 3], 0.0)).apply(scaled);
            // At 800 K green lies further outside than blue.
            assert!(
                r > g.max(b) && (g >= b || kelvin < 1000.0),
                "{kelvin} K by {curve:?}: {r} {g} {b}"
            );
        }
    }
}

#[test]
fn case_67_the_transfer_function_has_no_gap_and_no_nan() {
    let seam = 0.0031308_f32;
    let gap = f64::from(srgb_encode(seam)) - f64::from(srgb_encode(seam.next_up()));
    assert!(gap.abs() <= 3e-8, "{gap:e}");
    assert_eq!(srgb_encode(f32::NAN), 0.0);
    assert_eq!(srgb_decode(f32::NAN), 0.0);
    assert_eq!([-1.0, f32::NEG_INFINITY, -0.0].map(srgb_encode), [0.0; 3]);
    assert_eq!([1.0, 2.0, f32::INFINITY].map(srgb_encode), [1.0; 3]);
    // One bad channel makes no light of the pixel: half a colour would be a wrong one.
    for xyz in [
        [f32::NAN, 1.0, 1.0],
        [1.0, f32::INFINITY, 1.0],
        [f32::MAX, f32::MAX, f32::MAX],
    ] {
        assert_shown(xyz, WHITE);
    }
    let plain = BakedView::new(&view(Curve::Linear, [0.0; 3], 0.0));
    assert_eq!(plain.apply([f32::NAN, 1.0, 1.0]), [0.0; 3]);
}

#[test]
fn case_68_an_even_spectrum_weighs_the_same_in_x_y_and_z() {
    let sums = xyz_of(|_| 1.0);
    let stated = DVec3::new(106.86547, 106.85692, 106.89225);
    // All five decimals of the sums.
    assert!((sums - stated).abs().max_element() < 1e-5, "{sums}");
    let expected = DVec3::new(1.000080, 1.0, 1.000331);
    let law = even(1e-6, 1500.0).flame.soot();
    for set in WavelengthSet::ALL {
        let WavelengthSet::Plain(_) = set else {
            // Fitted to spectra of soot; an even one is none of these.
            continue;
        };
        let weights = set.wavelengths(law);
        let xyz = DVec3::from_array(weights.xyz_of(weights.nodes_nm.iter().map(|_| 1.0)));
        let error = (xyz / 106.85692 - expected).abs().max_element();
        assert!(error < 4e-4, "{set:?}: {xyz}, off by {error:e}");
    }
}

#[test]
fn case_69_adaptation_does_not_know_the_scale() {
    let colour = [1.5801411593805486, 1.0605568228861127, 0.057087148816693976];
    // tests/golden/adaptation.csv, "denormal scale".
    let expected = DVec3::new(
        0.32117505710103725,
        0.31728246958334400,
        0.15129425308210573,
    );
    for scale in [1.0, 1e-310, 1e300, 1e-300] {
        let [xyz, white] = [colour, WHITE].map(|triple| triple.map(|v| v * scale));
        let got = adapted(xyz, white, 1.0);
        // A denormal of 4e-312 has 1e-12 of itself in its last digit.
        let tolerance = if scale == 1e-310 { 1e-11 } else { 1e-12 };
        let error = (got / expected - 1.0).abs().max_element();
        assert!(error < tolerance, "{scale:e}: {got}, off by {error:e}");
    }
    let [plain, denormal, huge] = [1.0, 1e-310, 1e300].map(|scale| {
        let white = WHITE.map(|v| v * scale);
        BakedView::new(&view(Curve::Photographic, white, 1.0)).apply([0.3, 0.2, 0.05])
    });
    for c in 0..3 {
        assert!((plain[c] - denormal[c]).abs() < 1e-6 && (plain[c] - huge[c]).abs() < 1e-6);
    }
}
