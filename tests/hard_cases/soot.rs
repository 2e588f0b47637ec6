//! Cases 22 to 29: soot that is not there, transparent, of any size, or impossible.

use std::sync::Arc;

use sootlight::physics::soot::{
    Hold, SootLaw, SootModel, absorption_coefficient, scattering_coefficient,
    volume_fraction_factor,
};
use sootlight::physics::soot_index::{ComplexIndex, SootIndex, chang, dalzell_sarofim};
use sootlight::project::{Project, ProjectError};
use sootlight::render::{Cancel, Settings};
use sootlight::render::{Plan, Prober, Switch, render_still};
use sootlight::scene::WavelengthSet;

use super::super::common;
use super::{
    EPSILON_32, LENGTH_M, RGB_NM, assert_close, at_once, even, even_with, planck_of_the_march,
    refusal,
};

const PROPANE: SootLaw = SootLaw {
    model: SootModel::DalzellSarofim,
    fuel_index: SootIndex::Propane,
};

#[test]
fn case_22_no_soot_absorbs_nothing_of_whatever_radius() {
    for lambda_nm in RGB_NM {
        let index = PROPANE.complex_index(lambda_nm);
        assert_eq!(absorption_coefficient(0.0, lambda_nm, index), 0.0);
        // N = f_v/(4/3 πR³) is never formed: it would be 0/0 for R = 0.
        for radius_m in [0.0, 21.25e-9] {
            assert_eq!(scattering_coefficient(0.0, lambda_nm, radius_m, index), 0.0);
        }
        assert_eq!(PROPANE.scattering_ratio(lambda_nm, 0.0), 0.0);
        assert_eq!(scattering_coefficient(1e-6, lambda_nm, 0.0, index), 0.0);
    }
    assert_eq!(volume_fraction_factor(Hold::Number, 0.0), 0.0);
    let scene = even(0.0, 1800.0);
    let seen = at_once(&scene, RGB_NM);
    assert_eq!((seen.radiance, seen.opacity), ([0.0; 3], [0.0; 3]));
    let error = refusal(&["soot.radius_nm=0"]);
    assert_eq!(
        error.to_string(),
        "soot.radius_nm is 0: it must lie between 1 and 100"
    );
}

#[test]
fn case_23_a_transparent_particle_scatters_only() {
    let glass = ComplexIndex { n: 1.5, k: 0.0 };
    assert_eq!(absorption_coefficient(1e-6, 550.0, glass), 0.0);
    // F = ((n² − 1)/(n² + 2))², σ_s = 4π F f_v x³/λ.
    let x = std::f64::consts::TAU * 20.0 / 550.0;
    let scattered =
        2.0 * std::f64::consts::TAU * (1.25_f64 / 4.25).powi(2) * 1e-6 * x.powi(3) / 550e-9;
    let got = scattering_coefficient(1e-6, 550.0, 20e-9, glass);
    assert_close(got, scattered, 8.0 * f64::EPSILON, "σ_s of glass");
    let nothing = ComplexIndex { n: 1.0, k: 0.0 };
    assert_eq!(absorption_coefficient(1e-6, 550.0, nothing), 0.0);
    assert_eq!(scattering_coefficient(1e-6, 550.0, 20e-9, nothing), 0.0);
}

/// The index is data of the program and of no scene file, so that nobody can ask for n = 0. The law states it, and tests
/// of debug builds are stopped by it.
#[test]
fn case_24_no_index_comes_near_the_zero_of_its_denominator() {
    let error = Project::default().set("soot.n=0").unwrap_err();
    assert!(
        error.to_string().starts_with("there is no key soot.n"),
        "{error}"
    );
    for step in 0..=600 {
        let lambda_nm = 10.0_f64.powf(f64::from(step) / 100.0);
        for index in [
            chang(lambda_nm),
            dalzell_sarofim(SootIndex::Propane, lambda_nm),
            dalzell_sarofim(SootIndex::Acetylene, lambda_nm),
        ] {
            let ComplexIndex { n, k } = index;
            let denominator = (n * n - k * k + 2.0).powi(2) + 4.0 * n * n * k * k;
            assert!(
                n > 1.0 && k > 0.0 && denominator > 4.0,
                "{lambda_nm} nm: {index:?}"
            );
            assert!(index.absorption_function() > 0.0 && index.absorption_function() < 0.5);
        }
    }
    let zero = ComplexIndex {
        n: 0.0,
        k: std::f64::consts::SQRT_2,
    };
    if cfg!(debug_assertions) {
        assert!(std::panic::catch_unwind(|| zero.absorption_function()).is_err());
    }
}

