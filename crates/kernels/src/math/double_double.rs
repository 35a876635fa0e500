//! [`DoubleDouble`]: a number as the unevaluated sum of two `f64`, 106 bits, for reference solutions, by algorithms 6,
//! 12 and 18 of M. Joldes, J.-M. Muller & V. Popescu, ACM Trans. Math. Softw. 44(2), 2017.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::sums;
use crate::math::real::{Real, assign_operators};

/// `high + low` with |low| <= ulp(high)/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The value rounded to `f64`.
    pub high: f64,
    /// The rounding error of `high`.
    pub low: f64,
}

/// `sums::two_sum`.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let (high, low) = sums::two_sum(a, b);
    DoubleDouble { high, low }
}

/// Product and rounding error.
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble { high, low: a.mul_add(b, -high) }
}

#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let (high, low) = sums::fast_two_sum(a, b);
    DoubleDouble { high, low }
}

impl DoubleDouble {
    /// An `f64`, exactly.
    #[inline(always)]
    pub const fn exact(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // algorithm 6: relative error below 3 u^2
        let s = two_sum(self.high, other.high);
        let t = two_sum(self.low, other.low);
        let v = fast_two_sum(s.high, s.low + t.high);
        fast_two_sum(v.high, t.low + v.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // algorithm 12: relative error below 5 u^2
        let product = two_product(self.high, other.high);
        let cross = self.low * other.low;
        let cross = self.high.mul_add(other.low, cross);
        let cross = self.low.mul_add(other.high, cross);
        fast_two_sum(product.high, product.low + cross)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // algorithm 18: relative error below 10 u^2
        let reciprocal = 1.0 / other.high;
        let rest = DoubleDouble { high: (-other.high).mul_add(reciprocal, 1.0), low: -(other.low * reciprocal) };
        let rest = fast_two_sum(rest.high, rest.low);
        let delta = rest * DoubleDouble::exact(reciprocal);
        self * (delta + DoubleDouble::exact(reciprocal))
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

assign_operators!(DoubleDouble);

impl Real for DoubleDouble {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        DoubleDouble::exact(value)
    }
    /// Two roundings, each at 2^-104.
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return DoubleDouble::exact(self.high.sqrt());
        }
        // one Newton step from the f64 root (Karp & Markstein, ACM Trans. Math. Softw. 23(4), 1997)
        let root = self.high.sqrt();
        let rest = self - two_product(root, root);
        fast_two_sum(root, rest.high / (2.0 * root))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.high < other.high || (self.high == other.high && self.low < other.low)
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    /// The integer nearest to the value rounded to `f64`: adding a large number would keep the fraction of a
    /// double-double.
    #[inline(always)]
    fn nearest_integer(self) -> Self {
        DoubleDouble::exact(self.high.nearest_integer())
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        DoubleDouble::exact(self.high.exponent())
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        DoubleDouble::exact(self.high.power_of_two())
    }
    #[inline(always)]
    fn lane(&self, _lane: usize) -> f64 {
        self.high
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, value: f64) {
        *self = DoubleDouble::exact(value);
    }
    #[inline(always)]
    fn write(self, values: &mut [f64]) {
        values[0] = self.high;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dd(x: f64) -> DoubleDouble {
        DoubleDouble::exact(x)
    }

    /// Law: the nearest integer has no fraction, for any number of digits.
    #[test]
    fn the_nearest_integer_is_one() {
        for (number, integer) in [(dd(2.3) + dd(1e-20), 2.0), (dd(-0.7) - dd(1e-18), -1.0), (dd(5.0) + dd(1e-25), 5.0)]
        {
            assert_eq!(number.nearest_integer(), dd(integer), "{number:?}");
        }
    }
}
