//! The refractive index of a flame's gas, place by place.

use super::flame::Flame;

/// n − 1 and its gradient in the bricks of a medium.
#[derive(Debug)]
pub struct Refractivity {}

impl Refractivity {
    /// The gas of a flame for light of a vacuum wavelength (nm); `None` where the flame bends no light.
    pub fn new(flame: &Flame, lambda_nm: f64) -> Option<Self> {
        let _ = lambda_nm;
        flame.bending().map(|_| Self {})
    }
}
