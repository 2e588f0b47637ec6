//! Tests of the gas that bends light, and flames to test paths with.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::Arc;

use glam::{DAffine3, IVec3};

use super::*;
use crate::colour::cie;
use crate::physics::moist_air::Edition;
use crate::physics::soot::{Hold, SootModel};
use crate::scene::flame::{Bending, FlameParams, Placement};
use crate::scene::{GlowParams, Interpolation};
use crate::volume::{Border, FieldMap, FieldMaps, Grid, UpAxis, Volume};

/// Edge of a voxel, m.
pub(crate) const VOXEL_M: f64 = 0.01;

/// A cube of hot gas, and what is asked of it.
pub(crate) struct Gas {
    /// Voxels along an edge; the middle of the cube is the file's origin.
    pub(crate) edge: i32,
    pub(crate) border: Border,
    /// Temperature where the file says nothing, K.
    pub(crate) background_k: f64,
    pub(crate) up: UpAxis,
    pub(crate) air: Air,
    pub(crate) clear_k: f64,
    pub(crate) bending: Option<Bending>,
}

impl Default for Gas {
    fn default() -> Self {
        Self {
            edge: 64,
            border: Border::Background,
            background_k: 300.0,
            up: UpAxis::Z,
            air: Air::default(),
            clear_k: 300.0,
            bending: Some(Bending {
                gain: 1.0,
                dispersion: false,
            }),
        }
    }
}

impl Gas {
    /// The flame of these temperatures (K) and soot volume fractions at points of the file, m.
    pub(crate) fn flame(
        &self,
        kelvin: impl Fn(DVec3) -> f64 + Sync,
        soot: impl Fn(DVec3) -> f64 + Sync,
    ) -> Flame {
        let file_from_index = DAffine3::from_scale(DVec3::splat(VOXEL_M))
            * DAffine3::from_translation(DVec3::splat(-0.5 * f64::from(self.edge - 1)));
        let point = |voxel: IVec3| file_from_index.transform_point3(voxel.as_dvec3());
        let dims = IVec3::splat(self.edge);
        let around = self.background_k as f32;
        let hot = |voxel| kelvin(point(voxel)) as f32;
        let black = |voxel| soot(point(voxel)) as f32;
        let grids = vec![
            Grid::from_fn("soot", dims, file_from_index, self.border, 0.0, black),
            Grid::from_fn(
                "temperature",
                dims,
                file_from_index,
                self.border,
                around,
                hot,
            ),
        ];
        let volume = Arc::new(Volume::from_grids(grids, "gas"));
        Flame::new(&volume, &self.params(), None)
    }

    /// What it is made of.
    pub(crate) fn params(&self) -> FlameParams {
        let map = |name: &str, max: f64| Some(FieldMap::new(name, 1.0, 0.0, 0.0, max));
        FlameParams {
            maps: FieldMaps {
                soot: map("soot", 1.0),
                temperature: map("temperature", 1e4),
                ..FieldMaps::default()
            },
            placement: Placement {
                up: self.up,
                metres_per_unit: 1.0,
            },
            fuel: Fuel::named("propane").unwrap(),
            soot_model: SootModel::DalzellSarofim,
            soot_radius_nm: 21.25,
            soot_hold: Hold::Volume,
            soot_amount: 1.0,
            smoke_amount: 1.0,
            smoke_left_out: None,
            glow: GlowParams {
                clear_k: self.clear_k,
                ..GlowParams::default()
            },
            interpolation: Interpolation::Trilinear,
            air: self.air,
            scattering: None,
            bending: self.bending,
        }
    }

    /// n − 1 of gas of this temperature (K) at 550 nm, by the law.
    pub(crate) fn law(&self, kelvin: f64) -> f64 {
        let fuel = Fuel::named("propane").unwrap();
        let products = self.air.products_share(fuel, kelvin);
        let gas = self.air.gas(fuel).unwrap();
        gas.refractivity(Dispersion::at(550.0).unwrap(), kelvin, products)
    }
}

