//! [`Axis`]: range, unit and tick labels of an axis.

use std::ops::Range;

use crate::report::number::short;

/// Where a variable varies by less than this fraction of its magnitude, its axis shows the change since the first value.
const CHANGE_BELOW: f64 = 1e-3;

/// A change by less than this fraction of a variable's magnitude is what rounding makes of a constant in some thousands of operations: the axis is
/// not narrower, so that a constant looks constant.
const ROUNDING: f64 = 1e-12;

/// Values are shown as their difference from `base`, in units of 10^`power`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    base: f64,
    power: i32,
}

impl Axis {
    /// The axis of all finite `values`.
    pub(super) fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let values = values.filter(|value| value.is_finite());
        let (low, high) = values
            .clone()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let size = low.abs().max(high.abs());
        let span = high - low;
        let is_change = span > 0.0 && span < CHANGE_BELOW * size;
        if !is_change {
            return Axis { low, high, base: 0.0, power: power(size) };
        }
        let base = values.clone().next().unwrap_or(0.0);
        let (low, high) = (low.min(base - ROUNDING * size), high.max(base + ROUNDING * size));
        Axis { low, high, base, power: power(high - low) }
    }

    /// The axis of `values` that are changes of variables with magnitudes up to `size`.
    pub(super) fn of_changes(values: impl Iterator<Item = f64> + Clone, size: f64) -> Self {
        let least = ROUNDING * size;
        Axis::of(values.chain([-least, least]))
    }

    /// An axis from -`limit` to `limit`.
    pub(super) fn symmetric(limit: f64) -> Self {
        Axis { low: -limit, high: limit, base: 0.0, power: power(limit) }
    }

    /// The coordinate of a value.
    pub(super) fn map(&self, value: f64) -> f64 {
        (value - self.base) / libm::pow(10.0, f64::from(self.power))
    }

    /// The range of coordinates, wider by the fraction `margin` on each side.
    pub(super) fn range(&self, margin: f64) -> Range<f64> {
        let (low, high) = (self.map(self.low), self.map(self.high));
        if high > low {
            low - margin * (high - low)..high + margin * (high - low)
        } else {
            let half = if low == 0.0 { 1.0 } else { 0.01 * low.abs() };
            low - half..high + half
        }
    }

    /// The text of a tick, with as many decimals as neighbouring ticks need to differ.
    pub(super) fn label(&self, value: f64) -> String {
        let span = self.map(self.high) - self.map(self.low);
        let decimals = if span > 0.0 { (1.0 - libm::floor(libm::log10(span))).clamp(0.0, 9.0) as usize } else { 3 };
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    }

    /// The unit of the coordinates, and whether they are changes.
    pub(super) fn description(&self, unit: &str) -> String {
        let unit = match (self.power, unit) {
            (0, unit) => unit.to_owned(),
            (power, "") => format!("10{}", superscript(power)),
            (power, unit) => format!("10{} {unit}", superscript(power)),
        };
        if self.base == 0.0 { unit } else { format!("change, {unit}") }
    }

    /// What a title adds where the axis shows changes: the first value.
    pub(super) fn start(&self, unit: &str) -> String {
        if self.base == 0.0 { String::new() } else { format!(" (change from {} {unit})", short(self.base)) }
    }
}

/// The power of ten in which values up to `size` are written: a multiple of three, or zero where they are legible as they are.
fn power(size: f64) -> i32 {
    let decade = if size > 0.0 { libm::floor(libm::log10(size)) as i32 } else { 0 };
    if (-2..4).contains(&decade) { 0 } else { decade.div_euclid(3) * 3 }
}

/// `power` in superscript digits.
pub(super) fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = power.unsigned_abs().to_string();
    let digits = digits.chars().filter_map(|digit| digit.to_digit(10)).map(|digit| DIGITS[digit as usize]);
    (power < 0).then_some('⁻').into_iter().chain(digits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the ticks of a variable that hardly varies differ from each other, and the offset is explained.
    #[test]
    fn a_small_change_of_a_large_value_is_legible() {
        let axis = Axis::of([1_060_915.0, 1_060_914.9, 1_060_915.2].into_iter());
        assert_eq!(axis.base, 1_060_915.0);
        assert_ne!(axis.label(axis.map(1_060_915.05)), axis.label(axis.map(1_060_915.1)));
        assert_eq!((axis.description("J"), axis.start("J")), ("change, J".into(), " (change from 1.061e6 J)".into()));
        let axis = Axis::of([0.0, 3e-13].into_iter());
        assert_eq!((axis.base, axis.power, axis.description("")), (0.0, -15, "10⁻¹⁵".to_owned()));
        assert_eq!((axis.label(axis.map(1e-13)), axis.start("")), ("100".to_owned(), String::new()));
    }

    /// Law: rounding errors of a constant fill a hundredth of the axis at most; a change that is no rounding error fills it.
    #[test]
    fn a_constant_looks_constant() {
        let part = |axis: &Axis, change: f64| {
            let range = axis.range(0.0);
            (axis.map(axis.base + change) - axis.map(axis.base)) / (range.end - range.start)
        };
        let noise = [52.42, 52.42 + 3e-14, 52.42 - 2e-14];
        let axis = Axis::of(noise.into_iter());
        assert!(part(&axis, 3e-14) < 1e-2, "{axis:?}");
        assert_eq!(axis.start("N m s"), " (change from 52.42 N m s)");
        let axis = Axis::of([52.42, 52.42 + 1e-9].into_iter());
        assert!(part(&axis, 1e-9) > 0.9, "{axis:?}");
        // changes that are given as such
        let axis = Axis::of_changes([0.0, 1e-13, -2e-13].into_iter(), 5265.6);
        assert!(part(&axis, 1e-13) < 1e-2, "{axis:?}");
        assert!(part(&Axis::of([0.0, 1e-13, -2e-13].into_iter()), 1e-13) > 0.3);
        assert!(part(&Axis::of_changes([0.0, 1e-6].into_iter(), 5265.6), 1e-6) > 0.9);
    }

    #[test]
    fn a_symmetric_axis_has_zero_in_the_middle() {
        let range = Axis::symmetric(1e-10).range(0.1);
        assert_eq!(range.start, -range.end);
        assert_eq!(Axis::symmetric(1e-10).description(""), "10⁻¹²");
    }
}
