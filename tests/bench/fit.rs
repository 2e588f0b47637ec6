//! A table of times against something that grows, with its exponent.

use std::hint::black_box;
use std::time::Instant;

/// How often each case is timed.
const ROUNDS: usize = 5;

/// Something to be timed at one value of what grows; it gives how much of its work it counted.
pub(crate) struct Case<'a> {
    at: f64,
    work: Box<dyn Fn() -> u64 + 'a>,
}

impl<'a> Case<'a> {
    pub(crate) fn new(at: f64, work: impl Fn() -> u64 + 'a) -> Self {
        Self {
            at,
            work: Box::new(work),
        }
    }
}

/// What grows, and what is timed.
pub(crate) struct Axis {
    grows: &'static str,
    timed: &'static str,
    counted: &'static str,
}

impl Axis {
    pub(crate) fn new(grows: &'static str, timed: &'static str) -> Self {
        Self {
            grows,
            timed,
            counted: "samples",
        }
    }

    /// Names what the work counts.
    pub(crate) fn counts(self, counted: &'static str) -> Self {
        Self { counted, ..self }
    }

    /// Times the cases by turns and prints their medians, and the exponents of time and of what was counted.
    pub(crate) fn print(&self, cases: &[Case<'_>]) {
        let mut times = vec![Vec::new(); cases.len()];
        let mut counts = vec![0; cases.len()];
        for _ in 0..ROUNDS {
            for ((case, times), count) in cases.iter().zip(&mut times).zip(&mut counts) {
                let begun = Instant::now();
                *count = black_box((case.work)());
                times.push(1e3 * begun.elapsed().as_secs_f64());
            }
        }
        let points: Vec<[f64; 3]> = cases
            .iter()
            .zip(&times)
            .zip(&counts)
            .map(|((case, times), count)| [case.at, median(times), *count as f64])
            .collect();
        let along = |axis: usize| points.iter().map(move |point| [point[0], point[axis]]);
        let rows: Vec<String> = points
            .iter()
            .map(|[at, ms, _]| format!("{} {ms:.1}", short(*at)))
            .collect();
        println!(
            "  {:<18} {:<12} time ^ {:>5.2}, {} ^ {:>5.2};  ms: {}",
            self.grows,
            self.timed,
            exponent(along(1)),
            self.counted,
            exponent(along(2)),
            rows.join(", ")
        );
    }
}

/// A number as short as it can be read.
pub(crate) fn short(value: f64) -> String {
    if value >= 1.0 {
        format!("{value:.0}")
    } else {
        format!("{value:.3}")
    }
}

pub(crate) fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The slope of the straight line through the logarithms of points that has the least squares.
pub(crate) fn exponent(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    let points: Vec<[f64; 2]> = points.map(|point| point.map(f64::ln)).collect();
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let products = points.iter().map(|point| (point[0] - x) * (point[1] - y));
    let squares = points.iter().map(|point| (point[0] - x).powi(2));
    products.sum::<f64>() / squares.sum::<f64>()
}
