//! Light that is scattered again, in cells larger than those of the first order.

use super::*;

/// What light that is scattered again adds to an even ball in cells of at most two voxels' edge, less the same in those of one:
/// its mean and root mean square, for all that it adds.
fn again_in_larger_cells(soot_and_smoke: [f32; 2]) -> [f64; 2] {
    let scene = scene(ball_with_smoke(24.0, soot_and_smoke, 1600.0), 60.0, None);
    let plan = plan(&scene);
    let with_cells = |again: bool, cells_again: usize| {
        let effort = Effort {
            cells_again,
            ..FINE
        };
        with(&scene, &plan, again, effort, &Cancel::never()).unwrap()
    };
    let fields = [
        with_cells(false, 0),
        with_cells(true, 30_000),
        with_cells(true, usize::MAX),
    ];
    println!(
        "scattered at least twice: {:.3}",
        share_beyond(fields[0].share, 1)
    );
    let [once, larger, as_small] = fields.each_ref().map(|field| field.light.iter().flatten());
    let (mut sum, mut off, mut square) = (0.0, 0.0, 0.0);
    for ((once, larger), as_small) in once.zip(larger).zip(as_small) {
        let added = f64::from(*as_small - *once);
        let error = f64::from(*larger - *as_small);
        sum += added * added;
        off += added * error;
        square += error * error;
    }
    [off / sum, (square / sum).sqrt()]
}

#[test]
fn light_that_is_scattered_again_is_the_same_in_larger_cells_where_little_is() {
    let [mean, rms] = again_in_larger_cells([2e-7, 0.0]);
    println!("in larger cells: mean {mean:.4}, rms {rms:.4}");
    // It is at the ball's sharp edge; cells of four voxels are 3 % and 4 % off.
    assert!(
        rms > 0.0 && mean.abs() < 0.015 && rms < 0.025,
        "{mean} {rms}"
    );
    // Where cells are deep, and where much is scattered, they stay as small as the first order's.
    assert_eq!(again_in_larger_cells([1e-4, 0.0]), [0.0, 0.0]);
    assert_eq!(again_in_larger_cells([2e-7, 2e-6]), [0.0, 0.0]);
}
