//! What a campaign has come to, on one screen: verdicts, outcomes in one line each, and what drives them. Everything
//! else is in `summary_text`.

use crate::analysis::assessment::Assessment;
use crate::analysis::drivers::Question;
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::campaign::{Plan, Statement};
use crate::findings::names;
use crate::findings::number::{brief, counted, outward, significant};
use crate::report::drivers_text::{ranked, sentence};
use crate::report::observable_lines::{ObservableLine, QuantileLine};
use crate::report::share_text::with_interval;
use crate::report::summary::Summary;
use crate::report::verdict_table::{self, VerdictRow};
use crate::report::{drivers_text, mission_text, requirements, summary_text, warnings};
use crate::run::Status;
use crate::statistics::binomial::Decision;
use crate::statistics::quantile::percent;
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::table::wrapped::wrapped;

/// Outcomes whose drivers are named where nothing is required.
const DRIVEN: usize = 3;
/// Most quantiles beside the median.
const MOST_QUANTILES: usize = 2;

/// The text for at most `most` lines of `width` characters, where outcomes can be left out for that. `file` is the
/// campaign as a word of the commands that show a run.
pub fn text(plan: &Plan, summary: &Summary, all: &[InputSensitivity], file: &str, [most, width]: [usize; 2]) -> String {
    let mut text = wrapped(warnings::text(&summary.warnings).trim_start_matches('\n'), width);
    let is_warned = !summary.warnings.is_empty();
    text += &requirements_table(summary, width);
    if let Some((_, stop)) = &summary.stopping {
        text += &wrapped(&format!("  stop: {stop}\n"), width);
    }
    let failures = summary.why_failed();
    // below a warning of them they need no title
    text += &wrapped(if is_warned { summary_text::untitled(&failures) } else { &failures }, width);
    let is_required = summary.verdicts.list.iter().any(|one| one.requirement.observable() == Some("launched"));
    text += &wrapped(&mission_text::brief(&summary.missions, is_required, is_warned), width);
    text += &wrapped(&summary.noted(), width);
    let mut end = wrapped(&drivers(plan, summary, all), width);
    if let Some(audit) = &summary.audit {
        end += &wrapped(&audit.coverage(), width);
    }
    if !failures.is_empty() {
        end += &summary.first_failures(file, width);
    }
    let gap = if text.is_empty() { "" } else { "\n" };
    let room = most.saturating_sub([&text, gap, &end].map(|part| part.matches('\n').count()).iter().sum::<usize>());
    let mut outcomes = outcomes(summary, usize::MAX, width);
    if outcomes.lines().count() > room {
        // the line that counts those that are left out
        let rows = summary.outcomes().iter().filter(|line| !is_stated(summary, line)).count();
        let others = outcomes.lines().count().saturating_sub(rows) + 1;
        outcomes = self::outcomes(summary, room.saturating_sub(others).max(LEAST_OUTCOMES), width);
    }
    if outcomes.is_empty() { text + &end } else { text + gap + &outcomes + &end }
}

/// Outcomes that are shown however many lines there are.
const LEAST_OUTCOMES: usize = 2;

/// A line for each requirement.
fn requirements_table(summary: &Summary, width: usize) -> String {
    let list = &summary.verdicts.list;
    let Some(first) = list.first() else { return String::new() };
    let confidence = first.requirement.confidence;
    let is_common = list.iter().all(|one| one.requirement.confidence == confidence);
    let head = if is_common {
        format!("requirement, with {}% confidence", percent(confidence))
    } else {
        "requirement".to_owned()
    };
    let is_share = list.iter().all(|one| one.requirement.statement != Statement::Mean);
    let found = if is_share { "runs within" } else { "found" };
    let of = if list.iter().any(Assessment::has_interval) {
        format!("{found} {}", in_brackets(summary))
    } else {
        found.to_owned()
    };
    let row = |one: &Assessment| {
        let confidence = match is_common {
            true => String::new(),
            false => format!(" ({}% confidence)", percent(one.requirement.confidence)),
        };
        let (decided_by, assumed) = (requirements::decided_by(one), requirements::assumed(one));
        let notes = decided_by.iter().chain(&one.reason).chain(&assumed).chain(&one.note);
        let notes: Vec<&str> = notes.map(String::as_str).collect();
        VerdictRow {
            word: one.word().to_owned(),
            required: requirements::statement(one) + &confidence,
            found: requirements::estimate(one),
            notes: notes.join("; "),
        }
    };
    let rows: Vec<VerdictRow> = list.iter().map(row).collect();
    let needed = list.iter().filter_map(|one| match one.gate.decision {
        Decision::Undecided(runs) => runs,
        _ => None,
    });
    let needed = needed
        .max()
        .map_or(String::new(), |runs| format!("  {}\n", requirements::runs_needed(Some(&runs.to_string()))));
    verdict_table::text([&head, &of], &rows, width) + &wrapped(&needed, width)
}

