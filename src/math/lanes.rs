//! The one SIMD file: rays side by side in lanes, the exponential they need, and the choice of instruction set.
//!
//! Kernels are plain loops over `[f32; LANES]` that the compiler vectorises. [`dispatch`] instantiates a kernel
//! twice, for the baseline and for AVX2 with fused multiply-add, and picks one at run time. A fused product is rounded
//! once where the baseline rounds twice, so both give the same to a few of an f32's last bits; what a kernel computes
//! with is its [`Arithmetic`].
//!
//! # Exponential
//!
//! e^x − 1 with x = n ln 2 + r, |r| ≤ ln 2 / 2: `2ⁿ (e^r − 1) + (2ⁿ − 1)`, where e^r − 1 is a degree-7 Taylor
//! polynomial (truncation 5e-9 relative at |r| = ln 2 / 2). For n = 0 the polynomial stands alone, so the
//! relative accuracy holds as x → 0; the Cody–Waite split of ln 2 keeps r exact.

/// Rays marched side by side: two AVX2 registers, one AVX-512 register.
pub const LANES: usize = 16;

/// One f32 for each lane.
pub type Lanes = [f32; LANES];

/// Below this, e^x is taken as zero: 2⁻¹²⁶ is the smallest normal f32, and no radiance of this size is seen.
pub const EXP_UNDERFLOW: f32 = -87.0;

/// Up to here in magnitude the polynomial of [`exp_m1_thin_by`] stands alone: its next term is 0.5⁷/8! = 2e-7 of the first.
pub const THIN: f32 = 0.5;

/// ln 2 rounded to 12 bits, so that its product with a small integer is exact (Cody and Waite 1980).
const LN_2_HIGH: f32 = 0.693359375;
/// ln 2 − [`LN_2_HIGH`].
const LN_2_LOW: f32 = -2.1219444e-4;
/// Adding 1.5 · 2²³ rounds an f32 below 2²² in magnitude to the nearest integer, left in the low mantissa bits.
const ROUNDER: f32 = 12582912.0;

/// How a kernel adds a product.
pub trait Arithmetic {
    /// a b + c.
    fn madd(a: f32, b: f32, c: f32) -> f32;
}

/// On any processor: the product is rounded, then the sum.
pub struct Rounded;