/// A hot ball about a point: 300 K around, 1800 K in the middle, a bell of 0.1 m.
pub(crate) fn ball(middle: DVec3) -> impl Fn(DVec3) -> f64 {
    move |point| 300.0 + 1500.0 * (-(point - middle).length_squared() / 0.01).exp()
}

/// No soot, anywhere.
pub(crate) fn clear(_: DVec3) -> f64 {
    0.0
}

fn position(flame: &Flame, world: DVec3) -> [f64; 3] {
    let medium = flame.medium();
    medium.lattice_from_world.transform_point3(world).to_array()
}

#[test]
fn samples_are_the_law_and_gradients_its_slope() {
    let gas = Gas::default();
    let flame = gas.flame(ball(DVec3::ZERO), clear);
    let bent = Refractivity::new(&flame, 550.0).unwrap();
    assert_eq!(bent.ambient(), gas.law(300.0));
    let heat = ball(DVec3::ZERO);
    let n = |point| gas.law(heat(point)) - gas.law(300.0);
    let mut steepest = 0.0_f64;
    for i in 0..400 {
        let i = f64::from(i);
        // Within the samples, where the law is not yet interpolated.
        let voxel = DVec3::new(3.0 + i % 50.0, 12.0 + (i * 0.37).floor() % 41.0, 31.0);
        let world = (voxel - 31.5) * VOXEL_M;
        let [excess, x, y, z] = bent
            .at(flame.medium(), position(&flame, world))
            .map(f64::from);
        let expected = n(world);
        let slope = |axis: DVec3| {
            let step = axis * VOXEL_M;
            (n(world + step) - n(world - step)) / (2.0 * VOXEL_M)
        };
        let slopes = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
        // Gas less than 1 K above the air may be taken for air.
        let beside = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        if beside
            .map(|step| heat(world + VOXEL_M * step))
            .any(|kelvin| kelvin < 301.0)
        {
            continue;
        }
        // Temperatures are kept in f32: at 300 K half a last digit is 1.5e-5 K, and 1.4e-11 of n.
        assert!(
            (excess - expected).abs() < 1e-10,
            "{excess:e}, not {expected:e}"
        );
        steepest = steepest.max(slopes.length());
        assert!(
            (DVec3::new(x, y, z) - slopes).length() < 3e-8,
            "{x} {y} {z}, not {slopes}"
        );
    }
    assert!(steepest > 1e-3, "{steepest}");
}

#[test]
fn gradients_turn_with_the_axes_of_the_file() {
    let off = DVec3::new(0.03, 0.05, -0.02);
    let place = DVec3::new(0.06, 0.1, 0.01);
    let [z_up, y_up] = [UpAxis::Z, UpAxis::Y].map(|up| {
        let gas = Gas {
            up,
            ..Gas::default()
        };
        let flame = gas.flame(ball(off), clear);
        let placement = Placement {
            up,
            metres_per_unit: 1.0,
        };
        let world = placement.world_from_file().transform_point3(place);
        let bent = Refractivity::new(&flame, 550.0).unwrap();
        bent.at(flame.medium(), position(&flame, world))
    });
    let [excess, x, y, z] = z_up;
    // Rounding moves the place by a few last digits.
    let near = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near(y_up, [excess, x, -z, y]), "{z_up:?}, {y_up:?}");
    assert!(y.abs() > 1e-4 && (y - z).abs() > 1e-4);
}

#[test]
fn the_gain_multiplies_all_but_the_air() {
    let at = |gain: f64| {
        let gas = Gas {
            bending: Some(Bending {
                gain,
                dispersion: false,
            }),
            ..Gas::default()
        };
        let flame = gas.flame(ball(DVec3::ZERO), clear);
        let bent = Refractivity::new(&flame, 550.0).unwrap();
        let place = position(&flame, DVec3::new(0.07, 0.02, -0.05));
        (bent.ambient(), bent.at(flame.medium(), place))
    };
    let (plain, strong) = (at(1.0), at(20.0));
    assert_eq!(plain.0, strong.0);
    for (plain, strong) in plain.1.into_iter().zip(strong.1) {
        assert!((strong / plain - 20.0).abs() < 1e-4, "{plain}, {strong}");
    }
}