#[test]
fn case_25_the_smallest_particles_scatter_in_single_precision_too() {
    let cubed = 5e-9_f32 * 5e-9 * 5e-9;
    assert!(cubed.is_normal());
    assert_eq!(cubed * cubed, 0.0, "R⁶ is no f32");
    for lambda_nm in RGB_NM {
        let index = PROPANE.complex_index(lambda_nm);
        let x = std::f64::consts::TAU * 5.0 / lambda_nm;
        let ratio =
            2.0 / 3.0 * x.powi(3) * index.scattering_function() / index.absorption_function();
        let got = PROPANE.small_particle_scattering_ratio(lambda_nm, 5e-9);
        assert_close(got, ratio, 8.0 * f64::EPSILON, "σ_s/σ_a");
    }
    // In the march's tables σ_s is σ_a times the ratio, in f64, then rounded.
    let scene = even_with(1e-6, 1500.0, &["soot.radius_nm=5", "soot.hold=volume"]);
    let settings = Settings {
        size: [8, 8],
        step_voxels: 1.0,
        wavelengths: WavelengthSet::Plain(16),
        samples_per_pixel: 1,
        scattering_orders: 1,
        effects: common::scattered_alone(Switch::On),
    };
    let plan = Plan::new(&scene, &settings);
    let law = scene.flame.soot();
    for (node, &nm) in plan
        .tables
        .nodes
        .iter()
        .zip(&plan.tables.wavelengths.nodes_nm)
    {
        let expected = law.absorption_per_volume_fraction(nm) * law.scattering_ratio(nm, 5e-9);
        assert!(node.scattering[0].is_normal());
        assert_close(
            f64::from(node.scattering[0]),
            expected,
            EPSILON_32,
            "σ_s of the march",
        );
    }
    let frame = render_still(&scene, &settings, &Cancel::never(), &|_| {}).unwrap();
    let middle = frame.film.pixel(4, 4).unwrap().xyz;
    assert!(middle.iter().all(|v| v.is_finite() && *v > 0.0));
}

#[test]
fn case_26_outside_its_table_the_index_is_held_and_not_extrapolated() {
    for soot in [SootIndex::Propane, SootIndex::Acetylene] {
        let [first, last] = [435.8, 650.0].map(|nm| dalzell_sarofim(soot, nm));
        for nm in [1e-3, 230.0, 380.0, 435.79] {
            assert_eq!(dalzell_sarofim(soot, nm), first);
        }
        for nm in [650.01, 780.0, 1e4, 1e6, f64::INFINITY] {
            assert_eq!(dalzell_sarofim(soot, nm), last);
        }
    }
    assert_eq!((chang(399.0), chang(1e6)), (chang(400.0), chang(30_000.0)));
    // Acetylene's last two knots lead to k = 0 at 2850 nm.
    assert!(dalzell_sarofim(SootIndex::Acetylene, 3000.0).k > 0.4);
    let scene = even_with(
        1e-5,
        1500.0,
        &["soot.model=dalzell-sarofim", "fuel.name=acetylene"],
    );
    let seen = at_once(&scene, [3e3, 1e4, 780.0]);
    assert!(
        seen.opacity
            .iter()
            .all(|o| (0.0..=1.0).contains(o) && *o > 0.0)
    );
}

