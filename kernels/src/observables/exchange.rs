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

/// Exchange of `body` with `wheels`; `total` is the largest total energy.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isa;
    use crate::math::isa::Work;
    use crate::math::lanes::WIDTH;
    use crate::run::Grid;

    const POINTS: usize = 64;

    struct Exchanged<'a>(&'a Weights, &'a mut Spectrum, f64, [BodyEnergy<'a>; 2]);
    impl Work for Exchanged<'_> {
        type Output = (f64, f64);
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let [body, wheel] = self.3;
            let found = exchange(simd, self.0, Some(self.1), self.2, body, std::iter::once(wheel));
            (found.correlations[0], found.frequency)
        }
    }

    /// Correlation and frequency for a body with the energy f(time) and a wheel with `total` - f(time).
    fn exchanged(total: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
        let grid = Grid::uniform(4.0, POINTS);
        let columns = [0.0, total].map(|of_wheel| {
            let mut values: Vec<f64> = grid.times().iter().map(|time| (of_wheel - f(*time)).abs()).collect();
            values.resize(POINTS + WIDTH, values[POINTS - 1]);
            values
        });
        let energies = [0, 1].map(|k| {
            let values = &columns[k][..POINTS];
            let (low, high) =
                values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(*x), high.max(*x)));
            BodyEnergy { column: &columns[k], mean: values.iter().sum::<f64>() / POINTS as f64, swing: high - low }
        });
        let mut spectrum = Spectrum::of(&grid).expect("an even grid");
        Isa::best().run(Exchanged(&Weights::of(&grid), &mut spectrum, total, energies))
    }

    /// Law: one body gains what the other loses, at the frequency of the swing; bodies at rest or of constant energy
    /// exchange nothing.
    #[test]
    fn bodies_at_rest_exchange_nothing() {
        let (correlation, frequency) =
            exchanged(3.0, |time| 1.0 + 0.5 * libm::sin(core::f64::consts::TAU * 1.5 * time));
        // of a mean and a sum of 64 terms; the frequency lies between two bins of 1/4 Hz
        assert!((correlation + 1.0).abs() < 1e-14 && (frequency - 1.5).abs() < 0.25, "{correlation} {frequency}");
        for (total, energy, what) in [(0.0, 0.0, "at rest"), (3.0, 1.0, "a steady spin")] {
            let (correlation, frequency) = exchanged(total, |_| energy);
            assert!(correlation == 0.0 && frequency.is_nan(), "{what}: {correlation} {frequency}");
        }
    }
}
