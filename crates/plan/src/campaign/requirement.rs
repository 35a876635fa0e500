//! [`Requirement`]: a `[[require]]` table.

use super::numbers::{CONFIDENCE, PROBABILITY};
use super::section::Section;
use super::units;
use crate::observables::window::Window;
use crate::run::{points_before, points_to};
use crate::sampling::keys::{Condition, Kind, ListLimit, Presence, Row, Rule};
use crate::statistics::gate::GateLimit;

/// The statistic that the limit bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    Quantile(f64),
    Fraction(f64),
    Mean,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    Observable(String),
    /// A quantity at each point of its bands in an interval, point by point.
    Band(BandSubject),
    /// The extreme of a quantity in an interval of each run.
    AtAllTimes {
        band: BandSubject,
        window: Window,
        column: String,
    },
}

/// A quantity over time in an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct BandSubject {
    /// Its name in `bands.parquet`.
    pub series: String,
    /// Start, s; `None` for the start of the run.
    pub from_s: Option<f64>,
    /// End, s; `None` for the end of the run.
    pub to_s: Option<f64>,
}

impl BandSubject {
    /// True if the interval contains `time`, s.
    pub fn contains(&self, time: f64) -> bool {
        self.from_s.is_none_or(|from| points_before(&[time], from) == 0)
            && self.to_s.is_none_or(|to| points_to(&[time], to) == 1)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    pub subject: Subject,
    pub statement: Statement,
    /// In the unit of the subject.
    pub limit: GateLimit,
    /// For a mean: bounds of every value.
    pub bounded: Option<[f64; 2]>,
    /// For a fraction: whether a run without a value meets it, because the event never happens.
    pub never_meets: bool,
    pub confidence: f64,
}

pub const DEFAULT_CONFIDENCE: f64 = 0.95;
/// For `false` and `true`.
const NEVER: [&str; 2] = ["violates", "meets"];
const BOUNDS: ListLimit = ListLimit {
    allowed: "two numbers, the smaller one first: no run has a value outside of them",
    remedy: "write it like [0.0, 1.0]",
    test: |list| matches!(list, [low, high] if low < high),
};

#[rustfmt::skip]
pub const ROWS: [Row; 13] = [
    Row::new("observable", Kind::Observable, "The observable that must keep the limit"),
    Row::new("band", Kind::Band, "The quantity over time that must keep the limit"),
    Row::new("from_s", Kind::Number, "Start of the time interval; default: the start of the run"),
    Row::new("to_s", Kind::Number, "End of the time interval; default: the end of the run"),
    Row::new("at_all_times", Kind::Flag, "Whether each run must keep the limit at all times, instead of the runs at \
        each time separately; default: false"),
    Row::new("quantile", Kind::Number, "The quantile of the runs that must keep the limit").limited(PROBABILITY),
    Row::new("fraction", Kind::Number, "The fraction of the runs that must keep the limit").limited(PROBABILITY),
    Row::new("mean", Kind::Yes, "Whether the mean of the runs must keep the limit"),
    Row::new("at_most", Kind::Amount, "Upper limit, in the unit of the observable or quantity"),
    Row::new("at_least", Kind::Amount, "Lower limit, in the unit of the observable or quantity"),
    Row::new("bounded", Kind::Numbers(BOUNDS), "For a mean: two values between which every run is known to lie"),
    Row::new("never", Kind::Word(&NEVER), "For a fraction: whether a run without a value, because the event never \
        happens, meets the limit").sparse(),
    Row::new("confidence", Kind::Number, "Confidence of the verdict")
        .limited(CONFIDENCE)
        .or(Presence::Or(DEFAULT_CONFIDENCE)),
];

const A_TABLE_EACH: &str = "write a [[require]] table for each";

pub const RULES: [Rule; 7] = [
    Rule::One(&[&["observable"], &["band"]], "\"energy_error_max\"", A_TABLE_EACH),
    Rule::One(&[&["quantile"], &["fraction"], &["mean"]], "0.99", A_TABLE_EACH),
    Rule::One(&[&["at_most"], &["at_least"]], "1e-9", A_TABLE_EACH),
    Rule::Only {
        keys: &["from_s", "to_s", "at_all_times"],
        with: &[Condition::Has("band")],
        allowed: "left out with `observable`, which is one number of a run",
        remedy: "delete it, or write `band`",
    },
    Rule::Only {
        keys: &["mean"],
        with: &[Condition::Has("observable")],
        allowed: "left out with `band`: a requirement over time is about a share of the runs",
        remedy: "write quantile or fraction",
    },
    Rule::Only {
        keys: &["bounded"],
        with: &[Condition::Has("mean")],
        allowed: "left out without mean = true: shares and quantiles need no bounds",
        remedy: "delete it",
    },
    Rule::Only {
        keys: &["never"],
        with: &[Condition::Has("fraction"), Condition::Has("observable")],
        allowed: "left out where the requirement is not about a fraction of the runs and an observable",
        remedy: "write fraction, or delete this line",
    },
];

impl Requirement {
    pub(super) fn read(table: &mut Section<'_, '_>) -> Option<Self> {
        table.describes(None, units::UNKNOWN);
        let written = table.whole(&ROWS, &RULES)?.completed(&ROWS, &RULES);
        let number = |key| written.number(key);
        let limit = number("at_most").map(GateLimit::AtMost).or(number("at_least").map(GateLimit::AtLeast))?;
        let share = number("quantile").map(Statement::Quantile).or(number("fraction").map(Statement::Fraction));
        let text = |key| written.text(key).map(str::to_owned);
        let band = text("band").map(|series| BandSubject { series, from_s: number("from_s"), to_s: number("to_s") });
        let subject = match band {
            None => Subject::Observable(text("observable")?),
            Some(band) if written.flag("at_all_times") => {
                let is_highest = matches!(limit, GateLimit::AtMost(_));
                let known = table.document.known.as_ref()?;
                let (window, column) = known.window(&band.series, is_highest, [band.from_s, band.to_s])?;
                Subject::AtAllTimes { band, window, column }
            }
            Some(band) => Subject::Band(band),
        };
        let requirement = Requirement {
            subject,
            statement: share.unwrap_or(Statement::Mean),
            limit,
            bounded: written.numbers("bounded").and_then(|list| list.try_into().ok()),
            never_meets: written.text("never") == Some(NEVER[1]),
            confidence: number("confidence")?,
        };
        table.document.keep("[[require]]", written);
        Some(requirement)
    }

