//! A comparison of two results as text, and as the text of a JSON file.

use std::cmp::Ordering;

use serde_json::{Value, json};

use crate::analysis::comparison::{ColumnComparison, Comparison};
use crate::analysis::comparison_table;
use crate::analysis::population::Population;
use crate::campaign::difference::KeyDifference;
use crate::report::number::{brief, trimmed};
use crate::report::text_table::{Align, TextTable};
use crate::report::wrapped::wrapped;
use crate::statistics::quantile::percent;
use crate::storage::described_table;

/// Most observables in a table.
const MOST_LINES: usize = 40;
/// A shift that is smaller, as a share of the spread, matters to few: a small effect (J. Cohen, Statistical Power Analysis, 1988, 2.2). `--tolerance` says otherwise.
const SMALL_EFFECT: f64 = 0.2;
/// Most keys of plans that are listed.
const MOST_KEYS: usize = 30;

/// A requirement of either result with its verdict in each, where it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComparedVerdict {
    /// The requirement as a sentence.
    pub requirement: String,
    /// `PASS`, `FAIL` or `UNDECIDED`.
    pub verdicts: [Option<String>; 2],
}

impl ComparedVerdict {
    /// Whether the second verdict is worse than the first: FAIL is worse than UNDECIDED, which is worse than PASS. A requirement that only one result
    /// has is not compared.
    pub fn is_worse(&self) -> bool {
        self.change() == Some(Ordering::Less)
    }

    /// How the second verdict compares with the first; `None` where only one result has the requirement.
    fn change(&self) -> Option<Ordering> {
        let rank = |word: &String| ["FAIL", "UNDECIDED", "PASS"].iter().position(|known| known == word);
        let [first, second] = self.verdicts.each_ref().map(|verdict| verdict.as_ref().and_then(rank));
        first.zip(second).map(|(first, second)| second.cmp(&first))
    }
}

/// Two results compared, with what is said of them beside their numbers.
#[derive(Clone, Copy, Debug)]
pub struct Compared<'c> {
    pub comparison: &'c Comparison,
    /// The keys in which the plans differ.
    pub keys: &'c [KeyDifference],
    pub verdicts: &'c [ComparedVerdict],
    /// The shift that is allowed, where one is.
    pub tolerance: Option<f64>,
}

/// The text: differences of the plans, how the results are compared, the verdicts, and the observables that are shifted.
pub fn text(compared: Compared<'_>, width: usize) -> String {
    let Compared { comparison, keys, verdicts, tolerance } = compared;
    let mut text = match keys.len() {
        0 => "  the plans are the same\n".to_owned(),
        1 => "  plans: 1 key differs\n".to_owned(),
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
            "  compared sample by sample: {pairs} samples were drawn alike and computed in both; distributions by McNemar's test, whether runs moved by signed ranks\n"
        ),
    };
    if let Some(other) = [first, second].into_iter().find(|of| of.population != Population::Independent) {
        text += &format!("  p-values are for independent samples; intervals: {}\n", other.population.intervals());
    }
    for (names, which) in comparison.alone.iter().zip(["first", "second"]) {
        if !names.is_empty() {
            text += &format!("  only in the {which}: {}\n", names.join(", "));
        }
    }
    text = wrapped(&text, width);
    if !verdicts.is_empty() {
        text += "\n  requirements\n";
    }
    let heads = [("", Align::Left), ("", Align::Left), ("", Align::Left), ("", Align::Sentence)];
    let mut requirements = TextTable::new(heads);
    for one in verdicts {
        let [first, second] = one.verdicts.each_ref().map(value);
        let mark = match one.change() {
            Some(Ordering::Less) => "WORSE",
            Some(Ordering::Greater) => "BETTER",
            Some(Ordering::Equal) => "",
            None => "DIFFERENT",
        };
        requirements.row([first, second, mark.to_owned(), one.requirement.clone()]);
    }
    text += &requirements.text(width);
    text + &observables(comparison, tolerance, width)
}

/// What is said of the observables: shifts that matter, then those that are detectable and small.
fn observables(comparison: &Comparison, tolerance: Option<f64>, width: usize) -> String {
    let all = &comparison.columns;
    let same = all.iter().filter(|column| column.largest_relative() == 0.0 && column.differing_pairs == 0).count();
    let (shifted, others): (Vec<_>, Vec<_>) = all.iter().partition(|column| comparison.is_shifted(column));
    let most = tolerance.unwrap_or(SMALL_EFFECT);
    let (matters, detectable): (Vec<_>, Vec<_>) = shifted.iter().copied().partition(|column| column.is_beyond(most));
    let moved: Vec<_> = others.iter().copied().filter(|column| comparison.is_moved(column)).collect();
    let beyond: Vec<_> =
        others.into_iter().filter(|column| tolerance.is_some_and(|most| column.is_beyond(most))).collect();
    let mut text = wrapped(
        &format!(
            "\n  {same} of {} observables have the same statistics; {} are shifted: p adjusted for {} tests (Holm) is at most {}\n",
            all.len(),
            shifted.len(),
            all.iter().filter(|column| column.p_value.is_some()).count(),
            trimmed(comparison.level(), 3),
        ),
        width,
    );
    let limit = trimmed(most, 3);
    for (title, columns) in [
        (format!("matters: shifted by more than {limit} of the spread"), &matters),
        (format!("detectable, and small: shifted by at most {limit} of the spread"), &detectable),
        ("moved: most runs differ one way, and the distribution is not shown to be shifted".to_owned(), &moved),
        ("beyond the tolerance, explained by chance".to_owned(), &beyond),
    ] {
        text += &table(comparison, &title, columns, tolerance, width);
    }
    text
}

