//! Histograms: bars of equal width, by decades where values span many; of drawn samples with their nominal value and
//! with what is expected of the distribution that was asked for.

use crate::findings::number::short;
use crate::report::expected::Expected;
use crate::report::figure::{Axis, Dash, Figure, Hue, Mark, PointShape, Scale};

/// Fewest and most bars; between them as many as the square root of the number of values, so that few values are no
/// comb.
const BARS: [usize; 2] = [10, 40];
/// A nominal value farther from all samples than this fraction of their span is named at the edge: the samples keep two
/// thirds of the axis.
const FAR: f64 = 0.5;
/// Values whose median is below this fraction of the largest are those of a distribution over decades.
const OVER_DECADES: f64 = 0.05;

/// Edges of bars for `values`, and whether they are by decades: where all are positive and their range exceeds 100. The
/// first of `limits` among the values is an edge, so that no bar stands on both sides of it.
pub fn bins(values: &[f64], limits: &[f64]) -> (Vec<f64>, bool) {
    let (low, high) = ends(values);
    if low > high {
        return (Vec::new(), false);
    }
    let positive = values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
    // zeros are not on a logarithmic axis; where they are many, the axis is linear
    let is_log = low >= 0.0
        && positive.is_finite()
        && high > 100.0 * positive
        && values.iter().filter(|x| **x == 0.0).count() * 100 < values.len();
    if !is_log {
        return (linear_bins(values, limits), false);
    }
    let bars = bars(values.len());
    let edge = |k: usize| match k {
        0 => positive,
        _ if k == bars => high,
        _ => positive * libm::pow(high / positive, part(k, bars)),
    };
    let edges: Vec<f64> = (0..=bars).map(edge).collect();
    (moved(edges, limits, |edge, by| edge * by, |to, from| to / from), true)
}

/// How many bars so many values have.
fn bars(values: usize) -> usize {
    (values as f64).sqrt().ceil().clamp(BARS[0] as f64, BARS[1] as f64) as usize
}

/// `edges` with one more, moved by less than a bar so that the first of `limits` between their ends is an edge. `add`
/// moves an edge by a distance, and `distance` is that from one to another.
fn moved(
    edges: Vec<f64>,
    limits: &[f64],
    add: impl Fn(f64, f64) -> f64,
    distance: impl Fn(f64, f64) -> f64,
) -> Vec<f64> {
    let [first, second, .., last] = edges[..] else { return edges };
    let Some(limit) = limits.iter().copied().find(|limit| first < *limit && *limit < last) else { return edges };
    let Some(next) = edges.iter().copied().find(|edge| *edge >= limit) else { return edges };
    let by = distance(limit, next);
    let mut found: Vec<f64> = edges.iter().map(|edge| if *edge == next { limit } else { add(*edge, by) }).collect();
    found.push(add(add(last, by), distance(second, first)).max(last));
    found
}

