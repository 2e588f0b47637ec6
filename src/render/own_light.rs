//! What a place in the fire sees of its own glow, finer than any cells show.
//!
//! Cells smear what glows over about a cell, and soot is where soot glows: the light that sheets of it scatter comes
//! largely from themselves, and smeared it would be too little. So the field of [`super::scatter`] holds its light less
//! what its cells see of their own glow, and each sample of the march adds what it sees of its own:
//!
//! ```text
//! J(x) = J_cells(x) − own(j̄, σ̄)(x) + own(j(x), σ(x)),   own(j, σ) = j ℓ/(1 + σ ℓ)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | j, σ | emission coefficient and extinction of the sample | W m⁻³ sr⁻¹ nm⁻¹, 1/m |
//! | j̄, σ̄ | of the cells, as smeared as J_cells is | the same |
//! | ℓ | how far a place sees its own glow | m |
//!
//! # Why
//!
//! Where light is not dimmed, J is j convolved with 1/(4π r²), whose Fourier transform is π/(2k): the shorter a wave of j,
//! the less of it arrives. What cells take from a wave by smearing, own light gives back with ℓ in the place of π/(2k):
//! exactly for the one wave whose k is π/(2ℓ). Half a voxel is right for the shortest that a grid of voxels holds, k = π for
//! each voxel. Dense soot hides itself: own light is never more than the source function j/σ, and even fire sees no
//! difference.

/// The reach ℓ where cells are as small as voxels, in voxels.
const REACH_VOXELS: f64 = 0.5;

/// The reach ℓ of cells of so many voxels' edge, m.
///
/// Larger cells smear longer waves as well. That ℓ grows with the cube root of the edge is fitted: least squares over four
/// fires find 0.4 to 0.5 voxels for cells of 1, 0.6 to 0.7 for 2 and 0.8 to 1.0 for 4.
pub(super) fn reach_m(edge_voxels: f64, voxel_m: f64) -> f64 {
    REACH_VOXELS * edge_voxels.cbrt() * voxel_m
}

/// A place's own light on itself: radiance, where a length of it emits so much radiance and is so deep. No length is
/// clear and dark.
#[inline(always)]
pub(super) fn own_light(emitted: f32, depth: f32, length_m: f32, reach_m: f32) -> f32 {
    emitted * reach_m / (length_m + depth * reach_m).max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_light_is_the_glow_within_reach_and_at_most_the_source_function() {
        // j = 5, ℓ = 0.01: clear, and so deep that only j/σ is left.
        let (length, reach) = (0.002, 0.01);
        let clear = own_light(5.0 * length, 0.0, length, reach);
        assert!((clear - 0.05).abs() < 1e-8, "{clear}");
        let deep = own_light(5.0 * length, 1e6 * length, length, reach);
        assert!((deep / 5e-6 - 1.0).abs() < 1e-3, "{deep}");
        assert_eq!(own_light(0.0, 0.0, 0.0, reach), 0.0);
    }
}
