//! The findings on one screen ([`text`]) or in full ([`verbose`]), with a count of what is left out.

use std::path::Path;

use crate::analysis::outcomes::unique;
use crate::ensemble::precision::Measurement;
use crate::findings::end::SummaryEnd;
use crate::findings::names::sentence;
use crate::findings::numerics::WORST_RUN;
use crate::findings::requirement::EndVerdict;
use crate::findings::{Finding, Findings, Kind, Number, precision};
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::table::wrapped::{message, wrapped};

/// Lines of a screen without `--verbose`.
pub const LINES: usize = 24;
/// Maximum number of failure reasons: on a screen, in full.
const MOST_REASONS: [usize; 2] = [3, 12];
/// Rows on a screen: compared requirements, differing keys.
const MOST_REQUIREMENTS: usize = 6;
const MOST_KEYS: usize = 4;
/// Outcomes shown before any remark, and regardless of the space if there are no requirements.
const FIRST_OUTCOMES: usize = 3;
const LEAST_OUTCOMES: usize = 1;
const ALL: usize = usize::MAX;

/// Fits into `most` lines of `width` characters by omitting outcomes down to the first ones, then remarks, then more
/// outcomes, with a count of what is left out. `file` is the campaign, quoted for a shell.
pub fn text(findings: &Findings, file: &str, [most, width]: [usize; 2]) -> String {
    let of = |kind: Kind| findings.of(kind).filter(|one| one.rank == 0).collect::<Vec<_>>();
    let mut text = lines(&of(Kind::Warning), width);
    text += &requirements(findings, width);
    text += &sentences(&[of(Kind::Verdicts), of(Kind::Stop)].concat(), width);
    text += &reasons(findings, MOST_REASONS[0], width);
    text += &sentences(&[of(Kind::Mission), of(Kind::Note)].concat(), width);
    let (drivers, remarks): (Vec<&Finding>, Vec<&Finding>) =
        of(Kind::Driver).into_iter().partition(|one| !one.children.is_empty());
    // without drivers a remark says why
    let (drivers, remarks) = if drivers.is_empty() { (remarks, drivers) } else { (drivers, remarks) };
    let others = findings.of(Kind::Driver).filter(|one| one.rank == 1 && !one.children.is_empty()).count();
    let (worst, lost): (Vec<&Finding>, Vec<&Finding>) = of(Kind::Runs).into_iter().partition(|one| one.id == WORST_RUN);
    let all = of(Kind::Outcome);
    let with = |(outcomes, is_full): (usize, bool)| {
        let (numbers, about): (Vec<&Finding>, Vec<&Finding>) = all.iter().partition(|one| !one.numbers.is_empty());
        let gap = if text.is_empty() || outcomes == 0 || !is_full { "" } else { "\n" };
        let mut said = format!("{text}{gap}");
        let shown = outcomes.min(numbers.len());
        said += &self::outcomes(&numbers[..shown], width, usize::from(is_full));
        said += &left_out(numbers.len() - shown, ["outcome", "outcomes"], width);
        said += &sentences(&about, width);
        said += &sentences(&drivers, width);
        if is_full || remarks.is_empty() {
            said += &sentences(&remarks, width);
            said += &left_out(others, ["outcome with drivers", "outcomes with drivers"], width);
        } else {
            said += &left_out(others + remarks.len(), ["finding on drivers", "findings on drivers"], width);
        }
        said += &sentences(&of(Kind::Numerics), width);
        let runs = if is_full || worst.is_empty() { [&lost[..], &worst[..]].concat() } else { worst.clone() };
        said + &commands(&runs, file, width)
    };
    let least = if findings.verdict.is_none() { LEAST_OUTCOMES } else { 0 };
    let first = FIRST_OUTCOMES.min(all.len());
    let full = (first..=all.len()).rev().map(|outcomes| (outcomes, true));
    let choices = full.chain((least..=first).rev().map(|outcomes| (outcomes, false)));
    choices.map(with).find(|said| said.lines().count() <= most).unwrap_or_else(|| with((least, false)))
}

