//! Passes over a series: extremes, means, errors, transfers, in a fixed order of operations.
//!
//! Lane `i` of an accumulator gathers points `i`, `i + 8`, ..., and the eight are joined as a fixed tree. Means are of
//! departures from the first value: the rounding error of n points is at most n/8 + 4 roundings of the largest
//! *departure*. Weights are zero in the padding.

use fearless_simd::Simd;

use super::reduction::{ChangeStatistic, ErrorStatistic, OrderStatistic, Passes, Reduction, Stored, ValueStatistic};
use super::weights::{Weights, largest, smallest, total, vectors};
use crate::math::{Lanes, Real};

/// Reduces a series of numbers `stored` and writes the values to `out` at [`Reduction::index`]; errors and fraction are
/// divided by `scale`. `column` has one vector more than the weights.
#[inline(always)]
pub fn reduce<S: Simd>(
    simd: S,
    weights: &Weights,
    column: &[f64],
    passes: Passes,
    stored: Stored,
    scale: f64,
    out: &mut [f64; Reduction::COUNT],
) {
    if passes.order.contains(&true) {
        let order = order(simd, weights, column);
        for ((out, value), _) in out.iter_mut().zip(order).zip(passes.order).filter(|(_, is_needed)| *is_needed) {
            *out = stored.shown(value);
        }
    }
    if passes.value {
        let values = spread(simd, weights, column);
        out[Reduction::VALUE..Reduction::ERROR].copy_from_slice(&values);
        out[Reduction::FRACTION] = values[ValueStatistic::PeakToPeak as usize] / scale;
    }
    if passes.error {
        let errors = errors(simd, weights, column);
        out[Reduction::ERROR..Reduction::CHANGE].copy_from_slice(&errors.map(|error| error / scale));
    }
    if passes.change {
        out[Reduction::CHANGE..Reduction::FRACTION].copy_from_slice(&transfer(simd, weights, column));
    }
}

/// By [`ValueStatistic`]; extremes and mean are NaN if a value is.
#[inline(always)]
fn spread<S: Simd>(simd: S, weights: &Weights, column: &[f64]) -> [f64; ValueStatistic::ALL.len()] {
    let initial = column[0];
    let first = Lanes::broadcast(simd, initial);
    let mut min = first;
    let mut max = first;
    let mut sum = first.zero();
    for (x, one) in vectors(column, weights.one.len()).iter().zip(&weights.one) {
        let x = Lanes::load(simd, x);
        min = x.smaller(min);
        max = x.larger(max);
        sum = (x - first).mul_add(Lanes::load(simd, one), sum);
    }
    let mean = initial + total(sum) / weights.points as f64;
    let last = column[weights.points - 1];
    let [min, max] = if mean.is_nan() { [f64::NAN; 2] } else { [smallest(min), largest(max)] };
    [initial, last, min, max, mean, max - min, last - initial]
}

/// By [`OrderStatistic`].
#[inline(always)]
fn order<S: Simd>(simd: S, weights: &Weights, column: &[f64]) -> [f64; OrderStatistic::ALL.len()] {
    let mut max = Lanes::broadcast(simd, column[0]);
    for x in vectors(column, weights.one.len()) {
        max = Lanes::load(simd, x).larger(max);
    }
    [column[0], column[weights.points - 1], largest(max)]
}

/// By [`ErrorStatistic`].
#[inline(always)]
fn errors<S: Simd>(simd: S, weights: &Weights, values: &[f64]) -> [f64; ErrorStatistic::ALL.len()] {
    let zero = Lanes::broadcast(simd, 0.0);
    let (mut max, mut squares, mut slope) = (zero, zero, zero);
    let count = weights.one.len();
    let (column, one, line) = (vectors(values, count), &weights.one[..count], &weights.slope[..count]);
    for at in 0..count {
        let e = Lanes::load(simd, &column[at]);
        max = e.abs().larger(max);
        squares = (e * Lanes::load(simd, &one[at])).mul_add(e, squares);
        slope = e.mul_add(Lanes::load(simd, &line[at]), slope);
    }
    let rms = (total(squares) / weights.points as f64).sqrt();
    // a maximum by comparison skips NaN, a sum does not
    let max = if rms.is_nan() { f64::NAN } else { largest(max) };
    [max, values[weights.points - 1], rms, total(slope)]
}

