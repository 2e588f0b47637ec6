//! Tests of the optics of soot.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

use super::super::golden_csv::Table;
use super::*;
use proptest::prelude::*;

const ABSORPTION_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/soot_absorption.csv"
));
const MIE_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/soot_mie.csv"
));
const GLASS: ComplexIndex = ComplexIndex { n: 1.5, k: 0.0 };

fn law(model: SootModel, fuel_index: SootIndex) -> SootLaw {
    SootLaw { model, fuel_index }
}

fn assert_close(got: f64, expected: f64, what: &str) {
    assert!(
        (got / expected - 1.0).abs() < 1e-14,
        "{what}: {got:e}, expected {expected:e}"
    );
}

#[test]
fn absorption_and_scattering_agree_with_fifty_digit_arithmetic() {
    for row in Table::parse(ABSORPTION_CSV).rows() {
        let fuel = match row.text("fuel") {
            "propane" => SootIndex::Propane,
            "acetylene" => SootIndex::Acetylene,
            other => panic!("{other}"),
        };
        let soot = law(SootModel::DalzellSarofim, fuel);
        let (lambda_nm, f_v) = (row.number("lambda_nm"), row.number("f_v"));
        let radius_m = row.number("R_nm") * METRES_PER_NM;
        let index = soot.complex_index(lambda_nm);

        assert_close(index.absorption_function(), row.number("E_m"), "E");
        assert_close(index.scattering_function(), row.number("F_m"), "F");
        let sigma_a = row.number("sigma_a_alpha1_m-1");
        assert_close(
            soot.absorption_per_volume_fraction(lambda_nm) * f_v,
            sigma_a,
            "σ_a",
        );
        assert_close(
            absorption_coefficient(f_v, lambda_nm, index),
            sigma_a,
            "σ_a",
        );
        assert_close(
            soot.small_particle_scattering_ratio(lambda_nm, radius_m),
            row.number("sigma_s_over_sigma_a"),
            "σ_s/σ_a",
        );
        assert_close(
            scattering_coefficient(f_v, lambda_nm, radius_m, index),
            row.number("sigma_s_rayleigh_m-1"),
            "σ_s",
        );
    }
}

#[test]
fn the_rayleigh_limit_keeps_the_distance_from_mie_that_the_page_states() {
    let soot = law(SootModel::DalzellSarofim, SootIndex::Propane);
    for row in Table::parse(MIE_CSV).rows() {
        let (lambda_nm, radius_nm) = (row.number("lambda_nm"), row.number("R_nm"));
        let ratio = soot.small_particle_scattering_ratio(lambda_nm, radius_nm * METRES_PER_NM);
        let albedo = ratio / (1.0 + ratio);
        assert_close(albedo, row.number("albedo_rayleigh"), "albedo");

        // Per sphere, σ = N π R² Q with N = f_v / (4/3 π R³).
        let per_q = 0.75 / (radius_nm * METRES_PER_NM);
        let sigma_a = soot.absorption_per_volume_fraction(lambda_nm);
        let q_abs = sigma_a / per_q;
        assert_close(q_abs, row.number("Q_abs_rayleigh"), "Q_abs");
        assert_close(q_abs * ratio, row.number("Q_sca_rayleigh"), "Q_sca");

        let x = row.number("x");
        let low = 1.0 - q_abs / row.number("Q_abs_mie");
        let high = q_abs * ratio / row.number("Q_sca_mie") - 1.0;
        assert!(x > 0.17 || low < 0.025, "x = {x}: σ_a low by {low}");
        assert!(x > 0.49 || (low < 0.115 && high.abs() < 0.01), "x = {x}");
        assert!((0.0..0.2).contains(&low), "x = {x}: σ_a low by {low}");
    }
}

#[test]
fn scattering_is_that_of_mies_spheres_beside_the_absorption_of_small_ones() {
    let soot = law(SootModel::DalzellSarofim, SootIndex::Propane);
    for row in Table::parse(MIE_CSV).rows() {
        let (lambda_nm, radius_m) = (row.number("lambda_nm"), row.number("R_nm") * METRES_PER_NM);
        let expected = row.number("Q_sca_mie") / row.number("Q_abs_rayleigh");
        let got = soot.scattering_ratio(lambda_nm, radius_m);
        assert!((got / expected - 1.0).abs() < 1e-12, "{got} {expected}");
        let excess = row.number("abs_mie_over_rayleigh") - 1.0;
        let left_out = soot.absorption_left_out(lambda_nm, radius_m);
        assert!((left_out - excess).abs() < 1e-12, "{left_out} {excess}");
        let asymmetry = soot.asymmetry(lambda_nm, radius_m);
        assert!((asymmetry / row.number("g_mie") - 1.0).abs() < 1e-12);
    }
    // Below the series' range the limit stands, without a step.
    let radius_m = |x: f64| x * 550.0 * METRES_PER_NM / (2.0 * PI);
    let ratio = |x: f64| soot.scattering_ratio(550.0, radius_m(x)) / x.powi(3);
    assert!((ratio(0.999e-4) / ratio(1.001e-4) - 1.0).abs() < 1e-7);
}

