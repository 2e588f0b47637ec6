//! Cases 30 to 35: lines that are cold, endlessly hot, on a border, outside, crowded or thick.

use sootlight::colour::cie;
use sootlight::math::lanes;
use sootlight::physics::growth::curve_of_growth;
use sootlight::physics::lines::{self, ATMOSPHERE_PA, Line};
use sootlight::render::Plan;
use sootlight::render::march::Marcher;
use sootlight::scene::glow::Spread;
use sootlight::scene::{Air, Fuel, Glow, GlowParams, Optics, Salt, Scene};
use sootlight::spectral::Wavelengths;

use super::super::common;
use super::{EPSILON_32, LENGTH_M, assert_close, even_with, exponent, planck, scene_of, unbounded};

fn all() -> impl Iterator<Item = &'static Line> {
    [
        lines::LITHIUM,
        lines::SODIUM,
        lines::POTASSIUM,
        lines::CALCIUM,
        lines::STRONTIUM,
        lines::BARIUM,
        lines::COPPER,
    ]
    .into_iter()
    .flatten()
}

/// What glows in propane's gas with so much of a salt.
fn glow(salt: &str, ppm: f64) -> Glow {
    let params = GlowParams {
        salt: Salt::named(salt).unwrap(),
        salt_ppm: ppm,
        ..GlowParams::default()
    };
    Glow::new(&params, Fuel::default(), &Air::default())
}

/// X, Y and Z of what the gas of a slab gives by the march, without soot's own wavelengths.
fn marched(scene: &Scene) -> [f64; 3] {
    let none = Wavelengths {
        nodes_nm: Vec::new(),
        xyz: Vec::new(),
        opacity: Vec::new(),
    };
    let plan = Plan::with_wavelengths(scene, [64, 64], none);
    let marcher = Marcher::new(scene, &plan, 64.0).unwrap();
    let mut points = [None; 16];
    points[5] = Some([32.0, 32.0]);
    marcher.march(&points).0[5].xyz.map(f64::from)
}

/// A slab of sodium of so many parts in a million in gas of this temperature, K.
fn sodium(ppm: f64, kelvin: f64) -> Scene {
    even_with(
        0.0,
        kelvin,
        &["fuel.salt=sodium", &format!("fuel.salt_ppm={ppm}")],
    )
}

/// Half of the optical depth in the middle of a line over the slab: y of its curve of growth.
fn depth(scene: &Scene, line: &Line, ppm: f64, kelvin: f64) -> f64 {
    let share = scene.flame.glow().vapour_share(kelvin);
    let atoms = lines::number_density(1e-6 * ppm * share, ATMOSPHERE_PA, kelvin);
    let width_m = std::f64::consts::TAU * line.half_width_m();
    atoms * line.area_per_atom(kelvin) * LENGTH_M / width_m
}

#[test]
fn case_30_a_cold_line_absorbs_and_does_not_glow() {
    for line in all().filter(|line| line.lower_per_cm == 0.0) {
        // σ = N g₁/Q (g₂/g₁) A λ⁴/(8πc), integrated over the line.
        let lambda_m = 1e-9 * line.lambda_nm;
        let limit = line.degeneracies[1] / line.partition * line.rate_per_s * lambda_m.powi(4)
            / (8.0 * std::f64::consts::PI * 299_792_458.0);
        for kelvin in [0.0, 1e-3, 1.0, 20.0] {
            assert_close(line.area_per_atom(kelvin), limit, 8.0 * f64::EPSILON, "S/N");
            assert_eq!(
                line.area_per_atom(kelvin) * planck(line.lambda_nm, kelvin),
                0.0
            );
        }
    }
    // From an excited level nothing absorbs in the cold.
    for line in all().filter(|line| line.lower_per_cm > 0.0) {
        assert_eq!(
            [0.0, 1.0].map(|kelvin| line.area_per_atom(kelvin)),
            [0.0; 2]
        );
    }
    for kelvin in [0.0, 1.0, 77.0, 300.0] {
        assert_eq!(marched(&sodium(1e5, kelvin)), [0.0; 3], "{kelvin} K");
    }
}

