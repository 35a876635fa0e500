//! [`DrawnAxis`]: an axis of a figure in a file: from values to places, where its ticks are, and what is written at them.

use crate::findings::number::short;
use crate::report::figure::{Axis, Scale};

/// Where a variable varies by less than this fraction of its magnitude, its axis shows the change since the first value.
const CHANGE_BELOW: f64 = 1e-3;
/// A change by less than this fraction of a variable's magnitude is what rounding makes of a constant in some thousands of operations: the
/// axis is not narrower, so that a constant looks constant.
pub(super) const ROUNDING: f64 = 1e-12;
/// Free part of a linear axis on each side.
const MARGIN: f64 = 0.04;

/// An axis between two coordinates: of a value v, (v - base)/10^power on a linear axis, the decimal logarithm on one by decades.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DrawnAxis {
    axis: Axis,
    low: f64,
    high: f64,
    base: f64,
    power: i32,
}

fn ends(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|value| value.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    (low <= high).then_some([low, high])
}

impl DrawnAxis {
    /// The axis that shows `values`.
    pub(super) fn new(axis: &Axis, values: &[f64]) -> Self {
        let values = axis.range.as_ref().map_or(values, |range| range.as_slice());
        let drawn = |[low, high]: [f64; 2], base, power| DrawnAxis { axis: axis.clone(), low, high, base, power };
        match &axis.scale {
            Scale::Linear => {
                let [low, high] = ends(values.iter().copied()).unwrap_or([0.0, 0.0]);
                let size = low.abs().max(high.abs());
                let is_change = high > low && high - low < CHANGE_BELOW * size;
                let base = values.iter().copied().find(|value| is_change && value.is_finite()).unwrap_or(0.0);
                let (low, high) = match is_change {
                    true => (low.min(base - ROUNDING * size), high.max(base + ROUNDING * size)),
                    false => (low, high),
                };
                let power = power_of(if is_change { high - low } else { size });
                let [low, high] = [low, high].map(|value| (value - base) / libm::pow(10.0, f64::from(power)));
                let half = if low == 0.0 { 1.0 } else { 0.05 * low.abs() };
                let margin = match (high > low, axis.range) {
                    (false, _) => half,
                    (true, Some(_)) => 0.0,
                    (true, None) => MARGIN * (high - low),
                };
                drawn([low - margin, high + margin], base, power)
            }
            Scale::Log => {
                let logarithms = values.iter().filter(|value| **value > 0.0).map(|value| libm::log10(*value));
                let [low, high] = ends(logarithms).unwrap_or([0.0, 1.0]);
                let margin = (MARGIN * (high - low)).max(0.05);
                drawn([low - margin, high + margin], 0.0, 0)
            }
            Scale::Names(names) => drawn([-0.5, names.len().max(1) as f64 - 0.5], 0.0, 0),
        }
    }

    fn coordinate(&self, value: f64) -> f64 {
        match self.axis.scale {
            Scale::Linear => (value - self.base) / libm::pow(10.0, f64::from(self.power)),
            Scale::Log if value > 0.0 => libm::log10(value),
            Scale::Log => f64::NAN,
            Scale::Names(_) => value,
        }
    }

    /// The place of a value: 0 and 1 at the ends of the axis, NaN where it has none.
    pub(super) fn at(&self, value: f64) -> f64 {
        self.place(self.coordinate(value))
    }

    fn place(&self, coordinate: f64) -> f64 {
        let place = (coordinate - self.low) / (self.high - self.low);
        if self.axis.is_descending { 1.0 - place } else { place }
    }

    /// Quantity and unit, with the power of ten that the ticks are in and the value that changes are from.
    pub(super) fn title(&self) -> String {
        let power = if self.power == 0 { String::new() } else { format!("10{}", superscript(self.power)) };
        let is_spaced = !power.is_empty() && !self.axis.unit.is_empty();
        let unit = format!("{power}{}{}", if is_spaced { " " } else { "" }, self.axis.unit);
        let change = if self.base == 0.0 { "" } else { "change" };
        let quantity = match (self.axis.quantity.as_str(), change) {
            ("", text) | (text, "") => text.to_owned(),
            (quantity, change) => format!("{change} of {quantity}"),
        };
        let separator = if quantity.is_empty() || unit.is_empty() { "" } else { " / " };
        format!("{quantity}{separator}{unit}")
    }

