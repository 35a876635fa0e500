//! [`Histogram`]: bars of one column of drawn samples, with its nominal value and what is expected of the distribution that was asked for.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{COLORS, PlotError, drawing};
use crate::report::expected_counts::Asked;
use crate::report::fitted_text::fitted_to_pixels;
use crate::report::number::short;

/// Bars of a histogram.
const BARS: usize = 40;
/// A nominal value farther from all samples than this fraction of their span is named at the edge: the samples keep two thirds of the axis.
const FAR: f64 = 0.5;
/// A label of a tick is off by less than this fraction of the axis.
const LEGIBLE: f64 = 0.02;
/// Half of the gap between the axes of neighbouring histograms, pixels.
const MARGIN: u32 = 28;
/// Sizes of labels and of the name, pixels.
const LABEL: u32 = 12;
const NAME: u32 = 13;
/// Where the curve and the bars end, as a fraction of their height; the name of a far nominal value is above.
const HEADROOM: f64 = 1.05;
const HEADROOM_WITH_NAME: f64 = 1.25;

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// The histogram of one column.
#[derive(Clone, Debug)]
pub(super) struct Histogram<'a> {
    /// Its name.
    pub name: &'a str,
    /// The samples; those that are not finite are left out.
    pub values: &'a [f64],
    /// The nominal value.
    pub nominal: f64,
    /// The distribution that was asked for.
    pub asked: Option<&'a Asked<'a>>,
}

/// Style of the samples.
pub(super) fn of_samples() -> ShapeStyle {
    COLORS[0].mix(0.75).filled()
}

/// Style of what is expected.
pub(super) fn of_expected(scale: u32) -> ShapeStyle {
    COLORS[1].stroke_width(2 * scale)
}

/// Style of the nominal value.
pub(super) fn of_nominal(scale: u32) -> ShapeStyle {
    BLACK.stroke_width(scale)
}

/// Dash and gap of the line at the nominal value at scale 1, pixels.
pub(super) const NOMINAL_DASH: (u32, u32) = (5, 3);
/// Radius of the head of a probability at scale 1, pixels.
pub(super) const HEAD: u32 = 3;

/// The axis of a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Horizontal {
    low: f64,
    high: f64,
}

impl Horizontal {
    /// From `low` to `high`; a single value, or none, is shown in the middle.
    fn new(low: f64, high: f64) -> Self {
        if high > low {
            return Horizontal { low, high };
        }
        let (middle, half) = if low.is_finite() { (low, 0.05 * low.abs().max(1e-3)) } else { (0.0, 1.0) };
        Horizontal { low: middle - half, high: middle + half }
    }

    /// Half of its width, which is finite where the width is not.
    fn half(&self) -> f64 {
        0.5 * self.high - 0.5 * self.low
    }

    /// Position of a value on the axis: 0 and 1 at its ends.
    fn part(&self, value: f64) -> f64 {
        (0.5 * value - 0.5 * self.low) / self.half()
    }

    fn value(&self, part: f64) -> f64 {
        (1.0 - part) * self.low + part * self.high
    }

    fn bar(&self, value: f64) -> usize {
        ((self.part(value) * BARS as f64) as usize).min(BARS - 1)
    }

    /// The labels of these ticks: short numbers where those say their positions on the axis, else as many digits as that takes.
    fn labels(&self, parts: [f64; 3]) -> [String; 3] {
        let is_legible = |value: f64, text: &str| {
            text.parse::<f64>().is_ok_and(|shown| (shown - value).abs() <= 2.0 * LEGIBLE * self.half())
        };
        let values = parts.map(|part| self.value(part));
        if values.iter().all(|value| is_legible(*value, &short(*value))) {
            return values.map(short);
        }
        values.map(|value| {
            let mut texts = (4..17).map(|digits| digits_of(value, digits));
            texts.find(|text| is_legible(value, text)).unwrap_or_else(|| digits_of(value, 17))
        })
    }
}

