//! The largest value between two times from values at [`super::crossing::nodes`]: interpolated if accurate, else
//! narrowed down.

use super::crossing::{DEGREE, ROUNDING, Series};

/// Samples of the polynomial, several between extremes.
const SAMPLES: usize = 128;
const DIVISIONS: usize = 80;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A parabola exceeds its value at a point by an eighth of its second difference; points are searched if four times
/// that could make them largest.
pub(super) const BEYOND: f64 = 0.5;

/// The largest of `values`, NaN if all are unknown.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::NAN, |most, value| most.max(*value))
}

/// True if a value near `here` with these neighbours may exceed `known`; an unknown neighbour bounds nothing.
pub(super) fn may_exceed([before, here, next]: [f64; 3], known: f64) -> bool {
    let stays_below = here + BEYOND * (before - 2.0 * here + next).abs() < known;
    !here.is_nan() && !stays_below
}

/// The times to look between for values above the `largest` of `values` at `times`, the nodes of one or several
/// intervals, or one time: one time at the peak of a polynomial, which may exceed the quantity. Peaks are sought to a
/// share `error` of their size.
pub(super) fn of_curve(times: &[f64], values: &[f64], error: f64) -> Vec<[f64; 2]> {
    let pieces = times.chunks(DEGREE + 1).zip(values.chunks(DEGREE + 1));
    let known = largest(values);
    pieces.filter_map(|(times, values)| of_piece(times, values, known, error)).collect()
}

fn of_piece(times: &[f64], values: &[f64], known: f64, error: f64) -> Option<[f64; 2]> {
    let of_values = values.iter().enumerate().filter(|(_, value)| !value.is_nan());
    let (best, largest) = of_values.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let may_exceed = |three: &[f64]| may_exceed([three[0], three[1], three[2]], known);
    if values.iter().all(|value| value == largest) || *largest < known && !values.windows(3).any(may_exceed) {
        return None;
    }
    let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    let series = Series::of(values);
    if series.tail() <= error.max(ROUNDING) * size {
        let place = peak(&series);
        if series.value(place) <= known + ROUNDING * size {
            return None;
        }
        let [first, last] = [times[0], times[times.len() - 1]];
        let time = (0.5 * (first + last) + 0.5 * (last - first) * place).clamp(first, last);
        return Some([time; 2]);
    }
    let between = [best.saturating_sub(1), (best + 1).min(times.len() - 1)];
    let neighbours = between.map(|place| values[place]);
    let is_flat = neighbours.iter().all(|value| (largest - value).abs() <= error.max(ROUNDING) * size);
    let [start, end] = between.map(|place| times[place]);
    // a jump, or the end of the known values: nothing lies between
    let is_narrow = end - start <= 2.0 * ROUNDING * end.abs();
    (!is_flat && !is_narrow).then_some([start, end])
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
