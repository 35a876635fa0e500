//! Powers from [`Real`] operations alone, with the same bits in scalars and lanes, for step control.
//!
//! [`power`] has twelve digits, by the series of artanh about the nearest power of two and a Taylor polynomial within
//! half an octave (Abramowitz & Stegun 1964, 4.1.27 and 4.2.1). [`log2_rough`] and [`exp2_rough`] have four digits, for
//! Taylor steps.

use super::real::NEAREST;
use crate::math::real::Real;

const SMALLEST: f64 = f64::MIN_POSITIVE;

const LARGEST: f64 = f64::MAX / 2.0;

/// Series of artanh; the first neglected term is below 2e-14 at |t| <= 0.172.
const LOGARITHM: [f64; 8] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0];

/// 1/k!; the first neglected term is below 1e-14 at |x| <= ln(2)/2.
const EXPONENTIAL: [f64; 12] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
];

/// sum_k c_k x^k by Horner's rule.
#[inline(always)]
pub(super) fn polynomial<R: Real, const K: usize>(coefficients: &[f64; K], x: R) -> R {
    let mut sum = x.splat(coefficients[K - 1]);
    for k in (0..K - 1).rev() {
        sum = sum.mul_add(x, x.splat(coefficients[k]));
    }
    sum
}

/// log2 of a positive number, to an absolute error of 1e-13. Arguments are clamped to normal numbers up to 2^1023; NaN
/// counts as the smallest.
#[inline(always)]
pub fn log2<R: Real>(x: R) -> R {
    let x = x.larger(x.splat(SMALLEST)).smaller(x.splat(LARGEST));
    let exponent = x.exponent();
    let mantissa = x * (-exponent).power_of_two();
    // from [1, 2) to [0.71, 1.42), for fastest convergence
    let upper = x.splat(core::f64::consts::SQRT_2).lt(mantissa);
    let exponent = R::select(upper, exponent + x.splat(1.0), exponent);
    let mantissa = R::select(upper, mantissa * x.splat(0.5), mantissa);
    let t = (mantissa - x.splat(1.0)) / (mantissa + x.splat(1.0));
    let series = t * polynomial(&LOGARITHM, t * t);
    series.mul_add(x.splat(2.0 * core::f64::consts::LOG2_E), exponent)
}

/// 2^x, to a relative error of 1e-13; clamped to the range of normal numbers.
#[inline(always)]
pub fn exp2<R: Real>(x: R) -> R {
    let x = x.larger(x.splat(-1022.0)).smaller(x.splat(1023.0));
    let whole = x.nearest_integer();
    polynomial(&EXPONENTIAL, (x - whole) * x.splat(core::f64::consts::LN_2)) * whole.power_of_two()
}

/// `x^exponent` for positive `x` and |exponent| <= 1, to a relative error of 3e-13. Arguments are clamped as
/// in [`log2`].
#[inline(always)]
pub fn power<R: Real>(x: R, exponent: f64) -> R {
    exp2(log2(x) * x.splat(exponent))
}

/// log2 x with an absolute error up to 1e-4 for positive normal x below 2^1022; about -1020 for zero.
#[inline(always)]
pub fn log2_rough<R: Real>(x: R) -> R {
    let exponent = x.exponent();
    let y = x * (-exponent).power_of_two() - x.splat(1.0);
    // log2(1 + y)/y interpolated at the Chebyshev nodes of [0, 1], degree 5: error 7.4e-6
    let series = [1.442_681_47, -0.720_358_773, 0.468_658_879, -0.301_638_01, 0.144_471_096, -0.033_822_046];
    y.mul_add(polynomial(&series, y), exponent)
}

/// 2^x with a relative error up to 1e-4 for |x| < 1000.
#[inline(always)]
pub fn exp2_rough<R: Real>(x: R) -> R {
    // in double-double the sum keeps the fraction, which is good enough for steps
    let whole = (x + x.splat(NEAREST)) - x.splat(NEAREST);
    let rest = (x - whole) * x.splat(core::f64::consts::LN_2);
    polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0], rest) * whole.power_of_two()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a unit in the last place of log2 at the ends of the range (1.1e-13), times the exponent and ln 2.
    const POWER_ERROR: f64 = 3e-13;
    const ROUGH_ERROR: f64 = 1e-4;

    fn samples() -> impl Iterator<Item = f64> {
        (-3000..3000).map(|k| libm::exp(k as f64 * 0.2360679 / 1.01) * (1.0 + 1e-3 * (k % 7) as f64))
    }

    #[test]
    fn powers_agree_with_libm() {
        for x in samples() {
            for exponent in [0.2, -0.2, 0.125, -0.125, 1.0 / 3.0, -1.0] {
                let truth = libm::pow(x, exponent);
                let error = (power(x, exponent) / truth - 1.0).abs();
                assert!(error < POWER_ERROR, "{x:e}^{exponent}: {error:e}");
            }
        }
    }

    #[test]
    fn rough_logarithm_and_power_are_as_good_as_stated() {
        for k in -3000..3000 {
            let x = libm::exp2(f64::from(k) * 0.0317);
            // measured: 7.3e-6, and 3.2e-6 below
            assert!((log2_rough(x) - libm::log2(x)).abs() < ROUGH_ERROR, "{x}");
            let e = f64::from(k) * 0.0091;
            assert!((exp2_rough(e) / libm::exp2(e) - 1.0).abs() < ROUGH_ERROR, "{e}");
        }
        assert!(log2_rough(0.0_f64) < -1000.0);
    }

    #[test]
    fn exact_powers_of_two_and_edges() {
        assert_eq!(power(1.0, 0.2), 1.0);
        assert_eq!(power(32.0, 0.2), 2.0);
        assert_eq!(power(256.0, -0.125), 0.5);
        assert_eq!(power(0.0, 0.2), power(f64::MIN_POSITIVE, 0.2));
        assert_eq!(power(f64::NAN, 0.2), power(f64::MIN_POSITIVE, 0.2));
        assert!(power(f64::INFINITY, 0.2).is_finite());
        assert_eq!(1023.0_f64.power_of_two(), 2.0_f64.powi(1023));
        assert_eq!((-1022.0_f64).power_of_two(), f64::MIN_POSITIVE);
        assert_eq!(f64::MIN_POSITIVE.exponent(), -1022.0);
        assert_eq!(7.9.exponent(), 2.0);
    }
}