impl Arithmetic for Rounded {
    #[inline(always)]
    fn madd(a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
}

/// Where a processor does both at once: the sum alone is rounded.
struct Fused;

impl Arithmetic for Fused {
    #[inline(always)]
    fn madd(a: f32, b: f32, c: f32) -> f32 {
        a.mul_add(b, c)
    }
}

/// [`exp_m1_by`] on any processor.
#[inline(always)]
pub fn exp_m1(x: f32) -> f32 {
    exp_m1_by::<Rounded>(x)
}

/// e^x − 1 for x ≤ 0 and small positive x, relative error below 3e-7; −1 below [`EXP_UNDERFLOW`].
///
/// Valid for x ≤ 88. NaN gives NaN.
#[inline(always)]
pub fn exp_m1_by<A: Arithmetic>(x: f32) -> f32 {
    exp_m1_within::<A>(if x < EXP_UNDERFLOW { EXP_UNDERFLOW } else { x })
}

/// e^x − 1 for |x| ≤ [`THIN`], relative error below 3e-7: the polynomial alone, without the reduction by powers of 2.
#[inline(always)]
pub fn exp_m1_thin_by<A: Arithmetic>(x: f32) -> f32 {
    let tail = A::madd(x, A::madd(x, 1.0 / 5040.0, 1.0 / 720.0), 1.0 / 120.0);
    let p = A::madd(x, A::madd(x, tail, 1.0 / 24.0), 1.0 / 6.0);
    // No x²: of an x below 1e-19 it is denormal, which many processors are slow at.
    x * A::madd(x, A::madd(x, p, 0.5), 1.0)
}

/// [`inverse_exp_m1_by`] on any processor.
#[inline(always)]
pub fn inverse_exp_m1(x: f32) -> f32 {
    inverse_exp_m1_by::<Rounded>(x)
}

/// 1/(e^x − 1) for x ≥ 0, relative error below 3e-7 + x·6e-8: Planck's law without its scale. Exactly 0 where e^{−x} is.
///
/// Not e^{−x}/(1 − e^{−x}), of which a small x leaves no digits. 1 − e^{−x} is one over this plus 1.
#[inline(always)]
pub fn inverse_exp_m1_by<A: Arithmetic>(x: f32) -> f32 {
    let is_beyond = x > -EXP_UNDERFLOW;
    let beyond_one = exp_m1_within::<A>(if is_beyond { -EXP_UNDERFLOW } else { x });
    // Chosen before the division: after it, a branch around the division would keep the loop from being vectorised.
    1.0 / if is_beyond { f32::INFINITY } else { beyond_one }
}

/// [`exp_m1`] between [`EXP_UNDERFLOW`] and 88.
#[inline(always)]
fn exp_m1_within<A: Arithmetic>(x: f32) -> f32 {
    let (power, r) = reduced::<A>(x);
    let tail = A::madd(r, A::madd(r, 1.0 / 5040.0, 1.0 / 720.0), 1.0 / 120.0);
    let tail = A::madd(r, A::madd(r, tail, 1.0 / 24.0), 1.0 / 6.0);
    let p = r * A::madd(r, A::madd(r, tail, 0.5), 1.0);
    A::madd(power, p, power - 1.0)
}

/// [`exp_by`] on any processor.
#[inline(always)]
pub fn exp(x: f32) -> f32 {
    exp_by::<Rounded>(x)
}

/// e^x for x ≤ 0 and small positive x, relative error below 3e-7 + |x|·6e-8; exactly 0 below [`EXP_UNDERFLOW`].
#[inline(always)]
pub fn exp_by<A: Arithmetic>(x: f32) -> f32 {
    let (power, r) = reduced::<A>(if x < EXP_UNDERFLOW { EXP_UNDERFLOW } else { x });
    let tail = A::madd(r, A::madd(r, 1.0 / 720.0, 1.0 / 120.0), 1.0 / 24.0);
    let p = A::madd(r, A::madd(r, tail, 1.0 / 6.0), 0.5);
    let p = A::madd(r, A::madd(r, p, 1.0), 1.0);
    if x < EXP_UNDERFLOW { 0.0 } else { power * p }
}

/// 2ⁿ and r, where x = n ln 2 + r.
#[inline(always)]
fn reduced<A: Arithmetic>(x: f32) -> (f32, f32) {
    let shifted = A::madd(x, std::f32::consts::LOG2_E, ROUNDER);
    let n = shifted - ROUNDER;
    let r = A::madd(n, -LN_2_LOW, A::madd(n, -LN_2_HIGH, x));
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(0x3f80_0000));
    (power, r)
}

/// Adds a block to its total and leaves in it what that rounded off: of terms that are all alike the losses are as well,
/// and would add up (W. Kahan, Commun. ACM 8 (1965) 40).
#[inline(always)]
pub fn flush(total: &mut f32, block: &mut f32) {
    let sum = *total + *block;
    *block -= sum - *total;
    *total = sum;
}

/// A computation over lanes. Its `run` must be `#[inline(always)]`, down to the loops, so that each instance is
/// compiled for its own instruction set.
pub trait Kernel {
    /// What the computation returns.
    type Output;
    /// Does the work.
    fn run<A: Arithmetic>(self) -> Self::Output;
}

/// Runs the kernel with the widest instruction set that this processor has and that pays off.
///
/// AVX-512 is left out: it was measured slower than AVX2 on this kernel's mix of gathers and arithmetic.
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        #[allow(
            unsafe_code,
            reason = "calling a target_feature function: the feature was just detected"
        )]
        // SAFETY: `run_avx2` needs nothing but AVX2 and FMA, which were just found on this processor.
        return unsafe { run_avx2(kernel) };
    }
    kernel.run::<Rounded>()
}

