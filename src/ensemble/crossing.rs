//! Zero crossings of a quantity between two times, from its values at [`nodes`]: interpolated where that is exact, else
//! narrowed down.

use core::f64::consts::PI;

/// Degree of the polynomial through the nodes: exact to rounding for motions of up to about a turn.
const DEGREE: usize = 16;
/// Rounding of a quantity over its largest value.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Halvings of an interval until its ends are neighbours.
const HALVINGS: usize = 60;

/// The extreme points of the Chebyshev polynomial of degree [`DEGREE`] on [`start`, `end`], ascending, both ends exact.
pub(super) fn nodes(start: f64, end: f64) -> impl Iterator<Item = f64> {
    (0..=DEGREE).map(move |k| match k {
        0 => start,
        DEGREE => end,
        k => 0.5 * (start + end) - 0.5 * (end - start) * libm::cos(PI * k as f64 / DEGREE as f64),
    })
}

/// The result of a search for a crossing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Located {
    /// The time, s.
    At(f64),
    /// Times before and after the crossing, s, between which to look again.
    Between(f64, f64),
}

/// The crossing to be located between two times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wanted {
    /// Upwards, or downwards.
    pub is_rising: bool,
    /// The last one, or else the first.
    pub is_last: bool,
}

impl Wanted {
    /// Whether a quantity with these neighbouring values leaves zero between them in the wanted direction.
    fn is_between(self, before: f64, after: f64) -> bool {
        if self.is_rising { before <= 0.0 && after > 0.0 } else { before >= 0.0 && after < 0.0 }
    }

    /// The point before the crossing.
    fn place(self, values: &[f64]) -> Option<usize> {
        let mut places = (1..values.len()).filter(|after| self.is_between(values[after - 1], values[*after]));
        let after = if self.is_last { places.next_back() } else { places.next() };
        after.map(|after| after - 1)
    }
}

/// The crossing of a quantity that is held from one of `times` to the next, with these `values`; `is_next` tells whether
/// no time lies between two times.
pub(super) fn of_steps(times: &[f64], values: &[f64], wanted: Wanted, is_next: impl Fn(f64, f64) -> bool) -> Located {
    match wanted.place(values) {
        Some(place) if !is_next(times[place], times[place + 1]) => Located::Between(times[place], times[place + 1]),
        Some(place) => Located::At(times[place + 1]),
        None => Located::At(nearest(times, values)),
    }
}

/// The crossing of a quantity with these `values` at the [`nodes`] `times`, interpolated if the error of its time is at
/// most `error`, s.
pub(super) fn of_curve(times: &[f64], values: &[f64], wanted: Wanted, error: f64) -> Located {
    let Some(place) = wanted.place(values) else { return Located::At(nearest(times, values)) };
    let [start, end] = [times[place], times[place + 1]];
    let slope = (values[place + 1] - values[place]) / (end - start);
    let series = Series::of(values);
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let allowed = (error * slope.abs()).max(ROUNDING * largest);
    // NaN fails
    if series.tail() <= allowed {
        let middle = 0.5 * (times[0] + times[DEGREE]);
        let half = 0.5 * (times[DEGREE] - times[0]);
        return Located::At(bisect(start, end, |time| {
            wanted.is_between(values[place], series.value((time - middle) / half))
        }));
    }
    Located::Between(start, end)
}

/// The end with the value nearest to zero: rounding has moved the crossing onto a point.
fn nearest(times: &[f64], values: &[f64]) -> f64 {
    let ends = [0, times.len() - 1];
    let [first, last] = ends.map(|end| values[end].abs());
    times[if last < first { ends[1] } else { ends[0] }]
}

/// The time between `start` and `end` at which `is_after` begins to hold.
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

/// The Chebyshev series of the polynomial through the values at the nodes.
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

    /// The size of the last coefficients.
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

#[cfg(test)]
mod tests {
    use super::*;

    const RISING: Wanted = Wanted { is_rising: true, is_last: false };

    /// The crossing of `f` between `start` and `end`, and the number of passes.
    fn located(f: &dyn Fn(f64) -> f64, start: f64, end: f64, wanted: Wanted) -> (f64, usize) {
        let (mut start, mut end) = (start, end);
        for passes in 1..100 {
            let times: Vec<f64> = nodes(start, end).collect();
            let values: Vec<f64> = times.iter().map(|time| f(*time)).collect();
            match of_curve(&times, &values, wanted, 1e-12) {
                Located::At(time) => return (time, passes),
                Located::Between(before, after) if end - start > 1e-13 => (start, end) = (before, after),
                Located::Between(_, after) => return (after, passes),
            }
        }
        panic!("no end")
    }

    /// Law: the crossing of a smooth quantity is located at once, to rounding, also over a whole turn; the first and the
    /// last of several; at a corner and at a jump by narrowing.
    #[test]
    fn crossings_are_located() {
        for (f, exact, wanted) in [
            (&(|t: f64| libm::sin(t) - 0.3) as &dyn Fn(f64) -> f64, libm::asin(0.3), RISING),
            (&|t: f64| libm::sin(t) - 0.3, PI - libm::asin(0.3), Wanted { is_rising: false, is_last: true }),
            (&|t: f64| libm::exp(t) - 20.0, libm::log(20.0), RISING),
            (&|t: f64| t - 1.25, 1.25, RISING),
        ] {
            let (time, passes) = located(f, -0.5, 5.5, wanted);
            assert!((time - exact).abs() < 1e-12 && passes <= 2, "{time} for {exact}, {passes}");
        }
        let corner = |t: f64| (t - 1.0).abs().max(2.0 * (t - 1.1)) - 0.7;
        let (time, passes) = located(&corner, 1.0, 5.0, RISING);
        assert!((time - 1.45).abs() < 1e-12 && passes < 8, "{time} {passes}");
        let jump = |t: f64| if t < 2.345 { -1.0 } else { 1.0 };
        let (time, passes) = located(&jump, 0.0, 6.0, RISING);
        assert!((time - 2.345).abs() < 2e-12 && passes < 25, "{time} {passes}");
        let twice = |t: f64| libm::cos(3.0 * t);
        let last = Wanted { is_last: true, ..RISING };
        for (wanted, exact) in [(RISING, 0.5 * PI), (last, 7.0 * PI / 6.0)] {
            assert!((located(&twice, 0.0, 4.0, wanted).0 - exact).abs() < 1e-12);
        }
    }

    /// Law: a held quantity changes at the later of two neighbouring times, after a look at times between them.
    #[test]
    fn steps_are_at_the_later_time() {
        let (times, values) = ([0.0, 1.0, 3.0, 4.0], [-1.0, -2.0, 5.0, 6.0]);
        assert_eq!(of_steps(&times, &values, RISING, |_, _| true), Located::At(3.0));
        assert_eq!(of_steps(&times, &values, RISING, |a, b| b - a < 1.5), Located::Between(1.0, 3.0));
        assert_eq!(of_steps(&times, &[-1.0, -2.0, -0.5, -0.1], RISING, |_, _| true), Located::At(4.0));
    }
}
