//! Correlation of two series and slope of a series, in a fixed order of operations (see [`super::reduce`]).

use fearless_simd::Simd;

use super::weights::{Weights, total, vectors};
use crate::math::{Lanes, Real};

/// Correlation of `a` and `b`, given with their means; zero if one is constant.
#[inline(always)]
pub(super) fn correlation<S: Simd>(
    simd: S,
    weights: &Weights,
    (a, a_mean): (&[f64], f64),
    (b, b_mean): (&[f64], f64),
) -> f64 {
    let zero = Lanes::broadcast(simd, 0.0);
    let (a_mean, b_mean) = (Lanes::broadcast(simd, a_mean), Lanes::broadcast(simd, b_mean));
    let (mut aa, mut ab, mut bb) = (zero, zero, zero);
    let count = weights.one.len();
    let (a, b) = (vectors(a, count), vectors(b, count));
    for at in 0..count {
        let one = Lanes::load(simd, &weights.one[at]);
        let x = (Lanes::load(simd, &a[at]) - a_mean) * one;
        let y = (Lanes::load(simd, &b[at]) - b_mean) * one;
        aa = x.mul_add(x, aa);
        ab = x.mul_add(y, ab);
        bb = y.mul_add(y, bb);
    }
    let scale = total(aa).sqrt() * total(bb).sqrt();
    if scale == 0.0 { 0.0 } else { (total(ab) / scale).clamp(-1.0, 1.0) }
}

/// Slope of the least-squares line through a series, per second.
#[inline(always)]
pub(super) fn slope<S: Simd>(simd: S, weights: &Weights, column: &[f64], mean: f64) -> f64 {
    let mean = Lanes::broadcast(simd, mean);
    let mut slope = mean.zero();
    for (x, weight) in vectors(column, weights.slope.len()).iter().zip(&weights.slope) {
        let x = Lanes::load(simd, x) - mean;
        slope = x.mul_add(Lanes::load(simd, weight), slope);
    }
    total(slope)
}
