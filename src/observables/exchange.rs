//! `exchange`: correlations and dominant frequency of the exchange of kinetic energy between fuselage and wheels, about the
//! spacecraft's centre of mass.

use fearless_simd::Simd;

use super::correlation::{correlations, slope};
use super::spectrum::Spectrum;
use super::weights::Weights;

/// Swing of a body's energy, relative to the total about the centre of mass, up to which the energy counts as constant: some
/// dozens of roundings of the total, from its sum of squares and from the integration of omega.
pub const EXCHANGE_FLOOR: f64 = 64.0 * f64::EPSILON;

/// The energy of a body about the centre of mass.
#[derive(Clone, Copy)]
pub(super) struct BodyEnergy<'a> {
    pub(super) column: &'a [f64],
    pub(super) mean: f64,
    /// Maximum minus minimum.
    pub(super) swing: f64,
}

/// How the bodies exchange energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exchange {
    /// Correlation of the fuselage with each wheel; zero where one of the two is constant.
    pub(super) correlations: [f64; 2],
    /// Dominant frequency of the fuselage, Hz; zero where it is constant, NaN on a grid that has no spectrum.
    pub(super) frequency: f64,
}

impl Exchange {
    /// Of a run that was not observed.
    pub(super) const UNKNOWN: Exchange = Exchange { correlations: [f64::NAN; 2], frequency: f64::NAN };
}

/// The exchange of `fuselage` with `wheels`; `total` is the largest energy of all three.
#[inline(always)]
pub(super) fn exchange<S: Simd>(
    simd: S,
    weights: &Weights,
    spectrum: Option<&mut Spectrum>,
    total: f64,
    fuselage: BodyEnergy<'_>,
    wheels: [BodyEnergy<'_>; 2],
) -> Exchange {
    let varies = |body: BodyEnergy<'_>| body.swing > EXCHANGE_FLOOR * total;
    let [first, second] = wheels.map(|wheel| (wheel.column, wheel.mean));
    let found = correlations(simd, weights, (fuselage.column, fuselage.mean), [first, second]);
    let correlation = |wheel: usize| if varies(fuselage) && varies(wheels[wheel]) { found[wheel] } else { 0.0 };
    let frequency = match spectrum {
        Some(_) if !varies(fuselage) => 0.0,
        Some(spectrum) => {
            let slope = slope(simd, weights, fuselage.column, fuselage.mean);
            spectrum.peak(simd, fuselage.column, fuselage.mean, slope)
        }
        None => f64::NAN,
    };
    Exchange { correlations: [correlation(0), correlation(1)], frequency }
}
