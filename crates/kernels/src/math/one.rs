//! [`One`]: an `f64` as a [`Real`] of an instruction set: a run alone needs no lanes, but the fused operation.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::Simd;

use crate::math::real::{Real, assign_operators};

/// One number, with the operations of `f64` bit for bit.
#[derive(Clone, Copy, Debug)]
pub struct One<S>(pub f64, pub S);

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<S> $trait for One<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                One(self.0 $op other.0, self.1)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<S> Neg for One<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        One(-self.0, self.1)
    }
}
assign_operators!(One<S>, S: Simd);

impl<S: Simd> Real for One<S> {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        One(value, self.1)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        One(self.0.mul_add(a.0, b.0), self.1)
    }
    #[inline(always)]
    fn apart<T>(self, work: impl FnOnce() -> T) -> T {
        self.1.vectorize(work)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        One(self.0.sqrt(), self.1)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        One(self.0.abs(), self.1)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        One(self.0.exponent(), self.1)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        One(self.0.power_of_two(), self.1)
    }
    #[inline(always)]
    fn lane(&self, _lane: usize) -> f64 {
        self.0
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, value: f64) {
        self.0 = value;
    }
    #[inline(always)]
    fn write(self, values: &mut [f64]) {
        values[0] = self.0;
    }
}
