//! The irradiance that a clear ball of even emission throws on a surface, near or far.
//!
//! With the ball's power J in each direction (W sr⁻¹), the distance d of its centre from the surface point and the
//! centre's height h above the point's horizon, all lengths in units of the ball's radius R,
//!
//! ```text
//! E = j ∫ max(0, z)/r³ dV = J/(2R²) (N + S),   N = h / max(d, 1)³
//! S = m(h) (1 + 0.7 (1 − h²)³/d⁵)/d³                              d ≥ 1
//! S = 3/2 + (S(h/d, 1) − 3/2) d² (0.6 + 0.4 d²)                   d < 1
//! m(h) = 3/8 + 3/4 h² − 1/8 h⁴  for |h| < 1,   |h| beyond
//! ```
//!
//! N is what comes from above less what comes from below, as of gravity: outside of a ball it acts as if it stood in its
//! centre, inside its field grows evenly (Newton, Principia I, propositions 70 to 74). S is the sum of both. m is the mean
//! height |z| of the ball's points; what multiplies it is fitted to sums over chords, and 3/2 is S in the middle.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | E | irradiance | W m⁻² |
//! | j | emission coefficient, J over the ball's volume | W m⁻³ sr⁻¹ |
//!
//! **Validity.** Exact where all of the ball is above the horizon or below and in its middle; else within 0.03 J/R².
//!
//! **Source.** Own derivation.

/// E/J of a ball of a radius (m) whose centre is `distance` away and `height` above the horizon (m, |height| ≤ distance),
/// 1/m².
#[inline]
pub(super) fn irradiance_per_power(height: f64, distance: f64, radius_m: f64) -> f64 {
    if height >= radius_m {
        return height / (distance * distance * distance);
    }
    if height <= -radius_m {
        return 0.0;
    }
    let (h, d) = (height / radius_m, distance / radius_m);
    let outside = d.max(1.0);
    let net = h / (outside * outside * outside);
    let sum = if d >= 1.0 {
        from_both_sides(h, d)
    } else {
        let on_the_surface = from_both_sides(if d > 0.0 { h / d } else { 0.0 }, 1.0);
        let d2 = d * d;
        1.5 + (on_the_surface - 1.5) * d2 * (0.6 + 0.4 * d2)
    };
    0.5 * (net + sum).max(0.0) / (radius_m * radius_m)
}

/// S on or outside of the ball, for |h| ≤ 1.
#[inline]
fn from_both_sides(h: f64, d: f64) -> f64 {
    let h2 = h * h;
    let mean_height = 0.375 + h2 * (0.75 - 0.125 * h2);
    let (level, d3) = (1.0 - h2, d * d * d);
    mean_height * (1.0 + 0.7 * level * level * level / (d3 * d * d)) / d3
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E R²/J of a ball of radius 1 by a sum over directions of chord times cosine.
    fn by_chords(height: f64, distance: f64) -> f64 {
        const RINGS: u32 = 300;
        let aside = (distance * distance - height * height).max(0.0).sqrt();
        let mut sum = 0.0;
        for ring in 0..RINGS {
            let sine2 = (f64::from(ring) + 0.5) / f64::from(RINGS);
            for step in 0..2 * RINGS {
                let turn = std::f64::consts::TAU * (f64::from(step) + 0.5) / f64::from(2 * RINGS);
                // Along the ray, the middle of the chord and half of it.
                let middle = sine2.sqrt() * turn.cos() * aside + (1.0 - sine2).sqrt() * height;
                let half2 = 1.0 - distance * distance + middle * middle;
                if half2 > 0.0 {
                    let half = half2.sqrt();
                    sum += ((middle + half).max(0.0) - (middle - half).max(0.0))
                        / f64::from(2 * RINGS * RINGS);
                }
            }
        }
        // j π ⟨chord⟩ with J = 4π/3 j.
        0.75 * sum
    }

    #[test]
    fn it_is_the_sum_over_the_chords() {
        let mut worst = 0.0_f64;
        for (height, distance) in [
            (3.0, 3.0),
            (1.0, 2.5),
            (1.2, 1.3),
            (0.0, 0.0),
            (0.0, 0.5),
            (0.3, 0.3),
            (-0.3, 0.3),
            (0.5, 0.8),
            (-0.5, 0.8),
            (0.8, 0.8),
            (1.0, 1.0),
            (0.0, 1.0),
            (0.4, 1.2),
            (-0.4, 1.2),
            (0.0, 2.0),
            (0.5, 3.0),
            (-0.5, 3.0),
            (-1.0, 2.0),
        ] {
            let (ours, chords) = (
                irradiance_per_power(2.0 * height, 2.0 * distance, 2.0) * 4.0,
                by_chords(height, distance),
            );
            worst = worst.max((ours - chords).abs());
        }
        assert!(worst < 0.03, "{worst}");
    }

    #[test]
    fn it_has_no_steps() {
        for (height, distance) in [(1.0, 1.0), (1.0, 2.0), (-1.0, 1.5), (0.2, 1.0)] {
            let near = |by: f64| irradiance_per_power(height + by, distance + by.abs(), 1.0);
            assert!((near(1e-7) - near(-1e-7)).abs() < 1e-5);
        }
    }
}
