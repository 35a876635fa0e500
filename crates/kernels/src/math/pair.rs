//! [`Pair`]: two [`Real`]s as one, for twice as many independent operations in flight: two fused operations per cycle
//! with a latency of four need eight chains. Lanes never mix, so that pairing changes no bit.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::math::real::{Mask, Real, assign_operators};

/// Two numbers (or vectors of numbers); the lanes of the first come first.
#[derive(Clone, Copy, Debug)]
pub struct Pair<R>(pub R, pub R);

macro_rules! operator {
    ($pair:ident, $bound:ident, $trait:ident, $method:ident, $op:tt) => {
        impl<R: $bound> $trait for $pair<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $pair(self.0 $op other.0, self.1 $op other.1)
            }
        }
    };
}
operator!(Pair, Real, Add, add, +);
operator!(Pair, Real, Sub, sub, -);
operator!(Pair, Real, Mul, mul, *);
operator!(Pair, Real, Div, div, /);
operator!(PairMask, Mask, BitAnd, bitand, &);
operator!(PairMask, Mask, BitOr, bitor, |);
assign_operators!(Pair<R>, R: Real);

impl<R: Real> Neg for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Pair(-self.0, -self.1)
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PairMask<M>(M, M);

impl<M: Mask> Not for PairMask<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        PairMask(!self.0, !self.1)
    }
}

impl<M: Mask> Mask for PairMask<M> {
    const LANES: usize = 2 * M::LANES;

    #[inline(always)]
    fn any(self) -> bool {
        self.0.any() || self.1.any()
    }
    #[inline(always)]
    fn test(self, lane: usize) -> bool {
        if lane < M::LANES { self.0.test(lane) } else { self.1.test(lane - M::LANES) }
    }
    #[inline(always)]
    fn set(&mut self, lane: usize, value: bool) {
        if lane < M::LANES { self.0.set(lane, value) } else { self.1.set(lane - M::LANES, value) }
    }
}

/// Methods that act on each half.
macro_rules! halves {
    ($($method:ident($($argument:ident),*))*) => {
        $(#[inline(always)]
        fn $method(self, $($argument: Self),*) -> Self {
            Pair(self.0.$method($($argument.0),*), self.1.$method($($argument.1),*))
        })*
    };
}

impl<R: Real> Real for Pair<R> {
    type Mask = PairMask<R::Mask>;
    const LANES: usize = 2 * R::LANES;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        let half = self.0.splat(value);
        Pair(half, half)
    }
    halves! { mul_add(a, b) sqrt() abs() exponent() power_of_two() }

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        PairMask(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Pair(R::select(mask.0, yes.0, no.0), R::select(mask.1, yes.1, no.1))
    }
    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        if lane < R::LANES { self.0.lane(lane) } else { self.1.lane(lane - R::LANES) }
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        if lane < R::LANES {
            self.0.set_lane(lane, value);
        } else {
            self.1.set_lane(lane - R::LANES, value);
        }
    }
    #[inline(always)]
    fn write(self, values: &mut [f64]) {
        self.0.write(values);
        self.1.write(&mut values[R::LANES..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_of_a_pair_are_its_halves() {
        let mut pair = Pair(1.0_f64, 2.0).mul_add(Pair(3.0, 4.0), Pair(5.0, 6.0));
        assert_eq!((pair.lane(0), pair.lane(1), Pair::<f64>::LANES), (8.0, 14.0, 2));
        pair.set_lane(1, -1.0);
        assert_eq!((pair.0, pair.1), (8.0, -1.0));
        let negative = pair.lt(pair.zero());
        assert!(negative.any() && !pair.splat(9.0).lt(pair).any() && !pair.never().any());
        assert_eq!([negative.test(0), negative.test(1)], [false, true]);
        let mut other = !negative;
        assert_eq!([other.test(0), other.test(1)], [true, false]);
        assert!((other | negative).test(0) && !(other & negative).any());
        other.set(1, true);
        assert!(other.test(1) && (other & negative).test(1));
        let mut written = [0.0; 2];
        pair.write(&mut written);
        assert_eq!(written, [8.0, -1.0]);
    }
}