/// A number with so many significant digits, without zeros at its end.
fn digits_of(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits - 1);
    match text.parse::<f64>() {
        Ok(rounded) if rounded == 0.0 || (1e-4..1e12).contains(&rounded.abs()) => format!("{rounded}"),
        Ok(rounded) => format!("{rounded:e}"),
        Err(_) => text,
    }
}

impl Histogram<'_> {
    fn finite(&self) -> impl Iterator<Item = f64> + Clone {
        self.values.iter().copied().filter(|value| value.is_finite())
    }

    /// The axis, and whether the nominal value is on it. The axis contains the samples, and each value of a discrete distribution that one
    /// sample or more is expected to have.
    fn horizontal(&self) -> (Horizontal, bool) {
        let count = self.finite().count() as f64;
        let discrete = self.asked.and_then(|asked| asked.values()).unwrap_or_default();
        let frequent =
            discrete.into_iter().filter(|(_, probability)| count * probability >= 1.0).map(|(value, _)| value);
        let (low, high) = self
            .finite()
            .chain(frequent)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let nominal = self.nominal;
        if !nominal.is_finite() {
            return (Horizontal::new(low, high), false);
        }
        let reach = if high > low { FAR * (high - low) } else { f64::INFINITY };
        let is_on_axis = !(low - nominal > reach || nominal - high > reach);
        let (low, high) = if is_on_axis { (low.min(nominal), high.max(nominal)) } else { (low, high) };
        (Horizontal::new(low, high), is_on_axis)
    }

    /// The probabilities of a discrete distribution as samples that are expected: one stem for each bar that contains a value, at this value, or
    /// at the mean of those that share the bar.
    fn stems(&self, horizontal: &Horizontal) -> Option<Vec<(f64, f64)>> {
        let values = self.asked?.values()?;
        let count = self.finite().count() as f64;
        let mut bars = vec![(0.0, 0.0); BARS];
        for (value, probability) in values {
            let part = horizontal.part(value);
            if (horizontal.low..=horizontal.high).contains(&value) {
                let (sum, expected) = &mut bars[horizontal.bar(value)];
                *sum += count * probability * part;
                *expected += count * probability;
            }
        }
        Some(
            bars.into_iter()
                .filter(|(_, expected)| *expected > 0.0)
                .map(|(sum, expected)| (sum / expected, expected))
                .collect(),
        )
    }

    /// The numbers that are expected in the bars of a continuous distribution, at their middles.
    fn curve(&self, horizontal: &Horizontal) -> Vec<(f64, f64)> {
        let Some(asked) = self.asked.filter(|asked| asked.values().is_none()) else { return Vec::new() };
        let edges: Vec<f64> = (0..=BARS).map(|k| horizontal.value(k as f64 / BARS as f64)).collect();
        let expected = asked.expected(&edges, self.finite().count());
        expected.into_iter().enumerate().map(|(k, count)| ((k as f64 + 0.5) / BARS as f64, count)).collect()
    }

    /// Draws it on `area`: bars between minimum and maximum, what is expected, the nominal value.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let (horizontal, is_on_axis) = self.horizontal();
        let mut counts = [0u32; BARS];
        self.finite().for_each(|x| counts[horizontal.bar(x)] += 1);
        let (curve, stems) = (self.curve(&horizontal), self.stems(&horizontal).unwrap_or_default());
        let most = counts.iter().map(|count| f64::from(*count)).chain(curve.iter().chain(&stems).map(|point| point.1));
        let most = most.fold(1.0, f64::max);
        let is_named = !is_on_axis && self.nominal.is_finite();
        let top = if is_named { HEADROOM_WITH_NAME } else { HEADROOM } * most;
        let name = fitted_to_pixels(self.name, area.dim_in_pixel().0 / scale - MARGIN, NAME)?;
        let mut chart = ChartBuilder::on(area)
            .caption(name, ("sans-serif", NAME * scale))
            .margin(6 * scale)
            .margin_left(MARGIN * scale)
            .margin_right(MARGIN * scale)
            .x_label_area_size(24 * scale)
            .build_cartesian_2d(0.0..1.0, 0.0..top)
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .disable_y_axis()
            .x_labels(3)
            .x_label_formatter(&|_| String::new())
            .draw()
            .map_err(drawing)?;
        let bars = counts.iter().enumerate().map(|(k, count)| {
            let edge = |k: usize| k as f64 / BARS as f64;
            Rectangle::new([(edge(k), 0.0), (edge(k + 1), f64::from(*count))], of_samples())
        });
        chart.draw_series(bars).map_err(drawing)?;
        chart.draw_series(LineSeries::new(curve, of_expected(scale))).map_err(drawing)?;
        for (part, expected) in stems {
            let line = PathElement::new(vec![(part, 0.0), (part, expected)], of_expected(scale));
            chart.draw_series([line]).map_err(drawing)?;
            let head = Circle::new((part, expected), HEAD * scale, COLORS[1].filled());
            chart.draw_series([head]).map_err(drawing)?;
        }
        if is_named {
            self.name_nominal(&chart, &horizontal, HEADROOM * most, scale)?;
        } else if is_on_axis {
            let at = horizontal.part(self.nominal);
            let line = [(at, 0.0), (at, top)];
            let (dash, gap) = NOMINAL_DASH;
            chart
                .draw_series(DashedLineSeries::new(line, dash * scale, gap * scale, of_nominal(scale)))
                .map_err(drawing)?;
        }
        ticks(&chart, area, &horizontal, scale)
    }

    /// Names a nominal value that is not on the axis, with an arrow at the edge beyond which it is.
    fn name_nominal<B: DrawingBackend>(
        &self,
        chart: &Chart<'_, B>,
        horizontal: &Horizontal,
        above: f64,
        scale: u32,
    ) -> Result<(), PlotError> {
        let is_left = self.nominal < horizontal.low;
        let (edge, inward, side, align) =
            if is_left { (0.0, 1, "left", HPos::Left) } else { (1.0, -1, "right", HPos::Right) };
        let (unit, up) = (inward * scale as i32, 8 * scale as i32);
        let at = |x: i32, y: i32| (x * unit, y * scale as i32 - up);
        let style = of_nominal(scale);
        let arrow = EmptyElement::at((edge, above))
            + PathElement::new(vec![at(-8, 0), at(8, 0)], style)
            + PathElement::new(vec![at(-4, -3), at(-8, 0), at(-4, 3)], style);
        let plotting = chart.plotting_area();
        plotting.draw(&arrow).map_err(drawing)?;
        let font = ("sans-serif", LABEL * scale).into_font().color(&BLACK).pos(Pos::new(align, VPos::Center));
        let text = format!("nominal {}: {side} of this", short(self.nominal));
        let text = EmptyElement::at((edge, above)) + Text::new(text, at(12, 0), font);
        plotting.draw(&text).map_err(drawing)
    }
}

