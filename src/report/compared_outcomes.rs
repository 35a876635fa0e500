//! The outcomes of a comparison that are shifted: those that matter to a person, and all of them.

use crate::analysis::comparison::{Absence, ColumnComparison, Comparison, Shift};
use crate::analysis::outcomes::outcomes;
use crate::campaign::{Plan, ShownUnit, Statement};
use crate::findings::names;
use crate::findings::number::{self, brief, counted, outward, trimmed};
use crate::observables::Group;
use crate::report::compared::Compared;
use crate::statistics::quantile::percent;
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::table::wrapped::wrapped;

/// Most observables in a table.
const MOST_LINES: usize = 40;
/// A shift that is smaller, as a share of the spread, matters to few: a small effect (J. Cohen, Statistical Power
/// Analysis, 1988, 2.2). `--tolerance` says otherwise.
const SMALL_EFFECT: f64 = 0.2;
/// Groups of columns that keep the accounts of the integration, or the state that a run happens to end with: no outcome
/// of a mission, unless its file says so.
const ACCOUNTS: [Group; 6] = [
    Group::FinalState,
    Group::EnergyConservation,
    Group::MomentumConservation,
    Group::Constraints,
    Group::StepStatistics,
    Group::Numerics,
];
/// Columns with the number of a name, whose mean says nothing.
const CODES: [&str; 2] = ["failure", "phase_final"];

/// The shift that decides whether that of an observable matters, the largest: of its mean, and of one that is required
/// of its standard deviation and the required quantiles too. Quantiles far out in the tails of few runs differ by
/// chance. With a tolerance, which is about all of them: of all.
fn largest<'c>(compared: Compared<'_>, column: &'c ColumnComparison) -> Option<&'c Shift> {
    let required = compared.plans.iter().flat_map(|plan| &plan.analysis.requirements);
    let of_column = required.filter(|one| one.observable() == Some(column.quantity.name()));
    let quantiles: Vec<String> = of_column
        .filter_map(|one| match one.statement {
            Statement::Quantile(p) => Some(format!("p{}", percent(p))),
            _ => None,
        })
        .collect();
    let is_considered = |shift: &&Shift| {
        compared.tolerance.is_some()
            || shift.statistic == "mean"
            || column.is_required && shift.statistic == "standard deviation"
            || quantiles.contains(&shift.statistic)
    };
    // of equal ones the first
    column.shifts.iter().rev().filter(is_considered).max_by(|a, b| a.relative.total_cmp(&b.relative))
}

/// Whether an observable has only the values 0 and 1 in both results.
fn is_yes_or_no(compared: Compared<'_>, column: &ColumnComparison) -> bool {
    let is_of = |ends: [Option<f64>; 2]| ends.iter().all(|end| *end == Some(0.0) || *end == Some(1.0));
    let name = column.quantity.name();
    column.quantity.unit().is_empty()
        && compared
            .comparison
            .statistics
            .iter()
            .all(|of| of.column(name).is_some_and(|of| is_of([of.moments.min(), of.moments.max()])))
}

/// Whether an observable keeps accounts of the integration, or is a state that a run happens to end with, or a code.
fn is_account(compared: Compared<'_>, column: &ColumnComparison) -> bool {
    let name = column.quantity.name();
    let columns = compared.plans[0].request().columns();
    let group = columns.iter().find(|one| one.quantity.name() == name).map(|one| one.group);
    CODES.contains(&name) || group.is_some_and(|group| ACCOUNTS.contains(&group))
}

/// The shifts that matter, of observables that are outcomes: those that the first plan names, in its order, then the
/// largest.
pub fn shifted<'c>(compared: Compared<'c>) -> Vec<(&'c ColumnComparison, &'c Shift)> {
    let Compared { comparison, plans: [plan, _], tolerance, .. } = compared;
    let most = tolerance.unwrap_or(SMALL_EFFECT);
    let named = outcomes(plan);
    let place = |column: &ColumnComparison| named.iter().position(|name| name == column.quantity.name());
    let is_outcome = |column: &&ColumnComparison| {
        // a verdict says it already
        let is_stated = column.is_required && is_yes_or_no(compared, column);
        tolerance.is_some() || place(column).is_some() && !is_stated || !is_account(compared, column) && !is_stated
    };
    let is_seen = |column: &&ColumnComparison| {
        comparison.is_shifted(column) || tolerance.is_some_and(|most| column.is_beyond(most))
    };
    let found = comparison.columns.iter().filter(is_seen).filter(is_outcome);
    let mut found: Vec<(&ColumnComparison, &Shift)> = found
        .filter_map(|column| {
            Some((column, largest(compared, column).filter(|shift| shift.relative > most || shift.relative.is_nan())?))
        })
        .collect();
    let order = |column: &ColumnComparison| place(column).unwrap_or(usize::MAX);
    found.sort_by(|(a, of_a), (b, of_b)| order(a).cmp(&order(b)).then(of_b.relative.total_cmp(&of_a.relative)));
    found
}

