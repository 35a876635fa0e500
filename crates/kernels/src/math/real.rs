//! [`Real`]: the arithmetic of kernels.
//!
//! One trait for scalars and lanes, which agree bit for bit: every operation is correctly rounded (IEEE 754), `mul_add`
//! is always fused. Elementary functions in values of a row use `libm` or these operations.

use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

/// 2^52: the last bits of 2^52 + n are the integer n, which gives access to exponents without a conversion.
pub const TWO_52: f64 = 4_503_599_627_370_496.0;

/// 1.5 * 2^52: adding and subtracting it rounds to the nearest integer.
pub(super) const NEAREST: f64 = 1.5 * TWO_52;

/// One truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Number of lanes.
    const LANES: usize;

    /// True if any lane is.
    fn any(self) -> bool;

    /// The value in lane `lane`.
    fn test(self, lane: usize) -> bool;

    /// Sets the value of lane `lane`.
    fn set(&mut self, lane: usize, value: bool);
}

impl Mask for bool {
    const LANES: usize = 1;

    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn test(self, _lane: usize) -> bool {
        self
    }
    #[inline(always)]
    fn set(&mut self, _lane: usize, value: bool) {
        *self = value;
    }
}

/// `AddAssign` and `SubAssign` by the operators, for a type with these generic parameters.
macro_rules! assign_operators {
    ($type:ty $(, $parameter:ident: $bound:ident)?) => {
        impl$(<$parameter: $bound>)? core::ops::AddAssign for $type {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl$(<$parameter: $bound>)? core::ops::SubAssign for $type {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
    };
}
pub(super) use assign_operators;

/// A real number, or several that share no decision.
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
    /// The result of a comparison.
    type Mask: Mask;

    /// Number of lanes.
    const LANES: usize;

    /// `value` in every lane; `self` only determines the type.
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

    /// The larger number; `other` if either is NaN: `error.larger(maximum)` ignores an error of NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// The smaller number; `other` if either is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// `self < other`, lane by lane.
    fn lt(self, other: Self) -> Self::Mask;

    /// `yes` in the lanes where `mask` is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// One in the lanes where `mask` is true, else zero; `self` only determines the type.
    #[inline(always)]
    fn indicator(self, mask: Self::Mask) -> Self {
        Self::select(mask, self.splat(1.0), self.zero())
    }

    /// A mask that is false in every lane.
    #[inline(always)]
    fn never(self) -> Self::Mask {
        self.lt(self)
    }

    /// The nearest integer of a number below 2^51 in magnitude, ties to even.
    #[inline(always)]
    fn nearest_integer(self) -> Self {
        (self + self.splat(NEAREST)) - self.splat(NEAREST)
    }

    /// Exponent of a positive normal number: floor(log2(self)).
    fn exponent(self) -> Self;

    /// 2^self for an integer from -1022 to 1023.
    fn power_of_two(self) -> Self;

    /// The number in lane `lane`, rounded to `f64`.
    fn lane(&self, lane: usize) -> f64;

    /// Puts `value` into lane `lane`.
    fn set_lane(&mut self, lane: usize, value: f64);

    /// Writes the numbers to the start of a slice, as [`Real::lane`].
    fn write(self, values: &mut [f64]);

    /// Does long `work`, needed in several places, in a function of its own, compiled for the instruction set of lanes
    /// or the baseline of the target.
    #[inline(always)]
    fn apart<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Zero.
    #[inline(always)]
    fn zero(self) -> Self {
        self.splat(0.0)
    }
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(never)]
    fn apart<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

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
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
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
    fn write(self, values: &mut [f64]) {
        values[0] = self;
    }
}