#[test]
fn case_27_the_power_law_counts_in_its_reference_and_not_in_metres() {
    for fuel in [SootIndex::Propane, SootIndex::Acetylene] {
        let power = SootLaw::new(SootModel::HottelBroughton, fuel);
        let table = SootLaw::new(SootModel::DalzellSarofim, fuel);
        let at = |law: SootLaw, nm| law.absorption_per_volume_fraction(nm);
        assert_eq!(at(power, 550.0) / at(table, 550.0), 1.0);
        let expected = (550.0_f64 / 700.0).powf(1.39);
        assert_close(
            at(power, 700.0) / at(power, 550.0),
            expected,
            4.0 * f64::EPSILON,
            "λ^−1.39",
        );
    }
    // What metres would make of it.
    assert!(((1.0 / 550e-9_f64).powf(0.39) / 276.2 - 1.0).abs() < 1e-3);
    let [power, table] = ["hottel-broughton", "dalzell-sarofim"].map(|model| {
        let scene = even_with(1e-7, 1500.0, &[&format!("soot.model={model}")]);
        at_once(&scene, [550.0; 3])
    });
    assert_eq!(power, table);
}

#[test]
fn case_28_a_metre_of_dense_soot_is_a_black_body_at_every_visible_wavelength() {
    let tau = absorption_coefficient(1e-5, 550.0, PROPANE.complex_index(550.0));
    assert!((tau - 84.4).abs() < 0.05, "{tau}");
    let volume = common::slab(1, 1.0, |_| 1e-5, |_| 1500.0);
    let scene = super::scene_of(volume, &["soot.model=dalzell-sarofim"]);
    for nodes_nm in [
        [380.0, 400.0, 450.0],
        [500.0, 550.0, 600.0],
        [650.0, 700.0, 780.0],
    ] {
        let seen = at_once(&scene, nodes_nm);
        assert_eq!(seen.opacity, [1.0; 3]);
        assert_eq!(seen.radiance, planck_of_the_march(1500.0, nodes_nm));
    }
    let probe = Prober::new(&scene, [64, 64], common::scattered_alone(Switch::Off))
        .read([32.0, 32.0])
        .unwrap();
    let kelvin = probe.black_body_k().unwrap();
    assert!(
        (kelvin / 1500.0 - 1.0).abs() < 1e-3,
        "looks like {kelvin} K"
    );
}

#[test]
fn case_29_what_is_no_volume_fraction_is_refused() {
    for (bad, words) in [
        (
            "volume.soot.max=1.5",
            "volume.soot.max is 1.5: it must lie between 0 and 1",
        ),
        (
            "volume.soot.min=-1e-6",
            "volume.soot.min is -0.000001: it must lie between 0 and 1",
        ),
        (
            "volume.soot.max=nan",
            "volume.soot.max is NaN: it must lie between 0 and 1",
        ),
    ] {
        let error = refusal(&[bad]);
        assert!(
            matches!(error, ProjectError::FieldRange { .. }),
            "{error:?}"
        );
        assert_eq!(error.to_string(), words);
    }
    for bad in ["volume.soot.scale=nan", "volume.soot.offset=inf"] {
        let error = refusal(&[bad]);
        assert!(matches!(error, ProjectError::NotFinite { .. }), "{error:?}");
    }
    for bad in ["-1", "nan"] {
        let error = refusal(&[&format!("soot.amount={bad}")]);
        assert!(
            matches!(
                error,
                ProjectError::Range {
                    key: "soot.amount",
                    ..
                }
            ),
            "{error:?}"
        );
    }
    // In a file: below 0 and NaN count as none, above what was allowed as that, and it is said.
    for (value, expected) in [(-1e-3, 0.0), (f64::NAN, 0.0), (7.0, 1.0)] {
        let volume = Arc::new(common::slab(1, LENGTH_M, |_| value, |_| 1500.0));
        let job = super::unbounded(&[]).job(&volume).unwrap();
        let map = job.flame.maps.soot.as_ref().unwrap();
        let raw = f64::from(volume.grid("soot").unwrap().range().1);
        assert_eq!(
            map.apply(if raw.is_finite() { raw } else { 0.0 }),
            expected,
            "{value}"
        );
        assert_eq!(map.apply(value), expected, "{value}");
        let words = |flaw: &str| flaw.contains("clamped to");
        assert_eq!(
            job.flaws.iter().any(words),
            !value.is_nan() && !(0.0..=1.0).contains(&value),
            "{value}"
        );
    }
}
