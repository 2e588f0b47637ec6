//! Rays through balls of hot gas: on a grid, against the same ball in closed form.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::*;
use crate::render::chord::{Bricks, Chord, Run};
use crate::scene::Air;
use crate::scene::flame::{Bending, Flame};
use crate::scene::refractivity::tests::{Gas, VOXEL_M, ball, clear};
use crate::volume::UpAxis;

fn straight_up_x(y: f64, z: f64) -> Ray {
    Ray {
        origin: DVec3::new(-2.0, y, z),
        direction: DVec3::X,
    }
}

fn through(flame: &Flame, ray: &Ray) -> Bent {
    let gas = Refractivity::new(flame, 550.0).unwrap();
    bend(
        Surroundings {
            medium: flame.medium(),
            gas: &gas,
            stage: &Stage::default(),
        },
        Bricks::new(flame.medium(), true),
        ray,
        0.5 * VOXEL_M,
    )
}

/// Deflection of a ray beside the ball: ∫ dn/dr b/r ds along the straight ray, the first order in n − 1.
fn by_quadrature(gas: &Gas, beside: f64) -> f64 {
    let heat = ball(DVec3::ZERO);
    let n = |r: f64| gas.law(heat(r * DVec3::X));
    let (step, mut sum) = (1e-4, 0.0);
    for i in -5000..=5000 {
        let r = beside.hypot(f64::from(i) * step);
        sum += (n(r + 1e-6) - n(r - 1e-6)) / 2e-6 * beside / r * step;
    }
    sum
}