#[test]
fn case_31_at_endless_heat_absorption_goes_to_zero_as_x() {
    for line in all() {
        for kelvin in [1e13, 1e15, 1e20] {
            let x = exponent(line.lambda_nm, kelvin);
            let linear = line.cold_area_per_atom() * x;
            // The next terms are x/2 and that of the lower level.
            let next = x + line.lower_k() / kelvin;
            let area = line.area_per_atom(kelvin);
            assert_close(area, linear, next + 8.0 * f64::EPSILON, "σ → x");
        }
        assert_eq!(line.area_per_atom(f64::INFINITY), 0.0);
    }
    // The march's form of it: one over (1 + 1/(e^x − 1)).
    for x in [1e-30_f32, 1e-12, 1e-6, 1e-3] {
        let got = f64::from(1.0 / (1.0 + lanes::inverse_exp_m1(x)));
        assert_close(
            got,
            -(-f64::from(x)).exp_m1(),
            4.0 * EPSILON_32,
            "1 − e^{−x}",
        );
    }
    // The hottest that a field may be: x = 0.24 at the D lines, thin.
    let (ppm, kelvin) = (1e-3, 1e5);
    let scene = sodium(ppm, kelvin);
    let mut expected = [0.0; 3];
    for line in lines::SODIUM {
        let width_nm = 1e9 * std::f64::consts::TAU * line.half_width_m();
        let light = planck(line.lambda_nm, kelvin)
            * width_nm
            * curve_of_growth(depth(&scene, line, ppm, kelvin));
        let bar = cie::colour_matching(line.lambda_nm);
        expected = std::array::from_fn(|c| expected[c] + light * bar[c]);
    }
    assert_close(marched(&scene)[1], expected[1], 1e-5, "sodium at 1e5 K");
}

#[test]
fn case_32_a_line_on_the_edge_of_a_bin_is_counted_once() {
    let bins: Vec<[f64; 2]> = (0..80)
        .map(|i| 380.0 + 5.0 * f64::from(i))
        .map(|from| [from, from + 5.0])
        .collect();
    for nm in [590.0, 380.0, 775.0] {
        let holding = bins.iter().filter(|bin| lines::is_in_bin(nm, **bin));
        assert_eq!(holding.count(), 1, "{nm} nm");
        let shares: f64 = bins.iter().map(|&bin| Spread::Line(nm).share_in(bin)).sum();
        assert_eq!(shares, 1.0, "{nm} nm");
    }
    assert!(lines::is_in_bin(590.0, [590.0, 595.0]) && !lines::is_in_bin(590.0, [585.0, 590.0]));
    // Bins that begin and end on the very D line: the sum over all is S, whichever holds it.
    let gas = glow("sodium", 1e-3);
    let line = lines::SODIUM[0];
    let share = gas.vapour_share(2000.0);
    let atoms = lines::number_density(1e-9 * share, ATMOSPHERE_PA, 2000.0);
    let all: f64 = lines::SODIUM
        .iter()
        .map(|line| atoms * line.area_per_atom(2000.0))
        .sum();
    for shift in [0.0, 1.0, 2.5] {
        let first = line.lambda_nm - 200.0 + shift;
        let sum: f64 = (0..80)
            .map(|i| first + 5.0 * f64::from(i))
            .map(|from| 5e-9 * gas.coefficients([from, from + 5.0], 2000.0, 0.0).absorption)
            .sum();
        assert_close(sum, all, 1e-14, "Σ over bins");
    }
}