    /// The least share of runs within the limit; `None` for a mean.
    pub fn share(&self) -> Option<f64> {
        match self.statement {
            Statement::Quantile(p) => Some(self.limit.fraction(p)),
            Statement::Fraction(fraction) => Some(fraction),
            Statement::Mean => None,
        }
    }

    /// True if a run with this value of the observable, which may be NaN, meets it.
    pub fn is_met(&self, value: f64) -> bool {
        self.limit.is_met(value) || self.never_meets && value.is_nan()
    }

    /// The observable; `None` for a quantity at each time.
    pub fn observable(&self) -> Option<&str> {
        match &self.subject {
            Subject::Observable(name) | Subject::AtAllTimes { column: name, .. } => Some(name),
            Subject::Band(_) => None,
        }
    }

    /// The observable whose value decides whether a single run meets it; `None` for a mean or for a quantity at each
    /// time.
    pub fn of_runs(&self) -> Option<&str> {
        self.observable().filter(|_| self.statement != Statement::Mean)
    }

    /// The extreme over time that only this requirement adds to the rows.
    pub fn window(&self) -> Option<Window> {
        match &self.subject {
            Subject::AtAllTimes { window, .. } => Some(*window),
            _ => None,
        }
    }

    pub fn band(&self) -> Option<&BandSubject> {
        match &self.subject {
            Subject::Observable(_) => None,
            Subject::Band(band) | Subject::AtAllTimes { band, .. } => Some(band),
        }
    }

    /// The name of its observable or quantity over time.
    pub fn name(&self) -> &str {
        match &self.subject {
            Subject::Observable(name) => name,
            Subject::Band(band) | Subject::AtAllTimes { band, .. } => &band.series,
        }
    }

    /// The times at which the limit holds, in words: in each run at all times, or at each time separately; empty
    /// without times.
    pub fn times(&self) -> String {
        let Some(band) = self.band() else { return String::new() };
        let which = if self.window().is_some() { "at all times" } else { "at each time" };
        let end = |word: &str, end: Option<f64>| end.map_or(String::new(), |end| format!(" {word} {end} s"));
        format!(" {which}{}{}", end("from", band.from_s), end("to", band.to_s))
    }
}
