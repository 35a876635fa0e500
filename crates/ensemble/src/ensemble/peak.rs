//! The largest value between two times from values at [`super::crossing::nodes`]: interpolated if accurate, else
//! narrowed down.

use super::crossing::{ROUNDING, Series};

/// Samples of the polynomial, several between extremes.
const SAMPLES: usize = 128;
const DIVISIONS: usize = 80;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Peak {
    Value(f64),
    /// The largest so far, and the times to look between, s: one time at the peak of a polynomial, which may exceed the
    /// quantity.
    Between(f64, [f64; 2]),
}

/// The largest of `values` at the nodes `times`, or at one time, to a share `error` of its size; NaN is unknown.
pub(super) fn of_curve(times: &[f64], values: &[f64], error: f64) -> Peak {
    let known = values.iter().enumerate().filter(|(_, value)| !value.is_nan());
    let Some((best, largest)) = known.max_by(|(_, a), (_, b)| a.total_cmp(b)) else { return Peak::Value(f64::NAN) };
    if values.iter().all(|value| value == largest) {
        return Peak::Value(*largest);
    }
    let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    let series = Series::of(values);
    if series.tail() <= error.max(ROUNDING) * size {
        let place = peak(&series);
        if series.value(place) <= largest + ROUNDING * size {
            return Peak::Value(*largest);
        }
        let [first, last] = [times[0], times[times.len() - 1]];
        let time = (0.5 * (first + last) + 0.5 * (last - first) * place).clamp(first, last);
        return Peak::Between(*largest, [time; 2]);
    }
    let between = [best.saturating_sub(1), (best + 1).min(times.len() - 1)];
    let neighbours = between.map(|place| values[place]);
    let is_flat = neighbours.iter().all(|value| (largest - value).abs() <= error.max(ROUNDING) * size);
    let [start, end] = between.map(|place| times[place]);
    // a jump, or the end of the known values: nothing lies between
    let is_narrow = end - start <= 2.0 * ROUNDING * end.abs();
    if is_flat || is_narrow { Peak::Value(*largest) } else { Peak::Between(*largest, [start, end]) }
}

fn peak(series: &Series) -> f64 {
    let at = |sample: usize| -1.0 + 2.0 * sample as f64 / SAMPLES as f64;
    let value = |x: f64| series.value(x);
    let best = (0..=SAMPLES).max_by(|a, b| value(at(*a)).total_cmp(&value(at(*b)))).unwrap_or(0);
    let [mut low, mut high] = [best.saturating_sub(1), (best + 1).min(SAMPLES)].map(at);
    for _ in 0..DIVISIONS {
        let part = GOLDEN * (high - low);
        if value(high - part) < value(low + part) { low = high - part } else { high = low + part }
    }
    let middle = 0.5 * (low + high);
    if value(middle) > value(at(best)) { middle } else { at(best) }
}
