//! Paths whose shape is known.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use proptest::prelude::*;

use super::*;

#[path = "../../../tests/golden/csv.rs"]
mod golden_csv;

const SNELL_CSV: &str = include_str!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/golden/snell.csv"
));

/// Steps whose estimated error is so small, and that are no longer than this.
fn within(error: f64, longest_m: f64) -> Tolerance {
    Tolerance {
        position_m: error,
        direction_rad: error,
        longest_m,
    }
}

/// The path after so many metres.
fn after<F: Fn(DVec3) -> Index>(index: F, ray: Ray, tolerance: Tolerance, length_m: f64) -> Ray {
    let mut path = Path::new(index, ray, tolerance);
    let mut left_m = length_m;
    while left_m > 0.0 {
        left_m -= path.advance(left_m);
    }
    path.at()
}

/// Maxwell's fish eye of radius 1: n = 2/(1 + r²).
fn fish_eye(point: DVec3) -> Index {
    let down = 1.0 + point.length_squared();
    Index {
        refractivity: 2.0 / down - 1.0,
        gradient: -4.0 / (down * down) * point,
    }
}

/// From (−1, 0, 0) at an angle to the x axis, and the length of its arc to the other side.
fn into_the_fish_eye(angle: f64) -> (Ray, f64, DVec3, f64) {
    let (sin, cos) = angle.sin_cos();
    let ray = Ray {
        origin: DVec3::NEG_X,
        direction: DVec3::new(cos, sin, 0.0),
    };
    let centre = DVec3::new(0.0, -cos / sin, 0.0);
    let radius = 1.0 / sin;
    (ray, 2.0 * radius * (1.0 / radius).asin(), centre, radius)
}

/// J. C. Maxwell, Cambridge and Dublin Math. J. 8 (1854) 188; Born and Wolf, section 4.2.2.
#[test]
fn paths_in_maxwells_fish_eye_are_circles_and_meet_again() {
    for angle in [0.2, 0.6, 1.1, 1.5] {
        let (ray, arc, centre, radius) = into_the_fish_eye(angle);
        let mut path = Path::new(fish_eye, ray, within(1e-12, 0.1));
        let mut left = arc;
        while left > 0.0 {
            left -= path.advance(left);
            let off = (path.at().origin - centre).length() - radius;
            assert!(off.abs() < 1e-8 * radius, "{angle}: {off:e} off its circle");
            assert!((path.at().direction.length() - 1.0).abs() < 1e-15);
        }
        let missed = (path.at().origin - DVec3::X).length();
        assert!(missed < 1e-8, "{angle}: {missed:e} beside the image");
    }
}

/// A rod with n² = n₀²(1 − α²ρ²): x = x₀ cos(n₀ α z/β) with β = n cos θ, constant along a path.
#[test]
fn a_path_in_a_graded_rod_is_a_sine() {
    const MIDDLE: f64 = 1.5;
    const ALPHA: f64 = 3.0;
    let rod = |point: DVec3| {
        let across = DVec3::new(point.x, point.y, 0.0);
        let n = MIDDLE * (1.0 - ALPHA * ALPHA * across.length_squared()).sqrt();
        Index {
            refractivity: n - 1.0,
            gradient: -MIDDLE * MIDDLE * ALPHA * ALPHA / n * across,
        }
    };
    let start = 0.05;
    let ray = Ray {
        origin: DVec3::new(start, 0.0, 0.0),
        direction: DVec3::Z,
    };
    let beta = MIDDLE * (1.0 - ALPHA * ALPHA * start * start).sqrt();
    let mut path = Path::new(rod, ray, within(1e-12, 0.05));
    let period = std::f64::consts::TAU * beta / (MIDDLE * ALPHA);
    while path.at().origin.z < 3.0 * period {
        path.advance(1.0);
        let at = path.at().origin;
        let expected = start * (MIDDLE * ALPHA * at.z / beta).cos();
        assert!((at.x - expected).abs() < 1e-8, "{at}: not at {expected}");
        assert_eq!(at.y, 0.0);
    }
}