/// The kernel compiled for AVX2 and fused multiply-add.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Fused>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points from −100 to 1, dense near zero.
    fn points() -> impl Iterator<Item = f32> {
        let linear = (0..200_000).map(|i| -100.0 + 101.0 * i as f32 / 200_000.0);
        let small = (0..2_000).map(|i| -(10.0_f32.powf(-(i as f32) / 60.0)));
        linear.chain(small)
    }

    /// Every value of a function, by both arithmetics: a fused one is right on any processor, if slowly.
    fn by_both(fused: fn(f32) -> f32, rounded: fn(f32) -> f32) -> impl Iterator<Item = (f32, f32)> {
        points().flat_map(move |x| [(x, fused(x)), (x, rounded(x))])
    }

    #[test]
    fn exp_m1_holds_its_relative_error_down_to_zero() {
        let thin = by_both(exp_m1_thin_by::<Fused>, exp_m1_thin_by::<Rounded>);
        let thin = thin.filter(|(x, _)| x.abs() <= THIN);
        for (x, found) in by_both(exp_m1_by::<Fused>, exp_m1).chain(thin) {
            let exact = f64::from(x).exp_m1();
            let error = (f64::from(found) - exact).abs();
            assert!(
                error <= 3e-7 * exact.abs(),
                "x = {x}: {found} against {exact}"
            );
        }
    }

    #[test]
    fn exp_holds_its_relative_error_and_underflows_to_zero() {
        for (x, found) in by_both(exp_by::<Fused>, exp) {
            let exact = f64::from(x).exp();
            let error = (f64::from(found) - exact).abs();
            if x >= EXP_UNDERFLOW {
                assert!(
                    error <= (3e-7 + f64::from(x.abs()) * 6e-8) * exact,
                    "x = {x}"
                );
            } else {
                assert_eq!(found, 0.0);
            }
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(f32::NEG_INFINITY), 0.0);
        assert_eq!(exp_m1(f32::NEG_INFINITY), -1.0);
        assert_eq!(exp_m1(0.0), 0.0);
        assert_eq!(exp_m1(-1e-38), -1e-38);
    }

    #[test]
    fn the_inverse_holds_its_relative_error_from_zero_to_where_it_vanishes() {
        for x in points().map(f32::abs) {
            let exact = 1.0 / f64::from(x).exp_m1();
            let error = (f64::from(inverse_exp_m1(x)) - exact).abs();
            if x <= -EXP_UNDERFLOW {
                let bound = 3e-7 + f64::from(x) * 6e-8;
                assert!(
                    error <= bound * exact,
                    "x = {x}: off by {:e}",
                    error / exact
                );
            } else {
                assert_eq!(inverse_exp_m1(x), 0.0);
            }
        }
        assert_eq!(inverse_exp_m1(f32::INFINITY), 0.0);
        assert_eq!(inverse_exp_m1(0.0), f32::INFINITY);
    }

    #[test]
    fn a_million_equal_terms_add_up_in_blocks() {
        let (mut total, mut block) = (0.0_f32, 0.0_f32);
        for _ in 0..1 << 16 {
            for _ in 0..16 {
                block += 1e-12;
            }
            flush(&mut total, &mut block);
        }
        let exact = f64::from(1e-12_f32) * f64::from(1 << 20);
        let error = (f64::from(total) / exact - 1.0).abs();
        assert!(error < 5e-7, "off by {error:e}");
    }

    struct Sum(Lanes);

    impl Kernel for Sum {
        type Output = Lanes;

        #[inline(always)]
        fn run<A: Arithmetic>(self) -> Lanes {
            let mut out = [0.0; LANES];
            for (out, x) in out.iter_mut().zip(self.0) {
                *out = exp_by::<A>(x) - 0.5 * exp_m1_by::<A>(x);
            }
            out
        }
    }

    #[test]
    fn both_instances_give_the_same_to_the_last_bits() {
        let mut x = [0.0; LANES];
        for (i, x) in x.iter_mut().enumerate() {
            *x = -0.37 * (i as f32).powi(2);
        }
        for (one, other) in dispatch(Sum(x)).iter().zip(Sum(x).run::<Rounded>()) {
            assert!((one - other).abs() <= 6e-7 * other.abs(), "{one} {other}");
        }
    }
}