/// All findings except those for files only.
pub fn verbose(findings: &Findings, file: &str, width: usize) -> String {
    let of = |kind: Kind| findings.of(kind).filter(|one| one.rank <= 1).collect::<Vec<_>>();
    let mut parts = vec![lines(&of(Kind::Warning), width)];
    let mut said = if findings.verdict.is_some() { format!("  {}\n", findings.asked) } else { String::new() };
    for one in findings.of(Kind::Requirement) {
        let word = one.verdict.map_or("", |verdict| verdict.word());
        said += &wrapped(&format!("  {word:<10} {}\n", one.title), width);
        let all: Vec<&str> = core::iter::once(&one.sentence).chain(&one.notes).map(String::as_str).collect();
        said += &wrapped(&format!("             {}\n", all.join("; ")), width);
    }
    parts.push(said + &sentences(&of(Kind::Verdicts), width));
    parts.push(sentences(&of(Kind::Stop), width));
    parts.push(sentences(&of(Kind::Loss), width) + &reasons(findings, MOST_REASONS[1], width));
    let missions = of(Kind::Mission).into_iter().filter(|one| one.id != "missions").collect::<Vec<_>>();
    parts.push(sentences(&missions, width));
    parts.push(sentences(&of(Kind::Note), width));
    let more = findings.of(Kind::Outcome).filter(|one| one.rank > 1).count();
    let more =
        if more > 0 { format!("  and {more} more in statistics.parquet, with all others\n") } else { String::new() };
    parts.push(outcomes(&of(Kind::Outcome), width, ALL) + &more);
    parts.push(findings.brackets().map_or(String::new(), |said| {
        wrapped(&format!("  in brackets: {said}; ?: not bounded by so few runs\n"), width)
    }));
    let mut drivers = Table::with([("drivers", Align::Left), ("", Align::Sentence)]);
    of(Kind::Driver).iter().for_each(|one| drivers.row([&one.title, &one.sentence]));
    parts.push(if drivers.rows() > 0 { drivers.text(width) } else { String::new() });
    for one in of(Kind::Numerics) {
        let children: Vec<&Finding> = one.children.iter().collect();
        let columns = unique(children.iter().flat_map(|one| &one.numbers).map(|number| number.name.clone()));
        let table = numbers_table(&children, ("", &columns), true);
        let head = if one.sentence.is_empty() { format!("  {}\n", one.title) } else { sentences(&[one], width) };
        parts.push(head + &if children.is_empty() { String::new() } else { table.text(width) });
    }
    parts.push(commands(&of(Kind::Runs), file, width));
    parts.into_iter().filter(|part| !part.is_empty()).map(|part| format!("\n{part}")).collect()
}

/// Findings as sentences and tables, on a screen of `most` lines or in full. Rows of outcomes take the remaining lines.
pub fn list(findings: &[Finding], is_verbose: bool, [most, width]: [usize; 2]) -> String {
    let shown: Vec<&Finding> = findings.iter().filter(|one| one.rank <= u8::from(is_verbose)).collect();
    let paragraph = |one: &Finding, outcomes: usize| {
        let Some(table) = &one.table else {
            let indent = if [Kind::Runs, Kind::Verdicts].contains(&one.kind) { "" } else { "  " };
            return wrapped(&format!("{indent}{}\n", one.sentence), width);
        };
        let rows = match one.kind {
            _ if is_verbose => table.rows(),
            Kind::Requirement => MOST_REQUIREMENTS,
            Kind::Outcome => outcomes,
            _ => MOST_KEYS,
        };
        let left = table.rows().saturating_sub(rows);
        let things = [one.title.trim_end_matches('s'), &one.title];
        format!("\n{}{}", Text::of(table).first(rows).lines(width), left_out(left, things, width))
    };
    let text = |outcomes: usize| shown.iter().map(|one| paragraph(one, outcomes)).collect::<String>();
    let fits = |outcomes: &usize| text(*outcomes).lines().count() <= most;
    text((LEAST_OUTCOMES..most).rev().find(fits).unwrap_or(LEAST_OUTCOMES))
}

pub fn sections(findings: &[Finding], width: usize) -> String {
    let (mut text, mut title) = (String::new(), "");
    for one in findings {
        if one.title != title {
            title = &one.title;
            text += &if title.is_empty() { "\n".to_owned() } else { format!("\n== {title}\n") };
        }
        text += &paragraphs(core::slice::from_ref(one), width);
    }
    text
}

/// Findings without titles: sentences, tables, reasons.
pub fn paragraphs(findings: &[Finding], width: usize) -> String {
    let paragraph = |one: &Finding| {
        let end = if one.sentence.is_empty() { "" } else { "\n" };
        let table = one.table.as_ref().map_or(String::new(), |table| table.text(width));
        wrapped(&format!("{}{end}", one.sentence), width) + &table + &reason_lines(&one.children, usize::MAX, width)
    };
    findings.iter().map(paragraph).collect()
}