    /// What a title adds where the axis shows changes: the first value.
    pub(super) fn start(&self) -> String {
        let unit = if self.axis.unit.is_empty() { String::new() } else { format!(" {}", self.axis.unit) };
        if self.base == 0.0 { String::new() } else { format!(" (change from {}{unit})", short(self.base)) }
    }

    /// At most `most` ticks, at round values: their places and texts. By decades: whole ones; where there are fewer than two, also 2 and 5
    /// times a decade, and if need be round values.
    pub(super) fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        let most = most.max(2);
        let ticks: Vec<(f64, String)> = match &self.axis.scale {
            Scale::Names(names) => names.iter().enumerate().map(|(row, name)| (row as f64, name.clone())).collect(),
            Scale::Linear => {
                let least = (self.high - self.low) / most as f64;
                let step = match self.axis.step.map(|step| step / libm::pow(10.0, f64::from(self.power))) {
                    Some(step) => step * libm::ceil(least / step - 1e-9),
                    None => round_step(least),
                };
                let decimals = (-libm::floor(libm::log10(step) + 1e-9)).clamp(0.0, 12.0) as usize;
                multiples(self.low, self.high, step).map(|at| (at, decimal(at, decimals))).collect()
            }
            Scale::Log => self.decades(most).into_iter().map(|at| (at, power_text(at))).collect(),
        };
        ticks.into_iter().map(|(at, text)| (self.place(at), text)).collect()
    }

    /// Coordinates of the ticks of an axis by decades.
    fn decades(&self, most: usize) -> Vec<f64> {
        let (first, last) = (self.low.ceil() as i32, self.high.floor() as i32);
        if last > first {
            let every = ((last - first) as usize).div_ceil(most - 1);
            return (first..=last).step_by(every).map(f64::from).collect();
        }
        let logarithms = [1.0, 2.0, 5.0].map(libm::log10);
        let places = [first - 1, first].map(f64::from).into_iter().flat_map(|at| logarithms.map(|of| at + of));
        let inside: Vec<f64> = places.filter(|place| (self.low..=self.high).contains(place)).collect();
        if inside.len() > 1 {
            return inside;
        }
        // in units of the decade, so that no size of numbers matters
        let decade = f64::from(first - 1);
        let [low, high] = [self.low, self.high].map(|place| libm::pow(10.0, place - decade));
        let round = multiples(low, high, round_step((high - low) / 4.0));
        round.map(|multiple| decade + libm::log10(multiple)).collect()
    }
}

/// The multiples of `step` from `low` to `high`.
fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = (libm::ceil(low / step - 1e-9) as i64, libm::floor(high / step + 1e-9) as i64);
    (first..=last).map(move |count| count as f64 * step)
}

/// The smallest of 1, 2 and 5 times a power of ten that is no smaller than `step`.
fn round_step(step: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(step)));
    [1.0, 2.0, 5.0].map(|digit| digit * decade).into_iter().find(|round| *round >= step).unwrap_or(10.0 * decade)
}

/// A number with at most so many decimals.
fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// 10^`exponent`: a power of ten, or a short number times one.
fn power_text(exponent: f64) -> String {
    let whole = libm::round(exponent);
    if (exponent - whole).abs() < 1e-9 {
        return format!("10{}", superscript(whole as i32));
    }
    let whole = libm::floor(exponent);
    let factor = decimal(libm::pow(10.0, exponent - whole), 2);
    if whole == 0.0 { factor } else { format!("{factor}\u{d7}10{}", superscript(whole as i32)) }
}