/// By [`ChangeStatistic`].
#[inline(always)]
fn transfer<S: Simd>(simd: S, weights: &Weights, column: &[f64]) -> [f64; ChangeStatistic::ALL.len()] {
    let mut gross = Lanes::broadcast(simd, 0.0);
    let mut power = gross;
    let count = weights.one.len();
    let (next, column) = (vectors(&column[1..], count), vectors(column, count));
    let inverse_step = &weights.inverse_step[..count];
    for at in 0..count {
        // the padding repeats the last point and adds nothing
        let change = (Lanes::load(simd, &next[at]) - Lanes::load(simd, &column[at])).abs();
        gross += change;
        power = (change * Lanes::load(simd, &inverse_step[at])).larger(power);
    }
    [total(gross), largest(power)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isa;
    use crate::math::isa::Work;
    use crate::math::lanes::WIDTH;
    use crate::run::Grid;

    const ROUNDING: f64 = 5e-14;

    struct Reduce<'a>(&'a Weights, &'a [f64]);
    impl Work for Reduce<'_> {
        type Output = ([f64; 7], [f64; 4], [f64; 2]);
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            (spread(simd, self.0, self.1), errors(simd, self.0, self.1), transfer(simd, self.0, self.1))
        }
    }

    fn column(points: usize, f: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = (0..points).map(f).collect();
        let last = values[points - 1];
        values.resize(points.next_multiple_of(WIDTH) + WIDTH, last);
        values
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= ROUNDING * b.abs().max(1.0), "{a} != {b}");
    }

    #[test]
    fn every_number_agrees_with_its_definition_and_padding_counts_for_none() {
        for points in [1, 2, 7, 8, 9, 16, 101] {
            let times: Vec<f64> = (0..points).map(|k| k as f64 + 0.3 * (k as f64 * 0.7).floor()).collect();
            let weights = Weights::of(&Grid::at(times.clone()));
            let values = column(points, |k| ((k * 37 + 11) % 23) as f64 / 7.0 - 1.5);
            let ([initial, last, min, max, mean, ..], [error, last_error, rms, slope], [gross, power]) =
                Isa::best().run(Reduce(&weights, &values));
            let v = &values[..points];
            let n = points as f64;
            assert_eq!(min, v.iter().copied().fold(f64::INFINITY, f64::min));
            assert_eq!(max, v.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            assert_eq!((initial, last, last_error), (v[0], v[points - 1], v[points - 1]));
            close(mean, v.iter().sum::<f64>() / n);
            close(rms, (v.iter().map(|x| x * x).sum::<f64>() / n).sqrt());
            assert_eq!(error, v.iter().map(|x| x.abs()).fold(0.0, f64::max));
            let middle = times.iter().sum::<f64>() / n;
            let off: Vec<f64> = times.iter().map(|time| time - middle).collect();
            let squares: f64 = off.iter().map(|off| off * off).sum();
            let along: f64 = v.iter().zip(&off).map(|(x, off)| x * off).sum();
            close(slope, if points > 1 { along / squares } else { 0.0 });
            close(gross, v.windows(2).map(|x| (x[1] - x[0]).abs()).sum());
            let slopes = v.windows(2).zip(times.windows(2)).map(|(x, t)| ((x[1] - x[0]) / (t[1] - t[0])).abs());
            close(power, slopes.fold(0.0, f64::max));
        }
    }

    #[test]
    fn a_small_swing_on_a_large_value_keeps_its_mean() {
        let weights = Weights::of(&Grid::uniform(1.0, 101));
        let values = column(101, |k| 1e6 + (k % 2) as f64);
        let ([.., mean, _, _], ..) = Isa::best().run(Reduce(&weights, &values));
        assert_eq!(mean, 1e6 + 50.0 / 101.0);
    }

    #[test]
    fn what_is_not_a_number_is_not_lost_in_a_maximum() {
        let weights = Weights::of(&Grid::uniform(1.0, 20));
        let values = column(20, |k| if k == 13 { f64::NAN } else { k as f64 });
        let ([_, _, min, max, mean, ..], [error, _, rms, _], _) = Isa::best().run(Reduce(&weights, &values));
        assert!([min, max, mean, error, rms].into_iter().all(f64::is_nan));
    }
}
