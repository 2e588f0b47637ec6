//! Which of several ways are worth their time: those that no other is both quicker and more exact than.

/// Which of these (seconds, error) no other one beats in both; equal ones stand side by side.
pub(super) fn front(points: &[[f64; 2]]) -> Vec<bool> {
    let beats =
        |one: &[f64; 2], other: &[f64; 2]| one[0] <= other[0] && one[1] <= other[1] && one != other;
    let is_on = |point: &[f64; 2]| {
        point.iter().all(|value| value.is_finite()) && !points.iter().any(|it| beats(it, point))
    };
    points.iter().map(is_on).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_slower_and_less_exact_is_not_on_the_front() {
        let points = [
            [1.0, 5.0],
            [2.0, 1.0],
            [3.0, 1.0],
            [4.0, 0.1],
            [2.0, 6.0],
            [f64::NAN, 0.0],
        ];
        assert_eq!(front(&points), [true, true, false, true, false, false]);
        assert_eq!(front(&[[1.0, 1.0], [1.0, 1.0]]), [true, true]);
        assert!(front(&[]).is_empty());
    }
}
