//! [`ObservableLine`]: the statistics of an observable for `summary.json`, and those of several as a table on the screen.

use std::fmt::{self, Formatter};

use serde::Serialize;

use crate::analysis::statistics::{ColumnStatistics, QuantileStatistic, Statistics};
use crate::campaign::{Plan, Requirement};
use crate::observables::Group;
use crate::observables::headlines::headlines;
use crate::report::audit_summary::Numerics;
use crate::report::number::short;
use crate::statistics::quantile::percent;

/// A quantile of an observable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuantileLine {
    /// Which.
    pub p: f64,
    /// The sample quantile (type 7).
    pub value: Option<f64>,
    /// Ends of its interval; null where the runs do not bound it, or no interval holds.
    pub interval: [Option<f64>; 2],
    /// What it takes to bound it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// The statistics of an observable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObservableLine {
    /// The observable.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Number of values.
    pub count: u64,
    /// Runs that are `ok` and have none.
    pub without_value: u64,
    /// Mean.
    pub mean: Option<f64>,
    /// Ends of its interval; null where the runs do not bound it, or no interval holds.
    pub mean_interval: [Option<f64>; 2],
    /// Standard deviation, with n - 1.
    pub standard_deviation: Option<f64>,
    /// Ends of its interval; null as for the mean.
    pub standard_deviation_interval: [Option<f64>; 2],
    /// What keeps the runs from telling mean and standard deviation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_note: Option<String>,
    /// Skewness.
    pub skewness: Option<f64>,
    /// Minimum.
    pub min: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
    /// The quantiles of the plan.
    pub quantiles: Vec<QuantileLine>,
    /// Its numerical error over the audited runs, where there are any that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<Numerics>,
}

/// The quantiles that the screen shows, where the plan has them.
const SHOWN: [f64; 3] = [0.5, 0.95, 0.999];

impl ObservableLine {
    fn new(column: &ColumnStatistics, numerical_error: Option<Numerics>) -> Self {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let quantile = |one: &QuantileStatistic| QuantileLine {
            p: one.p,
            value: finite(one.value),
            interval: one.interval.map(finite),
            note: one.note.clone(),
        };
        ObservableLine {
            name: column.quantity.name().to_owned(),
            unit: column.quantity.unit().to_owned(),
            count: column.moments.count(),
            without_value: column.without_value,
            mean: finite(column.moments.mean()),
            mean_interval: column.mean_interval,
            standard_deviation: finite(column.moments.standard_deviation()),
            standard_deviation_interval: column.deviation_interval,
            mean_note: column.note.clone(),
            skewness: finite(column.moments.skewness()),
            min: finite(column.moments.min()),
            max: finite(column.moments.max()),
            quantiles: column.quantiles.iter().map(quantile).collect(),
            numerical_error,
        }
    }

    /// Whether it says nothing: no run is ok, with a value or without one, and no quantile is known from how the others failed.
    pub fn is_empty(&self) -> bool {
        let is_known =
            |quantile: &QuantileLine| quantile.value.is_some() || quantile.interval.iter().any(Option::is_some);
        self.count == 0 && self.without_value == 0 && !self.quantiles.iter().any(is_known)
    }

    fn quantile(&self, p: f64) -> Option<&QuantileLine> {
        self.quantiles.iter().find(|quantile| quantile.p == p)
    }
}

/// The lines of a summary of `plan`: main observables, the final state, what the file names and requires. `numerics` gives the numerical
/// error of an observable.
pub fn lines(plan: &Plan, statistics: &Statistics, numerics: impl Fn(&str) -> Option<Numerics>) -> Vec<ObservableLine> {
    let columns = plan.request().columns();
    let main = headlines(&plan.request()).into_iter().map(|index| &columns[index]);
    let last = columns.iter().filter(|column| column.group == Group::FinalState);
    let asked = plan.analysis.summary_columns.iter().map(String::as_str);
    let required = plan.analysis.requirements.iter().filter_map(Requirement::observable);
    let derived = plan.analysis.derived.iter().map(|derived| derived.name.as_str());
    let mut names: Vec<&str> = Vec::new();
    let usual = main.chain(last).map(|column| column.quantity.name());
    for name in usual.chain(derived).chain(asked).chain(required) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let found = names.into_iter().filter_map(|name| statistics.column(name));
    found.map(|column| ObservableLine::new(column, numerics(column.quantity.name()))).collect()
}

/// The quantiles that `lines` show: the usual ones where they have them, else the last of theirs.
fn shown(lines: &[ObservableLine]) -> Vec<f64> {
    let all: Vec<f64> = lines.first().map_or(Vec::new(), |line| line.quantiles.iter().map(|one| one.p).collect());
    let usual: Vec<f64> = SHOWN.into_iter().filter(|p| all.contains(p)).collect();
    if usual.is_empty() { all[all.len().saturating_sub(SHOWN.len())..].to_vec() } else { usual }
}

/// Three significant digits, for the ends of intervals.
fn end(value: Option<f64>) -> String {
    match value {
        Some(value) if value == 0.0 || (0.01..1e5).contains(&value.abs()) => short(value),
        Some(value) => format!("{value:.2e}"),
        None => "?".to_owned(),
    }
}

/// Writes `lines` as a table: values, and below them the ends of their intervals at `confidence`; `title` is that of the first column.
///
/// # Errors
/// What `f` returns.
pub fn write_table(f: &mut Formatter<'_>, lines: &[ObservableLine], title: &str, confidence: f64) -> fmt::Result {
    let width = lines.iter().map(|line| line.name.len()).max().unwrap_or(0).max(title.len());
    let ps = shown(lines);
    write!(f, "\n  {title:<width$}  {:>6}", "unit")?;
    for p in &ps {
        let name = if *p == 0.5 { "median".to_owned() } else { format!("p{}", percent(*p)) };
        write!(f, "{name:>24}")?;
    }
    writeln!(f, "{:>12}", "max")?;
    for line in lines {
        write!(f, "  {:<width$}  {:>6}", line.name, if line.unit.is_empty() { "-" } else { &line.unit })?;
        let quantiles: Vec<Option<&QuantileLine>> = ps.iter().map(|p| line.quantile(*p)).collect();
        for quantile in &quantiles {
            let value = quantile.and_then(|quantile| quantile.value);
            write!(f, "{:>24}", value.map_or("-".to_owned(), short))?;
        }
        writeln!(f, "{:>12}", line.max.map_or("-".to_owned(), short))?;
        let has_interval = |quantile: &&&QuantileLine| quantile.interval.iter().any(Option::is_some);
        if quantiles.iter().flatten().any(|quantile| has_interval(&quantile)) {
            write!(f, "  {:<width$}  {:>6}", "", "")?;
            for quantile in &quantiles {
                let [lower, upper] = quantile.map_or([None; 2], |quantile| quantile.interval);
                write!(f, "{:>24}", format!("[{}, {}]", end(lower), end(upper)))?;
            }
            writeln!(f)?;
        }
    }
    let has_intervals = lines.iter().flat_map(|line| &line.quantiles).any(|one| one.interval != [None; 2]);
    if has_intervals {
        writeln!(f, "  in brackets: {}% confidence; ?: not bounded by so few runs", percent(confidence))?;
    }
    for p in ps {
        let notes = lines.iter().filter_map(|line| line.quantile(p).and_then(|quantile| quantile.note.as_ref()));
        if let Some(note) = notes.max_by_key(|note| note.len()) {
            writeln!(f, "  {note}")?;
        }
    }
    Ok(())
}