fn ends(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

fn part(k: usize, bars: usize) -> f64 {
    k as f64 / bars as f64
}

/// Edges of equally wide bars; values on a lattice, as counts and times of control periods are, have bars of whole
/// steps of it, each with as many places.
fn linear_bins(values: &[f64], limits: &[f64]) -> Vec<f64> {
    let (low, high) = ends(values);
    if let Some(step) = lattice(values) {
        let steps = libm::round((high - low) / step) as usize;
        let most = if steps <= BARS[1] { BARS[1] } else { bars(values.len()) };
        let each = (steps + 1).div_ceil(most);
        // the places up to a limit end with a bar
        let limit = limits.iter().copied().find(|limit| low < *limit && *limit < high);
        let before = limit.map_or(0, |limit| libm::floor((limit - low) / step + 1e-6) as usize + 1);
        let outside = (each - before % each) % each;
        let edge = |k: usize| low + step * ((k * each) as f64 - outside as f64 - 0.5);
        return (0..=(steps + 1 + outside).div_ceil(each)).map(edge).collect();
    }
    let half = if high > low { 0.0 } else { 0.05 * low.abs().max(1e-300) };
    let bars = bars(values.len());
    let edge = |k: usize| (1.0 - part(k, bars)) * (low - half) + part(k, bars) * (high + half);
    moved((0..=bars).map(edge).collect(), limits, |edge, by| edge + by, |to, from| to - from)
}

/// The step of the lattice on which all of `values` are: one for whole numbers, else the smallest distance of two of
/// them, where many share a place; `None` where they are on none.
fn lattice(values: &[f64]) -> Option<f64> {
    /// Values to a place, at least, of values that are not whole.
    const SHARED: usize = 4;
    /// How far from its place a value may be, in steps: rounding of times that are multiples of a period.
    const OFF: f64 = 1e-6;
    /// Steps between the smallest and the largest value, at most.
    const LONGEST: f64 = 1e5;
    if values.iter().all(|value| *value == libm::floor(*value) && value.abs() < 1e15) {
        return Some(1.0);
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = (*sorted.first()?, *sorted.last()?);
    let apart = 1e-9 * (high - low);
    let gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > apart).collect();
    let step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let is_shared = !gaps.is_empty() && (gaps.len() + 1) * SHARED <= values.len() && high - low <= LONGEST * step;
    let is_on = |value: &f64| {
        let steps = (value - low) / step;
        (steps - libm::round(steps)).abs() < OFF * steps.max(1.0)
    };
    (is_shared && values.iter().all(is_on)).then_some(step)
}

/// How many `values` are between neighbouring `edges`; those at the ends count too.
pub fn counts(values: &[f64], edges: &[f64]) -> Vec<f64> {
    let bars = edges.len().saturating_sub(1);
    let mut counts = vec![0.0; bars];
    for value in values.iter().filter(|_| bars > 0) {
        let slack = 1e-9 * (edges[bars] - edges[0]);
        if *value >= edges[0] - slack && *value <= edges[bars] + slack {
            counts[edges.partition_point(|edge| edge <= value).clamp(1, bars) - 1] += 1.0;
        }
    }
    counts
}

/// The histogram of drawn samples of an input, with its unit; samples that are not finite are left out.
pub fn of_input(name: &str, unit: &str, samples: &[f64], nominal: f64, asked: Option<&Expected>) -> Figure {
    let values: Vec<f64> = samples.iter().copied().filter(|value| value.is_finite()).collect();
    let count = values.len();
    let discrete = asked.and_then(Expected::values);
    // the axis contains each value of a discrete distribution that one sample or more is expected to have
    let frequent = discrete.iter().flatten().filter(|(_, probability)| count as f64 * probability >= 1.0);
    let shown: Vec<f64> = values.iter().copied().chain(frequent.map(|(value, _)| *value)).collect();
    let mut sorted = shown.clone();
    sorted.sort_by(f64::total_cmp);
    let is_by_decades = sorted.get(sorted.len() / 2).is_some_and(|median| *median < OVER_DECADES * ends(&shown).1);
    let (edges, is_log) = if is_by_decades { bins(&shown, &[]) } else { (linear_bins(&shown, &[]), false) };
    let mut marks = vec![Mark::Bars {
        label: "samples".to_owned(),
        hue: Hue::Body,
        heights: counts(&values, &edges),
        edges: edges.clone(),
    }];
    match (discrete, asked) {
        (Some(values), _) => marks.push(stems(&values, count, &edges)),
        (None, Some(asked)) => {
            let middle = |ends: &[f64]| {
                if is_log { libm::sqrt(ends[0] * ends[1]) } else { 0.5 * ends[0] + 0.5 * ends[1] }
            };
            let x = edges.windows(2).map(middle).collect();
            let expected = asked.counts(&edges, count);
            marks.push(Mark::line("expected counts", Hue::Nominal, Dash::Solid, x, expected));
        }
        (None, None) => {}
    }
    let scale = if is_log { Scale::Log } else { Scale::Linear };
    let mut x = Axis { scale, ..Axis::linear("", unit) };
    let label = match (edges.first(), edges.last()) {
        (Some(low), Some(high)) if is_far(nominal, ends(&shown)) || (is_log && nominal <= 0.0) => {
            x = x.within(*low, *high);
            format!("nominal {}", short(nominal))
        }
        _ => "nominal".to_owned(),
    };
    if nominal.is_finite() {
        marks.push(Mark::Limit { label, at: nominal, vertical: true });
    }
    Figure { columns: 3, ..Figure::new(name, x, Axis::linear("samples", ""), marks) }
}

/// Whether the axis of the samples would be mostly empty with the nominal value on it; one value alone has no axis of
/// its own.
fn is_far(nominal: f64, (low, high): (f64, f64)) -> bool {
    let reach = FAR * (high - low);
    high > low && (low - nominal > reach || nominal - high > reach)
}

/// The probabilities of a discrete distribution as samples that are expected: one stem for each bar that contains a
/// value, at this value, or at the mean of those that share the bar.
fn stems(values: &[(f64, f64)], count: usize, edges: &[f64]) -> Mark {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for ends in edges.windows(2) {
        let is_last = Some(&ends[1]) == edges.last();
        let inside =
            values.iter().filter(|(value, _)| *value >= ends[0] && (*value < ends[1] || is_last && *value == ends[1]));
        let (sum, probability) = inside.fold((0.0, 0.0), |(sum, all), (value, p)| (sum + p * value, all + p));
        if probability > 0.0 {
            x.push(sum / probability);
            y.push(count as f64 * probability);
        }
    }
    let label = "expected count of a discrete value".to_owned();
    Mark::points(label, (Hue::Nominal, PointShape::Stem), x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: bars of counts and of times of control periods have equally many places of the lattice, so that equally
    /// many values at each place are equally high bars, but for those at the ends; a bar ends with the last place up to
    /// a limit.
    #[test]
    fn bars_follow_the_lattice() {
        for (step, offset) in [(1.0, 3.0), (0.1, 0.05), (0.25, -7.0)] {
            for places in [2, 7, 41, 57, 333, 1000] {
                let values: Vec<f64> = (0..5 * places).map(|k| offset + step * f64::from(k % places)).collect();
                let limit = offset + step * libm::floor(0.4 * f64::from(places));
                let edges = linear_bins(&values, &[limit]);
                let heights = counts(&values, &edges);
                let inner = &heights[1..heights.len() - 1];
                assert!(inner.windows(2).all(|pair| pair[0] == pair[1]), "{step}, {places}: {heights:?}");
                let ends = heights.iter().all(|height| inner.is_empty() || *height <= inner[0]);
                assert!(ends, "{step}, {places}: {heights:?}");
                let is_edge = |edge: &f64| (edge - limit - 0.5 * step).abs() < 1e-6 * step;
                assert!(limit == offset || edges.iter().any(is_edge), "{limit}: {edges:?}");
                assert!(heights.len() <= BARS[1].max(bars(values.len())) + 1, "{step}, {places}: {}", heights.len());
                assert_eq!(heights.iter().sum::<f64>(), f64::from(5 * places));
            }
        }
        // values of their own are on no lattice
        let values: Vec<f64> = (0..400).map(|k| libm::sqrt(f64::from(k))).collect();
        assert_eq!(lattice(&values), None);
    }

    /// Law: bars are as many as the square root of the number of values, from ten to forty; a limit between the values
    /// is an edge of them, on every kind of axis, and every value is still in one bar.
    #[test]
    fn bars_are_few_for_few_values_and_end_at_a_limit() {
        for (count, bars) in [(2, 10), (100, 10), (225, 15), (1000, 32), (1600, 40), (100_000, 40)] {
            let values = |end: f64| (0..count).map(move |k| 1.0 + end * f64::from(k) / f64::from(count - 1));
            for (values, is_by_decades) in [
                (values(2.5).collect::<Vec<f64>>(), false),
                (values(1.0).map(|value| libm::pow(1e6, value - 1.0)).collect(), true),
            ] {
                let (low, high) = ends(&values);
                let (edges, is_log) = bins(&values, &[]);
                assert_eq!((edges.len(), is_log), (bars + 1, is_by_decades), "{count}");
                for share in [1e-9, 0.03, 0.5, 0.77, 1.0 - 1e-9] {
                    let limit = if is_log { low * libm::pow(high / low, share) } else { low + share * (high - low) };
                    let (edges, _) = bins(&values, &[low - 1.0, limit]);
                    assert!(edges.contains(&limit) && edges.is_sorted() && edges.len() == bars + 2, "{edges:?}");
                    assert!(edges[0] <= low && edges[bars + 1] >= high, "{limit}: {edges:?}");
                    assert_eq!(counts(&values, &edges).iter().sum::<f64>(), f64::from(count), "{limit}");
                }
                assert_eq!(bins(&values, &[high + 1.0]).0, edges);
            }
        }
    }

    /// Law: each value of a discrete distribution has a stem of the height that is expected, and values that share a
    /// bar one of their sum; a continuous one has a curve whose sum is the number of samples, at the middle of each bar
    /// as the axis shows it.
    #[test]
    fn what_is_expected_is_drawn() {
        let drawn: Vec<f64> = (0..300).map(|k| [0.01, 0.02, 0.05][k % 3]).collect();
        let of = |values: &[f64; 3]| Expected::of_quantile(|u| values[(3.0 * u) as usize]);
        let stems = |values: &[f64; 3]| match of_input("x", "", &drawn, 0.01, Some(&of(values))).marks.swap_remove(1) {
            Mark::Points { shape: PointShape::Stem, x, y, .. } => (x, y),
            other => panic!("{other:?}"),
        };
        let (x, y) = stems(&[0.01, 0.02, 0.05]);
        assert!(x.iter().zip([0.01, 0.02, 0.05]).all(|(x, known)| (x - known).abs() < 1e-12), "{x:?}");
        assert!(y.len() == 3 && y.iter().all(|y| (y - 100.0).abs() < 0.05), "{y:?}");
        let (x, y) = stems(&[0.01, 0.0101, 0.05]);
        assert!(x.len() == 2 && (y[0] - 200.0).abs() < 0.05, "{x:?} {y:?}");
        // a value that was not drawn although samples are expected there is on the axis
        assert_eq!(stems(&[0.01, 0.02, 9.0]).0.last(), Some(&9.0));
        let decades: Vec<f64> = (0..300).map(|k| 1e-3 * libm::pow(1e4, f64::from(k) / 299.0)).collect();
        for (samples, scale, [min, max]) in
            [(&drawn, Scale::Linear, [0.01, 0.05]), (&decades, Scale::Log, [1e-3, 10.0])]
        {
            let uniform = Expected::of_quantile(|u| min + u * (max - min));
            let figure = of_input("x", "", samples, min, Some(&uniform));
            let [Mark::Bars { edges, .. }, Mark::Line { x, y, .. }, ..] = &figure.marks[..] else {
                panic!("{figure:?}")
            };
            assert!((y.iter().sum::<f64>() - 300.0).abs() < 1e-6, "{y:?}");
            assert_eq!((&figure.x.scale, x.len()), (&scale, edges.len() - 1));
            let place = |value: f64| if scale == Scale::Log { libm::log(value) } else { value };
            for (x, ends) in x.iter().zip(edges.windows(2)) {
                let part = (place(*x) - place(ends[0])) / (place(ends[1]) - place(ends[0]));
                assert!((part - 0.5).abs() < 1e-9, "{x} in {ends:?}");
            }
        }
    }
}