/// The first of the outcomes `all` that fit lines of `width` characters, in at most `most` lines below the heads; and
/// how many these are.
pub fn short(
    compared: Compared<'_>,
    all: &[(&ColumnComparison, &Shift)],
    most: usize,
    width: usize,
) -> (String, usize) {
    let confidence = percent(compared.comparison.statistics[0].confidence);
    let table = |rows: &[[String; 4]]| {
        let heads = ["outcome, mean of the runs", "before", "after", &format!("shift [{confidence}%]")];
        let aligns = [Align::Title, Align::Right, Align::Right, Align::Right];
        let mut table = Table::with(heads.map(str::to_owned).into_iter().zip(aligns));
        rows.iter().for_each(|row| table.row(row.clone()));
        table
    };
    let mut rows: Vec<[String; 4]> = Vec::new();
    for (column, shift) in all {
        rows.push(cells(compared, column, shift));
        if rows.len() > most || Text::of(&table(&rows)).width() > width {
            rows.pop();
        }
    }
    // rather a line above its numbers than none
    let first = all.first().filter(|_| rows.is_empty());
    rows.extend(first.map(|(column, shift)| cells(compared, column, shift)));
    if rows.is_empty() { (String::new(), 0) } else { (table(&rows).text(width), rows.len()) }
}

/// The cells of a row: name with its unit, both values, and the shift with its interval, where there is one.
fn cells(compared: Compared<'_>, column: &ColumnComparison, shift: &Shift) -> [String; 4] {
    let shown = shown(compared.plans[0], column);
    let name = names::of_quantity(&column.quantity);
    let of = match shift.statistic.as_str() {
        "mean" => name,
        statistic => format!("{statistic} of {name}"),
    };
    let is_share = shift.statistic == "mean" && is_yes_or_no(compared, column);
    let value = |value: f64| match is_share {
        true => format!("{}%", number::percent(value)),
        false => brief(shown.value(value)),
    };
    let interval = match column.mean.as_ref().filter(|_| shift.statistic == "mean") {
        Some(found) if is_share => {
            interval([found.shift.value, found.shift.lower, found.shift.upper].map(|x| 100.0 * x))
        }
        Some(found) => interval([found.shift.value, found.shift.lower, found.shift.upper].map(|x| shown.value(x))),
        None => brief(shown.value(shift.second - shift.first)),
    };
    let unit = if shown.unit.is_empty() { String::new() } else { format!(", {}", shown.unit) };
    [of + &unit, value(shift.first), value(shift.second), interval]
}

/// `1.04 [0.97, 1.11]`.
fn interval([value, low, high]: [f64; 3]) -> String {
    let [low, high] = outward([low, high], 3).map(brief);
    format!("{} [{low}, {high}]", brief(value))
}

/// The unit in which an observable is shown.
fn shown(plan: &Plan, column: &ColumnComparison) -> ShownUnit {
    plan.analysis.display.of(column.quantity.name(), column.quantity.unit())
}

/// The observables of `all`, those first that the first plan names, and without accounts of the integration where there
/// are others.
fn outcomes_first<'c>(compared: Compared<'_>, all: Vec<&'c ColumnComparison>) -> Vec<&'c ColumnComparison> {
    let named = outcomes(compared.plans[0]);
    let place = |column: &&ColumnComparison| named.iter().position(|name| name == column.quantity.name());
    let (mut first, rest): (Vec<_>, Vec<_>) = all.into_iter().partition(|column| place(column).is_some());
    first.sort_by_key(place);
    let (accounts, others): (Vec<_>, Vec<_>) = rest.into_iter().partition(|column| is_account(compared, column));
    first.extend(others);
    if first.is_empty() { accounts } else { first }
}

/// A line for each of the first `most` outcomes whose runs moved while no test of distributions sees it: how far, and
/// in how many pairs.
pub fn moved(compared: Compared<'_>, most: usize) -> String {
    let Compared { comparison, .. } = compared;
    let all = comparison.columns.iter().filter(|column| comparison.is_moved(column)).collect();
    let line = |column: &&ColumnComparison| {
        let shown = shown(compared.plans[0], column);
        let name = names::of_quantity(&column.quantity);
        let unit = if shown.unit.is_empty() { String::new() } else { format!(" {}", shown.unit) };
        let pairs = format!("in {} of {} runs", column.differing_pairs, comparison.pairs);
        let of = |statistic: &str| column.shifts.iter().find(|shift| shift.statistic == statistic);
        if column.moves_apart() {
            let ends = of("standard deviation").map(|shift| [shift.first, shift.second].map(|x| brief(shown.value(x))));
            let [before, after] = ends.unwrap_or_else(|| ["-", "-"].map(str::to_owned));
            return format!(
                "  moved apart: {name}, standard deviation {before} before, {after} after{unit}, {pairs}\n"
            );
        }
        let by = column.mean.map_or(String::new(), |found| {
            let by = interval([found.shift.value, found.shift.lower, found.shift.upper].map(|x| shown.value(x)));
            format!(" by {by}{unit} ({} of its spread)", brief(found.shift.value.abs() / column.scale))
        });
        format!("  moved: {name}{by}, {pairs}\n")
    };
    outcomes_first(compared, all).iter().take(most).map(line).collect()
}

