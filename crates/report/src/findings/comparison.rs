//! Two results compared: runs, verdicts, keys of the file and outcomes.

use std::cmp::Ordering;

use crate::analysis::comparison::{Absence, ColumnComparison, Shift};
use crate::analysis::outcomes::outcomes;
use crate::analysis::population::Population;
use crate::campaign::{ShownUnit, Statement};
use crate::findings::compared::{Compared, ComparedVerdict};
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::{self, brief, counted, trimmed, with_interval};
use crate::findings::{changed_keys, names};
use crate::observables::Group;
use crate::statistics::quantile::percent;
use crate::table::Table;
use crate::table::text::Align;

/// Smaller shifts, as a share of the spread, are small effects (J. Cohen, Statistical Power Analysis, 1988, 2.2);
/// `--tolerance` overrides this.
const SMALL_EFFECT: f64 = 0.2;
/// Groups that describe the integration or the final state: no outcomes of a mission unless the file names them.
const ACCOUNTS: [Group; 6] = [
    Group::FinalState,
    Group::EnergyConservation,
    Group::MomentumConservation,
    Group::Constraints,
    Group::StepStatistics,
    Group::Numerics,
];
/// Columns of codes, whose mean is meaningless.
const CODES: [&str; 2] = ["failure", "phase_final"];
/// Moved or absent outcomes that a screen lists.
const FEW: usize = 3;

/// The findings in screen order; the last one matches the exit code.
pub fn findings(compared: &Compared<'_>) -> Vec<Finding> {
    let Compared { names, comparison, plans: [first, second], .. } = compared;
    let mut list = Vec::new();
    if first.name != second.name {
        list.push(said(Kind::Runs, "campaigns", format!("different campaigns: {} and {}", first.name, second.name)));
    }
    for ((when, name), of) in ["before:", "after: "].into_iter().zip(names).zip(&comparison.statistics) {
        let runs = counted(of.samples(), "run");
        list.push(said(Kind::Runs, "result", format!("{when} {name}, {} of {runs} ok", of.ok())));
    }
    list.extend(requirements(compared));
    let keys = changed_keys::table(&compared.keys, compared.plans);
    list.push(match keys.rows() {
        0 => said(Kind::Note, "keys", "the plans are the same".to_owned()),
        _ => with_table(Kind::Note, "keys", "keys", keys),
    });
    list.extend(shifted(compared));
    list.push(said(Kind::Outcome, "counts", counts(compared)));
    list.push(Finding { rank: 1, ..said(Kind::Outcome, "methods", methods(compared)) });
    list.extend(moved(compared));
    list.extend(absent(compared));
    for (names, which) in comparison.alone.iter().zip(["before", "after"]).filter(|(names, _)| !names.is_empty()) {
        let columns = counted(names.len(), "column");
        list.push(said(Kind::Outcome, "alone", format!("only {which}: {columns}, {}", names.join(", "))));
    }
    if let Some(other) = comparison.statistics.iter().find(|of| of.population != Population::Independent) {
        let about = other.population.about_intervals();
        list.push(said(Kind::Outcome, "population", format!("p-values are for independent samples; {about}")));
    }
    list.extend(columns(compared));
    list.extend(end(compared));
    list
}

fn said(kind: Kind, id: &str, sentence: String) -> Finding {
    Finding::new(kind, id, "", sentence)
}

fn with_table(kind: Kind, id: &str, things: &str, table: Table<'static>) -> Finding {
    Finding { table: Some(table), ..Finding::new(kind, id, things, "") }
}

fn requirements(compared: &Compared<'_>) -> Option<Finding> {
    let mut all: Vec<&ComparedVerdict> = compared.verdicts.iter().collect();
    all.sort_by_key(|one| one.mark().0);
    let heads = [("requirement", Align::Title), ("before", Align::Whole), ("after", Align::Whole), ("", Align::Whole)];
    let mut table = Table::with(heads);
    for one in &all {
        let [before, after] = one.verdicts.each_ref().map(|verdict| match verdict {
            None => "-".to_owned(),
            Some(found) => format!("{} {}", found.word, without_interval(&found.found)).trim_end().to_owned(),
        });
        table.row([one.statement().to_owned(), before, after, one.mark().1]);
    }
    (!all.is_empty()).then(|| with_table(Kind::Requirement, "requirements", "requirements", table))
}

/// `98.4%` from `98.4% [91.5, 99.96]`: overlapping intervals would be a wrong test of the difference.
fn without_interval(found: &str) -> String {
    let parts = found.split_once(" [").and_then(|(value, rest)| Some((value, rest.split_once(']')?.1)));
    parts.map_or_else(|| found.to_owned(), |(value, unit)| format!("{value}{unit}"))
}