/// The power of ten in which values up to `size` are written: a multiple of three, or zero where they are legible as they are.
fn power_of(size: f64) -> i32 {
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

    fn linear(values: &[f64]) -> DrawnAxis {
        DrawnAxis::new(&Axis::linear("", "J"), values)
    }

    /// Law: the ticks of a variable that hardly varies differ from each other, and the offset is explained.
    #[test]
    fn a_small_change_of_a_large_value_is_legible() {
        let axis = linear(&[1_060_915.0, 1_060_914.9, 1_060_915.2]);
        assert_eq!((axis.title().as_str(), axis.start().as_str()), ("change / J", " (change from 1.061e6 J)"));
        let texts: Vec<String> = axis.ticks(6).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["-0.1", "0", "0.1", "0.2"]);
        let axis = linear(&[0.0, 3e-13]);
        assert_eq!((axis.title().as_str(), axis.start().as_str()), ("10⁻¹⁵ J", ""));
        assert!(axis.ticks(6).iter().any(|(place, text)| text == "100" && (place - axis.at(1e-13)).abs() < 1e-12));
    }

    /// Law: rounding errors of a constant fill a hundredth of the axis at most; a change that is no rounding error fills it.
    #[test]
    fn a_constant_looks_constant() {
        let part = |axis: &DrawnAxis, change: f64| axis.at(52.42 + change) - axis.at(52.42);
        assert!(part(&linear(&[52.42, 52.42 + 3e-14, 52.42 - 2e-14]), 3e-14) < 2e-2);
        assert!(part(&linear(&[52.42, 52.42 + 1e-9]), 1e-9) > 0.85);
    }

    /// The number that a text says.
    fn number(text: &str) -> f64 {
        let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|known| known == c);
        let alone = if text.chars().any(|c| digit(c).is_some()) { ("1", text) } else { (text, "10⁰") };
        let (factor, power) = text.split_once('\u{d7}').unwrap_or(alone);
        let size = power.chars().filter_map(digit).fold(0, |sum, digit| 10 * sum + digit as i32);
        let sign = if power.contains('⁻') { -1 } else { 1 };
        factor.parse::<f64>().expect("a number") * libm::pow(10.0, f64::from(sign * size))
    }

    /// Law: an axis has between two and nine ticks, each inside, and their texts are the numbers at which they are, however long the axis is.
    #[test]
    fn ticks_say_where_they_are() {
        for low in [1.3e-13, 3.0e-16, 0.96, 1.0, 7.0e5] {
            for ratio in [1.0 + 1e-3, 1.03, 1.4, 2.0, 4.4, 10.0, 99.0, 1e4, 1e11, 1e200] {
                for axis in [Axis::log("x", ""), Axis::linear("x", "")] {
                    let drawn = DrawnAxis::new(&axis, &[low, low * ratio]);
                    let ticks = drawn.ticks(9);
                    assert!((2..=10).contains(&ticks.len()), "{low} to {}: {ticks:?}", low * ratio);
                    for (place, text) in ticks {
                        assert!((0.0..=1.0).contains(&place), "{low}, {ratio}: {text} at {place}");
                        let value = match axis.scale {
                            Scale::Log => number(&text),
                            _ => drawn.base + number(&text) * libm::pow(10.0, f64::from(drawn.power)),
                        };
                        assert!((drawn.at(value) - place).abs() < 1e-6, "{text} at {place}: {value:e}");
                    }
                }
            }
        }
        let axis = DrawnAxis::new(&Axis::log("x", ""), &[1.3e-13, 4.4e-13]);
        let texts: Vec<String> = axis.ticks(9).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["2\u{d7}10⁻¹³", "3\u{d7}10⁻¹³", "4\u{d7}10⁻¹³"]);
    }

    /// Law: an axis whose step is given has its ticks at multiples, at both ends too; of twice or three times the step where there is room for fewer.
    #[test]
    fn a_given_step_is_kept() {
        let axis = DrawnAxis::new(&Axis::of_globe("longitude", 180.0), &[]);
        for (most, step) in [(13, 30), (12, 30), (11, 60), (6, 60), (4, 90)] {
            let expected: Vec<(f64, String)> =
                (-180..=180).step_by(step).map(|at| ((f64::from(at) + 180.0) / 360.0, at.to_string())).collect();
            let found = axis.ticks(most);
            let same = |((place, text), (known, name)): (&(f64, String), &(f64, String))| {
                text == name && (place - known).abs() < 1e-12
            };
            assert!(found.len() == expected.len() && found.iter().zip(&expected).all(same), "{most}: {found:?}");
        }
    }

    /// Law: without a fixed range all values are inside; a descending axis has the largest first.
    #[test]
    fn values_are_inside() {
        for (axis, values) in [(Axis::linear("y", ""), [0.0, 4000.0]), (Axis::log("y", ""), [1e-9, 3e4])] {
            let drawn = DrawnAxis::new(&axis, &values);
            assert!(values.iter().all(|value| (0.0..=1.0).contains(&drawn.at(*value))));
            let descending = DrawnAxis::new(&Axis { is_descending: true, ..axis }, &values);
            assert!(descending.at(values[0]) > 0.9 && descending.at(values[1]) < 0.1);
        }
        // counter-test: a fixed range that leaves one out
        let drawn = DrawnAxis::new(&Axis::linear("y", "").within(0.0, 1.0), &[0.0, 4000.0]);
        assert!(drawn.at(4000.0) > 1.0);
    }
}
