//! [`Figure`]: the content of a figure. `assets/report/chart.js` draws it, on the page ([`super::page`]) and in files
//! ([`super::figure_files`]).

use crate::campaign::{Display, ShownUnit};
use crate::findings::number::short;

/// The meaning of a colour; bodies keep theirs in all figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hue {
    /// The body without the wheels.
    Body,
    Wheel(usize),
    Debris,
    /// All bodies, or none.
    Total,
    /// The nominal run among others.
    Nominal,
    /// Failed by the figure's criterion; only the first wheel shares this hue.
    Failed,
    /// One of many curves of a panel, by its index.
    Curve(usize),
    /// Limits and other references.
    Reference,
}

impl Hue {
    /// Index in the palette of Okabe & Ito (2008): blue, vermilion, green, purple, sky blue, orange, yellow; 7: text
    /// colour, 8: grey, from 9: four more for wheels.
    pub const fn place(self) -> usize {
        match self {
            Hue::Body | Hue::Total => 0,
            Hue::Wheel(index) => [1, 2, 3, 4, 9, 10, 11, 12][index % 8],
            Hue::Debris => 5,
            Hue::Nominal => 7,
            Hue::Failed => 1,
            Hue::Curve(index) => [0, 1, 2, 3, 4, 7][index % 6],
            Hue::Reference => 8,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    Solid,
    Dashed,
    Dotted,
    Long,
}

impl Dash {
    /// Lengths of dash and gap, pixels.
    pub const fn lengths(self) -> Option<[u32; 2]> {
        match self {
            Dash::Solid => None,
            Dash::Dashed => Some([6, 4]),
            Dash::Dotted => Some([3, 3]),
            Dash::Long => Some([14, 4]),
        }
    }

    /// For curve `index` of a panel: two dozen curves differ in colour or dash.
    pub const fn of_curve(index: usize) -> Self {
        [Dash::Solid, Dash::Dashed, Dash::Dotted, Dash::Long][(index + index / 12) % 4]
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointShape {
    Disc,
    /// Failed or highlighted runs.
    Cross,
    /// Discs on a line from zero: probabilities.
    Stem,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub enum Scale {
    #[default]
    Linear,
    /// Omits values that are not positive.
    Log,
    /// One row per name, the first on top.
    Names(Vec<String>),
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    pub quantity: String,
    /// Empty for a pure number.
    pub unit: String,
    pub scale: Scale,
    /// Overrides the range of the marks.
    pub range: Option<[f64; 2]>,
    /// Overrides the tick spacing; only a multiple may fit.
    pub step: Option<f64>,
    /// The column or parameter shown; empty for none or several.
    pub column: String,
}

impl Axis {
    pub fn linear(quantity: impl Into<String>, unit: &str) -> Self {
        Axis { quantity: quantity.into(), unit: unit.to_owned(), ..Axis::default() }
    }

    pub fn log(quantity: impl Into<String>, unit: &str) -> Self {
        Axis { scale: Scale::Log, ..Axis::linear(quantity, unit) }
    }

    pub fn names(names: Vec<String>) -> Self {
        Axis { scale: Scale::Names(names), ..Axis::linear("", "") }
    }

    /// An angle on the Earth from -`most` to `most` degrees, with ticks every 30.
    pub fn of_globe(quantity: &str, most: f64) -> Self {
        Axis { step: Some(30.0), ..Axis::linear(quantity, "deg").within(-most, most) }
    }

    #[must_use]
    pub fn showing(self, column: impl Into<String>) -> Self {
        Axis { column: column.into(), ..self }
    }

    fn take_unit(&mut self, display: &Display) -> ShownUnit {
        let shown = display.of(&self.column, &self.unit);
        self.unit.clone_from(&shown.unit);
        self.range = self.range.map(|ends| ends.map(|end| shown.value(end)));
        shown
    }

    /// Sets the range.
    ///
    /// # Panics If it is empty.
    #[must_use]
    pub fn within(self, low: f64, high: f64) -> Self {
        assert!(low < high, "the range {low} to {high} of {}", self.quantity);
        Axis { range: Some([low, high]), ..self }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    Line {
        label: String,
        hue: Hue,
        dash: Dash,
        x: Vec<f64>,
        y: Vec<f64>,
    },
    Band {
        label: String,
        hue: Hue,
        opacity: f64,
        x: Vec<f64>,
        low: Vec<f64>,
        high: Vec<f64>,
        /// Stacked on others, so that its height is its value.
        stacked: bool,
    },
    Points {
        label: String,
        hue: Hue,
        shape: PointShape,
        x: Vec<f64>,
        y: Vec<f64>,
        /// Sample of each point; may be empty.
        samples: Vec<f64>,
    },
    Bars {
        label: String,
        hue: Hue,
        /// Ascending, one more than heights.
        edges: Vec<f64>,
        heights: Vec<f64>,
    },
    /// Values with intervals, one per name of the vertical axis; NaN if unknown.
    Whiskers {
        label: String,
        hue: Hue,
        x: Vec<f64>,
        low: Vec<f64>,
        high: Vec<f64>,
    },
    Limit {
        label: String,
        at: f64,
        vertical: bool,
    },
    /// Number of runs still in flight: a strip under the horizontal axis.
    Flight {
        label: String,
        x: Vec<f64>,
        counts: Vec<f64>,
        runs: f64,
    },
    /// A square matrix of correlations, names on the vertical axis.
    Matrix {
        values: Vec<f64>,
    },
}

impl Mark {
    /// Maps abscissae by `x` and ordinates by `y`.
    fn change(&mut self, x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64) {
        let change =
            |values: &mut Vec<f64>, by: &dyn Fn(f64) -> f64| values.iter_mut().for_each(|value| *value = by(*value));
        match self {
            Mark::Line { x: xs, y: ys, .. } | Mark::Points { x: xs, y: ys, .. } => {
                change(xs, x);
                change(ys, y);
            }
            Mark::Band { x: xs, low, high, .. } => {
                change(xs, x);
                change(low, y);
                change(high, y);
            }
            Mark::Bars { edges, heights, .. } => {
                change(edges, x);
                change(heights, y);
            }
            Mark::Whiskers { x: xs, low, high, .. } => [xs, low, high].into_iter().for_each(|values| change(values, x)),
            Mark::Limit { at, vertical, .. } => *at = if *vertical { x(*at) } else { y(*at) },
            Mark::Flight { x: xs, .. } => change(xs, x),
            Mark::Matrix { .. } => {}
        }
    }

    pub fn line(label: impl Into<String>, hue: Hue, dash: Dash, x: Vec<f64>, y: Vec<f64>) -> Self {
        Mark::Line { label: label.into(), hue, dash, x, y }
    }

    /// The area between the curves `ends`.
    pub fn area(label: impl Into<String>, (hue, opacity): (Hue, f64), x: Vec<f64>, ends: [Vec<f64>; 2]) -> Self {
        let [low, high] = ends;
        Mark::Band { label: label.into(), hue, opacity, x, low, high, stacked: false }
    }

    pub fn points(label: impl Into<String>, (hue, shape): (Hue, PointShape), x: Vec<f64>, y: Vec<f64>) -> Self {
        Mark::Points { label: label.into(), hue, shape, x, y, samples: Vec::new() }
    }

    /// Label in the legend; empty if it has none.
    pub fn legend(&self) -> &str {
        match self {
            Mark::Line { label, .. }
            | Mark::Points { label, .. }
            | Mark::Band { label, .. }
            | Mark::Bars { label, .. }
            | Mark::Flight { label, .. }
            | Mark::Whiskers { label, .. } => label,
            Mark::Matrix { .. } => "rank correlation, -1 to 1",
            Mark::Limit { .. } => "",
        }
    }

    fn ordinates(&self) -> Vec<&[f64]> {
        match self {
            Mark::Line { y, .. } | Mark::Points { y, .. } => vec![y],
            Mark::Band { low, high, .. } => vec![low, high],
            Mark::Bars { heights, .. } => vec![heights],
            Mark::Whiskers { .. } | Mark::Limit { .. } | Mark::Flight { .. } | Mark::Matrix { .. } => Vec::new(),
        }
    }

    /// Largest magnitude of the ordinates.
    pub fn largest(&self) -> f64 {
        let all = self.ordinates().into_iter().flatten().filter(|value| value.is_finite());
        all.fold(0.0, |most: f64, value| most.max(value.abs()))
    }

    fn is_visible(&self) -> bool {
        let any = |values: &[f64]| values.iter().any(|value| value.is_finite());
        match self {
            Mark::Bars { heights, .. } => heights.iter().any(|height| *height > 0.0),
            Mark::Whiskers { x: values, .. } | Mark::Matrix { values } => any(values),
            _ => !self.ordinates().is_empty() && self.ordinates().into_iter().all(any),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureSection {
    Outcome,
    Time,
    Numerics,
    Influence,
    /// Requested and applied distributions.
    Inputs,
    Statistics,
}

impl FigureSection {
    pub const fn anchor(self) -> &'static str {
        match self {
            FigureSection::Outcome => "outcome",
            FigureSection::Time => "time",
            FigureSection::Numerics => "numerics",
            FigureSection::Influence => "influence",
            FigureSection::Inputs => "inputs",
            FigureSection::Statistics => "statistics",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Anchor in the page and file name.
    pub name: String,
    pub section: FigureSection,
    pub title: String,
    /// Explains bands, marks and N.
    pub caption: String,
    /// Width in columns of twelve.
    pub columns: u8,
    /// True if the abscissa is the time of a run: the replay moves a cursor there.
    pub is_over_time: bool,
    pub x: Axis,
    pub y: Axis,
    /// From back to front.
    pub marks: Vec<Mark>,
}

impl Figure {
    #[must_use]
    pub fn in_units(mut self, display: &Display) -> Self {
        let [x, y] = [self.x.take_unit(display), self.y.take_unit(display)];
        if !(x.is_own() && y.is_own()) {
            for mark in &mut self.marks {
                // update a value within the label
                if let Mark::Limit { label, at, vertical: true } = mark
                    && let Some(name) = label.strip_suffix(&short(*at))
                {
                    *label = format!("{name}{}", short(x.value(*at)));
                }
                mark.change(&|value| x.value(value), &|value| y.value(value));
            }
        }
        self
    }

    /// A figure of half the page's width, without name and caption.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, marks: Vec<Mark>) -> Self {
        Figure::of(FigureSection::Time, [String::new(), title.into(), String::new()], [x, y], marks)
    }

    /// A figure of half the page's width with name, title and caption.
    pub fn of<T: Into<String>>(section: FigureSection, said: [T; 3], [x, y]: [Axis; 2], marks: Vec<Mark>) -> Self {
        let [name, title, caption] = said.map(Into::into);
        Figure { name, section, title, caption, columns: 6, is_over_time: false, x, y, marks }
    }

    #[must_use]
    pub fn wide(self, columns: u8) -> Self {
        Figure { columns, ..self }
    }

    /// True if any mark shows; pages omit other figures.
    pub fn is_visible(&self) -> bool {
        self.marks.iter().any(Mark::is_visible)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::shipped::plan_of;

    /// Law: a change of unit converts values, range and a value within a label, and leaves the other axis.
    #[test]
    fn a_figure_changes_as_a_whole() {
        let display = plan_of(include_str!("../../../../assets/start.toml"), &[]).analysis.display;
        let half = core::f64::consts::FRAC_PI_2;
        let limit = |label: String, vertical| Mark::Limit { label, at: half, vertical };
        let marks = vec![
            Mark::Bars { label: "runs".to_owned(), hue: Hue::Total, edges: vec![0.0, half], heights: vec![7.0] },
            limit(format!("nominal {}", short(half)), true),
            limit("at most 90\u{a0}deg".to_owned(), true),
            limit(short(half), false),
        ];
        let x = Axis::linear("angle", "rad").within(0.0, 2.0 * half);
        let figure = Figure::new("", x, Axis::linear("runs", ""), marks).in_units(&display);
        assert_eq!((figure.x.unit.as_str(), figure.x.range), ("deg", Some([0.0, 180.0])));
        let Mark::Bars { edges, heights, .. } = &figure.marks[0] else { panic!("{figure:?}") };
        assert_eq!((&edges[..], &heights[..]), (&[0.0, 90.0][..], &[7.0][..]));
        let names = [1, 2, 3].map(|k| match &figure.marks[k] {
            Mark::Limit { label, at, .. } => (label.clone(), *at),
            mark => panic!("{mark:?}"),
        });
        let expected = [("nominal 90".to_owned(), 90.0), ("at most 90\u{a0}deg".to_owned(), 90.0), (short(half), half)];
        assert_eq!(names, expected);
    }
}
