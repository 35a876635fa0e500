//! Bins of histograms: equal width, logarithmic for large ranges, whole steps for values on a lattice.

/// Minimum and maximum number of bars; in between, the square root of the number of values.
const BARS: [usize; 2] = [10, 40];

/// Edges of bars for `values`, and whether they are logarithmic: for positive values with a range above 100. The first
/// of `limits` among the values becomes an edge, so that no bar straddles it.
pub fn bins(values: &[f64], limits: &[f64]) -> (Vec<f64>, bool) {
    let (low, high) = ends(values);
    if low > high {
        return (Vec::new(), false);
    }
    let positive = values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
    // a logarithmic axis omits zeros: many of them require a linear one
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

fn bars(values: usize) -> usize {
    (values as f64).sqrt().ceil().clamp(BARS[0] as f64, BARS[1] as f64) as usize
}

/// Adds an edge and shifts all by less than a bar, so that the first of `limits` within them is an edge. `add` moves an
/// edge by a `distance` between two.
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

/// Minimum and maximum.
pub fn ends<'v>(values: impl IntoIterator<Item = &'v f64>) -> (f64, f64) {
    values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

fn part(k: usize, bars: usize) -> f64 {
    k as f64 / bars as f64
}

/// Edges of equally wide bars; on a lattice, as of counts and control periods, of whole steps.
pub fn linear_bins(values: &[f64], limits: &[f64]) -> Vec<f64> {
    let mut edges = equal_bins(values, limits);
    // bars of magnitudes begin at zero
    edges.first_mut().filter(|_| ends(values).0 >= 0.0).into_iter().for_each(|first| *first = first.max(0.0));
    edges
}

fn equal_bins(values: &[f64], limits: &[f64]) -> Vec<f64> {
    let (low, high) = ends(values);
    if let Some(step) = lattice(values) {
        let steps = libm::round((high - low) / step) as usize;
        let most = if steps <= BARS[1] { BARS[1] } else { bars(values.len()) };
        let each = (steps + 1).div_ceil(most);
        // a bar ends at the last place up to the limit
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

/// The step of the lattice of all `values`: one for whole numbers, else the smallest distance, if many values share
/// places; `None` if there is no lattice.
fn lattice(values: &[f64]) -> Option<f64> {
    /// Minimum values per place, unless whole.
    const SHARED: usize = 4;
    /// Tolerance in steps: rounding of multiples of a period.
    const OFF: f64 = 1e-6;
    /// Maximum range in steps.
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

/// Number of `values` between neighbouring `edges`, including both ends.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: on a lattice all bars have equally many places, so that uniform values give bars of equal height, except at
    /// the ends; a bar ends at the last place up to a limit.
    #[test]
    fn bars_follow_the_lattice() {
        for (step, offset) in [(1.0, 3.0), (0.1, 0.05), (0.25, -7.0)] {
            for places in [2, 7, 41, 57, 333, 1000] {
                let values: Vec<f64> = (0..5 * places).map(|k| offset + step * f64::from(k % places)).collect();
                let limit = offset + step * libm::floor(0.4 * f64::from(places));
                let edges = linear_bins(&values, &[limit]);
                assert_eq!(edges[0] < 0.0, offset < 0.0, "{edges:?}");
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
        let values: Vec<f64> = (0..400).map(|k| libm::sqrt(f64::from(k))).collect();
        assert_eq!(lattice(&values), None);
    }

    /// Law: the square root of the number of values, from ten to forty, is the number of bars; a limit among the values
    /// is an edge on every scale, and every value is in one bar.
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
                    assert!((0.0..=low).contains(&edges[0]) && edges[bars + 1] >= high, "{limit}: {edges:?}");
                    assert_eq!(counts(&values, &edges).iter().sum::<f64>(), f64::from(count), "{limit}");
                }
                assert_eq!(bins(&values, &[high + 1.0]).0, edges);
            }
        }
    }
}
