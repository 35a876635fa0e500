//! [`ObservableLine`]: the statistics of an observable for `summary.json`, and those of several as a table on the
//! screen.

use serde::Serialize;

use crate::analysis::order_statistics::QuantileStatistic;
use crate::analysis::outcomes::{OF_MOTION, named};
use crate::analysis::statistics::{ColumnStatistics, Statistics};
use crate::campaign::{Plan, ShownUnit};
use crate::findings::number::{brief, outward, short};
use crate::observables::Group;
use crate::observables::headlines::headlines;
use crate::report::audit_summary::Numerics;
use crate::report::share_text::with_interval;
use crate::statistics::quantile::percent;
use crate::table::Table;
use crate::table::text::Align;

/// A quantile of an observable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuantileLine {
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
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// The unit in which the screen shows it.
    #[serde(skip)]
    pub shown: ShownUnit,
    pub count: u64,
    /// Runs that are `ok` and have none.
    pub without_value: u64,
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
    pub skewness: Option<f64>,
    pub min: Option<f64>,
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
    fn new(column: &ColumnStatistics, shown: ShownUnit, numerical_error: Option<Numerics>) -> Self {
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
            shown,
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

    /// Whether it says nothing: no run is ok, with a value or without one, and no quantile is known from how the others
    /// failed.
    pub fn is_empty(&self) -> bool {
        let is_known =
            |quantile: &QuantileLine| quantile.value.is_some() || quantile.interval.iter().any(Option::is_some);
        self.count == 0 && self.without_value == 0 && !self.quantiles.iter().any(is_known)
    }

    /// Whether it has an interval.
    pub fn has_interval(&self) -> bool {
        self.quantiles.iter().any(|one| one.interval != [None; 2])
    }

    /// Whether one of the quantiles `ps` has.
    fn has_interval_of(&self, ps: &[f64]) -> bool {
        self.quantiles.iter().any(|one| ps.contains(&one.p) && one.interval != [None; 2])
    }

    /// Whether no run has another number than 0 and 1.
    pub fn is_yes_or_no(&self) -> bool {
        let is_whole = |value: f64| value == 0.0 || value == 1.0;
        let values = self.quantiles.iter().filter_map(|one| one.value).chain(self.min).chain(self.max);
        self.unit.is_empty() && self.min.is_some() && values.into_iter().all(is_whole)
    }

    /// The share of runs with 1, where no run has another number than 0 and 1. What is the same in all runs may be a
    /// number, such as an error of zero; of few runs a quantile may lie between both.
    pub fn share_of_yes(&self) -> Option<f64> {
        self.mean.filter(|_| self.name == "launched" || self.is_yes_or_no() && self.min != self.max)
    }

    fn quantile(&self, p: f64) -> Option<&QuantileLine> {
        self.quantiles.iter().find(|quantile| quantile.p == p)
    }
}

/// The lines of a summary of `plan`: main observables, the final state, what the file names and requires. `numerics`
/// gives the numerical error of an observable.
pub fn lines(plan: &Plan, statistics: &Statistics, numerics: impl Fn(&str) -> Option<Numerics>) -> Vec<ObservableLine> {
    let columns = plan.request().columns();
    let main = headlines(&plan.request()).into_iter().map(|index| &columns[index]);
    let last = columns.iter().filter(|column| column.group == Group::FinalState);
    let usual = main.chain(last).map(|column| column.quantity.name().to_owned());
    let of_motion = OF_MOTION.iter().map(|name| (*name).to_owned());
    let found =
        distinct(usual.chain(of_motion).chain(named(plan))).into_iter().filter_map(|name| statistics.column(&name));
    let line = |column: &ColumnStatistics| {
        let (name, unit) = (column.quantity.name(), column.quantity.unit());
        ObservableLine::new(column, plan.analysis.display.of(name, unit), numerics(name))
    };
    found.map(line).collect()
}

/// Names in their order, each once.
fn distinct(all: impl Iterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The quantiles that `lines` show: the usual ones where they have them, else the last of theirs.
fn shown(lines: &[&ObservableLine]) -> Vec<f64> {
    let all: Vec<f64> = lines.first().map_or(Vec::new(), |line| line.quantiles.iter().map(|one| one.p).collect());
    let usual: Vec<f64> = SHOWN.into_iter().filter(|p| all.contains(p)).collect();
    if usual.is_empty() { all[all.len().saturating_sub(SHOWN.len())..].to_vec() } else { usual }
}

/// The end of an interval, with a digit less where there is a power of ten; `?` for none.
fn end(value: f64) -> String {
    if value.is_nan() {
        "?".to_owned()
    } else {
        Some(short(value)).filter(|text| !text.contains('e')).unwrap_or_else(|| brief(value))
    }
}

/// `lines` as a table for lines of `width` characters: values, and below them the ends of their intervals; `title` is
/// that of the first column.
pub fn table(lines: &[&ObservableLine], title: &str, width: usize) -> String {
    let ps = shown(lines);
    let of_p = |p: &f64| if *p == 0.5 { "median".to_owned() } else { format!("p{}", percent(*p)) };
    let heads = ps.iter().map(of_p).chain(["max".to_owned()]).map(|head| (head, Align::Right));
    let mut table = Table::with([(title.to_owned(), Align::Title)].into_iter().chain(heads));
    for line in lines {
        let quantiles: Vec<Option<&QuantileLine>> = ps.iter().map(|p| line.quantile(*p)).collect();
        let value = |value: Option<f64>| value.map_or("-".to_owned(), |value| short(line.shown.value(value)));
        let unit = if line.shown.unit.is_empty() { String::new() } else { format!(", {}", line.shown.unit) };
        if let Some(share) = line.share_of_yes() {
            table.row([line.name.clone(), format!("yes in {}", with_interval([share; 2], [f64::NAN; 2]))]);
            continue;
        }
        let values = quantiles.iter().map(|quantile| value(quantile.and_then(|one| one.value)));
        table.row([line.name.clone() + &unit].into_iter().chain(values).chain([value(line.max)]));
        if line.has_interval_of(&ps) {
            let interval = |quantile: &Option<&QuantileLine>| {
                let ends = quantile.map_or([None; 2], |quantile| quantile.interval);
                let ends = ends.map(|end| line.shown.value(end.unwrap_or(f64::NAN)));
                let digits = if ends.iter().any(|value| end(*value).contains('e')) { 3 } else { 4 };
                let [lower, upper] = outward(ends, digits).map(end);
                format!("[{lower}, {upper}]")
            };
            table.row([String::new()].into_iter().chain(quantiles.iter().map(interval)));
        }
    }
    let mut text = format!("\n{}", table.text(width));
    for p in ps {
        let notes = lines.iter().filter_map(|line| line.quantile(p).and_then(|quantile| quantile.note.as_ref()));
        if let Some(note) = notes.max_by_key(|note| note.len()) {
            text += &format!("  {note}\n");
        }
    }
    text
}