fn is_yes_or_no(compared: &Compared<'_>, column: &ColumnComparison) -> bool {
    let is_of = |end: Option<f64>| end == Some(0.0) || end == Some(1.0);
    let mut of = compared.comparison.statistics.iter().map(|of| of.column(column.quantity.name()));
    let is_so = of.all(|of| of.is_some_and(|of| is_of(of.moments.min()) && is_of(of.moments.max())));
    column.quantity.unit().is_empty() && is_so
}

fn is_account(compared: &Compared<'_>, column: &ColumnComparison) -> bool {
    let name = column.quantity.name();
    let columns = compared.plans[0].request().columns();
    let group = columns.iter().find(|one| one.quantity.name() == name).map(|one| one.group);
    CODES.contains(&name) || group.is_some_and(|group| ACCOUNTS.contains(&group))
}

/// The rank of an observable among the outcomes of the first plan; all others come last.
fn place(compared: &Compared<'_>, column: &ColumnComparison) -> usize {
    let named = outcomes(compared.plans[0]);
    named.iter().position(|name| name == column.quantity.name()).unwrap_or(usize::MAX)
}

/// The largest shift that matters: of the mean and of required quantiles, or of all statistics if there is a tolerance.
/// Tail quantiles of few runs differ by chance.
fn largest<'c>(compared: &Compared<'_>, column: &'c ColumnComparison) -> Option<&'c Shift> {
    let required = compared.plans.iter().flat_map(|plan| &plan.analysis.requirements);
    let of_column = required.filter(|one| one.observable() == Some(column.quantity.name()));
    let quantiles: Vec<String> = of_column
        .filter_map(|one| match one.statement {
            Statement::Quantile(p) => Some(format!("p{}", percent(p))),
            _ => None,
        })
        .collect();
    let is_considered = |shift: &&Shift| {
        compared.tolerance.is_some() || shift.statistic == "mean" || quantiles.contains(&shift.statistic)
    };
    // of equal ones the first
    column.shifts.iter().rev().filter(is_considered).max_by(|a, b| a.relative.total_cmp(&b.relative))
}

/// The outcomes with a relevant shift: those of the first plan in their order, then by size.
fn shifted(compared: &Compared<'_>) -> Option<Finding> {
    let Compared { comparison, tolerance, .. } = compared;
    let most = tolerance.unwrap_or(SMALL_EFFECT);
    let is_seen = |column: &&ColumnComparison| {
        let is_stated = column.is_required && is_yes_or_no(compared, column);
        let is_outcome = place(compared, column) < usize::MAX || !is_account(compared, column);
        let is_beyond = tolerance.is_some_and(|most| column.is_beyond(most));
        (comparison.is_shifted(column) || is_beyond) && (tolerance.is_some() || is_outcome && !is_stated)
    };
    let found = comparison.columns.iter().filter(is_seen);
    let found = found.filter_map(|column| Some((place(compared, column), column, largest(compared, column)?)));
    let mut found: Vec<_> = found.filter(|(.., shift)| shift.relative > most || shift.relative.is_nan()).collect();
    found.sort_by(|(a, _, of_a), (b, _, of_b)| a.cmp(b).then(of_b.relative.total_cmp(&of_a.relative)));
    let shift = format!("shift [{}%]", percent(comparison.statistics[0].confidence));
    let heads = [("outcome, mean of the runs", Align::Title), ("before", Align::Right), ("after", Align::Right)];
    let mut table = Table::with(heads.into_iter().chain([(shift.as_str(), Align::Right)]));
    found.iter().for_each(|(_, column, shift)| table.row(cells(compared, column, shift)));
    (!found.is_empty()).then(|| with_table(Kind::Outcome, "shifted", "outcomes", table))
}

fn cells(compared: &Compared<'_>, column: &ColumnComparison, shift: &Shift) -> [String; 4] {
    let shown = shown(compared, column);
    let name = names::of_quantity(&column.quantity);
    let (of, is_mean) = match shift.statistic.as_str() {
        "mean" => (name, true),
        statistic => (format!("{statistic} of {name}"), false),
    };
    let is_share = is_mean && is_yes_or_no(compared, column);
    let in_shown = |value: f64| if is_share { 100.0 * value } else { shown.value(value) };
    let both = match is_share {
        true => [shift.first, shift.second].map(|value| format!("{}%", number::percent(value))),
        false => number::apart([shift.first, shift.second].map(in_shown)),
    };
    let by = match column.mean.as_ref().filter(|_| is_mean) {
        Some(found) => by(found.shift, in_shown),
        None => brief(in_shown(shift.second - shift.first)),
    };
    let [before, after] = both;
    [with_unit(&of, &shown), before, after, by]
}

