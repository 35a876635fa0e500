//! [`Figure`]: what a figure of the page shows, without saying how it is drawn.
//!
//! The page draws it interactively (`assets/report/chart.js`), [`super::drawing`] as SVG and PNG. Both take the same numbers, titles and
//! captions from here.

use serde_json::{Value, json};

use super::payload::Payload;

/// The colour of a mark, by what it belongs to: bodies keep theirs everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hue {
    /// The body without the wheels.
    Body,
    /// A wheel, by its index.
    Wheel(usize),
    /// The debris.
    Debris,
    /// All bodies together, or a quantity of no body.
    Total,
    /// The nominal run in front of others.
    Nominal,
    /// Runs that failed.
    Failed,
    /// Limits, and what is there for comparison.
    Reference,
}

impl Hue {
    /// The place in the palette of Okabe & Ito (2008): blue, vermilion, green, purple, sky blue, orange, yellow; 7 is the colour of text,
    /// 8 a grey.
    pub const fn place(self) -> usize {
        match self {
            Hue::Body => 0,
            Hue::Wheel(index) => [1, 2, 3, 4][index % 4],
            Hue::Debris => 5,
            Hue::Total => 0,
            Hue::Nominal => 7,
            Hue::Failed => 1,
            Hue::Reference => 8,
        }
    }
}

/// How values are laid out along an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// Proportional.
    Linear,
    /// By decades; values that are not positive are not shown.
    Log,
    /// One place for each name, the first on top.
    Names(Vec<String>),
}

/// An axis: quantity, unit, scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows.
    pub quantity: String,
    /// Its unit; empty where it has none.
    pub unit: String,
    /// How values are laid out.
    pub scale: Scale,
    /// The range, where it does not follow from the marks.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(quantity: impl Into<String>, unit: &str) -> Self {
        Axis { quantity: quantity.into(), unit: unit.to_owned(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis.
    pub fn log(quantity: impl Into<String>, unit: &str) -> Self {
        Axis { scale: Scale::Log, ..Axis::linear(quantity, unit) }
    }

    /// An axis of names.
    pub fn names(names: Vec<String>) -> Self {
        Axis { scale: Scale::Names(names), ..Axis::linear("", "") }
    }

    /// The same with a fixed range.
    ///
    /// # Panics
    /// Where it is empty.
    #[must_use]
    pub fn within(self, low: f64, high: f64) -> Self {
        assert!(low < high, "the range {low} to {high} of {}", self.quantity);
        Axis { range: Some([low, high]), ..self }
    }

    fn json(&self) -> Value {
        let names = if let Scale::Names(names) = &self.scale { Some(names) } else { None };
        let log = self.scale == Scale::Log;
        json!({ "quantity": self.quantity, "unit": self.unit, "log": log, "names": names, "range": self.range })
    }
}

/// What is drawn on a pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A curve.
    Line {
        /// Name in the legend.
        label: String,
        /// Colour.
        hue: Hue,
        /// Whether it is dashed.
        dashed: bool,
        /// Abscissae, ascending.
        x: Vec<f64>,
        /// Ordinates.
        y: Vec<f64>,
    },
    /// The area between two curves.
    Band {
        /// Name in the legend.
        label: String,
        /// Colour.
        hue: Hue,
        /// Opacity.
        opacity: f64,
        /// Abscissae, ascending.
        x: Vec<f64>,
        /// Lower curve.
        low: Vec<f64>,
        /// Upper curve.
        high: Vec<f64>,
        /// Whether it is one of several on top of each other: its height is its value.
        stacked: bool,
    },
    /// Points.
    Points {
        /// Name in the legend.
        label: String,
        /// Colour.
        hue: Hue,
        /// Whether they are crosses (of runs that failed, of what is marked); otherwise discs.
        crosses: bool,
        /// Abscissae.
        x: Vec<f64>,
        /// Ordinates.
        y: Vec<f64>,
        /// The samples that they show; empty where they show none.
        samples: Vec<f64>,
    },
    /// Bars between neighbouring edges.
    Bars {
        /// Name in the legend.
        label: String,
        /// Colour.
        hue: Hue,
        /// Edges, ascending; one more than heights.
        edges: Vec<f64>,
        /// Heights.
        heights: Vec<f64>,
    },
    /// Values with intervals, one for each name of the vertical axis; NaN where there is none.
    Whiskers {
        /// Name in the legend.
        label: String,
        /// Colour.
        hue: Hue,
        /// Values.
        x: Vec<f64>,
        /// Lower ends.
        low: Vec<f64>,
        /// Upper ends.
        high: Vec<f64>,
    },
    /// A straight line across the figure.
    Limit {
        /// What it is.
        label: String,
        /// Where it is.
        at: f64,
        /// Whether it is vertical.
        vertical: bool,
    },
    /// A square matrix of correlations between -1 and 1, row by row, names on the vertical axis.
    Matrix {
        /// Entries, row by row.
        values: Vec<f64>,
    },
}

