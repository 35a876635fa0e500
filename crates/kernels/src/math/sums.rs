//! Error-free sums for any [`Real`]: the rounded sum and its rounding error.

use crate::math::real::Real;

/// Sum of any two numbers and its rounding error (D. E. Knuth, *The Art of Computer Programming*, vol. 2, 4.2.2,
/// theorem B).
#[inline(always)]
pub fn two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    let other = sum - a;
    (sum, (a - (sum - other)) + (b - other))
}

/// Sum and rounding error for |a| >= |b| or a = 0 (T. J. Dekker, Numerische Mathematik 18, 1971).
#[inline(always)]
pub fn fast_two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    (sum, b - (sum - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        // integers below 2^80, which i128 adds exactly
        #[test]
        fn sum_and_error_are_exact(a in -(1i64 << 53)..1i64 << 53, b in -(1i64 << 53)..1i64 << 53, shift in 0i32..26) {
            let scale = 2.0f64.powi(shift);
            let (x, y) = (a as f64 * scale, b as f64);
            let exact = (i128::from(a) << shift) + i128::from(b);
            let (sum, error) = two_sum(x, y);
            prop_assert_eq!(sum as i128 + error as i128, exact);
            let (large, small) = if x.abs() < y.abs() { (y, x) } else { (x, y) };
            prop_assert_eq!(fast_two_sum(large, small), (sum, error));
        }
    }
}