/// The sines of the reference behind a face, where the face is a smooth layer; what it calls total reflection comes back
/// at its own angle. Beside the flat limit nothing of the layer counts: n sin θ is the same on both sides.
#[test]
fn a_thin_smooth_layer_refracts_as_snell_says() {
    let (mut refracted, mut reflected) = (0, 0);
    for row in golden_csv::Table::parse(SNELL_CSV).rows() {
        let [n1, n2, degrees] = ["n1", "n2", "theta1_deg"].map(|column| row.number(column));
        // At 90° a ray runs along the face; two indices that differ by an f64's last bit have no layer.
        if degrees == 90.0 || (n1 - n2).abs() < 1e-12 && n1 != n2 {
            continue;
        }
        // From z = 0 to 1, with two continuous derivatives.
        let layer = |point: DVec3| {
            let u = point.z.clamp(0.0, 1.0);
            let share = u * u * u * (10.0 - u * (15.0 - 6.0 * u));
            let slope = 30.0 * u * u * (1.0 - u) * (1.0 - u);
            Index {
                refractivity: n1 - 1.0 + (n2 - n1) * share,
                gradient: DVec3::new(0.0, 0.0, (n2 - n1) * slope),
            }
        };
        let (sin, cos) = degrees.to_radians().sin_cos();
        let ray = Ray {
            origin: DVec3::new(0.0, 0.0, -1e-3),
            direction: DVec3::new(sin, 0.0, cos),
        };
        let mut path = Path::new(layer, ray, within(1e-11, 0.5));
        while (-2e-3..=1.0).contains(&path.at().origin.z) {
            path.advance(f64::INFINITY);
        }
        let end = path.at();
        if row.text("theta2_deg") == "TIR" {
            reflected += 1;
            assert!(end.origin.z < 0.0, "{degrees}° goes through at {n1} → {n2}");
            let expected = DVec3::new(sin, 0.0, -cos);
            let off = (end.direction - expected).length();
            assert!(
                off < 1e-8,
                "{degrees}°, {n1} → {n2}: {} after reflection",
                end.direction
            );
        } else {
            refracted += 1;
            let expected = row.number("sin_theta2");
            assert!(end.origin.z > 1.0, "{degrees}° comes back at {n1} → {n2}");
            let off = end.direction.x - expected;
            assert!(off.abs() < 1e-9, "{degrees}°, {n1} → {n2}: off by {off:e}");
        }
    }
    assert!(
        refracted >= 25 && reflected >= 8,
        "{refracted}, {reflected}"
    );
}

/// Beyond 88.798294° air of 300 K and the hot side of a flame's edge are a mirror.
#[test]
fn case_42_the_critical_angle_is_where_snell_puts_it() {
    let [n1, n2] = [1.00027, 1.00005];
    let layer = |point: DVec3| {
        let u = point.z.clamp(0.0, 1.0);
        Index {
            refractivity: n1 - 1.0 + (n2 - n1) * u * u * (3.0 - 2.0 * u),
            gradient: DVec3::new(0.0, 0.0, (n2 - n1) * 6.0 * u * (1.0 - u)),
        }
    };
    for (degrees, through) in [
        (88.797, true),
        (88.798_29, true),
        (88.798_30, false),
        (88.8, false),
    ] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let ray = Ray {
            origin: DVec3::new(0.0, 0.0, -1e-3),
            direction: DVec3::new(sin, 0.0, cos),
        };
        let mut path = Path::new(layer, ray, within(1e-12, 0.5));
        while (-2e-3..=1.0).contains(&path.at().origin.z) {
            path.advance(f64::INFINITY);
            assert!(path.at().origin.is_finite() && path.at().direction.is_finite());
        }
        assert_eq!(path.at().origin.z > 1.0, through, "{degrees}°");
    }
}