/// A line for the runs that are not `ok`, and for each of the first `most` outcomes that fewer or more of the others
/// have, where chance does not explain it.
pub fn absent(compared: Compared<'_>, most: usize) -> String {
    let Compared { comparison, .. } = compared;
    let all = comparison.columns.iter().filter(|column| comparison.is_changed(&column.absence)).collect();
    let line = |what: &str, absence: &Absence| {
        let [before, after] = absence.shares().map(number::percent);
        format!("  {what}: {before}% of the runs before, {after}% after, more than chance explains\n")
    };
    let failures = comparison.is_changed(&comparison.failures).then(|| line("not ok", &comparison.failures));
    let of_column = |column: &&ColumnComparison| {
        line(&format!("without {}", names::of_quantity(&column.quantity)), &column.absence)
    };
    failures.into_iter().chain(outcomes_first(compared, all).iter().take(most).map(of_column)).collect()
}

/// How shifts are found, a sentence each.
pub fn methods(comparison: &Comparison) -> String {
    let tests = comparison.columns.iter().filter(|column| column.p_value.is_some()).count();
    let how = match comparison.pairs {
        0 => "Welch's test of means, Kolmogorov and Smirnov's of distributions",
        _ => {
            "distributions by McNemar's test, whether runs moved by signed ranks of their differences and their spread"
        }
    };
    format!("  {how}; p adjusted for {tests} tests (Holm) is at most {}\n", trimmed(comparison.level(), 3))
}

/// Every observable that is shifted, in tables: shifts that matter, then those that are detectable and small.
pub fn long(compared: Compared<'_>, important: &[(&ColumnComparison, &Shift)], width: usize) -> String {
    let Compared { comparison, tolerance, .. } = compared;
    let is_important =
        |column: &ColumnComparison| important.iter().any(|(one, _)| one.quantity.name() == column.quantity.name());
    let of = |is: &dyn Fn(&ColumnComparison) -> bool| -> Vec<&ColumnComparison> {
        comparison.columns.iter().filter(|column| is(column)).collect()
    };
    let matters: Vec<&ColumnComparison> =
        important.iter().map(|(column, _)| *column).filter(|column| comparison.is_shifted(column)).collect();
    let limit = trimmed(tolerance.unwrap_or(SMALL_EFFECT), 3);
    let tables = [
        (format!("matters: shifted by more than {limit} of the spread"), matters),
        (
            format!("detectable: shifted by at most {limit} of the spread, or accounts of the integration"),
            of(&|column| comparison.is_shifted(column) && !is_important(column)),
        ),
        (
            "moved run by run: most differ one way, or spread more; the test of distributions does not see it"
                .to_owned(),
            of(&|column| comparison.is_moved(column)),
        ),
        (
            "beyond the tolerance, explained by chance".to_owned(),
            of(&|column| !comparison.is_shifted(column) && tolerance.is_some_and(|most| column.is_beyond(most))),
        ),
    ];
    tables.into_iter().map(|(title, columns)| table(compared, &title, &columns, width)).collect::<Vec<_>>().concat()
}

/// A table of some observables, by the names of their columns; nothing where there are none.
fn table(compared: Compared<'_>, title: &str, columns: &[&ColumnComparison], width: usize) -> String {
    if columns.is_empty() {
        return String::new();
    }
    let confidence = percent(compared.comparison.statistics[0].confidence);
    let mut table = Table::with([
        (counted(columns.len(), "column"), Align::Title),
        ("mean".to_owned(), Align::Right),
        (format!("its shift [{confidence}%]"), Align::Right),
        ("adjusted p".to_owned(), Align::Right),
        ("largest shift".to_owned(), Align::Sentence),
    ]);
    for column in columns.iter().take(MOST_LINES) {
        let shown = shown(compared.plans[0], column);
        let mean = column.shifts.iter().find(|shift| shift.statistic == "mean").map_or(f64::NAN, |shift| shift.first);
        let shift = column.mean.as_ref().map_or("-".to_owned(), |found| {
            interval([found.shift.value, found.shift.lower, found.shift.upper].map(|x| shown.value(x)))
        });
        let worst = column.largest().map_or(String::new(), |shift| {
            let is_beyond = compared.tolerance.is_some_and(|tolerance| shift.relative > tolerance);
            let mark = if is_beyond { " (beyond)" } else { "" };
            format!("{} by {} of the spread{mark}", shift.statistic, brief(shift.relative))
        });
        let unit = if shown.unit.is_empty() { String::new() } else { format!(", {}", shown.unit) };
        let name = format!("{}{}{unit}", if column.is_required { "* " } else { "" }, column.quantity.name());
        let p = column.adjusted_p_value.map_or("-".to_owned(), brief);
        table.row([name, brief(shown.value(mean)), shift, p, worst]);
    }
    let mut text = wrapped(&format!("  {title}\n"), width) + &table.text(width);
    if columns.len() > MOST_LINES {
        text += &format!("  ... and {} more\n", columns.len() - MOST_LINES);
    }
    if columns.iter().take(MOST_LINES).any(|column| column.is_required) {
        text += "  * named by a requirement\n";
    }
    text + "\n"
}
