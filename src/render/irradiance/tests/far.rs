//! From outside of the fire.

use super::*;

#[test]
fn far_away_it_falls_with_the_square_of_the_distance() {
    let scene = torch();
    let plan = plan(&scene);
    let light = light(&scene, &plan, Level::Fine);
    let direction = DVec3::new(0.48, -0.8, 0.36);
    let at = |distance: f64| {
        let point = DVec3::new(0.0, 0.0, 0.2) + distance * direction;
        irradiance(&light, &plan, &Stage::default(), [point, -direction])
    };
    let [near, far] = [at(20.0), at(80.0)].map(|light| light[2]);
    assert!((near / far / 16.0 - 1.0).abs() < 0.01, "{near} {far}");
}

#[test]
fn it_is_what_the_march_sees_from_the_same_point() {
    let mut scenes = vec![("torch", torch(), DVec3::new(0.0, 0.0, 0.2), 0.5)];
    for (name, file) in [
        ("pool", "pool/pool_0022_zip_half.vdb"),
        ("campfire", "campfire/campfire_0022_zip_half.vdb"),
    ] {
        if let Some(scene) = shared(file) {
            let medium = scene.flame.medium();
            let world = medium.lattice_from_world.inverse();
            let centre = world.transform_point3(medium.domain.centre());
            let size = medium.domain.size().max_element() * medium.voxel_size_m();
            scenes.push((name, scene, centre, size));
        }
    }
    for (name, scene, centre, size) in scenes {
        let plan = plan(&scene);
        for level in [Level::Coarse, Level::Fine] {
            let start = std::time::Instant::now();
            let light = light(&scene, &plan, level);
            println!(
                "{name} {level:?}: {:?} nodes {} tables {}",
                start.elapsed(),
                light.tree.nodes.len(),
                light.tree.tables
            );
            for (direction, distance) in [
                (DVec3::new(1.0, 0.0, 0.0), 30.0),
                (DVec3::new(0.48, -0.8, 0.36), 3.0),
                (DVec3::new(0.3, 0.2, 0.93), 1.0),
                (DVec3::new(-0.6, 0.5, -0.62), 1.0),
            ] {
                let direction = direction.normalize();
                let point = centre + distance * size * direction;
                let place = [point, -direction];
                let ours = irradiance(&light, &plan, &Stage::default(), place);
                let fov = 2.0 * (0.9 / distance).atan().to_degrees();
                let marched = marched_irradiance(&scene, &plan, place, fov);
                println!(
                    "  {distance} sizes off: {:.2e}   {:.4?}",
                    off(&ours, &marched),
                    ours.iter()
                        .zip(&marched)
                        .map(|(a, b)| a / b - 1.0)
                        .collect::<Vec<_>>()
                );
            }
            let start = std::time::Instant::now();
            let mut sum = 0.0;
            for i in 0..2000 {
                let a = f64::from(i) * 0.1;
                let point = centre
                    + DVec3::new(a.cos(), a.sin(), 0.0) * size * f64::from(i) / 2000.0
                    - DVec3::Z * 0.5 * size;
                sum += irradiance(&light, &plan, &Stage::default(), [point, DVec3::Z])[0];
            }
            println!("  ground: {:?} a point ({sum:.1e})", start.elapsed() / 2000);
        }
    }
}

#[test]
#[ignore = "experiment"]
fn experiment() {
    let mut scenes = vec![("torch", torch(), DVec3::new(0.0, 0.0, 0.2), 0.5)];
    if let Some(scene) = shared("pool/pool_0022_zip_half.vdb") {
        let medium = scene.flame.medium();
        let world = medium.lattice_from_world.inverse();
        let centre = world.transform_point3(medium.domain.centre());
        let size = medium.domain.size().max_element() * medium.voxel_size_m();
        scenes.push(("pool", scene, centre, size));
    }
    for (name, scene, centre, size) in scenes {
        let plan = plan(&scene);
        let places = [
            (DVec3::new(0.3, 0.2, 0.93), 1.0),
            (DVec3::new(0.3, 0.2, 0.93), 30.0),
            (DVec3::new(0.48, -0.8, 0.36), 30.0),
            (DVec3::new(0.7, -0.3, -0.4), 0.6),
        ];
        let place = |(direction, distance): (DVec3, f64)| {
            let direction = direction.normalize();
            let fov = 2.0
                * (if distance > 2.0 {
                    0.9 / distance
                } else {
                    1.8 / distance
                })
                .atan()
                .to_degrees();
            ([centre + distance * size * direction, -direction], fov)
        };
        let marched: Vec<_> = places
            .iter()
            .map(|&p| marched_irradiance(&scene, &plan, place(p).0, place(p).1))
            .collect();
        let fine = Effort::of(Level::Fine);
        for (what, effort) in [
            ("fine", fine),
            (
                "opening 0.1",
                Effort {
                    opening: 0.1,
                    ..fine
                },
            ),
            (
                "squares 48",
                Effort {
                    squares: 48,
                    steps: usize::MAX,
                    table_blocks: 100_000_000,
                    ..fine
                },
            ),
            (
                "squares 48 opening 0.1",
                Effort {
                    opening: 0.1,
                    squares: 48,
                    steps: usize::MAX,
                    table_blocks: 100_000_000,
                    ..fine
                },
            ),
            (
                "cells 8",
                Effort {
                    finest: Fineness {
                        cells: 8,
                        points: 16,
                    },
                    steps: usize::MAX,
                    ..fine
                },
            ),
        ] {
            let start = std::time::Instant::now();
            let light = FireLight::with(&scene, &plan.tables, &effort, &Cancel::never()).unwrap();
            let took = start.elapsed();
            for (p, marched) in places.iter().zip(&marched) {
                let ours = irradiance(&light, &plan, &Stage::default(), place(*p).0);
                println!(
                    "{name} {what} {took:?} {} tables: {:.4?}",
                    light.tree.tables,
                    ours.iter()
                        .zip(marched)
                        .map(|(a, b)| a / b - 1.0)
                        .collect::<Vec<_>>()
                );
            }
        }
    }
}
