//! Bricks know what they hold, whichever way they are filled.

use super::*;

#[test]
fn a_brick_knows_the_box_of_its_data() {
    for (min, max) in [
        ([0, 0, 0], [8, 8, 8]),
        ([3, 4, 5], [4, 5, 6]),
        ([0, 7, 1], [8, 8, 8]),
        ([7, 0, 0], [8, 1, 8]),
    ] {
        let inside = IndexBox {
            min: min.into(),
            max: max.into(),
        };
        let coordinate = IVec3::new(-2, 0, 5);
        let origin = coordinate * BRICK_EDGE;
        let brick = NewBrick::from_samples(coordinate, 0.0, |voxel| {
            let local = voxel - origin;
            let is_in = local.cmpge(inside.min).all() && local.cmplt(inside.max).all();
            is_in.then_some(1.0)
        });
        assert_eq!(brick.tally.bounds.min, origin + inside.min);
        assert_eq!(brick.tally.bounds.max, origin + inside.max);
        let count = inside.dims().element_product();
        assert_eq!(brick.tally.active, count as u64);
    }
    let empty = NewBrick::from_samples(IVec3::ONE, 0.0, |_| None);
    assert!(empty.tally.bounds.is_empty() && empty.brick.is_none());
}

#[test]
fn rows_of_a_box_fill_bricks_as_samples_do() {
    let dims = IVec3::new(11, 9, 10);
    let values: Vec<f32> = (0..dims.element_product()).map(|i| i as f32).collect();
    let row = |y: i32, z: i32| {
        let begin = (dims.x * (y + dims.y * z)) as usize;
        &values[begin..begin + dims.x as usize]
    };
    for coordinate in [IVec3::ZERO, IVec3::X, IVec3::Z, IVec3::ONE] {
        let by_rows = NewBrick::from_rows(coordinate, -1.0, dims, row);
        let by_samples = NewBrick::from_samples(coordinate, -1.0, |voxel| {
            let inside = voxel.cmplt(dims).all();
            inside.then(|| row(voxel.y, voxel.z)[voxel.x as usize])
        });
        assert_eq!(by_rows.tally.bounds, by_samples.tally.bounds);
        assert_eq!(by_rows.tally.range, by_samples.tally.range);
        let samples = |new: &NewBrick| match &new.brick {
            Some(Brick::Dense(values)) => values.to_vec(),
            _ => Vec::new(),
        };
        assert_eq!(samples(&by_rows), samples(&by_samples));
        assert!(!samples(&by_rows).is_empty());
    }
}