#[test]
fn bouguers_invariant_holds_in_a_hot_ball() {
    // n r sin φ, for a ball of 300 K to 1800 K at a gain of 20.
    let ball = |point: DVec3| {
        let bell = 20.0 * 2.2e-4 * (-point.length_squared() / 0.01).exp();
        Index {
            refractivity: 2.7e-4 - bell,
            gradient: 2.0 * bell / 0.01 * point,
        }
    };
    for beside in [0.0, 0.03, 0.1, 0.2] {
        let ray = Ray {
            origin: DVec3::new(-0.5, beside, 0.01),
            direction: DVec3::X,
        };
        let invariant = |at: Ray| {
            let n = 1.0 + ball(at.origin).refractivity;
            n * at.origin.cross(at.direction).length()
        };
        let mut path = Path::new(ball, ray, within(1e-12, 0.01));
        let before = invariant(ray);
        while path.at().origin.x < 0.5 {
            path.advance(f64::INFINITY);
            let off = invariant(path.at()) - before;
            assert!(off.abs() < 1e-10, "{off:e}");
        }
        let turned = path.at().direction.cross(DVec3::X).length();
        assert!(
            turned > if beside == 0.2 { 1e-4 } else { 1e-3 },
            "{turned:e}"
        );
    }
}

#[test]
fn errors_shrink_with_the_third_power_of_the_step_and_with_the_tolerance() {
    let (ray, arc, _, _) = into_the_fish_eye(0.7);
    let error = |tolerance| (after(fish_eye, ray, tolerance, arc).origin - DVec3::X).length();
    let by_step = [0.04, 0.02, 0.01].map(|longest| error(within(f64::INFINITY, longest)));
    for pair in by_step.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 3.0).abs() < 0.2, "order {order}: {by_step:?}");
    }
    // A thousandfold tolerance makes a step ten times as long, and a thousandfold error of a step, which adds up over
    // a tenth of the steps.
    let by_tolerance = [1e-5, 1e-8, 1e-11].map(|tolerance| error(within(tolerance, 1.0)));
    for pair in by_tolerance.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((30.0..1000.0).contains(&ratio), "{by_tolerance:?}");
    }
}

#[test]
fn a_step_at_a_jump_of_the_gradient_ends() {
    let wedge = |point: DVec3| Index {
        refractivity: 0.0,
        gradient: if point.x > 0.0 { DVec3::Y } else { DVec3::ZERO },
    };
    let ray = Ray {
        origin: DVec3::new(-0.5, 0.0, 0.0),
        direction: DVec3::X,
    };
    let mut path = Path::new(wedge, ray, within(1e-30, 1.0));
    let mut steps = 0;
    while path.at().origin.x < 0.5 {
        path.advance(1.0);
        steps += 1;
        assert!(steps < 100_000, "stuck at {:?}", path.at());
    }
}

proptest! {
    #[test]
    fn a_straight_path_keeps_every_bit_of_its_direction(
        origin in prop::array::uniform3(-1e3..1e3_f64),
        direction in prop::array::uniform3(-1.0..1.0_f64),
        refractivity in 0.0..1e-3_f64,
        steps in 1..200_u32,
    ) {
        let Some(ray) = Ray::new(origin.into(), direction.into()) else { return Ok(()) };
        let air = |_| Index { refractivity, gradient: DVec3::ZERO };
        let mut path = Path::new(air, ray, within(1e-9, 0.37));
        let mut length = 0.0;
        for _ in 0..steps {
            length += path.advance(f64::INFINITY);
        }
        prop_assert_eq!(path.at().direction.to_array().map(f64::to_bits), ray.direction.to_array().map(f64::to_bits));
        prop_assert!((path.at().origin - ray.at(length)).length() < 1e-12 * (origin[0].abs() + 1e3));
    }
}
