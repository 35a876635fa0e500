//! A comparison of two results as text.

use crate::campaign::difference::KeyDifference;
use crate::dataset::comparison::{ColumnComparison, Comparison};
use crate::report::number::short;
use crate::statistics::quantile::percent;

/// Most observables in the table.
const MOST_LINES: usize = 40;
/// Most keys of plans that are listed.
const MOST_KEYS: usize = 30;

/// The text: differences of the plans, how the results are compared, and the observables, those with the largest shifts first.
pub fn text(comparison: &Comparison, keys: &[KeyDifference], tolerance: Option<f64>) -> String {
    let mut text = match keys.len() {
        0 => "  the plans are the same\n".to_owned(),
        count => format!("  plans: {count} keys differ\n"),
    };
    let value = |value: &Option<String>| value.clone().unwrap_or_else(|| "-".to_owned());
    for key in keys.iter().take(MOST_KEYS) {
        text += &format!("    {}: {} | {}\n", key.key, value(&key.first), value(&key.second));
    }
    let [first, second] = &comparison.statistics;
    text += &format!("  runs: {} of {} ok | {} of {} ok\n", first.ok(), first.samples(), second.ok(), second.samples());
    text += &match comparison.pairs {
        0 => "  compared as independent samples: Welch's test of means, Kolmogorov and Smirnov's of distributions\n"
            .to_owned(),
        pairs => format!(
            "  compared sample by sample: {pairs} samples were drawn alike; Student's test of means, signed ranks\n"
        ),
    };
    for (names, which) in comparison.alone.iter().zip(["first", "second"]) {
        if !names.is_empty() {
            text += &format!("  only in the {which}: {}\n", names.join(", "));
        }
    }
    text + &table(comparison, tolerance)
}

fn table(comparison: &Comparison, tolerance: Option<f64>) -> String {
    let largest = |column: &ColumnComparison| column.largest().map_or(0.0, |shift| shift.relative);
    let mut columns: Vec<&ColumnComparison> =
        comparison.columns.iter().filter(|column| largest(column) > 0.0 || column.differing_pairs > 0).collect();
    columns.sort_by(|a, b| largest(b).total_cmp(&largest(a)));
    let same = comparison.columns.len() - columns.len();
    let mut text = format!("  {same} of {} observables have the same statistics\n", comparison.columns.len());
    if columns.is_empty() {
        return text;
    }
    let width = columns.iter().map(|column| column.quantity.name().len()).max().unwrap_or(0);
    let confidence = percent(comparison.statistics[0].confidence);
    text += &format!(
        "\n  {:<width$}{:>12}{:>12}{:>26}{:>11}{:>11}   largest shift\n",
        "shifted",
        "mean",
        "shift",
        format!("{confidence}% interval"),
        "p (mean)",
        "p (dist.)"
    );
    let optional = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2e}"));
    for column in columns.iter().take(MOST_LINES) {
        let mean = column.shifts.iter().find(|shift| shift.statistic == "mean").map_or(f64::NAN, |shift| shift.first);
        let (shift, interval) = match &column.mean {
            Some(found) => {
                let interval = format!("[{:.2e}, {:.2e}]", found.shift.lower, found.shift.upper);
                (short(found.shift.value), interval)
            }
            None => ("-".to_owned(), "-".to_owned()),
        };
        let worst = column.largest().map_or(String::new(), |shift| {
            let mark = if tolerance.is_some_and(|tolerance| shift.relative > tolerance) { " (beyond)" } else { "" };
            format!("{} by {:.2e} of the spread{mark}", shift.statistic, shift.relative)
        });
        text += &format!(
            "  {:<width$}{:>12}{shift:>12}{interval:>26}{:>11}{:>11}   {worst}\n",
            column.quantity.name(),
            short(mean),
            optional(column.mean.map(|found| found.p_value)),
            optional(column.distribution_p_value),
        );
    }
    if columns.len() > MOST_LINES {
        text += &format!("  ... and {} more\n", columns.len() - MOST_LINES);
    }
    text
}