fn by(shift: crate::statistics::correlation::Estimate, in_shown: impl Fn(f64) -> f64) -> String {
    with_interval(in_shown(shift.value), [shift.lower, shift.upper].map(in_shown))
}

fn with_unit(name: &str, shown: &ShownUnit) -> String {
    if shown.unit.is_empty() { name.to_owned() } else { format!("{name}, {}", shown.unit) }
}

fn shown(compared: &Compared<'_>, column: &ColumnComparison) -> ShownUnit {
    compared.plans[0].analysis.display.of(column.quantity.name(), column.quantity.unit())
}

fn counts(compared: &Compared<'_>) -> String {
    let Compared { comparison, .. } = compared;
    let all = &comparison.columns;
    let count = |is: &dyn Fn(&ColumnComparison) -> bool| all.iter().filter(|column| is(column)).count();
    let same = count(&|column| column.largest_relative() == 0.0 && column.differing_pairs == 0);
    let shifted = count(&|column| comparison.is_shifted(column));
    let moved = match count(&|column| comparison.is_moved(column)) {
        0 => String::new(),
        moved => format!(", {moved} moved run by run"),
    };
    let how = match comparison.pairs {
        0 => "compared as independent samples".to_owned(),
        pairs => format!("compared sample by sample: {} drawn alike", counted(pairs, "sample")),
    };
    let found = match shifted {
        _ if comparison.statistics.iter().any(|one| one.ok() == 0) => {
            "no column is compared: a result has no dispersed run with numbers".to_owned()
        }
        _ if same == all.len() => format!("all {same} columns have the same statistics"),
        0 => format!("no distribution of {} is seen to shift", counted(all.len(), "column")),
        _ => format!("{shifted} of {} columns are shifted", all.len()),
    };
    format!("{found}{moved}; {how}")
}

fn methods(compared: &Compared<'_>) -> String {
    let Compared { comparison, .. } = compared;
    let tests = comparison.columns.iter().filter(|column| column.p_value.is_some()).count();
    let how = match comparison.pairs {
        0 => "Welch's test of means, Kolmogorov and Smirnov's of distributions",
        _ => {
            "distributions by McNemar's test, whether runs moved by signed ranks of their differences and their spread"
        }
    };
    format!("{how}; p adjusted for {tests} tests (Holm) is at most {}", trimmed(comparison.level(), 3))
}

/// The observables that meet `is`, outcomes of the first plan first, accounts of the integration only if there is
/// nothing else. Each with its rank: a screen shows the first `few`.
fn outcomes_first<'c>(
    compared: &'c Compared<'_>,
    few: usize,
    is: impl Fn(&ColumnComparison) -> bool,
) -> impl Iterator<Item = (&'c ColumnComparison, u8)> {
    let mut all: Vec<_> = compared.comparison.columns.iter().filter(|column| is(column)).collect();
    let is_other = |column: &ColumnComparison| place(compared, column) < usize::MAX || !is_account(compared, column);
    if all.iter().any(|column| is_other(column)) {
        all.retain(|column| is_other(column));
    }
    all.sort_by_key(|column| place(compared, column));
    all.into_iter().enumerate().map(move |(index, column)| (column, u8::from(index >= few)))
}

/// Outcomes whose runs moved without a visible change of the distribution: how far, in how many pairs.
fn moved(compared: &Compared<'_>) -> Vec<Finding> {
    let Compared { comparison, .. } = compared;
    let one = |(column, rank): (&ColumnComparison, u8)| {
        let shown = shown(compared, column);
        let (name, unit) = (names::of_quantity(&column.quantity), format!(" {}", shown.unit));
        let unit = unit.trim_end();
        let deviation = column.shifts.iter().find(|shift| shift.statistic == "standard deviation");
        let how = match (deviation.filter(|_| column.moves_apart()), column.mean) {
            (Some(shift), _) => {
                let [before, after] = number::apart([shift.first, shift.second].map(|x| shown.value(x)));
                format!("moved apart: {name}, standard deviation {before} before, {after} after{unit}")
            }
            (None, Some(found)) => {
                let part = brief(found.shift.value.abs() / column.scale);
                let by = by(found.shift, |value| shown.value(value));
                format!("moved: {name} by {by}{unit} ({part} of its spread)")
            }
            (None, None) => format!("moved: {name}"),
        };
        let pairs = format!("in {} of {} runs", column.differing_pairs, comparison.pairs);
        Finding { rank, ..said(Kind::Outcome, "moved", format!("{how}, {pairs}")) }
    };
    // details if a distribution shifts
    let few = if comparison.columns.iter().any(|column| comparison.is_shifted(column)) { 0 } else { FEW };
    outcomes_first(compared, few, |column| comparison.is_moved(column)).map(one).collect()
}