#[test]
fn a_ball_on_a_grid_bends_light_as_the_ball_itself() {
    let gas = Gas::default();
    let flame = gas.flame(ball(DVec3::ZERO), clear);
    for beside in [0.02, 0.06, 0.1, 0.14, 0.18] {
        // Off the lattice's planes, as a picture's rays are.
        let bent = through(&flame, &straight_up_x(0.8 * beside, 0.6 * beside));
        let turned = bent.exit.direction;
        let away = turned.y * 0.8 + turned.z * 0.6;
        let expected = by_quadrature(&gas, beside);
        let off = away / expected - 1.0;
        // The bell's flank is 5 voxels wide in n: differences over two voxels and linear interpolation flatten it by
        // (1/6 + 1/6)/25 = 1.3 %; where the flank's sides cancel, up to twice that.
        assert!(
            off.abs() < 0.03,
            "{beside} m: {away:e} rad, not {expected:e}"
        );
        let aside = turned.y * 0.6 - turned.z * 0.8;
        assert!(aside.abs() < 0.02 * expected.abs(), "{aside:e} aside");
        assert!((turned.length() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn the_deflection_turns_with_the_axes_of_the_file() {
    let middle = DVec3::new(0.01, 0.03, -0.02);
    let [z_up, y_up] = [UpAxis::Z, UpAxis::Y].map(|up| {
        let gas = Gas {
            up,
            ..Gas::default()
        };
        let flame = gas.flame(ball(middle), clear);
        let world = crate::scene::Placement {
            up,
            metres_per_unit: 1.0,
        }
        .world_from_file();
        let bent = through(&flame, &straight_up_x(0.1, 0.02).transformed(&world));
        world.inverse().transform_vector3(bent.exit.direction)
    });
    assert!((z_up - y_up).length() < 1e-9, "{z_up}, {y_up}");
    assert!((z_up.y - z_up.z).abs() > 1e-5 && z_up.y > 1e-5, "{z_up}");
}

#[test]
fn deflections_follow_pressure_and_gain() {
    let deflection = |pressure_pa: f64, gain: f64| {
        let gas = Gas {
            air: Air {
                pressure_pa,
                ..Air::default()
            },
            bending: Some(Bending {
                gain,
                dispersion: false,
            }),
            ..Gas::default()
        };
        let flame = gas.flame(ball(DVec3::ZERO), clear);
        let turned = through(&flame, &straight_up_x(0.1, 0.003)).exit.direction.y;
        (turned, gas.law(300.0) - gas.law(1800.0))
    };
    let (standard, n) = deflection(101_325.0, 1.0);
    let (thin, thin_n) = deflection(5e4, 1.0);
    // To first order: the path itself moves by a thousandth of a voxel.
    assert!(
        (thin / standard / (thin_n / n) - 1.0).abs() < 1e-3,
        "{thin:e}, {standard:e}"
    );
    let (strong, _) = deflection(101_325.0, 10.0);
    assert!(
        (strong / standard / 10.0 - 1.0).abs() < 0.02,
        "{strong:e}, {standard:e}"
    );
}

#[test]
fn rays_beside_the_gas_and_through_even_gas_keep_every_bit() {
    let flame = Gas::default().flame(ball(DVec3::ZERO), clear);
    for ray in [straight_up_x(0.5, 0.0), straight_up_x(0.31, 0.31)] {
        let bent = through(&flame, &ray);
        assert_eq!(bent.exit.direction.to_array(), ray.direction.to_array());
        assert!(bent.chord.is_none() && bent.hit.is_none());
    }
    let even = Gas {
        border: crate::volume::Border::Clamp,
        ..Gas::default()
    };
    let ray = Ray::new(DVec3::new(-2.0, 0.1, 0.2), DVec3::new(1.0, -0.03, -0.07)).unwrap();
    // What only bends light is not marched through.
    for (soot, marched) in [(0.0, false), (1e-6, true)] {
        let flame = even.flame(|_| 1200.0, |_| soot);
        let bent = through(&flame, &ray);
        assert_eq!(bent.exit.direction.to_array(), ray.direction.to_array());
        assert_eq!(bent.chord.is_some(), marched);
    }
}

#[test]
fn a_straight_path_is_cut_as_the_march_cuts_a_ray() {
    let even = Gas {
        border: crate::volume::Border::Clamp,
        ..Gas::default()
    };
    let flame = even.flame(|_| 1200.0, |_| 1e-6);
    let ray = Ray::new(DVec3::new(-2.0, 0.1, 0.2), DVec3::new(1.0, -0.03, -0.07)).unwrap();
    let gas = Refractivity::new(&flame, 550.0).unwrap();
    let around = Surroundings {
        medium: flame.medium(),
        gas: &gas,
        stage: &Stage::default(),
    };
    for step_m in [0.003, 0.01, 0.037, 5.0] {
        let bent = bend(around, Bricks::new(around.medium, true), &ray, step_m)
            .chord
            .unwrap();
        let chord = Chord::new(
            Bricks::new(flame.medium(), true),
            &ray,
            step_m,
            f64::INFINITY,
            [0.0, f64::INFINITY],
        )
        .unwrap();
        assert_eq!(bent.last, chord.last, "{step_m}");
        assert!((bent.last_share - chord.last_share).abs() < 1e-5);
        assert_eq!(bent.middles.len(), bent.last as usize + 1);
        for (step, position) in bent.middles.iter().enumerate() {
            let whole = step < bent.last as usize;
            let share = if whole {
                1.0
            } else {
                f64::from(chord.last_share)
            };
            let middle = step as f64 + 0.5 * share;
            for (axis, found) in position.iter().enumerate() {
                let expected = chord.start[axis] + middle * chord.delta[axis];
                assert!((found - expected).abs() < 1e-5, "{step_m}: step {step}");
            }
        }
        for Run { first, end, .. } in &bent.runs {
            let holds = |run: &Run| run.first <= *first && *end <= run.end;
            assert!(
                chord.runs.iter().any(holds),
                "{:?}, {:?}",
                bent.runs,
                chord.runs
            );
        }
    }
}

#[test]
fn steps_lie_on_the_path_and_those_with_gas_are_in_runs() {
    let gas = Gas {
        bending: Some(Bending {
            gain: 20.0,
            dispersion: false,
        }),
        ..Gas::default()
    };
    let flame = gas.flame(ball(DVec3::ZERO), |point| {
        1e-6 * (0.1 - point.length()).max(0.0)
    });
    let medium = flame.medium();
    let ray = straight_up_x(0.06, 0.01);
    let field = Refractivity::new(&flame, 550.0).unwrap();
    let around = Surroundings {
        medium,
        gas: &field,
        stage: &Stage::default(),
    };
    let way = follow(around, &ray);
    for step_m in [0.002, 0.013, 0.2] {
        let chord = bend(around, Bricks::new(around.medium, true), &ray, step_m)
            .chord
            .unwrap();
        let world = medium.lattice_from_world.inverse();
        let points: Vec<DVec3> = chord
            .middles
            .iter()
            .map(|position| world.transform_point3((*position).into()))
            .collect();
        for (step, position) in chord.middles.iter().enumerate() {
            let in_run = chord
                .runs
                .iter()
                .any(|run| (run.first as usize..run.end as usize).contains(&step));
            let soot = medium.sample((*position).into())[0];
            assert!(in_run || soot == 0.0, "step {step} is skipped");
        }
        // Equally far apart, but for the last, and no farther than a bent path's chord is short.
        for pair in points[..points.len() - 1].windows(2) {
            let apart = (pair[1] - pair[0]).length();
            assert!((apart / step_m - 1.0).abs() < 2e-3, "{apart} at {step_m}");
        }
        let share = f64::from(chord.last_share);
        let length = step_m * (f64::from(chord.last) + share);
        assert!((length - way.knots.last().unwrap().arc_m).abs() < 1e-6);
    }
    // The path bends by far more than the steps were allowed to be off.
    assert!(way.exit.direction.y > 1e-3);
}

#[test]
fn a_path_begins_where_an_eye_in_the_gas_is() {
    let flame = Gas::default().flame(ball(DVec3::ZERO), clear);
    let inside = Ray {
        origin: DVec3::new(0.0, 0.1, 0.003),
        direction: DVec3::X,
    };
    let [whole, half] = [straight_up_x(0.1, 0.003), inside].map(|ray| through(&flame, &ray));
    let share = half.exit.direction.y / whole.exit.direction.y;
    assert!((share - 0.5).abs() < 1e-2, "{share}");
}