#[test]
fn propane_at_550_nm_has_the_number_the_plume_is_built_on() {
    let index = law(SootModel::DalzellSarofim, SootIndex::Propane).complex_index(550.0);
    assert!((index.absorption_function() - 0.24624).abs() < 5e-6);
}

#[test]
fn case_22_no_soot_no_absorption_whatever_the_radius() {
    for model in SootModel::ALL {
        let index = law(model, SootIndex::Propane).complex_index(550.0);
        assert_eq!(absorption_coefficient(0.0, 550.0, index), 0.0);
        assert_eq!(scattering_coefficient(0.0, 550.0, 0.0, index), 0.0);
        assert_eq!(
            law(model, SootIndex::Propane).scattering_ratio(550.0, 0.0),
            0.0
        );
    }
    assert_eq!(volume_fraction_factor(Hold::Number, 0.0), 0.0);
}

#[test]
fn case_23_a_transparent_particle_scatters_only() {
    assert_eq!(absorption_coefficient(1e-6, 550.0, GLASS), 0.0);
    assert!(scattering_coefficient(1e-6, 550.0, 20e-9, GLASS) > 0.0);
}

#[test]
fn case_25_the_scattering_ratio_of_the_smallest_particles_survives_single_precision() {
    let soot = SootLaw::default();
    let ratio = soot.scattering_ratio(550.0, 5e-9) as f32;
    assert!(ratio.is_normal());
    let small = |radius_m| soot.small_particle_scattering_ratio(550.0, radius_m);
    assert!((small(10e-9) / small(5e-9) - 8.0).abs() < 1e-13);
}

#[test]
fn case_26_the_power_law_has_no_range_and_the_table_is_held() {
    let table = law(SootModel::DalzellSarofim, SootIndex::Acetylene);
    let at = |nm| table.absorption_per_volume_fraction(nm) * nm;
    assert_close(at(750.0), at(650.0), "E is held above 650 nm");
    assert_close(at(390.0), at(435.8), "E is held below 435.8 nm");
}

#[test]
fn case_27_the_power_law_meets_the_table_at_550_nm_and_has_its_slope() {
    for fuel in [SootIndex::Propane, SootIndex::Acetylene] {
        let power = law(SootModel::HottelBroughton, fuel);
        let table = law(SootModel::DalzellSarofim, fuel);
        assert_eq!(
            power.absorption_per_volume_fraction(550.0),
            table.absorption_per_volume_fraction(550.0)
        );
        let slope = (power.absorption_per_volume_fraction(700.0)
            / power.absorption_per_volume_fraction(400.0))
        .ln()
            / (700.0_f64 / 400.0).ln();
        assert!((slope + 1.39).abs() < 1e-14);
    }
}

#[test]
fn case_28_a_metre_of_dense_soot_is_opaque() {
    let soot = law(SootModel::DalzellSarofim, SootIndex::Propane);
    let tau = 1e-5 * soot.absorption_per_volume_fraction(550.0);
    assert!((tau - 84.4).abs() < 0.05, "{tau}");
}

#[test]
#[cfg(debug_assertions)]
fn case_29_volume_fractions_the_doors_must_refuse_are_caught_in_debug_builds() {
    for f_v in [-1e-6, 1.5, f64::NAN] {
        assert!(std::panic::catch_unwind(|| absorption_coefficient(f_v, 550.0, GLASS)).is_err());
    }
}

#[test]
fn the_radius_counts_only_where_the_number_is_held() {
    assert_eq!(
        volume_fraction_factor(Hold::Number, REFERENCE_RADIUS_NM),
        1.0
    );
    assert_eq!(
        volume_fraction_factor(Hold::Number, 2.0 * REFERENCE_RADIUS_NM),
        8.0
    );
    assert_eq!(volume_fraction_factor(Hold::Volume, 3.0), 1.0);
}

#[test]
fn names_are_those_of_the_scene_file() {
    for model in SootModel::ALL {
        let json = serde_json::to_string(&model).unwrap();
        assert_eq!(json, format!("\"{model}\""));
        assert_eq!(serde_json::from_str::<SootModel>(&json).unwrap(), model);
    }
    assert_eq!(SootModel::default(), SootModel::ALL[0]);
    assert_eq!(
        serde_json::to_string(&Hold::default()).unwrap(),
        "\"number\""
    );
}

proptest! {
    #[test]
    fn absorption_is_finite_positive_and_linear_in_soot(lambda_nm in 300.0..2000.0_f64, f_v in 0.0..1.0_f64) {
        for model in SootModel::ALL {
            let soot = law(model, SootIndex::Acetylene);
            let sigma = soot.absorption_per_volume_fraction(lambda_nm);
            prop_assert!(sigma.is_finite() && sigma > 0.0);
            let index = soot.complex_index(lambda_nm);
            let half = absorption_coefficient(f_v / 2.0, lambda_nm, index);
            prop_assert_eq!(half * 2.0, absorption_coefficient(f_v, lambda_nm, index));
        }
    }
}
