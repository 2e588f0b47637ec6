//! The irradiance that a clear ball of even emission throws on a surface, near or far.
//!
//! With the ball's power J in each direction (W sr⁻¹), the distance d of its centre from the surface point and the
//! centre's height h above the point's horizon, all lengths in units of the ball's radius R,
//!
//! ```text
//! E = j ∫ max(0, z)/r³ dV = J/(2R²) (N + S),   N = h / max(d, 1)³,   S = m(h)/(d² + c(d))^{3/2}
//! m(h) = 3/8 + 3/4 h² − 1/8 h⁴  for |h| < 1,   |h| beyond
//! ```
//!
//! N is what comes from above less what comes from below, as of gravity: outside of a ball it acts as if it stood in its
//! centre, inside its field grows evenly (Newton, Principia I, propositions 70 to 74). S is the sum of both. m is the mean
//! height |z| of the ball's points; c is 0 outside and lets S grow to 3/2, its value in the middle, inside.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | E | irradiance | W m⁻² |
//! | j | emission coefficient, J over the ball's volume | W m⁻³ sr⁻¹ |
//!
//! **Validity.** Exact where all of the ball is above the horizon or below, and with the horizon through the middle of the
//! ball; between, within a few hundredths of J/R² (the tests say how many).
//!
//! **Source.** Own derivation.

/// c in the middle of the ball: there S = 3/8 c^{−3/2} = 3/2.
const MIDDLE: f64 = 0.396_850_262_992_05;

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
    let h2 = h * h;
    let mean_height = 0.375 + h2 * (0.75 - 0.125 * h2);
    let inside = (1.0 - d * d).max(0.0);
    let reach = d * d + MIDDLE * inside * inside;
    let sum = mean_height / (reach * reach.sqrt());
    0.5 * (net + sum).max(0.0) / (radius_m * radius_m)
}
