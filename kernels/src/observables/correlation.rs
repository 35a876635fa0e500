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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isa;
    use crate::math::isa::Work;
    use crate::math::lanes::WIDTH;
    use crate::run::Grid;

    /// Some roundings of sums of up to a hundred terms of size one.
    const ROUNDING: f64 = 1e-14;

    struct Correlate<'a>(&'a Weights, &'a [f64], f64);
    impl Work for Correlate<'_> {
        type Output = (f64, f64);
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let own = (self.1, self.2);
            (slope(simd, self.0, self.1, self.2), correlation(simd, self.0, own, own))
        }
    }

    /// Slope and self-correlation of the series f(0), f(1), ... at `times`.
    fn correlated(times: &[f64], f: impl Fn(usize) -> f64) -> (f64, f64) {
        let mut values: Vec<f64> = (0..times.len()).map(f).collect();
        let mean = values.iter().sum::<f64>() / times.len() as f64;
        let last = values[times.len() - 1];
        values.resize(times.len().next_multiple_of(WIDTH) + WIDTH, last);
        Isa::best().run(Correlate(&Weights::of(&Grid::at(times.to_vec())), &values, mean))
    }

    #[test]
    fn a_line_has_its_slope_on_even_and_uneven_grids() {
        for times in [
            (0..101).map(|k| 0.1 * k as f64).collect::<Vec<_>>(),
            (0..37).map(|k| (k * k) as f64 * 0.01).collect(),
            vec![0.0, 1.0, 10.0],
        ] {
            let (slope, _) = correlated(&times, |k| 2.0 - 0.75 * times[k]);
            assert!((slope + 0.75).abs() <= ROUNDING, "{slope}");
        }
    }

    #[test]
    fn a_series_is_correlated_with_itself_unless_it_is_constant() {
        let times: Vec<f64> = (0..11).map(|k| 0.1 * f64::from(k)).collect();
        let (_, same) = correlated(&times, |k| (k * k) as f64);
        assert!((same - 1.0).abs() <= ROUNDING, "{same:?}");
        let (_, constant) = correlated(&times, |_| 3.0);
        assert_eq!(constant, 0.0);
    }
}
