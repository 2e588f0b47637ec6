//! Tests of the packing.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use super::*;
use crate::volume::{FieldMap, Grid};

/// Two single voxels, `apart` voxels apart, in a grid each with its own voxel size.
fn far(apart: f64, second_scale: f64) -> Volume {
    let grid = |name: &str, shift: f64, scale: f64| {
        let world = DAffine3::from_translation(DVec3::splat(shift))
            * DAffine3::from_scale(DVec3::splat(scale));
        Grid::from_fn(name, IVec3::ONE, world, Border::Background, 0.0, |_| 1e-6)
    };
    Volume::from_grids(
        vec![grid("soot", 0.0, 1.0), grid("smoke", apart, second_scale)],
        "far",
    )
}

fn maps(offset: f64) -> FieldMaps {
    let map = |grid: &str| Some(FieldMap::new(grid, 1.0, offset, 0.0, 1.0));
    FieldMaps {
        soot: map("soot"),
        smoke: map("smoke"),
        ..FieldMaps::default()
    }
}

fn packed(volume: &Volume, maps: &FieldMaps, limits: &Limits) -> Result<Medium, PackingError> {
    let fields = Fields {
        volume,
        maps,
        amounts: [1.0, 1.0],
        ambient_k: 300.0,
        gas: GasFields::default(),
        smoke_apart: false,
        interpolation: Interpolation::default(),
    };
    assert_eq!(
        fields.check(limits).err(),
        fields.pack(&DAffine3::IDENTITY, limits).err()
    );
    fields.pack(&DAffine3::IDENTITY, limits)
}

#[test]
fn fields_far_apart_are_packed_sparsely_or_refused() {
    let limits = Limits::default();
    let medium = packed(&far(1600.0, 1.0), &maps(0.0), &limits).unwrap();
    assert!(medium.occupancy().0 <= 16);
    for (apart, scale) in [(1e5, 1.0), (1e12, 1.0), (0.0, 1e12), (1e15, 1e-3)] {
        let refused = packed(&far(apart, scale), &maps(0.0), &limits)
            .err()
            .unwrap();
        assert!(
            matches!(refused, PackingError::TooWide { .. }),
            "{apart} {scale}: {refused}"
        );
    }
}

#[test]
fn soot_in_all_of_the_air_is_refused_before_it_is_allocated() {
    let dot = |voxel: IVec3| if voxel == IVec3::splat(30) { 1e-6 } else { 0.0 };
    let dims = IVec3::splat(64);
    let grid = Grid::from_fn(
        "soot",
        dims,
        DAffine3::IDENTITY,
        Border::Background,
        0.0,
        dot,
    );
    let volume = Volume::from_grids(vec![grid], "dot");
    let limits = Limits {
        max_bytes: 1 << 20,
        ..Limits::default()
    };
    assert!(packed(&volume, &maps(0.0), &limits).is_ok());
    let refused = packed(&volume, &maps(1e-9), &limits).err().unwrap();
    assert!(
        matches!(refused, PackingError::TooLarge { bricks: 1000, .. }),
        "{refused}"
    );
    assert!(refused.to_string().contains("offset"), "{refused}");
}