/// Significant changes in the number of failed runs, or of runs without an outcome.
fn absent(compared: &Compared<'_>) -> Vec<Finding> {
    let Compared { comparison, .. } = compared;
    let one = |what: &str, absence: &Absence, rank: u8| {
        let [before, after] = absence.shares().map(number::percent);
        let sentence = format!("{what}: {before}% of the runs before, {after}% after, more than chance explains");
        Finding { rank, ..said(Kind::Outcome, "absent", sentence) }
    };
    let failures = comparison.is_changed(&comparison.failures).then(|| one("not ok", &comparison.failures, 0));
    let of_column = |(column, rank): (&ColumnComparison, u8)| {
        one(&format!("without {}", names::of_quantity(&column.quantity)), &column.absence, rank)
    };
    let columns = outcomes_first(compared, FEW, |column| comparison.is_changed(&column.absence));
    failures.into_iter().chain(columns.map(of_column)).collect()
}

/// Every column that is shifted, moved or beyond the tolerance.
fn columns(compared: &Compared<'_>) -> Option<Finding> {
    let Compared { comparison, tolerance, .. } = compared;
    let is_beyond = |column: &ColumnComparison| tolerance.is_some_and(|most| column.is_beyond(most));
    let shift = format!("its shift [{}%]", percent(comparison.statistics[0].confidence));
    let mut table = Table::with([
        ("column", Align::Title),
        ("mean before", Align::Right),
        (shift.as_str(), Align::Right),
        ("adjusted p", Align::Right),
        ("", Align::Sentence),
    ]);
    for column in &comparison.columns {
        let (what, p) = match () {
            () if comparison.is_shifted(column) => ("shifted", column.adjusted_p_value),
            () if comparison.is_moved(column) => ("moved", column.adjusted_moved_p_value),
            () if is_beyond(column) => ("within chance", column.adjusted_p_value),
            () => continue,
        };
        let shown = shown(compared, column);
        let mean = column.shifts.iter().find(|shift| shift.statistic == "mean").map_or(f64::NAN, |shift| shift.first);
        let shift = column.mean.map_or("-".to_owned(), |found| by(found.shift, |value| shown.value(value)));
        let worst = column
            .largest()
            .map_or(String::new(), |shift| format!(", {} by {} of the spread", shift.statistic, brief(shift.relative)));
        let beyond = if is_beyond(column) { " (beyond)" } else { "" };
        let name = with_unit(column.quantity.name(), &shown);
        let p = p.map_or("-".to_owned(), brief);
        table.row([name, brief(shown.value(mean)), shift, p, format!("{what}{worst}{beyond}")]);
    }
    (table.rows() > 0).then(|| Finding { rank: 1, ..with_table(Kind::Outcome, "columns", "columns", table) })
}

fn end(compared: &Compared<'_>) -> Vec<Finding> {
    let Compared { comparison, verdicts, tolerance, .. } = compared;
    let count = |change: Ordering| compared.counted().filter(|one| one.change() == Some(change)).count();
    let is_are = |count: usize| if count == 1 { "verdict is" } else { "verdicts are" };
    let by_chance = verdicts.iter().filter(|one| one.is_within_chance).count();
    let mut list = match (count(Ordering::Less), count(Ordering::Greater)) {
        _ if verdicts.iter().all(|one| one.change().is_none()) => Vec::new(),
        (0, 0) if by_chance > 0 => {
            let worse = verdicts.iter().any(|one| one.is_within_chance && one.is_worse());
            let strict = if worse { "; --strict counts those that are worse" } else { "" };
            vec![format!("PASS: {} changed within chance, no other one{strict}", counted(by_chance, "verdict"))]
        }
        (0, 0) => vec!["PASS: no verdict has changed".to_owned()],
        (0, better) => vec![format!("PASS: {better} {} better, none is worse", is_are(better))],
        (worse, 0) => vec![format!("FAIL: {worse} {} worse than before", is_are(worse))],
        (worse, better) => vec![format!("FAIL: {worse} {} worse than before, {better} better", is_are(worse))],
    };
    list.extend(tolerance.map(|tolerance| match comparison.is_beyond(tolerance) {
        true => format!("FAIL: a shift is beyond {tolerance:?} of the spread"),
        false => format!("PASS: no shift is beyond {tolerance:?} of the spread"),
    }));
    if list.is_empty() {
        list.push("no requirement is in both results: there is no verdict to compare".to_owned());
    }
    list.into_iter().map(|sentence| said(Kind::Verdicts, "end", sentence)).collect()
}
