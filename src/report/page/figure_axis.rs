//! [`FigureAxis`]: an axis of a figure in a file: from values to coordinates, where its ticks are, and what is written at them.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::report::axis::{Axis as Ticks, superscript};
use crate::report::page::figure::{Axis, Scale};

/// Most ticks of an axis.
pub(super) const MOST_TICKS: usize = 9;

/// From values of an axis to coordinates, and back to labels.
pub(super) struct FigureAxis {
    scale: Scale,
    /// The coordinates that are shown.
    pub(super) range: Range<f64>,
    ticks: Ticks,
    /// Quantity and unit.
    pub(super) title: String,
}

impl FigureAxis {
    /// The axis that shows `values`.
    pub(super) fn of(axis: &Axis, values: &[f64]) -> Self {
        let ticks = Ticks::of(axis.range.map_or(values.to_vec(), |range| range.to_vec()).into_iter());
        let title = |unit: &str| match (axis.quantity.as_str(), unit) {
            ("", unit) => unit.to_owned(),
            (quantity, "") => quantity.to_owned(),
            (quantity, unit) => format!("{quantity} / {unit}"),
        };
        match &axis.scale {
            Scale::Linear => {
                let margin = if axis.range.is_some() { 0.0 } else { 0.04 };
                let description = ticks.description(&axis.unit);
                FigureAxis { scale: Scale::Linear, range: ticks.range(margin), title: title(&description), ticks }
            }
            Scale::Log => {
                let values = axis.range.map_or(values.to_vec(), |range| range.to_vec());
                let positive = values.into_iter().filter(|value| *value > 0.0 && value.is_finite()).map(libm::log10);
                let (low, high) =
                    positive.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
                let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
                let margin = (0.04 * (high - low)).max(0.05);
                FigureAxis { scale: Scale::Log, range: low - margin..high + margin, title: title(&axis.unit), ticks }
            }
            Scale::Names(names) => {
                let count = names.len().max(1) as f64;
                FigureAxis { scale: axis.scale.clone(), range: -0.5..count - 0.5, title: String::new(), ticks }
            }
        }
    }

    /// The coordinate of a value; NaN where it has none.
    pub(super) fn at(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.ticks.map(value),
            Scale::Log if value > 0.0 => libm::log10(value),
            Scale::Log => f64::NAN,
            Scale::Names(_) => value,
        }
    }

    /// What is written at a coordinate.
    pub(super) fn label(&self, coordinate: f64) -> String {
        match self.scale {
            Scale::Linear => self.ticks.label(coordinate),
            Scale::Log => {
                let power = libm::round(coordinate);
                if (coordinate - power).abs() < 1e-9 {
                    return format!("10{}", superscript(power as i32));
                }
                let power = libm::floor(coordinate);
                let factor = format!("{:.2}", libm::pow(10.0, coordinate - power));
                let factor = factor.trim_end_matches('0').trim_end_matches('.');
                if power == 0.0 { factor.to_owned() } else { format!("{factor}\u{d7}10{}", superscript(power as i32)) }
            }
            Scale::Names(_) => String::new(),
        }
    }

    /// The coordinates with their ticks.
    pub(super) fn coordinates(&self) -> Ticked {
        Ticked { coordinates: self.range.clone().into(), ticks: self.tick_places() }
    }

    /// Where the ticks are. On a logarithmic axis: decades, no more than [`MOST_TICKS`]; where there are fewer than two, also 2 and 5 times
    /// a decade, and if need be round values.
    fn tick_places(&self) -> Vec<f64> {
        let Range { start, end } = self.range;
        let evenly = |start: f64, end: f64, count: usize| RangedCoordf64::from(start..end).key_points(count);
        match self.scale {
            Scale::Names(_) => (0..=end as usize).map(|place| place as f64).collect(),
            Scale::Linear => evenly(start, end, MOST_TICKS - 2),
            Scale::Log => {
                let (first, last) = (start.ceil() as i32, end.floor() as i32);
                if last > first {
                    let every = ((last - first) as usize).div_ceil(MOST_TICKS - 1);
                    return (first..=last).step_by(every).map(f64::from).collect();
                }
                let logarithms = [1.0, 2.0, 5.0].map(libm::log10);
                let multiples =
                    [first - 1, first].map(f64::from).into_iter().flat_map(|at| logarithms.map(|of| at + of));
                let inside: Vec<f64> = multiples.filter(|place| self.is_inside(*place)).collect();
                if inside.len() > 1 {
                    return inside;
                }
                // in units of the decade, so that no size of numbers matters
                let [low, high] = [start, end].map(|place| libm::pow(10.0, place - f64::from(first - 1)));
                let step = round_step((high - low) / 4.0);
                let multiples = (libm::ceil(low / step) as u32..=libm::floor(high / step) as u32).map(f64::from);
                multiples.map(|multiple| f64::from(first - 1) + libm::log10(multiple * step)).collect()
            }
        }
    }

    /// Whether a coordinate is shown.
    pub(super) fn is_inside(&self, coordinate: f64) -> bool {
        (self.range.start..=self.range.end).contains(&coordinate)
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is no smaller than `step`.
fn round_step(step: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(step)));
    [1.0, 2.0, 5.0].map(|digit| digit * decade).into_iter().find(|round| *round >= step).unwrap_or(10.0 * decade)
}

