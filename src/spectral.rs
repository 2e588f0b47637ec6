//! Wavelengths with weights.