#[test]
fn case_33_a_line_outside_the_grid_gives_nothing_and_is_reported() {
    let gas = glow("potassium", 1.0);
    // Vacuum wavelengths of what air has at 766.5 and 769.9 nm.
    assert_eq!(gas.lines_outside([400.0, 700.0]), [766.70090, 770.10837]);
    assert_eq!(gas.lines_outside([400.0, 780.0]), [0.0; 0]);
    let optics = Optics::new(&{
        let volume = std::sync::Arc::new(common::slab(1, LENGTH_M, |_| 0.0, |_| 2000.0));
        let asked = ["fuel.salt=potassium", "fuel.salt_ppm=1"];
        unbounded(&asked).job(&volume).unwrap().flame
    });
    assert_eq!(optics.lines_outside([400.0, 700.0]), [766.70090, 770.10837]);
    for bin in 0..60 {
        let from = 400.0 + 5.0 * f64::from(bin);
        let absorption = gas.coefficients([from, from + 5.0], 2000.0, 0.0).absorption;
        // 404.5 nm is in the grid.
        assert_eq!(absorption > 0.0, from == 400.0, "{from} nm");
    }
}

#[test]
fn case_34_two_lines_in_a_bin_add_and_saturate() {
    let gas = glow("sodium", 1e-6);
    let share = gas.vapour_share(2000.0);
    let atoms = lines::number_density(1e-12 * share, ATMOSPHERE_PA, 2000.0);
    let areas = lines::SODIUM
        .iter()
        .map(|line| atoms * line.area_per_atom(2000.0));
    let bin = gas.coefficients([588.0, 593.0], 2000.0, 0.0).absorption * 5e-9;
    assert_close(bin, areas.sum(), 1e-14, "S(D₁) + S(D₂)");
    // tests/golden/line_curve_of_growth.csv, where y is the file's x; 100 is 7.97 % of the thin value.
    for (y, thin_factor) in [
        (1e-6, 9.9999950000025000e-01),
        (0.1, 9.5239937259111042e-01),
        (1.0, 6.7367002294334889e-01),
        (10.0, 2.4909601854788413e-01),
        (100.0, 7.9688532324226935e-02),
        (1e6, 7.9788446106727656e-04),
    ] {
        assert_close(
            curve_of_growth(y) / y,
            thin_factor,
            1e-12,
            &format!("y = {y}"),
        );
    }
}

#[test]
fn case_35_a_line_that_is_thick_in_its_middle_is_not_its_bins_mean() {
    let kelvin = 2000.0;
    for (ppm, tolerance) in [
        (1e-4, 5e-5),
        (0.03, 5e-5),
        (0.3, 5e-5),
        (30.0, 5e-5),
        (1e4, 5e-5),
    ] {
        let scene = sodium(ppm, kelvin);
        let (mut thin, mut grown, mut deepest) = (0.0, 0.0, 0.0_f64);
        for line in lines::SODIUM {
            let y = depth(&scene, line, ppm, kelvin);
            let width_nm = 1e9 * std::f64::consts::TAU * line.half_width_m();
            let light =
                planck(line.lambda_nm, kelvin) * width_nm * cie::colour_matching(line.lambda_nm)[1];
            thin += light * y;
            grown += light * curve_of_growth(y);
            deepest = deepest.max(2.0 * y);
        }
        // f32: Planck's x of 12, and 1e-6 of the fit to the curve.
        assert_close(marched(&scene)[1], grown, tolerance, &format!("{ppm} ppm"));
        if ppm == 0.3 {
            // The bin's mean depth is small, the line's middle is black: the mean would be so much too bright.
            let bin = scene.flame.glow().coefficients([587.5, 592.5], kelvin, 0.0);
            assert!(
                bin.absorption * LENGTH_M < 0.5 && deepest > 30.0,
                "{deepest}"
            );
            assert!(thin / grown > 3.0, "{}", thin / grown);
        }
    }
    // Split into many voxels and steps it stays the same.
    let many = common::slab(40, LENGTH_M, |_| 0.0, |_| kelvin);
    let many = scene_of(many, &["fuel.salt=sodium", "fuel.salt_ppm=30"]);
    assert_close(
        marched(&many)[1],
        marched(&sodium(30.0, kelvin))[1],
        1e-5,
        "many voxels",
    );
}