fn in_brackets(summary: &Summary) -> String {
    format!("[{}%]", percent(summary.confidence))
}

/// The table of the first `most` outcomes: those that the file names, or those of the motion.
fn outcomes(summary: &Summary, most: usize, width: usize) -> String {
    let mut shown = summary.outcomes();
    shown.retain(|line| !is_stated(summary, line));
    let left = shown.len().saturating_sub(most);
    shown.truncate(most);
    if shown.is_empty() || shown.iter().all(|line| line.is_empty()) {
        return if summary.is_computed() || !summary.warnings.is_empty() {
            String::new()
        } else {
            "  no statistics: no dispersed run was computed\n".to_owned()
        };
    }
    let required = summary.verdicts.list.iter().filter_map(|one| match one.requirement.statement {
        Statement::Quantile(p) => Some(p),
        _ => None,
    });
    let known: Vec<f64> = shown[0].quantiles.iter().map(|one| one.p).filter(|p| *p != 0.5).collect();
    let mut ps: Vec<f64> = required.filter(|p| known.contains(p)).collect();
    ps.sort_by(f64::total_cmp);
    ps.dedup();
    ps.truncate(MOST_QUANTILES);
    if ps.is_empty() {
        ps.extend(known.iter().find(|p| **p == 0.95).or(known.last()));
    }
    let mut table = outcome_table(summary, &shown, &ps, true);
    while Text::of(&table).width() > width && ps.len() > 1 {
        ps.pop();
        table = outcome_table(summary, &shown, &ps, true);
    }
    // names that are cut may be alike: rather no intervals
    if Text::of(&table).width() > width {
        table = outcome_table(summary, &shown, &ps, false);
    }
    let notes = shown.iter().flat_map(|line| &line.quantiles).filter(|one| ps.contains(&one.p));
    let note = notes.filter_map(|one| one.note.as_ref()).max_by_key(|note| note.len());
    let note = note.map_or(String::new(), |note| wrapped(&format!("  {note}\n"), width));
    // a warning says it already
    let is_said = !summary.warnings.is_empty();
    let treatment = match summary.treatment.starts_with(|letter: char| letter.is_ascii_digit()) && !is_said {
        true => wrapped(&format!("  {}\n", summary.treatment), width),
        false => String::new(),
    };
    let more = match left {
        0 => String::new(),
        1 => "  and 1 more outcome; --verbose shows all\n".to_owned(),
        left => format!("  and {left} more outcomes; --verbose shows all\n"),
    };
    table.text(width) + &more + &note + &treatment
}

/// A row for each of `shown`, with the quantiles `ps` beside the median, and their intervals where these are wanted.
fn outcome_table(summary: &Summary, shown: &[&ObservableLine], ps: &[f64], with_intervals: bool) -> Table<'static> {
    let has_counts = shown.iter().any(|line| line.without_value > 0);
    if !summary.without_nominal {
        return nominal_table(shown);
    }
    let mut heads = vec![("outcome".to_owned(), Align::Left)];
    if has_counts {
        heads.push(("runs".to_owned(), Align::Right));
    }
    heads.push(("median".to_owned(), Align::Right));
    let has_intervals = with_intervals && shown.iter().any(|line| line.has_interval());
    let interval = if has_intervals { format!(" {}", in_brackets(summary)) } else { String::new() };
    heads.extend(ps.iter().map(|p| (format!("p{}{interval}", percent(*p)), Align::Right)));
    heads.push(("max".to_owned(), Align::Right));
    let mut table = Table::with(heads);
    for line in shown {
        let mut cells = vec![name(line)];
        if has_counts {
            cells.push(line.count.to_string());
        }
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| brief(line.shown.value(value)));
        let quantile = |p: f64| line.quantiles.iter().find(|one| one.p == p);
        match line.share_of_yes() {
            Some(share) => {
                cells.extend([String::new(), format!("yes in {}", with_interval([share; 2], [f64::NAN; 2]))]);
            }
            None => {
                cells.push(number(quantile(0.5).and_then(|one| one.value)));
                cells.extend(ps.iter().map(|p| {
                    quantile(*p)
                        .filter(|_| !has_no_number(summary, line, *p))
                        .map_or("-".to_owned(), |one| if with_intervals { ends(line, one) } else { number(one.value) })
                }));
                cells.push(number(line.max));
            }
        }
        table.row(cells);
    }
    table
}

