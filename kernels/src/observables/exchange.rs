//! Exchange of kinetic energy between body and wheels about the spacecraft's centre of mass: correlations and dominant
//! frequency.

use fearless_simd::Simd;

use super::correlation::{correlation, slope};
use super::spectrum::Spectrum;
use super::weights::Weights;
use crate::scene::MAX_WHEELS;

/// Swing of a body's energy over the total about the centre of mass below which it counts as constant: dozens of
/// roundings of the total, from its sum of squares and the integration of omega.
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
    /// Correlation of the body with each wheel; zero if one is constant.
    pub(super) correlations: [f64; MAX_WHEELS],
    /// Dominant frequency of the body, Hz; zero if constant, NaN on a grid without a spectrum.
    pub(super) frequency: f64,
}

impl Exchange {
    /// A run that was not observed.
    pub(super) const UNKNOWN: Exchange = Exchange { correlations: [f64::NAN; MAX_WHEELS], frequency: f64::NAN };
}

#[inline(always)]
pub(super) fn exchange<'w, S: Simd>(
    simd: S,
    weights: &Weights,
    spectrum: Option<&mut Spectrum>,
    total: f64,
    body: BodyEnergy<'_>,
    wheels: impl Iterator<Item = BodyEnergy<'w>>,
) -> Exchange {
    let varies = |one: BodyEnergy<'_>| one.swing > EXCHANGE_FLOOR * total;
    let mut correlations = [0.0; MAX_WHEELS];
    for (found, wheel) in correlations.iter_mut().zip(wheels) {
        if varies(body) && varies(wheel) {
            *found = correlation(simd, weights, (body.column, body.mean), (wheel.column, wheel.mean));
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