/// A table of some observables; nothing where there are none.
fn table(
    comparison: &Comparison,
    title: &str,
    columns: &[&ColumnComparison],
    tolerance: Option<f64>,
    width: usize,
) -> String {
    if columns.is_empty() {
        return String::new();
    }
    let confidence = percent(comparison.statistics[0].confidence);
    let mut table = TextTable::new([
        (format!("{} observable{}", columns.len(), if columns.len() == 1 { "" } else { "s" }), Align::Left),
        ("mean".to_owned(), Align::Right),
        (format!("its shift [{confidence}%]"), Align::Right),
        ("adjusted p".to_owned(), Align::Right),
        ("largest shift".to_owned(), Align::Sentence),
    ]);
    for column in columns.iter().take(MOST_LINES) {
        let mean = column.shifts.iter().find(|shift| shift.statistic == "mean").map_or(f64::NAN, |shift| shift.first);
        let shift = column.mean.as_ref().map_or("-".to_owned(), |found| {
            let [low, high] = [found.shift.lower, found.shift.upper].map(brief);
            format!("{} [{low}, {high}]", brief(found.shift.value))
        });
        let worst = column.largest().map_or(String::new(), |shift| {
            let mark = if tolerance.is_some_and(|tolerance| shift.relative > tolerance) { " (beyond)" } else { "" };
            format!("{} by {} of the spread{mark}", shift.statistic, brief(shift.relative))
        });
        let name = format!("{}{}", if column.is_required { "* " } else { "" }, column.quantity.name());
        table.row([name, brief(mean), shift, column.adjusted_p_value.map_or("-".to_owned(), brief), worst]);
    }
    let mut text = format!("\n  {title}\n{}", table.text(width));
    if columns.len() > MOST_LINES {
        text += &format!("  ... and {} more\n", columns.len() - MOST_LINES);
    }
    if columns.iter().take(MOST_LINES).any(|column| column.is_required) {
        text += "  * named by a requirement\n";
    }
    text
}

/// The text of the file: everything that is compared. `names` are those of the results.
pub fn json(names: [String; 2], compared: Compared<'_>) -> String {
    let Compared { comparison, keys, verdicts, tolerance } = compared;
    let result = |name: String, which: usize| {
        let statistics = &comparison.statistics[which];
        json!({ "result": name, "samples": statistics.samples(), "ok": statistics.ok(), "only_here": comparison.alone[which] })
    };
    let key = |key: &KeyDifference| json!({ "key": key.key, "first": key.first, "second": key.second });
    let verdict = |one: &ComparedVerdict| json!({ "requirement": one.requirement, "first": one.verdicts[0], "second": one.verdicts[1], "is_worse": one.is_worse() });
    let [first, second] = names;
    let value = json!({
        "program": "spindrift",
        "version": env!("CARGO_PKG_VERSION"),
        "first": result(first, 0),
        "second": result(second, 1),
        "differing_keys": keys.iter().map(key).collect::<Vec<Value>>(),
        "compared_as": if comparison.pairs > 0 { "pairs" } else { "independent samples" },
        "pairs": comparison.pairs,
        "adjustment_of_p_values": "Holm",
        "level": comparison.level(),
        "tolerance": tolerance,
        "beyond_tolerance": tolerance.map(|tolerance| comparison.is_beyond(tolerance)),
        "requirements": verdicts.iter().map(verdict).collect::<Vec<Value>>(),
        "observables": described_table::json(&comparison_table::table(comparison)),
    });
    format!("{value:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: of every pair of verdicts those are worse that go down from PASS by UNDECIDED to FAIL; one that is in one result only is compared with nothing.
    #[test]
    fn worse_verdicts_go_down() {
        let words = [Some("PASS"), Some("UNDECIDED"), Some("FAIL"), None].map(|word| word.map(str::to_owned));
        for (place, first) in words.iter().enumerate() {
            for (other, second) in words.iter().enumerate() {
                let one = ComparedVerdict { requirement: String::new(), verdicts: [first.clone(), second.clone()] };
                assert_eq!(one.is_worse(), place < other && other < 3, "{one:?}");
                let is_better = one.change() == Some(Ordering::Greater);
                assert_eq!(is_better, other < place && place < 3, "{one:?}");
            }
        }
    }
}