#[test]
fn a_resampled_field_lies_where_the_file_puts_it() {
    // The same ball of smoke on the soot's own lattice and on one of half the voxel size, shifted.
    let ball = |world: DAffine3| {
        move |voxel: IVec3| {
            let point = world.transform_point3(voxel.as_dvec3());
            (1e-6 * (1.0 - (point - 10.0).length() / 6.0)).max(0.0) as f32
        }
    };
    let coarse = DAffine3::IDENTITY;
    let fine =
        DAffine3::from_scale(DVec3::splat(0.5)) * DAffine3::from_translation(DVec3::splat(0.37));
    let grid = |name: &str, dims: i32, world: DAffine3| {
        Grid::from_fn(
            name,
            IVec3::splat(dims),
            world,
            Border::Background,
            0.0,
            ball(world),
        )
    };
    let nothing = Grid::from_fn(
        "soot",
        IVec3::splat(20),
        coarse,
        Border::Background,
        0.0,
        |_| 0.0,
    );
    let smoke = |world, dims| {
        let nothing = nothing.clone();
        let volume = Volume::from_grids(vec![nothing, grid("smoke", dims, world)], "ball");
        packed(&volume, &maps(0.0), &Limits::default()).unwrap()
    };
    let (own, resampled) = (smoke(coarse, 20), smoke(fine, 40));
    for point in [
        DVec3::splat(10.0),
        DVec3::new(7.3, 11.2, 9.9),
        DVec3::new(12.5, 12.5, 8.0),
    ] {
        let at =
            |medium: &Medium| medium.sample(medium.lattice_from_world.transform_point3(point))[0];
        // Both are the cone's trilinear interpolant; half a voxel of its slope is the most they differ.
        assert!((at(&own) - at(&resampled)).abs() < 0.5e-6 / 6.0, "{point}");
        assert!(at(&own) > 1e-8);
    }
}

#[test]
fn hot_air_is_refused_before_it_is_allocated_and_its_flame_field_counts() {
    // A dot of soot in 64³ voxels of gas at 1000 K, inside the grid and around it.
    let grid = |name: &str, around: f32, dot: f32| {
        let (dims, world) = (IVec3::splat(64), DAffine3::IDENTITY);
        let value = move |voxel: IVec3| {
            if voxel == IVec3::splat(30) {
                dot
            } else {
                around
            }
        };
        Grid::from_fn(name, dims, world, Border::Background, around, value)
    };
    let volume = Volume::from_grids(
        vec![
            grid("soot", 0.0, 1e-6),
            grid("temperature", 1000.0, 1500.0),
            grid("flame", 0.0, 1.0),
        ],
        "hot air",
    );
    let map = |grid: &str, max: f64| Some(FieldMap::new(grid, 1.0, 0.0, 0.0, max));
    let maps = FieldMaps {
        soot: map("soot", 1.0),
        temperature: map("temperature", 1e4),
        flame: map("flame", 1.0),
        ..FieldMaps::default()
    };
    let limits = Limits {
        max_bytes: 2 << 20,
        ..Limits::default()
    };
    let bytes = |hot_above_k: Option<f64>, burning: Option<Burning>| {
        let fields = Fields {
            volume: &volume,
            maps: &maps,
            amounts: [1.0, 0.0],
            ambient_k: 300.0,
            smoke_apart: false,
            gas: GasFields {
                burning,
                hot_above_k,
                bends_above_k: None,
            },
            interpolation: Interpolation::Tricubic,
        };
        match fields.pack(&DAffine3::IDENTITY, &limits) {
            Ok(medium) => Ok(medium.bytes()),
            Err(PackingError::TooLarge { bytes, .. }) => Err(bytes),
            Err(other) => panic!("{other}"),
        }
    };
    assert!(bytes(None, None).is_ok() && bytes(None, Some(Burning::Field)).is_ok());
    let plain = bytes(Some(900.0), None).unwrap_err();
    let burning = bytes(Some(900.0), Some(Burning::Field)).unwrap_err();
    assert_eq!(
        3 * plain,
        2 * burning,
        "8 bytes for a sample, and 4 more for its flame"
    );
}

