//! [`Real`]: the arithmetic a kernel may use.
//!
//! One trait for a scalar and for eight lanes, so that a kernel is written once and lane `i` equals the scalar run bit for
//! bit: every operation here is correctly rounded (IEEE 754) in both, and `mul_add` is always fused. Elementary functions
//! are *not* here: those on the path of a row come from `libm` or are built from these operations.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// 2^52: the last bits of 2^52 + n are the integer n, which is how exponents are read and written without a conversion.
pub const TWO_52: f64 = 4_503_599_627_370_496.0;

/// A real number, or several side by side that never share a decision.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// One truth value per lane.
    type Mask: Copy;

    /// How many numbers stand side by side.
    const LANES: usize;

    /// The constant `value` in every lane; `self` only says which kind of number is meant.
    fn splat(self, value: f64) -> Self;

    /// `self * a + b` with a single rounding.
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// `b - self * a` with a single rounding.
    #[inline(always)]
    fn neg_mul_add(self, a: Self, b: Self) -> Self {
        (-self).mul_add(a, b)
    }

    /// Correctly rounded square root.
    fn sqrt(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// The larger of two numbers; where `self` is not a number the result is `other`, where `other` is not, it is `other`
    /// too (so that a maximum over errors, `error.larger(maximum)`, must be asked for non-finite values separately).
    fn larger(self, other: Self) -> Self;

    /// The smaller of two numbers, with the same rule for what is not a number.
    fn smaller(self, other: Self) -> Self;

    /// `self < other`, lane by lane.
    fn lt(self, other: Self) -> Self::Mask;

    /// `yes` where `mask` holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Whether `mask` holds in any lane.
    fn any(mask: Self::Mask) -> bool;

    /// The exponent of a positive normal number as a number: floor(log2(self)).
    fn exponent(self) -> Self;

    /// 2^self for an integer from -1022 to 1023.
    fn power_of_two(self) -> Self;

    /// The number in lane `lane`; rounded to `f64` where a wider type is behind.
    fn lane(&self, lane: usize) -> f64;

    /// Puts `value` into lane `lane`.
    fn set_lane(&mut self, lane: usize, value: f64);

    /// `LANES` numbers from the start of a slice; `self` only says which kind of number is meant.
    fn read(self, values: &[f64]) -> Self;

    /// Writes the numbers to the start of a slice, as [`Real::lane`] gives them.
    fn write(self, values: &mut [f64]);

    /// The constant zero.
    #[inline(always)]
    fn zero(self) -> Self {
        self.splat(0.0)
    }
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        f64::mul_add(self, a, b)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        f64::from_bits((self.to_bits() >> 52) | TWO_52.to_bits()) - (TWO_52 + 1023.0)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        f64::from_bits((self + (TWO_52 + 1023.0)).to_bits() << 52)
    }
    #[inline(always)]
    fn lane(&self, _lane: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, value: f64) {
        *self = value;
    }
    #[inline(always)]
    fn read(self, values: &[f64]) -> Self {
        values[0]
    }
    #[inline(always)]
    fn write(self, values: &mut [f64]) {
        values[0] = self;
    }
}
