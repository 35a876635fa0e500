//! Two results compared, as text: one screen of it, or all.

use std::cmp::Ordering;

use crate::analysis::comparison::ColumnComparison;
use crate::analysis::population::Population;
use crate::findings::number::{brief, counted};
use crate::report::compared::{Compared, ComparedVerdict};
use crate::report::{changed_keys, compared_outcomes};
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::table::wrapped::wrapped;

/// Lines of a screen without `--verbose`.
const SCREEN: usize = 24;
/// Requirements, and changed keys, on such a screen.
const FEW: [usize; 2] = [6, 3];
/// Outcomes at least, on such a screen.
const LEAST_OUTCOMES: usize = 2;

/// The text for lines of `width` characters, all of it or one screen: that the campaigns are different, where they are,
/// the results, the requirements, what differs between the plans, the outcomes that are shifted, and the verdict.
pub fn text(compared: Compared<'_>, is_verbose: bool, width: usize) -> String {
    let Compared { names, comparison, plans: [first, second], .. } = compared;
    let mut text = match (&first.name, &second.name) {
        (first, second) if first == second => String::new(),
        (first, second) => wrapped(&format!("different campaigns: {first} and {second}\n"), width),
    };
    for ((when, name), of) in ["before:", "after: "].into_iter().zip(names).zip(&comparison.statistics) {
        text += &wrapped(&format!("{when} {name}, {} of {} ok\n", of.ok(), counted(of.samples(), "run")), width);
    }
    let [of_verdicts, of_keys] = if is_verbose { [usize::MAX; 2] } else { FEW };
    for section in
        [requirements(compared, of_verdicts, is_verbose, width), changed_keys::text(compared, of_keys, width)]
    {
        text += &gap(section);
    }
    let verdict = wrapped(&verdict(compared), width);
    let all = compared_outcomes::shifted(compared);
    if is_verbose {
        let tables = compared_outcomes::long(compared, &all, width);
        return text + &gap(tables) + &wrapped(&rest(compared, None), width) + &verdict;
    }
    let used = [&text, &rest(compared, Some(0)), &verdict].map(|part| wrapped(part, width).lines().count());
    // a blank line, the heads
    let most = SCREEN.saturating_sub(used.iter().sum::<usize>() + 2).max(LEAST_OUTCOMES);
    let (outcomes, shown) = compared_outcomes::short(compared, &all, most, width);
    text + &gap(outcomes) + &wrapped(&rest(compared, Some(shown)), width) + &verdict
}

/// `section` below a blank line; nothing where there is none.
fn gap(section: String) -> String {
    if section.is_empty() { section } else { format!("\n{section}") }
}

/// The verdicts: those that differ first. With `as_sentences` each requirement as a sentence, with its confidence.
fn requirements(compared: Compared<'_>, most: usize, as_sentences: bool, width: usize) -> String {
    let mut all: Vec<&ComparedVerdict> = compared.verdicts.iter().collect();
    if all.is_empty() {
        return String::new();
    }
    all.sort_by_key(|one| one.mark().0);
    let (shown, left) = all.split_at(most.min(all.len()));
    let cell = |one: &ComparedVerdict, which: usize, has_found: bool| match &one.verdicts[which] {
        None => "-".to_owned(),
        Some(found) if has_found => format!("{} {}", found.word, without_interval(&found.found)),
        Some(found) => found.word.clone(),
    };
    let [name, before, after, mark] = ["requirement", "before", "after", ""];
    let table = |has_found: bool| {
        let heads = [(name, Align::Title), (before, Align::Whole), (after, Align::Whole), (mark, Align::Whole)];
        let mut table = Table::with(heads);
        for one in shown {
            let [first, second] = [0, 1].map(|which| cell(one, which, has_found));
            table.row([one.statement(), &first, &second, one.mark().1]);
        }
        table
    };
    let mut text = if as_sentences {
        let heads = [(before, Align::Whole), (after, Align::Whole), (mark, Align::Whole), (name, Align::Sentence)];
        let mut table = Table::with(heads);
        for one in shown {
            let [first, second] = [0, 1].map(|which| cell(one, which, true));
            table.row([&first, &second, one.mark().1, &one.requirement]);
        }
        table.text(width)
    } else {
        // rather no numbers than requirements on lines of their own
        let (full, bare) = (table(true), table(false));
        let (full, bare) = (Text::of(&full), Text::of(&bare));
        if full.width() > width && bare.width() <= width { bare.lines(width) } else { full.lines(width) }
    };
    if !left.is_empty() {
        let is_same = left.iter().all(|one| one.change() == Some(Ordering::Equal));
        text += &format!("  and {} more{}\n", left.len(), if is_same { ", whose verdicts are the same" } else { "" });
    }
    text
}

/// `98.4%` of `98.4% [91.5, 99.96]`.
fn without_interval(found: &str) -> String {
    match (found.split_once(" ["), found.split_once(']')) {
        (Some((value, _)), Some((_, unit))) => format!("{value}{unit}"),
        _ => found.to_owned(),
    }
}

