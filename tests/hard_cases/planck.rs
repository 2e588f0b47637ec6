//! Cases 1 to 8: Planck's law where its exponential overflows, vanishes or cancels.

use sootlight::math::lanes;
use sootlight::physics::blackbody::{FIRST_RADIATION_CONSTANT, SECOND_RADIATION_CONSTANT_NM_K};
use sootlight::physics::constants::{BOLTZMANN_J_PER_K, LIGHT_SPEED_M_PER_S, PLANCK_J_S};
use sootlight::physics::soot::SootModel;
use sootlight::project::{Project, ProjectError};
use sootlight::render::{Effects, Plan, Prober, Switch};
use sootlight::scene::WavelengthSet;
use sootlight::scene::curves::{Bands, BandsError};

use super::super::common;
use super::{
    EPSILON_32, LENGTH_M, RGB_NM, assert_close, even, even_with, exponent, fraction_of_depth,
    march, planck, planck_of_the_march, planck_tolerance, refusal, scene_of, three,
};

/// c₁ e^{−x}/λ⁵ with a power of two taken out, so that no factor leaves the range: for x from about 690 to 780.
fn by_wien(lambda_nm: f64, x: f64) -> f64 {
    let scale = FIRST_RADIATION_CONSTANT / lambda_nm.powi(5);
    scale * (1000.0 * std::f64::consts::LN_2 - x).exp() * 2.0_f64.powi(-1000)
}

#[test]
fn case_01_planck_overflows_to_zero() {
    // x = 1868.54; the true value is 3.79e-793.
    assert_eq!(planck(100.0, 77.0), 0.0);
    assert_eq!(planck_of_the_march(77.0, [100.0, 450.0, 650.0]), [0.0; 3]);
    // Where e^{−x} is denormal the radiance keeps its digits: at 1 nm it is still a normal number.
    for x in [709.0, 710.0, 744.0] {
        let kelvin = SECOND_RADIATION_CONSTANT_NM_K / x;
        let tolerance = planck_tolerance(1.0, kelvin, f64::EPSILON);
        assert_close(
            planck(1.0, kelvin),
            by_wien(1.0, x),
            tolerance,
            &format!("x = {x}"),
        );
    }
    // Past 745 e^{−x} itself is 0; two halves reach 761.
    for lambda_nm in [1.0, 100.0] {
        let kelvin = SECOND_RADIATION_CONSTANT_NM_K / (761.0 * lambda_nm);
        let (got, expected) = (planck(lambda_nm, kelvin), by_wien(lambda_nm, 761.0));
        let denormal = 8.0 * f64::from_bits(1);
        assert!(got > 0.0 && (got - expected).abs() <= 1600.0 * f64::EPSILON * expected + denormal);
    }
}

#[test]
fn case_02_planck_in_single_precision_gives_zero_and_not_infinity_over_infinity() {
    // e^{x} overflows past 88.72, so the march takes e^{−x}: 0 there, and in the f64 law what it is.
    for x in [88.72_f32, 88.73, 104.0, 1e4, f32::INFINITY] {
        assert_eq!(lanes::exp(-x), 0.0, "{x}");
    }
    assert!(exponent(450.0, 360.0) > 88.72);
    for kelvin in [360.0, 300.0, 77.0, 3.0] {
        let seen = planck_of_the_march(kelvin, [450.0, 440.0, 400.0]);
        assert_eq!(seen, [0.0; 3], "{kelvin} K");
    }
    let rounded = planck(450.0, 360.0) as f32;
    assert!(rounded > 0.0 && rounded.is_normal());
    // x = 86.9: the last that f32 has.
    let seen = planck_of_the_march(368.0, [450.0; 3])[0];
    assert_close(
        seen,
        planck(450.0, 368.0),
        planck_tolerance(450.0, 368.0, EPSILON_32),
        "368 K",
    );
}

#[test]
fn case_03_no_heat_is_no_light_and_what_is_no_temperature_is_refused() {
    for lambda_nm in [100.0, 450.0, 1e6] {
        assert_eq!(planck(lambda_nm, 0.0), 0.0);
        assert_eq!(planck(lambda_nm, 1e-3), 0.0);
    }
    for kelvin in [0.0, 1e-3] {
        assert_eq!(planck_of_the_march(kelvin, RGB_NM), [0.0; 3], "{kelvin} K");
    }
    for (bad, key) in [
        (
            "volume.temperature.min=-1",
            "volume.temperature.min is -1: it must lie between 0 and 100000",
        ),
        (
            "volume.temperature.max=inf",
            "volume.temperature.max is inf",
        ),
        (
            "volume.temperature.max=nan",
            "volume.temperature.max is NaN",
        ),
    ] {
        let error = refusal(&[bad]);
        assert!(
            matches!(error, ProjectError::FieldRange { .. }),
            "{error:?}"
        );
        assert!(error.to_string().starts_with(key), "{error}");
    }
    for bad in ["-1", "inf", "nan"] {
        let error = refusal(&[&format!("air.temperature_k={bad}")]);
        assert!(
            matches!(
                error,
                ProjectError::Range {
                    key: "air.temperature_k",
                    ..
                }
            ),
            "{error}"
        );
    }
    // A file's own voxels: NaN and infinity are read as no soot's temperature, what is below zero as zero.
    for kelvin in [-5.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let volume = common::slab(1, LENGTH_M, |_| 1e-5, |_| kelvin);
        let seen = march(&scene_of(volume, &[]), 1.0, RGB_NM);
        assert_eq!(seen.radiance, [0.0; 3], "{kelvin} K");
    }
}