pub fn measurement(found: Option<&Measurement>, width: usize) -> String {
    let table = precision::table(found);
    let text = Text::of(&table).at_least(&precision::COLUMNS.map(|(.., width)| width)).spaced(0, 1);
    if found.is_none() { text.head(width) } else { text.body(width) }
}

pub fn question(question: Option<&str>, width: usize) -> String {
    question
        .filter(|text| !text.is_empty())
        .map_or(String::new(), |text| wrapped(&format!("{}\n", sentence(text)), width))
}

/// Warnings and verdicts of a finished result, and its `place`.
pub fn end(end: &SummaryEnd, place: &Path, width: usize) -> String {
    let warnings: String = end.warnings.iter().map(|one| format!("  {one}\n")).collect();
    let row = |one: &EndVerdict| [one.word.clone(), one.statement.clone(), one.found.clone(), String::new()];
    let rows: Vec<[String; 4]> = end.verdicts.iter().map(row).collect();
    wrapped(&warnings, width) + &verdict_table(["", ""], &rows, width) + &end.verdict_line(place) + "\n"
}

fn requirements(findings: &Findings, width: usize) -> String {
    let of = |one: &Finding| {
        let word = one.verdict.map_or("", |verdict| verdict.word());
        let found = one.numbers.first().map_or_else(|| "-".to_owned(), Number::text);
        [word.to_owned(), one.title.clone(), found, one.notes.join("; ")]
    };
    let rows: Vec<[String; 4]> = findings.of(Kind::Requirement).map(of).collect();
    let has_interval = findings.of(Kind::Requirement).any(|one| one.numbers.iter().any(Number::has_interval));
    let found = format!("found{}", findings.in_brackets().filter(|_| has_interval).unwrap_or_default());
    if rows.is_empty() { String::new() } else { verdict_table([&findings.asked, &found], &rows, width) }
}

/// Rows of verdict, requirement, estimate, notes; on narrow screens the estimate goes below the requirement.
fn verdict_table([required, found]: [&str; 2], rows: &[[String; 4]], width: usize) -> String {
    let heads = [("", Align::Left), (required, Align::Left), (found, Align::Left), ("", Align::Sentence)];
    let mut table = Table::with(heads);
    let longest = rows.iter().map(|[word, ..]| word.len()).max().unwrap_or(0);
    let mut lines = match required {
        "" => String::new(),
        _ => wrapped(&format!("  {:longest$}  {required}: {found}\n", ""), width),
    };
    for [word, required, found, notes] in rows {
        table.row([word, required, found, notes]);
        let said = [found, notes].into_iter().filter(|text| !text.is_empty()).map(String::as_str);
        let said = said.collect::<Vec<_>>().join("; ");
        let whole = format!("  {word:longest$}  {required}: {said}");
        lines += &if whole.chars().count() <= width && !said.is_empty() {
            whole + "\n"
        } else {
            let below = wrapped(&format!("  {:longest$}    {said}\n", ""), width);
            wrapped(&format!("  {word:longest$}  {required}\n"), width) + if said.is_empty() { "" } else { &below }
        };
    }
    if Text::of(&table).width_of(3) > width { lines } else { table.text(width) }
}