#[test]
fn smoke_is_told_apart_only_where_it_is_asked_for() {
    // Soot in one half of the lattice, smoke in the other and between: a brick's border lies within both.
    let grid = |name: &str, inside: fn(i32) -> bool, value: f32| {
        let of_voxel = move |voxel: IVec3| if inside(voxel.x) { value } else { 0.0 };
        let dims = IVec3::new(40, 12, 12);
        let world = DAffine3::IDENTITY;
        Grid::from_fn(name, dims, world, Border::Background, 0.0, of_voxel)
    };
    let grids = vec![
        grid("soot", |x| x < 22, 1e-6),
        grid("smoke", |x| x > 17, 4e-6),
    ];
    let volume = Volume::from_grids(grids, "halves");
    let pack = |maps: &FieldMaps, amounts: [f64; 2], smoke_apart: bool, max_bytes: u64| {
        let fields = Fields {
            volume: &volume,
            maps,
            amounts,
            ambient_k: 300.0,
            gas: GasFields::default(),
            smoke_apart,
            interpolation: Interpolation::default(),
        };
        let limits = Limits {
            max_bytes,
            ..Limits::default()
        };
        fields.pack(&DAffine3::IDENTITY, &limits)
    };
    let both = maps(0.0);
    let plain = pack(&both, [1.0, 0.5], false, u64::MAX).unwrap();
    let apart = pack(&both, [1.0, 0.5], true, u64::MAX).unwrap();
    assert!(plain.smoke.is_empty());
    assert_eq!(plain.samples, apart.samples);
    assert_eq!(apart.smoke.len(), apart.samples.len());
    for (x, soot, smoke) in [(3.0, 1e-6, 0.0), (20.0, 3e-6, 2e-6), (33.0, 2e-6, 2e-6)] {
        let at = apart
            .lattice_from_world
            .transform_point3(DVec3::new(x, 6.0, 6.0));
        assert!((apart.sample(at)[0] - soot).abs() < 1e-12);
        assert!((apart.smoke(at) - smoke).abs() < 1e-12);
        assert_eq!(plain.smoke(at), 0.0);
    }

    // Smoke alone is all that absorbs, bit for bit; without an amount there is none.
    let smoke_alone = FieldMaps {
        soot: None,
        ..both.clone()
    };
    let alone = pack(&smoke_alone, [0.0, 0.3], true, u64::MAX).unwrap();
    let fractions: Vec<f32> = alone.samples.iter().map(|sample| sample[0]).collect();
    assert_eq!(alone.smoke, fractions);
    assert!(
        pack(&both, [1.0, 0.0], true, u64::MAX)
            .unwrap()
            .smoke
            .is_empty()
    );

    // Its four bytes beside a sample's eight are in the limit.
    let bytes = |smoke_apart: bool| match pack(&both, [1.0, 0.5], smoke_apart, 1) {
        Err(PackingError::TooLarge { bytes, .. }) => bytes,
        _ => panic!("a byte is enough"),
    };
    assert_eq!(3 * bytes(false), 2 * bytes(true));
}

#[test]
fn soot_too_thin_to_be_seen_is_none_and_no_denormal_number_is_packed() {
    let fractions = [1e-30, 2e-31, 5e-32, 1e-36, 1e-40, 1e-45, 0.0];
    let dims = IVec3::new(fractions.len() as i32, 1, 1);
    let of_voxel = |voxel: IVec3| fractions[voxel.x as usize];
    let grid = |name: &str| {
        let place = DAffine3::IDENTITY;
        Grid::from_fn(name, dims, place, Border::Clamp, 0.0, of_voxel)
    };
    let volume = Volume::from_grids(vec![grid("soot"), grid("smoke")], "thin");
    let both = maps(0.0);
    let smoke_alone = FieldMaps {
        soot: None,
        ..both.clone()
    };
    for (maps, amounts) in [(&both, [1.0, 0.0]), (&smoke_alone, [0.0, 1.0])] {
        let fields = Fields {
            volume: &volume,
            maps,
            amounts,
            ambient_k: 300.0,
            gas: GasFields::default(),
            smoke_apart: amounts[1] > 0.0,
            interpolation: Interpolation::default(),
        };
        let medium = fields
            .pack(&DAffine3::IDENTITY, &Limits::default())
            .unwrap();
        let packed = medium.samples.iter().map(|sample| sample[0]);
        for value in packed.chain(medium.smoke.iter().copied()) {
            assert!(value == 0.0 || value > 1e-31, "{value:e}");
        }
        assert_eq!(medium.peak_volume_fraction(), 1e-30);
    }
}