impl Mark {
    fn json(&self, payload: &mut Payload) -> Value {
        let mut array = |values: &[f64]| payload.array(values);
        match self {
            Mark::Line { label, hue, dashed, x, y } => json!({
                "kind": "line", "label": label, "hue": hue.place(), "dashed": dashed, "x": array(x), "y": array(y)
            }),
            Mark::Band { label, hue, opacity, x, low, high, stacked } => json!({
                "kind": "band", "label": label, "hue": hue.place(), "opacity": opacity, "stacked": stacked,
                "x": array(x), "low": array(low), "high": array(high)
            }),
            Mark::Points { label, hue, crosses, x, y, samples } => json!({
                "kind": "points", "label": label, "hue": hue.place(), "crosses": crosses,
                "x": array(x), "y": array(y), "samples": array(samples)
            }),
            Mark::Bars { label, hue, edges, heights } => json!({
                "kind": "bars", "label": label, "hue": hue.place(), "edges": array(edges), "heights": array(heights)
            }),
            Mark::Whiskers { label, hue, x, low, high } => json!({
                "kind": "whiskers", "label": label, "hue": hue.place(), "x": array(x), "low": array(low), "high": array(high)
            }),
            Mark::Limit { label, at, vertical } => {
                json!({ "kind": "limit", "label": label, "at": at, "vertical": vertical })
            }
            Mark::Matrix { values } => {
                json!({ "kind": "matrix", "label": "correlation", "hue": 0, "values": array(values) })
            }
        }
    }

    /// The largest magnitude of its ordinates.
    pub fn largest(&self) -> f64 {
        let of = |values: &[f64]| {
            values.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        match self {
            Mark::Line { y, .. } | Mark::Points { y, .. } => of(y),
            Mark::Band { low, high, .. } => of(low).max(of(high)),
            Mark::Bars { heights, .. } => of(heights),
            Mark::Whiskers { .. } | Mark::Limit { .. } | Mark::Matrix { .. } => 0.0,
        }
    }

    /// Whether there is anything to see.
    fn is_visible(&self) -> bool {
        let any = |values: &[f64]| values.iter().any(|value| value.is_finite());
        match self {
            Mark::Line { y, .. } | Mark::Points { y, .. } => any(y),
            Mark::Band { low, high, .. } => any(low) && any(high),
            Mark::Bars { heights, .. } => heights.iter().any(|height| *height > 0.0),
            Mark::Whiskers { x, .. } => any(x),
            Mark::Limit { .. } => false,
            Mark::Matrix { values } => any(values),
        }
    }
}

/// The sections of the page that have figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// What happened over time.
    Time,
    /// Numerical errors and work.
    Numerics,
    /// What drives the outcome.
    Influence,
    /// What was asked for and applied.
    Inputs,
    /// Statistics of the outcome.
    Statistics,
}

impl Section {
    /// The anchor of the section.
    pub const fn anchor(self) -> &'static str {
        match self {
            Section::Time => "time",
            Section::Numerics => "numerics",
            Section::Influence => "influence",
            Section::Inputs => "inputs",
            Section::Statistics => "statistics",
        }
    }
}

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its anchor in the page and its name as a file.
    pub name: String,
    /// Where it is.
    pub section: Section,
    /// What it shows.
    pub title: String,
    /// What bands, marks and N mean.
    pub caption: String,
    /// Width in columns of twelve.
    pub columns: u8,
    /// Whether the abscissa is the time of a run, so that the replay moves a cursor in it.
    pub is_over_time: bool,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, from back to front.
    pub marks: Vec<Mark>,
}

impl Figure {
    /// Whether it shows anything; a figure that does not is left out of the page.
    pub fn is_visible(&self) -> bool {
        self.marks.iter().any(Mark::is_visible)
    }

    /// What the page needs to draw it; numbers go to `payload`.
    pub fn json(&self, payload: &mut Payload) -> Value {
        let marks: Vec<Value> = self.marks.iter().map(|mark| mark.json(payload)).collect();
        json!({
            "name": self.name, "section": self.section.anchor(), "title": self.title, "caption": self.caption,
            "columns": self.columns, "time": self.is_over_time, "x": self.x.json(), "y": self.y.json(), "marks": marks
        })
    }
}