fn lines(list: &[&Finding], width: usize) -> String {
    let line = |one: &&Finding| wrapped(&format!("  {}: {}\n", one.title, one.sentence), width);
    list.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// One sentence each, with its title unless implied.
fn sentences(list: &[&Finding], width: usize) -> String {
    let line = |one: &&Finding| {
        let title = match one.kind {
            Kind::Driver if one.title.is_empty() => String::new(),
            // the title of an event contains the question
            Kind::Driver if one.title.contains(": ") => format!("{}: ", one.title),
            Kind::Driver => format!("what drives {}: ", one.title),
            Kind::Outcome if !one.numbers.is_empty() => format!("{}: ", one.title),
            Kind::Stop | Kind::Note => format!("{}: ", one.title),
            Kind::Mission if one.id == "missions" => format!("{}: ", one.title),
            Kind::Numerics if one.rank > 0 => format!("{}: ", one.title),
            _ => String::new(),
        };
        wrapped(&format!("  {title}{}\n", one.sentence), width)
    };
    list.iter().map(line).collect()
}

fn reasons(findings: &Findings, most: usize, width: usize) -> String {
    findings.of(Kind::Loss).map(|one| reason_lines(&one.children, most, width)).collect()
}

fn reason_lines(all: &[Finding], most: usize, width: usize) -> String {
    let mut text = String::new();
    for one in all.iter().take(most) {
        text += &wrapped(&format!("    {}: {}\n", one.title, one.sentence), width);
        text += &one.notes.iter().map(|note| wrapped(&format!("      {note}\n"), width)).collect::<String>();
    }
    text + &left_out(all.len().saturating_sub(most), ["reason", "reasons"], width)
}

fn left_out(count: usize, [one, several]: [&str; 2], width: usize) -> String {
    let what = if count == 1 { one } else { several };
    if count == 0 {
        String::new()
    } else {
        wrapped(&format!("  and {count} more {what}; --verbose shows all\n"), width)
    }
}

/// The replay command of each, unwrapped for copying.
fn commands(list: &[&Finding], file: &str, width: usize) -> String {
    let line = |one: &&Finding| Some(format!("  {}: {}\n", one.title, one.command(file)?));
    message(&list.iter().filter_map(line).collect::<String>(), width)
}

/// A table of outcomes with as many numbers as fit: median, required quantiles or spread, maximum; [`ALL`] notes add
/// means and minima. Yes-or-no outcomes and remarks are sentences.
fn outcomes(list: &[&Finding], width: usize, most_notes: usize) -> String {
    let is_all = most_notes == ALL;
    let is_in_table = |one: &&&Finding| !one.numbers.is_empty() && one.number("yes").is_none();
    let shown: Vec<&Finding> = list.iter().filter(is_in_table).copied().collect();
    let others: Vec<&Finding> = list.iter().filter(|one| !is_in_table(one)).copied().collect();
    let (yes_or_no, about): (Vec<&Finding>, Vec<&Finding>) =
        others.into_iter().partition(|one| !one.numbers.is_empty());
    let [yes_or_no, about] = [yes_or_no, about].map(|list| sentences(&list, width));
    if shown.is_empty() {
        return yes_or_no + &about;
    }
    let numbers = || shown.iter().flat_map(|one| &one.numbers);
    let named = |is_chosen: &dyn Fn(&Number) -> bool| {
        unique(numbers().filter(|number| is_chosen(number)).map(|number| number.name.clone()))
    };
    let is_one_of = |names: &'static [&'static str]| move |number: &Number| names.contains(&number.name.as_str());
    let mut columns = named(&is_one_of(&["value", "median"]));
    let required = named(&|number: &Number| number.limit.is_some() && number.name != "median");
    if required.is_empty() || is_all {
        columns.extend(named(&is_one_of(&["p5", "p95"])));
    }
    let start = columns.len().min(1);
    columns.extend(required.into_iter().filter(|name| !columns.contains(name)).collect::<Vec<_>>());
    columns[start..].sort_by_key(|name| name.trim_start_matches('p').parse::<f64>().map_or(0, |p| (1e6 * p) as u64));
    if is_all {
        columns.extend(named(&is_one_of(&["mean", "min"])));
    }
    let with_max: Vec<String> = columns.iter().cloned().chain(named(&is_one_of(&["max"]))).collect();
    let choices = [(&with_max, true), (&columns, true), (&with_max, false), (&columns, false)];
    let mut tables = choices.map(|(columns, has_intervals)| numbers_table(&shown, ("outcome", columns), has_intervals));
    let fits = |table: &Table<'_>| Text::of(table).width() <= width;
    let place = tables.iter().position(fits).unwrap_or(tables.len() - 1);
    let table = core::mem::take(&mut tables[if is_all { 0 } else { place }]).text(width);
    let is_shown = |note: &&String| match note.split_once(' ') {
        Some((name, _)) if name.starts_with('p') => with_max.iter().any(|one| one == name),
        _ => is_all,
    };
    let notes = unique(shown.iter().flat_map(|one| &one.notes).filter(is_shown));
    let notes = notes.into_iter().take(most_notes).map(|note| wrapped(&format!("  {note}\n"), width));
    let notes: String = notes.collect();
    table + &yes_or_no + &notes + &about
}

fn numbers_table(list: &[&Finding], (title, columns): (&str, &[String]), has_intervals: bool) -> Table<'static> {
    let heads = columns.iter().map(|name| (name.clone(), Align::Right));
    let mut table = Table::with([(title.to_owned(), Align::Title)].into_iter().chain(heads));
    for one in list {
        let text = |number: &Number| if has_intervals { number.bare() } else { number.alone() };
        let unit = one.numbers.first().map_or("", |number| number.shown.unit.as_str());
        let title = format!("{}, {unit}", one.title);
        let cells = columns.iter().map(|name| one.number(name).map_or_else(String::new, text));
        table.row([title.trim_end_matches(", ").to_owned()].into_iter().chain(cells));
    }
    table
}
