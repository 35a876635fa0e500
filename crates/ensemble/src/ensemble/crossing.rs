//! Zero crossings from values at [`nodes`]: interpolated if accurate, else narrowed down.

use core::f64::consts::PI;

/// Exact to rounding for motions of up to about a turn.
pub(super) const DEGREE: usize = 16;
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Halvings until neighbouring numbers.
const HALVINGS: usize = 60;

/// The extrema of the Chebyshev polynomial of degree [`DEGREE`] on [`start`, `end`], ascending, with exact ends.
pub(super) fn nodes(start: f64, end: f64) -> impl Iterator<Item = f64> {
    (0..=DEGREE).map(move |k| match k {
        0 => start,
        DEGREE => end,
        k => 0.5 * (start + end) - 0.5 * (end - start) * libm::cos(PI * k as f64 / DEGREE as f64),
    })
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Located {
    At(f64),
    /// Times before and after the crossing, s.
    Between(f64, f64),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wanted {
    pub is_rising: bool,
    pub is_last: bool,
}

impl Wanted {
    /// True if a quantity leaves zero in the wanted direction between these values.
    fn is_between(self, before: f64, after: f64) -> bool {
        if self.is_rising { before <= 0.0 && after > 0.0 } else { before >= 0.0 && after < 0.0 }
    }

    fn place(self, values: &[f64]) -> Option<usize> {
        let mut places = (1..values.len()).filter(|after| self.is_between(values[after - 1], values[*after]));
        let after = if self.is_last { places.next_back() } else { places.next() };
        after.map(|after| after - 1)
    }
}

/// The crossing of a quantity held from one of `times` to the next; `is_next`: no time lies between.
pub(super) fn of_steps(times: &[f64], values: &[f64], wanted: Wanted, is_next: impl Fn(f64, f64) -> bool) -> Located {
    match wanted.place(values) {
        Some(place) if !is_next(times[place], times[place + 1]) => Located::Between(times[place], times[place + 1]),
        Some(place) => Located::At(times[place + 1]),
        None => Located::At(nearest(times, values)),
    }
}

/// The crossing of a quantity with `values` at `times`, the [`nodes`] of one or several intervals, interpolated if its
/// error is at most `error`, s.
pub(super) fn of_curve(times: &[f64], values: &[f64], wanted: Wanted, error: f64) -> Located {
    let pieces = times.chunks_exact(DEGREE + 1).zip(values.chunks_exact(DEGREE + 1));
    let mut crossed = pieces.filter_map(|(times, values)| Some((times, values, wanted.place(values)?)));
    let found = if wanted.is_last { crossed.next_back() } else { crossed.next() };
    let Some((times, values, place)) = found else { return Located::At(nearest(times, values)) };
    let [start, end] = [times[place], times[place + 1]];
    let slope = (values[place + 1] - values[place]) / (end - start);
    let series = Series::of(values);
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let allowed = (error * slope.abs()).max(ROUNDING * largest);
    if series.tail() <= allowed {
        let middle = 0.5 * (times[0] + times[DEGREE]);
        let half = 0.5 * (times[DEGREE] - times[0]);
        return Located::At(bisect(start, end, |time| {
            wanted.is_between(values[place], series.value((time - middle) / half))
        }));
    }
    Located::Between(start, end)
}

/// The end nearest to zero: rounding moved the crossing onto a point.
fn nearest(times: &[f64], values: &[f64]) -> f64 {
    let ends = [0, times.len() - 1];
    let [first, last] = ends.map(|end| values[end].abs());
    times[if last < first { ends[1] } else { ends[0] }]
}

/// The time from which `is_after` holds.
fn bisect(mut start: f64, mut end: f64, is_after: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (start + end);
        if middle <= start || middle >= end {
            break;
        }
        if is_after(middle) { end = middle } else { start = middle }
    }
    end
}

/// The Chebyshev series through values at the nodes.
pub(super) struct Series([f64; DEGREE + 1]);

impl Series {
    pub fn of(values: &[f64]) -> Self {
        let half_at_ends = |k: usize| if k == 0 || k == DEGREE { 0.5 } else { 1.0 };
        Series(core::array::from_fn(|j| {
            // node k is at -cos(pi k/n)
            let term = |k: usize| half_at_ends(k) * values[DEGREE - k] * libm::cos(PI * (j * k) as f64 / DEGREE as f64);
            2.0 / DEGREE as f64 * half_at_ends(j) * (0..=DEGREE).map(term).sum::<f64>()
        }))
    }

    pub fn tail(&self) -> f64 {
        self.0[DEGREE - 2..].iter().map(|coefficient| coefficient.abs()).sum()
    }

    /// The value at x, from -1 to 1, by Clenshaw's recurrence.
    pub fn value(&self, x: f64) -> f64 {
        let (mut last, mut before) = (0.0, 0.0);
        for coefficient in self.0[1..].iter().rev() {
            (last, before) = (2.0 * x * last - before + coefficient, last);
        }
        x * last - before + self.0[0]
    }
}
