//! [`Lanes`]: eight `f64` as one [`Real`], by `fearless_simd::f64x8`.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Bytes, Select, Simd, SimdBase, SimdFloat, SimdFrom, SimdMask, f64x8, mask64x8, u64x8};

pub use super::real::TWO_52;
use crate::math::real::{Mask, Real, assign_operators};

/// Number of lanes of [`Lanes`].
pub const WIDTH: usize = 8;

/// Largest number of lanes of a [`Real`]: a [`super::Pair`] of [`Lanes`].
pub const WIDEST: usize = 2 * WIDTH;

/// Eight `f64`, each as the scalar operation bit for bit.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Lanes<S: Simd>(pub f64x8<S>);

impl<S: Simd> Lanes<S> {
    /// `value` in all lanes.
    #[inline(always)]
    pub fn broadcast(simd: S, value: f64) -> Self {
        Lanes(f64x8::simd_from(simd, value))
    }

    /// Eight values from memory.
    #[inline(always)]
    pub fn load(simd: S, values: &[f64; WIDTH]) -> Self {
        Lanes(f64x8::load_array_ref(simd, values))
    }

    /// Eight values from the start of a slice of at least eight.
    #[inline(always)]
    pub fn from_slice(simd: S, values: &[f64]) -> Self {
        Lanes(f64x8::from_slice(simd, &values[..WIDTH]))
    }

    /// Writes the eight values to the start of a slice of at least eight.
    #[inline(always)]
    pub fn store(self, values: &mut [f64]) {
        self.0.store_slice(&mut values[..WIDTH]);
    }

    /// The eight values.
    #[inline(always)]
    pub fn to_array(self) -> [f64; WIDTH] {
        self.0.to_array()
    }

    /// The alternating lanes of `self` and `other`: the first eight and the last eight.
    #[inline(always)]
    pub fn interleave(self, other: Self) -> (Self, Self) {
        (Lanes(self.0.zip_low(other.0)), Lanes(self.0.zip_high(other.0)))
    }

    /// The even and the odd numbers of the sixteen in `self` and `other`.
    #[inline(always)]
    pub fn deinterleave(self, other: Self) -> (Self, Self) {
        (Lanes(self.0.unzip_low(other.0)), Lanes(self.0.unzip_high(other.0)))
    }

    /// The token of the instruction set.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.0.simd
    }

    /// The nearest integers, ties to even.
    #[inline(always)]
    pub fn round(self) -> Self {
        Lanes(self.0.round_ties_even())
    }

    /// The largest integers not above.
    #[inline(always)]
    pub fn floor(self) -> Self {
        Lanes(self.0.floor())
    }
}

/// The fused operation by eight library calls, which take minutes to compile if inlined.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
fn plain_mul_add<S: Simd>(x: Lanes<S>, a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    Lanes(x.0.mul_add_precise(a.0, b.0))
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Lanes(self.0 $op other.0)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lanes(-self.0)
    }
}
assign_operators!(Lanes<S>, S: Simd);

impl<S: Simd> Mask for mask64x8<S> {
    const LANES: usize = WIDTH;

    #[inline(always)]
    fn any(self) -> bool {
        self.any_true()
    }
    #[inline(always)]
    fn test(self, lane: usize) -> bool {
        (self.to_bitmask() >> lane) & 1 != 0
    }
    #[inline(always)]
    fn set(&mut self, lane: usize, value: bool) {
        SimdMask::set(self, lane, value);
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = mask64x8<S>;
    const LANES: usize = WIDTH;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self::broadcast(self.simd(), value)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        #[cfg(target_arch = "x86_64")]
        if core::any::TypeId::of::<S>() == core::any::TypeId::of::<fearless_simd::x86::Sse2>() {
            return plain_mul_add(self, a, b);
        }
        Lanes(self.0.mul_add_precise(a.0, b.0))
    }
    #[inline(always)]
    fn apart<T>(self, work: impl FnOnce() -> T) -> T {
        self.simd().vectorize(work)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Lanes(self.0.abs())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        self.0.simd_lt(other.0)
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Lanes(mask.select(yes.0, no.0))
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        let bits = self.0.bitcast::<u64x8<S>>() >> 52;
        let shifted = (bits | TWO_52.to_bits()).bitcast::<f64x8<S>>();
        Lanes(shifted) - self.splat(TWO_52 + 1023.0)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        let bits = (self + self.splat(TWO_52 + 1023.0)).0.bitcast::<u64x8<S>>();
        Lanes((bits << 52).bitcast::<f64x8<S>>())
    }
    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        // the bit mask saves a bounds check
        self.0[lane & (WIDTH - 1)]
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        self.0[lane & (WIDTH - 1)] = value;
    }
    #[inline(always)]
    fn write(self, values: &mut [f64]) {
        self.store(values);
    }
}