#[test]
fn case_04_at_small_x_planck_keeps_its_digits() {
    let (lambda_nm, kelvin) = (1e6, 1e7);
    let x = exponent(lambda_nm, kelvin);
    let jeans =
        FIRST_RADIATION_CONSTANT / SECOND_RADIATION_CONSTANT_NM_K * kelvin / lambda_nm.powi(4);
    let limit = jeans * (1.0 - x / 2.0 + x * x / 12.0);
    assert_close(
        planck(lambda_nm, kelvin),
        limit,
        planck_tolerance(lambda_nm, kelvin, f64::EPSILON),
        "f64",
    );
    let single = f64::from(lanes::exp_m1(-(x as f32)));
    assert_close(
        single,
        (-f64::from(x as f32)).exp_m1(),
        3e-7,
        "the march's e^x − 1",
    );
    // The hottest that a field may be, in visible light and in the far infrared, where x is 1.4e-4.
    for lambda_nm in [780.0, 1e4, 1e6] {
        let seen = planck_of_the_march(1e5, [lambda_nm; 3])[0];
        let tolerance = planck_tolerance(lambda_nm, 1e5, EPSILON_32);
        assert_close(
            seen,
            planck(lambda_nm, 1e5),
            tolerance,
            &format!("{lambda_nm} nm"),
        );
    }
}

#[test]
fn case_05_planck_errs_by_no_more_than_its_condition() {
    // Fifty-digit arithmetic, W m⁻² sr⁻¹ nm⁻¹, from tests/golden/planck.csv.
    for (kelvin, lambda_nm, expected) in [
        (300.0, 450.0, 3.345553116754791e-40),
        (300.0, 650.0, 9.281631238354115e-27),
        (1500.0, 450.0, 0.003570964031584215),
        (1500.0, 550.0, 0.06311607034705652),
        (1500.0, 650.0, 0.4005101710742754),
        (77.0, 450.0, 3.000195396236521e-174),
    ] {
        let tolerance = planck_tolerance(lambda_nm, kelvin, f64::EPSILON);
        let what = format!("{lambda_nm} nm, {kelvin} K");
        assert_close(planck(lambda_nm, kelvin), expected, tolerance, &what);
        // A last digit of T is x of B, no less.
        let x = exponent(lambda_nm, kelvin);
        let moved = planck(lambda_nm, kelvin * (1.0 + 1e-9)) / expected - 1.0;
        assert_close(
            moved,
            1e-9 * x / -(-x).exp_m1(),
            1e-4,
            &format!("{what}: d ln B/d ln T"),
        );
    }
    for kelvin in [600.0, 1000.0, 1500.0, 1800.0, 2400.0, 6000.0, 1e5] {
        let nodes_nm = [700.0, 550.0, 400.0];
        for (seen, nm) in planck_of_the_march(kelvin, nodes_nm)
            .into_iter()
            .zip(nodes_nm)
        {
            let tolerance = planck_tolerance(nm, kelvin, EPSILON_32);
            assert_close(
                seen,
                planck(nm, kelvin),
                tolerance,
                &format!("march, {nm} nm, {kelvin} K"),
            );
        }
    }
}