#[test]
fn a_cut_through_hot_gas_is_no_lens() {
    // A file that ends in the midst of gas of 1000 K, whatever it says of the air beyond, and one that says 1300 K of air.
    for border in [Border::Clamp, Border::Background] {
        let cut = Gas {
            border,
            ..Gas::default()
        };
        let flame = cut.flame(|_| 1000.0, |_| 1e-7);
        let bent = Refractivity::new(&flame, 550.0).unwrap();
        let medium = flame.medium();
        let (domain, mut hot) = (medium.domain, 0);
        for i in 0..=20 {
            let along = f64::from(i) / 20.0;
            for across in [0.0, 0.01, 0.5, 1.0] {
                let place = DVec3::new(along, across, 0.3);
                let place = domain.min + place * domain.size();
                let [excess, gradient @ ..] = bent.at(medium, place.to_array());
                assert_eq!(gradient, [0.0; 3], "{border:?}: {place}");
                hot += u32::from(excess < -1e-4);
            }
        }
        assert!(hot > 15, "{border:?}: {hot}");
    }

    let zeroless = Gas {
        background_k: 1300.0,
        clear_k: 1300.0,
        ..Gas::default()
    };
    let flame = zeroless.flame(|_| 1300.0, |_| 1e-7);
    assert!(Refractivity::new(&flame, 550.0).is_none());
}

#[test]
fn heat_without_a_zero_is_stretched_to_begin_at_the_airs() {
    let zeroless = Gas {
        background_k: 1300.0,
        clear_k: 1300.0,
        ..Gas::default()
    };
    // 1300 to 1800 K becomes 300 to 1800 K; the middle sample's own peak makes a little less than 1800.
    let middle = DVec3::splat(0.005);
    let heat = ball(middle);
    let file = zeroless.flame(|point| 1300.0 + (heat(point) - 300.0) / 3.0, clear);
    let plain = Gas::default().flame(&heat, clear);
    let [file_bent, plain_bent] = [&file, &plain].map(|it| Refractivity::new(it, 550.0).unwrap());
    for i in 0..60 {
        let world = DVec3::new(-0.3 + 0.01 * f64::from(i), 0.04, 0.017);
        let stretched = file_bent.at(file.medium(), position(&file, world));
        let expected = plain_bent.at(plain.medium(), position(&plain, world));
        for (stretched, expected) in stretched.into_iter().zip(expected) {
            // Gas less than 1 K hotter than the air is left out of either, but not at the same places.
            assert!(
                (stretched - expected).abs() < 1e-6 + 1e-4 * expected.abs(),
                "{world}"
            );
        }
    }
}

#[test]
fn hot_clear_gas_is_stored_where_light_is_bent_and_changes_no_peak() {
    let soot = |point: DVec3| if point.z < -0.2 { 1e-6 } else { 0.0 };
    let straight = Gas {
        bending: None,
        ..Gas::default()
    };
    let heat = ball(DVec3::ZERO);
    let without = straight.flame(&heat, soot);
    let with = Gas::default().flame(&heat, soot);
    assert_eq!(with.medium().peaks, without.medium().peaks);
    assert!(with.medium().peaks.temperature_k < 400.0);
    assert!(Refractivity::new(&without, 550.0).is_none());
    let bent = Refractivity::new(&with, 550.0).unwrap();
    let place = DVec3::new(0.08, 0.0, 0.0);
    assert!(bent.at(with.medium(), position(&with, place))[1] > 1e-4);
    assert_eq!(
        without.medium().sample(position(&without, place).into()),
        [0.0; 2]
    );
    // Far from gas and soot there is nothing still.
    let (stored, all) = with.medium().occupancy();
    assert!(
        stored > without.medium().occupancy().0 && stored < all,
        "{stored} of {all}"
    );
}

