//! Exchange of kinetic energy between body and wheels about the centre of mass: correlations and dominant frequency.

use fearless_simd::Simd;

use super::spectrum::Spectrum;
use super::weights::{Weights, total, vectors};
use crate::math::{Lanes, Real};
use crate::scene::MAX_WHEELS;

/// Swing of a body's energy, over the largest total, below which it counts as constant: dozens of roundings.
pub const EXCHANGE_FLOOR: f64 = 64.0 * f64::EPSILON;

#[derive(Clone, Copy)]
pub(super) struct BodyEnergy<'a> {
    pub(super) column: &'a [f64],
    pub(super) mean: f64,
    /// Maximum minus minimum.
    pub(super) swing: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exchange {
    /// Correlation of the body with each wheel; zero if one does not vary.
    pub(super) correlations: [f64; MAX_WHEELS],
    /// Dominant frequency of the body, Hz; NaN if it does not vary or the grid has no spectrum.
    pub(super) frequency: f64,
}

impl Exchange {
    /// For a run that was not observed.
    pub(super) const UNKNOWN: Exchange = Exchange { correlations: [f64::NAN; MAX_WHEELS], frequency: f64::NAN };
}

/// Exchange of `body` with `wheels`; `largest` is the largest total energy.
#[inline(always)]
pub(super) fn exchange<'w, S: Simd>(
    simd: S,
    weights: &Weights,
    spectrum: Option<&mut Spectrum>,
    largest: f64,
    body: BodyEnergy<'_>,
    wheels: impl Iterator<Item = BodyEnergy<'w>>,
) -> Exchange {
    let varies = |one: BodyEnergy<'_>| one.swing > EXCHANGE_FLOOR * largest;
    let mut correlations = [0.0; MAX_WHEELS];
    for (found, wheel) in correlations.iter_mut().zip(wheels) {
        if varies(body) && varies(wheel) {
            *found = correlation(simd, weights, body, wheel);
        }
    }
    let frequency = match spectrum {
        Some(spectrum) if varies(body) => {
            let slope = slope(simd, weights, body.column, body.mean);
            spectrum.peak(simd, body.column, body.mean, slope)
        }
        _ => f64::NAN,
    };
    Exchange { correlations, frequency }
}

#[inline(always)]
fn correlation<S: Simd>(simd: S, weights: &Weights, a: BodyEnergy<'_>, b: BodyEnergy<'_>) -> f64 {
    let zero = Lanes::broadcast(simd, 0.0);
    let (a_mean, b_mean) = (Lanes::broadcast(simd, a.mean), Lanes::broadcast(simd, b.mean));
    let (mut aa, mut ab, mut bb) = (zero, zero, zero);
    let count = weights.one.len();
    let (a, b) = (vectors(a.column, count), vectors(b.column, count));
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
fn slope<S: Simd>(simd: S, weights: &Weights, column: &[f64], mean: f64) -> f64 {
    let mean = Lanes::broadcast(simd, mean);
    let mut slope = mean.zero();
    for (x, weight) in vectors(column, weights.slope.len()).iter().zip(&weights.slope) {
        let x = Lanes::load(simd, x) - mean;
        slope = x.mul_add(Lanes::load(simd, weight), slope);
    }
    total(slope)
}