#[test]
fn case_06_constants_for_nanometres_stay_in_range() {
    // In SI units λ⁵ is 1e-35 and h k is no f32 at all.
    assert_eq!(PLANCK_J_S as f32 * BOLTZMANN_J_PER_K as f32, 0.0);
    let scene = even(1e-6, 1e4);
    let plan = Plan::with_wavelengths(&scene, [64, 64], three([100.0, 550.0, 1e6]));
    for (node, nm) in plan
        .tables
        .nodes
        .iter()
        .zip(&plan.tables.wavelengths.nodes_nm)
    {
        assert!(node.planck_scale.is_normal() && node.planck_exponent_k.is_normal());
        let scale = 1.1910429723971884e20 / nm.powi(5);
        assert_close(f64::from(node.planck_scale), scale, EPSILON_32, "2hc²/λ⁵");
        let exponent_k = 1.4387768775039338e7 / nm;
        assert_close(
            f64::from(node.planck_exponent_k),
            exponent_k,
            EPSILON_32,
            "hc/λk",
        );
    }
    for (lambda_nm, kelvin) in [(100.0, 1e4), (550.0, 1800.0), (1e6, 300.0)] {
        let lambda_m = lambda_nm * 1e-9;
        let energy = PLANCK_J_S * LIGHT_SPEED_M_PER_S / lambda_m;
        let x = energy / (BOLTZMANN_J_PER_K * kelvin);
        let si = 2.0 * energy * LIGHT_SPEED_M_PER_S / lambda_m.powi(4) / x.exp_m1();
        let tolerance = planck_tolerance(lambda_nm, kelvin, f64::EPSILON);
        assert_close(
            planck(lambda_nm, kelvin),
            1e-9 * si,
            tolerance,
            "in SI units",
        );
        let seen = planck_of_the_march(kelvin, [lambda_nm; 3])[0];
        let tolerance = planck_tolerance(lambda_nm, kelvin, EPSILON_32);
        assert_close(seen, 1e-9 * si, tolerance, "march");
    }
}

/// No wavelength enters the march but through sets that the program makes itself; a person gives wavelengths to the
/// command `spectrum` alone. The law states that it takes none, and tests of debug builds are stopped by it.
#[test]
fn case_07_a_wavelength_of_zero_is_refused() {
    for range_nm in [
        [0.0, 780.0],
        [-1.0, 780.0],
        [f64::NAN, 780.0],
        [380.0, f64::NAN],
    ] {
        let error = Bands::new(range_nm, 1.0).unwrap_err();
        assert!(matches!(error, BandsError::Range { .. }), "{error:?}");
        assert!(error.to_string().contains("from 230 nm on"), "{error}");
    }
    assert_eq!(
        Bands::new([0.0, 0.0], 1.0).unwrap_err().to_string(),
        "the range is 0-0 nm: it must rise, from 230 nm on and up to 1000000 nm"
    );
    for count in [0, 1, 5, 128] {
        let words = WavelengthSet::try_from(count).unwrap_err();
        assert!(words.contains("choose 4, 6 or 8"), "{words}");
    }
    for set in WavelengthSet::ALL {
        let nodes = set
            .wavelengths(Project::default().fuel.name.soot_law(SootModel::default()))
            .nodes_nm;
        assert!(
            nodes.iter().all(|nm| (380.0..=780.0).contains(nm)),
            "{set:?}"
        );
    }
    if cfg!(debug_assertions) {
        assert!(std::panic::catch_unwind(|| planck(0.0, 1500.0)).is_err());
    }
}

/// Along a ray L/n² is conserved, so the march carries that, with vacuum wavelengths, and n drops out: hot gas of any n
/// looks like a black body in vacuum. The report's c₀/n is not offered; what it would be wrong by is worked out here.
#[test]
fn case_08_the_index_of_the_medium_drops_out() {
    // Equation 3.5 with c = c₀/n, fed with a vacuum wavelength, is n B(nλ)·n² in terms of B in vacuum.
    let (n, lambda_nm, kelvin) = (1.0003_f64, 450.0, 1500.0);
    let as_printed = n.powi(3) * planck(n * lambda_nm, kelvin);
    let in_medium = n * n * planck(lambda_nm, kelvin);
    // tests/golden/planck.csv: B in the medium, and the ratio.
    assert_close(
        in_medium,
        0.0035731069313899282,
        planck_tolerance(lambda_nm, kelvin, f64::EPSILON),
        "n² B",
    );
    assert_close(
        as_printed / in_medium,
        1.0052063321631956,
        1e-13,
        "as printed",
    );
    let x = exponent(lambda_nm, kelvin);
    let stated = n.powi(-4) * (x * (1.0 - 1.0 / n)).exp();
    assert_close(as_printed / in_medium, stated, 1e-8, "n⁻⁴ e^{x(1 − 1/n)}");

    // n − 1 is 5e-5 here, twenty times that by the gain: n² would show as 2e-3.
    let fraction = fraction_of_depth(100.0, 650.0);
    let hot = even_with(
        fraction,
        1500.0,
        &["effects.refraction=on", "air.refraction_gain=20"],
    );
    let bent = Effects {
        refraction: Switch::On,
        ..common::scattered_alone(Switch::Off)
    };
    let probe = Prober::new(&hot, [64, 64], bent)
        .read([32.0, 32.0])
        .unwrap();
    for [nm, radiance] in probe.spectrum {
        let tolerance = planck_tolerance(nm, 1500.0, EPSILON_32);
        assert_close(radiance, planck(nm, 1500.0), tolerance, &format!("{nm} nm"));
    }
}