/// What is seen in all columns together, and how; of a screen that shows so many shifts, the others are counted.
fn rest(compared: Compared<'_>, shown: Option<usize>) -> String {
    let Compared { comparison, .. } = compared;
    let all = &comparison.columns;
    let count = |is: &dyn Fn(&ColumnComparison) -> bool| all.iter().filter(|column| is(column)).count();
    let same = count(&|column| column.largest_relative() == 0.0 && column.differing_pairs == 0);
    let [shifted, moved] =
        [count(&|column| comparison.is_shifted(column)), count(&|column| comparison.is_moved(column))];
    let how = match comparison.pairs {
        0 => "compared as independent samples".to_owned(),
        pairs => format!("compared sample by sample: {} drawn alike", counted(pairs, "sample")),
    };
    let mut text = match shown {
        _ if comparison.statistics.iter().any(|one| one.ok() == 0) => {
            "  no column is compared: a result has no dispersed run with numbers".to_owned()
        }
        _ if same == all.len() => format!("  all {same} columns have the same statistics"),
        _ if shifted == 0 => format!("  no distribution of {} is seen to shift", counted(all.len(), "column")),
        Some(shown) if shown > 0 => {
            format!("  {} more of {} columns are shifted", shifted.saturating_sub(shown), all.len())
        }
        _ => format!("  {shifted} of {} columns are shifted", all.len()),
    };
    if moved > 0 {
        text += &format!(", {moved} moved run by run");
    }
    text += &format!("; {how}");
    text += if shifted + moved > 0 && shown.is_some() { "; --verbose lists all\n" } else { "\n" };
    if shown.is_none() {
        text += &compared_outcomes::methods(comparison);
    }
    text += &compared_outcomes::moved(compared, if shown.is_some() { FEW[1] } else { usize::MAX });
    text += &compared_outcomes::absent(compared, if shown.is_some() { FEW[1] } else { usize::MAX });
    for (names, which) in comparison.alone.iter().zip(["before", "after"]) {
        if !names.is_empty() {
            let listed = if shown.is_none() { names.join(", ") } else { counted(names.len(), "column") };
            text += &format!("  only {which}: {listed}\n");
        }
    }
    if let Some(other) = comparison.statistics.iter().find(|of| of.population != Population::Independent) {
        text += &format!("  p-values are for independent samples; {}\n", other.population.about_intervals());
    }
    text
}

/// The last lines: what the exit code says.
fn verdict(compared: Compared<'_>) -> String {
    let Compared { comparison, verdicts, tolerance, is_strict, .. } = compared;
    let counts = |one: &&ComparedVerdict| is_strict || !one.is_within_chance;
    let count = |change: Ordering| verdicts.iter().filter(counts).filter(|one| one.change() == Some(change)).count();
    let is_alone = verdicts.iter().all(|one| one.change().is_none());
    let is_are = |count: usize| if count == 1 { "verdict is" } else { "verdicts are" };
    let by_chance: Vec<&ComparedVerdict> = verdicts.iter().filter(|one| one.is_within_chance).collect();
    let of_chance = |one: &&ComparedVerdict| {
        let [before, after] = [0, 1].map(|which| one.verdicts[which].as_ref().map_or("", |one| one.found.as_str()));
        let p = one.p_value.map_or(String::new(), |p| format!(", p = {}", brief(p)));
        format!("  {}: {before} before, {after} after, no more than chance makes{p}\n", one.statement())
    };
    let chances: String = by_chance.iter().take(FEW[1]).map(of_chance).collect();
    let mut text = match (count(Ordering::Less), count(Ordering::Greater), is_alone) {
        (_, _, true) => String::new(),
        (0, 0, _) if !by_chance.is_empty() => {
            let worse = by_chance.iter().filter(|one| one.is_worse()).count();
            let counts = if worse > 0 { "; --strict counts those that are worse" } else { "" };
            format!("PASS: {} changed within chance, no other one{counts}\n", counted(by_chance.len(), "verdict"))
        }
        (0, 0, _) => "PASS: no verdict has changed\n".to_owned(),
        (0, better, _) => format!("PASS: {better} {} better, none is worse\n", is_are(better)),
        (worse, 0, _) => format!("FAIL: {worse} {} worse than before\n", is_are(worse)),
        (worse, better, _) => format!("FAIL: {worse} {} worse than before, {better} better\n", is_are(worse)),
    };
    if let Some(tolerance) = tolerance {
        text += &match comparison.is_beyond(tolerance) {
            true => format!("FAIL: a shift is beyond {tolerance:?} of the spread\n"),
            false => format!("PASS: no shift is beyond {tolerance:?} of the spread\n"),
        };
    }
    text = chances + &text;
    if text.is_empty() {
        "no requirement is in both results: there is no verdict to compare\n".to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known: what is left of an estimate without its interval.
    #[test]
    fn intervals_are_left_out() {
        for (found, known) in
            [("98.4% [91.5, 99.96]", "98.4%"), ("1.23 [1.2, 1.3] deg", "1.23 deg"), ("100%", "100%"), ("-", "-")]
        {
            assert_eq!(without_interval(found), known);
        }
    }
}
