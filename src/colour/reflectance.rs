//! Stub.

/// Reflectance 0 to 1 of a surface colour (linear Rec. 709) at a wavelength in nm.
pub fn at(colour: [f64; 3], lambda_nm: f64) -> f64 {
    let _ = lambda_nm;
    colour[1]
}