/// Coordinates with ticks at chosen places.
pub(super) struct Ticked {
    coordinates: RangedCoordf64,
    ticks: Vec<f64>,
}

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.coordinates.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.coordinates.range()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number that a text says.
    fn number(text: &str) -> f64 {
        let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|known| known == c);
        let alone = if text.chars().any(|c| digit(c).is_some()) { ("1", text) } else { (text, "10⁰") };
        let (factor, power) = text.split_once('\u{d7}').unwrap_or(alone);
        let size = power.chars().filter_map(digit).fold(0, |sum, digit| 10 * sum + digit as i32);
        let sign = if power.contains('⁻') { -1 } else { 1 };
        factor.parse::<f64>().expect("a number") * libm::pow(10.0, f64::from(sign * size))
    }

    /// Law: a logarithmic axis has between two and nine ticks, each inside, and their texts are the numbers at which they are, however many
    /// decades it has.
    #[test]
    fn a_logarithmic_axis_has_ticks() {
        for low in [1.3e-13, 3.0e-16, 1.45e-16, 0.96, 1.0, 7.0e5] {
            for ratio in [1.0 + 1e-3, 1.03, 1.4, 2.0, 4.4, 10.0, 99.0, 1e4, 1e11, 1e200] {
                let axis = FigureAxis::of(&Axis::log("x", ""), &[low, low * ratio]);
                let places = axis.tick_places();
                assert!((2..=MOST_TICKS).contains(&places.len()), "{low} to {}: {places:?}", low * ratio);
                assert!(places.iter().all(|place| axis.is_inside(*place)), "{low}, {ratio}: {places:?}");
                for place in places {
                    let (text, value) = (axis.label(place), libm::pow(10.0, place));
                    assert!((number(&text) - value).abs() < 1e-9 * value, "{text} at {value:e}");
                }
            }
        }
        let axis = FigureAxis::of(&Axis::log("x", ""), &[1.3e-13, 4.4e-13]);
        let texts: Vec<String> = axis.tick_places().iter().map(|place| axis.label(*place)).collect();
        assert_eq!(texts, ["2\u{d7}10⁻¹³", "3\u{d7}10⁻¹³", "4\u{d7}10⁻¹³"]);
    }

    /// Law: without a fixed range all values are inside.
    #[test]
    fn values_are_inside() {
        for (axis, values) in [(Axis::linear("y", ""), [0.0, 4000.0]), (Axis::log("y", ""), [1e-9, 3e4])] {
            let axis = FigureAxis::of(&axis, &values);
            assert!(values.iter().all(|value| axis.is_inside(axis.at(*value))));
        }
        // counter-test: a fixed range that leaves one out
        let axis = FigureAxis::of(&Axis::linear("y", "").within(0.0, 1.0), &[0.0, 4000.0]);
        assert!(!axis.is_inside(axis.at(4000.0)));
    }
}