/// Whether the quantile `p` is required of an outcome and a run without a value, which is not within the limit: that of
/// the runs with a value would look as if it were.
fn has_no_number(summary: &Summary, line: &ObservableLine, p: f64) -> bool {
    let is_it = |one: &&Assessment| {
        one.requirement.observable() == Some(&line.name) && one.requirement.statement == Statement::Quantile(p)
    };
    summary.verdicts.list.iter().find(is_it).is_some_and(|one| one.missing > 0 && one.value.is_none())
}

/// What an outcome is called, with the unit in which it is shown.
fn name(line: &ObservableLine) -> String {
    let unit = if line.shown.unit.is_empty() { String::new() } else { format!(", {}", line.shown.unit) };
    names::of_column(&line.name, &line.unit) + &unit
}

/// The outcomes of a nominal run alone, which has one value of each.
fn nominal_table(shown: &[&ObservableLine]) -> Table<'static> {
    let mut table = Table::with([("outcome of the nominal run", Align::Left), ("value", Align::Right)]);
    for line in shown {
        table.row([name(line), line.max.map_or("-".to_owned(), |value| brief(line.shown.value(value)))]);
    }
    table
}

/// Whether the verdict on the share of runs says all of this outcome: it is yes or no. Of few runs a quantile lies
/// between both.
fn is_stated(summary: &Summary, line: &ObservableLine) -> bool {
    (line.is_yes_or_no() || line.name == "launched")
        && summary.verdicts.list.iter().any(|one| one.requirement.observable() == Some(&line.name))
}

/// A quantile with the ends of its interval, `?` where the runs do not bound it.
fn ends(line: &ObservableLine, one: &QuantileLine) -> String {
    let Some(value) = one.value else { return "-".to_owned() };
    let value = brief(line.shown.value(value));
    if one.interval == [None; 2] {
        return value;
    }
    // a power of ten takes the place of a digit
    let short = |text: String| if text.contains('e') { significant(text.parse().unwrap_or(f64::NAN), 2) } else { text };
    let found = one.interval.map(|end| line.shown.value(end.unwrap_or(f64::NAN)));
    let digits = if found.iter().any(|end| brief(*end).contains('e')) { 2 } else { 3 };
    let end = |end: f64| if end.is_nan() { "?".to_owned() } else { short(brief(end)) };
    let [low, high] = outward(found, digits).map(end);
    format!("{value} [{low}, {high}]")
}

/// What drives the outcomes: the first one that is not met, or the first ones where nothing is required.
fn drivers(plan: &Plan, summary: &Summary, all: &[InputSensitivity]) -> String {
    let is_met = |outcome: &&str| {
        let mut of = summary.verdicts.list.iter().filter(|one| one.requirement.observable() == Some(outcome));
        of.all(|one| one.gate.decision == Decision::Pass)
    };
    let mut outcomes = drivers_text::outcomes(plan, all);
    let most = if summary.verdicts.list.is_empty() { DRIVEN } else { 1 };
    outcomes.sort_by_key(is_met);
    let unit = |outcome: &str| summary.lines.iter().find(|line| line.name == outcome).map_or("", |line| &line.unit);
    let said = outcomes.into_iter().filter_map(|outcome| {
        let mut rankings = ranked(plan, all, outcome);
        rankings.retain(|ranking| ranking.drivers().next().is_some());
        // the event of a requirement that is not met first, the spread last
        rankings.sort_by_key(|ranking| match ranking.question {
            Question::Event(Event { occurs: Occurs::Missed { requirement, .. }, .. }) => {
                summary.verdicts.list.get(requirement).is_some_and(|one| one.gate.decision == Decision::Pass)
            }
            Question::Event(_) => false,
            Question::Spread => true,
        });
        let name = names::of_column(outcome, unit(outcome));
        Some(format!("  what drives {name}: {}\n", sentence(plan, outcome, rankings.first()?)))
    });
    let failed = mission_text::all_failed(&summary.missions).map(|why| format!("  what drives failures: {why}\n"));
    let said: String = failed.into_iter().chain(said.take(most)).collect();
    let computed = Status::ALL.into_iter().zip(summary.statuses.of_population());
    let computed: u64 = computed.filter(|(status, _)| *status == Status::Done).map(|(_, count)| count).sum();
    let is_tested = !all.is_empty() && drivers_text::refused(plan, all).is_none();
    match said.is_empty() && is_tested && summary.without_nominal && summary.warnings.is_empty() {
        true => format!("  no significant driver found in {}\n", counted(computed, "dispersed run")),
        false => said,
    }
}