#[test]
fn the_gradient_has_no_step_at_the_faces_of_bricks() {
    // A ball whose edge is as sharp as a grid can hold it, in every place to the bricks.
    for i in 0..8 {
        let middle = DVec3::splat(0.01 * f64::from(i));
        let edge = |point: DVec3| {
            if (point - middle).length() < 0.115 {
                1500.0
            } else {
                300.0
            }
        };
        let flame = Gas::default().flame(edge, clear);
        let bent = Refractivity::new(&flame, 550.0).unwrap();
        let medium = flame.medium();
        let mut seen = 0.0_f32;
        for j in 0..4000 {
            let j = f64::from(j);
            let share = DVec3::new(j * 0.618_034, j * 0.414_214, j * 0.732_051).fract();
            let place = medium.domain.min + share * medium.domain.size();
            for axis in DVec3::AXES {
                let face = (place / 8.0).round() * 8.0;
                let on_face = place * (DVec3::ONE - axis) + face * axis;
                let sides = [-1e-4, 1e-4].map(|d| bent.at(medium, (on_face + d * axis).to_array()));
                for (a, b) in sides[0].into_iter().zip(sides[1]) {
                    seen = seen.max(a.abs());
                    // n changes by 2e-4 in a voxel, the gradient by 1e-2/m.
                    assert!((a - b).abs() < 1e-5, "{on_face}: {sides:?}");
                }
            }
        }
        assert!(seen > 2e-3, "{seen}");
    }
}

#[test]
fn all_that_is_known_of_the_air_counts() {
    let room = Air::default();
    let base = Gas::default();
    let others = [
        Air {
            humidity: 1.0,
            ..room
        },
        Air {
            co2_ppm: 2000.0,
            ..room
        },
        Air {
            pressure_pa: 8e4,
            ..room
        },
        Air {
            edition: Edition::Ciddor1996,
            ..room
        },
        Air {
            temperature_k: 280.0,
            ..room
        },
    ];
    let gas_of = |air: Air| {
        let gas = Gas {
            air,
            clear_k: 0.0,
            ..Gas::default()
        };
        let flame = gas.flame(ball(DVec3::ZERO), clear);
        let bent = Refractivity::new(&flame, 550.0).unwrap();
        let at = bent.at(
            flame.medium(),
            position(&flame, DVec3::new(0.075, 0.005, 0.005)),
        );
        (gas, bent.ambient(), f64::from(at[0]))
    };
    for air in others {
        let (gas, ambient, excess) = gas_of(air);
        assert_eq!(ambient, gas.law(air.temperature_k), "{air:?}");
        assert_ne!(ambient, base.law(300.0), "{air:?}");
        let expected = gas.law(ball(DVec3::ZERO)(DVec3::new(0.075, 0.005, 0.005))) - ambient;
        assert!(
            (excess / expected - 1.0).abs() < 1e-5,
            "{air:?}: {excess:e}, not {expected:e}"
        );
    }
}

#[test]
fn air_that_no_law_knows_bends_nothing() {
    let impossible = Gas {
        air: Air {
            humidity: 2.0,
            ..Air::default()
        },
        ..Gas::default()
    };
    let flame = impossible.flame(ball(DVec3::ZERO), clear);
    assert!(Refractivity::new(&flame, 550.0).is_none());
    let flame = Gas::default().flame(ball(DVec3::ZERO), clear);
    assert!(Refractivity::new(&flame, 100.0).is_none());
}

#[test]
fn each_of_the_three_paths_is_at_the_mean_of_its_light() {
    let mut sums = [[0.0; 2]; 3];
    for nm in (360..=830).map(f64::from) {
        for (sum, weight) in sums.iter_mut().zip(cie::colour_matching(nm)) {
            let weight = weight * cie::d65(nm);
            *sum = [sum[0] + weight * nm, sum[1] + weight];
        }
    }
    for ([moment, weight], path) in sums.into_iter().zip(PATHS_NM) {
        assert!(
            (moment / weight - path).abs() < 0.05,
            "{}, not {path}",
            moment / weight
        );
    }
}