/// Labels at both ends of the axis and in the middle. A label at an end is shifted where it would leave the histogram's area; that in the middle
/// is left out where it would meet another.
fn ticks<B: DrawingBackend>(
    chart: &Chart<'_, B>,
    area: &DrawingArea<B, Shift>,
    horizontal: &Horizontal,
    scale: u32,
) -> Result<(), PlotError> {
    let style = ("sans-serif", LABEL * scale).into_font().color(&BLACK);
    let plotting = chart.plotting_area();
    let length = plotting.dim_in_pixel().0 as i32;
    let (margin, gap) = (((MARGIN - 2) * scale) as i32, (6 * scale) as i32);
    let mut free = -margin..length + margin;
    let parts = [0.0, 1.0, 0.5];
    for (part, text) in parts.into_iter().zip(horizontal.labels(parts)) {
        let width = area.estimate_text_size(&text, &style).map_err(drawing)?.0 as i32;
        let at = (part * f64::from(length)) as i32;
        let left = at - width / 2;
        let left = if part == 0.5 { left } else { left.min(length + margin - width).max(-margin) };
        if part == 0.5 && !(free.contains(&left) && free.contains(&(left + width))) {
            continue;
        }
        if part == 0.0 {
            free.start = left + width + gap;
        } else if part == 1.0 {
            free.end = left - gap;
        }
        let text = EmptyElement::at((part, 0.0)) + Text::new(text, (left - at, (8 * scale) as i32), style.clone());
        plotting.draw(&text).map_err(drawing)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Distribution;
    use crate::sampling::distribution::choice::ChoiceQuantile;

    fn histogram<'a>(values: &'a [f64], nominal: f64, asked: Option<&'a Asked<'a>>) -> Histogram<'a> {
        Histogram { name: "x", values, nominal, asked }
    }

    /// Law: the axis is that of the samples where the nominal value is far from them, and contains it where it is near.
    #[test]
    fn a_far_nominal_value_does_not_widen_the_axis() {
        let values: Vec<f64> = (0..=200).map(|k| 999_999.0 + 0.01 * f64::from(k)).collect();
        for (nominal, expected) in [(0.0, false), (1e9, false), (1_000_000.5, true), (999_998.5, true)] {
            let (axis, is_on_axis) = histogram(&values, nominal, None).horizontal();
            assert_eq!(is_on_axis, expected, "{nominal}");
            let filled: std::collections::BTreeSet<usize> = values.iter().map(|value| axis.bar(*value)).collect();
            assert!(filled.len() >= 2 * BARS / 3, "{nominal}: {} bars", filled.len());
        }
        // one value only: the nominal value is shown however far it is
        assert!(histogram(&[5.0], 0.0, None).horizontal().1);
        assert_eq!(histogram(&[], f64::NAN, None).horizontal(), (Horizontal { low: -1.0, high: 1.0 }, false));
    }

    /// Law: labels say where their ticks are, also of a narrow axis far from zero.
    #[test]
    fn labels_are_legible() {
        let labels = |low, high| Horizontal::new(low, high).labels([0.0, 0.5, 1.0]);
        assert_eq!(labels(999_999.0, 1_000_001.0), ["999999", "1000000", "1000001"]);
        assert_eq!(labels(0.0, 179.99), ["0", "90.00", "180.0"]);
        assert_eq!(labels(1e-9, 3e-9), ["1.000e-9", "2.000e-9", "3.000e-9"]);
        let narrow = labels(7.0, 7.0 + 1e-12);
        assert!(narrow[0] != narrow[1] && narrow[1] != narrow[2], "{narrow:?}");
    }

    /// Law: each value of a discrete distribution has a stem of the height that is expected, and values that share a bar one of their sum.
    #[test]
    fn every_value_has_its_probability() {
        let drawn: Vec<f64> = (0..300).map(|k| [0.01, 0.02, 0.05][k % 3]).collect();
        let choice = Distribution::Choice(ChoiceQuantile::new(&[0.01, 0.02, 0.05], &[1.0; 3]));
        let asked = Asked::Number(&choice);
        let of_drawn = histogram(&drawn, 0.01, Some(&asked));
        let (axis, _) = of_drawn.horizontal();
        let stems = of_drawn.stems(&axis).unwrap();
        let known = [(0.0, 100.0), (0.25, 100.0), (1.0, 100.0)];
        let is_near = |((x, y), (a, b)): (&(f64, f64), &(f64, f64))| (x - a).abs() < 1e-12 && (y - b).abs() < 1e-9;
        assert!(stems.len() == 3 && stems.iter().zip(&known).all(is_near), "{stems:?}");
        assert!(of_drawn.curve(&axis).is_empty());
        let close = Distribution::Choice(ChoiceQuantile::new(&[0.01, 0.0101, 0.05], &[1.0; 3]));
        let stems = histogram(&drawn, 0.01, Some(&Asked::Number(&close))).stems(&axis).unwrap();
        assert!(stems.len() == 2 && (stems[0].1 - 200.0).abs() < 1e-9, "{stems:?}");
        // a value that was not drawn although samples are expected there is on the axis
        let wide = Distribution::Choice(ChoiceQuantile::new(&[0.01, 0.02, 9.0], &[1.0; 3]));
        let (axis, _) = histogram(&drawn, 0.01, Some(&Asked::Number(&wide))).horizontal();
        assert_eq!(axis, Horizontal { low: 0.01, high: 9.0 });
    }
}
